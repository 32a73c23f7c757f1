//! `brushwork firmware` as a person or a script runs it, against a simulated controller on a pseudo-terminal.
#![cfg(unix)]

use std::path::{Path, PathBuf};
use std::process::Command;

use crate::cli::{Run, program, run};
use brushwork_child::{Program, ahead};
use brushwork_link::settings::Profile;
use brushwork_mcp_sim::controller::{Bus, Controller, ControllerConfig, Flash};
use brushwork_mcp_wire::models;
use brushwork_plant::machine::StreamIndex;
use brushwork_plant::server::{Endpoint, Server, ServerOptions, SimHandle};
use brushwork_plant::world::WorldAction;
use tempfile::TempDir;

fn command(arguments: &[&str]) -> Command {
    let mut command = program();
    command.arg("firmware").args(arguments);
    command
}

fn firmware(arguments: &[&str]) -> Run {
    run(&command(arguments))
}

/// A RoboClaw on a pseudo-terminal, and an image for it.
struct Unit {
    server: SimHandle<Bus>,
    folder: TempDir,
}

impl Unit {
    fn start() -> Self {
        let folder = tempfile::tempdir().expect("a temporary folder can be made");
        let model = models::lookup("roboclaw-2x7a").expect("it is listed");
        let unit = Controller::new(ControllerConfig::of(model)).expect("the preset is valid");
        let endpoint = Endpoint::Pty { link: folder.path().join("port") };
        let bus = Bus::single(unit, StreamIndex::Usb);
        let server = ahead(|| Server::spawn(bus, ServerOptions::default(), &endpoint))
            .expect("there are pseudo-terminals");
        let this = Self { server, folder };
        let made = firmware(&["image", &this.image(), "--model", "roboclaw-2x7a", "--version", "9.8.7"]);
        assert_eq!(made.code, 0, "{made:?}");
        this
    }

    fn path(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    fn port(&self) -> String {
        self.path("port").display().to_string()
    }

    fn image(&self) -> String {
        self.path("new.bin").display().to_string()
    }

    fn flash(&self) -> Flash {
        self.server.inspect(|bus| bus.controllers()[0].flash().clone()).expect("it runs")
    }

    /// Switches it off and on; it is at the other end of the line again when this returns.
    fn power_cycle(&self) {
        for on in [false, true] {
            self.server.apply(0, WorldAction::Power { on }).expect("it runs");
            self.until(if on { "power" } else { "no power" }, move |unit| unit.unit().is_some() == on);
        }
        crate::wait::until("the port", || self.path("port").exists(), || "it is not there".to_owned());
    }

    fn until(&self, what: &str, holds: impl Fn(&Controller) -> bool + Copy + Send + 'static) {
        let look = || self.server.inspect(move |bus| holds(&bus.controllers()[0])).expect("it runs");
        crate::wait::until(what, look, || format!("{:?}", self.flash()));
    }
}

fn holds(path: &Path) -> Flash {
    Flash::Image(std::fs::read(path).expect("the image is there"))
}

#[test]
fn info_tells_what_is_installed_and_what_is_known_about_it() {
    let run = firmware(&["info", "--connect", "sim:mcp266"]);
    assert_eq!(run.code, 0, "{run:?}");
    for words in ["MCP266 2x60A v1.0.0", "Generation:  1", "983040 bytes", "no image is published", "16 bits"]
    {
        assert!(run.stdout.contains(words), "{words}: {run:?}");
    }
    let run = firmware(&["info", "--json", "--connect", "sim:mcp266,generation=4"]);
    let json: serde_json::Value = serde_json::from_str(&run.stdout).unwrap();
    assert_eq!(json["image_bytes"][0], 983_040);
    assert!(json["known"].as_array().unwrap().iter().any(|row| row["topic"] == "restart"));
}

#[test]
fn an_update_needs_the_risk_accepted_and_backs_the_settings_up_first() {
    let unit = Unit::start();
    let (image, port) = (unit.image(), unit.port());
    let unasked = firmware(&["update", &image, "--connect", &port, "--simulated"]);
    assert_eq!(unasked.code, 4, "{unasked:?}");
    assert!(
        unasked.stderr.contains("dead for good") && unasked.stderr.contains("--accept-risk"),
        "{unasked:?}"
    );
    assert_eq!(unit.flash(), Flash::Factory);

    let backup = unit.path("backup.json");
    let backup_name = backup.display().to_string();
    let arguments =
        ["update", &image, "--connect", &port, "--simulated", "--accept-risk", "--backup", &backup_name];
    let run = firmware(&arguments);
    assert_eq!(run.code, 0, "{run:?}");
    assert!(run.stdout.contains("128 pages were sent and confirmed"), "{run:?}");
    let updated = "The firmware is updated: USB Roboclaw 2x7a v4.2.8 before, USB Roboclaw 2x7a v9.8.7 now.";
    assert!(run.stdout.contains(updated), "{run:?}");
    assert!(run.stdout.contains("The settings are as they are in the backup."), "{run:?}");
    assert!(unit.flash() == holds(&unit.path("new.bin")));
    brushwork::install();
    assert!(Profile::load(&backup).unwrap().firmware.contains("v4.2.8"), "the backup is of the old firmware");
    unit.until("a restart", |unit| unit.unit().is_some_and(|unit| !unit.is_in_loader()));
    let info = firmware(&["info", "--connect", &port]);
    assert!(info.stdout.contains("v9.8.7"), "{info:?}");
}

#[test]
fn an_image_for_simulated_controllers_is_not_sent_to_what_could_be_a_real_one() {
    let unit = Unit::start();
    let run = firmware(&["update", &unit.image(), "--connect", &unit.port(), "--accept-risk"]);
    assert_eq!(run.code, 4, "{run:?}");
    assert!(run.stderr.contains("would leave a real one without firmware"), "{run:?}");
    assert_eq!(unit.flash(), Flash::Factory);
}

#[test]
fn a_file_of_another_size_is_not_sent() {
    let unit = Unit::start();
    let file = unit.path("short.bin");
    std::fs::write(&file, [1, 2, 3]).unwrap();
    let name = file.display().to_string();
    let run = firmware(&["update", &name, "--connect", &unit.port(), "--accept-risk"]);
    assert_eq!(run.code, 4, "{run:?}");
    assert!(run.stderr.contains("32768 or 65536 bytes"), "{run:?}");
}

#[test]
fn an_update_that_is_killed_is_resumed_after_a_power_cycle() {
    let unit = Unit::start();
    let (image, port) = (unit.image(), unit.port());
    let backup = unit.path("backup.json").display().to_string();
    let update =
        command(&["update", &image, "--connect", &port, "--simulated", "--accept-risk", "--backup", &backup]);
    let updating = Program::spawn(update);
    unit.until("a first page", |unit| matches!(unit.flash(), Flash::Filling(_)));
    drop(updating);
    assert!(matches!(unit.flash(), Flash::Filling(_)), "it was killed before its end");
    unit.power_cycle();
    let commands: [&[&str]; 6] = [
        &["firmware", "info"],
        &["status"],
        &["drive", "--duty", "10", "--for", "1"],
        &["settings", "read"],
        &["stop"],
        &["script", "status"],
    ];
    for words in commands {
        let mut lost = program();
        let lost = run(lost.args(words).args(["--connect", &port]));
        assert_eq!(lost.code, 3, "in its loader it answers no packet: {lost:?}");
        let told = format!("resume the update: brushwork firmware update {image} --connect {port} --resume");
        assert!(
            lost.stderr.contains(&told) && lost.stderr.contains("--model roboclaw-2x7a"),
            "{words:?}: {lost:?}"
        );
    }
    // No byte of them was a greeting to the loader, at which it erases: it still waits for one.
    let resume = [
        "update",
        &image,
        "--connect",
        &port,
        "--simulated",
        "--accept-risk",
        "--resume",
        "--model",
        "roboclaw-2x7a",
    ];
    let run = firmware(&resume);
    assert_eq!(run.code, 0, "{run:?}");
    assert!(run.stderr.contains("after the controller was switched off and on"), "{run:?}");
    assert!(
        run.stdout.contains("v4.2.8 before, USB Roboclaw 2x7a v9.8.7 now."),
        "what ran before is remembered: {run:?}"
    );
    assert!(run.stdout.contains("The settings are as they are in the backup."), "{run:?}");
    assert!(unit.flash() == holds(&unit.path("new.bin")));
}

#[test]
fn bytes_that_are_no_firmware_are_sent_and_not_called_an_update() {
    let unit = Unit::start();
    let file = unit.path("noise.bin");
    let noise: Vec<u8> = (0..0x8000_u32).map(|at| (at.wrapping_mul(2_654_435_761) >> 24) as u8).collect();
    std::fs::write(&file, noise).unwrap();
    let run = firmware(&["update", &file.display().to_string(), "--connect", &unit.port(), "--accept-risk"]);
    assert_eq!(run.code, 5, "{run:?}");
    let unchanged = "The version did not change: the controller still calls itself USB Roboclaw 2x7a v4.2.8.";
    assert!(run.stdout.contains(unchanged), "{run:?}");
}

#[test]
fn settings_that_differ_after_an_update_are_listed_and_written_back_when_that_is_wanted() {
    for restore in [false, true] {
        let unit = Unit::start();
        let (image, port) = (unit.image(), unit.port());
        // In RAM alone: the restart forgets it.
        let written =
            run(program().args(["settings", "write", "-c", &port, "motor1.velocity.qpps=12345", "--yes"]));
        assert_eq!(written.code, 0, "{written:?}");
        let mut update = vec!["update", &image, "--connect", &port, "--simulated", "--accept-risk"];
        update.extend(restore.then_some("--restore"));
        let run = firmware(&update);
        assert_eq!(run.code, if restore { 0 } else { 6 }, "{run:?}");
        assert!(run.stdout.contains("12345 counts/s in the backup, 44000 counts/s now"), "{run:?}");
        assert_eq!(run.stdout.contains("brushwork settings restore"), !restore, "{run:?}");
        let qpps = unit.server.inspect(|bus| bus.controllers()[0].stored_settings().motors[0].motion.qpps);
        assert_eq!(qpps.unwrap(), if restore { 12_345 } else { 44_000 });
    }
}
