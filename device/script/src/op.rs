//! The instructions of the virtual machine, which works on a stack of 32 bit cells.
//!
//! Bits of memory are counted from bit 0 of byte 0. Jumps count instructions from 0. What an instruction takes from the stack it
//! takes in the order in which it was put there: `StoreAt` finds the value below the index.

use crate::arithmetic::Type;
use crate::board::Board;
use crate::mcl::ast::{Binary, Format, Motion, Unary};
use crate::mcl::registers::RegisterId;
use crate::mcl::types::{Part, VarType};

/// A value in memory.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Cell {
    /// Its type.
    pub kind: VarType,
    /// Its first bit; all but bits and nibbles begin at a whole byte.
    pub at: u32,
}

/// Values in memory at equal distances.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Array {
    /// The first.
    pub first: Cell,
    /// Bits from one to the next.
    pub stride: u32,
    /// How many.
    pub length: u32,
}

/// Constants in the program's data.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct TableRef {
    /// Type of an entry.
    pub kind: VarType,
    /// First byte.
    pub at: u32,
    /// How many entries.
    pub length: u32,
}

/// One instruction.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Op {
    /// Nothing.
    Nop,
    /// Puts a constant on the stack.
    Push(u32),
    /// Takes a value away.
    Drop,
    /// Puts a variable on the stack.
    Load(Cell),
    /// Takes a value into a variable.
    Store(Cell),
    /// Takes an index, puts the element there.
    LoadAt(Array),
    /// Takes a value and an index.
    StoreAt(Array),
    /// Puts an element of a register.
    LoadRegister(RegisterId, u8),
    /// Takes a value into an element of a register.
    StoreRegister(RegisterId, u8),
    /// Takes an index, puts the register's element.
    LoadRegisterAt(RegisterId),
    /// Takes a value and an index.
    StoreRegisterAt(RegisterId),
    /// Takes an index, puts the entry of a table.
    LoadTable(TableRef),
    /// Takes a value, puts a part of it.
    Part(Part),
    /// Takes one value, puts one.
    Unary(Unary, Type),
    /// Takes two values, puts one.
    Binary(Binary, Type),
    /// Takes a value of one type, puts it as another.
    Convert(Type, Type),
    /// Goes on there.
    Jump(u32),
    /// Takes a value; goes on there if it is zero.
    JumpIfZero(u32),
    /// Takes a value; goes on there if it is not zero.
    JumpIfNotZero(u32),
    /// Takes an index. That many of the following jumps are skipped; all of them if there are not so many.
    Branch(u32),
    /// Calls the subroutine there, which takes so many arguments from the stack.
    Gosub(u32, u32),
    /// Returns from a subroutine, with a value of this type if it has one.
    Return(Option<Type>),
    /// Puts what the last subroutine returned, as this type.
    Result(Type),
    /// Takes first value, last value and, with `true`, step, and begins the loop of this number.
    ForStart(Cell, u32, bool),
    /// Takes the last value; counts the loop of this number, and jumps if it goes on.
    ForNext(Cell, u32, u32),
    /// Takes a stream; what follows is sent there.
    OutStream,
    /// What follows is stored in an array, from its first element.
    OutArray(Array),
    /// Takes a value and sends its low byte.
    OutByte,
    /// Takes a value and stores it as an element.
    OutValue,
    /// Sends bytes of the program's data: first byte, count.
    OutText(u32, u32),
    /// Takes a value and the least number of digits; sends digits, of which there are at most so many (0: all).
    OutNumber(Format, u32),
    /// Takes a float and the largest number of decimals (-1: as many as it has); 0 or the largest number of digits before the point.
    OutReal(u32),
    /// Takes a character and a count.
    OutRepeat,
    /// Takes a length and, with `true`, an end; sends elements of an array.
    OutString(Array, bool),
    /// Takes a length and, with `true`, an end; sends entries of a table.
    OutTable(TableRef, bool),
    /// Ends the output.
    OutEnd,
    /// Takes a stream; what follows is read from there.
    InStream,
    /// Waits for a byte and puts it.
    InByte,
    /// Waits for digits and puts their number; at most so many (0: all).
    InNumber(Format, u32),
    /// Waits for a number with a point and puts it.
    InReal,
    /// Takes a length and, with `true`, an end; stores bytes in an array.
    InString(Array, bool),
    /// Takes milliseconds and waits.
    Pause,
    /// Takes the arguments of a motion command; with `true` a buffer argument beyond its syntax.
    Motion(Motion, bool),
    /// Takes an address, puts the byte of the EEPROM.
    ReadEeprom,
    /// Takes an address and a byte.
    WriteEeprom,
    /// Takes so many bytes (and, with a target, the timeout after them) and sends them; jumps to the target on an error.
    I2cOut(u32, bool, Option<u32>),
    /// Takes the timeout if there is a target; puts so many bytes, the first on top; jumps to the target on an error.
    I2cIn(u32, Option<u32>),
    /// Sets all variables to zero.
    Clear,
    /// From now on the event of this number calls what is there.
    Handle(u32, u32),
    /// Whether events call their handlers, or are kept until they may.
    Events(bool),
    /// Takes a count and waits until a clock that has so many ticks a second has ticked so often.
    Wait(u32),
    /// Takes the arguments of a command of the board; puts what it gives, if it gives anything.
    Board(Board),
    /// Takes the address of a byte of memory, puts that byte.
    LoadByte,
    /// Takes an address and sends so many bytes of memory from there on.
    Send(u32),
    /// Takes an address and stores there so many bytes that were received.
    Receive(u32),
    /// Copies constants into memory: first byte there, first byte of the data, how many.
    Fill(u32, u32, u32),
    /// Keeps so many bytes of memory from this one on, and puts them back when the subroutine returns.
    Keep(u32, u32),
    /// Ends the program.
    End,
}
