//! Any bytes as an image with a right checksum: refused, or run.
#![no_main]

mod nobody;

use brushwork_script::image::{MAGIC, decode};
use brushwork_script::vm::Machine;
use libfuzzer_sys::fuzz_target;
use nobody::Nobody;
use std::sync::Arc;

fuzz_target!(|body: &[u8]| {
    let _ = decode(body);
    let mut image = MAGIC.to_vec();
    image.extend([1, 0, 0, 0]);
    image.extend(u32::try_from(20 + body.len()).unwrap_or(u32::MAX).to_le_bytes());
    image.extend(crc32(body).to_le_bytes());
    image.extend(body);
    if let Ok(program) = decode(&image) {
        Machine::new(Arc::new(program)).run(&mut Nobody, 5_000);
    }
});

/// CRC-32 (IEEE), bit by bit.
fn crc32(bytes: &[u8]) -> u32 {
    !bytes.iter().fold(u32::MAX, |crc, byte| {
        (0..8).fold(crc ^ u32::from(*byte), |crc, _| (crc >> 1) ^ (0xEDB8_8320 & (crc & 1).wrapping_neg()))
    })
}
