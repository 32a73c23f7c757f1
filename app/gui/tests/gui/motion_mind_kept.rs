//! Registers that cannot be lost, in the window: profiles, upgrades from another revision, comparisons, backups, and writes that were cut
//! short, for a Motion Mind 3, by role and label.

use crate::support::bench::Bench;
use brushwork_core::keep::UnitId;
use brushwork_gui::model::general::Sheet;
use brushwork_link::settings::{Act, Profile, SettingValue, SettingsTable};
use brushwork_motion_mind_sim::{Mode, MotionMindConfig};
use brushwork_motion_mind_wire::register_named;
use brushwork_plant::machine::Machine as _;
use brushwork_plant::world::WorldAction;
use egui::Theme;
use egui_kittest::kittest::Queryable as _;

/// The command that writes a register to RAM.
const WRITE: u8 = 0x18;

const PTERM: &str = "register.pterm";

/// Connected in mode 4 with the registers open and read.
fn opened() -> Bench {
    let configs = vec![MotionMindConfig::new(Mode::SerialPid)];
    let mut bench = Bench::with_minds_sized(configs, [1920.0, 1080.0], Theme::Dark);
    bench.pass_ms(200);
    bench.choose("Simulated model", "Motion Mind 3");
    bench.connect();
    bench.pass_ms(3000);
    bench.press("Registers");
    bench.pass_ms(2000);
    bench
}

fn unit(bench: &mut Bench) -> UnitId {
    UnitId::new(bench.model().front.link.identity().expect("it is connected"), &[])
}

fn ram(bench: &Bench, name: &str) -> i64 {
    let number = register_named(name).expect("a register of the manual").number;
    bench.minds.with(|bus| bus.motion_minds()[0].read_one(number))
}

fn want(bench: &mut Bench, changes: &[(&str, i64)]) {
    for (key, value) in changes {
        let unit = bench.model().front.settings.unit_mut().expect("it is looked at");
        unit.set(key, SettingValue::Int(*value));
    }
    bench.pass_ms(200);
}

fn write(bench: &mut Bench) {
    bench.press("Write settings");
    bench.press("Write to controller");
    bench.pass_ms(5000);
}

fn edits(bench: &mut Bench) -> usize {
    bench.model().front.settings.unit().expect("it is looked at").edits().len()
}

#[test]
fn a_profile_is_saved_opened_compared_and_taken_over() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("arm.json").display().to_string();
    let mut bench = opened();
    want(&mut bench, &[(PTERM, 7_000), ("register.vplimit", 250_000)]);
    write(&mut bench);
    bench.press("Save profile");
    bench.model().front.general.profiles.path = path.clone();
    bench.pass_ms(200);
    bench.harness.get_all_by_label("Save profile").last().unwrap().click();
    bench.pass_ms(500);
    let saved = Profile::load(path.as_ref()).unwrap();
    assert_eq!(saved.settings.get(PTERM), Some(SettingValue::Int(7_000)));
    bench.press("Default settings");
    bench.press("Restore factory values");
    bench.pass_ms(8000);
    assert_eq!(ram(&bench, "PTERM"), 6_000);
    bench.press("Open profile");
    bench.press("Open");
    assert_eq!(bench.model().front.general.sheet.as_ref(), Some(&Sheet::Compare));
    assert!(bench.sees_part("6000 -> 7000") && bench.sees_part("-> 250000"), "{:?}", bench.said());
    bench.press("Take over all");
    assert_eq!(ram(&bench, "PTERM"), 6_000, "taking over writes nothing");
    write(&mut bench);
    assert_eq!((ram(&bench, "PTERM"), ram(&bench, "VPLIMIT")), (7_000, 250_000));
    bench.press("Compare settings");
    assert!(bench.sees("Both sides have the same values."));
}

#[test]
fn a_profile_of_another_family_is_refused_and_one_of_another_revision_is_taken_over() {
    let folder = tempfile::tempdir().unwrap();
    let subject = brushwork_motion_mind_client::subject(7);
    let mut settings = SettingsTable::new(subject).default_image();
    settings.set(PTERM, SettingValue::Int(4_321));
    let profile = Profile {
        subject,
        firmware: "revision 7".to_owned(),
        address: brushwork_motion_mind_client::unit_address(3).expect("an address"),
        date: "2025-01-01T00:00:00Z".to_owned(),
        unit: String::new(),
        note: String::new(),
        settings,
    };
    let older = folder.path().join("older.json");
    profile.save(&older).unwrap();
    let mut bench = opened();
    bench.press("Open profile");
    bench.model().front.general.profiles.path = older.display().to_string();
    bench.pass_ms(200);
    bench.press("Open");
    if bench.model().front.general.sheet.as_ref() == Some(&Sheet::Upgrade) {
        bench.press("Use with these changes");
    }
    assert_eq!(bench.model().front.general.sheet.as_ref(), Some(&Sheet::Compare));
    assert!(bench.sees_part("6000 -> 4321"));

    let mcp = brushwork_mcp_client::subject(
        brushwork_mcp_wire::models::lookup("mcp236").unwrap(),
        brushwork_mcp_wire::packet_serial::Generation::Gen2,
    );
    let address = brushwork_link::UnitAddress::factory(brushwork_mcp_client::MCP);
    let foreign =
        Profile { subject: mcp, address, settings: SettingsTable::new(mcp).default_image(), ..profile };
    let path = folder.path().join("mcp.json");
    foreign.save(&path).unwrap();
    bench.press("Back");
    bench.press("Open profile");
    bench.model().front.general.profiles.path = path.display().to_string();
    bench.pass_ms(200);
    bench.press("Open");
    bench.pass_ms(300);
    assert!(bench.sees_part("MCP236"));
    assert_ne!(bench.model().front.general.sheet.as_ref(), Some(&Sheet::Compare), "nothing of it fits");
    assert_eq!(edits(&mut bench), 0);
}

#[test]
fn the_list_of_backups_compares_and_restores() {
    let mut bench = opened();
    bench.press("Backups");
    assert!(bench.sees_part("There is no backup of this controller yet"));
    bench.press("Back");
    want(&mut bench, &[(PTERM, 7_777)]);
    write(&mut bench);
    let unit = unit(&mut bench);
    let backups = bench.store().backups(Some(&unit));
    assert_eq!(backups.len(), 1);
    assert!(backups[0].name.ends_with(&format!("before-{}", Act::Write.label())));
    let title = backups[0].title();
    bench.press("Backups");
    bench.press(&format!("Restore backup {title}"));
    assert_eq!(
        bench.model().front.general.sheet.as_ref(),
        Some(&Sheet::Write),
        "what it changes is shown first"
    );
    assert!(bench.sees_part("7777 -> 6000"));
    bench.press("Write to controller");
    bench.pass_ms(5000);
    assert_eq!(ram(&bench, "PTERM"), 6_000);
    assert_eq!(bench.store().backups(Some(&unit)).len(), 2, "restoring is a write and leaves a backup too");
}

#[test]
fn a_write_that_a_pulled_cable_cuts_short_is_told_at_the_next_connection_and_finished() {
    let mut bench = opened();
    let wanted: [(&str, i64); 6] = [
        (PTERM, 7_001),
        ("register.iterm", 71),
        ("register.dterm", 701),
        ("register.vnlimit", -70_001),
        ("register.vplimit", 70_001),
        ("register.deadband", 17),
    ];
    want(&mut bench, &wanted);
    bench.minds.after_frame(WRITE, 3, WorldAction::Unplug { unplugged: true });
    bench.press("Write settings");
    bench.press("Write to controller");
    bench.pass_ms(20_000);
    assert_eq!((ram(&bench, "VPLIMIT"), ram(&bench, "DTERM")), (70_001, 0), "it is cut in the middle");
    assert!(!bench.model().is_connected());
    bench.minds.with(|bus| bus.apply(0, &WorldAction::Unplug { unplugged: false }));
    bench.connect();
    bench.pass_ms(4000);
    assert!(bench.sees_part("A write of settings begun"), "told at once: {:?}", bench.said());
    bench.press("Registers");
    bench.pass_ms(1000);
    assert_eq!(bench.model().front.general.sheet.as_ref(), Some(&Sheet::Unfinished));
    assert!(bench.sees_part("The controller holds a mix"));
    bench.press("Finish with the new values");
    bench.press("Write to controller");
    bench.pass_ms(6000);
    assert_eq!(edits(&mut bench), 0);
    for (key, value) in wanted {
        let name = key.trim_start_matches("register.").to_uppercase();
        assert_eq!(ram(&bench, &name), value, "{name}: {:?}", bench.said());
    }
    let unit = unit(&mut bench);
    assert_eq!(bench.store().open_journals(&unit).0.len(), 0, "it is settled");
}
