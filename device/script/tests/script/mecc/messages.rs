//! One program per code of an error or warning (`programs.txt`), with what the compiler says about it (`messages.txt`).
//!
//! `BRUSHWORK_UPDATE=1` writes the latter anew; the difference in version control is what to look at then.

use super::wrong;
use brushwork_script::mecc::{codes, compile};
use brushwork_script::text::Lines;
use std::path::Path;

#[test]
fn each_code_has_a_program_and_says_the_same_as_ever() {
    let programs = wrong();
    let known: Vec<&str> = programs.iter().map(|(code, _)| *code).collect();
    assert_eq!(known, codes::ALL.iter().map(|(code, _)| *code).collect::<Vec<_>>());
    let mut page = String::new();
    for (code, text) in &programs {
        let compiled = compile(text);
        let lines = Lines::of(text);
        page += &format!("== {code}\n");
        for said in &compiled.diagnostics {
            assert!(said.hint.is_some(), "{} says no remedy: {}", said.code, said.message);
            page += &said.render("x", text, &lines);
        }
        assert!(
            compiled.diagnostics.iter().any(|said| said.code == *code),
            "{code}: {:?}",
            compiled.diagnostics
        );
        assert_eq!(
            compiled.is_ok(),
            compiled.diagnostics.iter().all(|said| said.code.starts_with('W')),
            "{code}"
        );
        assert_eq!(compiled.is_ok(), code.starts_with('W'), "{code}");
    }
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/script/mecc/messages.txt");
    if std::env::var_os("BRUSHWORK_UPDATE").is_some() {
        std::fs::write(&file, &page).expect("the text can be written");
    }
    let expected = std::fs::read_to_string(&file).unwrap_or_default().replace("\r\n", "\n");
    for (said, expected) in page.split("== ").zip(expected.split("== ")) {
        assert_eq!(said, expected);
    }
    assert_eq!(page.len(), expected.len());
}
