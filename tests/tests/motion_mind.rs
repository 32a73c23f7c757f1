//! `brushwork sim --model motion-mind-3` from outside: the bytes and lines of its manual over a socket.
#![cfg(unix)]

use std::io::{Read, Write};
use std::net::TcpStream;

use brushwork_tests::program::Program;
use brushwork_tests::wait::LIMIT;

const BRUSHWORK: &str = env!("CARGO_BIN_EXE_brushwork-for-tests");
/// A simulated unit and a client that is connected to it.
fn served(options: &[&str]) -> (Program, TcpStream) {
    let arguments = [&["sim", "--model", "motion-mind-3", "--tcp", "127.0.0.1:0"], options].concat();
    let mut program = Program::start(BRUSHWORK, &arguments);
    let greeting = program.next_line(LIMIT).expect("it says where it is");
    let place = greeting.rsplit("tcp:").next().expect("there is a last part");
    let stream = TcpStream::connect(place).unwrap_or_else(|error| panic!("{greeting}: {error}"));
    stream.set_read_timeout(Some(LIMIT)).expect("a timeout can be set");
    (program, stream)
}

fn ask(stream: &mut TcpStream, request: &[u8], reply: &[u8]) {
    stream.write_all(request).expect("the line is open");
    let mut got = vec![0; reply.len()];
    stream.read_exact(&mut got).expect("a reply comes");
    assert_eq!(
        got,
        reply,
        "{:?} for {:?}",
        got.escape_ascii().to_string(),
        request.escape_ascii().to_string()
    );
}

#[test]
fn a_served_unit_answers_in_frames_each_to_its_address() {
    let (_program, mut stream) = served(&["--address", "1,2", "--mode", "3"]);
    // READ REGISTER 7, ADDRESS, of units 1 and 2: address, value, checksum.
    ask(&mut stream, &[0x1D, 0x01, 0x07, 0x25], &[0x01, 0x01, 0x02]);
    ask(&mut stream, &[0x1D, 0x02, 0x07, 0x26], &[0x02, 0x02, 0x04]);
    // READ REGISTER 18, MODE.
    ask(&mut stream, &[0x1D, 0x01, 0x12, 0x30], &[0x01, 0x03, 0x04]);
    // CHANGE_SPEED 763.
    ask(&mut stream, &[0x14, 0x01, 0xFB, 0x02, 0x12], &[0x06]);
}

#[test]
fn a_served_unit_answers_in_lines() {
    let (_program, mut stream) = served(&["--protocol", "ascii"]);
    ask(&mut stream, b"R01 04\r\n", b"PTRM=6000\r\n");
    ask(&mut stream, b"W01 00 -10000\r\n", b"OK\r\n");
    ask(&mut stream, b"R01 00\r\n", b"APOS=-10000\r\n");
    ask(&mut stream, b"Q\r\n", b"BAD COMMAND\r\n");
}

#[test]
fn what_does_not_fit_together_is_said_in_a_sentence() {
    for (options, sentence) in [
        (&["--model", "motion-mind-3", "--address", "0x80"][..], "an address from 1 to 98"),
        (&["--model", "motion-mind-3,mcp266"][..], "cannot share a line"),
        (&["--model", "motion-mind-3", "--can", "ascii"][..], "no CAN bus"),
        (&["--model", "motion-mind-3", "--rts"][..], "runs no scripts"),
        (&["--mode", "3"][..], "--model motion-mind-3"),
    ] {
        let ending = Program::start(BRUSHWORK, &[&["sim"], options].concat()).finish(LIMIT);
        let said = ending.stderr.join("\n");
        assert!(ending.status.code() == Some(2) && said.contains(sentence), "{options:?}: {ending:?}");
    }
}

#[test]
fn the_command_line_drives_by_mode_reads_settings_and_talks_to_simulated_units_in_this_program() {
    let run = |arguments: &[&str]| {
        let mut ending = Program::start(BRUSHWORK, arguments).finish(LIMIT);
        for _ in 0..10 {
            if !ending.was_starved() {
                break;
            }
            ending = Program::start(BRUSHWORK, arguments).finish(LIMIT);
        }
        (ending.status.code(), ending.stdout.join("\n"), ending.stderr.join("\n"))
    };
    for protocol in ["binary", "ascii"] {
        let target = format!("sim:motion-mind-3,mode=3,protocol={protocol},address=7");
        let (code, out, said) = run(&["drive", "--connect", &target, "--duty", "50", "--for", "1"]);
        assert!(code == Some(0) && out.contains("50.0 %"), "{protocol}: {out} {said}");
        assert!(said.contains("no serial time-out"), "{said}");
        let (code, _, said) = run(&["drive", "--connect", &target, "--speed", "1000"]);
        assert!(code == Some(4) && said.contains("duties and nothing else"), "{code:?} {said}");
        let (code, out, said) = run(&["settings", "read", "--connect", &target]);
        assert!(code == Some(0) && out.contains("register.pterm") && out.contains("6000"), "{out} {said}");
        let (code, out, said) = run(&["status", "--connect", &target]);
        assert!(code == Some(0) && out.contains("unit 7") && out.contains("TEMPFAULT"), "{out} {said}");
        let (code, out, said) = run(&["stop", "--connect", &target]);
        assert!(code == Some(0) && out.contains("unit 7: motor stopped"), "{out} {said}");
    }
    let text = "sim:motion-mind-3,protocol=ascii";
    let (code, out, said) = run(&["terminal", "--connect", text, "R01 04", "Z01"]);
    assert!(code == Some(4) && out.contains("PTRM=6000") && said.contains("Z is never sent"), "{out} {said}");
    let (code, out, _) = run(&["protocol", "--family", "motion-mind"]);
    assert!(code == Some(0) && out.contains("MOVEAT_VELOCITY") && out.contains("NEWVELMODE"));
    let (code, out, _) = run(&["protocol", "--family", "motion-mind", "--json"]);
    assert!(code == Some(0) && out.contains("\"registers\""));
}
