//! Hours of use in virtual time: the window, the device loop and the simulated controller, with a person who does things
//! at random. Nothing may fall over, no motor may be driven unarmed, and memory stays flat.
//!
//! A short run by default; `BRUSHWORK_SOAK_HOURS=8 cargo test -p brushwork-gui --test gui soak` runs them all.

use std::time::Duration;

use crate::support::alone::{LIMIT, alone};
use crate::support::bench::Bench;
use brushwork_gui::model::Phase;
use brushwork_gui::model::link::Arming;
use brushwork_link::Clock as _;
use brushwork_plant::world::WorldAction;
use brushwork_values::Motor;
use egui::{Key, Modifiers};
use egui_kittest::kittest::{NodeT as _, Queryable as _};

/// Virtual hours of the run that CI makes.
const SHORT_HOURS: f64 = 0.2;
/// Memory may grow by this much between the first eighth of the run, with everything opened once and the graph's ring full,
/// and its end.
const GROWTH_LIMIT_MEGABYTES: f64 = 16.0;
/// Rows that fill the graph's ring, which is bounded by itself.
const RING_ROWS: u32 = 370_000;
/// Frames while nobody touches anything and nothing is armed: fewer than the ten a second of the real window, to save time.
const IDLE_FRAME: Duration = Duration::from_millis(2_000);
/// Frames while something is armed: each renews the motion, which lives 250 ms.
const ARMED_FRAME: Duration = Duration::from_millis(200);
/// What a stop may take: the ramp from full duty, a second try, and the controller's own second after a lost link.
const GRACE: Duration = Duration::from_millis(1_700);

/// A small generator of its own, so that a seed gives the same run everywhere.
struct Dice(u64);

impl Dice {
    /// A whole number below `below`.
    fn roll(&mut self, below: u64) -> u64 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        self.0 % below
    }
}

/// What this process holds in memory; none where the system does not tell.
fn resident_megabytes() -> Option<f64> {
    let status = std::fs::read_to_string("/proc/self/status").ok()?;
    let line = status.lines().find(|line| line.starts_with("VmRSS:"))?;
    let kilobytes: f64 = line.split_whitespace().nth(1)?.parse().ok()?;
    Some(kilobytes / 1024.0)
}

fn hours() -> f64 {
    std::env::var("BRUSHWORK_SOAK_HOURS").ok().and_then(|hours| hours.parse().ok()).unwrap_or(SHORT_HOURS)
}

#[test]
fn hours_of_random_use_leave_nothing_driven_and_memory_flat() {
    let name = "soak::hours_of_random_use_leave_nothing_driven_and_memory_flat";
    println!("{}", alone(name, LIMIT + LIMIT.mul_f64(hours()), use_for_hours));
}

#[expect(clippy::print_stdout, reason = "the figures of a long run are what it is for")]
fn use_for_hours() {
    let seed = 0x5EED_CAFE_F00D;
    let whole = Duration::from_secs_f64(hours() * 3_600.0);
    let mut bench = Bench::new();
    bench.connect();
    if hours() > 1.0 {
        fill_graph(&mut bench);
    }
    let mut dice = Dice(seed);
    let mut user = User::default();
    let (mut early, mut acts, mut told_hour) = (None, 0_u32, 0);
    while bench.line.clock.now() < whole {
        user.act(&mut bench, &mut dice);
        acts += 1;
        let hour = bench.line.clock.now().as_secs() / 3_600;
        if hour > told_hour {
            told_hour = hour;
            println!("hour {hour}: {:.1} MB", resident_megabytes().unwrap_or(f64::NAN));
        }
        // Nobody leaves a motor running for long.
        let is_armed = bench.model().front.link.arming != Arming::Disarmed;
        let rest = Duration::from_millis(200 + dice.roll(if is_armed { 3_000 } else { 25_000 }));
        user.watch(&mut bench, rest, seed);
        if early.is_none() && bench.line.clock.now() > whole / 8 {
            early = resident_megabytes();
        }
    }
    let model = bench.model();
    println!("{acts} acts, {} driven, {} losses", user.drives, user.losses);
    assert!(model.messages.past().count() <= 200);
    assert!(user.drives > 0 && user.losses > 0, "seed {seed}: the run did not reach everything");
    if let (Some(early), Some(late)) = (early, resident_megabytes()) {
        println!("{early:.1} MB after an eighth of the run, {late:.1} MB at its end");
        assert!(
            late - early < GROWTH_LIMIT_MEGABYTES,
            "seed {seed}: memory grew from {early:.1} to {late:.1} MB"
        );
    }
}

/// Fills the graph's ring, so that its growth, which ends by itself, is not taken for a leak.
fn fill_graph(bench: &mut Bench) {
    let values = vec![1.0; bench.model().front.graph.live.channels.len()];
    for _ in 0..RING_ROWS {
        bench.model().front.graph.push(0.0, &values);
    }
}

/// A person who does things at random.
#[derive(Default)]
struct User {
    /// Since when nothing may drive.
    unarmed_since: Option<Duration>,
    drives: u32,
    losses: u32,
}

impl User {
    fn act(&mut self, bench: &mut Bench, dice: &mut Dice) {
        if !bench.model().is_connected() {
            // After a loss the user puts everything right and connects again.
            for action in [
                WorldAction::Unplug { unplugged: false },
                WorldAction::Power { on: true },
                WorldAction::SetBatteryVolts { volts: 24.0 },
            ] {
                bench.act(&action);
            }
            if bench.model().front.phase == Phase::Closed {
                bench.press("Connect");
            }
            bench.pass_ms(1_500);
            return;
        }
        match dice.roll(18) {
            0..=1 => self.show(bench, dice),
            2..=6 | 16..=17 => self.drive(bench, dice),
            7 => bench.key(Key::Space),
            8 => bench.key(Key::Escape),
            9 => bench.key_with(Modifiers::COMMAND, Key::T),
            10 => bench.key_with(Modifiers::COMMAND, Key::B),
            11 => {
                bench.act(&WorldAction::EStop { pressed: true });
                bench.pass_ms(3_000);
                bench.act(&WorldAction::EStop { pressed: false });
                // Its reset is set to hardware.
                bench.act(&WorldAction::Power { on: false });
                self.losses += 1;
            }
            12 => bench.act(&WorldAction::SetBatteryVolts {
                volts: [24.0, 9.0, 24.0, 61.0, 24.0, 24.0][dice.roll(6) as usize],
            }),
            13 => {
                bench.act(&WorldAction::LockShaft { motor: Motor::M1, on: dice.roll(2) == 0 });
            }
            14 if dice.roll(3) == 0 => {
                bench.act(&WorldAction::Unplug { unplugged: true });
                self.losses += 1;
            }
            _ => press_if_there(
                bench,
                ["Dismiss", "Clear history", "Pause log", "Record again", "Copy log"][dice.roll(5) as usize],
            ),
        }
    }

    fn show(&mut self, bench: &mut Bench, dice: &mut Dice) {
        let digits = [Key::Num1, Key::Num2, Key::Num3, Key::Num4, Key::Num5, Key::Num6];
        bench.key_with(Modifiers::COMMAND, digits[dice.roll(6) as usize]);
    }

    /// Arms a screen and drives, where the controller lets it.
    fn drive(&mut self, bench: &mut Bench, dice: &mut Dice) {
        bench.key_with(Modifiers::COMMAND, Key::Num3);
        press_if_there(bench, "Arm");
        bench.pass_ms(500);
        if matches!(bench.model().front.link.arming, Arming::Armed { .. }) {
            let percent = dice.roll(201) as i64 - 100;
            bench.set_duty(Motor::BOTH[dice.roll(2) as usize], &percent.to_string());
            self.drives += 1;
        }
    }

    /// Lets time pass and sees to it that nothing is driven that was not armed.
    fn watch(&mut self, bench: &mut Bench, time: Duration, seed: u64) {
        let end = bench.line.clock.now() + time;
        while bench.line.clock.now() < end {
            let armed = bench.model().front.link.arming != Arming::Disarmed;
            let frame = if armed { ARMED_FRAME } else { IDLE_FRAME };
            bench.pass_frame(frame);
            let now = bench.line.clock.now();
            if bench.model().front.link.arming != Arming::Disarmed {
                self.unarmed_since = None;
            } else {
                let since = *self.unarmed_since.get_or_insert(now);
                assert!(now < since + GRACE || bench.both_stand(), "seed {seed}: driven unarmed at {now:?}");
            }
        }
    }
}

fn press_if_there(bench: &mut Bench, label: &str) {
    let mut found = bench.harness.query_all_by_label(label).filter(|node| {
        node.accesskit_node().role() != egui::accesskit::Role::Label && !node.accesskit_node().is_disabled()
    });
    let is_there = found.next().is_some() && found.next().is_none();
    drop(found);
    if is_there {
        bench.press(label);
    }
}
