//! Simulated controllers behind the server, spoken to in packet serial as a host program does.

use brushwork_mcp_sim::controller::{Bus, Controller, ControllerConfig, turnaround};
use brushwork_mcp_wire::packet_serial::{Address, Generation, ReplyProgress, Request, number, parse_reply};
use brushwork_plant::machine::{Machine, StreamIndex};
use brushwork_plant::pacing::{Paced, byte_time};
use brushwork_plant::server::{ChannelEnds, Endpoint, Server, ServerOptions, SimHandle};
use brushwork_plant::world::WorldAction;
use brushwork_values::Motor;
use std::time::{Duration, Instant};

const PATIENCE: Duration = Duration::from_secs(60);
const SILENCE: Duration = Duration::from_millis(200);
const ADDRESSES: [u8; 2] = [0x80, 0x85];

fn address(byte: u8) -> Address {
    Address::new(byte).expect("it is one of the eight")
}

/// Two units on the first TTL port.
fn bus() -> Bus {
    let units = ADDRESSES.map(|byte| {
        let config = ControllerConfig { address: address(byte), ..ControllerConfig::default() };
        Controller::new(config).expect("the default is valid")
    });
    Bus::new(units.into(), StreamIndex::Uart1).expect("TTL ports take several units")
}

fn serve(faults: &[&str]) -> (SimHandle<Bus>, ChannelEnds) {
    let faults = faults.iter().map(|text| text.parse().expect("the test's faults are valid")).collect();
    let options = ServerOptions { stream: StreamIndex::Uart1, faults, ..ServerOptions::default() };
    let handle = Server::spawn(bus(), options, &Endpoint::Channel).expect("channels need nothing");
    let client = handle.new_channel().expect("it is in-process");
    (handle, client)
}

fn bytes(to: u8, command: u8, values: &[i64]) -> Vec<u8> {
    Request::new(address(to), command, values)
        .encode(Generation::Gen1)
        .expect("the test's requests are valid")
}

/// Sends a request and waits for its reply, one message.
fn ask(client: &ChannelEnds, to: u8, command: u8, values: &[i64], patience: Duration) -> Option<Vec<u8>> {
    client.to_controller.send(bytes(to, command, values)).ok()?;
    client.from_controller.recv_timeout(patience).ok()
}

fn is_good(reply: &[u8], to: u8, command: u8) -> bool {
    let request = Request::new(address(to), command, &[]);
    matches!(parse_reply(&request, Generation::Gen1, reply), ReplyProgress::Done { used, .. } if used == reply.len())
}

#[test]
fn two_units_on_one_wire_answer_to_their_own_addresses_alone() {
    let (handle, client) = serve(&[]);
    for to in ADDRESSES {
        let reply = ask(&client, to, number::READ_VERSION, &[], PATIENCE).expect("it answers");
        assert!(is_good(&reply, to, number::READ_VERSION), "{reply:02X?}");
    }
    assert_eq!(ask(&client, 0x81, number::READ_VERSION, &[], SILENCE), None);
    assert_eq!(handle.views().len(), 2);
    let addresses = handle
        .inspect(|bus| bus.controllers().iter().map(|unit| unit.settings().unit.address).collect::<Vec<_>>())
        .expect("it runs");
    assert_eq!(addresses, ADDRESSES);
}

#[test]
fn a_unit_unplugged_from_a_shared_wire_leaves_the_other_one_there() {
    let (handle, client) = serve(&[]);
    handle.apply(1, WorldAction::Unplug { unplugged: true }).expect("it runs");
    // Actions queue behind each other, not behind bytes: this waits until the plug is out.
    assert!(handle.inspect(|bus| bus.views().iter().any(|view| !view.plugged)).expect("it runs"));
    assert_eq!(ask(&client, 0x85, number::READ_VERSION, &[], SILENCE), None);
    assert!(ask(&client, 0x80, number::READ_VERSION, &[], PATIENCE).is_some());
    handle.apply(0, WorldAction::Unplug { unplugged: true }).expect("it runs");
    assert!(client.from_controller.recv_timeout(PATIENCE).is_err(), "with nobody left the line is gone");
}

#[test]
fn faults_of_the_second_unit_stay_with_it() {
    let (handle, client) = serve(&["plant:locked-shaft,motor=1,unit=2"]);
    for to in ADDRESSES {
        let ack = ask(&client, to, number::DUTY_BOTH, &[8000, 8000], PATIENCE);
        assert_eq!(ack, Some(vec![0xFF]));
    }
    let begin = Instant::now();
    let moved = loop {
        let moved =
            handle.views().iter().map(|view| view.axes.map(|axis| axis.encoder_counts)).collect::<Vec<_>>();
        if moved.iter().flatten().filter(|counts| **counts > 20).count() >= 3 || begin.elapsed() > PATIENCE {
            break moved;
        }
        std::thread::sleep(Duration::from_millis(5));
    };
    assert_eq!(moved[1][Motor::M1.index()], 0, "{moved:?}");
    assert!(moved[0][0] > 20 && moved[0][1] > 20 && moved[1][1] > 20, "{moved:?}");
}

#[test]
fn a_paced_transaction_takes_its_bytes_and_the_stated_turnaround() {
    for (rate, generation) in [(115_200, Generation::Gen1), (38_400, Generation::Gen4)] {
        let config = ControllerConfig { generation, ..ControllerConfig::default() };
        let mut settings = Controller::new(config.clone()).expect("the default is valid").settings();
        settings.streams[StreamIndex::Uart0.index()].rate_bps = rate;
        let config = ControllerConfig { settings: Some(settings), ..config };
        let unit = Controller::new(config).expect("the default is valid");
        let mut line = Paced::new(Bus::single(unit, StreamIndex::Uart0), true);
        let start = Duration::from_millis(500);
        line.advance(start);
        let request = bytes(0x80, number::READ_MAIN_BATTERY, &[]);
        line.receive(StreamIndex::Uart0, &request);
        // Two bytes out, two of data and two of CRC back.
        let wire = byte_time(rate) * (2 + 4) + turnaround(StreamIndex::Uart0, rate);
        line.advance(start + wire - Duration::from_nanos(1));
        assert_eq!(line.take_output(StreamIndex::Uart0).map(|reply| reply.len()), Some(3), "{rate}");
        line.advance(start + wire);
        assert_eq!(line.take_output(StreamIndex::Uart0).map(|reply| reply.len()), Some(1), "{rate}");
    }
}
