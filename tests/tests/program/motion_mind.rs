//! `brushwork sim --model motion-mind-3` from outside: the bytes and lines of its manual over a socket.
#![cfg(unix)]

use std::io::{Read, Write};
use std::net::TcpStream;
use std::path::Path;
use std::process::Command;

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
fn a_unit_that_is_alone_is_found_at_whatever_address_it_has_and_of_several_each_is_named() {
    let status = |addresses: &str, options: &[&str]| {
        let (program, stream) = served(&["--address", addresses, "--mode", "3"]);
        let place = format!("tcp:{}", stream.peer_addr().expect("it is connected"));
        drop(stream);
        let arguments = [&["status", "--connect", &place], options].concat();
        let ending = Program::start(BRUSHWORK, &arguments).finish(LIMIT);
        drop(program);
        ending
    };
    let named = &["--family", "motion-mind"][..];
    // Most of it is listening to addresses without a unit, so that they do it at once.
    let asked = [("7", named), ("3,7", named), ("7", &[]), ("3,7", &["--address", "7"])];
    let [alone, several, untold, addressed] = std::thread::scope(|scope| {
        let asking = asked.map(|(addresses, options)| scope.spawn(move || status(addresses, options)));
        asking.map(|asking| asking.join().expect("it has not failed"))
    });
    let ending = alone;
    assert_eq!(ending.status.code(), Some(0), "{ending:?}");
    assert!(ending.stderr.iter().any(|line| line.contains("Motion Mind 3 answers at unit 7")), "{ending:?}");
    let ending = several;
    assert_eq!(ending.status.code(), Some(2), "{ending:?}");
    assert!(
        ending.stderr.iter().any(|line| line.contains("unit 3, unit 7") && line.contains("--address")),
        "{ending:?}"
    );
    let ending = untold;
    assert_eq!(ending.status.code(), Some(3), "{ending:?}");
    assert!(ending.stderr.iter().any(|line| line.contains("family=motion-mind")), "{ending:?}");
    let ending = addressed;
    assert_eq!((ending.status.code(), ending.stderr.len()), (Some(0), 0), "{ending:?}");
}

#[test]
fn stop_finds_and_stops_units_at_other_addresses_than_the_factorys_without_being_told_the_family() {
    let (program, mut stream) = served(&["--address", "3,7", "--mode", "3"]);
    let port = stream.peer_addr().expect("it is connected").to_string();
    for unit in [3, 7] {
        // CHANGE_SPEED 763: the motor runs on until somebody stops it.
        ask(&mut stream, &[0x14, unit, 0xFB, 0x02, 0x11 + unit], &[0x06]);
    }
    drop(stream);
    let ending = Program::start(BRUSHWORK, &["stop", "--connect", &format!("tcp:{port}")]).finish(LIMIT);
    assert_eq!(ending.status.code(), Some(0), "{ending:?}");
    for unit in [3, 7] {
        let reported = format!("unit {unit}: motor stopped");
        assert!(ending.stdout.iter().any(|sentence| sentence.starts_with(&reported)), "{ending:?}");
    }
    let mut stream = TcpStream::connect(port).expect("it is still served");
    stream.set_read_timeout(Some(LIMIT)).expect("a timeout can be set");
    for unit in [3, 7] {
        // READ REGISTER 21, PWMOUT.
        let request = [0x1D, unit, 21];
        let sum = request.iter().fold(0_u8, |sum, byte| sum.wrapping_add(*byte));
        ask(&mut stream, &[&request[..], &[sum]].concat(), &[unit, 0, 0, unit]);
    }
    drop(program);
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
    let by_protocol = |protocol: &str| {
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
    };
    // Each command looks for the unit first, which is waiting: both at once.
    std::thread::scope(|scope| {
        for protocol in ["binary", "ascii"] {
            scope.spawn(move || by_protocol(protocol));
        }
    });
    let text = "sim:motion-mind-3,protocol=ascii";
    let (code, out, said) = run(&["terminal", "--connect", text, "R01 04", "Z01"]);
    assert!(code == Some(4) && out.contains("PTRM=6000") && said.contains("Z is never sent"), "{out} {said}");
    let (code, out, _) = run(&["protocol", "--family", "motion-mind"]);
    assert!(code == Some(0) && out.contains("MOVEAT_VELOCITY") && out.contains("NEWVELMODE"));
    let (code, out, _) = run(&["protocol", "--family", "motion-mind", "--json"]);
    assert!(code == Some(0) && out.contains("\"registers\""));
}

/// What the program says and how it ends, with what it keeps of controllers in a folder of the test.
fn run_in(folder: &Path, arguments: &[&str]) -> (Option<i32>, String, String) {
    let once = || {
        let mut command = Command::new(BRUSHWORK);
        command.args(arguments).current_dir(folder).env("BRUSHWORK_DATA_DIR", folder.join("kept"));
        Program::spawn(command).finish(LIMIT)
    };
    let mut ending = once();
    for _ in 0..10 {
        if !ending.was_starved() {
            break;
        }
        ending = once();
    }
    (ending.status.code(), ending.stdout.join("\n"), ending.stderr.join("\n"))
}

/// The whole life of a unit's settings on the command line, in one of its protocols.
fn settings_through_their_life(protocol: &str) {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let folder = folder.path();
    let options = ["--protocol", protocol, "--address", "5", "--revision", "9"];
    let (_sim, stream) = served(&options);
    let port = format!("tcp:{}", stream.peer_addr().expect("it is connected"));
    drop(stream);
    let target = format!("{port},family=motion-mind");
    let at_unit = ["--connect", &target, "--address", "5"];
    let settings =
        |act: &str, more: &[&str]| run_in(folder, &[&["settings", act], &at_unit[..], more].concat());
    let expect = |wanted: i32, words: &str, (code, out, said): (Option<i32>, String, String)| {
        let all = format!("{out}\n{said}");
        assert!(code == Some(wanted) && all.contains(words), "{protocol} {words}: {code:?} {all}");
        all
    };
    expect(0, "register.pterm", settings("read", &["register"]));
    expect(0, "before.json", settings("export", &["before.json"]));
    expect(
        0,
        "2 settings written and read back",
        settings("write", &["register.pterm=4321", "function.satprot=on", "--yes"]),
    );
    expect(6, "register.pterm", settings("diff", &["before.json"]));
    expect(5, "below the lowest value, 1", settings("write", &["register.velocitylimit=0", "--yes"]));
    let said = expect(0, "read back", settings("save", &["--yes"]));
    assert!(said.contains("stops the motor"), "{said}");
    expect(0, "agree", settings("compare", &["ram", "eeprom"]));
    expect(0, "register.dterm", settings("write", &["register.dterm=99", "--yes"]));
    let said = expect(0, "1 setting came back otherwise", settings("reload", &["--yes"]));
    assert!(said.contains("its motor stops") && said.contains("register.dterm"), "{said}");
    // The profile of a unit with other firmware is taken for what both have.
    let profile = std::fs::read_to_string(folder.join("before.json")).expect("it was exported");
    let older = profile.replace("\"generation\": 9", "\"generation\": 5").replace("revision 9", "revision 5");
    assert_ne!(profile, older, "{profile}");
    std::fs::write(folder.join("older.json"), older).expect("the folder takes it");
    expect(0, "register.pterm", settings("import", &["older.json", "--yes"]));
    expect(0, "before-write", run_in(folder, &["settings", "backups"]));
    expect(0, "4321", settings("restore", &["--yes"]));
    expect(0, "was cut short", settings("unfinished", &[]));
    let said = expect(0, "restored in RAM and EEPROM", settings("defaults", &["--yes"]));
    assert!(said.contains("stops the motor") && said.contains("answers at 1 now"), "{said}");
    expect(0, "6000", run_in(folder, &["settings", "read", "--connect", &target, "register.pterm"]));
    // Found without its family being named, at the factory address; told once which revision it is.
    let reported = expect(0, "revision 9", run_in(folder, &["status", "--connect", &port]));
    assert_eq!(reported.matches("revision 9").count(), 1, "{reported}");
}

#[test]
fn settings_live_on_the_command_line_in_binary() {
    settings_through_their_life("binary");
}

#[test]
fn settings_live_on_the_command_line_in_text() {
    settings_through_their_life("ascii");
}

#[test]
fn the_terminal_warns_before_what_stops_the_motor() {
    for (protocol, command) in [("binary", "19 01 02 80"), ("ascii", "S01 02 128"), ("ascii", "X01")] {
        let target = format!("sim:motion-mind-3,protocol={protocol}");
        let folder = tempfile::tempdir().expect("a temporary folder");
        let (code, out, said) = run_in(folder.path(), &["terminal", "--connect", &target, command]);
        assert!(code == Some(0) && said.contains("motor is stopped"), "{protocol} {command}: {out} {said}");
    }
    let folder = tempfile::tempdir().expect("a temporary folder");
    let (code, _, said) = run_in(folder.path(), &["terminal", "--connect", "sim:motion-mind-3", "1D 01 04"]);
    assert!(code == Some(0) && !said.contains("motor is stopped"), "{said}");
}
