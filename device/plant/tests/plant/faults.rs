//! Fault scripts in virtual time.

use crate::support::{Parrot, USB, exchange};
use brushwork_plant::faults::{Fault, Faulty};
use brushwork_plant::machine::Machine;
use brushwork_plant::pacing::Paced;
use brushwork_plant::world::{PinSignal, SwitchKind, WorldAction};
use brushwork_values::Motor;
use std::time::Duration;

const STEP: Duration = Duration::from_millis(1);

fn faults(texts: &[&str]) -> Vec<Fault> {
    texts.iter().map(|text| text.parse().expect("the test's faults are valid")).collect()
}

fn faulty(texts: &[&str], seed: u64) -> Faulty<Parrot> {
    Faulty::new(Parrot::new(), faults(texts), seed)
}

/// The replies to `count` requests, a millisecond apart.
fn replies(machine: &mut impl Machine, count: u8) -> Vec<Vec<u8>> {
    (0..count)
        .map(|n| exchange(machine, &[0x80, n], STEP).into_iter().flat_map(|(_, piece)| piece).collect())
        .collect()
}

#[test]
fn without_faults_all_passes_at_once() {
    let mut machine = faulty(&[], 1);
    assert_eq!(exchange(&mut machine, &[0x80, 7], STEP), [(Duration::ZERO, vec![7; 4])]);
}

#[test]
fn the_stated_share_of_bytes_is_lost_doubled_or_changed_and_the_same_ones_for_the_same_seed() {
    let send = |text: &str, seed: u64| {
        let mut machine = faulty(&[text], seed);
        for _ in 0..100 {
            machine.receive(USB, &[0x55; 100]);
            machine.advance(machine.now() + STEP);
        }
        machine.inner_mut().heard.iter().map(|(_, byte)| *byte).collect::<Vec<u8>>()
    };
    let dropped = send("drop=0.1,dir=in", 1);
    assert!((8800..9200).contains(&dropped.len()), "{}", dropped.len());
    let doubled = send("duplicate=10%,dir=in", 1);
    assert!((10_800..11_200).contains(&doubled.len()), "{}", doubled.len());
    let corrupted = send("corrupt=0.1,dir=in", 1);
    assert_eq!(corrupted.len(), 10_000);
    let changed: Vec<u8> = corrupted.iter().copied().filter(|byte| *byte != 0x55).collect();
    assert!((800..1200).contains(&changed.len()), "{}", changed.len());
    assert!(changed.iter().all(|byte| (byte ^ 0x55).count_ones() == 1), "one bit each");
    assert_eq!(corrupted, send("corrupt=0.1,dir=in", 1));
    assert_ne!(corrupted, send("corrupt=0.1,dir=in", 2));
}

#[test]
fn silence_lasts_as_long_as_it_says() {
    let mut machine = faulty(&["mute@5ms..10ms,dir=out"], 1);
    let heard: Vec<bool> = replies(&mut machine, 15).iter().map(|reply| !reply.is_empty()).collect();
    let wanted: Vec<bool> = (0..15).map(|n| !(5..10).contains(&n)).collect();
    assert_eq!(heard, wanted);
    assert_eq!(machine.inner_mut().heard.len(), 30, "the machine heard all of it");
}

#[test]
fn late_bytes_come_late_and_in_order() {
    let mut machine = faulty(&["delay=3ms@2ms..3ms,dir=in"], 1);
    machine.advance(Duration::from_millis(2));
    machine.receive(USB, &[0x80]);
    machine.advance(Duration::from_millis(3));
    machine.receive(USB, &[0x15]);
    machine.advance(Duration::from_millis(20));
    let late = Duration::from_millis(5);
    assert_eq!(machine.inner_mut().heard, [(late, 0x80), (late, 0x15)]);
    assert_eq!(machine.take_output(USB), Some(vec![0x15; 4]));
}

#[test]
fn a_reply_with_late_bytes_is_torn_at_the_first_of_them() {
    let mut torn = 0;
    for seed in 0..20 {
        let mut machine = faulty(&["delay=2ms,dir=out,share=0.3"], seed);
        let pieces = exchange(&mut machine, &[0x80, 9], Duration::from_millis(50));
        assert_eq!(pieces.iter().map(|(_, piece)| piece.len()).sum::<usize>(), 4, "seed {seed}");
        torn += usize::from(pieces.len() == 2);
    }
    assert!(torn > 5, "{torn} of 20 torn");
}

#[test]
fn a_fault_of_the_machine_begins_and_ends_at_its_times_however_time_is_driven() {
    for step_ms in [1, 7, 1000] {
        let mut machine = faulty(&["plant:locked-shaft@200ms..400ms,motor=2"], 1);
        machine.inner_mut().duty = 0.5;
        let run = |machine: &mut Faulty<Parrot>, to: u64| {
            while machine.now() < Duration::from_millis(to) {
                let next = machine.now() + Duration::from_millis(step_ms);
                machine.advance(next.min(Duration::from_millis(to)));
            }
            let view = machine.views().remove(0);
            view.axes.map(|axis| axis.truth.motor_radians_per_second)
        };
        let [free, same] = run(&mut machine, 195);
        assert_eq!(free, same);
        let [free, held] = run(&mut machine, 300);
        assert!(free > 100.0 && held == 0.0, "{free} {held}");
        let [_, again] = run(&mut machine, 1000);
        assert!(again > 100.0, "{again}");
    }
}

#[test]
fn the_end_of_a_fault_brings_back_what_was_there_before() {
    let mut machine = faulty(&["plant:battery=9@10ms..20ms", "plant:load-torque=1@10ms..20ms"], 1);
    machine.apply(0, &WorldAction::SetBatteryVolts { volts: 18.0 });
    machine.advance(Duration::from_millis(15));
    let during = machine.views().remove(0);
    assert_eq!((during.battery_volts, during.axes[0].truth.load_newton_metres), (9.0, 1.0));
    machine.advance(Duration::from_millis(25));
    let after = machine.views().remove(0);
    assert_eq!((after.battery_volts, after.axes[0].truth.load_newton_metres), (18.0, 0.0));
}

#[test]
fn a_pulled_cable_carries_nothing_until_it_is_back() {
    let mut machine = faulty(&["unplug@5ms..10ms"], 1);
    let heard: Vec<bool> = replies(&mut machine, 15).iter().map(|reply| !reply.is_empty()).collect();
    assert_eq!(heard, (0..15).map(|n| !(5..10).contains(&n)).collect::<Vec<_>>());
    assert_eq!(machine.inner_mut().heard.len(), 20);
}

#[test]
fn a_tripped_limit_switch_pulls_its_pin_to_ground_and_is_gone_afterwards() {
    let mut machine = faulty(&["plant:limit-switch=backward@10ms..20ms,motor=2,pin=3"], 1);
    let pin = |machine: &Faulty<Parrot>| machine.views()[0].pins[2];
    assert_eq!(pin(&machine), PinSignal::Open);
    machine.advance(Duration::from_millis(15));
    assert_eq!(pin(&machine), PinSignal::Volts { volts: 0.0 });
    assert_eq!(machine.views()[0].axes[1].switches_closed, [false, true, false]);
    machine.advance(Duration::from_millis(25));
    assert_eq!(pin(&machine), PinSignal::Open);
}

#[test]
fn every_action_can_be_undone() {
    let machine = faulty(&[], 1);
    let view = machine.views().remove(0);
    let (motor, on) = (Motor::M2, true);
    for action in [
        WorldAction::SetLoadTorque { motor, newton_metres: 1.0 },
        WorldAction::SetBatteryVolts { volts: 9.0 },
        WorldAction::SetBatteryOhms { ohms: 1.0 },
        WorldAction::SetBatterySinks { can_sink: false },
        WorldAction::ConnectBattery { connected: false },
        WorldAction::SetLogicVolts { volts: 5.0 },
        WorldAction::WireSwitch { motor, switch: SwitchKind::Home, pin: Some(1), trips_at_radians: None },
        WorldAction::HoldSwitch { motor, switch: SwitchKind::Home, closed: true },
        WorldAction::SetPin { pin: 0, signal: PinSignal::Pulse { microseconds: 1500.0 } },
        WorldAction::EStop { pressed: true },
        WorldAction::ReverseEncoder { motor, on },
        WorldAction::LoseEncoder { motor, on },
        WorldAction::SetEncoderNoise { motor, counts: 3.0 },
        WorldAction::SwapEncoders { on },
        WorldAction::LockShaft { motor, on },
        WorldAction::OpenLead { motor, on },
        WorldAction::ReverseLeads { motor, on },
        WorldAction::Power { on: false },
        WorldAction::Unplug { unplugged: true },
    ] {
        let mut machine = faulty(&[], 1);
        machine.apply(0, &action);
        assert_ne!(machine.views()[0], view, "{action:?}");
        machine.apply(0, &action.undo(&view).expect("it has an undo"));
        assert_eq!(machine.views()[0], view, "{action:?}");
    }
}

#[test]
fn faults_and_pacing_work_together() {
    let machine = Faulty::new(Parrot::new(), faults(&["drop=1@4ms..5ms,dir=out"]), 1);
    let mut machine = Paced::new(machine, true);
    let window = Duration::from_millis(2);
    let answered: Vec<bool> =
        (0..5).map(|n| !exchange(&mut machine, &[0x80, n], window).is_empty()).collect();
    assert_eq!(answered, [true, true, false, true, true]);
}
