//! Formatting changes spaces and nothing else: the tokens, the comments and the compiled program stay, and a second time nothing changes.

use crate::support::mutation::{damaged, seeds};
use brushwork_script::image::encode;
use brushwork_script::mcl::compile;
use brushwork_script::mcl::format::format;
use brushwork_script::mcl::lexer::{TokenKind, tokens};
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::SeedableRng;

fn kinds(text: &str) -> Vec<TokenKind> {
    let mut kinds: Vec<TokenKind> = tokens(text).0.into_iter().map(|token| token.kind).collect();
    // Empty lines at the end go.
    while kinds.ends_with(&[TokenKind::Newline, TokenKind::Newline, TokenKind::End]) {
        kinds.remove(kinds.len() - 2);
    }
    kinds
}

fn comments(text: &str) -> Vec<String> {
    let of = |line: &str| line.split_once(';').map(|(_, comment)| comment.trim().to_owned());
    text.lines().filter(|line| !line.contains('"')).filter_map(of).collect()
}

fn check(text: &str) {
    let formatted = format(text);
    assert_eq!(format(&formatted), formatted, "twice is not once:\n{text}\n---\n{formatted}");
    // Floats that are no numbers are not equal to themselves, so the tokens are compared as they are shown.
    assert_eq!(format!("{:?}", kinds(text)), format!("{:?}", kinds(&formatted)), "{text}\n---\n{formatted}");
    assert_eq!(comments(text), comments(&formatted), "{text}\n---\n{formatted}");
    let (before, after) = (compile(text), compile(&formatted));
    assert_eq!(
        before.program.as_ref().map(encode),
        after.program.as_ref().map(encode),
        "{text}\n---\n{formatted}"
    );
    let codes = |compiled: &brushwork_script::mcl::Compiled| -> Vec<&str> {
        compiled.diagnostics.iter().map(|diagnostic| diagnostic.code).collect()
    };
    assert_eq!(codes(&before), codes(&after), "{text}\n---\n{formatted}");
}

#[test]
fn the_manuals_programs_and_damaged_ones_keep_their_meaning() {
    let seeds = seeds();
    seeds.iter().for_each(|text| check(text));
    let seed = std::env::var("BRUSHWORK_SEED").ok().and_then(|seed| seed.parse().ok()).unwrap_or(5);
    println!("seed {seed}");
    let mut rng = ChaCha8Rng::seed_from_u64(seed);
    for _ in 0..1_500 {
        check(&damaged(&mut rng, &seeds));
    }
}

#[test]
fn the_programs_of_the_messages_keep_their_meaning() {
    let folder = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/messages");
    for entry in std::fs::read_dir(folder).expect("the folder is there") {
        let path = entry.expect("an entry").path();
        if path.extension().is_some_and(|extension| extension == "mcl") {
            check(&std::fs::read_to_string(&path).expect("a program"));
        }
    }
}
