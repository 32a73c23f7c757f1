//! How much faster than real time a simulated controller runs with both motors in closed loop.
//!
//! `cargo test --release -p brushwork-mcp-sim --test simulator speed:: -- --nocapture` prints the figure; an unoptimised build is not held to it.

use brushwork_mcp_sim::controller::{Bus, Controller, ControllerConfig};
use brushwork_mcp_wire::packet_serial::{Address, Generation, Request, number};
use brushwork_plant::machine::{Machine, StreamIndex};
use brushwork_script::{image, mcl};
use std::time::{Duration, Instant};

/// Simulated time per run.
const SIMULATED: Duration = Duration::from_secs(60);
/// Times real time that the simulator must reach.
const REQUIRED: f64 = 500.0;

/// It never pauses: it counts, reads registers, and drives both motors and says something ten times a second.
const SCRIPT: &str = "count var long\nsum var long\nnext_at var long\nspeed2 3000,20000,-2000,20000\nmain\n\
    count = count+1\nsum = sum+(count*3 & 0xFF)\nif MOTORENCPOS(0) > 1000000000 then main\nif SYSTICK < next_at then main\n\
    next_at = SYSTICK+100\nspeed2 3000,20000,-2000,20000\nputs 3,[dec count,13]\ngoto main\n";

#[test]
fn with_a_script_that_never_pauses_it_is_still_500_times() {
    let unit = Controller::new(ControllerConfig::default()).expect("the preset is valid");
    let mut bus = Bus::single(unit, StreamIndex::Usb);
    let program = mcl::compile(SCRIPT).program.expect("the script is in order");
    bus.controllers_mut()[0].install_script(&image::encode(&program));
    let start = Request::new(Address::DEFAULT, number::START_SCRIPT, &[]);
    let bytes = start.encode(Generation::Gen1).expect("a known command");
    assert_eq!(bus.exchange(&bytes, Duration::from_millis(10)), [0xff]);
    let started = Instant::now();
    bus.advance(SIMULATED);
    let factor = SIMULATED.as_secs_f64() / started.elapsed().as_secs_f64();
    println!("{factor:.0} times real time with a script that never pauses");
    let unit = bus.controllers()[0].unit().expect("it has power");
    let executed = unit.script().expect("it runs").executed();
    assert!(unit.script_is_running() && executed > 5_000_000, "{executed} instructions in a minute");
    if !cfg!(debug_assertions) {
        assert!(factor >= REQUIRED, "{factor:.0} times real time");
    }
}

#[test]
fn both_motors_in_closed_loop_run_at_least_500_times_faster_than_real_time() {
    let mut config = ControllerConfig::default();
    let mut settings = Controller::new(config.clone()).expect("the preset is valid").settings();
    settings.streams[0].timeout_ms = 0;
    config.settings = Some(settings);
    config.seed = 7;
    let unit = Controller::new(config).expect("the preset is valid");
    let mut bus = Bus::single(unit, StreamIndex::Usb);
    let request = Request::new(Address::DEFAULT, number::SPEED_ACCEL_BOTH, &[20_000, 3_000, -2_000]);
    let bytes = request.encode(Generation::Gen1).expect("a known command");
    assert_eq!(bus.exchange(&bytes, Duration::from_millis(10)), [0xff]);

    let started = Instant::now();
    bus.advance(SIMULATED);
    let factor = SIMULATED.as_secs_f64() / started.elapsed().as_secs_f64();
    println!("{factor:.0} times real time with both motors in closed loop");

    let channel = |motor| bus.controllers()[0].unit().expect("it has power").channel(motor).speeds().filtered;
    assert!(channel(brushwork_values::Motor::M1) > 1_000, "motor 1 must be running");
    if !cfg!(debug_assertions) {
        assert!(factor >= REQUIRED, "{factor:.0} times real time");
    }
}
