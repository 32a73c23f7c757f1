//! Motion, EEPROM, I2C, PAUSE.

use super::super::ast::{Expr, Motion, Name, Place};
use super::super::codes;
use super::super::constant::Constant;
use super::super::types::VarType;
use super::Lowering;
use crate::arithmetic::Type;
use crate::op::Op;

/// Addresses that the manual calls byte sized.
const LAST_BYTE_ADDRESS: i64 = 255;

/// POWER's argument for 100 % (MCP manual 3.4.1).
const FULL_DUTY: i64 = 32_767;

impl Lowering<'_> {
    pub(super) fn pause(&mut self, time: &Expr) {
        self.whole_number(time);
        self.emit(Op::Pause);
    }

    pub(super) fn motion(&mut self, command: Motion, arguments: &[Expr]) {
        for argument in arguments {
            self.whole_number(argument);
        }
        let extra = arguments.len() > command.arguments();
        if let (true, Some(buffer)) = (extra, arguments.last()) {
            let message =
                format!("The manual describes a buffer for {}, but its syntax has none.", command.word());
            self.report(codes::EXTRA_BUFFER, buffer.span, message, None);
        }
        self.warn_of_arguments(command, arguments);
        self.emit(Op::Motion(command, extra));
    }

    /// Constants that no motor takes, or that mean something in particular.
    fn warn_of_arguments(&mut self, command: Motion, arguments: &[Expr]) {
        let (motors, duties, accelerations): (&[usize], &[usize], &[usize]) = match command {
            Motion::Dist | Motion::Speed => (&[0], &[], &[]),
            Motion::Move => (&[0], &[], &[2, 3]),
            Motion::Move2 => (&[], &[], &[1, 2, 5, 6]),
            Motion::Power => (&[0], &[1], &[]),
            Motion::Power2 => (&[], &[0, 2], &[]),
            Motion::Dist2 | Motion::Speed2 => (&[], &[], &[]),
        };
        for (index, argument) in arguments.iter().enumerate() {
            let Ok(known) = self.folded(argument).map(|known| i64::from(known.as_whole() as i32)) else {
                continue;
            };
            if motors.contains(&index) && !(0..=1).contains(&known) {
                let message = format!("There is no motor {known}: they are 0 and 1.");
                self.report(codes::DOES_NOT_FIT, argument.span, message, None);
            }
            if duties.contains(&index) && !(-FULL_DUTY..=FULL_DUTY).contains(&known) {
                let message = format!("A duty goes from -{FULL_DUTY} to {FULL_DUTY}, not to {known}.");
                self.report(codes::DOES_NOT_FIT, argument.span, message, None);
            }
            if accelerations.contains(&index) && known == 0 {
                let message = "With acceleration 0 the motor's default acceleration is taken.".to_owned();
                self.report(codes::NO_ACCELERATION, argument.span, message, None);
            }
        }
    }

    /// A constant of which only the low byte is used.
    fn warn_of_byte(&mut self, value: &Expr) {
        if let Ok(known @ Constant::Whole(..)) = self.folded(value) {
            self.warn_of_loss(known, VarType::Byte, value.span);
        }
    }

    fn address(&mut self, address: &Expr) {
        self.whole_number(address);
        if self.folded(address).is_ok_and(|known| known.as_whole() > LAST_BYTE_ADDRESS) {
            let message = "The EEPROM of a script has addresses 0 to 255.".to_owned();
            self.report(codes::ADDRESS_UNIT, address.span, message, None);
        }
    }

    pub(super) fn read(&mut self, address: &Expr, to: &Place) {
        self.address(address);
        self.emit(Op::ReadEeprom);
        self.store(to, Type::Unsigned);
    }

    pub(super) fn write(&mut self, address: &Expr, value: &Expr) {
        self.address(address);
        self.warn_of_byte(value);
        self.whole_number(value);
        self.emit(Op::WriteEeprom);
    }

    pub(super) fn i2c_out(&mut self, otherwise: Option<&(Name, Expr)>, bytes: &[Expr], stop: bool) {
        self.check_count(bytes.iter().map(|byte| byte.span));
        for byte in bytes {
            self.warn_of_byte(byte);
            self.whole_number(byte);
        }
        let count = u32::try_from(bytes.len()).unwrap_or(u32::MAX);
        self.i2c(otherwise, |target| Op::I2cOut(count, stop, target));
    }

    pub(super) fn i2c_in(&mut self, otherwise: Option<&(Name, Expr)>, to: &[Place]) {
        self.check_count(to.iter().map(|place| place.span));
        let count = u32::try_from(to.len()).unwrap_or(u32::MAX);
        self.i2c(otherwise, |target| Op::I2cIn(count, target));
        for place in to {
            self.store(place, Type::Unsigned);
        }
    }

    fn i2c(&mut self, otherwise: Option<&(Name, Expr)>, op: impl Fn(Option<u32>) -> Op) {
        match otherwise {
            None => self.emit(op(None)),
            Some((label, timeout)) => {
                self.whole_number(timeout);
                self.jump_to_label(op(Some(0)), label);
            }
        }
    }
}
