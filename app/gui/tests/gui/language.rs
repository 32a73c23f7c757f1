//! The window in another language, and what each language's file must have, and nothing else.

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

use brushwork_gui::actions::{self, Menu};
use brushwork_gui::language::{GERMAN, Language, key, said, word};
use brushwork_gui::mcp::Mcp;
use brushwork_gui::messages::LinkStatusMessage;
use brushwork_gui::model::{IndicatorState, Screen};
use brushwork_gui::motion_mind::MotionMind;
use brushwork_gui::motorvator::Motorvator;
use brushwork_gui::screens::face::Window;
use brushwork_gui::shell::messages::BarMarkMessage;
use brushwork_gui::suprmotr::SuprMotr;
use egui::Theme;
use egui::accesskit::Role;
use egui_kittest::kittest::{NodeT as _, Queryable as _};
use fluent_bundle::{FluentBundle, FluentResource};

use crate::support::bench::Bench;

/// The themes of messages that the shell shows.
const THEMES: [&str; 5] =
    ["ShellMessage", "BarMarkMessage", "DeviceRowMessage", "DeviceStateMessage", "LinkStatusMessage"];
/// Members of other themes that it shows.
const MEMBERS: [&str; 40] = [
    "ButtonMessage.ConnectTo",
    "ButtonMessage.Copies",
    "ButtonMessage.Open",
    "ButtonMessage.Run",
    "ButtonMessage.StopAll",
    "PanelMessage.Toolbar",
    "GraphMessage.CopiedPicture",
    "GraphMessage.LeftOut",
    "GraphMessage.NoSample",
    "GraphMessage.NoThread",
    "GraphMessage.NothingKept",
    "GraphMessage.Recorded",
    "GraphMessage.RecordedInPart",
    "GraphMessage.RecordedUntilLost",
    "GraphMessage.RecordedUntilOther",
    "GraphMessage.Wrote",
    "OpenFileMessage.NoDialog",
    "OpenFileMessage.TooMany",
    "WindowStatusMessage.ArmEditorFirst",
    "WindowStatusMessage.AssistantWorks",
    "WindowStatusMessage.Copied",
    "WindowStatusMessage.DownloadRuns",
    "WindowStatusMessage.GainsBack",
    "WindowStatusMessage.LibraryRunsAgain",
    "WindowStatusMessage.LinkEnded",
    "WindowStatusMessage.NoLinkThread",
    "WindowStatusMessage.NoNameAtCaret",
    "WindowStatusMessage.Replaced",
    "WindowStatusMessage.ReportIsIn",
    "WindowStatusMessage.RunHoldsSettings",
    "WindowStatusMessage.WaitsForRun",
    "WindowStatusMessage.WindingPutBack",
    "WindowStatusMessage.Disconnected",
    "WindowStatusMessage.GaveUp",
    "WindowStatusMessage.TunedNotApplied",
    "WindowStatusMessage.AsPredicted",
    "OutcomeMessage.Applied",
    "OutcomeMessage.Written",
    "PathMessage.BackupMade",
    "SaveMessage.Verified",
];
/// Members of these themes that stay English: their values are sentences without a translation, and no line is half German.
const ENGLISH: [&str; 8] = [
    "ShellMessage.NewestEvent",
    "ShellMessage.WhichAddresses",
    "ShellMessage.Searching",
    "ShellMessage.Searched",
    "LinkStatusMessage.LostArmed",
    "LinkStatusMessage.LostArmedForever",
    "LinkStatusMessage.LostWaiting",
    "LinkStatusMessage.StoppedFromOutside",
];
/// A table that the message line shows too, beside those of the window.
const OF_THE_LINK: &str = include_str!("../../../../device/link/src/messages.rs");

fn sources(folder: &Path, found: &mut Vec<PathBuf>) {
    for entry in std::fs::read_dir(folder).expect("the languages have a folder") {
        let path = entry.expect("it can be listed").path();
        match path.is_dir() {
            true => sources(&path, found),
            false => found.push(path),
        }
    }
}

/// Every key that the shell asks for, with the names of its values.
fn wanted() -> BTreeMap<String, BTreeSet<String>> {
    drop(Bench::new());
    let mut wanted = BTreeMap::new();
    let mut english = BTreeMap::new();
    let mut want = |theme: &str, text: &str| {
        let key = key(theme, text);
        let before = english.entry(key.clone()).or_insert_with(|| text.trim_end().to_lowercase()).clone();
        assert_eq!(before, text.trim_end().to_lowercase(), "two texts of the key {key}");
        wanted.insert(key, BTreeSet::new());
    };
    actions::all().for_each(|action| want("action", action.title));
    Menu::ALL.into_iter().for_each(|menu| want("menu", menu.title()));
    let windows: [&dyn Window; 4] = [&Mcp, &MotionMind, &Motorvator, &SuprMotr];
    for family in windows {
        family.actions().iter().for_each(|action| want("action", action.title));
        family.indicators().iter().for_each(|info| want("indicator", info.title));
        Screen::ALL.into_iter().for_each(|screen| want("screen", family.title(screen)));
        family.figures().iter().flat_map(|block| block.rows).for_each(|figure| want("figure", figure.label));
    }
    for state in [
        IndicatorState::Unknown,
        IndicatorState::NotApplicable,
        IndicatorState::Ok,
        IndicatorState::Active,
        IndicatorState::Warning,
        IndicatorState::Error,
    ] {
        want("state", state.word());
    }
    let mut files = Vec::new();
    sources(Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/src")), &mut files);
    for path in &files {
        let source = std::fs::read_to_string(path).expect("a source of the repository");
        for call in source.split("word(").skip(1) {
            let mut texts = call.split('"');
            let (before, theme, between) = (texts.next(), texts.next(), texts.next());
            let is_call = before.is_some_and(|text| text.trim().is_empty())
                && between.is_some_and(|text| text.trim() == ",");
            if let (true, Some(theme), Some(text)) = (is_call, theme, texts.next()) {
                want(theme, &text.replace("\\\n", "").split_whitespace().collect::<Vec<_>>().join(" "));
            }
        }
    }
    for path in files.iter().filter(|path| path.ends_with("messages.rs")) {
        wanted_messages(&std::fs::read_to_string(path).expect("a source of the repository"), &mut wanted);
    }
    wanted_messages(OF_THE_LINK, &mut wanted);
    wanted
}

/// The messages of a source that the shell shows.
fn wanted_messages(source: &str, wanted: &mut BTreeMap<String, BTreeSet<String>>) {
    let mut theme = "";
    for line in source.lines() {
        if let Some(name) = line.strip_prefix("    pub enum ") {
            theme = name.trim_end_matches(" {");
        } else if let Some((head, words)) = line.strip_suffix("\",").and_then(|line| line.split_once(" \"")) {
            let key = format!("{theme}.{}", head.split_whitespace().next().expect("a member has a name"));
            let is_said = THEMES.contains(&theme) || MEMBERS.contains(&key.as_str());
            if is_said && !ENGLISH.contains(&key.as_str()) {
                // A value may have its digits behind its name.
                let name = |rest: &str| Some(rest.split(['}', ':']).next()?.to_owned());
                let values = words.split('{').skip(1).filter_map(name);
                wanted.insert(key, values.collect());
            }
        }
    }
}

/// Every key of a file, with the names of the values in its words.
fn there(file: &str) -> BTreeMap<String, BTreeSet<String>> {
    let mut there: BTreeMap<String, BTreeSet<String>> = BTreeMap::new();
    let (mut theme, mut key) = (String::new(), String::new());
    for line in file.lines().filter(|line| !line.starts_with('#')) {
        let name = line.split(" =").next().unwrap_or_default();
        if line.starts_with(|letter: char| letter.is_alphabetic()) {
            name.clone_into(&mut theme);
        } else if let Some(member) = name.strip_prefix("    .") {
            key = format!("{theme}.{member}");
            assert!(there.insert(key.clone(), BTreeSet::new()).is_none(), "{key} stands twice");
        }
        let values = line
            .split("{ $")
            .skip(1)
            .map(|rest| rest.split([' ', '}']).next().unwrap_or_default().to_owned());
        there.entry(key.clone()).or_default().extend(values);
    }
    there.remove("");
    there
}

#[test]
fn every_language_has_each_word_of_the_shell_with_its_values_and_no_other() {
    let (wanted, there) = (wanted(), there(GERMAN));
    println!("{} words", wanted.len());
    let lacking: Vec<_> = wanted.keys().filter(|key| !there.contains_key(*key)).collect();
    let unknown: Vec<_> = there.keys().filter(|key| !wanted.contains_key(*key)).collect();
    assert!(lacking.is_empty() && unknown.is_empty(), "lacking: {lacking:#?}\nunknown: {unknown:#?}");
    assert_eq!(there, wanted);
    assert!(wanted.len() > 200, "the words are not found any more");
}

#[test]
fn every_languages_file_is_read_without_an_error() {
    let read = FluentResource::try_new(GERMAN.to_owned()).map_err(|(_, errors)| errors);
    let mut bundle = FluentBundle::new(vec!["de".parse().expect("it is one")]);
    assert_eq!(bundle.add_resource(read.expect("it parses")).map_err(|errors| errors.len()), Ok(()));
}

#[test]
fn what_a_language_lacks_and_what_is_kept_is_english() {
    assert_eq!(said(&BarMarkMessage::OneEdit), BarMarkMessage::OneEdit.to_string());
    Language::German.begin();
    assert_eq!(said(&BarMarkMessage::Edits { edits: 12 }), "12 Änderungen nicht geschrieben");
    assert_eq!(
        BarMarkMessage::Edits { edits: 12 }.to_string(),
        "12 edits not written",
        "what is kept is English"
    );
    assert_eq!((word("menu", "File"), word("menu", "Nowhere")), ("Datei".to_owned(), "Nowhere".to_owned()));
    Language::English.begin();
    assert_eq!(word("menu", "File"), "File");
}

#[test]
fn the_window_is_drawn_in_german_at_once_and_in_english_again() {
    let mut bench = Bench::sized([1024.0, 700.0], Theme::Dark);
    let is_menu =
        |bench: &Bench, title: &str| bench.harness.query_by_role_and_label(Role::Button, title).is_some();
    assert!(is_menu(&bench, "File") && bench.sees("Open a file…"));
    bench.press("View");
    bench.press("Deutsch");
    bench.pass_ms(200);
    for menu in ["Datei", "Bearbeiten", "Gerät", "Fehlersuche", "Ansicht", "Kurven", "Hilfe"] {
        assert!(is_menu(&bench, menu), "{menu}");
    }
    for button in ["Datei öffnen…", "Sicherungen…", "Skript schreiben", "Alles anhalten", "Gerätestatus"]
    {
        assert!(bench.harness.query_by_role_and_label(Role::Button, button).is_some(), "{button}");
    }
    assert!(bench.sees("Einstellungen: kein Regler, kein Profil offen"));
    assert!(bench.sees("ESTP: unbekannt"));
    assert!(bench.sees("Simuliert: MCP266: in diesem Programm, verfügbar"));
    assert!(bench.sees_part("Kein Regler ist verbunden."));
    bench.harness.set_render_cursor(false);
    bench.harness.snapshot("german");
    bench.press("Gerät");
    let item = bench.harness.get_by_role_and_label(Role::MenuItem, "Einstellungen lesen…");
    assert!(item.accesskit_node().is_disabled());
    bench.press("Gerät");
    bench.press("Ansicht");
    bench.press("English");
    bench.pass_ms(200);
    assert!(is_menu(&bench, "File") && bench.sees("ESTP: unknown"));
}

#[test]
fn device_list_and_message_line_are_german_too_with_figures_as_germans_write_them() {
    let mut bench = Bench::new();
    bench.press("View");
    bench.press("Deutsch");
    bench.pass_ms(200);
    bench.press("Verbinden");
    bench.pass_ms(1500);
    let connected =
        "Hinweis: Verbunden mit MCP266 an sim:mcp266, Adresse 0x80, Firmware 1.0.0 (Generation 1).";
    assert!(bench.sees(connected), "{:?}", bench.said());
    assert!(bench.sees_part(", verbunden") && bench.sees("Trennen"));
    bench.press("PWM");
    bench.press("Arm");
    bench.pass_ms(500);
    assert!(bench.sees_part(", verbunden, scharf"));
    bench.key(egui::Key::Escape);
    bench.pass_ms(500);
    assert!(bench.sees_part("Hinweis: Angehalten. Der Haltebefehl war nach 0"), "{:?}", bench.said());
    let measured = LinkStatusMessage::Stopped { milliseconds: 1.087_31 };
    let stopped = said(&measured);
    assert!(stopped.contains(" nach 1,1 ms auf der Leitung"), "{stopped}");
    bench.press("Trennen");
    bench.pass_ms(1000);
    assert!(bench.sees_part("Hinweis: Getrennt."));
    assert!(bench.said().contains(&"Disconnected.".to_owned()), "what is kept is English");
}

/// A value of a translated message that is itself a message without a translation would be the other half of a line.
#[test]
fn no_line_is_half_german() {
    let mut bench = Bench::new();
    bench.press("View");
    bench.press("Deutsch");
    bench.pass_ms(200);
    let stop = bench.harness.get_by_role_and_label(Role::Button, "Alles anhalten");
    assert_eq!(stop.accesskit_node().data().keyboard_shortcut(), Some("Leertaste oder Esc"));
    // Why something cannot be done is told in English, and so is what it is called there.
    bench.key_with(egui::Modifiers { shift: true, ..egui::Modifiers::COMMAND }, egui::Key::P);
    bench.pass_ms(200);
    bench.harness.get_by_role_and_label(Role::TextInput, "Befehl").type_text("Encoder M2 nullen");
    bench.pass_ms(200);
    bench.key(egui::Key::Enter);
    bench.pass_ms(300);
    assert!(
        bench.sees("Warning: Device: Zero Encoder M2: No controller is connected."),
        "{:?}",
        bench.said()
    );
    // A lost link is told in one language from end to end.
    bench.press("Verbinden");
    bench.pass_ms(1500);
    bench.act(&brushwork_plant::world::WorldAction::Unplug { unplugged: true });
    bench.pass_ms(3000);
    let line = bench.said().first().cloned().unwrap_or_default();
    assert!(bench.sees(&format!("Error: {line}")), "{line}");
    // The list of addresses is no wider than in English.
    bench.press("Ansicht");
    bench.press("English");
    bench.pass_ms(200);
    let width =
        |bench: &Bench| bench.harness.get_by_role_and_label(Role::Button, "Device Status").rect().width();
    let english = width(&bench);
    bench.press("View");
    bench.press("Deutsch");
    bench.pass_ms(300);
    let german = bench.harness.get_by_role_and_label(Role::Button, "Gerätestatus").rect().width();
    assert!((german - english).abs() < 1.0, "{german} and {english} points");
}
