//! Instructions as bytes: an opcode and its operands.

use super::bytes::{Reader, Writer};
use super::error::ImageError;
use crate::arithmetic::Type;
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

macro_rules! opcodes {
    ($($constant:ident = $code:literal $name:literal $operands:literal;)*) => {
        $(const $constant: u8 = $code;)*
        /// Every opcode.
        pub const OPCODES: &[Opcode] = &[$(Opcode { code: $code, name: $name, operands: $operands }),*];
    };
}

opcodes! {
    NOP = 0x00 "nop" "";
    PUSH = 0x01 "push" "varint";
    DROP = 0x02 "drop" "";
    LOAD = 0x03 "load" "cell";
    STORE = 0x04 "store" "cell";
    LOAD_AT = 0x05 "load-at" "array";
    STORE_AT = 0x06 "store-at" "array";
    LOAD_REGISTER = 0x07 "load-register" "register, element";
    STORE_REGISTER = 0x08 "store-register" "register, element";
    LOAD_REGISTER_AT = 0x09 "load-register-at" "register";
    STORE_REGISTER_AT = 0x0A "store-register-at" "register";
    LOAD_TABLE = 0x0B "load-table" "table";
    PART = 0x0C "part" "type, first bit";
    UNARY = 0x10 "unary" "operator, type";
    BINARY = 0x11 "binary" "operator, type";
    CONVERT = 0x12 "convert" "type, type";
    JUMP = 0x20 "jump" "target";
    JUMP_IF_ZERO = 0x21 "jump-if-zero" "target";
    JUMP_IF_NOT_ZERO = 0x22 "jump-if-not-zero" "target";
    BRANCH = 0x23 "branch" "count";
    GOSUB = 0x24 "gosub" "target, count";
    RETURN = 0x25 "return" "";
    RETURN_VALUE = 0x26 "return-value" "type";
    RESULT = 0x27 "result" "type";
    FOR_START = 0x28 "for-start" "cell, loop, flag";
    FOR_NEXT = 0x29 "for-next" "cell, loop, target";
    END = 0x2F "end" "";
    OUT_STREAM = 0x30 "out-stream" "";
    OUT_ARRAY = 0x31 "out-array" "array";
    OUT_BYTE = 0x32 "out-byte" "";
    OUT_VALUE = 0x33 "out-value" "";
    OUT_TEXT = 0x34 "out-text" "byte, count";
    OUT_NUMBER = 0x35 "out-number" "format, digits";
    OUT_REAL = 0x36 "out-real" "digits";
    OUT_REPEAT = 0x37 "out-repeat" "";
    OUT_STRING = 0x38 "out-string" "array, flag";
    OUT_TABLE = 0x39 "out-table" "table, flag";
    OUT_END = 0x3A "out-end" "";
    IN_STREAM = 0x40 "in-stream" "";
    IN_BYTE = 0x41 "in-byte" "";
    IN_NUMBER = 0x42 "in-number" "format, digits";
    IN_REAL = 0x43 "in-real" "";
    IN_STRING = 0x44 "in-string" "array, flag";
    PAUSE = 0x50 "pause" "";
    MOTION = 0x51 "motion" "command, flag";
    READ_EEPROM = 0x52 "read-eeprom" "";
    WRITE_EEPROM = 0x53 "write-eeprom" "";
    I2C_OUT = 0x54 "i2c-out" "count, flag";
    I2C_OUT_OR = 0x55 "i2c-out-or" "count, flag, target";
    I2C_IN = 0x56 "i2c-in" "count";
    I2C_IN_OR = 0x57 "i2c-in-or" "count, target";
    CLEAR = 0x58 "clear" "";
}

/// The name of an instruction in a disassembly.
#[must_use]
pub fn name(op: Op) -> &'static str {
    let mut writer = Writer::default();
    write(&mut writer, op);
    let code = writer.done().first().copied().unwrap_or(NOP);
    OPCODES.iter().find(|row| row.code == code).map_or("?", |row| row.name)
}

fn cell(writer: &mut Writer, cell: Cell) {
    writer.byte(cell.kind as u8);
    writer.varint(cell.at);
}

pub fn write_array(writer: &mut Writer, array: Array) {
    cell(writer, array.first);
    writer.varint(array.stride);
    writer.varint(array.length);
}

fn table(writer: &mut Writer, table: TableRef) {
    writer.byte(table.kind as u8);
    writer.varint(table.at);
    writer.varint(table.length);
}

/// An opcode with operands of a byte.
fn short(writer: &mut Writer, code: u8, operands: &[u8]) {
    writer.byte(code);
    writer.bytes(operands);
}

/// An opcode with varints.
fn long(writer: &mut Writer, code: u8, operands: &[u32]) {
    writer.byte(code);
    operands.iter().for_each(|operand| writer.varint(*operand));
}

#[allow(clippy::wildcard_enum_match_arm, reason = "one answer for all the rest, new members too")]
pub fn write(writer: &mut Writer, op: Op) {
    match op {
        Op::Nop => writer.byte(NOP),
        Op::Push(value) => long(writer, PUSH, &[value]),
        Op::Drop => writer.byte(DROP),
        Op::Load(place) => {
            writer.byte(LOAD);
            cell(writer, place);
        }
        Op::Store(place) => {
            writer.byte(STORE);
            cell(writer, place);
        }
        Op::LoadAt(array) => with_array(writer, LOAD_AT, array),
        Op::StoreAt(array) => with_array(writer, STORE_AT, array),
        Op::LoadRegister(id, element) => short(writer, LOAD_REGISTER, &[id.0, element]),
        Op::StoreRegister(id, element) => short(writer, STORE_REGISTER, &[id.0, element]),
        Op::LoadRegisterAt(id) => short(writer, LOAD_REGISTER_AT, &[id.0]),
        Op::StoreRegisterAt(id) => short(writer, STORE_REGISTER_AT, &[id.0]),
        Op::LoadTable(constants) => {
            writer.byte(LOAD_TABLE);
            table(writer, constants);
        }
        Op::Part(part) => {
            short(writer, PART, &[part.kind as u8]);
            writer.varint(part.first_bit);
        }
        Op::Unary(operator, kind) => short(writer, UNARY, &[operator as u8, kind as u8]),
        Op::Binary(operator, kind) => short(writer, BINARY, &[operator as u8, kind as u8]),
        Op::Convert(from, to) => short(writer, CONVERT, &[from as u8, to as u8]),
        Op::Clear => writer.byte(CLEAR),
        Op::End => writer.byte(END),
        other => write_flow(writer, other),
    }
}

fn with_array(writer: &mut Writer, code: u8, array: Array) {
    writer.byte(code);
    write_array(writer, array);
}

#[allow(clippy::wildcard_enum_match_arm, reason = "one answer for all the rest, new members too")]
fn write_flow(writer: &mut Writer, op: Op) {
    match op {
        Op::Jump(to) => long(writer, JUMP, &[to]),
        Op::JumpIfZero(to) => long(writer, JUMP_IF_ZERO, &[to]),
        Op::JumpIfNotZero(to) => long(writer, JUMP_IF_NOT_ZERO, &[to]),
        Op::Branch(count) => long(writer, BRANCH, &[count]),
        Op::Gosub(to, count) => long(writer, GOSUB, &[to, count]),
        Op::Return(None) => writer.byte(RETURN),
        Op::Return(Some(kind)) => short(writer, RETURN_VALUE, &[kind as u8]),
        Op::Result(kind) => short(writer, RESULT, &[kind as u8]),
        Op::ForStart(place, number, has_step) => {
            writer.byte(FOR_START);
            cell(writer, place);
            writer.varint(number);
            writer.byte(has_step.into());
        }
        Op::ForNext(place, number, top) => {
            writer.byte(FOR_NEXT);
            cell(writer, place);
            writer.varint(number);
            writer.varint(top);
        }
        Op::Pause => writer.byte(PAUSE),
        Op::Motion(command, extra) => short(writer, MOTION, &[command as u8, extra.into()]),
        Op::ReadEeprom => writer.byte(READ_EEPROM),
        Op::WriteEeprom => writer.byte(WRITE_EEPROM),
        Op::I2cOut(count, stop, None) => long(writer, I2C_OUT, &[count, stop.into()]),
        Op::I2cOut(count, stop, Some(to)) => long(writer, I2C_OUT_OR, &[count, stop.into(), to]),
        Op::I2cIn(count, None) => long(writer, I2C_IN, &[count]),
        Op::I2cIn(count, Some(to)) => long(writer, I2C_IN_OR, &[count, to]),
        other => write_streams(writer, other),
    }
}

#[allow(clippy::wildcard_enum_match_arm, reason = "one answer for all the rest, new members too")]
fn write_streams(writer: &mut Writer, op: Op) {
    match op {
        Op::OutStream => writer.byte(OUT_STREAM),
        Op::OutArray(array) => with_array(writer, OUT_ARRAY, array),
        Op::OutByte => writer.byte(OUT_BYTE),
        Op::OutValue => writer.byte(OUT_VALUE),
        Op::OutText(at, count) => long(writer, OUT_TEXT, &[at, count]),
        Op::OutNumber(format, digits) => {
            short(writer, OUT_NUMBER, &[format as u8]);
            writer.varint(digits);
        }
        Op::OutReal(digits) => long(writer, OUT_REAL, &[digits]),
        Op::OutRepeat => writer.byte(OUT_REPEAT),
        Op::OutString(array, has_end) => {
            with_array(writer, OUT_STRING, array);
            writer.byte(has_end.into());
        }
        Op::OutTable(constants, has_end) => {
            writer.byte(OUT_TABLE);
            table(writer, constants);
            writer.byte(has_end.into());
        }
        Op::OutEnd => writer.byte(OUT_END),
        Op::InStream => writer.byte(IN_STREAM),
        Op::InByte => writer.byte(IN_BYTE),
        Op::InNumber(format, digits) => {
            short(writer, IN_NUMBER, &[format as u8]);
            writer.varint(digits);
        }
        Op::InReal => writer.byte(IN_REAL),
        Op::InString(array, has_end) => {
            with_array(writer, IN_STRING, array);
            writer.byte(has_end.into());
        }
        // The others have been written by those that call this.
        _ => writer.byte(NOP),
    }
}

/// The row of a table of values that a byte names.
fn one_of<T: Copy>(reader: &mut Reader<'_>, all: &[T], what: &'static str) -> Result<T, ImageError> {
    let index = usize::from(reader.byte()?);
    all.get(index).copied().ok_or(ImageError::Malformed(what))
}

fn read_type(reader: &mut Reader<'_>) -> Result<Type, ImageError> {
    one_of(reader, &Type::ALL, "an unknown type of number")
}

fn read_kind(reader: &mut Reader<'_>) -> Result<VarType, ImageError> {
    one_of(reader, &VarType::ALL, "an unknown type of variable")
}

fn read_format(reader: &mut Reader<'_>) -> Result<Format, ImageError> {
    one_of(reader, &Format::ALL, "an unknown output modifier")
}

fn read_cell(reader: &mut Reader<'_>) -> Result<Cell, ImageError> {
    Ok(Cell { kind: read_kind(reader)?, at: reader.varint()? })
}

pub fn read_array(reader: &mut Reader<'_>) -> Result<Array, ImageError> {
    Ok(Array { first: read_cell(reader)?, stride: reader.varint()?, length: reader.varint()? })
}

fn read_table(reader: &mut Reader<'_>) -> Result<TableRef, ImageError> {
    Ok(TableRef { kind: read_kind(reader)?, at: reader.varint()?, length: reader.varint()? })
}

fn read_register(reader: &mut Reader<'_>) -> Result<RegisterId, ImageError> {
    reader.byte().map(RegisterId)
}

pub fn read(reader: &mut Reader<'_>) -> Result<Op, ImageError> {
    let code = reader.byte()?;
    Ok(match code {
        NOP => Op::Nop,
        PUSH => Op::Push(reader.varint()?),
        DROP => Op::Drop,
        LOAD => Op::Load(read_cell(reader)?),
        STORE => Op::Store(read_cell(reader)?),
        LOAD_AT => Op::LoadAt(read_array(reader)?),
        STORE_AT => Op::StoreAt(read_array(reader)?),
        LOAD_REGISTER => Op::LoadRegister(read_register(reader)?, reader.byte()?),
        STORE_REGISTER => Op::StoreRegister(read_register(reader)?, reader.byte()?),
        LOAD_REGISTER_AT => Op::LoadRegisterAt(read_register(reader)?),
        STORE_REGISTER_AT => Op::StoreRegisterAt(read_register(reader)?),
        LOAD_TABLE => Op::LoadTable(read_table(reader)?),
        PART => Op::Part(Part { kind: read_kind(reader)?, first_bit: reader.varint()? }),
        UNARY => Op::Unary(one_of(reader, &Unary::ALL, "an unknown operator")?, read_type(reader)?),
        BINARY => Op::Binary(one_of(reader, &Binary::ALL, "an unknown operator")?, read_type(reader)?),
        CONVERT => Op::Convert(read_type(reader)?, read_type(reader)?),
        CLEAR => Op::Clear,
        END => Op::End,
        0x20..=0x2E | 0x50..=0x57 => read_flow(code, reader)?,
        _ => read_streams(code, reader)?,
    })
}

const UNKNOWN: ImageError = ImageError::Malformed("an unknown instruction");

fn read_flow(code: u8, reader: &mut Reader<'_>) -> Result<Op, ImageError> {
    Ok(match code {
        JUMP => Op::Jump(reader.varint()?),
        JUMP_IF_ZERO => Op::JumpIfZero(reader.varint()?),
        JUMP_IF_NOT_ZERO => Op::JumpIfNotZero(reader.varint()?),
        BRANCH => Op::Branch(reader.varint()?),
        GOSUB => Op::Gosub(reader.varint()?, reader.varint()?),
        RETURN => Op::Return(None),
        RETURN_VALUE => Op::Return(Some(read_type(reader)?)),
        RESULT => Op::Result(read_type(reader)?),
        FOR_START => Op::ForStart(read_cell(reader)?, reader.varint()?, reader.flag()?),
        FOR_NEXT => Op::ForNext(read_cell(reader)?, reader.varint()?, reader.varint()?),
        PAUSE => Op::Pause,
        MOTION => Op::Motion(one_of(reader, &Motion::ALL, "an unknown motion command")?, reader.flag()?),
        READ_EEPROM => Op::ReadEeprom,
        WRITE_EEPROM => Op::WriteEeprom,
        I2C_OUT => Op::I2cOut(reader.varint()?, reader.flag()?, None),
        I2C_OUT_OR => Op::I2cOut(reader.varint()?, reader.flag()?, Some(reader.varint()?)),
        I2C_IN => Op::I2cIn(reader.varint()?, None),
        I2C_IN_OR => Op::I2cIn(reader.varint()?, Some(reader.varint()?)),
        _ => return Err(UNKNOWN),
    })
}

fn read_streams(code: u8, reader: &mut Reader<'_>) -> Result<Op, ImageError> {
    Ok(match code {
        OUT_STREAM => Op::OutStream,
        OUT_ARRAY => Op::OutArray(read_array(reader)?),
        OUT_BYTE => Op::OutByte,
        OUT_VALUE => Op::OutValue,
        OUT_TEXT => Op::OutText(reader.varint()?, reader.varint()?),
        OUT_NUMBER => Op::OutNumber(read_format(reader)?, reader.varint()?),
        OUT_REAL => Op::OutReal(reader.varint()?),
        OUT_REPEAT => Op::OutRepeat,
        OUT_STRING => Op::OutString(read_array(reader)?, reader.flag()?),
        OUT_TABLE => Op::OutTable(read_table(reader)?, reader.flag()?),
        OUT_END => Op::OutEnd,
        IN_STREAM => Op::InStream,
        IN_BYTE => Op::InByte,
        IN_NUMBER => Op::InNumber(read_format(reader)?, reader.varint()?),
        IN_REAL => Op::InReal,
        IN_STRING => Op::InString(read_array(reader)?, reader.flag()?),
        _ => return Err(UNKNOWN),
    })
}
