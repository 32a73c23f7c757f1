//! Nodes on a CAN bus behind an adapter, seen from the adapter's serial port.

use crate::controller::{Bus, Controller, ControllerConfig};
use brushwork_canopen::adapter::{Decoder, Form};
use brushwork_canopen::nmt::{Command, State};
use brushwork_canopen::sdo::{Abort, Progress, Transfer};
use brushwork_canopen::{Emergency, Frame, Function, NodeId};
use brushwork_mcp_wire::canopen::objects::{Shape, index_of, raw_of, record_subindex_of, shape, subindex_of};
use brushwork_mcp_wire::packet_serial::{
    COMMANDS, Direction, Generation, ReplyProgress, Request, number, parse_reply,
};
use brushwork_plant::machine::{Machine, StreamIndex};
use brushwork_plant::world::WorldAction;
use brushwork_values::{Field, Value};
use std::time::Duration;

const ONE: NodeId = NodeId::DEFAULT;

fn ms(milliseconds: u64) -> Duration {
    Duration::from_millis(milliseconds)
}

/// A bus and whoever sits at the adapter.
struct Bench {
    bus: Bus,
    form: Form,
    decoder: Decoder,
}

impl Bench {
    fn of(configs: Vec<ControllerConfig>, form: Form) -> Self {
        let units = configs.into_iter().map(|config| Controller::new(config).expect("the preset is valid"));
        let bus = Bus::on_can(units.collect(), form).expect("there is a unit");
        Self { bus, form, decoder: Decoder::new(form) }
    }

    fn new(generation: Generation) -> Self {
        Self::of(vec![ControllerConfig { generation, ..ControllerConfig::default() }], Form::Ascii)
    }

    fn send(&mut self, frame: &Frame) {
        let bytes = self.form.encode(frame).expect("a standard frame");
        self.bus.receive(StreamIndex::Usb, &bytes);
    }

    /// Lets time pass and gives back what came.
    fn wait(&mut self, time: Duration) -> Vec<Frame> {
        let to = self.bus.now() + time;
        self.bus.advance(to);
        let mut frames = Vec::new();
        while let Some(bytes) = self.bus.take_output(StreamIndex::Usb) {
            frames.extend(self.decoder.feed_all(&bytes));
        }
        frames
    }

    /// Runs an access to the node.
    fn run(&mut self, node: NodeId, mut transfer: Transfer) -> Result<Vec<u8>, Abort> {
        let mut request = transfer.begin();
        loop {
            self.send(&Frame::full(Function::SdoRequest(node).id(), request));
            let answers = self.wait(ms(5));
            let answer = answers.iter().find(|frame| frame.id() == Function::SdoResponse(node).id());
            match transfer.take(answer.expect("the node answers").bytes()) {
                Progress::Send(next) => request = next,
                Progress::Done(value) => return Ok(value),
                Progress::Refused(code) | Progress::GiveUp { code, .. } => return Err(code),
                Progress::Passed => panic!("an answer to something else"),
            }
        }
    }

    fn read(&mut self, index: u16, subindex: u8) -> Result<Vec<u8>, Abort> {
        self.run(ONE, Transfer::upload(index, subindex))
    }

    fn write(&mut self, index: u16, subindex: u8, value: &[u8]) -> Result<(), Abort> {
        self.run(ONE, Transfer::download(index, subindex, value)).map(drop)
    }

    fn raw(&mut self, command: u8, subindex: u8, field: &Field) -> i64 {
        let bytes = self.read(index_of(command), subindex).expect("it can be read");
        raw_of(field, &bytes).expect("it is as wide as the field")
    }

    fn duty(&self) -> f64 {
        self.bus.controllers()[0].view().axes[0].output.duty()
    }
}

#[test]
fn a_node_boots_and_beats_in_both_forms_of_adapter() {
    for form in Form::ALL {
        let mut bench = Bench::of(vec![ControllerConfig::default()], form);
        assert_eq!(bench.wait(ms(500)), [State::BootUp.heartbeat(ONE)], "{form:?}");
        assert_eq!(bench.wait(ms(3000)).len(), 3, "a heartbeat each second");
        assert_eq!(bench.read(0x2015, 1), Ok(b"MCP266 2x60A v1.0.0".to_vec()));
    }
}

#[test]
fn nmt_commands_change_the_state_that_the_heartbeat_says() {
    let mut bench = Bench::new(Generation::Gen1);
    bench.wait(ms(100));
    for (command, state) in [
        (Command::Start, State::Operational),
        (Command::EnterPreOperational, State::PreOperational),
        (Command::Stop, State::Stopped),
    ] {
        bench.send(&command.frame(None));
        assert_eq!(bench.wait(ms(1000)), [state.heartbeat(ONE)]);
    }
    bench.send(&Frame::full(Function::SdoRequest(ONE).id(), Transfer::upload(0x1000, 0).begin()));
    assert!(bench.wait(ms(20)).is_empty(), "a stopped node answers no SDO");
    bench.send(&Command::ResetNode.frame(Some(ONE)));
    assert_eq!(bench.wait(ms(100)), [State::BootUp.heartbeat(ONE)]);
    assert!(bench.read(0x1000, 0).is_ok());
}

#[test]
fn several_nodes_answer_each_to_their_own_id() {
    let mut configs = Vec::new();
    for id in [3, 5] {
        let mut settings = crate::settings::Settings::factory(ControllerConfig::default().model, 0x80);
        settings.unit.can_node_id = id;
        configs.push(ControllerConfig { settings: Some(settings), ..ControllerConfig::default() });
    }
    let mut bench = Bench::of(configs, Form::Ascii);
    let (three, five) = (NodeId::new(3).unwrap(), NodeId::new(5).unwrap());
    assert_eq!(bench.wait(ms(100)), [State::BootUp.heartbeat(three), State::BootUp.heartbeat(five)]);
    assert!(bench.run(three, Transfer::upload(0x1018, 1)).is_ok());
    assert!(bench.run(five, Transfer::upload(0x1018, 1)).is_ok());
}

/// Compares every command that can be read both ways, in every generation: the objects hold what packet serial says.
#[test]
fn every_object_holds_what_the_command_behind_it_reads() {
    let mut compared = 0;
    for generation in Generation::ALL {
        let mut bench = Bench::new(generation);
        let mut serial = super::support::Bench::new(generation);
        // Input signals come to rest.
        bench.wait(ms(2000));
        serial.wait(ms(2000));
        for row in COMMANDS {
            let Some(form) = row.form(generation).filter(|form| form.direction == Direction::Read) else {
                continue;
            };
            let Some(shape) = shape(form) else { continue };
            let request = Request::new(serial.address, row.number, &[]);
            let reply = serial.raw(&request.encode(generation).unwrap());
            let ReplyProgress::Done { values, .. } = parse_reply(&request, generation, &reply) else {
                assert!(bench.read(index_of(row.number), 0).is_err(), "{} answers nothing", row.key);
                continue;
            };
            compared += 1;
            match shape {
                Shape::Single(field) => {
                    assert_eq!(
                        Some(bench.raw(row.number, 0, field)),
                        values.try_int(field.name),
                        "{}",
                        row.key
                    );
                }
                Shape::Several(fields) => {
                    assert_eq!(bench.read(index_of(row.number), 0), Ok(vec![fields.len() as u8]));
                    for (at, field) in fields.iter().enumerate().filter(|(_, field)| field.name != "tick") {
                        let got = bench.raw(row.number, subindex_of(at), field);
                        assert_eq!(Some(got), values.try_int(field.name), "{} {}", row.key, field.name);
                    }
                }
                Shape::List(fields) => {
                    let records: Vec<_> = values.records().collect();
                    assert_eq!(
                        bench.read(index_of(row.number), 1),
                        Ok(vec![records.len() as u8]),
                        "{}",
                        row.key
                    );
                    for (number, record) in records.iter().enumerate() {
                        bench.write(index_of(row.number), 1, &[number as u8]).unwrap();
                        for (at, field) in fields.iter().enumerate() {
                            let got = bench.raw(row.number, record_subindex_of(at), field);
                            assert_eq!(
                                Some(got),
                                record.try_int(field.name),
                                "{} {number} {}",
                                row.key,
                                field.name
                            );
                        }
                    }
                }
                Shape::Text => {
                    let text = bench.read(index_of(row.number), 1).unwrap();
                    let reported = values.values().iter().find_map(|value| match value {
                        Value::Text(text) => Some(text.trim_end().to_owned()),
                        _ => None,
                    });
                    assert_eq!(String::from_utf8(text).unwrap().trim_end(), reported.unwrap());
                }
                Shape::Trigger => unreachable!("it is read"),
            }
        }
    }
    assert!(compared > 150, "only {compared} commands were compared");
}

#[test]
fn motion_acts_at_all_priority_levels_and_several_arguments_when_the_last_is_there() {
    let mut bench = Bench::new(Generation::Gen1);
    bench.bus.controllers_mut()[0].carry_out(number::SET_PRIORITIES, &[0, 0, 0]);
    bench.write(index_of(number::DUTY_M1), 0, &0x4000_i16.to_le_bytes()).unwrap();
    bench.wait(ms(200));
    assert!((bench.duty() - 0.5).abs() < 0.01, "Serial is in no level, CAN moves it all the same");
    // 54: duty 0 and the highest acceleration for both.
    let both = index_of(number::DUTY_ACCEL_BOTH);
    bench.write(both, 1, &0_i16.to_le_bytes()).unwrap();
    bench.write(both, 2, &655_359_u32.to_le_bytes()).unwrap();
    bench.write(both, 3, &0_i16.to_le_bytes()).unwrap();
    bench.wait(ms(100));
    assert!(bench.duty() > 0.4, "three of four arguments do nothing");
    bench.write(both, 4, &655_359_u32.to_le_bytes()).unwrap();
    bench.wait(ms(100));
    assert_eq!(bench.duty(), 0.0);
    assert_eq!(bench.write(both, 4, &[0; 4]), Err(Abort::DEVICE_STATE), "the other three are missing");
}

#[test]
fn what_is_wrong_with_an_access_is_said_by_its_code() {
    let mut bench = Bench::new(Generation::Gen1);
    for (index, subindex, code) in [
        (0x1234, 0, Abort::NO_OBJECT),
        (0x1018, 9, Abort::NO_SUBINDEX),
        (0x2018, 1, Abort::NO_SUBINDEX),
        (0x2020, 0, Abort::WRITE_ONLY),
        (index_of(number::ENTER_LOADER), 0, Abort::NO_OBJECT),
        (index_of(number::READ_ALL_STATUS), 1, Abort::NO_OBJECT),
    ] {
        assert_eq!(bench.read(index, subindex), Err(code), "{index:04X}:{subindex}");
    }
    for (index, value, code) in [
        (0x2018, &[1, 2][..], Abort::READ_ONLY),
        (0x2020, &[1], Abort::LENGTH),
        (0x1000, &[1], Abort::READ_ONLY),
        (0x1017, &[1], Abort::LENGTH),
        (index_of(number::RESET_ENCODERS), &[1], Abort::VALUE),
    ] {
        assert_eq!(bench.write(index, 0, value), Err(code), "{index:04X}");
    }
    assert_eq!(bench.write(index_of(number::RESET_ENCODERS), 0, &[0]), Ok(()));
}

#[test]
fn a_master_that_is_no_longer_heard_stops_the_motors_to_the_millisecond() {
    let mut bench = Bench::new(Generation::Gen1);
    bench.wait(ms(100));
    let master = NodeId::new(127).unwrap();
    // 1016:01: node 127 within 500 ms: 0x007F01F4.
    bench.write(0x1016, 1, &0x007F_01F4_u32.to_le_bytes()).unwrap();
    bench.write(index_of(number::DUTY_M1), 0, &0x4000_i16.to_le_bytes()).unwrap();
    for _ in 0..10 {
        bench.send(&State::Operational.heartbeat(master));
        let frames = bench.wait(ms(400));
        assert!(frames.iter().all(|frame| Emergency::read(frame).is_none()));
    }
    assert!(bench.duty() > 0.4);
    bench.wait(ms(99));
    assert!(bench.duty() > 0.4, "499 ms of silence are not too long");
    let frames = bench.wait(ms(20));
    let emergency = frames.iter().find_map(Emergency::read).expect("it says so");
    assert_eq!((emergency.code, emergency.register), (0x8130, 0x11));
    bench.wait(ms(100));
    assert_eq!(bench.duty(), 0.0);
    bench.send(&State::Operational.heartbeat(master));
    bench.wait(ms(100));
    assert_eq!(bench.duty(), 0.0, "the master's return brings no motion back");
}

#[test]
fn a_power_cycle_is_a_boot_up_and_another_node_id_counts_from_then_on() {
    let mut bench = Bench::new(Generation::Gen4);
    bench.wait(ms(100));
    bench.write(index_of(number::SET_NODE_ID), 0, &[9]).unwrap();
    let key = 0xE22E_AB7A_u32.to_le_bytes();
    bench.write(index_of(number::SAVE_SETTINGS), 0, &key).unwrap();
    bench.wait(ms(800));
    Machine::apply(&mut bench.bus, 0, &WorldAction::Power { on: false });
    assert!(bench.wait(ms(2500)).is_empty(), "nobody speaks without power");
    Machine::apply(&mut bench.bus, 0, &WorldAction::Power { on: true });
    assert_eq!(bench.wait(ms(100)), [State::BootUp.heartbeat(NodeId::new(9).unwrap())]);
}

#[test]
fn a_node_at_another_rate_hears_nothing_and_says_nothing() {
    let mut bench = Bench::new(Generation::Gen1);
    bench.wait(ms(100));
    let action = WorldAction::SetHidden { key: "can.rate".to_owned(), value: 125_000 };
    bench.bus.controllers_mut()[0].apply(&action).unwrap();
    bench.send(&Frame::full(Function::SdoRequest(ONE).id(), Transfer::upload(0x1000, 0).begin()));
    assert!(bench.wait(ms(5000)).is_empty());
}

#[test]
fn any_bytes_on_the_adapters_port_harm_nothing() {
    for form in Form::ALL {
        let mut bench = Bench::of(vec![ControllerConfig::default()], form);
        let mut state = 0x1234_5678_u32;
        for _ in 0..2000 {
            let bytes: Vec<u8> = (0..20)
                .map(|_| {
                    state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
                    (state >> 24) as u8
                })
                .collect();
            bench.bus.receive(StreamIndex::Usb, &bytes);
            // Frames of the node's own id too, with any content.
            if let Some(frame) = Frame::data(Function::SdoRequest(ONE).id(), &bytes[..8]) {
                bench.send(&frame);
            }
            bench.wait(Duration::from_micros(300));
        }
        // What is left of a frame is ended by the next one, which it may take with it.
        bench.send(&Frame::full(Function::SdoRequest(ONE).id(), Transfer::upload(0x1000, 0).begin()));
        bench.wait(ms(20));
        assert!(bench.read(0x1000, 0).is_ok(), "{form:?}");
    }
}
