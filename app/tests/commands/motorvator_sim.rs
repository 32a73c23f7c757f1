//! `brushwork sim --model motorvator-3` over its pseudo-terminal, in plain bytes of the manual: no codec of this project takes part.
#![cfg(unix)]

use std::fs::{File, OpenOptions};
use std::io::{Read as _, Write as _};
use std::time::{Duration, Instant};

use crate::cli::{Simulated, USAGE, name, program, run};

const MANUAL: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../assets/mecc/send_receive.mecc");

/// The other end of the line.
struct Terminal(File);

impl Terminal {
    fn open(line: &Simulated) -> Self {
        Self(OpenOptions::new().read(true).write(true).open(line.port()).expect("the port is there"))
    }

    fn send(&mut self, bytes: &[u8]) {
        self.0.write_all(bytes).expect("the line takes them");
    }

    /// The next line that comes, with its carriage return.
    fn line(&mut self) -> Vec<u8> {
        let mut line = Vec::new();
        let mut byte = [0];
        while !line.ends_with(b"\r") {
            self.0.read_exact(&mut byte).expect("more of a line");
            line.push(byte[0]);
        }
        line
    }

    /// The next line that does not come by itself: the library tells every half second that it runs.
    fn answer(&mut self) -> Vec<u8> {
        loop {
            let line = self.line();
            if line != b"073082066000002000000000000\r" {
                return line;
            }
        }
    }
}

#[test]
fn the_manuals_program_sends_and_receives_the_manuals_bytes() {
    let line = Simulated::start_on_pty(&["--model", "motorvator-3", "--program", MANUAL]);
    let mut terminal = Terminal::open(&line);
    terminal.send(b"G\r");
    let begun = Instant::now();
    // "TX ", 0, "RX ", 0 after a tick; then what was received, with zeros behind it.
    assert_eq!(terminal.line(), b"073084088032000082088032000\r");
    terminal.send(b"I003\r");
    assert_eq!(terminal.line(), b"073003000000000000000000000\r");
    terminal.send(b"I001002003\r");
    assert_eq!(terminal.line(), b"073001002003000000000000000\r");
    // Every 5 s: three frames are out, two have come.
    assert_eq!(terminal.line(), b"073084088032003082088032002\r");
    let took = begun.elapsed();
    // A busy computer hears of it later.
    assert!((Duration::from_millis(4900)..Duration::from_secs(15)).contains(&took), "{took:?}");
}

#[test]
fn a_board_waits_for_g_and_tells_its_version_and_what_it_does_not_know() {
    let line = Simulated::start_on_pty(&["--model", "motorvator-3", "--program", MANUAL]);
    let mut terminal = Terminal::open(&line);
    terminal.send(b"H\r");
    assert_eq!(terminal.line(), b"MotorVator AWOS 2.32 (simulated by Brushwork)\r");
    terminal.line();
    terminal.send(b"I256\r");
    assert_eq!(terminal.line(), b"\n?\r");
    // A frame of another board is ignored, and nothing runs before G.
    terminal.send(b"073084088049050051052053054\rI001\rG\r");
    assert_eq!(terminal.line(), b"\n073084088032000082088032000\r");
}

#[test]
fn the_host_library_is_spoken_to_in_plain_bytes() {
    let line = Simulated::start_on_pty(&["--model", "motorvator-3"]);
    let mut terminal = Terminal::open(&line);
    assert_eq!(terminal.line(), b"073082066000002000000000000\r", "it runs, in version 2");
    let mut ask = |sent: &[u8]| {
        terminal.send(sent);
        terminal.answer()
    };
    assert_eq!(ask(b"I080001\r"), b"073082080001002000000000000\r", "ping: version 2");
    assert_eq!(ask(b"I077002003066060\r"), b"073082077002000000188000000\r", "motor 3 backward 60 %");
    assert_eq!(ask(b"I068003079075\r"), b"073082068003079075000000000\r", "the display shows OK");
    assert_eq!(ask(b"I067004001005009040\r"), b"073082067004001005009040000\r", "ConfigStepper 1, 5, 9, 40");
    assert_eq!(ask(b"I088005\r"), b"073082088005000000000000000\r", "stop");
    assert_eq!(ask(b"I033006\r"), b"073082033006000000000000064\r", "an order that it does not know");
    ask(b"I077007001070050\r");
    std::thread::sleep(Duration::from_millis(400));
    assert_eq!(ask(b"I083008\r"), b"073082083008000000000000128\r", "stopped by the dead-man");
}

#[test]
fn options_of_a_motorvator_are_refused_elsewhere_and_with_what_they_cannot_be() {
    let folder = tempfile::tempdir().expect("a temporary folder can be made");
    let wrong = folder.path().join("wrong.mecc");
    std::fs::write(&wrong, "Begin Program\nBep 1, 2\nEnd Program\n").expect("it takes it");
    for (words, sentence) in [
        (&["--program", MANUAL][..], "are for --model motorvator-3"),
        (&["--model", "motorvator-3", "--baud", "9601"], "has no 9601 baud"),
        (&["--model", "motorvator-3", "--address", "2"], "has no address"),
        (&["--model", "motorvator-3,mcp266"], "cannot share a line"),
        (&["--model", "motorvator-3", "--can", "ascii"], "no CAN bus"),
        (&["--model", "motorvator-3", "--script", MANUAL], "runs a --program"),
    ] {
        run(program().arg("sim").args(words)).ended_with(USAGE).explains(sentence);
    }
    run(program().args(["sim", "--model", "motorvator-3", "--program", name(&wrong)]))
        .ended_with(9)
        .explains(":2:1");
}
