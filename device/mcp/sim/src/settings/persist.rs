//! The byte layout of the settings in EEPROM: one function per group serves both directions.

use super::{
    BatterySettings, ControlInput, MotorRegisters, OutputSettings, RoboclawSettings, Settings, Shape,
    SignalSettings, StreamSettings, UnitSettings,
};
use crate::motion::MotionSettings;

/// First bytes of a valid image; anything else reads as an empty EEPROM, which loads the defaults.
const MAGIC: u32 = 0x4d43_5031;

/// Room for a text: a serial number of 36 letters, or of 18 that take three bytes each.
const TEXT_BYTES: usize = 54;

/// Settings as bytes, in the order in which the EEPROM holds them.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Image(pub Vec<u8>);

impl Image {
    /// The image of `settings`.
    pub fn of(settings: &Settings) -> Self {
        let mut writer = Writer(Vec::with_capacity(2048));
        writer.u32(&mut { MAGIC });
        settings.clone().visit(&mut writer);
        Self(writer.0)
    }

    /// The settings this image holds for a unit of that shape, or `None` when it holds none.
    ///
    /// The shape must be the one the image was written for.
    pub fn settings(&self, shape: Shape, defaults: Settings) -> Option<Settings> {
        let mut reader = Reader { bytes: &self.0, at: 0 };
        let mut magic = 0;
        reader.u32(&mut magic);
        if magic != MAGIC {
            return None;
        }
        let mut settings = defaults;
        settings.signals.resize_with(shape.signals, SignalSettings::default);
        settings.outputs.resize_with(shape.outputs, OutputSettings::default);
        settings.visit(&mut reader);
        Some(settings)
    }
}

/// A group of settings that can be written to and read from an image.
pub trait Persist {
    /// Hands every field to the visitor, always in the same order.
    fn visit(&mut self, visitor: &mut dyn Visitor);
}

/// One direction of the layout: writing takes the fields, reading fills them. Numbers are big-endian.
pub trait Visitor {
    /// A run of bytes.
    fn bytes(&mut self, field: &mut [u8]);

    /// One byte.
    fn u8(&mut self, field: &mut u8) {
        let mut raw = [*field];
        self.bytes(&mut raw);
        *field = raw[0];
    }

    /// One signed byte.
    fn i8(&mut self, field: &mut i8) {
        let mut raw = field.to_be_bytes();
        self.bytes(&mut raw);
        *field = i8::from_be_bytes(raw);
    }

    /// A flag in one byte.
    fn flag(&mut self, field: &mut bool) {
        let mut raw = [u8::from(*field)];
        self.bytes(&mut raw);
        *field = raw[0] != 0;
    }

    /// Text in a place of fixed size; what does not fit is cut off.
    fn text(&mut self, field: &mut String) {
        let mut raw = [0; TEXT_BYTES];
        for (to, from) in raw.iter_mut().zip(field.bytes()) {
            *to = from;
        }
        self.bytes(&mut raw);
        let end = raw.iter().position(|byte| *byte == 0).unwrap_or(raw.len());
        *field = String::from_utf8_lossy(&raw[..end]).into_owned();
    }

    /// Two bytes.
    fn u16(&mut self, field: &mut u16) {
        let mut raw = field.to_be_bytes();
        self.bytes(&mut raw);
        *field = u16::from_be_bytes(raw);
    }

    /// Four bytes.
    fn u32(&mut self, field: &mut u32) {
        let mut raw = field.to_be_bytes();
        self.bytes(&mut raw);
        *field = u32::from_be_bytes(raw);
    }

    /// Four signed bytes.
    fn i32(&mut self, field: &mut i32) {
        let mut raw = field.to_be_bytes();
        self.bytes(&mut raw);
        *field = i32::from_be_bytes(raw);
    }
}

struct Writer(Vec<u8>);

impl Visitor for Writer {
    fn bytes(&mut self, field: &mut [u8]) {
        self.0.extend_from_slice(field);
    }
}

struct Reader<'a> {
    bytes: &'a [u8],
    at: usize,
}

impl Visitor for Reader<'_> {
    /// Leaves the field as it is when the image is too short.
    fn bytes(&mut self, field: &mut [u8]) {
        let end = self.at + field.len();
        if let Some(stored) = self.bytes.get(self.at..end) {
            field.copy_from_slice(stored);
        }
        self.at = end;
    }
}

impl Persist for Settings {
    fn visit(&mut self, visitor: &mut dyn Visitor) {
        self.unit.visit(visitor);
        self.battery.visit(visitor);
        for motor in &mut self.motors {
            motor.visit(visitor);
        }
        for output in &mut self.outputs {
            output.visit(visitor);
        }
        visitor.bytes(&mut self.priority);
        for stream in &mut self.streams {
            stream.visit(visitor);
        }
        self.roboclaw.visit(visitor);
        for signal in &mut self.signals {
            signal.visit(visitor);
        }
    }
}

impl Persist for UnitSettings {
    fn visit(&mut self, visitor: &mut dyn Visitor) {
        visitor.u8(&mut self.address);
        visitor.u8(&mut self.mixed);
        visitor.u8(&mut self.serial_timeout_tenths);
        visitor.u8(&mut self.estop_lock);
        visitor.u32(&mut self.script_autorun_ms);
        visitor.u8(&mut self.can_node_id);
        visitor.u16(&mut self.config_word);
        visitor.text(&mut self.serial_number);
        visitor.flag(&mut self.bridged);
        visitor.u32(&mut self.can_rate_bps);
        visitor.u32(&mut self.i2c_rate_bps);
    }
}

impl Persist for BatterySettings {
    fn visit(&mut self, visitor: &mut dyn Visitor) {
        visitor.u16(&mut self.main_min_tenths);
        visitor.u16(&mut self.main_max_tenths);
        visitor.u8(&mut self.main_auto_offset_tenths);
        visitor.u16(&mut self.logic_min_tenths);
        visitor.u16(&mut self.logic_max_tenths);
        visitor.i8(&mut self.main_offset_tenths);
        visitor.i8(&mut self.logic_offset_tenths);
    }
}

impl Persist for MotorRegisters {
    fn visit(&mut self, visitor: &mut dyn Visitor) {
        self.motion.visit(visitor);
        visitor.u8(&mut self.pwm_mode);
        visitor.u8(&mut self.encoder_mode);
        visitor.u16(&mut self.homing_duty_raw);
        visitor.u32(&mut self.homing_timeout_ticks);
    }
}

impl Persist for MotionSettings {
    fn visit(&mut self, visitor: &mut dyn Visitor) {
        visitor.u32(&mut self.velocity_p_raw);
        visitor.u32(&mut self.velocity_i_raw);
        visitor.u32(&mut self.velocity_d_raw);
        visitor.u32(&mut self.qpps);
        visitor.u32(&mut self.position_p_raw);
        visitor.u32(&mut self.position_i_raw);
        visitor.u32(&mut self.position_d_raw);
        visitor.u32(&mut self.position_max_i);
        visitor.u32(&mut self.position_deadzone_counts);
        visitor.i32(&mut self.position_min_counts);
        visitor.i32(&mut self.position_max_counts);
        visitor.u32(&mut self.default_accel_raw);
        visitor.u32(&mut self.default_decel_raw);
        visitor.u16(&mut self.default_speed_raw);
        visitor.u32(&mut self.inductance_raw);
        visitor.u32(&mut self.resistance_raw);
        visitor.u32(&mut self.max_current_raw);
        visitor.i32(&mut self.min_current_raw);
        visitor.u32(&mut self.speed_error_limit);
        visitor.u32(&mut self.position_error_limit);
        visitor.u8(&mut self.pwm_idle_raw);
    }
}

impl Persist for OutputSettings {
    fn visit(&mut self, visitor: &mut dyn Visitor) {
        visitor.u8(&mut self.action);
        visitor.flag(&mut self.inverted);
    }
}

impl Persist for SignalSettings {
    fn visit(&mut self, visitor: &mut dyn Visitor) {
        visitor.u8(&mut self.kind);
        visitor.u8(&mut self.mode);
        visitor.u8(&mut self.target);
        visitor.u16(&mut self.min_action);
        visitor.u16(&mut self.max_action);
        visitor.u8(&mut self.low_pass);
        visitor.u32(&mut self.timeout_ms);
        visitor.i32(&mut self.load_home);
        visitor.i32(&mut self.min);
        visitor.i32(&mut self.max);
        visitor.i32(&mut self.center);
        visitor.u32(&mut self.deadband);
        visitor.i32(&mut self.power_exp_raw);
        visitor.i32(&mut self.min_output);
        visitor.i32(&mut self.max_output);
        visitor.u32(&mut self.power_min);
        visitor.u32(&mut self.potentiometer);
        visitor.flag(&mut self.digital);
    }
}

impl Persist for StreamSettings {
    fn visit(&mut self, visitor: &mut dyn Visitor) {
        visitor.u8(&mut self.kind);
        visitor.u32(&mut self.rate_bps);
        visitor.u32(&mut self.timeout_ms);
        visitor.flag(&mut self.multi_unit);
    }
}

impl Persist for RoboclawSettings {
    fn visit(&mut self, visitor: &mut dyn Visitor) {
        visitor.bytes(&mut self.pin_functions);
        for input in &mut self.inputs {
            input.visit(visitor);
        }
        visitor.bytes(&mut self.control_modes);
        for duty in &mut self.control_duties {
            visitor.u16(duty);
        }
        for limit in &mut self.control_limits {
            visitor.u16(limit);
        }
    }
}

impl Persist for ControlInput {
    fn visit(&mut self, visitor: &mut dyn Visitor) {
        visitor.u8(&mut self.reverse_deadband);
        visitor.u8(&mut self.forward_deadband);
        visitor.u16(&mut self.reverse_limit);
        visitor.u16(&mut self.forward_limit);
        visitor.u16(&mut self.center);
        visitor.u16(&mut self.min);
        visitor.u16(&mut self.max);
    }
}
