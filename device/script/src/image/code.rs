//! Instructions as bytes: an opcode and its operands.

use super::bytes::{Reader, Writer};
use super::error::ImageError;
use crate::arithmetic::Type;
use crate::board::Board;
use crate::mcl::ast::{Binary, Format, Motion, Unary};
use crate::mcl::registers::RegisterId;
use crate::mcl::types::{Part, VarType};
use crate::op::{Array, Cell, Op, TableRef};
use serde::Serialize;

/// A row of the table of opcodes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub struct Opcode {
    /// Its byte.
    pub code: u8,
    /// Its name in a disassembly.
    pub name: &'static str,
    /// What follows it: `cell` is a type and a varint bit, `array` a cell, a varint stride in bits and a varint length, `table` a type, a varint
    /// byte and a varint length, `target` and `count` varints; types, operators, formats and flags are a byte each.
    pub operands: &'static str,
}

/// What stands behind an opcode.
pub trait Operand: Sized {
    fn write(self, writer: &mut Writer);
    fn read(reader: &mut Reader<'_>) -> Result<Self, ImageError>;
}

impl Operand for u8 {
    fn write(self, writer: &mut Writer) {
        writer.byte(self);
    }

    fn read(reader: &mut Reader<'_>) -> Result<Self, ImageError> {
        reader.byte()
    }
}

impl Operand for u32 {
    fn write(self, writer: &mut Writer) {
        writer.varint(self);
    }

    fn read(reader: &mut Reader<'_>) -> Result<Self, ImageError> {
        reader.varint()
    }
}

impl Operand for bool {
    fn write(self, writer: &mut Writer) {
        writer.byte(self.into());
    }

    fn read(reader: &mut Reader<'_>) -> Result<Self, ImageError> {
        reader.flag()
    }
}

/// Operands that are one of a list, as a byte: its place there.
macro_rules! listed_operands {
    ($($operand:ident $unknown:literal;)*) => {
        $(impl Operand for $operand {
            fn write(self, writer: &mut Writer) {
                writer.byte(self as u8);
            }

            fn read(reader: &mut Reader<'_>) -> Result<Self, ImageError> {
                let index = usize::from(reader.byte()?);
                Self::ALL.get(index).copied().ok_or(ImageError::Malformed($unknown))
            }
        })*
    };
}

listed_operands! {
    Type "an unknown type of number";
    VarType "an unknown type of variable";
    Format "an unknown output modifier";
    Motion "an unknown motion command";
    Board "an unknown command of the board";
    Unary "an unknown operator";
    Binary "an unknown operator";
}

/// Operands of several parts, one behind the other.
macro_rules! joined_operands {
    ($($operand:ident { $($part:tt),* })*) => {
        $(impl Operand for $operand {
            fn write(self, writer: &mut Writer) {
                $(self.$part.write(writer);)*
            }

            fn read(reader: &mut Reader<'_>) -> Result<Self, ImageError> {
                Ok(Self { $($part: Operand::read(reader)?),* })
            }
        })*
    };
}

joined_operands! {
    RegisterId { 0 }
    Cell { kind, at }
    Array { first, stride, length }
    TableRef { kind, at, length }
    Part { kind, first_bit }
}

/// The opcodes: the byte of each, its name, what follows it in words and as the parts of the instruction, in order.
macro_rules! opcodes {
    ($($code:literal $name:literal $operands:literal [$($part:ident)*] $op:ident $(($($shape:tt)*))?;)*) => {
        /// Every opcode.
        pub const OPCODES: &[Opcode] = &[$(Opcode { code: $code, name: $name, operands: $operands }),*];

        pub fn write(writer: &mut Writer, op: Op) {
            match op {
                $(Op::$op $(($($shape)*))? => {
                    writer.byte($code);
                    $($part.write(writer);)*
                })*
            }
        }

        pub fn read(reader: &mut Reader<'_>) -> Result<Op, ImageError> {
            Ok(match reader.byte()? {
                $($code => {
                    $(let $part = Operand::read(reader)?;)*
                    Op::$op $(($($shape)*))?
                })*
                _ => return Err(ImageError::Malformed("an unknown instruction")),
            })
        }
    };
}

opcodes! {
    0x00 "nop" "" [] Nop;
    0x01 "push" "varint" [value] Push(value);
    0x02 "drop" "" [] Drop;
    0x03 "load" "cell" [place] Load(place);
    0x04 "store" "cell" [place] Store(place);
    0x05 "load-at" "array" [array] LoadAt(array);
    0x06 "store-at" "array" [array] StoreAt(array);
    0x07 "load-register" "register, element" [id element] LoadRegister(id, element);
    0x08 "store-register" "register, element" [id element] StoreRegister(id, element);
    0x09 "load-register-at" "register" [id] LoadRegisterAt(id);
    0x0A "store-register-at" "register" [id] StoreRegisterAt(id);
    0x0B "load-table" "table" [constants] LoadTable(constants);
    0x0C "part" "type, first bit" [part] Part(part);
    0x10 "unary" "operator, type" [operator kind] Unary(operator, kind);
    0x11 "binary" "operator, type" [operator kind] Binary(operator, kind);
    0x12 "convert" "type, type" [from to] Convert(from, to);
    0x20 "jump" "target" [to] Jump(to);
    0x21 "jump-if-zero" "target" [to] JumpIfZero(to);
    0x22 "jump-if-not-zero" "target" [to] JumpIfNotZero(to);
    0x23 "branch" "count" [count] Branch(count);
    0x24 "gosub" "target, count" [to count] Gosub(to, count);
    0x25 "return" "" [] Return(None);
    0x26 "return-value" "type" [kind] Return(Some(kind));
    0x27 "result" "type" [kind] Result(kind);
    0x28 "for-start" "cell, loop, flag" [place number has_step] ForStart(place, number, has_step);
    0x29 "for-next" "cell, loop, target" [place number top] ForNext(place, number, top);
    0x2F "end" "" [] End;
    0x30 "out-stream" "" [] OutStream;
    0x31 "out-array" "array" [array] OutArray(array);
    0x32 "out-byte" "" [] OutByte;
    0x33 "out-value" "" [] OutValue;
    0x34 "out-text" "byte, count" [at count] OutText(at, count);
    0x35 "out-number" "format, digits" [format digits] OutNumber(format, digits);
    0x36 "out-real" "digits" [digits] OutReal(digits);
    0x37 "out-repeat" "" [] OutRepeat;
    0x38 "out-string" "array, flag" [array has_end] OutString(array, has_end);
    0x39 "out-table" "table, flag" [constants has_end] OutTable(constants, has_end);
    0x3A "out-end" "" [] OutEnd;
    0x40 "in-stream" "" [] InStream;
    0x41 "in-byte" "" [] InByte;
    0x42 "in-number" "format, digits" [format digits] InNumber(format, digits);
    0x43 "in-real" "" [] InReal;
    0x44 "in-string" "array, flag" [array has_end] InString(array, has_end);
    0x50 "pause" "" [] Pause;
    0x51 "motion" "command, flag" [command extra] Motion(command, extra);
    0x52 "read-eeprom" "" [] ReadEeprom;
    0x53 "write-eeprom" "" [] WriteEeprom;
    0x54 "i2c-out" "count, flag" [count stop] I2cOut(count, stop, None);
    0x55 "i2c-out-or" "count, flag, target" [count stop to] I2cOut(count, stop, Some(to));
    0x56 "i2c-in" "count" [count] I2cIn(count, None);
    0x57 "i2c-in-or" "count, target" [count to] I2cIn(count, Some(to));
    0x58 "clear" "" [] Clear;
    0x60 "handle" "event, target" [event to] Handle(event, to);
    0x61 "events" "flag" [on] Events(on);
    0x62 "wait" "parts of a second" [parts] Wait(parts);
    0x63 "board" "command" [command] Board(command);
    0x64 "load-byte" "" [] LoadByte;
    0x65 "send" "count" [count] Send(count);
    0x66 "receive" "count" [count] Receive(count);
    0x67 "fill" "byte of memory, byte of data, count" [to from count] Fill(to, from, count);
    0x68 "keep" "byte of memory, count" [first count] Keep(first, count);
}

/// The name of an instruction in a disassembly.
#[must_use]
pub fn name(op: Op) -> &'static str {
    let mut writer = Writer::default();
    write(&mut writer, op);
    let code = writer.done().first().copied();
    OPCODES.iter().find(|row| Some(row.code) == code).map_or("?", |row| row.name)
}
