//! One program per code of an error or warning, with what the compiler says about it: `tests/messages/CODE.mcl` and `CODE.txt`.
//!
//! `BRUSHWORK_UPDATE=1` writes the texts anew; the difference in version control is what to look at then.

use brushwork_script::mcl::{codes, compile};
use brushwork_script::text::Lines;
use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};

fn folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/messages")
}

#[test]
fn each_code_has_a_program_and_says_the_same_as_ever() {
    let mut wrong = Vec::new();
    for (code, meaning) in codes::ALL {
        let file = folder().join(format!("{code}.mcl"));
        let text = fs::read_to_string(&file).unwrap_or_else(|error| panic!("{code}, {meaning} {error}"));
        let text = text.replace("\r\n", "\n");
        let compiled = compile(&text);
        let lines = Lines::of(&text);
        let name = format!("{code}.mcl");
        let said: Vec<String> =
            compiled.diagnostics.iter().map(|diagnostic| diagnostic.render(&name, &text, &lines)).collect();
        assert!(
            compiled.diagnostics.iter().any(|diagnostic| diagnostic.code == *code),
            "{code}:\n{}",
            said.join("")
        );
        assert_eq!(compiled.is_ok(), !said.join("").contains(": error "), "{code}");
        let golden = folder().join(format!("{code}.txt"));
        if std::env::var_os("BRUSHWORK_UPDATE").is_some() {
            fs::write(&golden, said.join("")).expect("the text can be written");
        }
        let expected = fs::read_to_string(&golden).unwrap_or_default().replace("\r\n", "\n");
        if said.join("") != expected {
            wrong.push(format!("{code} says:\n{}\nand not:\n{expected}", said.join("")));
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn no_program_here_belongs_to_a_code_that_is_gone() {
    let codes: BTreeSet<&str> = codes::ALL.iter().map(|(code, _)| *code).collect();
    for entry in fs::read_dir(folder()).expect("the folder is there") {
        let path = entry.expect("an entry").path();
        let stem = path.file_stem().and_then(|stem| stem.to_str()).unwrap_or_default().to_owned();
        assert!(codes.contains(stem.as_str()), "{}", path.display());
    }
}

#[test]
fn a_warning_does_not_keep_a_program_from_running_and_an_error_does() {
    for (code, _) in codes::ALL {
        let text = fs::read_to_string(folder().join(format!("{code}.mcl"))).expect("its program");
        if code.starts_with('W') {
            assert!(compile(&text).is_ok(), "{code}");
        } else {
            assert!(!compile(&text).is_ok(), "{code}");
        }
    }
}
