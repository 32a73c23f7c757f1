//! Profiles of older schemas, other models, other generations: what becomes of them, told in sentences.

use brushwork_mcp_wire::packet_serial::Generation;

use crate::tests::settings::{every_table, table};
use brushwork_link::settings::{Profile, SCHEMA, SettingValue, SettingsTable, Strictness};

/// A file of each older schema, as the program of that time wrote it.
const FIXTURES: &[(u64, &str)] = &[
    (1, include_str!("fixtures/profile-schema-1.json")),
    (2, include_str!("fixtures/profile-schema-2.json")),
];

fn fixture() -> Profile {
    Profile::parse(FIXTURES[0].1).expect("it is right")
}

/// The fixture as far as it has settings of another controller, and the sentences.
fn fitted(to: &SettingsTable) -> (Profile, Vec<String>) {
    let fitted = fixture().fitted_to(to);
    (fitted.profile, fitted.changes.iter().map(ToString::to_string).collect())
}

#[test]
fn there_is_a_file_of_every_older_schema_and_each_is_read() {
    let known: Vec<u64> = FIXTURES.iter().map(|(schema, _)| *schema).collect();
    assert_eq!(known, (1..SCHEMA).collect::<Vec<_>>());
    for (schema, text) in FIXTURES {
        assert!(text.contains(&format!("\"schema\": {schema},")));
        let opened = Profile::read(text, Strictness::Refuse).unwrap_or_else(|error| panic!("{error}"));
        // Schema 2 lacked the registers alone, which follow from its values.
        assert_eq!(opened.upgraded.is_empty(), schema == &2, "schema {schema}: every change is told");
        assert_eq!(opened.profile.settings.len(), 242, "schema {schema}");
        assert_eq!(opened.profile.settings.get("motor1.velocity.p"), Some(SettingValue::Number(2.5)));
        assert_eq!(opened.profile.settings, fixture().settings, "schema {schema}");
        let again = Profile::read(&opened.profile.to_json(), Strictness::Refuse).expect("it is of today");
        assert_eq!((again.profile, again.upgraded), (opened.profile, Vec::new()));
    }
}

#[test]
fn schema_1_did_not_name_unit_and_reason() {
    let opened = Profile::read(FIXTURES[0].1, Strictness::Refuse).expect("it is right");
    assert_eq!(
        opened.upgraded,
        [
            "Schema 1 did not say which unit the settings came from; that stays open.",
            "Schema 1 did not say why they were kept; that stays open.",
        ]
    );
    assert_eq!((opened.profile.unit.as_str(), opened.profile.note.as_str()), ("", ""));
}

#[test]
fn a_profile_of_the_same_kind_is_not_touched() {
    let (profile, changes) = fitted(&table("mcp266", Generation::Gen1));
    assert_eq!(changes, [""; 0]);
    assert_eq!(profile, fixture());
}

#[test]
fn what_is_too_much_for_another_model_is_moved_into_its_range_and_told() {
    let (profile, changes) = fitted(&table("mcp263", Generation::Gen1));
    assert_eq!(profile.settings.get("limits.main_battery.max_volts"), Some(SettingValue::Number(34.0)));
    assert_eq!(
        changes,
        [
            "The profile was made for the MCP266 (2x60A), the connected controller is the MCP263 (2x60A).",
            "Main battery maximum 48.0 V is above the MCP263's 34.0 V. 34.0 V is used instead.",
        ]
    );
}

#[test]
fn encoders_go_by_their_channel_and_inputs_by_their_name() {
    let mut profile = fixture();
    profile.settings.set("pin.4.deadband", SettingValue::Int(7));
    profile.settings.set("pin.3.target", SettingValue::Choice("motor1"));
    let here = table("mcp233", Generation::Gen1);
    let fitted = profile.fitted_to(&here);
    let settings = &fitted.profile.settings;
    // ENC1A is DIN7 of the MCP266 and DIN3 of the MCP233.
    assert_eq!(settings.get("pin.3.type"), Some(SettingValue::Choice("encoder")));
    assert_eq!(
        settings.get("pin.3.target"),
        Some(SettingValue::Choice("none")),
        "DIN3 gave way to the encoder"
    );
    assert_eq!(settings.get("motor1.encoder.pin"), here.row("motor1.encoder.pin").map(|row| row.default));
    let reported: Vec<String> = fitted.changes.iter().map(ToString::to_string).collect();
    let reported = reported.join("\n");
    for sentence in [
        "The settings of input DIN7/AN7/P7/ENC1A go to DIN3/AN3/P3/ENC1A/TX2.",
        "has no place for DIN3/AN3: its 17 settings are left out (not at the default: controls Motor 1",
        "has no place for DIN4/AN4/P4: its 17 settings are left out (not at the default: deadband 7",
        "Motor 1: maximum current 60.00 A is above the MCP233's 30.00 A. 30.00 A is used instead.",
    ] {
        assert!(reported.contains(sentence), "no {sentence:?} in:\n{reported}");
    }
}

#[test]
fn an_input_that_cannot_measure_what_it_should_measures_nothing() {
    let mut profile = fixture();
    profile.settings.set("pin.2.type", SettingValue::Choice("analog"));
    let fitted = profile.fitted_to(&table("mcp2163", Generation::Gen1));
    assert_eq!(fitted.profile.settings.get("pin.2.type"), Some(SettingValue::Choice("none")));
    let reported = "DIN2/P2 cannot be analog on the MCP2163; it measures nothing instead.";
    assert!(fitted.changes.iter().any(|change| change == reported), "{:#?}", fitted.changes);
}

#[test]
fn another_generation_keeps_what_it_has_and_names_what_it_has_not() {
    let (profile, changes) = fitted(&table("mcp266", Generation::Gen4));
    assert_eq!(profile.subject.generation, crate::firmware_of(Generation::Gen4));
    assert_eq!(profile.settings.get("motor1.velocity.p"), Some(SettingValue::Number(2.5)));
    assert!(changes[0].contains("firmware generation 1, the connected controller has generation 4"));
}

#[test]
fn every_profile_fits_every_controller_once_it_is_fitted_and_nothing_is_lost_unsaid() {
    for from in every_table() {
        let mut profile = fixture();
        profile.subject = *from.subject();
        profile.settings = from.default_image();
        let others = [
            ("mcp233", Generation::Gen1),
            ("mcp2163", Generation::Gen4),
            ("roboclaw-2x7a", Generation::Gen2),
        ];
        for to in others.map(|(model, generation)| table(model, generation)) {
            let fitted = profile.fitted_to(&to);
            let problems = fitted.profile.changes_for(&to, &Default::default(), true).err();
            assert!(
                problems.is_none(),
                "{} -> {}: {problems:?}",
                from.subject().model.key,
                to.subject().model.key
            );
            // What is divided otherwise there has a test of its own: `upgrade_matrix`.
            let is_roboclaw = to.row("roboclaw.config.mode").is_some();
            let is_divided = |key: &str| {
                key.ends_with("default_decel")
                    || key.ends_with("pwm_mode")
                    || is_roboclaw && key.starts_with("roboclaw.") && key.contains("deadband")
            };
            let count =
                |profile: &Profile| profile.settings.iter().filter(|(key, _)| !is_divided(key)).count();
            let lost = count(&profile) - count(&fitted.profile);
            let reported: usize =
                fitted.changes.iter().filter_map(|change| left_out(&change.to_string())).sum();
            assert_eq!(lost, reported, "{:#?}", fitted.changes);
            assert_eq!(Profile::parse(&fitted.profile.to_json()).as_ref(), Ok(&fitted.profile));
        }
    }
}

/// How many settings a sentence says were left out.
fn left_out(sentence: &str) -> Option<usize> {
    let rest = sentence.split(": its ").nth(1).filter(|rest| rest.contains("left out"))?;
    if rest.starts_with("setting is") { Some(1) } else { rest.split(' ').next()?.parse().ok() }
}
