//! A client that dies in mid-motion: the controller's own time-out stops the motors, and nothing else is needed.
#![cfg(unix)]
#![expect(clippy::print_stdout, reason = "measured times belong into the record of a test run")]

use std::time::Duration;

use brushwork_mcp_wire::packet_serial::Generation;
use brushwork_tests::foreign;
use brushwork_tests::program::Program;
use brushwork_tests::simulated::{OnPty, is_at_rest, is_driven};
use brushwork_tests::wait::LIMIT;
use brushwork_tests::workspace;

/// How often a client may be kept from talking by a busy machine before the test gives up.
const TRIES: usize = 20;

fn driving_client(controller: &OnPty, time_out: Duration) -> Program {
    let script = workspace::root().join("tests/foreign/driving_client.py");
    let port = controller.port();
    let time_out_ms = time_out.as_millis().to_string();
    let python = foreign::python();
    let text = |path: &std::path::Path| path.to_string_lossy().into_owned();
    let mut client = Program::start(&text(&python), &[text(&script), text(&port), time_out_ms]);
    client.wait_for("driving", LIMIT);
    client
}

/// Whether the motors run on for half as long again as the time-out.
fn runs_on(controller: &OnPty, time_out: Duration) -> bool {
    controller.wait_until("a client that drives", is_driven);
    controller.let_pass(time_out + time_out / 2);
    controller.look(is_driven)
}

fn dies_in_mid_motion(signal: &str, time_out: Duration) {
    if foreign::is_left_out("python") {
        return;
    }
    let talking = (0..TRIES).find_map(|_| {
        let controller = OnPty::start(Generation::Gen1);
        let client = driving_client(&controller, time_out);
        runs_on(&controller, time_out).then_some((controller, client))
    });
    let (controller, client) = talking.expect("the motors run on for as long as the client talks");
    client.signal(signal);
    let off = controller.wait_until_off();
    println!("SIG{signal}: {off:?}, time-out {time_out:?}");
    off.assert_by_time_out(time_out);
    controller.wait_until("shafts at rest", is_at_rest);
}

#[test]
fn a_killed_client_leaves_motors_that_stop_within_the_time_out() {
    dies_in_mid_motion("KILL", Duration::from_millis(1000));
}

#[test]
fn a_shorter_time_out_stops_them_sooner() {
    dies_in_mid_motion("KILL", Duration::from_millis(200));
}

#[test]
fn a_frozen_client_is_as_good_as_a_dead_one() {
    dies_in_mid_motion("STOP", Duration::from_millis(300));
}
