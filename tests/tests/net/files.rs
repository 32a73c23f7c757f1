//! Every kind of file that version 0.1 wrote is opened and means what it meant. The files in `tests/net/files` are its own.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use brushwork_core::recording::{Head, Record, open};
use brushwork_gui::mcl::journal::Journal;
use brushwork_gui::model::Model;
use brushwork_gui::remember::Memory;
use brushwork_tests::program::Child;
#[cfg(unix)]
use brushwork_tests::program::Program;
use brushwork_tests::wait::LIMIT;
use serde_json::Value;
use tempfile::TempDir;

use crate::folder;

const DONE: i32 = 0;
const FAILED: i32 = 1;
const DIFFERENT: i32 = 6;

fn file(name: &str) -> PathBuf {
    folder().join("files").join(name)
}

/// A folder of the program's own with what 0.1 kept of the simulated controllers.
fn kept() -> TempDir {
    let work = TempDir::new().expect("a temporary folder can be made");
    copy(&file("data"), &work.path().join("data"));
    work
}

fn copy(from: &Path, to: &Path) {
    fs::create_dir_all(to).expect("the folder is the test's");
    for entry in fs::read_dir(from).unwrap_or_else(|error| panic!("{}: {error}", from.display())) {
        let entry = entry.expect("it can be listed");
        let target = to.join(entry.file_name());
        if entry.path().is_dir() {
            copy(&entry.path(), &target);
        } else {
            fs::copy(entry.path(), &target).expect("the folder is the test's");
        }
    }
}

/// What 0.1 kept of a controller at a port of its own, as if it had been at this one.
#[cfg(unix)]
fn kept_at(port: &Path) -> TempDir {
    const PORT: &str = "/tmp/netport";
    let slug = |path: &str| {
        let safe = |letter: char| if letter.is_ascii_alphanumeric() || letter == '.' { letter } else { '-' };
        path.chars().map(safe).collect::<String>().trim_matches('-').to_owned()
    };
    let (work, port) =
        (TempDir::new().expect("a temporary folder can be made"), port.to_str().expect("it is text"));
    for folder in ["backups/mcp266-0x80-tmp-netport", "eeprom", "journals", "wear"] {
        let name = |name: &str| name.replace(&slug(PORT), &slug(port));
        let target = work.path().join("data").join(name(folder));
        fs::create_dir_all(&target).expect("the folder is the test's");
        for entry in fs::read_dir(file("data").join(folder)).expect("it is in the repository") {
            let entry = entry.expect("it can be listed");
            let text = fs::read_to_string(entry.path()).expect("it is text").replace(PORT, port);
            let target = target.join(name(&entry.file_name().to_string_lossy()));
            fs::write(target, text).expect("the folder is the test's");
        }
    }
    work
}

/// Runs the program in a folder of its own; what it printed, once it ended as it should.
#[track_caller]
fn brushwork(work: &TempDir, arguments: &[&str], code: i32) -> String {
    let mut command = Command::new(env!("CARGO_BIN_EXE_brushwork-for-tests"));
    command.env("BRUSHWORK_DATA_DIR", work.path().join("data")).current_dir(work.path()).args(arguments);
    let output = Child::output(&command, b"", LIMIT);
    let [printed, said] =
        [output.stdout, output.stderr].map(|text| String::from_utf8_lossy(&text).into_owned());
    assert_eq!(output.status.code(), Some(code), "{arguments:?}: {printed}{said}");
    printed
}

/// The only member of a list that was printed as JSON.
#[track_caller]
fn listed(work: &TempDir, arguments: &[&str], code: i32) -> Vec<Value> {
    let printed = brushwork(work, arguments, code);
    let value: Value = serde_json::from_str(&printed).unwrap_or_else(|error| panic!("{error}: {printed}"));
    let list = value.as_array().or_else(|| value.as_object()?.values().find_map(Value::as_array));
    list.unwrap_or_else(|| panic!("no list in {printed}")).clone()
}

const TARGETS: [(&str, &str); 4] = [
    ("mcp266", "sim:mcp266"),
    ("mcp266 generation 4", "sim:mcp266,generation=4"),
    ("roboclaw-2x7a", "sim:roboclaw-2x7a"),
    ("motion mind", "sim:motion-mind-3,mode=4"),
];

/// What a factory RoboClaw has other than the simulated one of the version that wrote its profile.
const ROBOCLAW_DIFFERS: [&str; 5] = [
    "roboclaw.config.mode",
    "roboclaw.config.baud",
    "roboclaw.config.word",
    "roboclaw.deadband.reverse",
    "roboclaw.deadband.forward",
];

#[test]
fn profiles_are_compared_and_written() {
    for (name, target) in TARGETS {
        let work = kept();
        let profile = file(&format!("profile {name}.json"));
        let profile = profile.to_str().expect("the folder's name is text");
        let differing: &[&str] = if name == "roboclaw-2x7a" { &ROBOCLAW_DIFFERS } else { &[] };
        let code = if differing.is_empty() { DONE } else { DIFFERENT };
        let told = brushwork(&work, &["settings", "diff", "--connect", target, profile], code);
        let keys: Vec<&str> = told
            .lines()
            .filter(|line| line.starts_with("  "))
            .filter_map(|line| line.split_whitespace().next())
            .collect();
        assert_eq!(keys, differing, "{told}");
        brushwork(&work, &["settings", "import", "--connect", target, "--yes", profile], DONE);
    }
}

#[test]
fn backups_are_listed_compared_and_restored() {
    for (target, unit, setting, changed) in [
        ("sim:mcp266", "mcp266-0x80-sim-mcp266", "motor1.velocity.qpps", "motor1.velocity.qpps=12000"),
        (
            "sim:motion-mind-3,mode=4",
            "motion-mind-3-0x01-sim-motion-mind-3-mode-4",
            "register.pterm",
            "register.pterm=77",
        ),
    ] {
        let work = kept();
        let backups = listed(&work, &["settings", "backups", "--json"], DONE);
        let of_this = |backup: &&Value| {
            backup["unit"] == unit
                && backup["name"].as_str().is_some_and(|name| name.contains("before-write"))
        };
        let oldest = backups.iter().find(of_this).unwrap_or_else(|| panic!("none of {unit} in {backups:?}"));
        let [name, profile] =
            ["name", "path"].map(|key| oldest[key].as_str().expect("it is text").to_owned());
        brushwork(&work, &["settings", "write", "--connect", target, "--yes", changed], DONE);
        // A controller within the program is a new one each time: what the backup holds are its factory values.
        let printed =
            brushwork(&work, &["settings", "compare", "--connect", target, "defaults", &profile], DONE);
        assert!(!printed.contains(setting), "{printed}");
        brushwork(&work, &["settings", "restore", "--connect", target, "--yes", &name], DONE);
    }
}

#[test]
#[cfg(unix)]
fn what_eeprom_held_last_and_what_was_cut_short_are_told() {
    let place = TempDir::new().expect("a temporary folder can be made");
    let port = place.path().join("port");
    let mut command = Command::new(env!("CARGO_BIN_EXE_brushwork-for-tests"));
    command.args(["sim", "--pty"]).arg(&port);
    let mut unit = Program::spawn(command);
    assert!(unit.next_line(LIMIT).is_some_and(|line| line.contains("port")));
    let work = kept_at(&port);
    let port = port.to_str().expect("it is text");
    let connect = ["--connect", port];
    let settings =
        |action: &[&str], code| brushwork(&work, &[&["settings"], action, &connect].concat(), code);
    let printed = settings(&["compare", "eeprom", "ram"], DIFFERENT);
    assert!(printed.contains("23456"), "{printed}");
    let printed = settings(&["unfinished"], DIFFERENT);
    assert!(printed.contains("A write of settings"), "{printed}");
    assert_eq!(listed(&work, &["settings", "backups", "--json"], DONE).len(), 4);
    settings(&["unfinished", "--forget"], DONE);
    settings(&["unfinished"], DONE);
}

#[test]
fn reports_are_replayed() {
    // Those of this version are, to the last bit.
    let of_this = folder().join("../reports/velocity.json");
    brushwork(&kept(), &["tune", "replay", of_this.to_str().expect("the folder's name is text")], DONE);
    // A tuner that asks the machine for other steps cannot go by the record of an earlier one. It is read whole, and that is said.
    for name in ["report mcp266.json", "report motion mind.json"] {
        let path = file(name);
        let mut command = Command::new(env!("CARGO_BIN_EXE_brushwork-for-tests"));
        command.args(["tune", "replay"]).arg(&path);
        let output = Child::output(&command, b"", LIMIT);
        let said = String::from_utf8_lossy(&output.stderr).into_owned();
        assert_eq!(output.status.code(), Some(FAILED), "{said}");
        assert!(said.contains("does not belong to this version of the tuner"), "{said}");
    }
}

#[test]
fn images_are_read_and_sent() {
    let work = kept();
    let [script, firmware] = ["script.mcli", "firmware.bin"]
        .map(|name| file(name).to_str().expect("the folder's name is text").to_owned());
    let listing = brushwork(&work, &["mcl", "disasm", &script], DONE);
    assert!(listing.lines().count() > 3, "{listing}");
    brushwork(&work, &["script", "download", &script], DONE);
    brushwork(&work, &["firmware", "update", &firmware, "--accept-risk", "--backup", "before.json"], DONE);
}

#[test]
fn recordings_are_read_to_the_last_value() {
    for name in ["recording.csv", "recording.bwr"] {
        let mut head: Option<Head> = None;
        let mut records = Vec::new();
        let take = |record| {
            records.push(record);
            true
        };
        let damage = open::read(&file(name), |found| head = Some(found.clone()), take).expect("it is whole");
        assert_eq!(damage, None);
        let head = head.expect("it has a head");
        let columns: Vec<(&str, &str)> =
            head.columns.iter().map(|column| (column.label.as_str(), column.unit.as_str())).collect();
        assert_eq!(columns, [("M1 Position", "counts"), ("M1 PWM", "%")], "{name}");
        // The table has no place for the controller's name.
        assert_eq!(head.device, if name.ends_with("csv") { "" } else { "MCP266 at 0x80" }, "{name}");
        let samples: Vec<f64> = records
            .iter()
            .filter_map(|record| match record {
                Record::Sample(readings) => Some(readings[1].value),
                Record::Gap { .. } | Record::Mark { .. } => None,
            })
            .collect();
        let expected: Vec<f64> = (0..20).map(|number| f64::from(number) * 0.25 - 1.5).collect();
        assert_eq!(samples, expected, "{name}");
        assert!(records.contains(&Record::Gap { at_us: 1_203_000 }), "{name}");
        let mark =
            Record::Mark { at_us: 702_000, kind: "drive".to_owned(), text: "M1 duty 30.0 %".to_owned() };
        assert!(records.contains(&mark), "{name}: {records:?}");
    }
}

#[test]
fn the_window_is_as_it_was_left() {
    brushwork::install();
    let work = TempDir::new().expect("a temporary folder can be made");
    let path = work.path().join("window.json");
    fs::copy(file("window.json"), &path).expect("the folder is the test's");
    let (memory, failure) = Memory::at(Some(path));
    assert!(failure.is_none(), "{failure:?}");
    let mut model = Model::default();
    memory.current.recall(&mut model);
    assert_eq!(model.screen.title(), "Velocity Settings");
    assert_eq!(model.devices.recent, ["sim:mcp266", "/dev/ttyACM0"]);
    assert_eq!(model.appearance.scale_percent, 125);
    assert_eq!(format!("{:?}", model.appearance.theme), "Light");
}

#[test]
fn unsaved_programs_are_offered_back() {
    let work = kept();
    let left = Journal::at(&work.path().join("data")).left();
    let [left] = &left[..] else { panic!("{left:?}") };
    let [program] = &left.programs[..] else { panic!("{left:?}") };
    assert_eq!((program.title.as_str(), program.text.as_str()), ("door.mcl", "x var word\r\nx = 1\nend\n"));
}
