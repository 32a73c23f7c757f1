//! One simulated Motion Mind on a wire, asked through the bytes of its manual; shared by the tests of the family.
#![allow(dead_code, reason = "each test file uses a part of it")]

use std::time::Duration;

use brushwork_motion_mind_sim::{Mode, MotionMind, MotionMindBus, MotionMindConfig, pin};
use brushwork_motion_mind_wire::{
    Address, Command, Progress, Reply, Returns, encode_frame, parse_frame_reply, register_named,
};
use brushwork_plant::machine::Machine;
use brushwork_plant::world::{PinSignal, WorldAction};

pub const PATIENCE: Duration = Duration::from_millis(100);
pub const UNIT_1: Address = Address::FACTORY;

/// One unit on a wire, asked in frames.
pub struct Bench {
    pub bus: MotionMindBus,
}

impl Bench {
    pub fn new(mode: Mode) -> Self {
        Self::of(MotionMindConfig::new(mode))
    }

    pub fn of(config: MotionMindConfig) -> Self {
        Self { bus: MotionMindBus::new(vec![MotionMind::new(config).expect("the preset is sound")]) }
    }

    pub fn unit(&self) -> &MotionMind {
        &self.bus.motion_minds()[0]
    }

    pub fn run(&mut self, for_how_long: Duration) {
        let to = self.bus.now() + for_how_long;
        self.bus.advance(to);
    }

    pub fn seconds(&mut self, seconds: f64) {
        self.run(Duration::from_secs_f64(seconds));
    }

    /// Bytes that come back for bytes.
    pub fn raw(&mut self, bytes: &[u8]) -> Vec<u8> {
        let reply = self.bus.exchange(bytes, PATIENCE);
        self.run(Duration::from_millis(6));
        reply
    }

    pub fn tell(&mut self, command: Command) {
        let frame = encode_frame(UNIT_1, &command).expect("it has a binary form");
        let reply = self.raw(&frame);
        let returns = Returns::of_function(u16::try_from(self.get("FUNCTION")).expect("16 bits"));
        match parse_frame_reply(UNIT_1, &command, returns, &reply) {
            Progress::Done { reply: Reply::Acknowledged | Reply::Returned(_), .. } => {}
            other => panic!("{command:?}: {other:?}"),
        }
    }

    pub fn set(&mut self, name: &str, value: i64) {
        let register = register_named(name).expect("the register exists").number;
        self.tell(Command::Write { register, value });
    }

    pub fn store(&mut self, name: &str, value: i64) {
        let register = register_named(name).expect("the register exists").number;
        self.tell(Command::WriteStore { register, value });
    }

    /// A register as the wire tells it.
    pub fn ask(&mut self, name: &str) -> i64 {
        let register = register_named(name).expect("the register exists");
        let command = Command::ReadRegister(register.number);
        let reply = self.raw(&encode_frame(UNIT_1, &command).expect("it has a binary form"));
        match parse_frame_reply(UNIT_1, &command, Returns::default(), &reply) {
            Progress::Done { reply: Reply::Registers(values), .. } => values[0].1,
            other => panic!("{name}: {other:?}"),
        }
    }

    /// A register as the unit has it.
    pub fn get(&self, name: &str) -> i64 {
        self.unit().read_one(register_named(name).expect("the register exists").number)
    }

    pub fn pin(&mut self, pin: usize, signal: PinSignal) {
        self.bus.apply(0, &WorldAction::SetPin { pin, signal });
    }

    pub fn volts(&mut self, pin: usize, volts: f64) {
        self.pin(pin, PinSignal::Volts { volts });
    }

    pub fn pulse(&mut self, milliseconds: f64) {
        self.pin(pin::INDEX_RC, PinSignal::Pulse { microseconds: milliseconds * 1000.0 });
    }

    pub fn power_cycle(&mut self) {
        self.bus.apply(0, &WorldAction::Power { on: false });
        self.seconds(1.0);
        self.bus.apply(0, &WorldAction::Power { on: true });
        // Its light blinks up to eight times first.
        self.seconds(4.0);
    }
}

/// A unit in mode 4 with gains that hold the default motor.
pub fn positioner() -> Bench {
    let mut bench = Bench::new(Mode::SerialPid);
    bench.set("PTERM", 20_000);
    bench.set("ITERM", 0);
    bench.set("DTERM", 40_000);
    bench.set("PIDSCALAR", 11);
    bench
}
