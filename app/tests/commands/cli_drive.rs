//! `brushwork drive` as a script runs it: what its exit code says of the motion.
#![cfg(unix)]

use crate::cli::{REFUSED, program, run};
use brushwork_child::ahead;
use brushwork_mcp_sim::controller::{Bus, Controller, ControllerConfig};
use brushwork_plant::machine::StreamIndex;
use brushwork_plant::server::{Endpoint, Server, ServerOptions};
use brushwork_plant::world::WorldAction;
use brushwork_values::Motor;

#[test]
fn a_motor_that_is_held_ends_it_with_4_and_a_sentence() {
    let unit = Controller::new(ControllerConfig::default()).expect("the preset is valid");
    let server = ahead(|| {
        Server::spawn(
            Bus::single(unit, StreamIndex::Usb),
            ServerOptions::default(),
            &Endpoint::Tcp("127.0.0.1:0".parse().expect("it is an address")),
        )
    })
    .expect("loopback has a free port");
    server.apply(0, WorldAction::LockShaft { motor: Motor::M1, on: true }).expect("it runs");
    // A loop gives all it has to a motor that is held, which no friction explains.
    let words = [
        "drive",
        "--connect",
        &format!("tcp:{},stream=usb", server.address().trim_start_matches("tcp:")),
        "--motor",
        "1",
        "--speed",
        "3000",
        "--for",
        "60",
    ];
    let driven = run(program().args(words)).ended_with(REFUSED).explains("blocked");
    assert!(!driven.stderr.contains("Cut the motor power"), "the stop was confirmed: {driven:?}");
}
