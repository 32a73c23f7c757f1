//! One unit on its machine: power, bytes, ticks and answers.

use super::answer::{Answer, REFUSED, find};
use super::config::ControllerConfig;
use super::firmware::Firmware;
use super::loader::{Flash, LoaderStep};
use super::memory::Memory;
use super::port::{Port, turnaround};
use super::readings::Readings;
use super::unit_view::UnitView;
use crate::motion::ControlLaw;
use crate::settings::{Eeprom, Settings, UnknownKey};
use brushwork_mcp_wire::packet_serial::{ACK, Framed, encode_reply, encode_reply_named};
use brushwork_plant::ParamsError;
use brushwork_plant::bridge::BridgeOutput;
use brushwork_plant::machine::StreamIndex;
use brushwork_plant::world::{World, WorldAction, WorldParams, WorldView};
use brushwork_script::debug::{Debugger, StopCause};
use std::time::Duration;

/// Supply voltage below which the logic gives up. Assumed.
const BROWN_OUT_VOLTS: f64 = 5.0;

/// One simulated controller with its machine.
#[derive(Clone, Debug)]
pub struct Controller {
    pub(super) config: ControllerConfig,
    pub(super) law: ControlLaw,
    pub(super) world: World,
    /// The running firmware; none while the unit has no power.
    pub(super) firmware: Option<Firmware>,
    /// What is kept while it does not run.
    pub(super) memory: Memory,
    pub(super) ports: [Port; 5],
    /// Time on the wire, which never stands still.
    pub(super) now: Duration,
    /// How much of that the unit and its world stood still, because somebody looked at a paused script.
    pub(super) frozen_for: Duration,
    pub(super) ticks: u64,
    /// Keeps its breakpoints over power cycles.
    pub(super) debugger: Debugger,
}

impl Controller {
    /// A controller that has just been switched on, at time zero, with its machine at rest.
    ///
    /// # Errors
    /// If an axis cannot be built from its parameters.
    pub fn new(config: ControllerConfig) -> Result<Self, ParamsError> {
        let params = WorldParams { pins: config.model.wired_pins(), ..config.world.clone() };
        let world = World::new(&params, config.seed)?;
        let memory = Memory::holding(&config.stored_settings());
        let mut controller = Self {
            law: config.law.repaired(),
            ports: std::array::from_fn(|_| Port::new(config.generation, config.model.family)),
            config,
            world,
            firmware: None,
            memory,
            now: Duration::ZERO,
            frozen_for: Duration::ZERO,
            ticks: 0,
            debugger: Debugger::default(),
        };
        controller.follow_power();
        Ok(controller)
    }

    /// What it was made of.
    pub fn config(&self) -> &ControllerConfig {
        &self.config
    }

    /// Time since its start.
    pub fn now(&self) -> Duration {
        self.now
    }

    /// Takes bytes that arrive now.
    pub fn receive(&mut self, stream: StreamIndex, bytes: &[u8]) {
        if !self.world.plugged() {
            return;
        }
        for byte in bytes {
            self.receive_byte(stream, *byte);
        }
    }

    /// Moves time on to `to`, tick by tick. A time that is past changes nothing.
    pub fn advance(&mut self, to: Duration) {
        while !self.is_frozen() {
            let next = self.law.tick_at(self.ticks + 1);
            if next > to.saturating_sub(self.frozen_for) {
                self.run_script(to.saturating_sub(self.frozen_for));
                self.now = self.now.max(to);
                return;
            }
            self.run_script(next);
            self.run_tick(next);
        }
        self.stand_still(to);
    }

    /// When the next reply leaves, on whichever stream.
    pub fn next_output_at(&self) -> Option<Duration> {
        self.ports.iter().filter_map(Port::next_output_at).min()
    }

    /// Takes the next reply on a stream if it has left by now. Each call gives one write.
    pub fn take_output(&mut self, stream: StreamIndex) -> Option<Vec<u8>> {
        self.ports[stream.index()].take_output(self.now)
    }

    /// Does something to the machine or to the unit's power, plug and hidden settings.
    ///
    /// # Errors
    /// If a hidden setting is named that this model does not have; nothing is changed then.
    pub fn apply(&mut self, action: &WorldAction) -> Result<(), UnknownKey> {
        if let WorldAction::SetHidden { key, value } = action {
            return match &mut self.firmware {
                Some(firmware) => firmware.settings.set_hidden(key, *value),
                None => Ok(()),
            };
        }
        if let WorldAction::SendCan { bytes } = action {
            self.world.can_line.send(bytes, self.unit_now());
        }
        self.world.apply(action);
        self.follow_power();
        if !self.world.plugged() {
            self.ports.iter_mut().for_each(Port::reset);
        }
        if let Some(firmware) = &mut self.firmware {
            firmware.readings.estop_pressed = self.world.estop_pressed();
            firmware.rts = self.world.rts();
            firmware.update_estop();
        }
        Ok(())
    }

    /// The machine as it is now.
    pub fn view(&self) -> WorldView {
        let leds = self.firmware.as_ref().map(|firmware| firmware.leds);
        let script = self.unit().map(|unit| unit.script_view());
        WorldView { leds, script, ..self.world.view(self.unit_now()) }
    }

    /// The machine.
    pub fn world(&self) -> &World {
        &self.world
    }

    /// What the firmware has found and decided; `None` without power.
    pub fn unit(&self) -> Option<UnitView<'_>> {
        self.firmware.as_ref().map(|firmware| UnitView::new(firmware, &self.debugger))
    }

    /// The settings in RAM; without power those that a start would load.
    pub fn settings(&self) -> Settings {
        match &self.firmware {
            Some(firmware) => firmware.settings.clone(),
            None => self.memory.load(self.config.model, self.config.address),
        }
    }

    /// The rate a stream is set to.
    pub fn bits_per_second(&self, stream: StreamIndex) -> u32 {
        match &self.firmware {
            Some(firmware) => firmware.settings.streams[stream.index()].rate_bps,
            None => self.settings().streams[stream.index()].rate_bps,
        }
    }

    /// The EEPROM.
    pub fn eeprom(&self) -> &Eeprom {
        match &self.firmware {
            Some(firmware) => &firmware.memory.eeprom,
            None => &self.memory.eeprom,
        }
    }

    /// The settings that the EEPROM holds.
    pub fn stored_settings(&self) -> Settings {
        let memory = self.firmware.as_ref().map_or(&self.memory, |firmware| &firmware.memory);
        memory.load(self.config.model, self.config.address)
    }

    /// The script image in flash memory as far as it was written.
    pub fn script_image(&self) -> &[u8] {
        let memory = self.firmware.as_ref().map_or(&self.memory, |firmware| &firmware.memory);
        memory.script.image()
    }

    /// Stores a script image past the wire, as if it had been downloaded. A script that runs is stopped.
    pub fn install_script(&mut self, image: &[u8]) {
        match &mut self.firmware {
            Some(firmware) => {
                firmware.script.stop_for(StopCause::NewImage);
                firmware.memory.script.install(image);
            }
            None => self.memory.script.install(image),
        }
    }

    /// The flash memory of the firmware.
    pub fn flash(&self) -> &Flash {
        self.firmware.as_ref().map_or(&self.memory.flash, |firmware| &firmware.memory.flash)
    }

    /// How long a stream waits before it answers.
    pub fn turnaround(&self, stream: StreamIndex) -> Duration {
        turnaround(stream, self.bits_per_second(stream))
    }

    fn run_tick(&mut self, at: Duration) {
        // Always the same length, so that the machine's step is worked out once; ticks in whole nanoseconds differ by one.
        let dt_s = self.law.tick_s();
        self.ticks += 1;
        self.now = self.now.max(at + self.frozen_for);
        match &mut self.firmware {
            Some(firmware) => {
                let mut is_first = [true; 2];
                self.world.advance_with(dt_s, |motor, sense| {
                    let first = std::mem::take(&mut is_first[motor.index()]);
                    if first { firmware.output(motor) } else { firmware.refine(motor, sense) }
                });
            }
            None => self.world.advance([BridgeOutput::Coast; 2], dt_s),
        }
        self.follow_power();
        if let Some(firmware) = &mut self.firmware {
            firmware.tick(&mut self.world, at);
        }
    }

    /// Starts the firmware when there is power and stops it when there is none.
    fn follow_power(&mut self) {
        let supply_volts = self.world.bus_volts().max(self.world.logic_volts());
        let has_power = self.world.powered() && supply_volts > BROWN_OUT_VOLTS;
        match (&self.firmware, has_power) {
            (None, true) if !matches!(self.memory.flash, Flash::Dead) => self.boot(),
            (Some(_), false) => self.shut_down(),
            _ => {}
        }
    }

    fn boot(&mut self) {
        if let Some(image) = self.memory.flash.installed() {
            self.config.options.version = Some(image.version);
            self.config.generation = image.generation;
            self.ports = std::array::from_fn(|_| Port::new(image.generation, self.config.model.family));
        }
        let readings = Readings::take(&mut self.world);
        let firmware = Firmware::boot(&self.config, self.memory.clone(), readings, self.unit_now());
        self.firmware = Some(firmware);
    }

    fn shut_down(&mut self) {
        if let Some(firmware) = self.firmware.take() {
            self.memory = firmware.memory;
            self.memory.eeprom.cut_power();
            self.memory.flash.cut_power(self.unit_now());
        }
        self.ports.iter_mut().for_each(Port::reset);
    }

    fn receive_byte(&mut self, stream: StreamIndex, byte: u8) {
        let unit_now = self.unit_now();
        let Some(firmware) = &mut self.firmware else {
            return;
        };
        firmware.note_byte(stream, unit_now);
        if let Some(loader) = &mut firmware.loader {
            let step = loader.feed(byte, unit_now, &mut firmware.memory.flash);
            self.load(stream, step);
        } else if firmware.hears_simple_serial(stream) {
            firmware.take_simple_serial(byte);
        } else if !firmware.speaks_packet_serial(stream) {
            firmware.hear_for_script(stream, byte, unit_now);
        } else if let Some(framed) = self.ports[stream.index()].feed(byte, self.now) {
            self.answer(stream, &framed);
        }
    }

    fn load(&mut self, stream: StreamIndex, step: LoaderStep) {
        match step {
            LoaderStep::Wait => {}
            LoaderStep::Answer { byte, after } => self.send(stream, vec![byte], after),
            LoaderStep::Restart => {
                self.shut_down();
                self.follow_power();
            }
        }
    }

    fn answer(&mut self, stream: StreamIndex, framed: &Framed) {
        let unit_now = self.unit_now();
        let Some(firmware) = &mut self.firmware else {
            return;
        };
        if stream != StreamIndex::Usb && framed.address.get() != firmware.settings.unit.address {
            return;
        }
        let command = framed.command.number;
        if self.config.quirks.silent.contains(&command) {
            return;
        }
        // The bytes of this very request may have made Serial the commanding source.
        firmware.now = unit_now;
        firmware.update_source();
        let answer = firmware.execute(framed);
        let request = framed.request();
        let generation = self.config.quirks.layouts.get(&command).copied().unwrap_or(self.config.generation);
        let reply = match &answer {
            Answer::Silence => return,
            Answer::Ack => encode_reply(&request, generation, &[]),
            Answer::Data(fields) => encode_reply_named(&request, generation, |name| find(fields, name)),
            Answer::AckThenStatus { .. } => Ok(vec![ACK]),
            Answer::Refused => Ok(vec![REFUSED]),
        };
        // A reply that does not fit the table is a mistake of a handler; a test over all commands keeps it from happening.
        debug_assert!(reply.is_ok(), "{}: {reply:?}", framed.command.key);
        let delay = self.config.quirks.delay_of(command);
        self.send(stream, reply.unwrap_or_default(), delay);
        if let Answer::AckThenStatus { status, after } = answer {
            self.send(stream, vec![status], after + delay);
        }
    }

    fn send(&mut self, stream: StreamIndex, bytes: Vec<u8>, after: Duration) {
        let due = self.now + self.turnaround(stream) + after;
        if !bytes.is_empty() {
            self.ports[stream.index()].send(bytes, due);
        }
    }
}
