//! The command line on a CANopen bus: simulated nodes behind an adapter on a TCP port, and in the program itself.
#![cfg(unix)]

use crate::cli::{Run, program, run};
use brushwork_canopen::NodeId;
use brushwork_canopen::adapter::Form;
use brushwork_child::ahead;
use brushwork_mcp_sim::controller::{Bus, Controller, ControllerConfig};
use brushwork_plant::server::{Endpoint, Server, ServerOptions, SimHandle};
use serde_json::{Value, json};
use std::io::Write as _;
use std::net::TcpStream;

fn brushwork(arguments: &[&str]) -> Run {
    run(program().args(arguments))
}

/// Where the adapter is reached.
fn place(server: &SimHandle<Bus>) -> &str {
    server.address().trim_start_matches("tcp:")
}

/// Nodes behind an adapter, as somebody else's program would run them.
fn served(form: Form, nodes: &[u8]) -> (SimHandle<Bus>, String) {
    let units = nodes.iter().map(|id| {
        let mut config = ControllerConfig::default();
        config.set_node(NodeId::new(*id).expect("a node id"));
        Controller::new(config).expect("the preset is valid")
    });
    let bus = Bus::on_can(units.collect(), form).expect("there are units");
    let endpoint = Endpoint::Tcp("127.0.0.1:0".parse().expect("it is an address"));
    let server =
        ahead(|| Server::spawn(bus, ServerOptions::default(), &endpoint)).expect("loopback has a free port");
    let target = format!("can:tcp:{},form={}", place(&server), form.key());
    (server, target)
}

#[test]
fn nodes_behind_either_form_of_adapter_are_listed_with_their_identity() {
    for form in Form::ALL {
        let (_server, target) = served(form, &[3, 17]);
        let run = brushwork(&["nodes", "--json", "--connect", &target]);
        assert_eq!(run.code, 0, "{run:?}");
        let json: Value = serde_json::from_str(&run.stdout).unwrap();
        let ids: Vec<_> = json["nodes"].as_array().unwrap().iter().map(|node| node["node"].clone()).collect();
        assert_eq!(ids, [3, 17], "{form:?}");
        let who = json!({ "kind": "controller", "text": "MCP266 2x60A v1.0.0" });
        assert_eq!((&json["nodes"][0]["who"], &json["nodes"][0]["state"]), (&who, &json!("pre_operational")));
    }
}

#[test]
fn the_wrong_form_of_adapter_and_a_node_that_is_not_there_are_told() {
    let (server, _target) = served(Form::Ascii, &[3]);
    let adapter = format!("tcp:{}", place(&server));
    let run = brushwork(&["nodes", "--connect", &format!("can:{adapter},form=binary")]);
    assert_eq!(run.code, 3, "{run:?}");
    assert!(run.stderr.contains("no node of the bus answered"), "{run:?}");
    let run = brushwork(&["status", "--connect", &format!("can:{adapter},node=9")]);
    assert_eq!(run.code, 3, "{run:?}");
    assert!(run.stderr.contains("node 9 did not answer"), "{run:?}");
}

#[test]
fn settings_are_written_over_can_and_a_drive_is_refused_with_its_reason() {
    let (server, target) = served(Form::Ascii, &[3]);
    let node = format!("{target},node=3");
    let run = brushwork(&["settings", "write", "-c", &node, "motor1.velocity.qpps=12345", "--yes"]);
    assert_eq!(run.code, 0, "{run:?}");
    let qpps = server.inspect(|bus| bus.controllers()[0].settings().motors[0].motion.qpps).unwrap();
    assert_eq!(qpps, 12_345);
    let run = brushwork(&["drive", "-c", &node, "--duty", "20", "--for", "0.5"]);
    assert_eq!(run.code, 4, "{run:?}");
    assert!(run.stderr.contains("over CANopen the controller has no time-out"), "{run:?}");
}

#[test]
fn a_node_simulated_in_the_program_drives() {
    let run = brushwork(&["drive", "-c", "sim:mcp266,can,node=5", "--duty", "20", "--for", "0.5"]);
    assert_eq!(run.code, 0, "{run:?}");
    assert!(run.stdout.contains("20.0 %"), "{run:?}");
}

#[test]
fn firmware_is_not_updated_over_can() {
    let folder = tempfile::tempdir().unwrap();
    let image = folder.path().join("new.bin").display().to_string();
    assert_eq!(brushwork(&["firmware", "image", &image]).code, 0);
    let run = brushwork(&["firmware", "update", &image, "-c", "sim:mcp266,can", "--accept-risk"]);
    assert_eq!(run.code, 4, "{run:?}");
    assert!(run.stderr.contains("connect over USB"), "{run:?}");
}

#[test]
fn a_stopped_node_is_listed_with_what_to_do_and_started_when_that_is_asked_for() {
    let (server, target) = served(Form::Ascii, &[3]);
    TcpStream::connect(place(&server)).unwrap().write_all(b":S000N0203;").unwrap();
    let run = brushwork(&["status", "--connect", &format!("{target},node=3")]);
    assert_eq!(run.code, 3, "{run:?}");
    assert!(run.stderr.contains("node 3 is stopped") && run.stderr.contains("nodes --start 3"), "{run:?}");
    let run = brushwork(&["nodes", "--connect", &target]);
    assert_eq!(run.code, 3, "{run:?}");
    assert!(run.stdout.contains("stopped: it answers nothing until it is started"), "{run:?}");
    let run = brushwork(&["nodes", "--start", "3", "--connect", &target]);
    assert_eq!(run.code, 0, "{run:?}");
    assert!(run.stderr.contains("node 3 says that it is operational"), "{run:?}");
    assert!(run.stdout.contains("operational") && run.stdout.contains("MCP266 2x60A v1.0.0"), "{run:?}");
    drop(server);
}

#[test]
fn nodes_of_other_makers_and_doubled_numbers_are_listed() {
    let (server, target) = served(Form::Ascii, &[3, 4, 4]);
    server.inspect(|bus| bus.add_other_node(NodeId::new(9).unwrap())).unwrap();
    let run = brushwork(&["nodes", "--connect", &target]);
    assert_eq!(run.code, 4, "{run:?}");
    assert!(run.stdout.contains("another device (Another drive): never written to"), "{run:?}");
    assert!(run.stdout.contains("several devices answer as this node"), "{run:?}");
    let written = server.inspect(|bus| bus.other_nodes()[0].written().len()).unwrap();
    assert_eq!(written, 0);
}
