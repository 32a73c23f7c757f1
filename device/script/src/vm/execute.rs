//! What each instruction does.

use super::counter::{Loop, step_of};
use super::fault::{FaultKind, outside};
use super::{Call, Host, Machine, State, element};
use crate::arithmetic::{self, Type};
use crate::mcl::ast::{Binary, Motion};
use crate::mcl::registers::RegisterId;
use crate::mcl::types::{Part, VarType};
use crate::op::{Array, Cell, Op, TableRef};
use crate::program::{Program, limits};
use std::time::Duration;

type Done = Result<(), FaultKind>;

impl Machine {
    #[inline]
    #[allow(clippy::wildcard_enum_match_arm, reason = "one answer for all the rest, new members too")]
    pub(super) fn execute<H: Host + ?Sized>(&mut self, op: Op, program: &Program, host: &mut H) -> Done {
        match op {
            Op::Nop => {}
            Op::Push(value) => self.push(value)?,
            Op::Drop => {
                self.pop()?;
            }
            Op::Load(cell) => self.push(self.memory.load(cell))?,
            Op::Store(cell) => {
                let value = self.pop()?;
                self.memory.store(cell, value);
            }
            Op::LoadAt(array) => {
                let cell = self.pop_element(array)?;
                self.push(self.memory.load(cell))?;
            }
            Op::StoreAt(array) => {
                let cell = self.pop_element(array)?;
                let value = self.pop()?;
                self.memory.store(cell, value);
            }
            Op::Unary(operator, kind) => {
                let value = self.pop()?;
                self.push(arithmetic::unary(operator, kind, value))?;
            }
            Op::Binary(operator, kind) => self.binary(operator, kind)?,
            Op::Convert(from, to) => {
                let value = self.pop()?;
                self.push(arithmetic::convert(value, from, to))?;
            }
            Op::Jump(to) => self.at = to,
            Op::JumpIfZero(to) => {
                if self.pop()? == 0 {
                    self.at = to;
                }
            }
            Op::JumpIfNotZero(to) => {
                if self.pop()? != 0 {
                    self.at = to;
                }
            }
            Op::ForStart(cell, number, has_step) => self.for_start(cell, number, has_step)?,
            Op::ForNext(cell, number, top) => self.for_next(cell, number, top)?,
            other => self.execute_rest(other, program, host)?,
        }
        Ok(())
    }

    #[allow(clippy::wildcard_enum_match_arm, reason = "one answer for all the rest, new members too")]
    fn execute_rest<H: Host + ?Sized>(&mut self, op: Op, program: &Program, host: &mut H) -> Done {
        match op {
            Op::LoadRegister(id, index) => self.push(register(host, id, index))?,
            Op::StoreRegister(id, index) => {
                let value = self.pop()?;
                host.set_register(id, index, id.row().kind.keep(value));
            }
            Op::LoadRegisterAt(id) => {
                let index = self.pop_register_index(id)?;
                self.push(register(host, id, index))?;
            }
            Op::StoreRegisterAt(id) => {
                let index = self.pop_register_index(id)?;
                let value = self.pop()?;
                host.set_register(id, index, id.row().kind.keep(value));
            }
            Op::LoadTable(table) => {
                let index = self.pop()?;
                self.push(entry(program, table, index)?)?;
            }
            Op::Part(part) => {
                let value = self.pop()?;
                self.push(part_of(part, value))?;
            }
            Op::Branch(count) => {
                let index = self.pop()?;
                self.at = self.at.saturating_add(index.min(count));
            }
            Op::Gosub(to, count) => self.gosub(to, count)?,
            Op::Return(kind) => self.return_from(kind)?,
            Op::Result(kind) => self.push(self.result_as(kind))?,
            Op::Pause => {
                let time = Duration::from_millis(self.pop()?.into());
                self.state = State::Pausing { until: host.now() + time };
            }
            Op::Motion(command, extra) => self.motion(command, extra, host)?,
            Op::ReadEeprom => {
                let address = self.pop()?;
                self.push(host.read_eeprom(address).into())?;
            }
            Op::WriteEeprom => {
                let (value, address) = (self.pop()?, self.pop()?);
                host.write_eeprom(address, value as u8);
                self.wait_for(host);
            }
            Op::I2cOut(count, stop, otherwise) => {
                self.i2c_out(count, stop, otherwise, host)?;
                self.wait_for(host);
            }
            Op::I2cIn(count, otherwise) => {
                self.i2c_in(count, otherwise, host)?;
                self.wait_for(host);
            }
            Op::Clear => self.memory.clear(),
            Op::End => {
                // It stays on its instruction, so that the line that ended it is known.
                self.at = self.at.saturating_sub(1);
                self.state = State::Ended;
            }
            other => self.on_board(other, program, host)?,
        }
        Ok(())
    }

    fn pop_element(&mut self, array: Array) -> Result<Cell, FaultKind> {
        let index = self.pop()?;
        element(array, index).ok_or(outside(index, array.length))
    }

    fn pop_register_index(&mut self, id: RegisterId) -> Result<u8, FaultKind> {
        let index = self.pop()?;
        let length = id.row().length;
        u8::try_from(index).ok().filter(|index| *index < length).ok_or(outside(index, length.into()))
    }

    #[inline]
    fn binary(&mut self, operator: Binary, kind: Type) -> Done {
        let right = self.pop()?;
        let left = self.stack.last_mut().ok_or(FaultKind::StackEmpty)?;
        *left = arithmetic::binary(operator, kind, *left, right).map_err(|_| FaultKind::DivisionByZero)?;
        Ok(())
    }

    /// Without a step the loop counts towards its last value.
    fn for_start(&mut self, cell: Cell, number: u32, has_step: bool) -> Done {
        let step = if has_step { Some(self.pop()?) } else { None };
        let (finish, start) = (self.pop()?, self.pop()?);
        let step = step.unwrap_or_else(|| step_of(type_of(cell.kind), start, finish));
        self.memory.store(cell, start);
        if let Some(counted) = self.loops.get_mut(number as usize) {
            *counted = Loop { start, step };
        }
        Ok(())
    }

    fn for_next(&mut self, cell: Cell, number: u32, top: u32) -> Done {
        let finish = self.pop()?;
        let counted = self.loops.get(number as usize).copied().unwrap_or_default();
        let (next, goes_on) = counted.next(type_of(cell.kind), self.memory.load(cell), finish);
        self.memory.store(cell, next);
        if goes_on {
            self.at = top;
        }
        Ok(())
    }

    fn gosub(&mut self, to: u32, count: u32) -> Done {
        if self.calls.len() >= limits::CALLS {
            return Err(FaultKind::CallsTooDeep);
        }
        let base = self.stack.len().checked_sub(count as usize).ok_or(FaultKind::StackEmpty)?;
        self.calls.push(Call { returns_to: self.at, entered_at: to, base, interrupted: None });
        self.at = to;
        Ok(())
    }

    fn return_from(&mut self, kind: Option<Type>) -> Done {
        self.result = match kind {
            Some(kind) => (self.pop()?, kind),
            None => (0, Type::Unsigned),
        };
        let call = self.calls.pop().ok_or(FaultKind::NoCall)?;
        self.stack.truncate(call.base);
        self.at = call.returns_to;
        self.put_back();
        if let Some(result) = call.interrupted {
            self.result = result;
            self.handler_returned();
        }
        Ok(())
    }

    pub(super) fn pop_many(&mut self, count: usize) -> Result<Vec<u32>, FaultKind> {
        let from = self.stack.len().checked_sub(count).ok_or(FaultKind::StackEmpty)?;
        Ok(self.stack.split_off(from))
    }

    fn motion<H: Host + ?Sized>(&mut self, command: Motion, extra: bool, host: &mut H) -> Done {
        let arguments = self.pop_many(command.arguments() + usize::from(extra))?;
        let arguments: Vec<i32> = arguments.into_iter().map(|argument| argument as i32).collect();
        host.motion(command, &arguments);
        Ok(())
    }

    fn pop_timeout(&mut self, otherwise: Option<u32>) -> Result<Option<Duration>, FaultKind> {
        otherwise.map(|_| self.pop().map(|time| Duration::from_millis(time.into()))).transpose()
    }

    fn i2c_out<H: Host + ?Sized>(
        &mut self,
        count: u32,
        stop: bool,
        otherwise: Option<u32>,
        host: &mut H,
    ) -> Done {
        let timeout = self.pop_timeout(otherwise)?;
        let bytes: Vec<u8> = self.pop_many(count as usize)?.into_iter().map(|byte| byte as u8).collect();
        if let (false, Some(target)) = (host.i2c_write(&bytes, stop, timeout), otherwise) {
            self.at = target;
        }
        Ok(())
    }

    fn i2c_in<H: Host + ?Sized>(&mut self, count: u32, otherwise: Option<u32>, host: &mut H) -> Done {
        let timeout = self.pop_timeout(otherwise)?;
        let bytes = match (host.i2c_read(count as usize, timeout), otherwise) {
            (Some(bytes), _) => bytes,
            (None, Some(target)) => {
                self.at = target;
                return Ok(());
            }
            // Without a label the program goes on with zeros.
            (None, None) => vec![0; count as usize],
        };
        for index in (0..count as usize).rev() {
            self.push(bytes.get(index).copied().unwrap_or(0).into())?;
        }
        Ok(())
    }
}

fn register<H: Host + ?Sized>(host: &mut H, id: RegisterId, index: u8) -> u32 {
    id.row().kind.keep(host.register(id, index))
}

/// An entry of a table in the program's data.
pub(super) fn entry(program: &Program, table: TableRef, index: u32) -> Result<u32, FaultKind> {
    if index >= table.length {
        return Err(outside(index, table.length));
    }
    let width = (table.kind.bits() / 8) as usize;
    let at = table.at as usize + index as usize * width;
    let mut wide = [0; 4];
    let bytes = program.data.get(at..at + width).ok_or(FaultKind::BadJump)?;
    wide[..width].copy_from_slice(bytes);
    Ok(table.kind.keep(u32::from_le_bytes(wide)))
}

fn part_of(part: Part, value: u32) -> u32 {
    part.kind.keep(value.checked_shr(part.first_bit).unwrap_or(0))
}

#[allow(clippy::wildcard_enum_match_arm, reason = "one answer for all the rest, new members too")]
fn type_of(kind: VarType) -> Type {
    match kind {
        VarType::Float => Type::Float,
        kind if kind.is_signed() => Type::Signed,
        _ => Type::Unsigned,
    }
}
