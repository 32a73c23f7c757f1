//! The unit as a whole: address, mixing, E-Stop, voltage limits, priority levels, scripting (MCP manual
//! 1.2.10).

use brushwork_mcp_wire::codes::{ESTOP_RESETS, ESTOP_RESETS_GENERATION_4, PRIORITY_SIGNALS, PWM_MODES};
use brushwork_mcp_wire::models::Family;
use brushwork_mcp_wire::packet_serial::number;
use brushwork_values::Unit;

use crate::settings::rows::scales::{DECISECONDS, GEN1, GEN2, GEN3, GEN4, VOLTS};
use crate::settings::template::{
    DefaultValue, Form, Limits, Repeat, Template, at, mcp, motor, setting, settings,
};
use brushwork_link::settings::Group;
use brushwork_link::settings::Kind;

pub(crate) static ROWS: &[Template] = settings! {
    mcp("unit.address", "Packet serial address", Group::UNIT)
        .int(Unit::None, Limits::Between(128.0, 135.0)).default(DefaultValue::Int(128));
        [Form::link_address(at(&[number::SET_ADDRESS_MIXED], &["address"])).only(GEN1, GEN1),
         Form::field(&[number::READ_ADDRESS_MIXED], &[number::SET_ADDRESS_MIXED], &["address"])
            .only(GEN2, GEN4)]
        "The number this controller answers to when several share one serial line, 128 to 135 (0x80 to \
         0x87). A new address counts from the next command on. MCP manual 1.2.10, command 141.";
    mcp("unit.mixing", "Control mixing", Group::UNIT);
        [Form::field(&[number::READ_ADDRESS_MIXED], &[number::SET_ADDRESS_MIXED], &["mixed"])]
        "Mixes the two inputs for a vehicle with a motor on each side: one input drives, the other turns. \
         MCP manual 1.2.10, command 141.";
    setting("unit.estop_reset", "E-Stop reset method", Group::UNIT).choice(ESTOP_RESETS)
        .default(DefaultValue::Key("hardware"));
        [Form::field(&[number::READ_ESTOP_LOCK], &[number::SET_ESTOP_LOCK], &["lock"]).only(GEN1, GEN3),
         Form::field(&[number::READ_ESTOP_LOCK], &[number::SET_ESTOP_LOCK], &["lock"]).only(GEN4, GEN4)
            .with_kind(Kind::Choice(ESTOP_RESETS_GENERATION_4))]
        "How an emergency stop ends: only by resetting the hardware, by a command from the computer, or, \
         in newer firmware, by itself when the input clears. MCP manual 1.2.10, command 201.";
    setting("unit.pwm_mode", "PWM mode", Group::UNIT).choice(PWM_MODES)
        .default(DefaultValue::Key("locked_antiphase"));
        [Form::field(&[number::READ_PWM_MODE], &[number::SET_PWM_MODE], &["mode"]).only(GEN1, GEN2)]
        "How the bridge switches. Locked antiphase brakes and regenerates all the time; sign magnitude is \
         quieter at standstill. MCP manual 1.2.10, command 148.";
    motor("motor{n}.pwm_mode", "PWM mode", Group::UNIT).choice(PWM_MODES)
        .default(DefaultValue::Key("locked_antiphase"));
        [Form::field(&[number::READ_PWM_MODE], &[number::SET_PWM_MODE], &["mode_m1", "mode_m2"])
            .only(GEN3, GEN4)]
        "How this motor's bridge switches. Locked antiphase brakes and regenerates all the time; sign \
         magnitude is quieter at standstill. MCP manual 1.2.10, command 148.";
    mcp("unit.bridge_channels", "Bridge channels", Group::UNIT);
        [Form::hidden("No packet serial command for bridging the channels is public. Set it with the \
         vendor's own program, before wiring one motor to both channels.")]
        "Runs both channels as one, for one motor with twice the current. Set it before the single motor \
         is wired, or the controller is damaged. MCP manual 1.8.";
    setting("unit.serial_timeout", "Serial time-out", Group::UNIT)
        .fixed(Unit::Seconds, DECISECONDS, 1, Limits::Steps(0, 255)).default(DefaultValue::Number(0.0))
        .only_on(Family::RoboClaw);
        [Form::field(&[number::READ_SERIAL_TIMEOUT], &[number::SET_SERIAL_TIMEOUT], &["timeout"])
            .only(GEN2, GEN4)]
        "Stops the motors when nothing was received for this long; 0 switches it off. Public clients, \
         2015-2025, command 14.";
    setting("limits.main_battery.min_volts", "Main battery minimum", Group::VOLTAGE_LIMITS)
        .fixed(Unit::Volts, VOLTS, 1, Limits::MainVolts).default(DefaultValue::Lowest);
        [Form::field(&[number::READ_MAIN_VOLTAGES], &[number::SET_MAIN_VOLTAGES], &["min"])]
        "Below this main battery voltage the motors run free, which protects the battery and the supply. \
         MCP manual 1.4.2, command 57.";
    setting("limits.main_battery.max_volts", "Main battery maximum", Group::VOLTAGE_LIMITS)
        .fixed(Unit::Volts, VOLTS, 1, Limits::MainVolts).default(DefaultValue::Highest);
        [Form::field(&[number::READ_MAIN_VOLTAGES], &[number::SET_MAIN_VOLTAGES], &["max"])]
        "Above this main battery voltage the motors are braked. With a power supply set it 2 V above the \
         supply, and fit a voltage clamp. MCP manual 1.4.2 and 1.7, command 57.";
    setting("limits.main_battery.auto_offset_volts", "Main battery automatic offset", Group::VOLTAGE_LIMITS)
        .fixed(Unit::Volts, VOLTS, 1, Limits::Steps(0, 255)).assumed_default(DefaultValue::Number(0.0));
        [Form::field(&[number::READ_MAIN_VOLTAGES], &[number::SET_MAIN_VOLTAGES], &["auto_offset"])
            .only(GEN4, GEN4)]
        "Sets the maximum by itself at power-up, this much above the voltage found then; 0 uses the fixed \
         maximum. Public clients, 2025, command 57.";
    setting("limits.logic_battery.min_volts", "Logic battery minimum", Group::VOLTAGE_LIMITS)
        .fixed(Unit::Volts, VOLTS, 1, Limits::LogicVolts).assumed_default(DefaultValue::Number(8.0));
        [Form::field(&[number::READ_LOGIC_VOLTAGES], &[number::SET_LOGIC_VOLTAGES], &["min"])]
        "Below this logic battery voltage the controller stops with an error, since its own electronics \
         would fail. MCP manual 1.6.3, command 58.";
    setting("limits.logic_battery.max_volts", "Logic battery maximum", Group::VOLTAGE_LIMITS)
        .fixed(Unit::Volts, VOLTS, 1, Limits::LogicVolts).assumed_default(DefaultValue::WithinRange(15.0));
        [Form::field(&[number::READ_LOGIC_VOLTAGES], &[number::SET_LOGIC_VOLTAGES], &["max"])]
        "Above this logic battery voltage the controller stops with an error. MCP manual 1.6.3, command \
         58.";
    setting("limits.main_battery.offset_volts", "Main battery reading offset", Group::VOLTAGE_LIMITS)
        .fixed(Unit::Volts, VOLTS, 1, Limits::Steps(-10, 10)).assumed_default(DefaultValue::Number(0.0));
        [Form::field(&[number::READ_VOLTAGE_OFFSETS], &[number::SET_VOLTAGE_OFFSETS], &["main"])
            .only(GEN3, GEN4)]
        "Corrects the main battery reading by a fixed amount, when a meter shows another voltage. Public \
         clients, 2018-2025, command 115.";
    setting("limits.logic_battery.offset_volts", "Logic battery reading offset", Group::VOLTAGE_LIMITS)
        .fixed(Unit::Volts, VOLTS, 1, Limits::Steps(-10, 10)).assumed_default(DefaultValue::Number(0.0));
        [Form::field(&[number::READ_VOLTAGE_OFFSETS], &[number::SET_VOLTAGE_OFFSETS], &["logic"])
            .only(GEN3, GEN4)]
        "Corrects the logic battery reading by a fixed amount, when a meter shows another voltage. Public \
         clients, 2018-2025, command 115.";
    mcp("priority.{n}", "Input", Group::PRIORITY_LEVELS).per(Repeat::Levels).choice(PRIORITY_SIGNALS)
        .default(DefaultValue::Keys(&["serial", "pulse", "analog"]));
        [Form::field(&[number::READ_PRIORITIES], &[number::SET_PRIORITIES], &["level_1", "level_2", "level_3"])]
        "Which kind of input commands the motors at this level. Level 1 wins; when its input times out, \
         the next level takes over. MCP manual 1.2.10, command 139.";
    mcp("script.autorun_delay", "Script autorun delay", Group::SCRIPTING)
        .int(Unit::Milliseconds, Limits::Steps(0, 0xFFFF_FFFF)).default(DefaultValue::Int(0));
        [Form::field(&[number::READ_SCRIPT_AUTORUN], &[number::SET_SCRIPT_AUTORUN], &["delay"])]
        "Starts the stored script this long after power-up. Below 100 ms no script starts by itself. A \
         script can move motors. MCP manual 1.2.10, command 246.";
};
