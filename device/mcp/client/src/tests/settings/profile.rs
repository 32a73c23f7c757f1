//! Profiles: a round trip, and everything that can be wrong with one.

use crate::subject;
use brushwork_mcp_wire::models;
use brushwork_mcp_wire::packet_serial::{Address, Generation};

use crate::tests::settings::table;
use brushwork_link::settings::{
    OpenedProfile, Profile, SettingValue, SettingsTable, Signed, Strictness, WriteOptions, diff,
};

fn profile(model: &str, generation: Generation) -> Profile {
    brushwork_link::install(&[&crate::McpDriver]);
    let subject = subject(models::lookup(model).expect("a model of the list"), generation);
    Profile {
        subject,
        firmware: "MCP266 2x60A v1.0.0".to_owned(),
        address: crate::unit_address(Address::DEFAULT),
        date: "2026-01-05T10:00:00Z".to_owned(),
        unit: "0123456789".to_owned(),
        note: "before a write".to_owned(),
        settings: SettingsTable::new(subject).default_image(),
    }
}

/// A valid profile with two settings, as text.
const SMALL: &str = r#"{
  "format": "brushwork-settings",
  "schema": 3,
  "model": "mcp266",
  "firmware": "MCP266 2x60A v1.0.0",
  "generation": 1,
  "address": "0x80",
  "date": "2026-01-05", "unit": "", "note": "",
  "pins": 10,
  "streams": 5,
  "douts": 2,
  "settings": {
    "unit.mixing": { "value": true },
    "limits.main_battery.max_volts": { "value": 24.3, "unit": "V" }
  }
}
"#;

#[test]
fn a_profile_survives_the_way_to_text_and_back() {
    for model in ["mcp233", "mcp266", "mcp2166", "roboclaw-2x7a"] {
        for generation in Generation::ALL {
            let mut profile = profile(model, generation);
            if profile.settings.get("dout.1.action").is_some() {
                profile.settings.set("dout.1.action", SettingValue::UnknownCode(99));
            }
            profile.firmware = "strange \"name\"\\ \u{1F600}\u{0}".to_owned();
            let text = profile.to_json();
            assert_eq!(Profile::parse(&text).as_ref(), Ok(&profile), "{model} {generation}");
            assert_eq!(Profile::parse(&text).map(|read| read.to_json()), Ok(text));
        }
    }
}

#[test]
fn a_profile_is_json_with_one_line_per_setting_and_its_unit() {
    let text = profile("mcp266", Generation::Gen1).to_json();
    assert!(serde_json::from_str::<serde_json::Value>(&text).is_ok());
    assert!(
        text.contains(
            "\n    \"limits.main_battery.max_volts\": { \"value\": 60.0, \"unit\": \"V\", \"raw\": 600 },\n"
        ),
        "{text}"
    );
    assert!(text.contains("\n    \"motor1.velocity.i\": { \"value\": 0.500, \"raw\": 32768 },\n"), "{text}");
    assert!(
        text.contains("\n    \"unit.estop_reset\": { \"value\": \"hardware\", \"raw\": 0 },\n"),
        "{text}"
    );
}

#[test]
fn the_small_profile_is_right() {
    let profile = Profile::parse(SMALL).expect("it is right");
    assert_eq!(profile.settings.len(), 2);
    assert_eq!(profile.settings.get("limits.main_battery.max_volts"), Some(SettingValue::Number(24.3)));
    assert_eq!(profile.subject.model.key, "mcp266");
}

/// The small profile with one text replaced by another.
fn broken(from: &str, to: &str) -> Vec<String> {
    assert!(SMALL.contains(from), "{from}");
    let error = Profile::parse(&SMALL.replacen(from, to, 1)).expect_err("it is broken");
    error.problems.iter().map(ToString::to_string).collect()
}

#[test]
fn each_fault_is_told_with_its_place() {
    for (from, to, expected) in [
        ("\"schema\": 3,", "\"schema\": 3", "line 4, column 3: Not JSON: expected `,` or `}`."),
        ("}\n}", "}", "line 16, column 0: Not JSON: EOF while parsing an object."),
        (
            "brushwork-settings",
            "other",
            "This is no settings profile: it does not say \"format\": \"brushwork-settings\".",
        ),
        (
            "\"schema\": 3",
            "\"schema\": 4",
            "schema (line 3, column 3): The profile has schema 4, this program reads up to 3. A newer \
             program wrote it.",
        ),
        (
            "\"schema\": 3",
            "\"schema\": \"1\"",
            "schema (line 3, column 3): Expected a schema number from 1, got a text.",
        ),
        (
            "\"generation\": 1",
            "\"generation\": 7",
            "generation (line 6, column 3): 7 is no firmware generation; there are 1 to 4.",
        ),
        ("0x80", "0x90", "address (line 7, column 3): \"0x90\" is no address; there are 0x80 to 0x87."),
        ("\"pins\": 10", "\"pins\": 1000000", "pins (line 9, column 3): 1000000 is not from 0 to 32."),
        ("\"date\"", "\"data\"", "data (line 8, column 3): A profile has no such member."),
        (
            "unit.mixing",
            "unit.mixxing",
            "settings.unit.mixxing (line 13, column 5): The MCP266 with firmware generation 1 has no such \
             setting.",
        ),
        ("true", "1", "settings.unit.mixing (line 13, column 5): Expected true or false, got a number."),
        (
            "\"V\"",
            "\"mV\"",
            "settings.limits.main_battery.max_volts (line 14, column 5): The unit is \"mV\"; it has to be \
             \"V\".",
        ),
        (
            ", \"unit\": \"V\"",
            "",
            "settings.limits.main_battery.max_volts (line 14, column 5): The unit is missing; it has to be \
             \"V\".",
        ),
        (
            "24.3",
            "\"24.3\"",
            "settings.limits.main_battery.max_volts (line 14, column 5): Expected a number, got a text.",
        ),
        (
            "{ \"value\": true }",
            "true",
            "settings.unit.mixing (line 13, column 5): Expected an object with a \"value\", got true or \
             false.",
        ),
        (
            "{ \"value\": true }",
            "{ \"value\": true, \"valeu\": 1 }",
            "settings.unit.mixing (line 13, column 5): A setting has no member \"valeu\".",
        ),
    ] {
        let reported = broken(from, to);
        assert!(reported.iter().any(|problem| problem == expected), "{from} -> {to}: {reported:#?}");
    }
    assert_eq!(
        broken("mcp266", "mcp999"),
        ["model (line 4, column 3): \"mcp999\" is no known model; known are mcp233, mcp236, mcp263, \
             mcp266, mcp2126, mcp2128, mcp2163, mcp2166, mcp2168, mcp2206, roboclaw-solo-30a, roboclaw-solo-60a, \
             roboclaw-solo-300a, roboclaw-solo-300ahv, roboclaw-2x5a, roboclaw-2x7a, roboclaw-2x15a, \
             roboclaw-2x30a, roboclaw-2x45a, roboclaw-2x60a, roboclaw-2x60ahv, roboclaw-2x120a, \
             roboclaw-2x120ahv, roboclaw-2x160a, roboclaw-2x160ahv, roboclaw-2x200ahv, roboclaw-2x300ahv, \
             roboclaw-2x400ahv."]
    );
    assert_eq!(
        broken(
            "\"limits.main_battery.max_volts\": { \"value\": 24.3, \"unit\": \"V\" }",
            "\"unit.mixing\": { \"value\": false }"
        ),
        ["settings.unit.mixing (line 13, column 5): The setting stands twice."]
    );
}

#[test]
fn the_register_counts_unless_the_value_beside_it_was_changed() {
    let read = |entry: &str, strictness| {
        let text = SMALL.replace("{ \"value\": 24.3, \"unit\": \"V\" }", entry);
        let text = text.replace("limits.main_battery.max_volts", "motor1.current.min_amps");
        let key = "motor1.current.min_amps";
        Profile::read(&text, strictness)
            .map(|opened| (opened.profile.settings.get(key), opened.corrected))
            .map_err(|error| error.to_string())
    };
    let signed = |raw| Some(SettingValue::Signed(Signed { number: -5.0, raw }));
    let whole = |entry| {
        let (value, corrected) = read(entry, Strictness::Refuse).expect("it is right");
        assert_eq!(corrected, []);
        value
    };
    // Units report the minimum current with either sign.
    assert_eq!(whole(r#"{ "value": -5.00, "unit": "A", "raw": 500 }"#), signed(500));
    assert_eq!(whole(r#"{ "value": -5.00, "unit": "A", "raw": -500 }"#), signed(-500));
    assert_eq!(whole(r#"{ "raw": 500 }"#), signed(500));
    assert_ne!(signed(500), signed(-500));
    let typed = whole(r#"{ "value": -5.00, "unit": "A" }"#);
    assert!(typed == signed(500) && typed == signed(-500), "who typed it said nothing of a sign");
    let edited = r#"{ "value": -4.00, "unit": "A", "raw": 500 }"#;
    let (value, said) = read(edited, Strictness::Refuse).expect("people change files");
    assert_eq!(value, Some(SettingValue::Number(-4.0)));
    assert_eq!(
        said[0].to_string(),
        "settings.motor1.current.min_amps (line 14, column 5): It says -4.00 A, and its \"raw\" 500 is -5.00 A: -4.00 A counts."
    );
    // What cannot be understood is refused, and comes back from a backup all the same.
    let foreign = r#"{ "value": "five", "raw": 500 }"#;
    assert!(read(foreign, Strictness::Refuse).is_err());
    let (value, said) = read(foreign, Strictness::Repair).expect("the file as a whole is right");
    assert_eq!((value, said.len()), (signed(500), 1));
    let odd = r#"{ "value": -5.00, "unit": "A", "raw": "500" }"#;
    assert!(read(odd, Strictness::Refuse).unwrap_err().contains("Expected a whole number as \"raw\""));
}

#[test]
fn a_program_that_had_no_name_for_a_number_wrote_it_twice_and_it_is_still_read() {
    let text = SMALL.replace("{ \"value\": true }", "{ \"value\": 1, \"raw\": 1 }");
    let profile = Profile::parse(&text).expect("the number is a name by now");
    assert_eq!(profile.settings.get("unit.mixing"), Some(SettingValue::Bool(true)));
    assert!(Profile::parse(&text.replace("\"raw\": 1", "\"raw\": 0")).is_err());
}

#[test]
fn several_faults_are_told_at_once() {
    let text = SMALL
        .replace("24.3", "\"99\"")
        .replace("true", "\"yes\"")
        .replace("\"generation\": 1", "\"generation\": 1,\n\"x\": 1");
    let error = Profile::parse(&text).expect_err("it is broken");
    assert_eq!(error.problems.len(), 3, "{error}");
}

#[test]
fn what_is_no_profile_at_all_is_refused_without_panic() {
    for text in [
        "",
        "null",
        "[]",
        "3",
        "\"x\"",
        "{}",
        "{\"format\": 1}",
        "\u{feff}{}",
        "{\"format\":\"brushwork-settings\"}",
    ] {
        assert!(Profile::parse(text).is_err(), "{text}");
    }
    let deep = "[".repeat(100_000);
    assert!(Profile::parse(&deep).is_err());
}

#[test]
fn every_prefix_of_a_profile_is_refused_without_panic() {
    let whole = SMALL.trim_end();
    for end in (0..whole.len()).filter(|end| whole.is_char_boundary(*end)) {
        assert!(Profile::parse(&whole[..end]).is_err(), "{end}");
    }
}

#[test]
fn a_profile_with_a_few_bytes_changed_is_refused_or_read_as_what_it_then_says() {
    // A small generator of our own: the same 20000 texts in every run.
    let mut state: u64 = 0x9E37_79B9_7F4A_7C15;
    let mut next = |below: usize| {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        usize::try_from(state >> 33).expect("31 bits") % below
    };
    let mut taken = 0;
    for _ in 0..20_000 {
        let mut bytes = SMALL.as_bytes().to_vec();
        for _ in 0..=next(3) {
            let at = next(bytes.len());
            match next(3) {
                0 => bytes[at] = b" !\"#,.:0123456789aetx{}[]-"[next(26)],
                1 => drop(bytes.remove(at)),
                _ => bytes.insert(at, bytes[next(bytes.len())]),
            }
        }
        let text = String::from_utf8(bytes).expect("all of it is ASCII");
        if let Ok(profile) = Profile::parse(&text) {
            taken += 1;
            assert_eq!(Profile::parse(&profile.to_json()), Ok(profile), "{text}");
        }
    }
    assert!((100..15_000).contains(&taken), "{taken} texts were still right");
}

#[test]
fn single_faults_can_be_mended_with_a_warning_each() {
    let text = SMALL.replace("24.3", "\"80\"").replace("unit.mixing", "unit.mixxing");
    let opened = Profile::read(&text, Strictness::Repair).expect("the file as a whole is right");
    let OpenedProfile { profile, corrected: warnings, upgraded } = opened;
    assert!(upgraded.is_empty(), "{upgraded:?}");
    assert!(profile.settings.is_empty());
    let reported: Vec<String> = warnings.iter().map(ToString::to_string).collect();
    assert_eq!(
        reported,
        [
            "settings.unit.mixxing (line 13, column 5): The MCP266 with firmware generation 1 has no such \
             setting.",
            "settings.limits.main_battery.max_volts (line 14, column 5): Expected a number, got a text.",
        ]
    );
}

#[test]
fn what_a_unit_held_out_of_range_is_kept_as_it_was_and_told_before_it_is_written() {
    let mut stored = Profile::parse(&SMALL.replace("24.3", "80")).expect("a unit may hold 80 V");
    stored.settings.set("unit.mixing", SettingValue::UnknownCode(5));
    stored.settings.set("dout.1.action", SettingValue::UnknownCode(99));
    stored.settings.set("motor1.position.min", SettingValue::Int(9));
    stored.settings.set("motor1.position.max", SettingValue::Int(-9));
    for strictness in [Strictness::Refuse, Strictness::Repair] {
        let opened = Profile::read(&stored.to_json(), strictness).expect("nothing is wrong with it");
        assert_eq!((&opened.profile, opened.corrected.len()), (&stored, 0));
    }
    let here = table("mcp266", Generation::Gen1);
    assert_eq!(stored.fitted_to(&here).changes, [""; 0]);
    let ram = here.default_image();
    let wanted = stored.changes_for(&here, &ram, false).expect("it fits").wanted;
    assert_eq!(wanted, stored.settings);
    let options = WriteOptions { as_read: true, ..WriteOptions::default() };
    let plan =
        brushwork_link::settings::plan(&here, &ram, &wanted, options).expect("it is written as it was");
    assert_eq!(
        plan.warnings[..4],
        [
            "Control mixing: 5 is none of the values known for it. It is written as it was read.",
            "Main battery maximum 80.0 V is above the MCP266's 60.0 V. It is written as it was read.",
            "DOUT1: action: 99 is none of the values known for it. It is written as it was read.",
            "Motor 1: minimum position 9 counts would be above Motor 1: maximum position -9 counts. Both are written as \
             they were read.",
        ]
    );
    // What somebody types is refused as ever.
    let refusals = brushwork_link::settings::plan(&here, &ram, &wanted, WriteOptions::default())
        .expect_err("out of range");
    assert_eq!(refusals.len(), 4, "{refusals:?}");
}

#[test]
fn what_no_unit_can_hold_is_refused_whoever_says_so() {
    let here = table("mcp266", Generation::Gen4);
    let ram = here.default_image();
    for (key, value, expected) in [
        ("limits.main_battery.max_volts", SettingValue::Number(10_000.0), "holds 0 to 65535"),
        ("motor1.idle.delay_seconds", SettingValue::Number(20.0), "200 takes more than 7 bits"),
        ("unit.pwm_mode", SettingValue::Int(1), "has no setting"),
        ("motor1.pwm_mode", SettingValue::UnknownCode(256), "holds 0 to 255"),
        ("motor1.velocity.qpps", SettingValue::UnknownCode(1), "none of the values"),
    ] {
        let wanted = [(key.to_owned(), value)].into_iter().collect();
        let options = WriteOptions { as_read: true, ..WriteOptions::default() };
        let refusals = brushwork_link::settings::plan(&here, &ram, &wanted, options).expect_err(key);
        assert!(
            refusals.iter().any(|refusal| refusal.sentence.to_string().contains(expected)),
            "{key}: {refusals:?}"
        );
    }
}

#[test]
fn a_profile_of_another_model_or_generation_changes_nothing() {
    let stored = profile("mcp266", Generation::Gen1);
    let here = table("mcp233", Generation::Gen3);
    let error = stored.changes_for(&here, &here.default_image(), false).expect_err("it does not fit");
    let reported = error.to_string();
    assert!(reported.contains(
        "model: The profile was made for the MCP266 (2x60A), the connected controller is the MCP233 (2x30A)."
    ));
    assert!(reported.contains(
        "generation: The profile was made for firmware generation 1, the connected \
                           controller has generation 3."
    ));
    assert!(reported.contains("unit.pwm_mode: The connected controller has no such setting."));
    assert!(reported.contains(
        "motor1.current.max_amps: Motor 1: maximum current 60.00 A is above the MCP233's 30.00 A."
    ));
}

#[test]
fn a_profile_gives_exactly_the_changes_it_asks_for() {
    let stored = Profile::parse(SMALL).expect("it is right");
    let here = table("mcp266", Generation::Gen1);
    let ram = here.default_image();
    let changes = stored.changes_for(&here, &ram, false).expect("it fits").wanted;
    let keys: Vec<&str> = changes.iter().map(|(key, _)| key).collect();
    assert_eq!(keys, ["limits.main_battery.max_volts", "unit.mixing"]);
    let mut after = ram.clone();
    after.merge(&changes);
    let reported: Vec<String> = diff(&here, &ram, &after)
        .iter()
        .map(|change| change.describe(here.row(&change.key).expect("a row")))
        .collect();
    assert_eq!(reported, ["Control mixing: no -> yes", "Main battery maximum: 60.0 V -> 24.3 V"]);
}

#[test]
fn what_a_real_controller_cannot_be_told_is_left_out_with_the_reason() {
    let mut stored = profile("mcp266", Generation::Gen1);
    stored.settings.set("unit.bridge_channels", SettingValue::Bool(true));
    stored.settings.set("unit.mixing", SettingValue::Bool(true));
    let here = table("mcp266", Generation::Gen1);
    let ram = here.default_image();
    let real = stored.changes_for(&here, &ram, false).expect("it fits");
    assert_eq!(real.wanted.iter().map(|(key, _)| key).collect::<Vec<_>>(), ["unit.mixing"]);
    assert_eq!(real.left_out.len(), 1);
    assert!(
        real.left_out[0]
            .to_string()
            .starts_with("Bridge channels: yes is not written. No packet serial command")
    );
    let simulated = stored.changes_for(&here, &ram, true).expect("it fits");
    assert_eq!((simulated.wanted.len(), simulated.left_out.len()), (2, 0));
}

#[test]
fn a_file_is_replaced_whole_or_not_at_all() {
    let folder = tempfile::tempdir().expect("a folder for the test");
    let path = folder.path().join("cart.json");
    let first = profile("mcp266", Generation::Gen1);
    first.save(&path).expect("the folder is writable");
    let mut second = first.clone();
    second.settings.set("unit.mixing", SettingValue::Bool(true));
    second.save(&path).expect("the folder is writable");
    assert_eq!(Profile::load(&path).expect("it was just written"), second);
    let names: Vec<_> = std::fs::read_dir(folder.path()).expect("it exists").collect();
    assert_eq!(names.len(), 1, "no temporary file stays: {names:?}");

    let lost = folder.path().join("no such folder").join("cart.json");
    let reported = first.save(&lost).expect_err("there is no such folder").to_string();
    assert!(
        reported.starts_with("Writing the profile ")
            && reported.ends_with("A file of that name is unchanged."),
        "{reported}"
    );
    let reported = Profile::load(&lost).expect_err("there is no such file").to_string();
    assert!(reported.starts_with("Reading the profile "), "{reported}");
}
