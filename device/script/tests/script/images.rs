//! Images of programs: the same program comes back, and no bytes at all make the reader or the machine panic.
//!
//! `BRUSHWORK_MCL_IMAGES=n` damages n of them, `BRUSHWORK_SEED=n` others.

use crate::support::examples::{corrected, examples};
use crate::support::{TestHost, run_in_slices};
use brushwork_script::image::{MAGIC, decode, encode};
use brushwork_script::mcl::compile;
use brushwork_script::vm::Machine;
use proptest::prelude::*;
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::{Rng, SeedableRng};
use std::sync::Arc;

fn images() -> Vec<Vec<u8>> {
    let files = [include_str!("../manual/registers.txt"), include_str!("../manual/chapter.txt")];
    let texts = files.iter().flat_map(|file| examples(file)).map(|example| corrected(&example));
    texts.map(|text| encode(&compile(&text).program.expect("it compiles"))).collect()
}

#[test]
fn every_program_of_the_manual_comes_back_from_its_image() {
    let files = [include_str!("../manual/registers.txt"), include_str!("../manual/chapter.txt")];
    for example in files.iter().flat_map(|file| examples(file)) {
        let program = compile(&corrected(&example)).program.expect("it compiles");
        assert_eq!(decode(&encode(&program)).as_ref(), Ok(&program), "{}", example.title);
    }
}

/// Length and checksum as the content wants them.
fn sealed(mut image: Vec<u8>) -> Vec<u8> {
    let length = image.len() as u32;
    image[12..16].copy_from_slice(&length.to_le_bytes());
    let checksum = crc32fast::hash(&image[20..]);
    image[16..20].copy_from_slice(&checksum.to_le_bytes());
    image
}

fn number(name: &str, default: u64) -> u64 {
    std::env::var(name).ok().and_then(|value| value.parse().ok()).unwrap_or(default)
}

#[test]
fn damaged_images_with_a_right_checksum_are_refused_or_run_without_a_panic() {
    let (seed, runs) = (number("BRUSHWORK_SEED", 1), number("BRUSHWORK_MCL_IMAGES", 20_000));
    println!("seed {seed}, {runs} images");
    let mut rng = ChaCha8Rng::seed_from_u64(seed);
    let images = images();
    let mut ran = 0;
    for _ in 0..runs {
        let mut image = images[rng.next_u32() as usize % images.len()].clone();
        for _ in 0..=rng.next_u32() % 3 {
            let at = 20 + rng.next_u32() as usize % (image.len() - 20);
            image[at] = match rng.next_u32() % 3 {
                0 => rng.next_u32() as u8,
                1 => image[at] ^ 1 << (rng.next_u32() % 8),
                _ => image[20 + rng.next_u32() as usize % (image.len() - 20)],
            };
        }
        let Ok(program) = decode(&sealed(image)) else { continue };
        let mut host = TestHost::default();
        host.waiting.insert(0, (0..=255).collect());
        run_in_slices(&mut Machine::new(Arc::new(program)), &mut host, 4_000, 2_000);
        ran += 1;
    }
    assert!(ran > runs / 20, "only {ran} of {runs} were still programs");
}

proptest! {
    #![proptest_config(proptest::test_runner::Config {
        rng_seed: proptest::test_runner::RngSeed::Fixed(0x5EED),
        failure_persistence: None,
        ..proptest::test_runner::Config::default()
    })]

    #[test]
    fn no_bytes_panic_the_reader(bytes in proptest::collection::vec(any::<u8>(), 0..400), sealed_up: bool) {
        let mut image = MAGIC.to_vec();
        image.extend([1, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0]);
        image.extend(&bytes);
        let _ = decode(&bytes);
        let _ = decode(&if sealed_up { sealed(image) } else { image });
    }
}
