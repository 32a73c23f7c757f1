//! What each command does, and what each report says (SuprMotr manual, "Command Reference" and "Command Short Form").

use super::assumed::{BOOT_TIME, CHECKSUM, VERSION};
use super::axis::Edge;
use super::channels::Line as Input;
use super::program::Wait;
use super::unit::SuprMotr;
use brushwork_suprmotr_wire::{
    Address, Command, ErrorCode, FURTHEST_COUNTS, Line, Mnemonic, Radix, ReportLine, Reports, Status,
    help_lines, inputs, limits, motion, operation,
};
use std::time::Duration;

impl SuprMotr {
    /// Does a command of a line or macro.
    ///
    /// # Errors
    /// Why it is refused now, although its number is one that it takes.
    #[allow(clippy::wildcard_enum_match_arm, reason = "a test sends every command that reports nothing")]
    pub(super) fn execute(&mut self, command: Command) -> Result<(), ErrorCode> {
        if command.row().reports != Reports::Nothing {
            self.report(command);
            return Ok(());
        }
        let number = command.value().unwrap_or_default();
        let wide = i64::from(number);
        let running = &mut self.running;
        match command.mnemonic {
            Mnemonic::UD => {
                self.eeprom.parameters = running.parameters.clone();
                self.eeprom_writes += 1;
            }
            Mnemonic::DB => {
                // The table lets no other number through.
                let address = u8::try_from(number).ok().and_then(Address::new).ok_or(ErrorCode::TooLarge)?;
                self.eeprom.address = address;
                self.eeprom_writes += 1;
                running.address = address;
            }
            Mnemonic::RT => self.start(BOOT_TIME),
            Mnemonic::DV | Mnemonic::SV => running.parameters.velocity = number,
            Mnemonic::DA | Mnemonic::SA => running.parameters.acceleration = number,
            Mnemonic::DP => running.parameters.proportional = number,
            Mnemonic::DI => running.parameters.integral = number,
            Mnemonic::DD => running.parameters.derivative = number,
            Mnemonic::DL => running.parameters.integral_limit = number,
            Mnemonic::SM => running.parameters.most_error = number,
            Mnemonic::SQ => running.parameters.torque = number,
            // Assumed: the board keeps the number and does nothing with it.
            Mnemonic::SJ => running.parameters.jog = number,
            Mnemonic::BR => running.parameters.rate = number,
            Mnemonic::EN => running.parameters.has_echo = true,
            Mnemonic::EF => running.parameters.has_echo = false,
            Mnemonic::LN => running.parameters.has_limits = true,
            Mnemonic::LF => running.parameters.has_limits = false,
            Mnemonic::LH => running.parameters.is_active_high = true,
            Mnemonic::LL => running.parameters.is_active_high = false,
            Mnemonic::PH => {
                // Assumed: without a number it is the other way round from now on.
                let was_reversed = running.parameters.is_phase_reversed;
                running.parameters.is_phase_reversed =
                    command.number.map_or(!was_reversed, |number| number != 0);
            }
            Mnemonic::DM => running.radix = Radix::Decimal,
            Mnemonic::HM => running.radix = Radix::Hexadecimal,
            Mnemonic::MN => running.axis.switch_on(),
            Mnemonic::MF => running.axis.switch_off(),
            Mnemonic::AB if number == 0 => running.axis.stop(),
            Mnemonic::AB | Mnemonic::ST => running.axis.slow_to_stop(&running.parameters),
            Mnemonic::MA => running.axis.move_to(wide, &running.parameters),
            Mnemonic::GH => running.axis.move_to(0, &running.parameters),
            Mnemonic::MR => {
                let target = running.axis.position() + wide;
                if target > i64::from(FURTHEST_COUNTS) {
                    return Err(ErrorCode::TooLarge);
                }
                if target < -i64::from(FURTHEST_COUNTS) {
                    return Err(ErrorCode::TooSmall);
                }
                running.axis.move_to(target, &running.parameters);
            }
            Mnemonic::FE => {
                let edge = Edge::from_number(wide).ok_or(ErrorCode::TooLarge)?;
                running.axis.find(edge, &running.parameters, &running.channels);
            }
            Mnemonic::DH => running.axis.define_home(),
            Mnemonic::RP => running.program.repeat(number.unsigned_abs()),
            Mnemonic::WS => running.program.wait = Some(Wait::Stop(milliseconds(number))),
            Mnemonic::WA => running.program.wait = Some(Wait::Until(self.now + milliseconds(number))),
            Mnemonic::WN => running.program.wait = Some(Wait::Channel { channel: wide, is_on: true }),
            Mnemonic::WF => running.program.wait = Some(Wait::Channel { channel: wide, is_on: false }),
            Mnemonic::XN if !running.channels.is_on(wide) => running.program.skip_rest(),
            Mnemonic::XF if running.channels.is_on(wide) => running.program.skip_rest(),
            Mnemonic::XN | Mnemonic::XF => {}
            Mnemonic::MC | Mnemonic::EM => {
                // The table lets no other number through.
                let called = macro_number(number).ok_or(ErrorCode::TooLarge)?;
                let commands = self.eeprom.macro_of(called);
                if !commands.is_empty() && !running.program.call(called, commands.to_vec()) {
                    return Err(ErrorCode::LineOverflow);
                }
            }
            Mnemonic::RM => {
                self.eeprom.erase(command.number.and_then(macro_number));
                self.eeprom_writes += 1;
            }
            Mnemonic::RZ => {
                self.eeprom.erase(Some(0));
                self.eeprom_writes += 1;
            }
            Mnemonic::SO => running.channels.set_analog_output(wide),
            Mnemonic::IO => running.channels.change_analog_output(wide),
            Mnemonic::CF => running.channels.switch(wide, false),
            Mnemonic::CN => running.channels.switch(wide, true),
            Mnemonic::CI => running.channels.set_direction(wide, false),
            Mnemonic::CT => running.channels.set_direction(wide, true),
            Mnemonic::CP => running.channels.set_pattern(wide),
            // A definition is a line of its own, and reports were seen to above.
            _ => return Err(ErrorCode::NotAvailable),
        }
        Ok(())
    }

    /// What a report says. TS takes the error away.
    pub(super) fn lines_of(&mut self, command: Command) -> Vec<ReportLine> {
        let channel = command.value().and_then(|value| u8::try_from(value).ok()).unwrap_or_default();
        match command.row().reports {
            Reports::Nothing => Vec::new(),
            Reports::Number { .. } | Reports::Plain => {
                let value = self.number_of(command.mnemonic);
                let bounds = (i64::from(i32::MIN), i64::from(i32::MAX));
                let value = value.clamp(bounds.0, bounds.1) as i32;
                vec![ReportLine::Number { of: command.mnemonic, value }]
            }
            Reports::Status => {
                let status = self.status();
                self.running.error = None;
                vec![ReportLine::Status(status)]
            }
            Reports::Analog => {
                let analog = self.running.channels.analog();
                let values = match channel {
                    0 => analog.to_vec(),
                    input => analog.get(usize::from(input) - 1).copied().into_iter().collect(),
                };
                vec![ReportLine::Analog { channel, values }]
            }
            Reports::Channels if channel == 0 => {
                let channels = &self.running.channels;
                vec![ReportLine::Channels { outputs: channels.outputs(), inputs: channels.inputs() }]
            }
            Reports::Channels => {
                vec![ReportLine::Channel { channel, is_on: self.running.channels.is_on(channel.into()) }]
            }
            Reports::Each(parts) => {
                parts.iter().flat_map(|part| self.lines_of(Command::plain(*part))).collect()
            }
            Reports::Text if command.mnemonic == Mnemonic::HE => {
                help_lines().into_iter().map(ReportLine::Text).collect()
            }
            Reports::Text => vec![ReportLine::Text(VERSION.to_owned())],
            Reports::Macros => {
                let is_all = command.mnemonic == Mnemonic::TM && channel == 0;
                let told = self.eeprom.macros().filter(|(number, _)| is_all || *number == channel);
                let line = |(number, commands): (u8, &[Command])| Line {
                    defines: Some(number),
                    commands: commands.to_vec(),
                };
                told.map(|each| ReportLine::Macro(line(each))).collect()
            }
        }
    }

    #[allow(clippy::wildcard_enum_match_arm, reason = "the other commands report no number")]
    fn number_of(&self, mnemonic: Mnemonic) -> i64 {
        let running = &self.running;
        let parameters = &running.parameters;
        match mnemonic {
            Mnemonic::TP => running.axis.position(),
            Mnemonic::TT => running.axis.target(),
            Mnemonic::TE => running.axis.target() - running.axis.position(),
            Mnemonic::TF => running.axis.following_error(),
            Mnemonic::TD => running.axis.dynamic_target(),
            Mnemonic::TV => running.axis.velocity(),
            Mnemonic::TQ => running.axis.drive(),
            Mnemonic::GV | Mnemonic::TY => parameters.velocity.into(),
            Mnemonic::GA | Mnemonic::TL => parameters.acceleration.into(),
            Mnemonic::GP => parameters.proportional.into(),
            Mnemonic::GI => parameters.integral.into(),
            Mnemonic::GD => parameters.derivative.into(),
            Mnemonic::GL => parameters.integral_limit.into(),
            Mnemonic::TI => running.program.repeats_left().into(),
            Mnemonic::TB => running.address.get().into(),
            Mnemonic::TJ => parameters.jog.into(),
            Mnemonic::TO => running.channels.analog_output().into(),
            Mnemonic::CS => CHECKSUM,
            _ => 0,
        }
    }

    /// The six bytes of TS.
    ///
    /// Assumed: inputs and limits are told as on or off by LL and LH, not as levels; the polarities are set for positive; leading zeros are always
    /// kept.
    pub(super) fn status(&self) -> Status {
        let running = &self.running;
        let (axis, flags) = (&running.axis, running.axis.flags());
        let search = axis.search();
        let is_on = |line| running.channels.is_active(line, running.parameters.is_active_high);
        Status {
            operation: set([
                (operation::ECHO, running.parameters.has_echo),
                (operation::WAIT, running.program.wait.is_some()),
                (operation::COMMAND_ERROR, running.error.is_some()),
                (operation::MACRO, running.program.is_in_macro()),
                (operation::ZEROS_KEPT, true),
                (operation::HEXADECIMAL, running.radix == Radix::Hexadecimal),
                (operation::ADDRESSED, running.is_selected),
            ]),
            motion: set([
                (motion::MOTOR_OFF, !axis.is_on()),
                (motion::ERROR_POLARITY, axis.following_error() > 0),
                (motion::FORWARD, flags.is_forward),
                (motion::MOVE_ERROR, flags.move_error),
                (motion::DECELERATION_POLARITY, flags.slowed_forward),
                (motion::PHASE, running.parameters.is_phase_reversed),
                (motion::EXCESSIVE_ERROR, flags.excessive_error),
                (motion::COMPLETE, axis.is_complete()),
            ]),
            limits: set([
                (limits::ENABLED, running.parameters.has_limits),
                (limits::ACTIVE_HIGH, running.parameters.is_active_high),
                (limits::FIND_EDGE, search.is_some()),
                (limits::EDGE_STATE, search.is_some_and(|search| search.was_on)),
            ]),
            inputs: set([
                (inputs::POSITIVE, is_on(Input::Positive)),
                (inputs::REFERENCE, is_on(Input::Reference)),
                (inputs::NEGATIVE, is_on(Input::Negative)),
            ]),
            mode: 0,
            error: running.error.map_or(0, ErrorCode::number),
        }
    }
}

fn set<const N: usize>(bits: [(u8, bool); N]) -> u8 {
    bits.into_iter().filter(|(_, is_set)| *is_set).fold(0, |byte, (bit, _)| byte | bit)
}

fn milliseconds(number: i32) -> Duration {
    Duration::from_millis(number.unsigned_abs().into())
}

fn macro_number(number: i32) -> Option<u8> {
    u8::try_from(number).ok()
}
