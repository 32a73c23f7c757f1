//! Recipes of the Motion Mind, the SuprMotr and the MotorVator: what they name exists, and what comes of them is told before it is written.

use std::collections::BTreeSet;

use brushwork_gui::family::Family as _;
use brushwork_gui::family::path::Place;
use brushwork_gui::family::recipe::{Live, Recipes};
use brushwork_gui::model::screen::Screen;
use brushwork_gui::model::{Section, Sheet};
use brushwork_gui::motion_mind::MotionMind;
use brushwork_gui::motion_mind::recipes::MindRecipes;
use brushwork_gui::motorvator::Motorvator;
use brushwork_gui::suprmotr::SuprMotr;
use brushwork_link::settings::{SettingValue, SettingsTable};
use brushwork_motion_mind_client::MotionMindDriver;
use brushwork_motion_mind_sim::{Mode, MotionMindConfig, pin};
use brushwork_motion_mind_wire::{FUNCTION_BITS, FUNCTION2_BITS, REGISTERS};
use brushwork_motorvator::sim_spec::{MotorvatorSpec, library};
use brushwork_motorvator_client::MotorvatorDriver;
use brushwork_plant::machine::Machine as _;
use brushwork_plant::world::{PinSignal, WorldAction};
use brushwork_script::mecc::reference::reference;
use brushwork_suprmotr::sim_spec::SuprMotrSpec;
use brushwork_suprmotr_client::SuprMotrDriver;
use brushwork_suprmotr_wire::Mnemonic;
use egui::Theme;
use egui_kittest::kittest::Queryable as _;

use crate::support::alone::{LIMIT, alone};
use crate::support::bench::{Bench, FRAME};
use crate::support::one::One;

type Window = &'static dyn brushwork_gui::family::Family;
type Known = fn(&str) -> bool;

/// Each family with its settings, and whether a word of its sentences is a name that it knows; other words are nothing that could be wrong.
fn families() -> [(Window, SettingsTable, Known); 3] {
    [
        (&MotionMind, SettingsTable::new(brushwork_motion_mind_client::subject(5)), is_of_motion_mind),
        (&SuprMotr, SettingsTable::new(brushwork_suprmotr_client::subject()), is_of_suprmotr),
        (&Motorvator, SettingsTable::new(brushwork_motorvator_client::subject()), is_of_motorvator),
    ]
}

fn is_capital(word: &str) -> bool {
    let has_letters = word.chars().filter(char::is_ascii_uppercase).count() >= 2;
    has_letters
        && word.chars().all(|letter| letter.is_ascii_uppercase() || letter.is_ascii_digit() || letter == '_')
}

/// Registers, their bits, and pins (Motion Mind manual 3.5 and figures 18 and 20).
fn is_of_motion_mind(word: &str) -> bool {
    const PINS: &[&str] = &[
        "SW1", "MODE0", "MODE1", "MODE2", "POS_LIM", "NEG_LIM", "_BRAKE", "ANA_FBCK", "ANA_MODE", "ANA_DIR",
        "ANA_CON", "BTN_MODE", "RCPOS", "TXEN", "RX", "TX", "RS",
    ];
    let is_bit = |word: &str| FUNCTION_BITS.iter().chain(FUNCTION2_BITS).any(|bit| bit.name == word);
    !is_capital(word)
        || PINS.contains(&word)
        || is_bit(word)
        || REGISTERS.iter().any(|known| known.name == word)
}

/// Commands, with a number or without (SuprMotr manual, command reference).
fn is_of_suprmotr(word: &str) -> bool {
    let letters = word.trim_end_matches(|digit: char| digit.is_ascii_digit());
    let is_command = (0..=u8::MAX).filter_map(Mnemonic::from_number).any(|known| known.name() == letters);
    !is_capital(word) || is_command || ["RS", "EEPROM"].contains(&letters)
}

/// Statements and events of MeccCode, which have capitals inside.
fn is_of_motorvator(word: &str) -> bool {
    const OF_OTHERS: &[&str] = &["MotorVator", "MinWait", "MaxWait", "HoldCurrent"];
    let is_name = word.chars().skip(1).any(|letter| letter.is_ascii_uppercase());
    let all = reference();
    let is_word = all.statements.iter().any(|known| known.syntax.contains(word));
    !is_name || is_word || OF_OTHERS.contains(&word) || all.events.iter().any(|event| event.name == word)
}

#[test]
fn every_setting_screen_and_name_of_a_recipe_exists_for_its_controller() {
    alone(
        "family_recipes::every_setting_screen_and_name_of_a_recipe_exists_for_its_controller",
        LIMIT,
        || {
            brushwork_link::install(&[&MotionMindDriver, &SuprMotrDriver, &MotorvatorDriver]);
            let mut values = 0;
            for (family, table, knows) in families() {
                let recipes = family.recipes().expect("it has recipes");
                let offered = recipes.of(&table);
                assert_eq!(offered.iter().filter(|(_, found)| found.is_some()).count(), recipes.all().len());
                for (goal, recipe) in offered {
                    let name = format!("{} {goal:?}", family.name());
                    assert_ne!(
                        recipe.is_some(),
                        recipes.without(goal).is_some(),
                        "{name}: a recipe, or why there is none"
                    );
                    let texts = recipe.map_or(vec![], |recipe| vec![recipe.text, recipe.consequence]);
                    for text in texts.into_iter().chain(recipes.without(goal)) {
                        assert!(text.ends_with('.') && text.len() > 25, "{text}");
                        let is_part = |letter: char| letter.is_ascii_alphanumeric() || letter == '_';
                        for word in text.split(|letter| !is_part(letter)) {
                            assert!(knows(word), "{name}: there is no {word}: {text}");
                        }
                    }
                    match recipes.goes_on(goal) {
                        Some(Place::Screen(screen)) => assert!(has_screen(family, screen), "{name}"),
                        Some(Place::Drawer(screen, tab)) => {
                            assert!(family.tabs(screen).contains(&tab), "{name}");
                        }
                        Some(place) => panic!("{name}: {place:?}"),
                        None => {}
                    }
                    let Some(recipe) = recipe else { continue };
                    assert!(!recipe.wiring.wires.is_empty(), "{name}");
                    is_told(family, recipe.live, &name);
                    for answers in recipe.every_answer((1, &[])) {
                        let settings =
                            recipe.settings(&table, &answers, &|_, _| None).expect("it is offered");
                        values += settings.len();
                        for (key, value) in settings {
                            table
                                .row(&key)
                                .expect("the recipe found it")
                                .check(value)
                                .expect("it is allowed");
                        }
                        for key in recipe.rows.iter().chain(recipe.rows_if_there) {
                            assert!(table.row(key).is_some(), "{name}: {key}");
                        }
                    }
                }
            }
            println!("{values} values");
            assert!(values >= 30, "{values}");
        },
    );
}

fn has_screen(family: Window, screen: Screen) -> bool {
    family.screens(None, &|_| None).contains(&screen)
}

/// What is shown live is something that the family tells.
fn is_told(family: Window, live: Live, name: &str) {
    match live {
        Live::Nothing | Live::Board => {}
        Live::Pin => panic!("{name}: it has no pins that are read"),
        Live::Channels(channels) => {
            assert!(channels.iter().all(|channel| family.channels().contains(channel)), "{name}");
        }
        Live::Indicators(shorts) => {
            let is_known = |short: &&str| family.indicators().iter().any(|info| info.short == *short);
            assert!(shorts.iter().all(is_known), "{name}: {shorts:?}");
        }
        Live::All(all) => all.iter().for_each(|live| is_told(family, *live, name)),
    }
}

// ---- Motion Mind ----

/// A window on the recipes of a Motion Mind in a mode.
fn on_recipes(mode: Mode, size: [f32; 2], theme: Theme) -> Bench {
    let mut bench = Bench::with_minds_sized(vec![MotionMindConfig::new(mode)], size, theme);
    bench.pass(FRAME * 2);
    bench.choose("Simulated model", "Motion Mind 3");
    bench.connect();
    bench.pass_ms(3000);
    bench.press("Registers");
    bench.pass_ms(2000);
    bench.press("Recipes");
    bench.pass_ms(500);
    bench
}

fn edited(bench: &mut Bench) -> BTreeSet<String> {
    let unit = bench.model().front.settings.unit().expect("it is there");
    unit.edits().iter().map(|(key, _)| key.to_owned()).collect()
}

#[test]
fn virtual_limits_beside_the_motor_are_told_before_they_are_written() {
    let mut bench = on_recipes(Mode::SerialPid, [1280.0, 800.0], Theme::Dark);
    assert!(bench.sees_part("Switches now: mode 4 (serial PID); binary protocol"));
    bench.press("Virtual limits");
    bench.pass_ms(500);
    assert!(bench.sees_part("Wiring: Encoder, +5 V to J6 P1 5V"));
    bench.press("Make these the wanted settings");
    bench.pass_ms(500);
    assert!(bench.sees("The motor stands at 0 counts, between the virtual limits of -100000 and 100000."));
    bench
        .model()
        .front
        .settings
        .unit_mut()
        .expect("it is there")
        .set("register.vnlimit", SettingValue::Int(200));
    bench.pass_ms(500);
    let below = "The motor stands at 0 counts, below the virtual limit of 200: as soon as this is written, nothing drives it further down.";
    assert!(bench.sees(below));
    bench.press("Write settings");
    bench.pass_ms(300);
    assert_eq!(bench.model().front.general.sheet, Some(Sheet::Write));
    assert!(bench.sees(below), "told again before it is written");
    bench.press("Write to controller");
    bench.pass_ms(3000);
    assert!(bench.sees("It is set so") && !bench.sees(below));
    assert!(bench.sees("Negative virtual limit now: warning"), "the limit acts");
}

#[test]
fn a_stick_and_a_contact_are_seen_live_and_lead_to_their_screen() {
    let mut bench = on_recipes(Mode::RadioControl, [1280.0, 800.0], Theme::Dark);
    bench.press("R/C stick");
    let pulse = PinSignal::Pulse { microseconds: 1500.0 };
    bench.minds.with(|bus| bus.apply(0, &WorldAction::SetPin { pin: pin::INDEX_RC, signal: pulse }));
    bench.pass_ms(2000);
    assert!(bench.sees_part("R/C Pulse: 1.500 ms"), "{:?}", bench.said());
    bench.press("Position");
    bench.press("Make these the wanted settings");
    bench.pass_ms(500);
    assert!(bench.sees_part("Another feedback is another position: as soon as this is written"));
    assert!(edited(&mut bench).contains("function.rcpos_encfdbck"));
    bench.press("Emergency stop");
    bench.pass_ms(500);
    let brake = WorldAction::SetPin { pin: pin::BRAKE, signal: PinSignal::Volts { volts: 0.0 } };
    assert!(bench.sees("Brake input low: bridge off now: not active"));
    bench.minds.with(|bus| bus.apply(0, &brake));
    bench.pass_ms(1000);
    assert!(bench.sees("Brake input low: bridge off now: error"), "{:?}", bench.said());
    bench.press("Go to Inputs and R/C");
    assert_eq!(bench.model().screen, Screen::Inputs);
}

#[test]
fn every_recipe_of_a_motion_mind_can_be_looked_at_and_sets_edits_and_nothing_else() {
    let mut bench = on_recipes(Mode::AnalogPid, [1024.0, 700.0], Theme::Light);
    let sent = bench.minds.with(|bus| bus.motion_minds()[0].stored(4));
    let mut set = 0;
    for goal in MindRecipes.goals() {
        bench.press(goal.title());
        bench.pass_ms(300);
        if bench.harness.query_by_label("Make these the wanted settings").is_some() {
            bench.button("Make these the wanted settings").click();
            bench.pass_ms(300);
            set += 1;
        }
    }
    assert!(set >= 4, "{set}");
    assert!(edited(&mut bench).len() >= 8, "{:?}", edited(&mut bench));
    assert_eq!(bench.minds.with(|bus| bus.motion_minds()[0].stored(4)), sent, "nothing was written");
    assert!(
        bench.sees_part("A Motion Mind 3 has no serial time-out") || {
            bench.press("Serial time-out");
            bench.sees_part("A Motion Mind 3 has no serial time-out")
        }
    );
    bench.press("All registers");
    assert_ne!(bench.model().front.general.section, Section::Recipes);
    assert!(bench.sees("PTERM in RAM: 6000"), "written it is not");
}

// ---- SuprMotr ----

#[test]
fn the_level_of_limit_switches_is_told_by_what_it_does_now() {
    alone("family_recipes::the_level_of_limit_switches_is_told_by_what_it_does_now", LIMIT, || {
        let folder = tempfile::tempdir().expect("a temporary folder can be made");
        let bus =
            SuprMotrSpec::parse("suprmotr-v9,seed=0").expect("it is a board").bus().expect("it is sound");
        let mut bench = One::new(&folder, (&SuprMotrDriver, &SuprMotr), bus, "sim:suprmotr-v9");
        bench.app().open("sim:suprmotr-v9");
        bench.pass_ms(5000);
        bench.press("General Settings");
        bench.pass_ms(3000);
        bench.press("Section Recipes");
        bench.pass_ms(500);
        assert!(bench.sees("Wiring: Switch, - end to J4 7 neg."));
        assert!(bench.sees("Negative limit switch now: not active"));
        bench.press("On while high (LH)");
        bench.press("Make these the wanted settings");
        bench.pass_ms(500);
        // Both contacts are open, which is high.
        assert!(bench.sees("The negative limit switch counts as on now: as soon as this is written, the motor does not move in the negative direction."));
        assert!(bench.sees("The positive limit switch counts as on now"));
        bench.press("On while low (LL)");
        bench.press("Make these the wanted settings");
        bench.pass_ms(500);
        assert!(!bench.sees("counts as on now"), "nothing is edited then");
        bench.press("Home switch");
        bench.pass_ms(300);
        bench.press("Go to Motion: Home");
        bench.pass_ms(500);
        assert_eq!(bench.app().model.screen, Screen::Position);
        assert!(bench.sees("Find home"));
    });
}

#[test]
fn every_recipe_of_a_motorvator_can_be_looked_at_and_shows_its_inputs_live() {
    alone(
        "family_recipes::every_recipe_of_a_motorvator_can_be_looked_at_and_shows_its_inputs_live",
        LIMIT,
        || {
            let folder = tempfile::tempdir().expect("a temporary folder can be made");
            let spec = MotorvatorSpec::parse("motorvator-3,seed=0").expect("it is a board");
            let board = spec.board(library()).expect("the preset is sound");
            let mut bench = One::new(&folder, (&MotorvatorDriver, &Motorvator), board, "sim:motorvator-3");
            bench.app().open("sim:motorvator-3");
            bench.pass_ms(3000);
            bench.press("Stepper Settings");
            bench.pass_ms(2000);
            bench.press("Section Recipes");
            bench.pass_ms(500);
            assert!(bench.sees("Host library silent now: not active"));
            for goal in Motorvator.recipes().expect("it has recipes").goals() {
                bench.press(goal.title());
                bench.pass_ms(300);
            }
            bench.press("Input lines");
            bench.pass_ms(300);
            assert!(bench.sees("Input 3 changed now: not active"));
            let closed = WorldAction::SetPin { pin: 2, signal: PinSignal::Volts { volts: 0.0 } };
            bench.line.with(|board| board.apply(0, &closed));
            bench.pass_ms(1000);
            assert!(bench.sees("Input 3 changed now: active"));
        },
    );
}
