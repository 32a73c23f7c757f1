//! Images byte by byte, whole and damaged.

use super::*;
use crate::mcl::compile;
use crate::op::Op;

const TEXT: &str = "\
names ByteTable \"abc\"
list var word(3)
i var byte
main
for i = 0 to 2
list(i) = names(i) * 300
next
puts 0,[str names\\3,dec list(2),13]
goto main
";

fn program() -> Program {
    compile(TEXT).program.unwrap()
}

#[test]
fn an_image_gives_the_program_back_and_is_whole_rows() {
    let program = program();
    let image = encode(&program);
    assert_eq!(image.len() % ROW_BYTES, 0);
    assert_eq!(decode(&image), Ok(program.clone()));
    // What stands behind it in memory does not matter.
    let mut memory = image.clone();
    memory.extend([PADDING; 64]);
    assert_eq!(decode(&memory), Ok(program));
    assert!(length(&image).unwrap() <= image.len());
}

#[test]
fn the_header_is_what_the_documentation_says() {
    let program = Program { ops: vec![Op::Push(300), Op::End], lines: vec![1, 3], ..Program::default() };
    let body = [
        0, // bytes of variables
        0, // FOR loops
        2, // instructions
        0x01, 0xAC, 0x02, // push 300
        0x2F, // end
        0,    // bytes of data
        1, 2, // one instruction, one line on
        1, 4, // one instruction, two lines on
        0, // variables
        0, // labels
    ];
    let mut expected = b"BWMCLIMG\x01\x00\x00\x00".to_vec();
    expected.extend([34, 0, 0, 0]); // 20 bytes of header and 14 of body
    expected.extend(crc32fast::hash(&body).to_le_bytes());
    expected.extend(body);
    expected.resize(48, 0xFF);
    assert_eq!(encode(&program), expected);
}

#[test]
fn what_is_no_image_is_refused_with_the_reason() {
    let image = encode(&program());
    let length = length(&image).unwrap();
    assert_eq!(decode(b"hello"), Err(ImageError::NotAnImage));
    assert_eq!(decode(&[PADDING; 400]), Err(ImageError::NotAnImage));
    assert_eq!(decode(&image[..length - 1]), Err(ImageError::Cut { has: length - 1, wants: length }));
    let mut other = image.clone();
    other[8] = 9;
    assert_eq!(decode(&other), Err(ImageError::OtherVersion(9)));
    for at in HEADER_BYTES..length {
        let mut damaged = image.clone();
        damaged[at] ^= 1;
        assert_eq!(decode(&damaged), Err(ImageError::Damaged), "byte {at}");
    }
}

/// The image of some body, with the right length and checksum.
fn wrapped(body: &[u8]) -> Vec<u8> {
    let mut image = MAGIC.to_vec();
    image.extend([1, 0, 0, 0]);
    image.extend((20 + body.len() as u32).to_le_bytes());
    image.extend(crc32fast::hash(body).to_le_bytes());
    image.extend(body);
    image
}

#[test]
fn places_outside_the_program_are_refused() {
    let refused = |op: Op| {
        let program = Program { ops: vec![op, Op::End], lines: vec![1, 1], ..Program::default() };
        assert!(matches!(decode(&encode(&program)), Err(ImageError::Malformed(_))), "{op:?}");
    };
    let cell = crate::op::Cell { kind: crate::mcl::types::VarType::Long, at: 0 };
    let array = crate::op::Array { first: cell, stride: u32::MAX, length: u32::MAX };
    refused(Op::Load(cell));
    refused(Op::StoreAt(array));
    refused(Op::Jump(2));
    refused(Op::Gosub(0, u32::MAX));
    refused(Op::I2cIn(u32::MAX, None));
    refused(Op::OutText(0, 1));
    refused(Op::ForNext(cell, 0, 0));
    refused(Op::LoadRegister(crate::mcl::registers::RegisterId(80), 0));
    refused(Op::LoadRegister(crate::mcl::registers::RegisterId(0), 1));
    assert!(matches!(decode(&wrapped(&[])), Err(ImageError::Malformed(_))));
    assert!(matches!(decode(&wrapped(&[0x80, 0x00])), Err(ImageError::Malformed(_))));
}

#[test]
fn opcodes_are_told_apart_and_values_stand_at_their_places() {
    let mut codes: Vec<u8> = OPCODES.iter().map(|row| row.code).collect();
    codes.dedup();
    assert_eq!(codes.len(), OPCODES.len());
    use crate::arithmetic::Type;
    use crate::mcl::ast::{Binary, Format, Motion, Unary};
    use crate::mcl::types::VarType;
    assert!(Unary::ALL.iter().enumerate().all(|(at, value)| at == *value as usize));
    assert!(Binary::ALL.iter().enumerate().all(|(at, value)| at == *value as usize));
    assert!(Format::ALL.iter().enumerate().all(|(at, value)| at == *value as usize));
    assert!(Motion::ALL.iter().enumerate().all(|(at, value)| at == *value as usize));
    assert!(VarType::ALL.iter().enumerate().all(|(at, value)| at == *value as usize));
    assert!(Type::ALL.iter().enumerate().all(|(at, value)| at == *value as usize));
}

#[test]
fn a_file_has_words_for_people_before_its_image() {
    let image = encode(&program());
    let file = to_file(&image);
    assert_eq!(file.len(), 0x100 + image.len());
    assert!(file.starts_with(b"Brushwork MCL image, format 1\r\n"));
    assert_eq!(of_file(&file), Some(&image[..]));
    assert_eq!(of_file(&image), None);
    assert_eq!(of_file(b""), None);
}
