//! Whether the places that instructions name lie inside the program. The machine checks what only shows when it runs (the stack,
//! indices); what stands here it takes for granted.

use super::error::ImageError;
use crate::mcl::registers::{REGISTERS, RegisterId};
use crate::mcl::types::VarType;
use crate::op::{Array, Cell, Op, TableRef};
use crate::program::{Program, limits};

type Valid = Result<(), ImageError>;

fn require(holds: bool, what: &'static str) -> Valid {
    if holds { Ok(()) } else { Err(ImageError::Malformed(what)) }
}

pub fn program(program: &Program) -> Valid {
    require(!program.ops.is_empty(), "it has no instruction")?;
    for op in &program.ops {
        instruction(program, *op)?;
    }
    for variable in &program.variables {
        array(program, variable.memory)?;
    }
    for (_, at) in &program.labels {
        target(program, *at)?;
    }
    Ok(())
}

#[allow(clippy::wildcard_enum_match_arm, reason = "one answer for all the rest, new members too")]
fn instruction(program: &Program, op: Op) -> Valid {
    match op {
        Op::Load(place) | Op::Store(place) => cell(program, place),
        Op::LoadAt(list) | Op::StoreAt(list) | Op::OutArray(list) => array(program, list),
        Op::OutString(list, _) | Op::InString(list, _) => array(program, list),
        Op::LoadRegister(id, element) | Op::StoreRegister(id, element) => register(id, element),
        Op::LoadRegisterAt(id) | Op::StoreRegisterAt(id) => register(id, 0),
        Op::LoadTable(constants) | Op::OutTable(constants, _) => table(program, constants),
        Op::Part(part) => require(part.first_bit < 32, "a part outside its variable"),
        Op::Jump(to) | Op::JumpIfZero(to) | Op::JumpIfNotZero(to) => target(program, to),
        Op::Gosub(to, count) => {
            target(program, to)?;
            few(count)
        }
        Op::ForStart(place, number, _) => {
            cell(program, place)?;
            require(number < program.loops, "a loop that is not there")
        }
        Op::ForNext(place, number, to) => {
            cell(program, place)?;
            target(program, to)?;
            require(number < program.loops, "a loop that is not there")
        }
        Op::OutText(at, count) => data(program, at, u64::from(count)),
        Op::Handle(event, to) => {
            target(program, to)?;
            require(event < limits::EVENTS, "an event that is not there")
        }
        Op::Wait(parts) => require(parts > 0, "a wait of no length"),
        Op::Send(count) | Op::Receive(count) => {
            require(count <= limits::FRAME_BYTES, "more bytes than are sent at once")
        }
        Op::Fill(to, from, count) => {
            bytes(program, to, count)?;
            data(program, from, u64::from(count))
        }
        Op::Keep(first, count) => bytes(program, first, count),
        Op::I2cOut(count, _, otherwise) | Op::I2cIn(count, otherwise) => {
            otherwise.map_or(Ok(()), |to| target(program, to))?;
            few(count)
        }
        _ => Ok(()),
    }
}

/// What is taken from the stack at once.
fn few(count: u32) -> Valid {
    require(count as usize <= limits::STACK_CELLS, "more values than the stack holds")
}

fn target(program: &Program, at: u32) -> Valid {
    require((at as usize) < program.ops.len(), "a jump out of the program")
}

fn cell(program: &Program, cell: Cell) -> Valid {
    array(program, Array { first: cell, stride: cell.kind.bits(), length: 1 })
}

fn array(program: &Program, array: Array) -> Valid {
    let last = u64::from(array.length.max(1) - 1) * u64::from(array.stride);
    let end = u64::from(array.first.at) + last + u64::from(array.first.kind.bits());
    require(end <= u64::from(program.ram_bytes) * 8, "a variable outside the memory")
}

fn bytes(program: &Program, first: u32, count: u32) -> Valid {
    let end = u64::from(first) + u64::from(count);
    require(end <= u64::from(program.ram_bytes), "a variable outside the memory")
}

fn table(program: &Program, table: TableRef) -> Valid {
    require(!matches!(table.kind, VarType::Bit | VarType::Nib), "a table of parts of bytes")?;
    data(program, table.at, u64::from(table.length) * u64::from(table.kind.bits() / 8))
}

fn data(program: &Program, at: u32, count: u64) -> Valid {
    require(u64::from(at) + count <= program.data.len() as u64, "constants outside the data")
}

fn register(id: RegisterId, element: u8) -> Valid {
    let row = REGISTERS.get(usize::from(id.0));
    require(row.is_some_and(|row| element < row.length), "a register that is not there")
}
