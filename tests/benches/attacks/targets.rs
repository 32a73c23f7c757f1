//! The readers of what comes from outside, each with samples of what it reads and the words of its language.

use std::fs;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicU64};
use std::time::Duration;

use crate::brought;
use brushwork_canopen::adapter::{Decoder, Form};
use brushwork_canopen::sdo::{Abort, Dictionary, Server, Transfer};
use brushwork_core::keep::{Store, UnitId};
use brushwork_core::recording::open;
use brushwork_core::session::Simulation;
use brushwork_family::examine::Examination;
use brushwork_gui::graph::load;
use brushwork_gui::mcl::disk;
use brushwork_gui::motion_mind::model::terminal;
use brushwork_gui::remember;
use brushwork_link::ConnectTarget;
use brushwork_link::files::Disk;
use brushwork_link::settings::{Journal, Profile, Strictness};
use brushwork_mcp_client::firmware::suit_model;
use brushwork_mcp_wire::canopen::describe_frame;
use brushwork_mcp_wire::models;
use brushwork_mcp_wire::packet_serial::{
    Address, COMMANDS, Command, FramerEvent, Generation, ReplyProgress, Request, RequestFramer,
    describe_event, describe_reply, encode_reply_named, lookup, parse_reply,
};
use brushwork_motion_mind_wire as mind;
use brushwork_plant::faults::Fault;
use brushwork_script::image::{self, MAGIC};
use brushwork_script::mcl;
use brushwork_script::mcl::ast::Motion;
use brushwork_script::mcl::format::format;
use brushwork_script::mcl::index::Index;
use brushwork_script::mcl::registers::RegisterId;
use brushwork_script::mecc;
use brushwork_script::text::Lines;
use brushwork_script::vm::{Host, Machine};
use brushwork_tests::workspace;

/// Reads one input: its bytes, and the file that holds them.
pub type Reader = Box<dyn FnMut(&[u8], &Path)>;

/// A reader of what comes from outside.
pub struct Target {
    pub name: &'static str,
    /// What it reads when all is well.
    pub samples: fn() -> Vec<Vec<u8>>,
    /// Words of its language.
    pub words: &'static [&'static str],
    /// Made once; the folder is its own.
    pub reader: fn(&Path) -> Reader,
}

const JSON: &[&str] = &[
    "[1,",
    "{\"a\":",
    "{\"settings\":{\"",
    "\"value\":",
    "\"format\":\"brushwork-settings\",",
    "\"schema\":2,",
    "true,",
    "1e308,",
    "\"x\":{},",
    "{\"request\":{\"method\":\"velocity\"},\"verdict\":\"tuned\",\"record\":[",
    "\"schema\":\"brushwork-examination\",",
];
const MCL: &[&str] = &[
    "if 1 then\n",
    "while 1\n",
    "for x = 1 to 2\n",
    "x var long\n",
    "x=x+1\n",
    "x+",
    "-",
    "not ",
    "~",
    "endif\n",
    "wend\n",
    "next\n",
    "goto main\n",
    "main\n",
    "gosub ",
    "puts 0,[",
    "dec ",
    "table bytetable 1,2\n",
    "#define A B\n",
    "A con 1\n",
    "a: ",
    "'",
    "0x",
    "$F",
    "%1",
    ".5",
    "do\n",
    "select x\n",
    "case 1\n",
    "end\n",
];
const MECC: &[&str] = &[
    "Begin Program\n",
    "End Program\n",
    "Declare Byte a\n",
    "Declare DataTable t\n",
    "Reserve 65535\n",
    "End DataTable\n",
    "Declare Function f(a As Word) Returns Word\n",
    "End Function\n",
    "Declare EventHandler h()\n",
    "Loop\n",
    "End Loop\n",
    "Do\n",
    "Until a = 1\n",
    "If a Then ",
    "Else\n",
    "Select a\n",
    "Case 1, ",
    "Call f(",
    "Transmit p\n",
    "SetEvent ReceiveEvent, h\n",
    "a = ",
    "-",
    "Not ",
    "(",
    "+a*",
    "\"",
];
const CSV: &[&str] = &[
    "time_s,",
    "0.1,",
    "\"\"",
    "a\n",
    "1,2,3\n",
    "2026-01-01T00:00:00Z",
    "\tb\t",
    "1;2;3\n",
    "mark",
    "note",
];
const SPEC: &[&str] = &[
    "sim:",
    "mcp266",
    "roboclaw-2x30a",
    "motion-mind-3",
    ",",
    "generation=",
    "fault=",
    "mode=",
    "serial:",
    "tcp:",
    "can:",
    "/dev/ttyUSB0",
    "COM3",
    "baud=",
    "latency=",
    "family=",
    "silent@",
    "+",
    "crc@1s",
    "units=",
    "127.0.0.1:",
    "like=",
];

/// All of them.
pub static TARGETS: &[Target] = &[
    Target {
        name: "MCL source",
        samples: scripts,
        words: MCL,
        reader: |_| Box::new(|bytes, _| script(bytes)),
    },
    Target {
        name: "MCL file in the editor",
        samples: scripts,
        words: MCL,
        reader: |_| Box::new(|_, path| drop(disk::read(path))),
    },
    Target {
        name: "MeccCode source",
        samples: || all_of("assets/mecc"),
        words: MECC,
        reader: |_| Box::new(|bytes, _| board_program(bytes)),
    },
    Target {
        name: "MCL image",
        samples: images,
        words: &["\x01\0\0\0", "\u{1}"],
        reader: |_| Box::new(|bytes, _| run_image(bytes)),
    },
    Target { name: "profile", samples: profiles, words: JSON, reader: |_| Box::new(|_, path| profile(path)) },
    Target {
        name: "journal",
        samples: || kept("journals"),
        words: JSON,
        reader: |_| Box::new(|bytes, _| drop(Journal::parse(&text(bytes)))),
    },
    Target {
        name: "kept backup",
        samples: || kept("backups"),
        words: JSON,
        reader: |folder| keeper(folder, "backups", open_backups),
    },
    Target {
        name: "kept journal",
        samples: || kept("journals"),
        words: JSON,
        reader: |folder| keeper(folder, "journals", |store, unit| drop(store.open_journals(unit))),
    },
    Target {
        name: "kept count of saves",
        samples: || kept("wear"),
        words: JSON,
        reader: |folder| keeper(folder, "wear", |store, unit| drop(store.wear(unit))),
    },
    Target {
        name: "kept EEPROM",
        samples: || kept("eeprom"),
        words: JSON,
        reader: |folder| keeper(folder, "eeprom", |store, unit| drop(store.eeprom(unit))),
    },
    Target {
        name: "tuning report",
        samples: reports,
        words: JSON,
        reader: |_| Box::new(|_, path| drop(brushwork_core::tune::file::read(path))),
    },
    Target {
        name: "examination",
        samples: || vec![EXAMINATION.to_vec()],
        words: JSON,
        reader: |_| Box::new(examination),
    },
    Target {
        name: "recording",
        samples: recordings,
        words: CSV,
        reader: |_| Box::new(|_, path| recording(path)),
    },
    Target {
        name: "recording in the graph",
        samples: recordings,
        words: CSV,
        reader: |_| Box::new(|_, path| graph(path)),
    },
    Target {
        name: "state of the window",
        samples: || files(&["tests/net/files/window.json"]),
        words: JSON,
        reader: |_| Box::new(|_, path| drop(remember::read(&Disk, path))),
    },
    Target {
        name: "firmware image",
        samples: || files(&["tests/net/files/firmware.bin"]),
        words: &["BRUSHWORK"],
        reader: |_| Box::new(|bytes, _| firmware(bytes)),
    },
    Target {
        name: "fault script",
        samples: faults,
        words: SPEC,
        reader: |_| Box::new(|bytes, _| drop(text(bytes).parse::<Fault>())),
    },
    Target {
        name: "target of a connection",
        samples: specs,
        words: SPEC,
        reader: |_| Box::new(|bytes, _| target(bytes)),
    },
    Target {
        name: "packet serial, requests",
        samples: packets,
        words: &["\u{0}\u{80}"],
        reader: |_| Box::new(|bytes, _| requests(bytes)),
    },
    Target {
        name: "packet serial, replies",
        samples: packets_back,
        words: &["MCP266 2x60A v1.0.0\n\0"],
        reader: |_| Box::new(|bytes, _| replies(bytes)),
    },
    Target {
        name: "CAN adapter",
        samples: can,
        words: &["t", "T0", "\r", "\u{7}", "t5818", "t60184015200000000000\r"],
        reader: |_| Box::new(|bytes, _| adapter(bytes)),
    },
    Target {
        name: "Motion Mind, frames",
        samples: frames_of_mind,
        words: &["\u{1d}\u{1}", "\u{0}"],
        reader: |_| Box::new(|bytes, _| frames(bytes)),
    },
    Target {
        name: "Motion Mind, lines",
        samples: lines_of_mind,
        words: &["R01 ", "W01 ", "\r\n", ",", "-", "K01 "],
        reader: |_| Box::new(|bytes, _| mind_lines(bytes)),
    },
    Target {
        name: "Motion Mind, replies",
        samples: lines_of_mind,
        words: &["R01 ", "OK", "\r\n", ">"],
        reader: |_| Box::new(|bytes, _| mind_replies(bytes)),
    },
    Target {
        name: "terminal",
        samples: lines_of_mind,
        words: &["R01 ", "1D 01 ", "0x", " "],
        reader: |_| Box::new(|bytes, _| typed(bytes)),
    },
    Target {
        name: "SuprMotr, lines",
        samples: brought::lines_of_suprmotr,
        words: &["MA100\r", "TS\r", "MD1,", "\u{1}0", "!", "'", "\u{8}", ",", "-", "$FF"],
        reader: |_| Box::new(|bytes, _| brought::suprmotr_lines(bytes)),
    },
    Target {
        name: "SuprMotr, reports",
        samples: brought::reports_of_suprmotr,
        words: &["0S:", "P:+0000012345", "\r\n", "\u{3}", "C:", " FFFF"],
        reader: |_| Box::new(|bytes, _| brought::suprmotr_reports(bytes)),
    },
    Target {
        name: "SuprMotr macros",
        samples: brought::macros,
        words: &["macro home = 1\n", "end\n", "MA ", "const A = 1\n", "# ", "JP ", ", "],
        reader: |_| Box::new(|bytes, _| brought::suprmotr_macros(bytes)),
    },
    Target {
        name: "MotorVator, lines",
        samples: || {
            vec![b"I001002003\r".to_vec(), b"G\rH\r".to_vec(), b"S:001002003004005006007008\r".to_vec()]
        },
        words: &["I", "255", "256", "000", "G\r", "H\r"],
        reader: |_| Box::new(|bytes, _| brought::motorvator_lines(bytes)),
    },
    Target {
        name: "bytes in words",
        samples: || vec![b"80 15 0A 5 # read\n\n0x80,0x5A\n".to_vec(), b"1D 01 07 25\n".to_vec()],
        words: &["80 ", "0x", "5A", "\n", "# ", ",", "\t"],
        reader: |_| Box::new(|bytes, _| brought::bytes_in_words(bytes)),
    },
    Target {
        name: "composed command",
        samples: || vec![b"0\n-1\n0x80\n".to_vec(), b"1,2,3\nname\n".to_vec()],
        words: &["0x", "-", "4294967296", "1e9", ",", "\n", "\"", "FF "],
        reader: |_| Box::new(|bytes, _| brought::composed(bytes)),
    },
    Target {
        name: "dropped file",
        samples: brought::files_of_all_kinds,
        words: JSON,
        reader: |_| Box::new(|_, path| brought::dropped(path)),
    },
    Target {
        name: "pasted text",
        samples: scripts,
        words: MCL,
        reader: |_| Box::new(|bytes, _| brought::pasted(bytes)),
    },
];

/// The one of a name.
pub fn named(name: &str) -> Option<&'static Target> {
    TARGETS.iter().find(|target| target.name == name)
}

fn text(bytes: &[u8]) -> String {
    String::from_utf8_lossy(bytes).into_owned()
}

fn files(paths: &[&str]) -> Vec<Vec<u8>> {
    paths
        .iter()
        .map(|path| fs::read(workspace::root().join(path)).expect("a sample of the repository"))
        .collect()
}

/// Every file below a folder of the repository, in order.
fn below(folder: &str) -> Vec<PathBuf> {
    let (mut open, mut found) = (vec![workspace::root().join(folder)], Vec::new());
    while let Some(folder) = open.pop() {
        for entry in fs::read_dir(&folder).expect("a folder of the repository").flatten() {
            let path = entry.path();
            if path.is_dir() { open.push(path) } else { found.push(path) }
        }
    }
    found.sort();
    found
}

fn all_of(folder: &str) -> Vec<Vec<u8>> {
    below(folder).iter().map(|path| fs::read(path).expect("a sample of the repository")).collect()
}

fn scripts() -> Vec<Vec<u8>> {
    all_of("assets/mcl")
}

fn script(bytes: &[u8]) {
    let source = text(bytes);
    let formatted = format(&source);
    assert_eq!(format(&formatted), formatted, "what is in order stays so");
    drop(Index::of(&source));
    let compiled = mcl::compile(&source);
    let lines = Lines::of(&source);
    for said in &compiled.diagnostics {
        drop(said.render("x", &source, &lines));
    }
    let Some(program) = compiled.program else { return };
    assert_eq!(image::decode(&image::encode(&program)).as_ref(), Ok(&program));
    Machine::new(Arc::new(program)).run(&mut Nobody, 5_000);
}

fn board_program(bytes: &[u8]) {
    let source = text(bytes);
    let formatted = mecc::format::format(&source);
    assert_eq!(mecc::format::format(&formatted), formatted, "what is in order stays so");
    let compiled = mecc::compile(&source);
    let lines = Lines::of(&source);
    for said in &compiled.diagnostics {
        drop(said.render("x", &source, &lines));
    }
    let Some(program) = compiled.program else { return };
    assert_eq!(image::decode(&image::encode(&program)).as_ref(), Ok(&program));
    let mut machine = Machine::new(Arc::new(program));
    for event in 0..16 {
        machine.run(&mut Nobody, 300);
        machine.raise(event);
    }
}

fn images() -> Vec<Vec<u8>> {
    let programs = scripts().into_iter().filter_map(|source| mcl::compile(&text(&source)).program);
    programs.map(|program| image::encode(&program)[20..].to_vec()).collect()
}

/// Any bytes as an image with a right checksum: refused, or run.
fn run_image(body: &[u8]) {
    drop(image::decode(body));
    let mut bytes = MAGIC.to_vec();
    bytes.extend([1, 0, 0, 0]);
    bytes.extend(u32::try_from(20 + body.len()).unwrap_or(u32::MAX).to_le_bytes());
    bytes.extend(crc32fast::hash(body).to_le_bytes());
    bytes.extend(body);
    if let Ok(program) = image::decode(&bytes) {
        Machine::new(Arc::new(program)).run(&mut Nobody, 5_000);
    }
}

/// A host without streams, registers and motors.
struct Nobody;

impl Host for Nobody {
    fn now(&self) -> Duration {
        Duration::ZERO
    }
    fn register(&mut self, _: RegisterId, _: u8) -> u32 {
        42
    }
    fn set_register(&mut self, _: RegisterId, _: u8, _: u32) {}
    fn put(&mut self, _: u32, _: u8) {}
    fn get(&mut self, _: u32) -> Option<u8> {
        Some(b'7')
    }
    fn motion(&mut self, _: Motion, _: &[i32]) {}
    fn read_eeprom(&mut self, _: u32) -> u8 {
        0
    }
    fn write_eeprom(&mut self, _: u32, _: u8) {}
    fn i2c_write(&mut self, _: &[u8], _: bool, _: Option<Duration>) -> bool {
        true
    }
    fn i2c_read(&mut self, count: usize, _: Option<Duration>) -> Option<Vec<u8>> {
        Some(vec![0; count.min(256)])
    }
}

fn profiles() -> Vec<Vec<u8>> {
    files(&[
        "tests/net/files/profile mcp266.json",
        "tests/net/files/profile motion mind.json",
        "tests/net/files/profile roboclaw-2x7a.json",
    ])
}

fn profile(path: &Path) {
    for strictness in [Strictness::Refuse, Strictness::Repair] {
        if let Ok(opened) = Profile::open(path, strictness) {
            drop(opened.profile.to_json());
        }
    }
}

/// Files that the program keeps, of one kind.
const KEPT: &str = "tests/net/files/data";

fn kept(kind: &str) -> Vec<Vec<u8>> {
    all_of(&format!("{KEPT}/{kind}")).into_iter().take(3).collect()
}

/// A folder with one kept file of a kind, which is replaced by the input each time, and how that is read.
fn keeper(folder: &Path, kind: &str, read: fn(&Store, &UnitId)) -> Reader {
    let (source, root) = (workspace::root().join(KEPT), folder.join("kept"));
    let is_meant = |path: &PathBuf| {
        let place = path.strip_prefix(&source).expect("it lies below");
        place.starts_with(kind) && place.to_string_lossy().contains("netport")
    };
    let path = below(KEPT).into_iter().find(is_meant).expect("there is one of the kind");
    let replaced = root.join(path.strip_prefix(&source).expect("it lies below"));
    fs::create_dir_all(replaced.parent().expect("it has a folder")).expect("the folder is the attack's");
    let unit = UnitId {
        model: "mcp266".to_owned(),
        place: "tmp-netport".to_owned(),
        has_serial_number: false,
        address: 0x80,
        is_simulated: false,
    };
    let store = Store::at(root);
    Box::new(move |bytes, _| {
        fs::write(&replaced, bytes).expect("the folder is the attack's");
        read(&store, &unit);
    })
}

fn open_backups(store: &Store, unit: &UnitId) {
    for backup in store.backups(Some(unit)) {
        drop(backup.open());
    }
}

fn reports() -> Vec<Vec<u8>> {
    files(&["tests/net/files/report mcp266.json", "tests/net/files/report motion mind.json"])
}

const EXAMINATION: &[u8] = br#"{"schema":"brushwork-examination","version":1,"program":"x","family":"mcp","unit":{"version_text":"MCP266 2x60A v1.0.0","model":"mcp266","firmware":"1.0.0","generation":1,"protocol":"packet serial","notes":[]},"line":{},"commands":[],"answers":[],"not_askable":[]}"#;

fn examination(bytes: &[u8], path: &Path) {
    drop(Examination::parse(&text(bytes)));
    drop(brushwork_core::examine::like(path));
}

fn recordings() -> Vec<Vec<u8>> {
    files(&["tests/net/files/recording.csv", "tests/net/files/recording.bwr"])
}

fn recording(path: &Path) {
    drop(open::read(path, |_| {}, |_| true));
}

fn graph(path: &Path) {
    drop(load::load(path, &AtomicU64::new(0), &AtomicBool::new(false)));
}

fn firmware(bytes: &[u8]) {
    let model = models::lookup("mcp266").expect("a model");
    for is_simulated in [false, true] {
        drop(suit_model(bytes.to_vec(), model, is_simulated));
    }
}

fn faults() -> Vec<Vec<u8>> {
    ["silent@1s", "crc@0.5s-2s:to-host=0.1", "stall@2s:m1", "reset@3s"]
        .map(|fault| fault.as_bytes().to_vec())
        .to_vec()
}

fn specs() -> Vec<Vec<u8>> {
    let specs = [
        "sim:mcp266,generation=4",
        "sim:roboclaw-2x30a",
        "sim:motion-mind-3,mode=4",
        "/dev/ttyUSB0,baud=115200,latency=20ms",
        "tcp:127.0.0.1:4000",
        "can:/dev/ttyACM0",
    ];
    specs.map(|spec| spec.as_bytes().to_vec()).to_vec()
}

/// What is typed as a target. A long one that names simulated units is refused before any of them starts.
fn target(bytes: &[u8]) {
    let typed = text(bytes);
    if let Ok(ConnectTarget::Sim(spec)) = typed.parse::<ConnectTarget>()
        && spec.len() > LONGEST_SOUND
    {
        drop(Simulation::start(&spec));
    }
}

/// No sound description of simulated units is longer; shorter ones, which would start their threads, have their tests.
const LONGEST_SOUND: usize = 200;

/// Bytes that come without a pause, as [`requests`] and [`frames`] take them.
fn without_pause(bytes: &[u8]) -> impl Iterator<Item = u8> {
    bytes.iter().flat_map(|byte| [*byte, 0])
}

/// Any request of a command that the generation has.
fn request_of(number: u8, generation: Generation) -> Option<Request> {
    let form = lookup(number)?.form(generation)?;
    Some(Request::new(Address::DEFAULT, number, &vec![1; form.request.len()]))
}

/// One of each command, of each generation.
fn packets() -> Vec<Vec<u8>> {
    let of = |(index, generation): (u8, Generation)| {
        let requests = COMMANDS.iter().filter_map(move |command| request_of(command.number, generation));
        let packets = requests.filter_map(move |request| request.encode(generation).ok());
        let bytes = packets.flat_map(|packet| without_pause(&packet).collect::<Vec<u8>>());
        [index].into_iter().chain(bytes).collect()
    };
    (0..).zip(Generation::ALL).map(of).collect()
}

/// Replies of the newest generation to some commands.
fn packets_back() -> Vec<Vec<u8>> {
    let newest = Generation::ALL.len() - 1;
    let generation = Generation::ALL[newest];
    let of = |(index, command): (usize, &Command)| {
        let request = request_of(command.number, generation)?;
        let reply = encode_reply_named(&request, generation, |_| Some(1.into())).ok()?;
        Some([newest, index].iter().filter_map(|number| u8::try_from(*number).ok()).chain(reply).collect())
    };
    COMMANDS.iter().enumerate().step_by(8).filter_map(of).collect()
}

fn requests(data: &[u8]) {
    let Some((&first, arrivals)) = data.split_first() else { return };
    let generation = Generation::ALL[usize::from(first % 4)];
    let mut framer = RequestFramer::new(generation);
    let mut now = Duration::ZERO;
    for arrival in arrivals.chunks_exact(2) {
        // The second byte is mostly no pause.
        now += Duration::from_millis(u64::from(arrival[1].saturating_sub(240)));
        let Some(event) = framer.feed(arrival[0], now) else { continue };
        drop(describe_event(&event, generation));
        if let FramerEvent::Request(framed) = event {
            if framed.native {
                let again = framed.request().encode(generation).expect("what was framed can be sent");
                assert_eq!(again.len(), framed.raw.len());
            }
            drop(encode_reply_named(&framed.request(), generation, |_| Some(0.into())));
        }
    }
}

fn replies(data: &[u8]) {
    let &[first, number, ref bytes @ ..] = data else { return };
    let generation = Generation::ALL[usize::from(first % 4)];
    let command = &COMMANDS[usize::from(number) % COMMANDS.len()];
    let arguments = command.form(generation).map_or(0, |form| form.request.len());
    let request = Request::new(Address::DEFAULT, command.number, &vec![0; arguments]);
    match parse_reply(&request, generation, bytes) {
        ReplyProgress::NeedMore { at_least } => assert!(at_least > bytes.len()),
        ReplyProgress::Done { values, used } => {
            assert!(used <= bytes.len());
            drop(describe_reply(&request, &values, generation));
        }
        ReplyProgress::BadCrc { expected, got, used } => assert!(expected != got && used <= bytes.len()),
        ReplyProgress::BadAck { got } => assert_ne!(got, 0xFF),
        ReplyProgress::Malformed { .. } => {}
    }
}

fn can() -> Vec<Vec<u8>> {
    vec![b"t581843152001000000\rt70117F\r".to_vec()]
}

struct Objects(Vec<u8>);

impl Dictionary for Objects {
    fn read(&mut self, _: u16, _: u8) -> Result<Vec<u8>, Abort> {
        Ok(self.0.clone())
    }

    fn write(&mut self, _: u16, _: u8, value: &[u8]) -> Result<(), Abort> {
        self.0 = value.to_vec();
        Ok(())
    }
}

fn adapter(bytes: &[u8]) {
    for form in Form::ALL {
        let (mut server, mut objects) = (Server::default(), Objects(vec![7; 30]));
        let mut client = Transfer::upload(0x2015, 1);
        for frame in Decoder::new(form).feed_all(bytes) {
            drop(describe_frame(&frame));
            let _ = server.take(frame.bytes(), &mut objects);
            let _ = client.take(frame.bytes());
        }
    }
}

fn frames_of_mind() -> Vec<Vec<u8>> {
    let commands = [
        mind::Command::ChangeSpeed(300),
        mind::Command::MoveToAbsolute(-70_000),
        mind::Command::Write { register: 12, value: 5 },
        mind::Command::Read(0xFFFF_FFFF),
        mind::Command::ReadRegister(3),
        mind::Command::Restore,
    ];
    let frames =
        commands.iter().filter_map(|command| mind::encode_frame(mind::Address::FACTORY, command).ok());
    frames.map(|frame| without_pause(&frame).collect()).collect()
}

fn frames(data: &[u8]) {
    let mut reader = mind::FrameReader::new();
    let mut now = Duration::ZERO;
    for arrival in data.chunks_exact(2) {
        now += Duration::from_millis(u64::from(arrival[1].saturating_sub(246)));
        if let Some(mind::FrameEvent::Command(address, command)) = reader.feed(arrival[0], now) {
            drop(mind::describe_command(address, &command));
            let is_read = matches!(command, mind::Command::Read(_) | mind::Command::ReadRegister(_));
            if !(is_read && address.is_broadcast()) {
                mind::encode_frame(address, &command).expect("what came as a frame goes as one");
            }
        }
    }
}

fn lines_of_mind() -> Vec<Vec<u8>> {
    ["R01 18\r\n", "W01 3 100\r\n", "R01 0", "1D 01 12 30", "S01\r\n"]
        .map(|line| line.as_bytes().to_vec())
        .to_vec()
}

fn mind_lines(data: &[u8]) {
    let mut reader = mind::LineReader::new();
    for byte in data {
        if let Some(mind::LineEvent::Command(address, command)) = reader.feed(*byte) {
            drop(mind::describe_command(address, &command));
            if !(matches!(command, mind::Command::ReadText(_)) && address.is_broadcast()) {
                mind::encode_line(address, &command).expect("what came as a line goes as one");
            }
        }
    }
}

fn mind_replies(data: &[u8]) {
    let &[first, second, ref bytes @ ..] = data else { return };
    let row = &mind::COMMANDS[usize::from(first) % mind::COMMANDS.len()];
    let values = vec![i64::from(second % 32); row.values.len()];
    let Some(command) = mind::Command::from_parts(row.number, &values) else { return };
    let text = match command {
        mind::Command::Read(_) => mind::Command::ReadText(
            [mind::Part::All, mind::Part::StatusBits, mind::Part::FunctionBits][usize::from(second % 3)],
        ),
        mind::Command::ReadRegister(number) => mind::Command::ReadText(mind::Part::Register(number)),
        other => other,
    };
    let returns = mind::Returns::of_function(u16::from(second));
    for progress in [
        mind::parse_frame_reply(mind::Address::FACTORY, &command, returns, bytes),
        mind::parse_line_reply(&text, returns, bytes),
        mind::parse_all_loosely(bytes),
    ] {
        if let mind::Progress::Done { reply, used } = progress {
            assert!(0 < used && used <= bytes.len());
            drop(mind::describe_reply(&reply));
        }
    }
}

/// What is typed or pasted into a Motion Mind's terminal.
fn typed(bytes: &[u8]) {
    let typed = text(bytes);
    drop(terminal::of_text(&typed));
    drop(terminal::of_hex(&typed));
}
