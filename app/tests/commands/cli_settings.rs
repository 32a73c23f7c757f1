//! `brushwork settings` as a person or a script runs it: the built program, its output and its exit codes.

use crate::cli::{DIFFERENT, DONE, NOT_TAKEN, REFUSED, USAGE, edit, exported, name, settings};
use serde_json::Value;

#[test]
fn read_shows_values_with_their_units() {
    settings(&["read", "motor1.velocity"])
        .ended_with(DONE)
        .prints("motor1.velocity.qpps    44000 counts/s    default 44000 counts/s");
}

#[test]
fn read_gives_json_for_programs() {
    let json = settings(&["read", "--json", "motor2.velocity.p"]).ended_with(DONE).json();
    assert_eq!(json["identity"]["model"], "MCP266");
    assert_eq!(json["settings"].as_array().map(Vec::len), Some(1));
    assert_eq!(json["settings"][0]["value"], 1.0);
    assert_eq!(json["failures"], Value::Array(Vec::new()));
}

#[test]
fn every_setting_can_be_read_in_every_generation() {
    for generation in 1..=4 {
        let target = format!("sim:mcp266,generation={generation}");
        let json = settings(&["read", "--json", "-c", &target]).ended_with(DONE).json();
        let rows = json["settings"].as_array().expect("a list of settings");
        assert!(rows.len() > 200, "{} settings in generation {generation}", rows.len());
        let unknown: Vec<&Value> = rows.iter().filter(|row| row["value"].is_null()).collect();
        assert!(unknown.is_empty(), "without a value in generation {generation}: {unknown:#?}");
    }
}

#[test]
fn read_of_a_key_that_does_not_exist_is_told() {
    settings(&["read", "motr1"]).ended_with(NOT_TAKEN).explains("has no setting motr1");
}

#[test]
fn a_value_is_shown_old_and_new_written_and_read_back() {
    settings(&["write", "motor1.velocity.p=2.5", "--yes"])
        .ended_with(DONE)
        .prints("motor1.velocity.p  1.000 -> 2.500")
        .prints("1 setting written and read back.");
}

#[test]
fn nothing_is_written_while_nobody_can_agree() {
    settings(&["write", "motor1.velocity.p=2.5"])
        .ended_with(REFUSED)
        .prints("1.000 -> 2.500")
        .explains("give --yes to do it. Nothing was written.");
    settings(&["save"]).ended_with(REFUSED).explains("--yes");
    settings(&["defaults"]).ended_with(REFUSED).explains("--yes");
}

#[test]
fn a_value_out_of_range_is_told_with_its_range_and_nothing_is_written() {
    settings(&["write", "limits.main_battery.max_volts=99", "motor1.velocity.p=2.5", "--yes"])
        .ended_with(NOT_TAKEN)
        .explains("Nothing was written:")
        .explains("Main battery maximum 99.0 V is above the MCP266's 60.0 V.");
    settings(&["write", "motor1.velocity.p=fast", "--yes"])
        .ended_with(NOT_TAKEN)
        .explains("'fast' is not a number");
}

#[test]
fn an_unknown_key_is_answered_with_the_one_that_was_meant() {
    settings(&["write", "motor1.velocty.p=2", "--yes"])
        .ended_with(NOT_TAKEN)
        .explains("has no setting motor1.velocty.p. Did you mean motor1.velocity.p?");
    settings(&["write", "motor1.velocity.p", "--yes"]).ended_with(USAGE).explains("KEY=VALUE");
}

#[test]
fn a_dry_run_shows_the_command_and_its_bytes() {
    // 80: address. 1C: 28, M1 velocity PID. D 0.25 = 00004000, P 2.5 = 00028000, I 0.5 = 00008000 (each times
    // 65536), QPPS 12000 = 00002EE0. 5E59: CRC-16/XMODEM of all before it.
    settings(&["write", "motor1.velocity.p=2.5", "motor1.velocity.qpps=12000", "--dry-run"])
        .ended_with(DONE)
        .prints("0x80 M1 velocity PID: P 2.5, I 0.5, D 0.25, QPPS 12000")
        .prints("80 1C 00 00 40 00 00 02 80 00 00 00 80 00 00 00 2E E0 5E 59");
    let json = settings(&["write", "motor1.velocity.p=2.5", "--dry-run", "--json"]).ended_with(DONE).json();
    assert_eq!(json["dry_run"], true);
    assert_eq!(json["changes"][0]["after"], 2.5);
    assert_eq!(json["commands"][0]["keys"][0], "motor1.velocity.p");
    assert!(json["write"].is_null());
}

#[test]
fn a_write_tells_programs_what_became_of_it() {
    let run = settings(&["write", "motor1.velocity.p=2.5", "--yes", "--json", "--save"]).ended_with(DONE);
    let json = run.json();
    assert_eq!(json["write"]["rows"][0]["state"], "taken");
    assert_eq!(json["write"]["rows"][0]["found"], 2.5);
    assert_eq!(json["save"]["verdict"], "verified");
}

#[test]
fn what_no_command_carries_is_set_in_the_simulated_controller() {
    settings(&["write", "unit.bridge_channels=yes", "--yes"])
        .ended_with(DONE)
        .prints("unit.bridge_channels  no -> yes")
        .prints("1 setting written and read back.");
}

#[test]
fn values_that_contradict_each_other_are_refused() {
    settings(&["write", "motor1.position.min=100", "motor1.position.max=-100", "--yes"])
        .ended_with(NOT_TAKEN)
        .explains("Nothing was written:")
        .explains("minimum position 100 counts would be above");
}

#[test]
fn defaults_are_restored_and_proven() {
    settings(&["defaults", "--yes"]).ended_with(DONE).prints("The factory defaults are restored in RAM");
}

#[test]
fn the_reference_needs_no_controller() {
    settings(&["reference"]).ended_with(DONE).prints("motor{n}.velocity.p");
    let json = settings(&["reference", "--json"]).ended_with(DONE).json();
    assert!(json.as_array().is_some_and(|rows| rows.len() > 50));
}

#[test]
fn a_profile_agrees_with_what_it_was_exported_from() {
    let (_folder, file) = exported("sim:mcp266");
    settings(&["diff", name(&file)]).ended_with(DONE).prints("agree");
    settings(&["import", name(&file), "--yes"]).ended_with(DONE).prints("there is nothing to write");
}

#[test]
fn a_difference_is_shown_and_has_its_own_exit_code() {
    let (folder, file) = exported("sim:mcp266");
    let other = folder.path().join("other.json");
    std::fs::copy(&file, &other).unwrap();
    edit(&other, "\"motor1.velocity.p\": { \"value\": 1.000", "\"motor1.velocity.p\": { \"value\": 3.000");
    for arguments in [vec!["diff", name(&other)], vec!["diff", name(&file), name(&other)]] {
        settings(&arguments)
            .ended_with(DIFFERENT)
            .prints("1 setting with different values")
            .prints("motor1.velocity.p  1.000 -> 3.000");
    }
    let json = settings(&["diff", "--json", name(&other)]).ended_with(DIFFERENT).json();
    assert_eq!(json["differences"][0]["key"], "motor1.velocity.p");
    settings(&["import", name(&other), "--yes"]).ended_with(DONE).prints("1 setting written and read back.");
}

#[test]
fn an_export_replaces_the_whole_file_or_nothing() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("profile.json");
    std::fs::write(&file, "x".repeat(1_000_000)).unwrap();
    settings(&["export", name(&file), "--force"]).ended_with(DONE);
    settings(&["diff", name(&file)]).ended_with(DONE);
    // A folder of that name cannot be replaced by a file.
    let in_the_way = folder.path().join("folder.json");
    std::fs::create_dir(&in_the_way).unwrap();
    settings(&["export", name(&in_the_way), "--force"]).ended_with(1).explains("is a folder");
    assert!(in_the_way.is_dir());
    let left = std::fs::read_dir(folder.path()).unwrap().count();
    assert_eq!(left, 2, "nothing but the profile and the folder is left behind");
}

#[test]
fn a_faulty_profile_is_refused_with_the_place_of_the_fault() {
    let faults = [
        ("{\n", "{{\n", "line 1, column 2"),
        ("\"schema\": 3", "\"schema\": 99", "schema (line"),
        ("motor1.velocity.p", "motor1.velocity.pp", "settings.motor1.velocity.pp (line"),
        (
            "\"motor1.velocity.p\": { \"value\": 1.000",
            "\"motor1.velocity.p\": { \"value\": \"x\"",
            "settings.motor1.velocity.p",
        ),
        (
            "\"limits.main_battery.max_volts\": { \"value\": 60.0",
            "\"limits.main_battery.max_volts\": { \"value\": \"600\"",
            "settings.limits.main_battery.max_volts",
        ),
    ];
    for (from, to, place) in faults {
        let (_folder, file) = exported("sim:mcp266");
        edit(&file, from, to);
        for arguments in [vec!["import", "--yes"], vec!["write", "--yes", "--profile"], vec!["diff"]] {
            let run = settings(&[&arguments[..], &[name(&file)]].concat());
            run.ended_with(NOT_TAKEN).explains("was not taken, nothing was changed").explains(place);
        }
    }
}

#[test]
fn a_profile_for_another_controller_is_upgraded_only_when_that_is_agreed_to() {
    let (_folder, file) = exported("sim:mcp266");
    settings(&["import", name(&file), "-c", "sim:mcp263"])
        .ended_with(REFUSED)
        .explains(
            "The profile was made for the MCP266 (2x60A), the connected controller is the MCP263 (2x60A).",
        )
        .explains("Main battery maximum 60.0 V is above the MCP263's 34.0 V. 34.0 V is used instead.")
        .explains("Use the profile with these changes? There is no terminal to ask at");
    settings(&["import", name(&file), "--yes", "-c", "sim:mcp263"])
        .ended_with(DONE)
        .explains("34.0 V is used instead.")
        .prints("there is nothing to write");
    let json = settings(&["import", name(&file), "--yes", "--json", "-c", "sim:mcp266,generation=4"])
        .ended_with(DONE)
        .explains("made for firmware generation 1, the connected controller has generation 4")
        .json();
    assert!(!json["upgraded"].as_array().unwrap().is_empty());
}

#[test]
fn a_profile_that_is_not_there_is_told_by_name() {
    settings(&["import", "/no/such/profile.json", "--yes"])
        .ended_with(NOT_TAKEN)
        .explains("Reading the profile /no/such/profile.json failed");
}

#[cfg(unix)]
mod on_a_served_controller {
    use std::path::Path;

    use brushwork_child::{Program, ahead};
    use brushwork_mcp_sim::controller::{Bus, Controller, ControllerConfig};
    use brushwork_plant::machine::StreamIndex;
    use brushwork_plant::server::{Endpoint, Server, ServerOptions, SimHandle};

    use super::*;
    use crate::cli::{LIMIT, NO_LINK, Simulated, program};

    #[test]
    fn what_one_command_writes_the_next_one_reads() {
        let unit = Simulated::start_on_pty(&[]);
        unit.settings("write", &["motor1.velocity.p=2.5", "pin.1.deadband=3", "--yes"]).ended_with(DONE);
        unit.settings("read", &["motor1.velocity.p"]).ended_with(DONE).prints("* 2.500");
        let json = unit.settings("save", &["--yes", "--json"]).ended_with(DONE).json();
        assert_eq!(json["save"]["verdict"], "verified");
        let keys: Vec<&Value> =
            json["not_default"].as_array().unwrap().iter().map(|row| &row["key"]).collect();
        assert_eq!(keys, ["motor1.velocity.p", "pin.1.deadband"]);

        let file = unit.folder.path().join("profile.json");
        unit.settings("export", &[name(&file)]).ended_with(DONE);
        unit.settings("defaults", &["--yes"]).ended_with(DONE).prints("2.500 -> 1.000");
        unit.settings("diff", &[name(&file)])
            .ended_with(DIFFERENT)
            .prints("motor1.velocity.p  1.000 -> 2.500");
        unit.settings("import", &[name(&file), "--yes"]).ended_with(DONE).prints("2 settings written");
        unit.settings("diff", &[name(&file)]).ended_with(DONE).prints("agree");
    }

    #[test]
    fn what_could_not_be_read_back_is_named_and_has_its_own_exit_code() {
        // Nothing can be read back through a port that has just been switched off; nobody holds RTS here to bring it back.
        let unit = Simulated::start(&[]);
        unit.settings("write", &["stream.usb.type=disabled", "--yes", "--save"])
            .ended_with(NOT_TAKEN)
            .prints("Note: It is not known which of the controller's streams this port is wired to")
            .explains("USB: mode was set to Disabled and not read back.")
            .explains("not saved to EEPROM, since not all of them took");
    }

    #[test]
    fn a_refused_write_changes_nothing() {
        let unit = Simulated::start(&[]);
        let mixed = ["motor1.velocity.p=2.5", "limits.main_battery.max_volts=99", "--yes"];
        unit.settings("write", &mixed).ended_with(NOT_TAKEN);
        let file = unit.folder.path().join("profile.json");
        unit.settings("export", &[name(&file)]).ended_with(DONE);
        edit(&file, "\"motor1.velocity.p\": { \"value\": 1.000", "\"motor1.velocity.p\": { \"value\": 2.000");
        edit(
            &file,
            "\"motor2.velocity.p\": { \"value\": 1.000",
            "\"motor2.velocity.p\": { \"value\": -2.0e9",
        );
        unit.settings("import", &[name(&file), "--yes"]).ended_with(NOT_TAKEN);
        unit.settings("read", &["motor1.velocity.p"]).ended_with(DONE).prints("motor1.velocity.p     1.000");
    }

    #[test]
    fn a_guess_is_never_written_to_a_controller_that_is_not_simulated_here() {
        let unit = Simulated::start(&[]);
        unit.settings("write", &["unit.bridge_channels=yes", "--yes"])
            .ended_with(NOT_TAKEN)
            .explains("No packet serial command for bridging the channels is public.");
        unit.settings("read", &["unit"])
            .ended_with(DONE)
            .prints("#  cannot be written on this controller:")
            .prints("No packet serial command for bridging the channels is public.");
    }

    #[test]
    fn what_a_profile_has_beyond_this_controller_is_left_out_with_its_reason() {
        let (_folder, file) = exported("sim:mcp266");
        edit(
            &file,
            "\"unit.bridge_channels\": { \"value\": false",
            "\"unit.bridge_channels\": { \"value\": true",
        );
        edit(&file, "\"motor1.velocity.p\": { \"value\": 1.000", "\"motor1.velocity.p\": { \"value\": 4.000");
        let unit = Simulated::start(&[]);
        unit.settings("import", &[name(&file), "--yes"])
            .ended_with(DONE)
            .prints("Left out of the profile")
            .prints("unit.bridge_channels (yes)")
            .prints("1 setting written and read back.");
    }

    #[test]
    fn a_port_that_is_no_controller_is_told() {
        let folder = tempfile::tempdir().unwrap();
        let nothing = folder.path().join("nothing");
        settings(&["read", "--connect", name(&nothing)]).ended_with(NO_LINK).explains("Could not open");
        let unit = Simulated::start(&["--fault", "mute"]);
        unit.settings("read", &[]).ended_with(NO_LINK).explains("nothing answered at address 0x80");
    }

    /// How often a busy machine may bring a signal too late before a test gives up.
    const TRIES: usize = 20;

    #[test]
    fn an_interrupted_write_ends_soon_and_says_what_was_not_done() {
        let keys = ["velocity.p", "velocity.i", "position.p", "position.i"];
        let changes = keys.map(|key| [format!("motor1.{key}=7"), format!("motor2.{key}=7")]).concat();
        let interrupted = (0..TRIES).any(|_| {
            let unit = Simulated::start(&["--fault", "delay=20ms"]);
            let mut command = program();
            command.args(["settings", "write", "--yes", "--connect", &unit.port()]).args(&changes);
            let mut program = Program::spawn(command);
            // The changes are shown before the first of them is written.
            assert!(program.next_line(LIMIT).unwrap().contains("->"));
            program.signal("INT");
            let ending = program.finish(LIMIT);
            if ending.stdout.iter().any(|line| line.starts_with("8 settings written")) {
                return false;
            }
            assert_eq!(ending.status.code(), Some(130), "{ending:?}");
            assert!(ending.stderr.join("\n").contains("it was cancelled"), "{ending:?}");
            true
        });
        assert!(interrupted, "every write went on to its end");
    }

    #[test]
    fn a_new_address_is_followed() {
        let unit = Simulated::start(&[]);
        unit.settings("write", &["unit.address=0x83", "--yes"])
            .ended_with(DONE)
            .prints("unit.address  128 -> 131")
            .prints("answers to its new address");
    }

    #[test]
    fn an_interrupt_ends_a_slow_reading_cleanly_before_its_end() {
        let interrupted = (0..TRIES).any(|_| {
            let folder = tempfile::tempdir().unwrap();
            let unit = slow_unit(&folder.path().join("port"));
            let mut command = program();
            command.args(["settings", "read", "--connect", name(&folder.path().join("port"))]);
            let program = Program::spawn(command);
            let is_asked =
                |bus: &mut Bus| bus.controllers()[0].unit().is_some_and(|unit| unit.silence().is_some());
            crate::wait::until(
                "a first question",
                || unit.inspect(is_asked).unwrap(),
                || "silence".to_owned(),
            );
            program.signal("INT");
            let ending = program.finish(LIMIT);
            if ending.status.success() {
                return false;
            }
            assert_eq!(ending.status.code(), Some(130), "{ending:?}");
            assert!(ending.stdout.is_empty(), "{ending:?}");
            true
        });
        assert!(interrupted, "every reading went on to its end");
    }

    /// A controller whose answers take so long that reading everything takes seconds.
    fn slow_unit(link: &Path) -> SimHandle<Bus> {
        let unit = Controller::new(ControllerConfig::default()).expect("the preset is valid");
        let faults = vec!["delay=30ms".parse().expect("a fault")];
        let options = ServerOptions { faults, ..ServerOptions::default() };
        let endpoint = Endpoint::Pty { link: link.to_owned() };
        let bus = Bus::single(unit, StreamIndex::Usb);
        ahead(|| Server::spawn(bus, options, &endpoint)).expect("there are pseudo-terminals")
    }
}
