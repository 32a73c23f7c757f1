//! Settings that cannot be lost, from the command line: backups, comparisons, copies, what was cut short.

use std::path::PathBuf;

use crate::cli::{
    DIFFERENT, DONE, NOT_TAKEN, REFUSED, Run, USAGE, edit, exported, name, program_keeping_in, run, settings,
};
use tempfile::TempDir;

/// A folder of its own for what the program keeps.
struct Kept(TempDir);

impl Kept {
    fn new() -> Self {
        Self(tempfile::tempdir().expect("a temporary folder can be made"))
    }

    fn settings(&self, arguments: &[&str]) -> Run {
        run(program_keeping_in(self.0.path()).arg("settings").args(arguments))
    }

    fn files(&self, folder: &str) -> Vec<PathBuf> {
        let mut found = Vec::new();
        let mut open = vec![self.0.path().join(folder)];
        while let Some(folder) = open.pop() {
            for entry in std::fs::read_dir(folder).into_iter().flatten().flatten() {
                if entry.path().is_dir() { open.push(entry.path()) } else { found.push(entry.path()) }
            }
        }
        found.sort();
        found
    }
}

#[test]
fn every_write_save_and_restore_leaves_a_backup_named_by_date_and_reason() {
    let kept = Kept::new();
    kept.settings(&["backups"]).ended_with(DONE).prints("There are no backups");
    kept.settings(&["write", "motor1.velocity.p=2.5", "--yes", "--save"]).ended_with(DONE);
    kept.settings(&["defaults", "--yes"]).ended_with(DONE);
    let listed = kept.settings(&["backups"]).ended_with(DONE);
    for reason in ["-before-write", "-before-save", "-before-defaults"] {
        assert!(listed.stdout.contains(reason), "{listed:#?}");
    }
    assert_eq!(kept.files("backups").len(), 3);
    assert_eq!(kept.files("journals").len(), 0, "what ended well leaves no journal");
    let json = kept.settings(&["backups", "--json"]).ended_with(DONE).json();
    assert_eq!(json.as_array().map(Vec::len), Some(3));
    // Reading and a dry run leave none.
    kept.settings(&["read"]).ended_with(DONE);
    kept.settings(&["write", "motor1.velocity.p=2.5", "--dry-run"]).ended_with(DONE);
    assert_eq!(kept.files("backups").len(), 3);
}

#[test]
fn nothing_is_written_when_no_backup_can_be_kept() {
    let folder = tempfile::tempdir().unwrap();
    let in_the_way = folder.path().join("file");
    std::fs::write(&in_the_way, "").unwrap();
    run(program_keeping_in(&in_the_way).args(["settings", "write", "motor1.velocity.p=2.5", "--yes"]))
        .ended_with(NOT_TAKEN)
        .explains("Nothing was written. Could not keep a backup before the write")
        .explains("BRUSHWORK_DATA_DIR");
}

#[test]
fn any_two_copies_can_be_compared() {
    let kept = Kept::new();
    let (folder, file) = exported("sim:mcp266");
    let other = folder.path().join("other.json");
    std::fs::copy(&file, &other).unwrap();
    edit(&other, "\"motor1.velocity.p\": { \"value\": 1.000", "\"motor1.velocity.p\": { \"value\": 3.000");
    let other = name(&other);
    kept.settings(&["compare", "ram", other])
        .ended_with(DIFFERENT)
        .prints("motor1.velocity.p 1.000 -> 3.000");
    kept.settings(&["compare", other, "default"]).ended_with(DIFFERENT).prints("3.000 -> 1.000");
    kept.settings(&["compare", "default", other]).ended_with(DIFFERENT).prints("1.000 -> 3.000");
    kept.settings(&["compare", name(&file), name(&file)]).ended_with(DONE).prints("agree");
    kept.settings(&["compare", "ram", "default"]).ended_with(DONE).prints("agree");
    kept.settings(&["compare", "ram", "eeprom"])
        .ended_with(REFUSED)
        .explains("known after a save or a reload that was proven");
    kept.settings(&["compare", "ram", "backup"]).ended_with(REFUSED).explains("no backup of this controller");
    kept.settings(&["write", "motor1.velocity.p=2.5", "--yes"]).ended_with(DONE);
    kept.settings(&["compare", "backup", other]).ended_with(DIFFERENT).prints("1.000 -> 3.000");
    let json = kept.settings(&["compare", "backup:2", other, "--json"]).ended_with(DIFFERENT).json();
    assert_eq!(json["differences"][0]["key"], "motor1.velocity.p");
    kept.settings(&["compare", "ram"]).ended_with(USAGE);
    // A file of another model is compared as it would be here.
    let (_folder, small) = exported("sim:mcp233");
    kept.settings(&["compare", "ram", name(&small)])
        .ended_with(DIFFERENT)
        .explains("compared as it would be on the controller of")
        .prints("limits.main_battery.max_volts 60.0 V -> 34.0 V");
}

#[test]
fn a_profile_of_an_older_firmware_differs_in_what_both_have_alone_and_says_how_the_motors_brake() {
    let (_folder, file) = exported("sim:mcp266,generation=1");
    edit(
        &file,
        "\"motor1.default_accel\": { \"value\": 1999.997",
        "\"motor1.default_accel\": { \"value\": 50",
    );
    let four = "sim:mcp266,generation=4";
    let run = settings(&["diff", name(&file), "-c", four]).ended_with(DIFFERENT);
    let run = run
        .explains("compared as it would be on the controller of")
        .explains("Motor 1: default duty deceleration becomes 50 %/s, since")
        .explains("They stay as they are:")
        .prints("motor1.default_accel 1999.997 %/s -> 50 %/s")
        .prints("motor1.default_decel 1999.997 %/s -> 50 %/s");
    assert!(run.stdout.starts_with("2 settings with different values"), "{run:#?}");
    // The file comes to the unit, on whichever side that stands.
    settings(&["compare", name(&file), "ram", "-c", four])
        .ended_with(DIFFERENT)
        .prints("motor1.default_decel 50 %/s -> 1999.997 %/s");
}

#[test]
fn one_motor_is_copied_to_the_other() {
    settings(&["copy-motor", "--yes"]).ended_with(DONE).prints("there is nothing to write");
    settings(&["copy-motor", "2", "--dry-run"]).ended_with(DONE);
    settings(&["copy-motor", "3", "--yes"]).ended_with(USAGE);
}

#[test]
fn a_full_disk_and_a_folder_that_cannot_be_written_are_sentences_and_the_old_file_stays() {
    let (folder, file) = exported("sim:mcp266");
    #[cfg(unix)]
    {
        let before = std::fs::read_to_string(&file).unwrap();
        // A limit of one block per file stands for a full disk: the write fails midway.
        let full = format!(
            "trap '' XFSZ; ulimit -f 8; exec '{}' settings export '{}' --force",
            env!("CARGO_BIN_EXE_brushwork"),
            name(&file)
        );
        let mut shell = std::process::Command::new("sh");
        shell.args(["-c", &full]).env("BRUSHWORK_DATA_DIR", folder.path().join("kept"));
        run(&shell)
            .ended_with(1)
            .explains("Writing the profile")
            .explains("A file of that name is unchanged.");
        assert_eq!(std::fs::read_to_string(&file).unwrap(), before);
    }
    let nowhere = folder.path().join("no such folder").join("profile.json");
    settings(&["export", name(&nowhere)]).ended_with(1).explains("Writing the profile");
    let left: Vec<_> =
        std::fs::read_dir(folder.path()).unwrap().flatten().map(|entry| entry.path()).collect();
    assert!(left.contains(&file), "{left:?}");
    assert!(left.iter().all(|path| path.extension().is_none_or(|extension| extension != "tmp")), "{left:?}");
}

#[cfg(unix)]
mod on_a_served_controller {
    use brushwork_child::Program;
    use std::path::Path;

    use super::*;
    use crate::cli::{LIMIT, Simulated};

    fn at(kept: &Kept, unit: &Simulated, action: &str, arguments: &[&str]) -> Run {
        kept.settings(&[&[action, "--connect", &unit.port()], arguments].concat())
    }

    #[test]
    fn a_backup_brings_back_what_was_there() {
        let (kept, unit) = (Kept::new(), Simulated::start(&[]));
        at(&kept, &unit, "write", &["motor1.velocity.p=2.5", "--yes"]).ended_with(DONE);
        at(&kept, &unit, "write", &["motor1.velocity.p=3.5", "--yes"]).ended_with(DONE);
        at(&kept, &unit, "restore", &[]).ended_with(REFUSED).prints("3.500 -> 2.500");
        at(&kept, &unit, "restore", &["--yes"]).ended_with(DONE).prints("3.500 -> 2.500");
        let oldest = kept.files("backups").remove(0);
        let oldest = oldest.file_stem().unwrap().to_str().unwrap();
        at(&kept, &unit, "restore", &[oldest, "--yes"]).ended_with(DONE).prints("2.500 -> 1.000");
        at(&kept, &unit, "restore", &["2999", "--yes"])
            .ended_with(REFUSED)
            .explains("There is no backup 2999");
    }

    #[test]
    fn loading_eeprom_brings_back_what_was_saved_and_leaves_a_backup_of_the_rest() {
        let (kept, unit) = (Kept::new(), Simulated::start(&[]));
        at(&kept, &unit, "write", &["motor1.velocity.p=2.5", "--yes"]).ended_with(DONE);
        at(&kept, &unit, "reload", &[])
            .ended_with(REFUSED)
            .explains("What was written and not saved is lost.");
        at(&kept, &unit, "reload", &["--yes"]).ended_with(DONE).prints("2.500 -> 1.000");
        at(&kept, &unit, "compare", &["ram", "eeprom"]).ended_with(DONE).prints("agree");
        at(&kept, &unit, "restore", &["--only", "motor2", "--yes"])
            .ended_with(DONE)
            .prints("nothing to write");
        at(&kept, &unit, "restore", &["--only", "motr1", "--yes"]).ended_with(NOT_TAKEN).explains("motr1");
        at(&kept, &unit, "restore", &["--only", "motor1", "--yes"]).ended_with(DONE).prints("1.000 -> 2.500");
    }

    #[test]
    fn eeprom_is_known_after_a_save_and_saves_are_counted() {
        let (kept, unit) = (Kept::new(), Simulated::start(&[]));
        at(&kept, &unit, "save", &["--yes"]).ended_with(DONE).prints("1 save to this EEPROM was counted");
        at(&kept, &unit, "write", &["motor2.velocity.p=2.5", "--yes"]).ended_with(DONE);
        at(&kept, &unit, "compare", &["eeprom", "ram"])
            .ended_with(DIFFERENT)
            .prints("motor2.velocity.p 1.000 -> 2.500");
        at(&kept, &unit, "save", &[])
            .ended_with(REFUSED)
            .prints("What would change in EEPROM, as known since");
        let json = at(&kept, &unit, "save", &["--yes", "--json"]).ended_with(DONE).json();
        assert_eq!(json["saves_counted"]["saves"], 2);
        at(&kept, &unit, "copy-motor", &["2", "--yes"])
            .ended_with(DONE)
            .prints("motor1.velocity.p 1.000 -> 2.500");
    }

    #[test]
    fn the_wear_of_an_eeprom_is_told_before_it_is_worn() {
        let (kept, unit) = (Kept::new(), Simulated::start(&[]));
        at(&kept, &unit, "save", &["--yes"]).ended_with(DONE);
        let [counted] = &kept.files("wear")[..] else { panic!("one unit is counted") };
        edit(counted, "\"saves\": 1", "\"saves\": 9999");
        at(&kept, &unit, "save", &["--yes"])
            .ended_with(DONE)
            .explains("9999 saves to this EEPROM were counted")
            .explains("half worn")
            .explains("tells no serial number");
        at(&kept, &unit, "save", &["--yes"]).ended_with(DONE).explains("may be worn out");
    }

    /// A program that is killed in the middle of a write leaves a controller with some of it.
    #[test]
    fn a_write_that_was_killed_is_told_setting_by_setting_and_can_be_finished_or_undone() {
        for (settle, p1, deadband) in [("--finish", "7.000", "7"), ("--undo", "1.000", "0")] {
            let (kept, unit) = a_killed_write();
            assert_eq!(journals(&kept).len(), 1);
            let reported = at(&kept, &unit, "read", &["motor1.velocity.p"]).ended_with(DONE);
            assert!(reported.stderr.contains("A write of settings begun"), "{reported:#?}");
            assert!(reported.stderr.contains("Motor 1: velocity P holds the"), "{reported:#?}");
            let reported = at(&kept, &unit, "unfinished", &["--json"]).ended_with(DIFFERENT).json();
            let aftermath = &reported[0]["aftermath"];
            let count = |list: &str| aftermath[list].as_array().map_or(0, Vec::len);
            assert_eq!(count("old") + count("new"), 18, "{aftermath:#}");
            if count(if settle == "--undo" { "new" } else { "old" }) > 0 {
                at(&kept, &unit, "unfinished", &[settle]).ended_with(REFUSED).explains("--yes");
            }
            at(&kept, &unit, "unfinished", &[settle, "--yes"]).ended_with(DONE);
            let reported = at(&kept, &unit, "unfinished", &[]).ended_with(DONE);
            assert!(reported.stdout.contains("Nothing that was begun"), "{reported:#?}");
            at(&kept, &unit, "read", &["motor1.velocity.p"]).ended_with(DONE).prints(p1);
            at(&kept, &unit, "read", &["pin.9.deadband"]).ended_with(DONE).prints(deadband);
            assert_eq!(journals(&kept).len(), 0);
        }
    }

    #[test]
    fn what_was_cut_short_can_be_left_as_it_is() {
        let (kept, unit) = a_killed_write();
        at(&kept, &unit, "unfinished", &["--forget"]).ended_with(DONE).prints("A write of settings");
        let reported = at(&kept, &unit, "read", &["motor1.velocity.p"]).ended_with(DONE);
        assert!(!reported.stderr.contains("cut short"), "{reported:#?}");
    }

    /// A controller in the middle of a write whose program was killed once its journal was there and some may be sent.
    fn a_killed_write() -> (Kept, Simulated) {
        /// How often a busy machine may bring the signal too late.
        const TRIES: usize = 20;
        let killed = (0..TRIES).find_map(|_| {
            let (kept, unit) = (Kept::new(), Simulated::start(&["--fault", "delay=10ms"]));
            kill_a_write(&kept, &unit);
            (!journals(&kept).is_empty()).then_some((kept, unit))
        });
        killed.expect("a write is killed before its end")
    }

    fn journals(kept: &Kept) -> Vec<PathBuf> {
        let mut found = kept.files("journals");
        found.retain(|path| path.extension().is_some_and(|name| name == "json"));
        found
    }

    fn kill_a_write(kept: &Kept, unit: &Simulated) {
        let mut changes: Vec<String> = ["velocity.p", "velocity.i", "position.p", "position.i"]
            .iter()
            .flat_map(|key| [format!("motor1.{key}=7"), format!("motor2.{key}=7")])
            .collect();
        changes.extend((1..=10).map(|pin| format!("pin.{pin}.deadband=7")));
        let mut command = program_keeping_in(kept.0.path());
        command.args(["settings", "write", "--yes", "--connect", &unit.port()]).args(&changes);
        let mut program = Program::spawn(command);
        assert!(program.next_line(LIMIT).is_some_and(|line| line.contains("->")));
        let begun = || !journals(kept).is_empty() || !program.is_running();
        crate::wait::until("a journal", begun, || format!("{:?}", kept.files("")));
        // Some of it is sent. A write that has ended by now is tried again.
        std::thread::sleep(std::time::Duration::from_millis(300));
        drop(program);
    }

    #[test]
    fn a_folder_without_the_right_to_write_keeps_its_file() {
        let folder = tempfile::tempdir().unwrap();
        if !Path::new("/proc/self").exists() {
            return;
        }
        // Nobody, the administrator included, may make files there.
        let refused = settings(&["export", "/proc/profile.json"]).ended_with(1);
        assert!(refused.stderr.contains("Writing the profile /proc/profile.json failed"), "{refused:#?}");
        drop(folder);
    }
}
