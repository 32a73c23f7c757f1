//! The compiler as a whole.

use super::compile;
use crate::mcl::codes;

fn said(text: &str) -> Vec<&'static str> {
    compile(text).diagnostics.into_iter().map(|diagnostic| diagnostic.code).collect()
}

#[test]
fn a_plain_program_compiles_without_a_word() {
    let text =
        "value var long\nmain\n  for value = 0 to 9\n  puts 0,[\"Value=\",dec value,13]\n  next\ngoto main\n";
    assert_eq!(said(text), Vec::<&str>::new());
}

#[test]
fn several_errors_are_found_in_one_pass() {
    let text = "a var byte\nb = 1\ngoto nowhere\na = \nputs 0,[dec a,13]\nif a then\nend\n";
    let found = said(text);
    for code in [codes::UNKNOWN_NAME, codes::UNKNOWN_LABEL, codes::UNEXPECTED, codes::NO_BLOCK_END] {
        assert!(found.contains(&code), "{code} in {found:?}");
    }
}
