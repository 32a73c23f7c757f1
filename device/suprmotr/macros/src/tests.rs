//! Macro files as a whole: what they mean, what is said about them, and their one style.

use crate::{Checked, check, codes, format, written};
use brushwork_script::diagnostic::Severity;
use brushwork_script::text::Lines;
use brushwork_suprmotr_wire::{COMMANDS, Command, Mnemonic, Radix};
use proptest::prelude::*;

/// The manual's homing, and a shuttle that calls it.
const SLIDE: &str = "\
# Finds home, and goes to and fro.
const SLOW = 500

macro start = 0  # 0 runs at power-up
    MC home
    MC shuttle

macro home
    DV 10000
    FE 1, WS
    DV SLOW
    FE 4, WS, DH

macro shuttle = 3
    MA 0, WS 500
    MA 2000, WS 500
    RP 9
";

/// What is said, as `LINE:COLUMN CODE`.
fn said(text: &str) -> Vec<String> {
    let lines = Lines::of(text);
    let place = |span: brushwork_script::text::Span| lines.place(text, span.start);
    let found = check(text);
    found
        .diagnostics
        .iter()
        .map(|said| format!("{}:{} {}", place(said.span).line, place(said.span).column, said.code))
        .collect()
}

fn lines_of(checked: &Checked) -> Vec<String> {
    let line = |bytes: Vec<u8>| String::from_utf8(bytes).expect("it is ASCII").trim_end().to_owned();
    checked.macros.iter().map(|known| line(known.line().expect("it fits"))).collect()
}

#[test]
fn a_file_becomes_the_lines_that_define_its_macros() {
    let checked = check(SLIDE);
    assert!(checked.is_right());
    assert_eq!(
        lines_of(&checked),
        ["MD0,MC1,MC3", "MD1,DV10000,FE1,WS,DV500,FE4,WS,DH", "MD3,MA0,WS500,MA2000,WS500,RP9",]
    );
    assert_eq!(said(SLIDE), ["4:7 W401"], "it moves at power-up");
    assert_eq!(checked.find("SHUTTLE").map(|known| known.number), Some(3));
    assert_eq!(checked.find("1").map(|known| known.name.as_str()), Some("home"));
    // Where each command stands: FE 4 is on line 12.
    let home = checked.find("home").expect("it is there");
    let place = Lines::of(SLIDE).place(SLIDE, home.places[4].start);
    assert_eq!((place.line, place.column), (12, 5));
}

#[test]
fn macros_without_a_number_take_the_lowest_that_is_free_and_never_0() {
    let text = "macro a\nCN1\nmacro b = 1\nCN2\nmacro c\nCN3\n";
    let numbers: Vec<u8> = check(text).macros.iter().map(|known| known.number).collect();
    assert_eq!(numbers, [2, 1, 3]);
    let many: String = (0..15).map(|index| format!("macro m_{index}\nCN1\n")).collect();
    assert_eq!(said(&many), ["29:7 E304"]);
}

#[test]
fn each_mistake_has_its_code_and_its_place() {
    for (text, expected) in [
        ("macro a\n  MA 5 $\n", "2:8 E101"),
        ("macro a\nMA 99999999999\n", "2:4 E102"),
        ("macro a\nMA99999999999\n", "2:1 E102"),
        ("macro\n", "1:6 E103"),
        ("macro a = \n", "1:10 E103"),
        ("macro a 3\n", "1:9 E103"),
        ("const a\n", "1:8 E103"),
        ("macro a\nMA 5 6\n", "2:6 E103"),
        ("macro a\nCN1,,CN2\n", "2:5 E103"),
        ("macro a\nQQ 5\n", "2:1 E201"),
        ("macro a\nDE100\n", "2:1 E201"),
        ("macro a\nDV\n", "2:1 E202"),
        ("macro a\nTP 5\n", "2:1 E203"),
        ("macro a\nDP 256\n", "2:1 E204"),
        ("macro a\nFE 3\n", "2:1 E204"),
        ("macro a\nMC 15\n", "2:1 E204"),
        ("macro a\nMC b\n", "2:4 E205"),
        ("macro a\nDV fast\n", "2:4 E205"),
        ("CN1\n", "1:1 E206"),
        ("macro a\nMD1\n", "2:1 E207"),
        ("macro a\nCN1\nmacro A\nCN1\n", "3:7 E301"),
        ("macro a = 4\nCN1\nmacro b = 4\nCN1\n", "3:11 E302"),
        ("macro a = 15\nCN1\n", "1:11 E303"),
        ("macro a\n", "1:7 E305"),
        ("macro a\nCN1,CN1,CN1,CN1,CN1,CN1,CN1,CN1\nCN1,CN1,CN1,CN1,CN1,CN1,CN1,CN1\n", "3:29 E306"),
        ("macro a\nMC 7\n", "2:1 W402"),
        ("macro a\nMC a\nCN1\n", "2:1 W403"),
        ("macro a\nCN1\nMC b\nmacro b\nMC a, CN1\n", "5:1 W403"),
        ("macro a\nCN1, UD, RP\n", "2:6 W404"),
        ("macro a\nMR 5, RP 9\n", "2:1 W405"),
        ("const x = 5\nmacro a\nCN1\n", "1:7 W406"),
        ("macro a\nCN1, WA 5, RP, RP, CF1\n", "2:20 W407"),
    ] {
        let found = said(text);
        assert!(found.iter().any(|said| said == expected), "{text:?}: {found:?}, not {expected}");
        let error = expected.contains(" E");
        assert_eq!(!check(text).is_right(), error, "{text:?}");
    }
}

#[test]
fn what_is_right_is_left_alone() {
    for text in [
        "",
        "# nothing yet\n",
        "macro a\nCN1\n",
        "macro a\nWA 10, MC a\n",
        "macro a\nMA, WS, RP\n",
        "macro a = 0\nCN1\n",
        "macro a\r\nDV 5,\r\nMR -500, WS\r\n",
        "const back = -500\nmacro go2 = 3\nmr back, ws\nmacro b\nem go2\n",
    ] {
        assert_eq!(said(text), Vec::<String>::new(), "{text:?}");
    }
}

#[test]
fn a_long_list_of_errors_is_cut_short_and_a_long_file_refused() {
    let text: String = std::iter::once("macro a\n").chain(std::iter::repeat_n("QQ\n", 300)).collect();
    let found = said(&text);
    assert_eq!((found.len(), found.last().map(|last| &last[last.len() - 4..])), (101, Some("E308")));
    assert_eq!(said(&"#".repeat(300_000)), ["1:1 E104"]);
}

#[test]
fn every_code_has_one_meaning() {
    let mut seen = std::collections::BTreeSet::new();
    assert!(codes::ALL.iter().all(|(code, meaning)| seen.insert(*code) && meaning.ends_with('.')));
}

#[test]
fn the_one_style_is_kept_and_reached() {
    assert_eq!(format(SLIDE), SLIDE);
    let untidy = "#Finds home, and goes to and fro.\r\nCONST SLOW=500\n\n\nMacro start=0   #0 runs at power-up\nmc home\n MC  shuttle\n\
                  \nmacro home\n  # first the edge\ndv10000\nfe1,ws,\nDV SLOW\n$ what\n\n\n";
    let tidy = "# Finds home, and goes to and fro.\nconst SLOW = 500\n\nmacro start = 0  # 0 runs at power-up\n    MC home\n    MC shuttle\n\
                \nmacro home\n    # first the edge\n    DV 10000\n    FE 1, WS\n    DV SLOW\n$ what\n";
    assert_eq!(format(untidy), tidy);
    assert_eq!(format(tidy), tidy);
    assert_eq!(format("\n\n"), "");
}

#[test]
fn what_a_controller_told_becomes_a_file_with_the_names_that_are_known() {
    let known = check(SLIDE);
    let told: Vec<(u8, Vec<Command>)> =
        known.macros.iter().map(|known| (known.number, known.commands.clone())).collect();
    let text = written(&told, &known);
    assert!(
        text.starts_with("macro start = 0\n    MC home\n    MC shuttle\n\nmacro home = 1\n    DV 10000\n"),
        "{text}"
    );
    assert_eq!(lines_of(&check(&text)), lines_of(&known));
    let text = written(&told, &Checked::default());
    assert!(text.starts_with("macro macro_0 = 0\n    MC macro_1\n    MC macro_3\n"), "{text}");
    assert_eq!(lines_of(&check(&text)), lines_of(&known));
    assert_eq!(format(&text), text, "it is in the one style");
}

fn command() -> impl Strategy<Value = Command> {
    (0..COMMANDS.len(), any::<u32>()).prop_map(|(index, drawn)| {
        let row = &COMMANDS[index];
        let mnemonic = if row.mnemonic == Mnemonic::MD { Mnemonic::CN } else { row.mnemonic };
        let number = mnemonic.row().takes.map(|takes| {
            let span = i64::from(takes.high) - i64::from(takes.low) + 1;
            let drawn = i64::from(takes.low) + i64::from(drawn) % span;
            let drawn = i32::try_from(drawn).expect("it is in range");
            if takes.allows(drawn) { drawn } else { takes.low }
        });
        Command { mnemonic, number }
    })
}

proptest! {
    /// Whatever fits a controller can be written to a file and comes back, and formatting changes nothing of it.
    #[test]
    fn macros_come_back_from_their_file(commands in prop::collection::vec(command(), 1..=15), number in 0_u8..=14) {
        let text = written(&[(number, commands.clone())], &Checked::default());
        let checked = check(&text);
        prop_assert!(checked.diagnostics.iter().all(|said| said.severity() == Severity::Warning), "{:?}", checked.diagnostics);
        prop_assert_eq!(&checked.macros[0].commands, &commands);
        let again = check(&format(&text));
        prop_assert_eq!(&again.macros[0].commands, &commands);
        // The line of a controller has no more room than this.
        let line = checked.macros[0].line().expect("check said that it fits");
        prop_assert!(line.len() <= 256);
        let text: String = line.into_iter().map(char::from).collect();
        let parsed = brushwork_suprmotr_wire::parse_line(text.trim_end().as_bytes(), Radix::Decimal);
        prop_assert_eq!(parsed.error, None);
    }

    /// No text makes it panic; formatting ends after one round and keeps every macro.
    #[test]
    fn any_text_is_read_and_formatted(text in "([a-zA-Z0-9,=#\\- \t]|macro |const |\n|ö|\\$){0,200}") {
        let checked = check(&text);
        let once = format(&text);
        prop_assert_eq!(&format(&once), &once);
        let again = check(&once);
        let commands = |checked: &Checked| checked.macros.iter().map(|known| known.commands.clone()).collect::<Vec<_>>();
        prop_assert_eq!(commands(&checked), commands(&again));
        prop_assert_eq!(checked.diagnostics.len(), again.diagnostics.len());
    }
}
