//! One motor: current limits, encoder, gains, travel, acceleration, error limits, homing (MCP manual 1.2.10
//! to 1.2.13).

use brushwork_mcp_wire::models::Family;
use brushwork_mcp_wire::packet_serial::{number, scale};
use brushwork_mcp_wire::roboclaw::{ENCODER_KINDS, IDLE_MODES};
use brushwork_values::Unit;

use crate::settings::rows::scales::{
    AMPS, DECISECONDS, DUTY_ACCEL, GEN1, GEN2, GEN3, GEN4, I32_STEPS, POSITION_GAIN, U32_STEPS,
    VELOCITY_GAIN, steps_of,
};
use crate::settings::template::{DefaultValue, Form, Limits, Template, at, motor, settings};
use brushwork_link::settings::Coding;
use brushwork_link::settings::Group;

pub(crate) static ROWS: &[Template] = settings! {
    motor("motor{n}.current.max_amps", "Maximum current", Group::CURRENT_LIMITS)
        .fixed(Unit::Amps, AMPS, 2, Limits::Amps).default(DefaultValue::Highest);
        [Form::field(READ_CURRENT_LIMITS, SET_CURRENT_LIMITS, &["max"])]
        "The most current the motor may draw; power is cut back to hold it. Set it to what the motor \
         stands. MCP manual 1.2.10, command 133.";
    motor("motor{n}.current.min_amps", "Minimum current", Group::CURRENT_LIMITS)
        .fixed(Unit::Amps, MIN_AMPS, 2, Limits::NegativeAmps).default(DefaultValue::Lowest);
        [Form::field(READ_CURRENT_LIMITS, SET_CURRENT_LIMITS, &["min"]).only(GEN1, GEN2),
         Form::field(READ_CURRENT_LIMITS, SET_CURRENT_LIMITS, &["min"]).only(GEN3, GEN4)
            .with_coding(MIN_AMPS_MAGNITUDE)]
        "The most current the motor may push back into the battery while it brakes, as a negative number. \
         MCP manual 1.2.10, command 133.";
    motor("motor{n}.encoder.pin", "Encoder input number", Group::ENCODERS)
        .int(Unit::None, Limits::Steps(0, 255)).assumed_default(DefaultValue::EncoderPin)
        .only_on(Family::Mcp);
        [Form::field(READ_ENCODERS, SET_ENCODER, &["mode_m1", "mode_m2"]).writing(&["mode"])
            .simulated_only(PIN_NUMBERS)]
        "The number of the input signal that serves as this motor's encoder. Which number stands for \
         which pin is not published. MCP manual 1.2.10, command 92.";
    encoder("motor{n}.encoder.kind", "Encoder").choice(ENCODER_KINDS)
        .assumed_default(DefaultValue::Key("quadrature"));
        [encoder_bits(0, 1)]
        "A quadrature encoder counts lines; an absolute one is a voltage. RoboClaw manual 2018, command 92, bit \
         0.";
    encoder("motor{n}.encoder.motor_reversed", "Motor reversed").assumed_default(DefaultValue::Bool(false));
        [encoder_bits(5, 1)]
        "The motor turns the other way round. Together with the encoder it turns a whole axis round; alone it \
         makes a loop with the right wiring run away. RoboClaw manual 2018, command 92, bit 5.";
    encoder("motor{n}.encoder.reversed", "Encoder reversed").assumed_default(DefaultValue::Bool(false));
        [encoder_bits(6, 1)]
        "The encoder counts the other way round, so that its two lines need not be changed over. RoboClaw \
         manual 2018, command 92, bit 6.";
    encoder("motor{n}.encoder.in_rc", "Encoder in R/C and analog mode").assumed_default(DefaultValue::Bool(false));
        [encoder_bits(7, 1)]
        "R/C and analog inputs command speed, or position where the motor has a position loop, instead of \
         duty. RoboClaw manual 2018, command 92, bit 7.";
    encoder("motor{n}.encoder.other_bits", "Encoder mode, bits 1 to 4").int(Unit::None, Limits::Steps(0, 15))
        .assumed_default(DefaultValue::Int(0));
        [encoder_bits(1, 4)]
        "What these bits do is not published. Leave them as they are. Command 92.";
    encoder("motor{n}.encoder.mode", "Encoder mode").int(Unit::Bits, Limits::Steps(0, 255))
        .assumed_default(DefaultValue::Int(0));
        [Form::read_only(at(READ_ENCODERS, &["mode_m1", "mode_m2"]), "The mode as a whole is shown for \
         comparison; change its parts above.")]
        "All of the encoder's settings in one number. Command 91.";
    motor("motor{n}.inductance_henries", "L", Group::MOTOR)
        .fixed(Unit::Henries, INDUCTANCE_RESISTANCE, 6, U32_STEPS)
        .assumed_default(DefaultValue::Number(0.0));
        [Form::field(READ_L_R, SET_L_R, &["inductance"])]
        "Inductance of the motor winding. Together with a resistance other than 0 it turns duty commands \
         into current (torque) commands. MCP manual 1.2.11, command 128.";
    motor("motor{n}.resistance_ohms", "R", Group::MOTOR)
        .fixed(Unit::Ohms, INDUCTANCE_RESISTANCE, 3, U32_STEPS).assumed_default(DefaultValue::Number(0.0));
        [Form::field(READ_L_R, SET_L_R, &["resistance"])]
        "Resistance of the motor winding and its leads. Together with an inductance other than 0 it turns \
         duty commands into current (torque) commands. MCP manual 1.2.11, command 128.";
    motor("motor{n}.default_accel", "Default duty acceleration", Group::MOTOR)
        .fixed(Unit::PercentPerSecond, DUTY_ACCEL, 0, Limits::Steps(0, scale::MAX_DUTY_ACCEL_RAW))
        .assumed_default(DefaultValue::Number(ACCEL_DEFAULT_PERCENT_PER_S));
        [Form::field(READ_DEFAULT_ACCELS, SET_DEFAULT_ACCEL, &["accel_m1", "accel_m2"]).writing(&["accel"])]
        "How fast the duty rises for duty commands without an acceleration of their own, and for pulse \
         and analog inputs. 2000 %/s goes from full backward to full forward in 100 ms. MCP manual 2.4.9, \
         command 68.";
    motor("motor{n}.default_decel", "Default duty deceleration", Group::MOTOR)
        .fixed(Unit::PercentPerSecond, DUTY_ACCEL, 0, Limits::Steps(0, scale::MAX_DUTY_ACCEL_RAW))
        .assumed_default(DefaultValue::Number(ACCEL_DEFAULT_PERCENT_PER_S));
        [Form::field(READ_DEFAULT_ACCELS, SET_DEFAULT_ACCEL, &["decel_m1", "decel_m2"]).only(GEN2, GEN4)
            .writing(&["decel"])]
        "How fast the duty falls for duty commands without an acceleration of their own. Public clients, \
         2016-2025, command 68.";
    motor("motor{n}.default_speed", "Default speed", Group::MOTOR)
        .fixed(Unit::Percent, DEFAULT_SPEED, 1, Limits::Steps(0, 0x7FFF))
        .assumed_default(DefaultValue::Highest);
        [Form::field(READ_DEFAULT_SPEEDS, SET_DEFAULT_SPEED, &["speed_m1", "speed_m2"]).only(GEN3, GEN4)
            .writing(&["speed"])]
        "The share of the top speed that position commands without a speed of their own use. Public \
         clients, 2018-2025, command 70.";
    motor("motor{n}.idle.delay_seconds", "Idle delay", Group::MOTOR)
        .fixed(Unit::Seconds, DECISECONDS, 1, Limits::Steps(0, 127))
        .assumed_default(DefaultValue::Number(0.0));
        [Form::bits(READ_PWM_IDLE, SET_PWM_IDLE, &["idle_m1", "idle_m2"], (0, 7)).only(GEN3, GEN4)]
        "How long after a stop the bridge goes idle. Public clients, 2018-2025, command 160.";
    motor("motor{n}.idle.mode", "Idle mode, bit 7", Group::MOTOR).choice(IDLE_MODES)
        .assumed_default(DefaultValue::Key("off"));
        [Form::bits(READ_PWM_IDLE, SET_PWM_IDLE, &["idle_m1", "idle_m2"], (7, 1)).only(GEN3, GEN4)]
        "What happens once the bridge is idle. Sources contradict each other: two libraries call the bit enable, \
         an example calls it brake or coast. Try it before you rely on it. Public clients, 2018-2025, command 160, \
         bit 7.";
    motor("motor{n}.velocity.p", "Velocity P", Group::VELOCITY)
        .fixed(Unit::Gain, VELOCITY_GAIN, 3, U32_STEPS).default(DefaultValue::Number(1.0));
        [Form::field(READ_VELOCITY_PID, SET_VELOCITY_PID, &["p"])]
        "Proportional gain of the speed loop: how hard it pushes against a speed error. Start at 1 and \
         raise it until the motor trembles, then take two thirds. MCP manual 2.4.6, command 28.";
    motor("motor{n}.velocity.i", "Velocity I", Group::VELOCITY)
        .fixed(Unit::Gain, VELOCITY_GAIN, 3, U32_STEPS).default(DefaultValue::Number(0.5));
        [Form::field(READ_VELOCITY_PID, SET_VELOCITY_PID, &["i"])]
        "Integral gain of the speed loop: takes away the error that remains. Raise it in steps of 0.1. \
         MCP manual 2.4.6, command 28.";
    motor("motor{n}.velocity.d", "Velocity D", Group::VELOCITY)
        .fixed(Unit::Gain, VELOCITY_GAIN, 3, U32_STEPS).default(DefaultValue::Number(0.25));
        [Form::field(READ_VELOCITY_PID, SET_VELOCITY_PID, &["d"])]
        "Derivative gain of the speed loop: damps overshoot and amplifies noise. Usually 0. MCP manual \
         2.4.6, command 28.";
    motor("motor{n}.velocity.qpps", "QPPS", Group::VELOCITY).int(Unit::CountsPerSecond, U32_STEPS)
        .default(DefaultValue::Int(44_000));
        [Form::field(READ_VELOCITY_PID, SET_VELOCITY_PID, &["qpps"])]
        "Speed of the motor at full duty, in encoder counts per second. Measure it before tuning; with 0 \
         neither speed nor position control moves. MCP manual 2.4.5, command 28.";
    motor("motor{n}.position.p", "Position P", Group::POSITION)
        .fixed(Unit::Gain, POSITION_GAIN, 3, U32_STEPS).default(DefaultValue::Number(0.0));
        [Form::field(READ_POSITION_PID, SET_POSITION_PID, &["p"])]
        "Proportional gain of the position loop: speed asked for per count of position error. 2000 is a \
         starting point. MCP manual 2.4.7, command 61.";
    motor("motor{n}.position.i", "Position I", Group::POSITION)
        .fixed(Unit::Gain, POSITION_GAIN, 3, U32_STEPS).default(DefaultValue::Number(0.0));
        [Form::field(READ_POSITION_PID, SET_POSITION_PID, &["i"])]
        "Integral gain of the position loop: closes the last counts, and makes a drive with backlash \
         hunt. Needs Max I. MCP manual 2.4.7, command 61.";
    motor("motor{n}.position.d", "Position D", Group::POSITION)
        .fixed(Unit::Gain, POSITION_GAIN, 3, U32_STEPS).default(DefaultValue::Number(0.0));
        [Form::field(READ_POSITION_PID, SET_POSITION_PID, &["d"])]
        "Derivative gain of the position loop: damps the overshoot; usually 5 to 20 times P. MCP manual \
         2.4.7, command 61.";
    motor("motor{n}.position.max_i", "Max I", Group::POSITION).int(Unit::None, U32_STEPS)
        .default(DefaultValue::Int(0));
        [Form::field(READ_POSITION_PID, SET_POSITION_PID, &["max_i"])]
        "The most the integral of the position loop may wind up. With 0 the I gain does nothing. MCP \
         manual 2.4.7, command 61.";
    motor("motor{n}.position.deadzone", "Deadzone", Group::POSITION).int(Unit::Counts, U32_STEPS)
        .default(DefaultValue::Int(0));
        [Form::field(READ_POSITION_PID, SET_POSITION_PID, &["deadzone"])]
        "Position errors up to this count as none, so that backlash in the gears does not make the motor \
         hunt. MCP manual 2.4.7, command 61.";
    motor("motor{n}.position.min", "Minimum position", Group::POSITION).int(Unit::Counts, I32_STEPS)
        .default(DefaultValue::Int(0));
        [Form::field(READ_POSITION_PID, SET_POSITION_PID, &["min"])]
        "The lowest position a command can reach. While minimum and maximum are both 0, position commands \
         do not move. MCP manual 2.4.7, command 61.";
    motor("motor{n}.position.max", "Maximum position", Group::POSITION).int(Unit::Counts, I32_STEPS)
        .default(DefaultValue::Int(0));
        [Form::field(READ_POSITION_PID, SET_POSITION_PID, &["max"])]
        "The highest position a command can reach. While minimum and maximum are both 0, position \
         commands do not move. MCP manual 2.4.7, command 61.";
    motor("motor{n}.error_limit.speed", "Speed error limit", Group::ERROR_LIMITS)
        .int(Unit::CountsPerSecond, U32_STEPS).assumed_default(DefaultValue::Int(0));
        [Form::field(READ_SPEED_ERROR_LIMITS, SET_SPEED_ERROR_LIMITS, &["limit_m1", "limit_m2"])
            .only(GEN3, GEN3),
         Form::field(READ_SPEED_ERROR_LIMITS, SET_SPEED_ERROR_LIMITS, &["limit_m1", "limit_m2"])
            .only(GEN4, GEN4).with_range(U16_STEPS)]
        "Stops the motor with a fault when its speed is this far from the speed asked for; 0 switches the \
         check off. Public clients, 2018-2025, command 109.";
    motor("motor{n}.error_limit.position", "Position error limit", Group::ERROR_LIMITS)
        .int(Unit::Counts, U32_STEPS).assumed_default(DefaultValue::Int(0));
        [Form::field(READ_POSITION_ERROR_LIMITS, SET_POSITION_ERROR_LIMITS, &["limit_m1", "limit_m2"])
            .only(GEN3, GEN3),
         Form::field(READ_POSITION_ERROR_LIMITS, SET_POSITION_ERROR_LIMITS, &["limit_m1", "limit_m2"])
            .only(GEN4, GEN4).with_range(U16_STEPS)]
        "Stops the motor with a fault when its position is this far from the position asked for; 0 \
         switches the check off. It works only with accelerations set. Public clients, 2018-2025, command \
         112.";
    motor("motor{n}.home.duty", "Homing duty", Group::HOMING)
        .fixed(Unit::Percent, DEFAULT_SPEED, 1, Limits::Steps(0, 0x7FFF))
        .assumed_default(DefaultValue::Number(0.0));
        [Form::field(READ_HOMING, SET_HOMING, &["duty_m1", "duty_m2"]).only(GEN2, GEN3).writing(&["duty"])]
        "How hard the motor looks for its home switch at power-up: a share of the top speed where it has a \
         velocity or position loop, else a duty. RoboClaw manual 2018, command 105.";
    motor("motor{n}.home.timeout_seconds", "Homing time-out", Group::HOMING)
        .fixed(Unit::Seconds, Coding::PerUnit(steps_of(scale::HOMING_TIMEOUT_S)), 2, U32_STEPS)
        .assumed_default(DefaultValue::Number(0.0));
        [Form::field(READ_HOMING, SET_HOMING, &["timeout_m1", "timeout_m2"]).only(GEN2, GEN4)
            .writing(&["timeout"])]
        "How long the motor looks for its home switch before it gives up. With 0 it does not look. RoboClaw \
         manual 2018, command 105.";
};

const fn encoder(key: &'static str, label: &'static str) -> Template {
    motor(key, label, Group::ENCODERS).only_on(Family::RoboClaw)
}

const fn encoder_bits(shift: u8, width: u8) -> Form {
    Form::bits(READ_ENCODERS, SET_ENCODER, &["mode_m1", "mode_m2"], (shift, width)).writing(&["mode"])
}

const PIN_NUMBERS: &str = "Which number stands for which pin is not public, so it is not written to a real \
                           controller. Choose the encoder pin with the vendor's own program.";

/// 655359 on the wire: from full backward to full forward in 100 ms.
const ACCEL_DEFAULT_PERCENT_PER_S: f64 =
    scale::MAX_DUTY_ACCEL_RAW as f64 * 100.0 / scale::DUTY_ACCEL_RAW_PER_SECOND;
const DEFAULT_SPEED: Coding = Coding::PerUnit(scale::DEFAULT_SPEED_RAW / 100.0);
const INDUCTANCE_RESISTANCE: Coding = Coding::PerUnit(scale::INDUCTANCE_RESISTANCE);
const MIN_AMPS: Coding = Coding::NegativePerUnit { steps: steps_of(scale::CURRENT_AMPS), magnitude: false };
const MIN_AMPS_MAGNITUDE: Coding =
    Coding::NegativePerUnit { steps: steps_of(scale::CURRENT_AMPS), magnitude: true };
const U16_STEPS: Limits = Limits::Steps(0, 0xFFFF);

// The commands of motor 1 and motor 2. Where one command serves both, its fields differ instead.
const READ_CURRENT_LIMITS: &[u8] = &[number::READ_CURRENT_LIMITS_M1, number::READ_CURRENT_LIMITS_M2];
const SET_CURRENT_LIMITS: &[u8] = &[number::SET_CURRENT_LIMITS_M1, number::SET_CURRENT_LIMITS_M2];
const READ_ENCODERS: &[u8] = &[number::READ_ENCODER_MODES];
const SET_ENCODER: &[u8] = &[number::SET_ENCODER_MODE_M1, number::SET_ENCODER_MODE_M2];
const READ_L_R: &[u8] = &[number::READ_INDUCTANCE_RESISTANCE_M1, number::READ_INDUCTANCE_RESISTANCE_M2];
const SET_L_R: &[u8] = &[number::SET_INDUCTANCE_RESISTANCE_M1, number::SET_INDUCTANCE_RESISTANCE_M2];
const READ_DEFAULT_ACCELS: &[u8] = &[number::READ_DEFAULT_ACCELS];
const SET_DEFAULT_ACCEL: &[u8] = &[number::SET_DEFAULT_ACCEL_M1, number::SET_DEFAULT_ACCEL_M2];
const READ_DEFAULT_SPEEDS: &[u8] = &[number::READ_DEFAULT_SPEEDS];
const SET_DEFAULT_SPEED: &[u8] = &[number::SET_DEFAULT_SPEED_M1, number::SET_DEFAULT_SPEED_M2];
const READ_PWM_IDLE: &[u8] = &[number::READ_PWM_IDLE];
const SET_PWM_IDLE: &[u8] = &[number::SET_PWM_IDLE];
const READ_VELOCITY_PID: &[u8] = &[number::READ_VELOCITY_PID_M1, number::READ_VELOCITY_PID_M2];
const SET_VELOCITY_PID: &[u8] = &[number::SET_VELOCITY_PID_M1, number::SET_VELOCITY_PID_M2];
const READ_POSITION_PID: &[u8] = &[number::READ_POSITION_PID_M1, number::READ_POSITION_PID_M2];
const SET_POSITION_PID: &[u8] = &[number::SET_POSITION_PID_M1, number::SET_POSITION_PID_M2];
const READ_SPEED_ERROR_LIMITS: &[u8] = &[number::READ_SPEED_ERROR_LIMITS];
const SET_SPEED_ERROR_LIMITS: &[u8] = &[number::SET_SPEED_ERROR_LIMITS];
const READ_POSITION_ERROR_LIMITS: &[u8] = &[number::READ_POSITION_ERROR_LIMITS];
const SET_POSITION_ERROR_LIMITS: &[u8] = &[number::SET_POSITION_ERROR_LIMITS];
const READ_HOMING: &[u8] = &[number::READ_HOMING];
const SET_HOMING: &[u8] = &[number::SET_HOMING_M1, number::SET_HOMING_M2];
