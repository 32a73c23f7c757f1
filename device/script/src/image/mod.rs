//! Programs as bytes: what is downloaded to a simulated controller and what `brushwork mcl build` writes.
//!
//! The makers' byte code is not public, so this is a format of our own, and its header says so. All numbers are little-endian;
//! `varint` is a whole number in groups of seven bits, the lowest first, each but the last with the top bit set.
//!
//! | Bytes | What |
//! | --- | --- |
//! | 0 to 7 | `BWMCLIMG` |
//! | 8, 9 | version of the format, [`VERSION`] |
//! | 10, 11 | 0, kept for later |
//! | 12 to 15 | length of the image in bytes, this header included; what follows is padding |
//! | 16 to 19 | CRC-32 (IEEE) of the bytes from 20 to the end |
//! | 20 on | varints: bytes of variables, FOR loops, then the sections |
//! | code | varint count of instructions; each its opcode and operands, see [`OPCODES`] |
//! | data | varint count of bytes; tables and texts |
//! | lines | pairs of varints up to the last instruction: how many instructions, by how much their line differs from the one before (zigzag) |
//! | variables | varint count; each a name, an array and 1 if it was defined with a size |
//! | labels | varint count; each a name and its instruction |
//!
//! A name is a varint count of bytes and UTF-8. An image is filled up with 0xFF to whole rows of [`ROW_BYTES`], because that is what
//! command 251 writes.
//!
//! A file holds [`FILE_HEADER_BYTES`] bytes for people and then the image: the makers' tool skips so many before it downloads.

mod bytes;
mod code;
mod error;
mod size;
mod validate;

pub use code::{OPCODES, Opcode, name};
pub use error::{ImageError, VERSION};

use crate::program::{Program, Variable, limits};
use bytes::{Reader, Writer};
use code::Operand;

/// The first bytes of every image.
pub const MAGIC: [u8; 8] = *b"BWMCLIMG";
/// An image is a multiple of this long.
pub const ROW_BYTES: usize = 16;
/// What fills up the last row, as an erased memory would.
pub const PADDING: u8 = 0xFF;

const HEADER_BYTES: usize = 20;

/// How long the image is that begins here, if one does; for whoever keeps it among other bytes.
#[must_use]
pub fn length(bytes: &[u8]) -> Option<usize> {
    let length = bytes.get(12..16)?.try_into().ok()?;
    bytes.starts_with(&MAGIC).then(|| u32::from_le_bytes(length) as usize)
}

/// What a file has before its image.
pub const FILE_HEADER_BYTES: usize = 0x100;

const FILE_TITLE: &str = "Brushwork MCL image, format 1\r\n\
    A compiled script for Brushwork's simulated controllers. The byte code of real controllers is not public; they do not run this.\r\n";

/// The file of an image.
#[must_use]
pub fn to_file(image: &[u8]) -> Vec<u8> {
    let mut file = FILE_TITLE.as_bytes().to_vec();
    file.resize(FILE_HEADER_BYTES, 0x1A);
    file.extend_from_slice(image);
    file
}

/// The image in a file, if the file is one of ours.
#[must_use]
pub fn of_file(file: &[u8]) -> Option<&[u8]> {
    file.get(FILE_HEADER_BYTES..).filter(|image| image.starts_with(&MAGIC))
}

/// How many bytes the instructions of a program take.
#[must_use]
pub fn code_bytes(program: &Program) -> usize {
    let mut writer = Writer::default();
    program.ops.iter().for_each(|op| code::write(&mut writer, *op));
    writer.done().len()
}

/// The image of a program.
#[must_use]
pub fn encode(program: &Program) -> Vec<u8> {
    let mut writer = Writer::default();
    writer.varint(program.ram_bytes);
    writer.varint(program.loops);
    writer.count(program.ops.len());
    program.ops.iter().for_each(|op| code::write(&mut writer, *op));
    writer.count(program.data.len());
    writer.bytes(&program.data);
    write_lines(&mut writer, &program.lines);
    writer.count(program.variables.len());
    for variable in &program.variables {
        writer.name(&variable.name);
        variable.memory.write(&mut writer);
        writer.byte(variable.is_array.into());
    }
    writer.count(program.labels.len());
    for (name, at) in &program.labels {
        writer.name(name);
        writer.varint(*at);
    }
    let body = writer.done();
    let length = u32::try_from(HEADER_BYTES + body.len()).unwrap_or(u32::MAX);
    let mut image = MAGIC.to_vec();
    image.extend(VERSION.to_le_bytes());
    image.extend([0, 0]);
    image.extend(length.to_le_bytes());
    image.extend(crc32fast::hash(&body).to_le_bytes());
    image.extend(body);
    image.resize(image.len().next_multiple_of(ROW_BYTES), PADDING);
    image
}

/// The program in an image. What comes after the length that its header gives is not looked at.
///
/// # Errors
/// The bytes are no image, of another version, cut, damaged, or make no program that the machine could run. Nothing panics.
pub fn decode(bytes: &[u8]) -> Result<Program, ImageError> {
    if bytes.len() < HEADER_BYTES || !bytes.starts_with(&MAGIC) {
        return Err(ImageError::NotAnImage);
    }
    let version = u16::from_le_bytes([bytes[8], bytes[9]]);
    if version != VERSION {
        return Err(ImageError::OtherVersion(version));
    }
    let wants = length(bytes).unwrap_or(0);
    let body = bytes.get(HEADER_BYTES..wants).ok_or(ImageError::Cut { has: bytes.len(), wants })?;
    let checksum = u32::from_le_bytes([bytes[16], bytes[17], bytes[18], bytes[19]]);
    if crc32fast::hash(body) != checksum {
        return Err(ImageError::Damaged);
    }
    let program = read(&mut Reader::new(body))?;
    validate::program(&program)?;
    Ok(program)
}

fn read(reader: &mut Reader<'_>) -> Result<Program, ImageError> {
    let ram_bytes = reader.at_most(limits::RAM_BYTES, "too much memory for variables")?;
    let loops = reader.at_most(limits::LOOPS, "too many loops")?;
    let count = reader.count(limits::INSTRUCTIONS, "too many instructions")?;
    let ops = (0..count).map(|_| code::read(reader)).collect::<Result<Vec<_>, _>>()?;
    let count = reader.count(limits::DATA_BYTES, "too much data")?;
    let data = reader.bytes(count)?.to_vec();
    let lines = read_lines(reader, ops.len())?;
    let count = reader.count(limits::NAMES, "too many variables")?;
    let variables = (0..count).map(|_| read_variable(reader)).collect::<Result<Vec<_>, _>>()?;
    let count = reader.count(limits::NAMES, "too many labels")?;
    let label = |reader: &mut Reader<'_>| Ok((reader.name()?, reader.varint()?));
    let labels = (0..count).map(|_| label(reader)).collect::<Result<Vec<_>, ImageError>>()?;
    Ok(Program { ops, lines, data, ram_bytes, loops, variables, labels })
}

fn read_variable(reader: &mut Reader<'_>) -> Result<Variable, ImageError> {
    Ok(Variable { name: reader.name()?, memory: Operand::read(reader)?, is_array: reader.flag()? })
}

fn write_lines(writer: &mut Writer, lines: &[u32]) {
    let mut before = 0u32;
    for run in lines.chunk_by(|a, b| a == b) {
        writer.count(run.len());
        let difference = run[0].wrapping_sub(before) as i32;
        writer.varint(((difference << 1) ^ (difference >> 31)) as u32);
        before = run[0];
    }
}

fn read_lines(reader: &mut Reader<'_>, count: usize) -> Result<Vec<u32>, ImageError> {
    let mut lines = Vec::new();
    let mut line = 0u32;
    while lines.len() < count {
        let run = reader.count(count - lines.len(), "more lines than instructions")?;
        if run == 0 {
            return Err(ImageError::Malformed("a line without instructions"));
        }
        let zigzag = reader.varint()?;
        line = line.wrapping_add((zigzag >> 1) ^ (zigzag & 1).wrapping_neg());
        lines.resize(lines.len() + run, line);
    }
    Ok(lines)
}

#[cfg(test)]
mod tests;
