//! Simulated boards on a wire, asked in the lines of their manual.

use std::time::Duration;

use crate::{SuprMotr, SuprMotrBus, SuprMotrConfig, pin};
use brushwork_plant::machine::{Machine, StreamIndex};
use brushwork_plant::world::{PinSignal, WorldAction};
use brushwork_suprmotr_wire::{Address, Status};

/// Longer than any report takes, echo and reply together.
const PATIENCE: Duration = Duration::from_millis(3);

/// Boards on a wire.
pub struct Bench {
    pub bus: SuprMotrBus,
}

impl Bench {
    /// Board 0, selected, its echo off.
    pub fn new() -> Self {
        Self::of(SuprMotrConfig::new(Address::FACTORY))
    }

    pub fn of(config: SuprMotrConfig) -> Self {
        let mut bench = Self::line(vec![config]);
        bench.raw(b"\x010EF\r");
        bench
    }

    /// Boards as they are after power-up.
    pub fn line(configs: Vec<SuprMotrConfig>) -> Self {
        let units = configs.into_iter().map(|config| SuprMotr::new(config).expect("the slide is sound"));
        let mut bus = SuprMotrBus::new(units.collect());
        bus.advance(Duration::from_millis(1));
        Self { bus }
    }

    pub fn unit(&self) -> &SuprMotr {
        &self.bus.suprmotrs()[0]
    }

    /// Goes on by so many milliseconds.
    pub fn ms(&mut self, milliseconds: u64) {
        let to = self.bus.now() + Duration::from_millis(milliseconds);
        self.bus.advance(to);
    }

    /// What comes back for bytes within 3 ms.
    pub fn raw(&mut self, bytes: &[u8]) -> String {
        let reply = self.bus.exchange(bytes, PATIENCE);
        reply.into_iter().map(char::from).collect()
    }

    /// What comes back for a line.
    pub fn ask(&mut self, line: &str) -> String {
        self.raw(format!("{line}\r").as_bytes())
    }

    /// A line that nothing comes back for.
    pub fn tell(&mut self, line: &str) {
        assert_eq!(self.ask(line), "", "{line}");
    }

    /// A line, and not a millisecond gone.
    pub fn begin(&mut self, line: &str) {
        self.bus.receive(StreamIndex::Usb, format!("{line}\r").as_bytes());
    }

    /// The number that a line reports.
    pub fn number(&mut self, line: &str) -> i64 {
        number_in(&self.ask(line))
    }

    /// The status by its single character, which ends no macro.
    pub fn status(&mut self) -> Status {
        let reply = self.raw(b"%");
        let (_, bytes) = reply.trim_end_matches("\r\n\u{3}").split_once(':').expect("a status");
        let bytes: Vec<u8> =
            bytes.split(' ').map(|byte| u8::from_str_radix(byte, 16).expect("hexadecimal")).collect();
        Status::from_bytes(&bytes).expect("six bytes")
    }

    /// Goes on until the trajectory is complete, and says how long that took, in milliseconds.
    pub fn until_complete(&mut self) -> u64 {
        self.until(SuprMotr::is_motion_complete)
    }

    /// Goes on until something holds, and says how long that took, in milliseconds.
    pub fn until(&mut self, holds: impl Fn(&SuprMotr) -> bool) -> u64 {
        let mut took = 0;
        while !holds(self.unit()) {
            self.ms(1);
            took += 1;
            assert!(took < 100_000, "it never comes to that");
        }
        took
    }

    pub fn volts(&mut self, pin: usize, volts: f64) {
        self.bus.apply(0, &WorldAction::SetPin { pin, signal: PinSignal::Volts { volts } });
        // The next tick sees it.
        self.ms(1);
    }

    /// Puts 5 V on a channel, counted from 1, or 0 V.
    pub fn channel(&mut self, channel: usize, is_on: bool) {
        self.volts(pin::CHANNEL_1 + channel - 1, if is_on { 5.0 } else { 0.0 });
    }

    pub fn power_cycle(&mut self) {
        self.bus.apply(0, &WorldAction::Power { on: false });
        self.ms(1_000);
        self.bus.apply(0, &WorldAction::Power { on: true });
        self.ms(150);
    }
}

/// The number in a report.
pub fn number_in(report: &str) -> i64 {
    let (_, number) = report.trim_end_matches("\r\n\u{3}").split_once(':').expect("a report");
    number.trim().parse().expect("a number")
}
