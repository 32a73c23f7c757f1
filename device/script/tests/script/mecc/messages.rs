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

/// What is said of a program, code by code.
fn told(text: &str) -> Vec<String> {
    compile(text)
        .diagnostics
        .iter()
        .map(|found| format!("{}: {}", found.code, found.hint.clone().unwrap_or_default()))
        .collect()
}

#[test]
fn two_words_that_are_written_as_one_are_one_mistake_with_its_remedy() {
    for (text, both) in [
        ("Begin Program\nIf 1 = 1 Then\nBeep 1, 1\nEndIf\nEnd Program\n", "End If"),
        ("Begin Program\nLoop\nBeep 1, 1\nendloop ; again\nEnd Program\n", "End Loop"),
        ("Begin Program\nSelect 1\nCase 1\nBeep 1, 1\nEndSelect\nEnd Program\n", "End Select"),
        ("Begin Program\nBeep 1, 1\nEndProgram\n", "End Program"),
        ("BeginProgram\nBeep 1, 1\nEnd Program\n", "Begin Program"),
        (
            "Begin Program\nBeep 1, 1\nCall F()\nEnd Program\nDeclare Function F()\nBeep 1, 1\nENDFUNCTION\n",
            "End Function",
        ),
        (
            "Declare DataTable t\n1, 2, 3, 4, 5, 6, 7, 8\nEndDataTable\nDeclare DataPointer p\nBegin Program\np = SetPointer(t)\nTransmit p\nEnd Program\n",
            "End DataTable",
        ),
        (
            "Declare EventHandler H()\nBeep 1, 1\nEndEventHandler\nBegin Program\nSetEvent OnOff1Event, H\nEnableEvents\nEnd Program\n",
            "End EventHandler",
        ),
    ] {
        let errors: Vec<String> = told(text).into_iter().filter(|told| told.starts_with('E')).collect();
        assert_eq!(errors[0], format!("E210: It is two words: {both}"), "{text}");
        let expected = text.matches("EnableEvents").count() + 1;
        assert_eq!(errors.len(), expected, "{text}: {errors:?}");
    }
}

#[test]
fn a_wait_below_zero_is_warned_of_since_it_lasts_for_minutes() {
    let text = |wait: &str| format!("Begin Program\nWait {wait}\nEnd Program\n");
    for (wait, ticks) in [("-1", "512 s"), ("-128", "511 s")] {
        let found = compile(&text(wait)).diagnostics;
        let told: Vec<String> =
            found.iter().map(|found| format!("{}: {}", found.code, found.message)).collect();
        assert_eq!(told.len(), 1, "{told:?}");
        assert!(told[0].starts_with("W403") && told[0].contains(ticks), "{told:?}");
    }
    assert!(compile(&text("1")).diagnostics.is_empty());
}
