//! PUTS, GETS and what is written into arrays.

use super::execute::entry;
use super::reading::Reading;
use super::{FaultKind, Host, Machine, Sink, State, digits, element};
use crate::mcl::ast::Format;
use crate::op::{Array, Op, TableRef};
use crate::program::Program;

type Done = Result<(), FaultKind>;

/// Bytes that one step of GETS looks at, at most; as many as a stream holds.
const BYTES_PER_STEP: usize = 256;

impl Machine {
    #[allow(clippy::wildcard_enum_match_arm, reason = "one answer for all the rest, new members too")]
    pub(super) fn stream<H: Host + ?Sized>(&mut self, op: Op, program: &Program, host: &mut H) -> Done {
        match op {
            Op::OutStream => self.sink = Sink::Stream(self.pop()?),
            Op::OutArray(array) => self.sink = Sink::Array { array, next: 0 },
            Op::OutByte => {
                let value = self.pop()?;
                self.out(value & 0xFF, host)?;
            }
            Op::OutValue => {
                let value = self.pop()?;
                self.out(value, host)?;
            }
            Op::OutText(at, length) => {
                let (from, to) = (at as usize, at as usize + length as usize);
                for byte in program.data.get(from..to).unwrap_or_default() {
                    self.out(u32::from(*byte), host)?;
                }
            }
            Op::OutNumber(format, max) => {
                let (min, value) = (self.pop()?, self.pop()?);
                self.out_text(&digits::whole(format, value, max, min), host)?;
            }
            Op::OutReal(max) => {
                let (decimals, value) = (self.pop()?, self.pop()?);
                self.out_text(&digits::real(f32::from_bits(value), max, decimals), host)?;
            }
            Op::OutRepeat => {
                let (count, letter) = (self.pop()?, self.pop()?);
                for _ in 0..count.min(u32::from(u16::MAX)) {
                    self.out(letter & 0xFF, host)?;
                }
            }
            Op::OutString(array, has_end) => {
                let load =
                    |machine: &Self, index| element(array, index).map(|cell| machine.memory.load(cell));
                self.out_string(array.length, has_end, host, load)?;
            }
            Op::OutTable(table, has_end) => self.out_table(table, has_end, program, host)?,
            Op::InStream => self.source = self.pop()?,
            Op::InByte => {
                if let Some(byte) = self.byte(host) {
                    self.push(byte.into())?;
                }
            }
            Op::InNumber(format, max) => self.in_number(format, max, host)?,
            Op::InReal => self.in_real(host)?,
            Op::InString(array, has_end) => self.in_string(array, has_end, host)?,
            _ => {}
        }
        self.wait_for(host);
        Ok(())
    }

    /// Lets the script wait while its host is busy with what it did.
    pub(super) fn wait_for<H: Host + ?Sized>(&mut self, host: &H) {
        if let (State::Ready, Some(until)) = (&self.state, host.busy_until()) {
            self.state = State::Pausing { until };
        }
    }

    fn out<H: Host + ?Sized>(&mut self, value: u32, host: &mut H) -> Done {
        match &mut self.sink {
            Sink::Stream(stream) => host.put(*stream, value as u8),
            Sink::Array { array, next } => {
                let outside = FaultKind::IndexOutside { index: *next as i32, length: array.length };
                let cell = element(*array, *next).ok_or(outside)?;
                *next += 1;
                self.memory.store(cell, value);
            }
        }
        Ok(())
    }

    fn out_text<H: Host + ?Sized>(&mut self, text: &str, host: &mut H) -> Done {
        text.bytes().try_for_each(|byte| self.out(byte.into(), host))
    }

    /// "Until the end of the array or until an optional specified EOL character is found" (MCP manual 3.3, STR).
    fn out_string<H: Host + ?Sized>(
        &mut self,
        most: u32,
        has_end: bool,
        host: &mut H,
        load: impl Fn(&Self, u32) -> Option<u32>,
    ) -> Done {
        let end = if has_end { Some(self.pop()? & 0xFF) } else { None };
        let length = self.pop()?.min(most);
        for index in 0..length {
            let value = load(self, index).unwrap_or(0);
            if Some(value & 0xFF) == end {
                break;
            }
            self.out(value, host)?;
        }
        Ok(())
    }

    fn out_table<H: Host + ?Sized>(
        &mut self,
        table: TableRef,
        has_end: bool,
        program: &Program,
        host: &mut H,
    ) -> Done {
        self.out_string(table.length, has_end, host, |_, index| entry(program, table, index).ok())
    }

    /// The next byte; without one the machine waits at this instruction.
    fn byte<H: Host + ?Sized>(&mut self, host: &mut H) -> Option<u8> {
        let byte = host.get(self.source);
        if byte.is_none() {
            self.at = self.at.saturating_sub(1);
            self.state = State::Listening { stream: self.source };
        }
        byte
    }

    fn in_number<H: Host + ?Sized>(&mut self, format: Format, max: u32, host: &mut H) -> Done {
        self.in_digits(host, |reading, byte| reading.take(format, max, byte))
    }

    fn in_real<H: Host + ?Sized>(&mut self, host: &mut H) -> Done {
        self.in_digits(host, |reading, byte| reading.take_real(byte).map(f32::to_bits))
    }

    /// Reads until `take` has a number. A stream of anything else must not hold the caller: it is gone on with in the next step.
    fn in_digits<H: Host + ?Sized>(
        &mut self,
        host: &mut H,
        mut take: impl FnMut(&mut Reading, u8) -> Option<u32>,
    ) -> Done {
        for _ in 0..BYTES_PER_STEP {
            let Some(byte) = self.byte(host) else { return Ok(()) };
            if let Some(value) = take(&mut self.reading, byte) {
                self.reading = Reading::default();
                return self.push(value);
            }
        }
        self.at = self.at.saturating_sub(1);
        Ok(())
    }

    /// Length and end stay on the stack until everything has come.
    fn in_string<H: Host + ?Sized>(&mut self, array: Array, has_end: bool, host: &mut H) -> Done {
        let arguments = 1 + usize::from(has_end);
        let from = self.stack.len().checked_sub(arguments).ok_or(FaultKind::StackEmpty)?;
        let length = self.stack[from].min(array.length);
        let end = has_end.then(|| self.stack[from + 1] & 0xFF);
        while self.reading.stored < length {
            let Some(byte) = self.byte(host) else { return Ok(()) };
            if Some(u32::from(byte)) == end {
                break;
            }
            if let Some(cell) = element(array, self.reading.stored) {
                self.memory.store(cell, byte.into());
            }
            self.reading.stored += 1;
        }
        self.reading = Reading::default();
        self.stack.truncate(from);
        Ok(())
    }
}
