//! The example programs of MCP manual chapter 3, run inside the simulated controller: none faults, and what they say on stream 0 is what
//! the manual says. What they do to registers, motors, EEPROM and buses is tested beside the controller.

#[path = "../../../../script/tests/script/support/examples.rs"]
mod examples;

use brushwork_mcp_sim::controller::{Bus, Controller, ControllerConfig};
use brushwork_mcp_wire::packet_serial::{Address, Generation, Request, number};
use brushwork_plant::machine::{Machine, StreamIndex};
use brushwork_plant::world::ScriptRun;
use brushwork_script::{image, mcl};
use examples::{Example, corrected, examples};
use std::time::Duration;

/// How long each runs; the longest of those that end counts ten times to a second.
const TIME: Duration = Duration::from_secs(15);

/// What a script says on the USB port, and how far it is after [`TIME`].
fn run(example: &Example<'_>) -> (Vec<u8>, ScriptRun) {
    let text = corrected(example);
    let program = mcl::compile(&text).program.unwrap_or_else(|| panic!("{}", example.title));
    let mut config = ControllerConfig::default();
    let mut settings = Controller::new(config.clone()).expect("the preset is valid").settings();
    // USB is the script's, UART1 makes room for I2C; the command to start comes over RS-232.
    settings.streams[StreamIndex::Usb.index()].kind = 0;
    settings.streams[StreamIndex::Uart1.index()].kind = 2;
    config.settings = Some(settings);
    let mut bus = Bus::single(Controller::new(config).expect("the settings are in order"), StreamIndex::Usb);
    bus.controllers_mut()[0].install_script(&image::encode(&program));
    bus.advance(Duration::from_millis(10));
    let start = Request::new(Address::DEFAULT, number::START_SCRIPT, &[]);
    let start = start.encode(Generation::Gen1).expect("it has one form in every generation");
    bus.receive(StreamIndex::Uart0, &start);
    for line in &example.expected {
        if let Some(input) = line.strip_prefix("< ") {
            bus.receive(StreamIndex::Usb, &bytes(input));
        }
    }
    bus.advance(bus.now() + TIME);
    let said = std::iter::from_fn(|| bus.take_output(StreamIndex::Usb)).flatten().collect();
    (said, bus.controllers()[0].unit().expect("it has power").script_view().run)
}

fn bytes(text: &str) -> Vec<u8> {
    let text = text.replace("\\r", "\r").replace("\\0", "\0");
    text.replace("\\x01", "\x01").replace("\\x02", "\x02").into_bytes()
}

/// Runs the examples of a file; gives how many ran, and how many of them said something that is written down.
fn prove(file: &str, reads_set_registers: bool) -> (usize, usize) {
    let examples = examples(file);
    let mut compared = 0;
    for example in &examples {
        let (said, state) = run(example);
        assert!(!matches!(state, ScriptRun::Faulted { .. }), "{}: {state:?}", example.title);
        assert_ne!(state, ScriptRun::Idle, "{} did not start", example.title);
        // Where registers or a device were set for the expectation, the simulated controller has its own.
        let depends =
            example.expected.iter().any(|line| line.starts_with("set ") || line.starts_with("i2c "));
        for line in &example.expected {
            if let (Some(expected), false, false) = (line.strip_prefix("> "), depends, reads_set_registers) {
                let shown = String::from_utf8_lossy(&said);
                assert!(said.starts_with(&bytes(expected)), "{}: {shown:?}, not {expected:?}", example.title);
                compared += 1;
            }
            if *line == "ends" && !depends {
                assert!(matches!(state, ScriptRun::Ended { .. }), "{}: {state:?}", example.title);
            }
        }
    }
    (examples.len(), compared)
}

#[test]
fn the_examples_of_the_register_pages_run() {
    let (ran, _) = prove(include_str!("../../../../script/tests/manual/registers.txt"), true);
    assert!(ran > 60, "{ran}");
}

#[test]
fn the_examples_of_the_rest_of_the_chapter_run_and_say_what_the_manual_says() {
    let (ran, compared) = prove(include_str!("../../../../script/tests/manual/chapter.txt"), false);
    assert!(ran > 70 && compared > 35, "{ran} ran, {compared} were compared");
}
