//! Why the motors do not run: each cause as a state of the simulated controller, told by `brushwork status`.

use std::net::SocketAddr;
use std::process::Command;
use std::time::Duration;

use crate::causes::{self, Cause};
use crate::wait::PATIENCE;
use brushwork_child::{Child, ahead};
use brushwork_mcp_sim::controller::Bus;
use brushwork_plant::machine::{Machine as _, StreamIndex};
use brushwork_plant::server::{Endpoint, Server, ServerOptions};
use serde_json::Value;

/// What `brushwork status` says of a controller in the state of a cause.
fn status_of(cause: &Cause) -> Value {
    let endpoint = Endpoint::Tcp(SocketAddr::from(([127, 0, 0, 1], 0)));
    let mut bus = Bus::single(cause.controller(), StreamIndex::Usb);
    for action in &cause.actions {
        bus.apply(0, action);
    }
    bus.advance(Duration::from_secs(2));
    let served =
        ahead(|| Server::spawn(bus, ServerOptions::default(), &endpoint)).expect("loopback has a free port");
    let target = format!("tcp:{}", served.address().trim_start_matches("tcp:"));
    let mut command = Command::new(env!("CARGO_BIN_EXE_brushwork"));
    command.args(["status", "--json", "--connect", &target]);
    let output = Child::output(&command, b"", PATIENCE);
    serde_json::from_slice(&output.stdout).unwrap_or_else(|error| {
        panic!("{}: {error}: {}", cause.name, String::from_utf8_lossy(&output.stderr))
    })
}

#[test]
fn status_says_of_every_cause_what_is_so_and_what_to_do() {
    std::thread::scope(|scope| {
        for cause in causes::all() {
            scope.spawn(move || {
                let status = status_of(&cause);
                let findings = status["findings"].as_array().expect("a list").clone();
                let [what, cure] = cause.says;
                let found = findings.iter().any(|finding| {
                    let says = |key: &str, words: &str| {
                        finding[key].as_str().is_some_and(|text| text.contains(words))
                    };
                    says("what", what) && says("cure", cure)
                });
                assert!(found, "{}: {findings:#?}", cause.name);
                assert!(status["diagnosis"].as_str().is_some_and(|sentence| sentence.ends_with('.')));
                assert!(findings.len() <= 2, "{}: {findings:#?}", cause.name);
            });
        }
    });
}
