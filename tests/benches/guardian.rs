//! How soon a motor is off after the program that drives it was killed, or lost its display: seen in the simulator, whose controllers have no
//! time-out of their own, or one of a minute.
//!
//! `cargo bench -p brushwork-tests --bench guardian -- [--kills 100] [--displays 20] [--load quiet|busy] [--program drive|tune|window]
//! [--minutes 30]`. Busy is 8 processes that take all they can get from when a program drives, or a window is open, on. The table in SAFETY.md is what it prints. With `--minutes` it is a soak: one attack of each kind after the other, until the
//! time is over. Each attack is told on the standard error as it comes. Of the worst it says when the motor was last seen driven, too: far from the first look at which it was off, this
//! computer was late, not the stop. It ends with 1 where a motor was off later than promised, or a row could not be tried.
#![expect(clippy::print_stdout, reason = "the table is what the benchmark is for")]
#![expect(clippy::print_stderr, reason = "each attack is told as it comes")]

fn main() -> std::process::ExitCode {
    #[cfg(target_os = "linux")]
    return killing::run();
    #[cfg(not(target_os = "linux"))]
    std::process::ExitCode::SUCCESS
}

/// Pseudo-terminals and Xvfb.
#[cfg(target_os = "linux")]
mod killing {
    use std::process::{Command, ExitCode, Stdio};
    use std::thread;
    use std::time::{Duration, Instant};

    use brushwork_motion_mind_sim::{Mode, MotionMind, MotionMindBus, MotionMindConfig};
    use brushwork_plant::machine::Machine;
    use brushwork_tests::hands::OpenWindow;
    use brushwork_tests::program::{Child, Program};
    use brushwork_tests::served::{Off, Served, mcp, motion_mind};
    use brushwork_tests::wait;

    const BRUSHWORK: &str = env!("CARGO_BIN_EXE_brushwork-for-tests");

    /// How many programs keep the machine busy.
    const BUSY: usize = 8;
    /// A motor that is driven for so long is not stopped by anybody.
    const NEVER: Duration = Duration::from_secs(5);
    /// How often a program is started that finds the machine too crowded to drive.
    const TRIES: usize = 20;
    /// Moments of an attack lie so far apart within a run, in so many steps.
    const MOMENTS: (Duration, u32) = (Duration::from_millis(17), 13);

    /// What is asked for.
    struct Wanted {
        kills: u32,
        displays: u32,
        load: Option<String>,
        program: Option<String>,
        /// Attacks of all kinds in turn for so long, instead of a count of each.
        soak: Option<Duration>,
    }

    impl Wanted {
        /// Of the command line, without what cargo adds.
        fn read() -> Result<Self, String> {
            let mut wanted = Self { kills: 100, displays: 20, load: None, program: None, soak: None };
            let mut words = std::env::args().skip(1).filter(|word| word != "--bench");
            while let Some(word) = words.next() {
                let value = words.next().ok_or_else(|| format!("{word} has no value."))?;
                let count = || value.parse().map_err(|_| format!("{word} {value} is no number."));
                match word.as_str() {
                    "--kills" => wanted.kills = count()?,
                    "--displays" => wanted.displays = count()?,
                    "--load" => wanted.load = Some(value),
                    "--program" => wanted.program = Some(value),
                    "--minutes" => wanted.soak = Some(Duration::from_secs(60) * count()?),
                    _ => return Err(format!("There is no option {word}.")),
                }
            }
            Ok(wanted)
        }
    }

    /// Who drives, and how it is attacked.
    #[derive(Clone, Copy, PartialEq, Eq)]
    enum Attack {
        Drive,
        Tune,
        Window,
        Display,
    }

    impl Attack {
        const ALL: [Self; 4] = [Self::Drive, Self::Tune, Self::Window, Self::Display];

        fn program(self) -> &'static str {
            match self {
                Self::Drive => "drive",
                Self::Tune => "tune",
                Self::Window | Self::Display => "window",
            }
        }

        fn title(self) -> &'static str {
            if self == Self::Display { "X server killed" } else { "kill -9" }
        }

        fn wants_display(self) -> bool {
            self.program() == "window"
        }
    }

    pub fn run() -> ExitCode {
        let wanted = match Wanted::read() {
            Ok(wanted) => wanted,
            Err(why) => {
                println!("{why}");
                return ExitCode::from(2);
            }
        };
        let has_xvfb = std::env::var_os("PATH")
            .is_some_and(|path| std::env::split_paths(&path).any(|folder| folder.join("Xvfb").is_file()));
        println!(
            "| Attack | Program | Controller | Load | Tried | Motor off in: median | p99 | worst | Goal |"
        );
        println!("| --- | --- | --- | --- | --- | --- | --- | --- | --- |");
        let wants_window = wanted.program.as_ref().is_none_or(|only| only == Attack::Window.program());
        let mut is_kept = has_xvfb || !wants_window;
        if !is_kept {
            println!("Xvfb is not installed, so that the window was not tried: on Debian, apt install xvfb.");
        }
        for (load, goal_ms) in [("quiet", 100), ("busy", 300)] {
            if wanted.load.as_ref().is_some_and(|only| only != load) {
                continue;
            }
            let busy = Busy::of(if load == "busy" { BUSY } else { 0 });
            let attacks = Attack::ALL.into_iter().filter(|attack| {
                wanted.program.as_ref().is_none_or(|only| only == attack.program())
                    && (has_xvfb || !attack.wants_display())
            });
            let mut rows: Vec<Row> =
                attacks.flat_map(|attack| UNITS.map(|unit| Row { attack, unit, took: Vec::new() })).collect();
            let began = Instant::now();
            for turn in 0.. {
                let is_due = |row: &Row| match wanted.soak {
                    Some(soak) => began.elapsed() < soak,
                    None if row.attack == Attack::Display => turn < wanted.displays,
                    None => turn < wanted.kills,
                };
                let mut tried = false;
                for row in &mut rows {
                    if is_due(row) {
                        let took = row.unit.attacked(row.attack, turn, &busy);
                        row.say(load, turn, took);
                        row.took.push(took);
                        tried = true;
                    }
                }
                if !tried {
                    break;
                }
            }
            for row in rows {
                is_kept &= row.print(load, goal_ms);
            }
            drop(busy);
        }
        ExitCode::from(u8::from(!is_kept))
    }

    /// Programs that keep the machine busy.
    struct Busy(Vec<Child>);

    impl Busy {
        fn of(count: usize) -> Self {
            let mut command = Command::new("sh");
            command.args(["-c", "while :; do :; done"]);
            Self((0..count).map(|_| Child::spawn(&command, [(); 3].map(|()| Stdio::null()))).collect())
        }

        /// On a pseudo-terminal; on a busy machine by TCP, but for `drive`: what goes through a terminal comes up to half a second late there, and who
        /// hears nothing for a quarter second stops by itself before the attack.
        fn serve<M: Machine + 'static>(&self, attack: Attack, machine: M, options: &str) -> Served<M> {
            if attack != Attack::Drive && !self.0.is_empty() {
                Served::on_tcp(machine, options)
            } else {
                Served::on_pty(machine, options)
            }
        }

        /// Does what is no part of an attack while they stand still: a window that opens beside them takes half a minute.
        fn halted<T>(&self, work: impl FnOnce() -> T) -> T {
            self.0.iter().for_each(|program| program.signal("STOP"));
            let done = work();
            self.0.iter().for_each(|program| program.signal("CONT"));
            done
        }
    }

    /// Whose motor is driven.
    #[derive(Clone, Copy)]
    enum Unit {
        Mcp,
        MotionMind,
    }

    const UNITS: [Unit; 2] = [Unit::Mcp, Unit::MotionMind];

    impl Unit {
        fn name(self) -> &'static str {
            match self {
                Self::Mcp => "MCP266",
                Self::MotionMind => "Motion Mind 3",
            }
        }

        /// One attack on a new one. Nothing where its motor was not stopped.
        fn attacked(self, attack: Attack, turn: u32, busy: &Busy) -> Option<Off> {
            match (self, attack) {
                (Self::Mcp, _) => once(&busy.serve(attack, mcp(), ",stream=usb"), attack, turn, busy),
                (Self::MotionMind, Attack::Tune) => {
                    once(&busy.serve(attack, tunable(), OF_MIND), attack, turn, busy)
                }
                (Self::MotionMind, Attack::Drive | Attack::Window | Attack::Display) => {
                    once(&busy.serve(attack, motion_mind(), OF_MIND), attack, turn, busy)
                }
            }
        }
    }

    const OF_MIND: &str = ",family=motion-mind";

    /// A Motion Mind whose loop can be tuned.
    fn tunable() -> MotionMindBus {
        let unit =
            MotionMind::new(MotionMindConfig::new(Mode::SerialPid)).expect("the default motor is sound");
        MotionMindBus::new(vec![unit])
    }

    /// A row of the table.
    struct Row {
        attack: Attack,
        unit: Unit,
        took: Vec<Option<Off>>,
    }

    impl Row {
        /// Says what one attack took: a run of hours that is ended early has told what it saw.
        fn say(&self, load: &str, turn: u32, took: Option<Off>) {
            let took = took.map_or_else(
                || "never off".to_owned(),
                |took| format!("{:.0} ms", took.off_after.as_secs_f64() * 1e3),
            );
            let (title, program, unit) = (self.attack.title(), self.attack.program(), self.unit.name());
            eprintln!("{load}, {title}, {program}, {unit}, {}: {took}", turn + 1);
        }

        /// Prints it. Whether all of it is within the goal.
        fn print(self, load: &str, goal_ms: u64) -> bool {
            let never = Off { off_after: NEVER, driven_for: NEVER };
            let mut took: Vec<Off> = self.took.into_iter().map(|took| took.unwrap_or(never)).collect();
            took.sort_unstable();
            let Some(last) = took.len().checked_sub(1) else { return true };
            let at = |share: usize| took[(last * share).div_ceil(100)].off_after.as_secs_f64() * 1e3;
            let worst = took[last];
            let is_kept = worst.off_after <= Duration::from_millis(goal_ms);
            println!(
                "| {} | {} | {} | {load} | {} | {:.0} ms | {:.0} ms | {:.0} ms (driven at {:.0}) | {goal_ms} ms{} |",
                self.attack.title(),
                self.attack.program(),
                self.unit.name(),
                took.len(),
                at(50),
                at(99),
                at(100),
                worst.driven_for.as_secs_f64() * 1e3,
                if is_kept { "" } else { ", MISSED" }
            );
            is_kept
        }
    }

    /// One attack, at a moment that depends on its turn.
    fn once<M: Machine + 'static>(served: &Served<M>, attack: Attack, turn: u32, busy: &Busy) -> Option<Off> {
        let (step, moments) = MOMENTS;
        let moment = step * (turn % moments);
        let target = served.target.as_str();
        let drive = ["drive", "-c", target, "--motor", "1", "--duty", "40", "--for", "600"];
        let tune = ["tune", "velocity", "-c", target, "--dry-run"];
        match attack {
            Attack::Drive => killed(served, moment, || Program::start(BRUSHWORK, &drive)),
            Attack::Tune => killed(served, moment, || Program::start(BRUSHWORK, &tune)),
            Attack::Window | Attack::Display => {
                let mut window = busy.halted(|| OpenWindow::on(BRUSHWORK, served));
                let drives = (0..TRIES).any(|_| {
                    window.drive(served);
                    thread::sleep(moment);
                    window.program.is_running() && served.look().0
                });
                assert!(drives, "a machine with room for a window that drives");
                let strike = || match attack {
                    Attack::Display => window.screen.kill(),
                    Attack::Drive | Attack::Tune | Attack::Window => window.program.signal("KILL"),
                };
                served.off_after(strike, NEVER)
            }
        }
    }

    /// Kills a program while it drives.
    fn killed<M: Machine + 'static>(
        served: &Served<M>,
        moment: Duration,
        start: impl Fn() -> Program,
    ) -> Option<Off> {
        let drives = |program: &mut Program| {
            let drives_or_ended = || served.look().0 || !program.is_running();
            wait::until("a driven motor, or the end", drives_or_ended, || "it stands".to_owned());
            program.is_running()
        };
        let begun = (0..TRIES).map(|_| start()).find_map(|mut program| {
            let lives = drives(&mut program) && {
                thread::sleep(moment);
                drives(&mut program)
            };
            lives.then_some(program)
        });
        let program = begun.expect("a machine with room for a program that drives");
        served.off_after(|| program.signal("KILL"), NEVER)
    }
}
