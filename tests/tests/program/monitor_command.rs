//! `brushwork monitor` from outside: its own traffic, a tap between two programs, and bytes from a file.
#![cfg(unix)]
#![expect(clippy::print_stdout, reason = "measured times belong into the record of a test run")]

use std::path::Path;
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

use brushwork_link::transport::{SerialTransport, Transport as _};
use brushwork_mcp_wire::packet_serial::Generation;
use brushwork_tests::program::{Child, Ending, Program};
use brushwork_tests::simulated::{LATE_PTY, OnPty, is_driven};
use brushwork_tests::wait::{self, LIMIT};
use serde_json::Value;

const BRUSHWORK: &str = env!("CARGO_BIN_EXE_brushwork-for-tests");

/// How often a busy machine may get in the way before a test gives up.
const TRIES: usize = 20;

fn start(arguments: &[&str]) -> Program {
    Program::start(BRUSHWORK, arguments)
}

fn run(arguments: &[&str]) -> Ending {
    start(arguments).finish(LIMIT)
}

fn text(path: &Path) -> String {
    path.to_string_lossy().into_owned()
}

fn code(ending: &Ending) -> Option<i32> {
    ending.status.code()
}

/// The lines of `--json` output.
fn records(ending: &Ending) -> Vec<Value> {
    let parsed = ending.stdout.iter().map(|line| serde_json::from_str(line));
    parsed.collect::<Result<_, _>>().unwrap_or_else(|error| panic!("{error}: {ending:?}"))
}

/// A simulated controller and a monitor that serves a second pseudo-terminal in front of it.
struct Tapped {
    controller: OnPty,
    folder: tempfile::TempDir,
    monitor: Program,
}

impl Tapped {
    fn start(generation: Generation, more: &[&str]) -> Self {
        let controller = OnPty::patient(generation);
        let folder = tempfile::tempdir().expect("a temporary folder");
        let tap = text(&folder.path().join("tap"));
        let port = text(&controller.port());
        let monitor = start(&[&["monitor", "--connect", &port, "--pty", &tap], more].concat());
        wait::for_path(&folder.path().join("tap"));
        Self { controller, folder, monitor }
    }

    fn tap(&self) -> String {
        text(&self.folder.path().join("tap"))
    }

    fn is_gone(folder: &Path) -> bool {
        folder.join("tap").symlink_metadata().is_err()
    }

    /// Ends the monitor and gives its output.
    fn end(self, signal: &str) -> Ending {
        self.monitor.signal(signal);
        let ending = self.monitor.finish(LIMIT);
        assert_eq!(code(&ending), Some(130), "{ending:?}");
        assert!(Self::is_gone(self.folder.path()), "the link is left behind after SIG{signal}");
        ending
    }
}

#[test]
fn its_own_polling_is_shown_in_words_and_as_json() {
    let ending = run(&["monitor", "--connect", "sim:mcp266,generation=2", "--for", "0.5", "--json"]);
    assert_eq!(code(&ending), Some(0), "{ending:?}");
    assert!(ending.stderr.join(" ").contains("generation 2"), "{ending:?}");
    let records = records(&ending);
    let request = |record: &Value| record["direction"] == "to_controller" && record["hex"] == "80 5A";
    let at = records.iter().position(request).expect("a status request");
    let reply = &records[at + 1];
    assert_eq!(reply["direction"], "from_controller");
    assert!(reply["text"].as_str().is_some_and(|text| text.contains("0x80 read status: 0x")), "{reply}");
    assert!(reply["time_s"].as_f64() > records[at]["time_s"].as_f64());
}

#[test]
fn a_tap_passes_another_programs_bytes_and_tells_them_while_clients_come_and_go() {
    // A client or a controller that a busy machine keeps waiting is a fault on the line, which the tap has to tell.
    let undisturbed = (0..TRIES).any(|_| told_of_two_clients().is_empty());
    assert!(undisturbed, "faults are told of a line without any");
}

/// What a tap tells of faults while two clients come and go.
fn told_of_two_clients() -> Vec<Value> {
    let tapped = Tapped::start(Generation::Gen3, &["--json"]);
    for _ in 0..2 {
        let ending = run(&["status", "--connect", &format!("{}{LATE_PTY}", tapped.tap()), "--json"]);
        assert_eq!(code(&ending), Some(0), "{ending:?}");
        let status: Value = serde_json::from_str(&ending.stdout.join("\n")).expect("JSON");
        assert_eq!(status["identity"]["generation"], 3, "{status}");
    }
    let ending = tapped.end("TERM");
    let records = records(&ending);
    let reported = |record: &&Value, direction: &str, words: &str| {
        record["direction"] == direction && record["text"].as_str().is_some_and(|text| text.contains(words))
    };
    let versions =
        records.iter().filter(|record| reported(record, "from_controller", "MCP266 2x60A")).count();
    assert!(versions >= 2, "each client reads the version: {ending:?}");
    let is_wrong = |record: &Value| {
        ["no answer", "bad reply", "dropped", "answer to nothing"]
            .iter()
            .any(|words| record["text"].as_str().is_some_and(|text| text.contains(words)))
    };
    let wrong: Vec<Value> = records.into_iter().filter(is_wrong).collect();
    println!("{wrong:#?}");
    wrong
}

#[test]
fn a_hundred_round_trips_in_a_row_pass_a_tap() {
    let tapped = Tapped::start(Generation::Gen1, &[]);
    let median = |path: &str| {
        let mut port = SerialTransport::open(path, 115_200).expect("the port opens");
        let mut times: Vec<Duration> = (0..101).map(|_| round_trip(&mut port)).collect();
        times.sort();
        times[50]
    };
    let tap_time = median(&tapped.tap());
    tapped.end("INT");
    let direct = median(&text(&OnPty::start(Generation::Gen1).port()));
    // What it costs is measured by `brushwork bench tap`.
    println!("round trip {direct:?}, through the tap {tap_time:?}");
}

/// Reads the main battery.
fn round_trip(port: &mut SerialTransport) -> Duration {
    let start = Instant::now();
    port.write(&[0x80, 24]).expect("the port takes bytes");
    let (mut reply, mut chunk) = (Vec::<u8>::new(), [0; 16]);
    while reply.len() < 4 {
        let count = port.read(&mut chunk, LIMIT).expect("the port is there");
        assert!(count > 0, "no answer");
        reply.extend(&chunk[..count]);
    }
    start.elapsed()
}

fn stops_what_the_client_drove(signal: &str) {
    let stopped = (0..TRIES).any(|_| {
        let tapped = Tapped::start(Generation::Gen1, &[]);
        let target = format!("{},stream=usb{LATE_PTY}", tapped.tap());
        let client =
            start(&["drive", "--connect", &target, "--motor", "both", "--duty", "40", "--for", "600"]);
        tapped.controller.wait_until("a client that drives", is_driven);
        tapped.monitor.signal(signal);
        let off = tapped.controller.wait_until_off();
        println!("SIG{signal} to the tap: {off:?}");
        off.assert_by_command();
        let ending = tapped.monitor.finish(LIMIT);
        assert_eq!(code(&ending), Some(130), "{ending:?}");
        let said = ending.stderr.join(" ");
        // The motors are off, but a busy machine may bring the confirmation too late.
        let is_confirmed = said.contains("Stopped both motors of 0x80");
        assert!(
            is_confirmed || said.contains("Told both motors of 0x80 to stop, but it did not"),
            "{ending:?}"
        );
        let client = client.finish(LIMIT);
        let was_late = client.was_starved() || client.found_silence();
        assert!(was_late || code(&client) == Some(3), "the client has lost its link: {client:?}");
        is_confirmed && !was_late
    });
    assert!(stopped, "the machine has a processor for the client and the confirmation now and then");
}

#[test]
fn a_tap_that_is_ended_stops_the_motors_that_its_client_drove() {
    stops_what_the_client_drove("TERM");
}

#[test]
fn a_tap_whose_terminal_closes_stops_the_motors_that_its_client_drove() {
    stops_what_the_client_drove("HUP");
}

#[test]
fn a_tap_whose_reader_goes_ends_and_removes_its_link() {
    let controller = OnPty::start(Generation::Gen1);
    let folder = tempfile::tempdir().expect("a temporary folder");
    let tap = folder.path().join("tap");
    let mut command = Command::new(BRUSHWORK);
    command.args(["monitor", "--connect", &text(&controller.port()), "--pty", &text(&tap)]);
    let mut monitor = Child::spawn(&command, [Stdio::null(), Stdio::piped(), Stdio::null()]);
    wait::for_path(&tap);
    monitor.close_stdout();
    let client = run(&["status", "--connect", &text(&tap)]);
    let status = monitor.finish(LIMIT);
    assert_eq!(status.code(), Some(130), "{client:?}");
    assert!(Tapped::is_gone(folder.path()));
}

#[test]
fn a_tap_on_tcp_says_where_it_is_and_is_connected_to_there() {
    let mut monitor = start(&["monitor", "--connect", "sim:mcp236,generation=4", "--tcp", "127.0.0.1:0"]);
    let greeting = monitor.wait_for_error("Between tcp:127.0.0.1:", LIMIT);
    let place = greeting.split_whitespace().nth(1).expect("a second word");
    let status = run(&["status", "--connect", &format!("{place},stream=usb")]);
    assert!(status.stdout.join("\n").contains("MCP236 at 0x80"), "{status:?}");
    monitor.wait_for("read version", LIMIT);
    monitor.signal("INT");
    assert_eq!(code(&monitor.finish(LIMIT)), Some(130));
}

#[test]
fn a_tap_ends_when_its_time_is_over() {
    let ending = run(&["monitor", "--connect", "sim:mcp236", "--tcp", "127.0.0.1:0", "--for", "0.2"]);
    assert_eq!(code(&ending), Some(0), "{ending:?}");
}

#[test]
fn a_place_that_cannot_be_served_is_told_in_a_sentence() {
    let file = tempfile::NamedTempFile::new().expect("a file");
    let taken = text(file.path());
    for (arguments, words) in [
        (["--pty", taken.as_str()], "is already there"),
        (["--tcp", "192.0.2.1:7000"], "only served on this computer"),
        (["--tcp", "banana"], "no address to listen on"),
    ] {
        let ending = run(&[&["monitor", "--connect", "sim:mcp266"][..], &arguments].concat());
        assert_eq!(code(&ending), Some(1), "{ending:?}");
        let reported = ending.stderr.join(" ");
        assert!(reported.contains(words) && reported.ends_with('.'), "{reported}");
    }
    assert!(file.path().exists(), "what was there is left alone");
}

fn decode(input: &str, more: &[&str]) -> Ending {
    let mut program = start(&[&["monitor", "--decode", "-"], more].concat());
    program.say(input);
    program.finish(LIMIT)
}

#[test]
fn bytes_of_requests_are_decoded_from_standard_input_and_from_a_file() {
    let ending = decode("80 15 59 0C, 0x80 0x18\n80 AA", &[]);
    assert_eq!(code(&ending), Some(0), "{ending:?}");
    let texts: Vec<&str> =
        ending.stdout.iter().map(|line| line.split("  ").last().unwrap_or_default()).collect();
    let first = ["0x80 read version", "0x80 read main battery", "dropped 80 AA: unknown command"];
    assert_eq!(texts.iter().map(|text| text.trim()).collect::<Vec<_>>(), first);

    let folder = tempfile::tempdir().expect("a temporary folder");
    let file = folder.path().join("capture.txt");
    std::fs::write(&file, "# read all status\n80 49\n").expect("the file is written");
    let ending = run(&["monitor", "--decode", &text(&file), "--generation", "4", "--json"]);
    assert_eq!(records(&ending)[0]["text"], "0x80 read all status", "{ending:?}");
    assert_eq!(records(&ending)[0]["time_s"], Value::Null);
}

#[test]
fn a_bad_digit_and_a_missing_file_are_told_in_a_sentence() {
    let ending = decode("80 15\n80 1G", &[]);
    assert_eq!(code(&ending), Some(1), "{ending:?}");
    assert!(
        ending.stderr.join(" ").contains("line 2, column 5: \"G\" is no hexadecimal digit"),
        "{ending:?}"
    );
    assert!(ending.stdout.is_empty(), "{ending:?}");
    let ending = run(&["monitor", "--decode", "/no/such/file"]);
    assert_eq!(code(&ending), Some(1), "{ending:?}");
    assert!(ending.stderr.join(" ").starts_with("Could not decode /no/such/file"), "{ending:?}");
}

/// A Motion Mind on a pseudo-terminal, a monitor in front of it, and a foreign client on the other side of that.
fn motion_mind_behind_a_tap(protocol: &str) -> (Ending, Vec<Value>) {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let (unit, tap) = (text(&folder.path().join("mm")), text(&folder.path().join("tap")));
    let _sim =
        start(&["sim", "--model", "motion-mind-3", "--mode", "3", "--protocol", protocol, "--pty", &unit]);
    wait::for_path(&folder.path().join("mm"));
    let target = format!("{unit},family=motion-mind");
    let monitor = start(&["monitor", "--connect", &target, "--pty", &tap, "--json"]);
    wait::for_path(&folder.path().join("tap"));
    let mut client = SerialTransport::open(&tap, 19_200).expect("the port opens");
    let commands: [(&[u8], usize); 3] = match protocol {
        // READ REGISTER 18, MODE; a checksum that is wrong; CHANGE_SPEED 300.
        "binary" => [(&[0x1D, 1, 18, 0x30], 3), (&[0x1D, 1, 18, 0x31], 0), (&[0x14, 1, 0x2C, 0x01, 0x42], 1)],
        _ => [(b"R01 18\r\n", 8), (b"Q01\r\n", 13), (b"C01 300\r\n", 4)],
    };
    for (bytes, length) in commands {
        client.write(bytes).expect("the tap takes it");
        let mut answer = Vec::new();
        let begun = Instant::now();
        let patience = if length == 0 { Duration::from_millis(100) } else { LIMIT };
        while answer.len() < length.max(1) && begun.elapsed() < patience {
            let mut buffer = [0; 64];
            let count = client.read(&mut buffer, Duration::from_millis(20)).expect("the tap is there");
            answer.extend_from_slice(&buffer[..count]);
        }
        assert_eq!(answer.len(), length, "{bytes:?}: {answer:?}");
    }
    monitor.signal("INT");
    let ending = monitor.finish(LIMIT);
    let records = records(&ending);
    drop(client);
    // The motor stands: PWMOUT is 0.
    let mut port = SerialTransport::open(&unit, 19_200).expect("the unit is free again");
    let stands = |port: &mut SerialTransport| {
        let ask: &[u8] = if protocol == "binary" { &[0x1D, 1, 21, 0x33] } else { b"R01 21\r\n" };
        port.write(ask).expect("the port takes it");
        let mut buffer = [0; 64];
        let count = port.read(&mut buffer, Duration::from_millis(500)).expect("the port is there");
        std::thread::sleep(Duration::from_millis(20));
        matches!(&buffer[..count], [1, 0, 0, 1] | b"PWMO=0\r\n")
    };
    wait::until("the motor stands", || stands(&mut port), || format!("{:?}", ending.stderr));
    (ending, records)
}

#[test]
fn a_tap_in_front_of_a_motion_mind_tells_both_protocols_and_stops_what_runs_on() {
    for (protocol, wrong) in [("binary", "checksum is 0x31 and not 0x30"), ("ascii", "no command: \"Q01\"")] {
        let (ending, records) = motion_mind_behind_a_tap(protocol);
        let reported: Vec<&str> = records.iter().filter_map(|record| record["text"].as_str()).collect();
        for words in ["unit 1: read MODE", "MODE 3", wrong, "unit 1: drive 300 of 1023", "acknowledged"] {
            assert!(reported.iter().any(|text| text.contains(words)), "{protocol} {words}: {reported:?}");
        }
        let said = ending.stderr.join("\n");
        assert!(said.contains("the motor of unit 1"), "{protocol}: {said}");
    }
}

#[test]
fn frames_of_a_motion_mind_are_decoded_from_a_file() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let file = folder.path().join("frames.txt");
    let lines = "15 01 F0 D8 FF FF DC   # -10000\n1A 01 04 01 18 00 38\n17 63 00 00 7A\n80 15\n";
    std::fs::write(&file, lines).expect("the folder takes it");
    let ending = run(&["monitor", "--family", "motion-mind", "--decode", &text(&file)]);
    assert_eq!(code(&ending), Some(0), "{ending:?}");
    let wanted = [
        "unit 1: move to -10000 counts",
        "unit 1: read VELOCITYFF, PIDSCALAR, ANALOGCON, ANALOGFBCK",
        "all units: turn at 0 counts per loop",
        "0x80 begins none",
    ];
    for (line, words) in ending.stdout.iter().zip(wanted) {
        assert!(line.contains(words), "{words}: {ending:?}");
    }
    assert_eq!(ending.stdout.len(), wanted.len(), "{ending:?}");
}
