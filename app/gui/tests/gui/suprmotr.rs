//! A SuprMotr in the window, by role and label, against a simulated controller in virtual time: its inputs and outputs.

use crate::support::alone::{LIMIT, alone};
use crate::support::one::One;
use brushwork_gui::suprmotr::SuprMotr;
use brushwork_plant::machine::{Machine as _, StreamIndex};
use brushwork_plant::world::{PinSignal, WorldAction};
use brushwork_suprmotr::sim_spec::SuprMotrSpec;
use brushwork_suprmotr_client::SuprMotrDriver;
use brushwork_suprmotr_sim::{SuprMotrBus, pin};
use egui::accesskit::Role;
use egui_kittest::kittest::{NodeT as _, Queryable as _};
use std::time::Duration;

type Bench = One<SuprMotrBus>;

const TARGET: &str = "sim:suprmotr-v9";

/// A board that was told these lines before anybody connected, and was then switched off and on.
fn board(lines: &[&str]) -> SuprMotrBus {
    let spec = SuprMotrSpec::parse("suprmotr-v9,seed=0").expect("it is a board");
    let mut bus = spec.bus().expect("the preset is sound");
    let mut time = Duration::from_millis(200);
    bus.advance(time);
    bus.exchange(b"\x010", Duration::from_millis(20));
    for line in lines {
        bus.exchange(format!("{line}\r").as_bytes(), Duration::from_millis(50));
    }
    for on in [false, true] {
        bus.apply(0, &WorldAction::Power { on });
        time = bus.now() + Duration::from_millis(500);
        bus.advance(time);
    }
    while bus.take_output(StreamIndex::Usb).is_some() {}
    bus
}

/// A window on a board.
fn connected(folder: &tempfile::TempDir, lines: &[&str]) -> Bench {
    let mut bench = Bench::new(folder, (&SuprMotrDriver, &SuprMotr), board(lines), TARGET);
    let begun = bench.line.with(|bus| bus.now());
    bench.line.clock.advance_to(begun);
    bench.app().open(TARGET);
    bench.pass_ms(5000);
    let phase = format!("{:?}", bench.app().model.front.phase);
    assert!(bench.app().model.front.is_connected(), "{phase}");
    bench
}

fn volts(bench: &Bench, pin: usize, volts: f64) {
    let signal = PinSignal::Volts { volts };
    bench.line.with(|bus| bus.apply(0, &WorldAction::SetPin { pin, signal }));
}

fn outputs(bench: &Bench) -> u16 {
    bench.line.with(|bus| bus.suprmotrs()[0].outputs())
}

/// Whether a button can be pressed.
fn can_press(bench: &Bench, label: &str) -> bool {
    let found = bench.harness.query_all_by_label(label);
    let mut buttons = found.filter(|node| node.accesskit_node().role() == Role::Button);
    !buttons.next().expect("there is such a button").accesskit_node().is_disabled()
}

#[test]
fn channels_are_turned_switched_and_seen_and_analog_lines_have_volts() {
    alone("suprmotr::channels_are_turned_switched_and_seen_and_analog_lines_have_volts", LIMIT, || {
        let folder = tempfile::tempdir().expect("a temporary folder can be made");
        let mut bench = connected(&folder, &[]);
        bench.press("Inputs and Outputs");
        bench.pass_ms(2000);
        assert!(bench.sees("Channel 1 reads off") && bench.sees("Channel 16 reads off"));
        volts(&bench, pin::CHANNEL_1 + 6, 5.0);
        volts(&bench, pin::ANALOG_1, 2.49);
        bench.pass_ms(2000);
        assert!(bench.sees("Channel 7 reads on") && bench.sees("Channel 8 reads off"));
        assert!(bench.sees("Input 1 (J1 pin 3): 2.49 V (127)"), "an input in volts");
        assert!(bench.sees("Input 2 (J2 pin 1): 5.00 V (255)"), "its pull-up");
        assert!(bench.sees("Brake output (J3 pin 4): released"));

        // A channel is an output before it can be switched.
        assert!(!can_press(&bench, "Switch channel 3 on"));
        bench.press("Make channel 3 an output");
        bench.pass_ms(500);
        assert_eq!(outputs(&bench), 0);
        bench.press("Switch channel 3 on");
        bench.pass_ms(1000);
        assert_eq!(outputs(&bench), 0x0004);
        assert!(bench.sees("Channel 3 reads on"));
        // The same by the keyboard alone.
        bench.harness.get_by_label("Switch channel 3 off").focus();
        bench.harness.step();
        bench.harness.key_press(egui::Key::Enter);
        bench.pass_ms(1000);
        assert_eq!(outputs(&bench), 0);
        assert!(bench.sees("Channel 3 reads off"));
        bench.press("Make channel 3 an input");
        bench.pass_ms(500);
        assert!(!can_press(&bench, "Switch channel 3 on"));

        bench.app().model.front.suprmotr_mut().channels.wanted_volts = 2.5;
        bench.press("Set the analog output");
        bench.pass_ms(2000);
        assert_eq!(bench.line.with(|bus| bus.suprmotrs()[0].analog_output()), 128);
        assert!(bench.sees("Output (J3 pin 17): 2.51 V (128)"));
    });
}

#[test]
fn a_macro_goes_on_while_its_channels_are_watched_and_nothing_else_is_sent() {
    alone("suprmotr::a_macro_goes_on_while_its_channels_are_watched_and_nothing_else_is_sent", LIMIT, || {
        let folder = tempfile::tempdir().expect("a temporary folder can be made");
        let mut bench = connected(&folder, &["MD0,CN5,WA900,CF5,WA900,RP"]);
        assert!(bench.line.with(|bus| bus.suprmotrs()[0].is_in_macro()), "it runs from power-up on");
        bench.press("Inputs and Outputs");
        let mut seen = [false; 2];
        for _ in 0..60 {
            bench.pass_ms(100);
            seen[0] |= bench.sees("Channel 5 reads off");
            seen[1] |= bench.sees("Channel 5 reads on");
        }
        assert_eq!(seen, [true; 2], "both levels are seen");
        assert!(bench.line.with(|bus| bus.suprmotrs()[0].is_in_macro()), "and it still runs");
        assert!(bench.sees("A macro or a wait is in process"));
        assert!(bench.sees("Input 1 (J1 pin 3): not read"));
        for label in ["Make channel 3 an output", "Switch channel 5 on", "Set the analog output"] {
            assert!(!can_press(&bench, label), "{label}");
        }
        bench.press("Stop All");
        bench.pass_ms(3000);
        assert!(!bench.line.with(|bus| bus.suprmotrs()[0].is_in_macro()));
        assert!(!bench.sees("A macro or a wait is in process"));
        assert!(bench.sees("Input 1 (J1 pin 3): 0.00 V (0)"), "lines are sent again");
        assert!(can_press(&bench, "Make channel 3 an output"));
    });
}
