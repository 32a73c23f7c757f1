//! What was read from a unit is compared, imported and restored as it was, out of range too; what somebody types is not.
#![cfg(unix)]

use crate::cli::{DIFFERENT, DONE, NOT_TAKEN, Simulated, edit, name};

const MIN: &str = "limits.main_battery.min_volts";
const WARNING: &str =
    "Note: Main battery minimum 8.4 V is below the MCP266's 10.0 V. It is written as it was read.";

/// A unit whose main battery minimum is 8.4 V, and a profile of it.
fn unit_below_its_range() -> (Simulated, std::path::PathBuf) {
    let unit = Simulated::start(&[]);
    let file = unit.folder.path().join("first.json");
    unit.settings("export", &[name(&file)]).ended_with(DONE);
    // A profile is a profile: that a hand has changed it cannot be told.
    edit(&file, "min_volts\": { \"value\": 10.0", "min_volts\": { \"value\": 8.4");
    unit.settings("import", &[name(&file), "--yes"]).ended_with(DONE).prints(WARNING);
    let held = unit.folder.path().join("held.json");
    unit.settings("export", &[name(&held)]).ended_with(DONE);
    assert!(std::fs::read_to_string(&held).expect("it was exported").contains("\"value\": 8.4"));
    (unit, held)
}

#[test]
fn an_export_of_a_unit_below_its_range_is_compared_and_imported_again() {
    let (unit, held) = unit_below_its_range();
    unit.settings("diff", &[name(&held)]).ended_with(DONE).prints("agree");
    unit.settings("compare", &["ram", name(&held)]).ended_with(DONE);
    unit.settings("import", &[name(&held), "--only", "motor1", "--yes"]).ended_with(DONE);
    unit.settings("defaults", &["--yes"]).ended_with(DONE);
    unit.settings("diff", &[name(&held)]).ended_with(DIFFERENT).prints("10.0 V -> 8.4 V");
    let json = unit.settings("import", &[name(&held), "--yes", "--json"]).ended_with(DONE).json();
    assert_eq!(json["warnings"][0], WARNING.trim_start_matches("Note: "));
    unit.settings("diff", &[name(&held)]).ended_with(DONE);
}

#[test]
fn a_backup_of_a_unit_below_its_range_is_restored() {
    let (unit, held) = unit_below_its_range();
    unit.settings("defaults", &["--yes"]).ended_with(DONE);
    unit.settings("restore", &["--yes"]).ended_with(DONE).prints(WARNING);
    unit.settings("diff", &[name(&held)]).ended_with(DONE);
}

#[test]
fn what_is_typed_beside_a_profile_stays_refused_out_of_range() {
    let (unit, held) = unit_below_its_range();
    let lower = format!("{MIN}=8.2");
    unit.settings("write", &[&lower, "--yes"])
        .ended_with(NOT_TAKEN)
        .explains("8.2 V is below the MCP266's 10.0 V.");
    unit.settings("write", &["--profile", name(&held), &lower, "--yes"])
        .ended_with(NOT_TAKEN)
        .explains("8.2 V is below the MCP266's 10.0 V.");
    let pair = [&format!("{MIN}=30"), "limits.main_battery.max_volts=24"];
    unit.settings("write", &["--profile", name(&held), pair[0], pair[1], "--yes"])
        .ended_with(NOT_TAKEN)
        .explains("Main battery minimum 30.0 V would be above Main battery maximum 24.0 V.");
    unit.settings("diff", &[name(&held)]).ended_with(DONE);
}
