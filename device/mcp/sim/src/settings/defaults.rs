//! Factory settings (MCP manual 1.2.10, 1.9 and the command descriptions), by model.

use super::{
    BatterySettings, ControlInput, MotorRegisters, OutputSettings, RoboclawSettings, Settings, Shape,
    SignalSettings, StreamSettings, UnitSettings,
};
use crate::motion::MotionSettings;
use brushwork_mcp_wire::codes::ENCODER_PIN_NONE;
use brushwork_mcp_wire::models::{Family, Model};
use brushwork_mcp_wire::packet_serial::Address;
use brushwork_mcp_wire::roboclaw::ConfigWord;

/// Logic battery limits on the settings screens (MCP manual 1.2.10).
const LOGIC_MIN_TENTHS: u16 = 80;
const LOGIC_MAX_TENTHS: u16 = 150;
/// Time-outs on the settings screens (MCP manual 1.9).
const TIMEOUT_MS: u32 = 1000;
/// UART bit rate (MCP manual 1.9.5).
const MCP_RATE_BPS: u32 = 115_200;
/// UART bit rate of a RoboClaw (public clients, 2015-2025).
const ROBOCLAW_RATE_BPS: u32 = 38_400;
/// Dead band of the R/C and analog inputs, 2.5 % (RoboClaw manual 2018, command 76).
const DEADBAND: u8 = 25;
/// CANopen bit rate (MCP manual 1.9.4) and I2C bit rate (1.9.6).
const CAN_RATE_BPS: u32 = 250_000;
const I2C_RATE_BPS: u32 = 100_000;
/// Stream types of command 145.
const STREAM_PACKET_SERIAL: u8 = 1;
const STREAM_DISABLED: u8 = 2;
/// Signal type "encoder".
const KIND_ENCODER: u8 = 3;

impl Shape {
    /// The shape of a model's settings.
    pub fn of(model: &Model) -> Self {
        Self { signals: model.pins.len(), outputs: model.douts }
    }
}

impl Settings {
    /// What a unit of that model holds when it leaves the factory, with that address.
    pub fn factory(model: &Model, address: u8) -> Self {
        let shape = Shape::of(model);
        let centiamps = tenths_of(model.max_amps * 10.0);
        let motor = |index: u8| MotorRegisters {
            motion: MotionSettings {
                max_current_raw: centiamps.into(),
                min_current_raw: -i32::from(centiamps),
                ..MotionSettings::default()
            },
            encoder_mode: default_encoder(model, index + 1),
            ..MotorRegisters::default()
        };
        Self {
            unit: UnitSettings {
                address,
                config_word: match model.family {
                    Family::Mcp => 0,
                    Family::RoboClaw => {
                        let number = address.saturating_sub(Address::FIRST.get());
                        ConfigWord::packet_serial(number).0
                    }
                },
                ..UnitSettings::default()
            },
            battery: BatterySettings {
                main_min_tenths: tenths_of(model.main_volts.0),
                main_max_tenths: tenths_of(model.main_volts.1),
                logic_max_tenths: LOGIC_MAX_TENTHS.min(tenths_of(model.logic_volts.1)),
                ..BatterySettings::default()
            },
            motors: [motor(0), motor(1)],
            outputs: vec![OutputSettings::default(); shape.outputs],
            priority: [1, 2, 3],
            signals: model
                .pins
                .iter()
                .map(|pin| SignalSettings {
                    kind: if pin.encoder_channel().is_some() { KIND_ENCODER } else { 0 },
                    ..SignalSettings::default()
                })
                .collect(),
            streams: std::array::from_fn(|index| StreamSettings {
                kind: if model.stream_shares_encoder(index) { STREAM_DISABLED } else { STREAM_PACKET_SERIAL },
                rate_bps: match model.family {
                    Family::Mcp => MCP_RATE_BPS,
                    Family::RoboClaw => ROBOCLAW_RATE_BPS,
                },
                timeout_ms: match model.family {
                    Family::Mcp => TIMEOUT_MS,
                    Family::RoboClaw => 0,
                },
                ..StreamSettings::default()
            }),
            roboclaw: RoboclawSettings {
                inputs: [ControlInput {
                    reverse_deadband: DEADBAND,
                    forward_deadband: DEADBAND,
                    ..ControlInput::default()
                }; 2],
                ..RoboclawSettings::default()
            },
        }
    }
}

impl Default for UnitSettings {
    fn default() -> Self {
        Self {
            address: 0x80,
            mixed: 0,
            serial_timeout_tenths: 0,
            estop_lock: 0,
            script_autorun_ms: 0,
            can_node_id: 1,
            config_word: 0,
            serial_number: String::new(),
            bridged: false,
            can_rate_bps: CAN_RATE_BPS,
            i2c_rate_bps: I2C_RATE_BPS,
        }
    }
}

impl Default for BatterySettings {
    fn default() -> Self {
        Self {
            main_min_tenths: 100,
            main_max_tenths: 340,
            main_auto_offset_tenths: 0,
            logic_min_tenths: LOGIC_MIN_TENTHS,
            logic_max_tenths: LOGIC_MAX_TENTHS,
            main_offset_tenths: 0,
            logic_offset_tenths: 0,
        }
    }
}

impl Default for SignalSettings {
    fn default() -> Self {
        Self {
            kind: 0,
            mode: 0,
            target: 0,
            min_action: 0,
            max_action: 0,
            low_pass: 0,
            timeout_ms: TIMEOUT_MS,
            load_home: 0,
            min: 0,
            max: 4095,
            center: 2048,
            deadband: 0,
            power_exp_raw: 0,
            min_output: -32_767,
            max_output: 32_767,
            power_min: 0,
            potentiometer: 0,
            digital: false,
        }
    }
}

impl Default for StreamSettings {
    fn default() -> Self {
        Self { kind: 1, rate_bps: MCP_RATE_BPS, timeout_ms: TIMEOUT_MS, multi_unit: false }
    }
}

/// The signal index of a motor's own encoder, phase A. Assumed: a real unit may leave the factory with none.
fn default_encoder(model: &Model, motor_number: u8) -> u8 {
    let own = model.pins.iter().position(|pin| pin.encoder_channel() == Some((motor_number, 'A')));
    match model.family {
        Family::RoboClaw => 0,
        Family::Mcp => own.and_then(|index| u8::try_from(index).ok()).unwrap_or(ENCODER_PIN_NONE as u8),
    }
}

fn tenths_of(value: f64) -> u16 {
    (value * 10.0).round() as u16
}
