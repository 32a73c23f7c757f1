//! `brushwork sim --model suprmotr-v9` with the options that no other model has.
#![cfg(unix)]

use std::fs::{self, OpenOptions};
use std::io::{Read as _, Write as _};
use std::time::{Duration, Instant};

use crate::cli::{LIMIT, Simulated, USAGE, name, program, run};

/// What comes back for bytes, up to the end of text.
fn exchange(port: &str, bytes: &[u8]) -> String {
    let mut line = OpenOptions::new().read(true).write(true).open(port).expect("the port is there");
    line.write_all(bytes).expect("it takes them");
    let mut reply = Vec::new();
    let mut byte = [0];
    while !reply.ends_with(&[3]) {
        line.read_exact(&mut byte).expect("an answer");
        reply.push(byte[0]);
    }
    reply.into_iter().map(char::from).collect()
}

#[test]
fn units_forms_echo_and_selection_are_chosen_and_the_eeprom_kept() {
    let folder = tempfile::tempdir().expect("a temporary folder can be made");
    let file = folder.path().join("eeprom.json");
    let options = |extra: &[&'static str]| {
        let common = ["--model", "suprmotr-v9", "--reply-form", "id", "--echo", "off", "--eeprom"];
        let mut all: Vec<String> = common.map(str::to_owned).to_vec();
        all.push(name(&file).to_owned());
        all.extend(extra.iter().map(|word| (*word).to_owned()));
        all
    };
    let start = |extra: &[&'static str]| {
        let words = options(extra);
        Simulated::start_on_pty(&words.iter().map(String::as_str).collect::<Vec<_>>())
    };
    let line = start(&["--units", "0,3,F"]);
    assert_eq!(exchange(&line.port(), b"\x01FTB\r"), "B:+0000000015\r\n\u{3}");
    assert_eq!(exchange(&line.port(), b"\x013DP99,UD\rMD3,MR500,WS,RP9\rGP\r"), "G:+0000000099\r\n\u{3}");
    let deadline = Instant::now() + LIMIT;
    while !fs::read_to_string(&file).is_ok_and(|text| text.contains("MR500,WS,RP9")) {
        assert!(Instant::now() < deadline, "the file never has the macro");
        std::thread::sleep(Duration::from_millis(20));
    }
    drop(line);
    // Now the file says who is there.
    let line = start(&["--addressed", "yes", "--baud", "38400"]);
    let told = exchange(&line.port(), b"\x013TM3\r");
    assert!(told.ends_with("MD3, MR+0000000500,WS,RP+0000000009\r\n\u{3}"), "{told}");
    drop(line);
    let words = options(&["--units", "0,3"]);
    run(program().arg("sim").args(words))
        .ended_with(USAGE)
        .explains("EEPROMs of 3 boards, and 2 are asked for");
    fs::write(&file, "{}").expect("it takes it");
    run(program().arg("sim").args(options(&[]))).ended_with(USAGE).explains("is no file of EEPROMs");
}

#[test]
fn options_of_a_suprmotr_are_refused_elsewhere_and_with_what_they_cannot_be() {
    for (words, sentence) in [
        (&["--units", "0"][..], "are for --model suprmotr-v9"),
        (&["--model", "suprmotr-v9", "--units", "G"], "is no address of a SuprMotr"),
        (&["--model", "suprmotr-v9", "--units", "3,3"], "Two simulated controllers"),
        (&["--model", "suprmotr-v9", "--baud", "57600"], "has no 57600 baud"),
        (&["--model", "suprmotr-v9,mcp266"], "cannot share a line"),
        (&["--model", "suprmotr-v9", "--can", "ascii"], "no CAN bus"),
    ] {
        run(program().arg("sim").args(words)).ended_with(USAGE).explains(sentence);
    }
}
