//! The firmware of one unit: everything that a power cycle starts anew, and what one tick does.

use super::can::Can;
use super::config::{ControllerConfig, FirmwareOptions};
use super::control::{Control, follow_rate};
use super::loader::Loader;
use super::memory::Memory;
use super::pins::PinFunctions;
use super::readings::Readings;
use super::script::ScriptState;
use crate::motion::{BridgeOverride, Channel, Conditions, Measured, Mixer, MotionCommand, MotionSettings};
use crate::priority::Source;
use crate::settings::{Image, Settings};
use crate::signals::{Signal, Triggers};
use crate::supervision::{DetectedBattery, EStop, Protection};
use brushwork_mcp_wire::models::{Family, Model};
use brushwork_mcp_wire::packet_serial::{Address, Generation};
use brushwork_mcp_wire::roboclaw::{ControlMode, ENCODER_MOTOR_REVERSED};
use brushwork_plant::bridge::BridgeOutput;
use brushwork_plant::machine::StreamIndex;
use brushwork_plant::world::Leds;
use brushwork_plant::world::{BridgeSense, UnitFault, World};
use brushwork_values::Motor;
use std::time::Duration;

/// The running firmware. Private to the controller, which hands out what may be looked at.
#[derive(Clone, Debug)]
pub(super) struct Firmware {
    pub model: &'static Model,
    pub generation: Generation,
    pub options: FirmwareOptions,
    pub factory_address: Address,
    /// What survives without power.
    pub memory: Memory,
    /// Settings in RAM.
    pub settings: Settings,
    pub channels: [Channel; 2],
    pub pins: Vec<PinFunctions>,
    pub signals: Vec<Signal>,
    /// What quadrature encoders on the pins have counted.
    pub counts: Vec<i64>,
    pub readings: Readings,
    pub protection: Protection,
    /// What automatic detection found at start-up, where it is on.
    pub battery: Option<DetectedBattery>,
    /// Something was wrong at start-up.
    pub boot_warning: bool,
    pub estop: EStop,
    /// What the inputs' actions ask for at this tick.
    pub triggers: Triggers,
    /// Motors whose direction a reverse action has turned round.
    pub reversed: [bool; 2],
    /// Loop errors that stopped a motor.
    pub loop_faults: [LoopFaults; 2],
    /// Whether the E-stop button hangs on an input pin.
    pub estop_is_on_a_pin: bool,
    /// Whether the emergency stop or a latched error holds the motors.
    pub is_held: bool,
    pub ports: PortActivity,
    /// What a RoboClaw does by its pins and its configuration word.
    pub control: Control,
    /// Which kind of input commands the motors, and its level.
    pub source: Option<(usize, Source)>,
    /// What signals last told the motors, so that the same is not told again.
    pub steered: [Option<MotionCommand>; 2],
    /// Duties of the compatibility commands 8 to 13.
    pub mixer: Mixer,
    pub script: ScriptState,
    pub can: Can,
    /// Whether the command that is being carried out came over the CAN bus, whose functions act at all priority levels.
    pub from_can: bool,
    /// Duties of commands 102 and 104.
    pub auxiliary_duties: [u16; 5],
    /// The firmware loader, once command 255 has been taken.
    pub loader: Option<Loader>,
    pub leds: Leds,
    pub outputs: Vec<bool>,
    /// Outputs that a script has set, which overrides their actions.
    pub overrides: Vec<Option<bool>>,
    /// Whether the host holds the USB port's RTS line.
    pub rts: bool,
    pub is_first_tick: bool,
    pub booted_at: Duration,
    pub now: Duration,
}

/// Which error limits of commands 109 and 112 stopped a motor.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct LoopFaults {
    pub speed: bool,
    pub position: bool,
}

/// When bytes came in.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct PortActivity {
    /// Last byte of each stream.
    pub last_bytes: [Option<Duration>; 5],
    /// The serial time-out of command 14 has stopped the motors since the last byte.
    pub timed_out: bool,
}

impl Firmware {
    /// Starts up: settings come from EEPROM, everything else is as after a reset.
    pub fn boot(config: &ControllerConfig, memory: Memory, readings: Readings, now: Duration) -> Self {
        let mut settings = memory.load(config.model, config.address);
        if config.model.family == Family::RoboClaw {
            follow_rate(&mut settings);
        }
        Self {
            model: config.model,
            generation: config.generation,
            options: config.options.clone(),
            factory_address: config.address,
            channels: [Channel::new(&config.law), Channel::new(&config.law)],
            pins: config.model.pins.iter().copied().map(PinFunctions::of).collect(),
            counts: vec![0; settings.signals.len()],
            signals: vec![Signal::default(); settings.signals.len()],
            readings,
            protection: Protection::default(),
            battery: readings.detects_battery.then(|| DetectedBattery::of(readings.main_volts)),
            boot_warning: readings.unit_faults.has(UnitFault::Boot),
            estop: EStop::default(),
            triggers: Triggers::default(),
            reversed: [false; 2],
            loop_faults: [LoopFaults::default(); 2],
            estop_is_on_a_pin: config.world.wiring.estop_pin.is_some(),
            is_held: false,
            ports: PortActivity::default(),
            control: Control::boot(settings.unit.config_word, readings.main_volts),
            source: None,
            steered: [None; 2],
            mixer: Mixer::default(),
            script: ScriptState::default(),
            can: Can::default(),
            from_can: false,
            auxiliary_duties: [0; 5],
            loader: (!memory.flash.is_whole()).then(|| Loader::new(config.model.family)),
            leds: Leds::default(),
            outputs: vec![false; settings.outputs.len()],
            overrides: vec![None; settings.outputs.len()],
            rts: false,
            is_first_tick: true,
            booted_at: now,
            now,
            memory,
            settings,
        }
    }

    /// One control tick: measure, look after the limits, find out who commands, run the loops.
    pub fn tick(&mut self, world: &mut World, now: Duration) {
        self.now = now;
        self.memory.eeprom.advance(now);
        self.readings = Readings::take(world);
        self.turn_readings_round();
        self.rts = world.rts();
        self.update_signals(world);
        if self.is_roboclaw() {
            self.update_control_pins(world);
        }
        self.update_protection();
        self.update_source();
        if self.is_roboclaw() {
            self.run_homing();
            self.steer_by_inputs(world);
        } else {
            self.steer_by_signals();
        }
        self.run_channels();
        if self.loader.is_none() {
            let up_for = self.up_for();
            self.script.autorun(self.settings.unit.script_autorun_ms, up_for, &self.memory.script);
        }
        self.update_outputs(world);
    }

    /// What a bridge does from a tick on. Bridged, motor 2's leads drive nothing of their own.
    pub fn output(&self, motor: Motor) -> BridgeOutput {
        if self.is_idle(motor) {
            return BridgeOutput::Coast;
        }
        self.turned_round(motor, self.channels[motor.index()].output())
    }

    /// What a bridge does in the midst of a tick.
    pub fn refine(&mut self, motor: Motor, sense: BridgeSense) -> BridgeOutput {
        if self.is_idle(motor) {
            return BridgeOutput::Coast;
        }
        let amps = if self.is_motor_reversed(motor) { -sense.amps } else { sense.amps };
        let output = self.channels[motor.index()].refine(amps, sense.bus_volts, sense.step_s);
        self.turned_round(motor, output)
    }

    /// Whether a RoboClaw is told to turn a motor the other way round (RoboClaw manual 2018, command 92).
    fn is_motor_reversed(&self, motor: Motor) -> bool {
        self.is_roboclaw() && self.settings.motors[motor.index()].encoder_mode & ENCODER_MOTOR_REVERSED != 0
    }

    fn turned_round(&self, motor: Motor, output: BridgeOutput) -> BridgeOutput {
        match output {
            BridgeOutput::Duty(duty) if self.is_motor_reversed(motor) => BridgeOutput::Duty(-duty),
            BridgeOutput::Duty(_) | BridgeOutput::Brake | BridgeOutput::Coast => output,
        }
    }

    /// Currents count along the way that the motor is told to turn.
    fn turn_readings_round(&mut self) {
        for motor in Motor::BOTH {
            if self.is_motor_reversed(motor) {
                self.readings.amps[motor.index()] *= -1.0;
            }
        }
    }

    /// A byte has come on a stream.
    pub fn note_byte(&mut self, stream: StreamIndex, now: Duration) {
        self.ports.last_bytes[stream.index()] = Some(now);
        self.ports.timed_out = false;
    }

    /// Whether a stream takes packets: not while it belongs to a script or is disabled (command 145), but for the USB port whose RTS line
    /// the host holds (MCP manual 1.9.3).
    pub fn speaks_packet_serial(&self, stream: StreamIndex) -> bool {
        const PACKET_SERIAL: u8 = 1;
        if self.is_roboclaw()
            && stream != StreamIndex::Usb
            && self.control.mode() != ControlMode::PacketSerial
        {
            return false;
        }
        let is_forced = stream == StreamIndex::Usb && self.rts;
        is_forced || self.settings.streams[stream.index()].kind == PACKET_SERIAL
    }

    /// Writes the settings to EEPROM (command 94); that takes its time.
    pub fn save_settings(&mut self) {
        self.memory.eeprom.begin_save(&Image::of(&self.settings), self.now);
    }

    /// Takes the settings back from EEPROM (command 95).
    pub fn reload_settings(&mut self) {
        let before = self.settings.streams.clone();
        self.settings = self.memory.load(self.model, self.factory_address);
        self.keep_rates(&before);
    }

    /// Time since power up.
    pub fn up_for(&self) -> Duration {
        self.now.saturating_sub(self.booted_at)
    }

    /// Whether both bridges drive one motor (MCP manual 1.8).
    pub fn is_bridged(&self) -> bool {
        self.settings.unit.bridged && self.model.family == Family::Mcp
    }

    /// The settings a channel runs with. Bridged, the current limits of both bridges add up.
    pub fn motion_settings(&self, motor: Motor) -> MotionSettings {
        let mut motion = self.settings.motors[motor.index()].motion;
        if self.is_bridged() {
            motion.max_current_raw = motion.max_current_raw.saturating_mul(2);
            motion.min_current_raw = motion.min_current_raw.saturating_mul(2);
        }
        motion
    }

    /// Gives a command to a channel, whoever it comes from. A fault stops any further action until it is over (MCP manual 1.6.2).
    pub fn command(&mut self, motor: Motor, command: MotionCommand) {
        let stops = matches!(command, MotionCommand::SafeStop | MotionCommand::Coast);
        if self.drives_nothing(motor) || (self.is_held && !stops) {
            return;
        }
        self.control.end_homing();
        self.reversed[motor.index()] = false;
        self.script.drives[motor.index()] = false;
        self.loop_faults[motor.index()] = LoopFaults::default();
        let settings = self.motion_settings(motor);
        // A refused command is acknowledged like any other; the wire has no word for it.
        let _ = self.channels[motor.index()].command(command, &settings);
    }

    /// Stops both motors at the highest deceleration and empties their buffers.
    pub fn stop_both(&mut self) {
        self.mixer = Mixer::default();
        for motor in Motor::BOTH {
            self.command(motor, MotionCommand::SafeStop);
        }
    }

    /// The same for motors that the running script does not drive: the source that commanded the others has gone silent.
    pub fn stop_what_no_script_drives(&mut self) {
        self.mixer = Mixer::default();
        let is_running = self.script.is_running();
        for motor in Motor::BOTH {
            if !is_running || !self.script.drives[motor.index()] {
                self.command(motor, MotionCommand::SafeStop);
            }
        }
    }

    fn is_idle(&self, motor: Motor) -> bool {
        self.loader.is_some() || self.drives_nothing(motor)
    }

    /// Whether a motor has no bridge of its own: bridged, or on a board of one channel. Assumed: such a board acknowledges commands
    /// for motor 2.
    pub fn drives_nothing(&self, motor: Motor) -> bool {
        motor == Motor::M2 && (self.is_bridged() || self.model.motors == 1)
    }

    fn run_channels(&mut self) {
        let share = self.current_limit_share();
        let bridge = self.bridge_override();
        for motor in Motor::BOTH {
            let index = motor.index();
            let held = self.triggers.motors[index];
            let conditions = Conditions {
                safe_stop: held.safe_stop,
                off: held.off,
                reverse: self.reversed[index],
                forward_limit: held.forward_limit,
                backward_limit: held.backward_limit,
                bridge: if self.loader.is_some() { BridgeOverride::Freewheel } else { bridge },
                current_limit_share: share,
            };
            let measured = Measured {
                encoder: self.readings.encoders[index],
                current_amps: self.readings.amps[index],
                bus_volts: self.readings.main_volts,
            };
            let settings = self.motion_settings(motor);
            self.channels[index].tick(&measured, &conditions, &settings);
            if self.is_first_tick {
                // Counters start at zero, wherever the shaft is.
                self.channels[index].encoder_mut().set(0);
            }
        }
        self.is_first_tick = false;
    }
}
