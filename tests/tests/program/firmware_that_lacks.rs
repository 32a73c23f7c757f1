//! A unit whose firmware lacks commands: found out once, kept, not asked for again, and told as what it is.
#![cfg(unix)]
#![expect(clippy::print_stdout, reason = "measured times belong into the record of a test run")]

use std::collections::BTreeMap;
use std::io::{Read as _, Write as _};
use std::net::{TcpListener, TcpStream};
use std::sync::{Arc, Mutex};
use std::thread;
use std::time::Instant;

use brushwork_mcp_wire::packet_serial::number;
use brushwork_motion_mind_wire::numbers as motion_mind;
use brushwork_motion_mind_wire::register_number;
use brushwork_tests::program::{Ending, Program};
use brushwork_tests::wait::LIMIT;
use serde_json::Value;

const BRUSHWORK: &str = env!("CARGO_BIN_EXE_brushwork-for-tests");

/// What of a request the firmware lacks, as its capability map numbers it.
type Lacks = Box<dyn Fn(&[u8]) -> Option<u8> + Send>;

/// A simulated controller behind a line that keeps some commands from it: firmware without them.
struct Lacking {
    _sim: Program,
    target: String,
    asked: Arc<Mutex<BTreeMap<u8, usize>>>,
}

impl Lacking {
    fn start(model: &str, generation: &str, lacks: &'static [u8]) -> Self {
        let command_of = |request: &[u8]| match *request {
            [address, command, ..] if address >= 0x80 => Some(command),
            _ => None,
        };
        let arguments = ["--model", model, "--generation", generation];
        let lacking = move |request: &[u8]| command_of(request).filter(|it| lacks.contains(it));
        Self::behind(&arguments, Box::new(lacking), b"")
    }

    /// A Motion Mind that answers no read in which one of the registers is.
    fn motion_mind(lacks: &'static [u8]) -> Self {
        let registers = |request: &[u8]| match *request {
            [motion_mind::READ, _, a, b, c, d, _] => u32::from_le_bytes([a, b, c, d]),
            [motion_mind::READ_REGISTER, _, register, _] => 1 << register,
            _ => 0,
        };
        let lacking = move |request: &[u8]| {
            let asked = registers(request);
            lacks.iter().copied().find(|register| asked >> register & 1 == 1)
        };
        Self::behind(&["--model", "motion-mind-3", "--mode", "4"], Box::new(lacking), b"")
    }

    /// A Motion Mind in text that says of one register that it is none.
    fn motion_mind_in_text(lacks: u8) -> Self {
        let lacking = move |request: &[u8]| {
            let line = String::from_utf8_lossy(request);
            let register = line.strip_prefix('R')?.split_whitespace().nth(1)?.parse().ok()?;
            (register == lacks).then_some(register)
        };
        Self::behind(
            &["--model", "motion-mind-3", "--protocol", "ascii"],
            Box::new(lacking),
            b"BAD COMMAND\r\n",
        )
    }

    /// What is lacking is answered with `answer`.
    fn behind(arguments: &[&str], lacks: Lacks, answer: &'static [u8]) -> Self {
        let mut sim = Program::start(BRUSHWORK, &[&["sim", "--tcp", "127.0.0.1:0"], arguments].concat());
        let greeting = sim.wait_for("tcp:127.0.0.1:", LIMIT);
        let behind = greeting.rsplit("tcp:").next().unwrap_or_default().to_owned();
        let listener = TcpListener::bind("127.0.0.1:0").expect("a free port");
        let place = listener.local_addr().expect("it has an address");
        let is_mcp = !arguments.contains(&"motion-mind-3");
        let target = format!("tcp:{place}{}", if is_mcp { ",stream=usb" } else { "" });
        let asked = Arc::new(Mutex::new(BTreeMap::new()));
        let counts = Arc::clone(&asked);
        // The thread ends with the test's process; it waits for clients for as long as there may be some.
        named("lacking line", move || {
            for client in listener.incoming().flatten() {
                let Ok(unit) = TcpStream::connect(&behind) else { return };
                let _ = client.set_nodelay(true).and_then(|()| unit.set_nodelay(true));
                let back = client.try_clone().and_then(|to| Ok((unit.try_clone()?, to)));
                let (from, to) = back.expect("a connection can be held twice");
                named("lacking line back", move || pass(from, to, &|_| None, b"", &Mutex::default()));
                pass(client, unit, &lacks, answer, &counts);
            }
        });
        Self { _sim: sim, target, asked }
    }

    fn run(&self, arguments: &[&str]) -> Ending {
        let whole = [arguments, &["--connect", &self.target]].concat();
        Program::start(BRUSHWORK, &whole).finish(LIMIT)
    }

    /// How often the commands were asked for since the last call.
    fn take_asked(&self) -> BTreeMap<u8, usize> {
        std::mem::take(&mut *self.asked.lock().expect("no test has failed with it"))
    }
}

fn named(name: &str, work: impl FnOnce() + Send + 'static) {
    thread::Builder::new().name(name.to_owned()).spawn(work).expect("a thread can be started");
}

/// Passes bytes on but for requests of what is lacking, which are counted. A request of this program comes in one write.
fn pass(
    mut from: TcpStream,
    mut to: TcpStream,
    lacks: &dyn Fn(&[u8]) -> Option<u8>,
    answer: &[u8],
    asked: &Mutex<BTreeMap<u8, usize>>,
) {
    let mut bytes = [0; 1024];
    while let Ok(count) = from.read(&mut bytes) {
        if count == 0 {
            break;
        }
        match lacks(&bytes[..count]) {
            Some(lacking) => {
                *asked.lock().expect("no test has failed with it").entry(lacking).or_insert(0) += 1;
                if from.write_all(answer).is_err() {
                    break;
                }
            }
            None if to.write_all(&bytes[..count]).is_err() => break,
            None => {}
        }
    }
    let _ = to.shutdown(std::net::Shutdown::Both);
}

fn status_without_status(model: &str, generation: &str) {
    let unit = Lacking::start(model, generation, &[number::READ_STATUS, number::READ_ALL_STATUS]);
    let begun = Instant::now();
    let first = unit.run(&["status"]);
    let asked = unit.take_asked();
    println!("generation {generation}, first: {:?}, asked {asked:?}", begun.elapsed());
    assert!(asked[&number::READ_STATUS] >= 3, "{asked:?}");
    assert_eq!(first.status.code(), Some(0), "{first:?}");
    let begun = Instant::now();
    let second = unit.run(&["status", "--json", "--commands"]);
    println!("generation {generation}, second: {:?}", begun.elapsed());
    assert_eq!(second.status.code(), Some(0), "{second:?}");
    assert_eq!(unit.take_asked(), BTreeMap::new(), "a command known to be absent is not asked again");
    let json: Value = serde_json::from_str(&second.stdout.join("\n")).expect("JSON");
    let of = |wanted: u8| {
        let commands = json["commands"].as_array().expect("a list");
        commands.iter().find(|known| known["command"] == wanted).map(|known| known["presence"].clone())
    };
    assert_eq!(of(number::READ_STATUS), Some("absent".into()), "{json}");
    assert_eq!(of(number::READ_VERSION).or(of(number::READ_ENCODERS)), Some("present".into()), "{json}");
    assert!(json["readings"]["main_battery"].is_number(), "what it has is shown: {json}");
    let text = unit.run(&["status"]).stdout.join("\n");
    assert!(text.contains("This firmware does not have: read status (90)."), "{text}");
    assert_eq!(unit.take_asked(), BTreeMap::new());
    let anew = unit.run(&["status", "--learn-anew"]);
    assert_eq!(anew.status.code(), Some(0), "{anew:?}");
    assert!(unit.take_asked()[&number::READ_STATUS] >= 3, "what was forgotten is asked again");
}

#[test]
fn a_status_that_no_firmware_tells_is_waited_for_once() {
    status_without_status("mcp266", "1");
    status_without_status("mcp236", "4");
}

#[test]
fn settings_that_a_firmware_lacks_are_no_failure_and_are_not_blamed_on_the_cable() {
    const LACKS: &[u8] = &[
        number::READ_PWM_MODE,
        number::READ_ADDRESS_MIXED,
        number::READ_DEFAULT_ACCELS,
        number::READ_SERIAL_TIMEOUT,
        number::READ_PRIORITIES,
    ];
    let unit = Lacking::start("mcp266", "4", LACKS);
    // What a quiet line has to show before silence counts comes with the first read.
    unit.run(&["settings", "read"]);
    let again = unit.run(&["settings", "read"]);
    unit.take_asked();
    let third = unit.run(&["settings", "read"]);
    assert_eq!(unit.take_asked(), BTreeMap::new());
    for ending in [again, third] {
        assert_eq!(ending.status.code(), Some(0), "{ending:?}");
        let said = ending.stderr.join("\n");
        assert!(said.contains("this firmware does not have it") && !said.contains("baud rate"), "{said}");
    }
}

/// A Motion Mind reads many registers at once, so that one that its firmware lacks would keep all from being read.
#[test]
fn a_register_that_a_motion_mind_lacks_keeps_no_other_from_being_read() {
    let unit = Lacking::motion_mind(&[register_number::THERMISTOR, register_number::DEADBAND]);
    let first = unit.run(&["settings", "read", "--json"]);
    println!("asked at first: {:?}", unit.take_asked());
    assert_eq!(first.status.code(), Some(0), "{first:?}");
    unit.run(&["status"]);
    unit.take_asked();
    let status = unit.run(&["status", "--commands", "--json"]);
    let again = unit.run(&["settings", "read"]);
    assert_eq!(unit.take_asked(), BTreeMap::new(), "what is known to be lacking is not asked for");
    assert_eq!((status.status.code(), again.status.code()), (Some(0), Some(0)), "{status:?} {again:?}");
    let json: Value = serde_json::from_str(&status.stdout.join("\n")).expect("JSON");
    let of =
        |wanted: u8| json["commands"].as_array()?.iter().find(|known| known["command"] == wanted).cloned();
    let lacking = of(register_number::THERMISTOR).expect("it was learned");
    assert_eq!((&lacking["presence"], &lacking["title"]), (&"absent".into(), &"THERMISTOR".into()), "{json}");
    assert_ne!(of(register_number::POSITION).expect("it is read")["presence"], "absent", "{json}");
    let readings = &json["readings"];
    assert!(readings["m1_position"].is_number() && readings["m1_current"].is_number(), "{json}");
    assert!(readings["temperature_1"].is_null(), "{json}");
    let text = unit.run(&["status"]).stdout.join("\n");
    assert!(text.contains("This firmware does not have: THERMISTOR ("), "{text}");
}

#[test]
fn a_register_that_a_motion_mind_calls_no_command_in_text_is_lacking_and_no_damaged_reply() {
    let unit = Lacking::motion_mind_in_text(register_number::THERMISTOR);
    // Text reads most registers with one line for all; an examination asks for each.
    let examined = unit.run(&["examine"]);
    println!("asked at first: {:?}", unit.take_asked());
    assert_eq!(examined.status.code(), Some(0), "{examined:?}");
    let told = [examined.stdout, examined.stderr].concat().join("\n");
    let row = told.lines().find(|line| line.contains("register THERMISTOR")).expect("it is told");
    assert!(row.contains("absent") && !told.contains("makes no sense"), "{told}");
    let status = unit.run(&["status"]);
    assert_eq!(unit.take_asked(), BTreeMap::new(), "what is known to be lacking is not asked for");
    let text = status.stdout.join("\n");
    assert!(text.contains("This firmware does not have: THERMISTOR ("), "{text}");
}
