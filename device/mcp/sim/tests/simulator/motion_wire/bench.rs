//! A controller on a table, spoken to over USB.

use brushwork_mcp_sim::controller::{Controller, ControllerConfig};
use brushwork_mcp_wire::crc::crc16_xmodem;
use brushwork_mcp_wire::packet_serial::Generation;
use brushwork_plant::AxisTruth;
use brushwork_plant::machine::StreamIndex;
use brushwork_plant::world::WorldAction;
use brushwork_values::Motor;
use std::time::Duration;

const ADDRESS: u8 = 0x80;
const POLL: Duration = Duration::from_millis(100);

/// Payload of a request, most significant byte first.
#[derive(Clone, Default)]
pub struct Payload(Vec<u8>);

impl Payload {
    pub fn new() -> Self {
        Payload::default()
    }

    pub fn u8(mut self, value: u8) -> Self {
        self.0.push(value);
        self
    }

    pub fn i16(mut self, value: i16) -> Self {
        self.0.extend(value.to_be_bytes());
        self
    }

    pub fn u32(mut self, value: u32) -> Self {
        self.0.extend(value.to_be_bytes());
        self
    }

    pub fn i32(mut self, value: i32) -> Self {
        self.0.extend(value.to_be_bytes());
        self
    }
}

/// Data of a reply, read from the front.
pub struct Reply(Vec<u8>);

impl Reply {
    fn take<const N: usize>(&mut self) -> [u8; N] {
        let rest = self.0.split_off(N.min(self.0.len()));
        let head = std::mem::replace(&mut self.0, rest);
        head.try_into().expect("the reply has the length that was asked for")
    }

    pub fn u8(&mut self) -> u8 {
        let [byte] = self.take();
        byte
    }

    pub fn u16(&mut self) -> u16 {
        u16::from_be_bytes(self.take())
    }

    pub fn i16(&mut self) -> i16 {
        i16::from_be_bytes(self.take())
    }

    pub fn u32(&mut self) -> u32 {
        u32::from_be_bytes(self.take())
    }

    pub fn i32(&mut self) -> i32 {
        i32::from_be_bytes(self.take())
    }
}

/// The controller.
pub struct Bench {
    pub unit: Controller,
}

impl Bench {
    /// An MCP266 of generation 1 with a small gearmotor on each channel.
    pub fn new() -> Self {
        Bench::of(Generation::Gen1)
    }

    pub fn of(generation: Generation) -> Self {
        Bench::with(ControllerConfig { generation, ..ControllerConfig::default() })
    }

    pub fn with(config: ControllerConfig) -> Self {
        let unit = Controller::new(config).expect("the configuration is valid");
        let mut bench = Bench { unit };
        bench.run_s(0.1);
        bench
    }

    /// Sends a command that is answered by 0xFF.
    pub fn write(&mut self, command: u8, payload: Payload) {
        let mut frame = vec![ADDRESS, command];
        frame.extend(payload.0);
        let crc = crc16_xmodem(&frame);
        frame.extend(crc.to_be_bytes());
        assert_eq!(self.exchange(&frame), [0xFF], "command {command}");
    }

    /// Asks and takes `length` bytes of data, CRC checked.
    pub fn read(&mut self, command: u8, length: usize) -> Reply {
        let request = [ADDRESS, command];
        let mut data = self.exchange(&request);
        assert_eq!(data.len(), length + 2, "command {command}: {data:02x?}");
        let crc = data.split_off(length);
        let covered: Vec<u8> = request.iter().chain(&data).copied().collect();
        assert_eq!(crc, crc16_xmodem(&covered).to_be_bytes(), "command {command}");
        Reply(data)
    }

    /// Lets time pass, with a reading now and then as a client would: a second of silence stops the motors (MCP manual 1.9.3).
    pub fn run_s(&mut self, seconds: f64) {
        let end = self.unit.now() + Duration::from_secs_f64(seconds);
        while self.unit.now() < end {
            self.read(24, 2);
            self.unit.advance(end.min(self.unit.now() + POLL));
        }
    }

    /// Seconds until `done`, asked every 2 ms.
    pub fn seconds_until(&mut self, mut done: impl FnMut(&mut Bench) -> bool) -> f64 {
        let start = self.unit.now();
        while !done(self) {
            self.run_s(0.002);
            assert!(self.unit.now() - start < Duration::from_secs(60), "not done within a minute");
        }
        (self.unit.now() - start).as_secs_f64()
    }

    pub fn apply(&mut self, action: &WorldAction) {
        self.unit.apply(action).expect("the action fits the model");
    }

    pub fn truth(&self, motor: Motor) -> AxisTruth {
        self.unit.world().truth(motor)
    }

    /// Raw duties, command 48.
    pub fn duties(&mut self) -> [i16; 2] {
        let mut reply = self.read(48, 4);
        [reply.i16(), reply.i16()]
    }

    /// Currents in 10 mA, command 49.
    pub fn currents(&mut self) -> [i16; 2] {
        let mut reply = self.read(49, 4);
        [reply.i16(), reply.i16()]
    }

    /// Encoder counts, command 78.
    pub fn counts(&mut self) -> [i32; 2] {
        let mut reply = self.read(78, 8);
        [reply.i32(), reply.i32()]
    }

    /// Buffer lengths, command 47.
    pub fn buffers(&mut self) -> [u8; 2] {
        let mut reply = self.read(47, 2);
        [reply.u8(), reply.u8()]
    }

    /// Signed speeds from magnitude and direction, commands 18 and 19.
    pub fn speeds(&mut self) -> [i32; 2] {
        [18, 19].map(|command| {
            let mut reply = self.read(command, 5);
            let magnitude = reply.i32();
            if reply.u8() == 0 { magnitude } else { -magnitude }
        })
    }

    /// Status word of generations 1 and 2, command 90.
    pub fn status(&mut self) -> u16 {
        self.read(90, 2).u16()
    }

    /// Velocity PID of both motors with the speed of the small gearmotor: commands 28 and 29, D, P, I, QPPS.
    pub fn tune_velocity(&mut self) {
        for command in [28, 29] {
            self.write(command, Payload::new().u32(0).u32(0x0001_0000).u32(0x0000_1000).u32(QPPS));
        }
    }

    fn exchange(&mut self, frame: &[u8]) -> Vec<u8> {
        self.unit.receive(StreamIndex::Usb, frame);
        let Some(at) = self.unit.next_output_at() else { return Vec::new() };
        self.unit.advance(at);
        self.unit.take_output(StreamIndex::Usb).unwrap_or_default()
    }
}

/// Counts per second of the small gearmotor at 100 %.
pub const QPPS: u32 = 10_650;
