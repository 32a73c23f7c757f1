//! Every command of the command line that changes settings keeps a backup of them first, and changes nothing where it cannot.
#![cfg(unix)]

use std::path::Path;
use std::process::Command;

use crate::cli::{DONE, LIMIT, exported, name, program_keeping_in, run};
use brushwork_child::{Program, ahead};
use brushwork_core::keep::{Store, UnitId};
use brushwork_link::settings::{Act, Journal, Profile, SettingValue};
use brushwork_mcp_sim::controller::{Bus, Controller, ControllerConfig};
use brushwork_mcp_sim::settings::Settings;
use brushwork_mcp_wire::models;
use brushwork_plant::machine::StreamIndex;
use brushwork_plant::server::{Endpoint, Server, ServerOptions, SimHandle};
use tempfile::TempDir;

/// A controller on a TCP port whose settings are not those of the factory, and a folder for what is kept of it.
struct Bench {
    unit: SimHandle<Bus>,
    folder: TempDir,
}

/// What motor 1's velocity P is before each command, and what its default is.
const P_BEFORE: f64 = 2.5;

impl Bench {
    fn new(model: &str) -> Self {
        let folder = tempfile::tempdir().expect("a temporary folder can be made");
        let mut config = ControllerConfig::of(models::lookup(model).expect("it is listed"));
        let mut settings = Settings::factory(config.model, config.address.get());
        settings.motors[0].motion.velocity_p_raw = (P_BEFORE * 65536.0) as u32;
        config.settings = Some(settings);
        let unit = Controller::new(config).expect("the preset is valid");
        let endpoint = Endpoint::Tcp("127.0.0.1:0".parse().expect("it is an address"));
        let bus = Bus::single(unit, StreamIndex::Usb);
        let unit = ahead(|| Server::spawn(bus, ServerOptions::default(), &endpoint))
            .expect("loopback has a free port");
        Self { unit, folder }
    }

    fn kept(&self) -> std::path::PathBuf {
        self.folder.path().join("kept")
    }

    /// The program with these arguments, where PORT and FOLDER stand for this bench's own.
    fn command(&self, keeping_in: &Path, arguments: &[&str]) -> Command {
        let folder = name(self.folder.path()).to_owned();
        let port = format!("tcp:{}", self.unit.address().trim_start_matches("tcp:"));
        let own = |argument: &&str| argument.replace("PORT", &port).replace("FOLDER", &folder);
        let mut command = program_keeping_in(keeping_in);
        command.args(arguments.iter().map(own));
        command
    }

    fn settings(&self) -> Settings {
        self.unit.inspect(|bus| bus.controllers()[0].settings()).expect("it runs")
    }

    /// The backups of `kept`, oldest first.
    fn backups(&self) -> Vec<Profile> {
        brushwork::install();
        let mut open = vec![self.kept().join("backups")];
        let mut files = Vec::new();
        while let Some(folder) = open.pop() {
            for path in std::fs::read_dir(folder).into_iter().flatten().flatten().map(|entry| entry.path()) {
                if path.is_dir() { open.push(path) } else { files.push(path) }
            }
        }
        files.retain(|path| path.extension().is_some_and(|extension| extension == "json"));
        files.sort();
        files.iter().map(|path| Profile::load(path).expect("a backup is a profile")).collect()
    }

    /// What has to be there before a command makes sense: a profile, an image.
    fn prepare(&self, model: &str) {
        let (_made, profile) = exported(&format!("sim:{model}"));
        std::fs::copy(profile, self.folder.path().join("profile.json")).expect("the folder is ours");
        let image = self.folder.path().join("new.bin");
        run(program_keeping_in(&self.kept()).args(["firmware", "image", name(&image), "--model", model]))
            .ended_with(DONE);
    }
}

/// Each command that writes settings, or lets them be forgotten.
const COMMANDS: [&[&str]; 9] = [
    &["settings", "write", "motor1.velocity.p=7", "--yes", "-c", "PORT"],
    &["settings", "write", "motor1.velocity.p=7", "--yes", "--save", "-c", "PORT"],
    &["settings", "write", "--profile", "FOLDER/profile.json", "--yes", "-c", "PORT"],
    &["settings", "import", "FOLDER/profile.json", "--yes", "-c", "PORT"],
    &["settings", "copy-motor", "2", "--yes", "-c", "PORT"],
    &["settings", "save", "--yes", "-c", "PORT"],
    &["settings", "defaults", "--yes", "-c", "PORT"],
    &["settings", "reload", "--yes", "-c", "PORT"],
    &["script", "autorun", "500", "--to", "PORT"],
];

fn p_of(profile: &Profile) -> Option<SettingValue> {
    profile.settings.get("motor1.velocity.p")
}

#[test]
fn every_command_that_changes_settings_leaves_a_backup_of_what_was_there() {
    for arguments in COMMANDS {
        let bench = Bench::new("mcp266");
        bench.prepare("mcp266");
        run(&bench.command(&bench.kept(), arguments)).ended_with(DONE);
        let backups = bench.backups();
        let first = backups.first().unwrap_or_else(|| panic!("{arguments:?} left no backup"));
        assert_eq!(p_of(first), Some(SettingValue::Number(P_BEFORE)), "{arguments:?}");
        assert!(first.note.starts_with("before "), "{arguments:?}: {}", first.note);
    }
}

#[test]
fn no_command_changes_anything_where_no_backup_can_be_kept() {
    for arguments in COMMANDS {
        let bench = Bench::new("mcp266");
        bench.prepare("mcp266");
        let in_the_way = bench.folder.path().join("file");
        std::fs::write(&in_the_way, "").expect("the folder is ours");
        let (before, saved) =
            (bench.settings(), bench.unit.inspect(|bus| format!("{:?}", bus.controllers()[0].eeprom())).ok());
        let refused = run(&bench.command(&in_the_way, arguments));
        assert_ne!(refused.code, DONE, "{arguments:?}: {refused:?}");
        assert!(refused.stderr.contains("backup"), "{arguments:?}: {refused:?}");
        assert_eq!(bench.settings(), before, "{arguments:?}");
        assert_eq!(
            bench.unit.inspect(|bus| format!("{:?}", bus.controllers()[0].eeprom())).ok(),
            saved,
            "{arguments:?}"
        );
    }
}

#[test]
fn a_restored_backup_a_finished_write_and_an_update_of_the_firmware_leave_one_too() {
    let bench = Bench::new("mcp266");
    run(&bench.command(&bench.kept(), COMMANDS[0])).ended_with(DONE);
    run(&bench.command(&bench.kept(), &["settings", "restore", "--yes", "-c", "PORT"])).ended_with(DONE);
    let backups = bench.backups();
    assert_eq!(backups.len(), 2);
    assert_eq!(p_of(&backups[1]), Some(SettingValue::Number(7.0)), "of what the restore wrote over");

    let bench = Bench::new("roboclaw-2x7a");
    bench.prepare("roboclaw-2x7a");
    let update = ["firmware", "update", "FOLDER/new.bin", "--simulated", "--accept-risk", "-c", "PORT"];
    run(&bench.command(&bench.kept(), &update)).ended_with(DONE);
    assert_eq!(bench.backups().iter().map(p_of).collect::<Vec<_>>(), [Some(SettingValue::Number(P_BEFORE))]);
}

#[test]
fn tuning_keeps_a_backup_before_it_moves_anything() {
    let bench = Bench::new("mcp266");
    let command = bench.command(&bench.kept(), &["tune", "velocity", "--apply", "-c", "PORT,stream=usb"]);
    let program = Program::spawn(command);
    crate::wait::until("a backup", || !bench.backups().is_empty(), || "none".to_owned());
    assert_eq!(p_of(&bench.backups()[0]), Some(SettingValue::Number(P_BEFORE)));
    program.signal("INT");
    program.finish(LIMIT);
}

#[test]
fn what_only_reads_leaves_none() {
    let bench = Bench::new("mcp266");
    for arguments in [
        &["settings", "read", "-c", "PORT"][..],
        &["settings", "write", "motor1.velocity.p=7", "--dry-run", "-c", "PORT"],
        &["settings", "export", "FOLDER/read.json", "-c", "PORT"],
        &["script", "status", "--to", "PORT"],
        &["script", "autorun", "--to", "PORT"],
        &["status", "-c", "PORT"],
        &["firmware", "info", "-c", "PORT"],
    ] {
        run(&bench.command(&bench.kept(), arguments)).ended_with(DONE);
        assert!(bench.backups().is_empty(), "{arguments:?}");
    }
}

/// What is kept of the bench's unit, after one write that went well.
fn kept_of(bench: &Bench) -> (Store, UnitId, Profile) {
    run(&bench.command(&bench.kept(), &["settings", "write", "motor1.velocity.p=7", "--yes", "-c", "PORT"]))
        .ended_with(DONE);
    let backup = bench.backups().pop().expect("there is one");
    let unit = UnitId {
        model: backup.subject.model.key.to_owned(),
        place: backup.unit.clone(),
        has_serial_number: false,
        address: backup.address.get(),
        is_simulated: false,
    };
    (Store::at(bench.kept()), unit, backup)
}

/// Commands that open the unit, whatever they are for.
const OPENING: [&[&str]; 5] = [
    &["status", "-c", "PORT"],
    &["drive", "--duty", "0", "--for", "0.1", "-c", "PORT"],
    &["settings", "read", "-c", "PORT"],
    &["settings", "unfinished", "-c", "PORT"],
    &["firmware", "info", "-c", "PORT"],
];

#[test]
fn after_a_cut_write_every_command_that_opens_the_unit_says_so() {
    let bench = Bench::new("mcp266");
    let (store, unit, before) = kept_of(&bench);
    let journal = Journal { act: Act::Write, wanted: before.clone(), before };
    let path = store.open_journal(&unit, &journal).expect("the folder is ours");
    for arguments in OPENING {
        let ran = run(&bench.command(&bench.kept(), arguments));
        let told = ran.stderr.contains("did not end") || ran.stderr.contains("was cut short");
        assert!(told || ran.stdout.contains("was cut short"), "{arguments:?}: {ran:#?}");
    }
    let mut tuning = Program::spawn(bench.command(&bench.kept(), &["tune", "velocity", "-c", "PORT"]));
    tuning.wait_for_error("did not end", LIMIT);
    drop(tuning);
    // A damaged journal is as much worth a word.
    std::fs::write(&path, "{").expect("the folder is ours");
    for arguments in OPENING {
        let ran = run(&bench.command(&bench.kept(), arguments));
        assert!(
            ran.stderr.contains("is damaged") && ran.stderr.contains("may have been cut short"),
            "{arguments:?}: {ran:#?}"
        );
        assert!(!ran.stdout.contains("Nothing that was begun"), "{arguments:?}: {ran:#?}");
    }
    run(&bench.command(&bench.kept(), &["settings", "unfinished", "--forget", "-c", "PORT"]))
        .ended_with(DONE);
    let settled =
        run(&bench.command(&bench.kept(), &["settings", "unfinished", "-c", "PORT"])).ended_with(DONE);
    assert!(settled.stdout.contains("Nothing that was begun"), "{settled:#?}");
}

#[test]
fn a_damaged_count_of_saves_is_named_and_the_next_save_says_that_it_was_lost() {
    let bench = Bench::new("mcp266");
    let (store, unit, _) = kept_of(&bench);
    store.count_saves(&unit, 6_000, "2026-01-05").expect("the folder is ours");
    let file =
        std::fs::read_dir(bench.kept().join("wear")).unwrap().flatten().next().expect("it is there").path();
    std::fs::write(&file, "\0\0").expect("the folder is ours");
    let saved =
        run(&bench.command(&bench.kept(), &["settings", "save", "--yes", "-c", "PORT"])).ended_with(DONE);
    assert!(saved.stderr.contains("is damaged") && saved.stderr.contains("is not known"), "{saved:#?}");
    assert!(saved.stdout.contains("What was counted before is lost"), "{saved:#?}");
    let again =
        run(&bench.command(&bench.kept(), &["settings", "save", "--yes", "-c", "PORT"])).ended_with(DONE);
    assert!(again.stdout.contains("2 saves") && again.stdout.contains("before is lost"), "{again:#?}");
}
