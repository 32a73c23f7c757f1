//! Recipes: each for every model and firmware, with what it names; and a home switch from its wiring to what it does.

use std::collections::{BTreeMap, BTreeSet};

use brushwork_gui::family::recipe::{Goal, Live, Recipe, Recipes as _};
use brushwork_gui::family::{self, Family as _};
use brushwork_gui::mcp::Mcp;
use brushwork_gui::mcp::recipes::McpRecipes;
use brushwork_gui::model::{Section, Sheet};
use brushwork_link::settings::SettingsTable;
use brushwork_mcp_sim::controller::{Controller, ControllerConfig};
use brushwork_mcp_wire::models::{Family, MODELS, Model, lookup};
use brushwork_mcp_wire::packet_serial::Generation;
use brushwork_plant::world::{PinSignal, WorldAction};
use egui::Theme;
use egui_kittest::kittest::Queryable as _;

use crate::support::bench::Bench;

/// What a controller has no setting for, by its kind and generation.
fn cannot(model: &Model, generation: Generation, job: Goal) -> bool {
    let is_early = matches!(generation, Generation::Gen1 | Generation::Gen2);
    let has_inputs = model.control_pins.contains(&"S4");
    match (model.family, job) {
        (Family::RoboClaw, Goal::Home) => !has_inputs,
        (Family::RoboClaw, Goal::Limit) => is_early || !has_inputs,
        (Family::RoboClaw, Goal::Brake) => generation == Generation::Gen1 || !has_inputs,
        (Family::RoboClaw, Goal::TimeOut) => generation == Generation::Gen1,
        _ => false,
    }
}

#[test]
fn every_setting_and_option_that_a_recipe_names_exists_for_each_model_and_firmware() {
    crate::support::install_families();
    let known = McpRecipes;
    let mut offered: BTreeMap<String, usize> = BTreeMap::new();
    let (mut optional, mut seen, mut values) = (BTreeSet::new(), BTreeSet::new(), 0);
    let name = |recipe: &Recipe| format!("{:?}: {}", recipe.job, recipe.text);
    for model in MODELS {
        for generation in Generation::ALL {
            let table = SettingsTable::new(brushwork_mcp_client::subject(model, generation));
            let encoder_pin = |motor, phase| known.encoder_pin(&table, motor, phase);
            for (job, recipe) in known.of(&table) {
                let Some(recipe) = recipe else {
                    assert!(cannot(model, generation, job), "{} {generation:?}: no {job:?}", model.key);
                    continue;
                };
                *offered.entry(name(recipe)).or_default() += 1;
                let able = recipe.pin_use().map(|wanted| known.able_pins(&table, wanted)).unwrap_or_default();
                for answers in recipe.every_answer((known.motors(&table), &able)) {
                    let settings = recipe.settings(&table, &answers, &encoder_pin).expect("it is offered");
                    for (key, value) in settings {
                        let row = table.row(&key).expect("the recipe found it");
                        row.check(value).unwrap_or_else(|why| panic!("{} {generation:?}: {why}", model.key));
                        values += 1;
                    }
                    for key in recipe.rows {
                        let key = recipe.fill(key, &answers, &encoder_pin);
                        assert!(table.row(&key).is_some(), "{} {generation:?}: {key}", model.key);
                    }
                    for key in recipe.rows_if_there {
                        optional.insert(*key);
                        if table.row(&recipe.fill(key, &answers, &encoder_pin)).is_some() {
                            seen.insert(*key);
                        }
                    }
                    assert!(!recipe.keys(&table, &answers, &encoder_pin).is_empty());
                }
            }
        }
    }
    assert_eq!(offered.len(), known.all().len(), "each is for some controller: {offered:#?}");
    assert_eq!(optional, seen, "each is there on some controller");
    println!("{values} values over {} models", MODELS.len());
    assert!(values > 1000, "{values}");
}

#[test]
fn what_a_recipe_shows_of_a_controller_is_something_that_its_family_tells() {
    crate::support::install_families();
    for family in family::all() {
        let Some(known) = family.recipes() else { continue };
        for recipe in known.all() {
            is_told(*family, recipe.live, recipe.job);
            for text in [recipe.text, recipe.consequence] {
                assert!(text.ends_with('.') && text.len() > 30, "{text}");
            }
            assert!(!recipe.wiring.wires.is_empty(), "{:?}", recipe.job);
        }
    }
    assert!(Mcp.recipes().is_some());
}

fn is_told(family: &dyn family::Family, live: Live, job: Goal) {
    match live {
        Live::Nothing | Live::Pin | Live::Board => {}
        Live::Channels(channels) => {
            assert!(channels.iter().all(|channel| family.channels().contains(channel)), "{job:?}");
        }
        Live::Indicators(names) => {
            let is_known = |name: &&str| family.indicators().iter().any(|info| info.short == *name);
            assert!(names.iter().all(is_known), "{job:?}");
        }
        Live::All(all) => all.iter().for_each(|live| is_told(family, *live, job)),
    }
}

#[test]
fn the_pins_the_encoders_and_the_next_step_lead_to_their_recipes() {
    let mut bench = Bench::new();
    bench.connect();
    bench.pass_ms(4000);
    bench.press("Step Switches and homing: not needed");
    bench.press("Go to Recipes: Home switch");
    bench.pass_ms(2000);
    assert!(bench.sees_part("Wiring: Switch, contact to "));
    bench.press("Section Encoders");
    bench.press("Recipe: Encoder");
    assert!(bench.sees_part("Wiring: Encoder, A to ENC1A"));
    // It stands below what the list shows.
    bench.button("Section DIN4/AN4/P4").scroll_to_me();
    bench.pass_ms(600);
    bench.press("Section DIN4/AN4/P4");
    bench.press("Recipes…");
    assert_eq!(chosen_pin(&mut bench), 4);
    assert_eq!(bench.model().front.general.section, Section::Recipes);
}

fn on_recipes(mut bench: Bench) -> Bench {
    bench.connect();
    bench.pass_ms(3000);
    bench.press("General Settings");
    bench.pass_ms(2000);
    bench.press("Section Recipes");
    bench.pass_ms(500);
    bench
}

/// The pin that the recipe has chosen, from 1.
fn chosen_pin(bench: &mut Bench) -> usize {
    bench.model().front.general.recipes.answers.pin
}

#[test]
fn a_home_switch_is_set_with_its_consequence_told_before_it_is_written() {
    let mut bench = on_recipes(Bench::new());
    let pin = chosen_pin(&mut bench);
    assert!(pin > 0);
    bench.act(&WorldAction::SetPin { pin: pin - 1, signal: PinSignal::Volts { volts: 0.0 } });
    assert!(bench.sees_part("measures nothing that is read yet"));
    assert!(bench.sees_part("Wiring: Switch, contact to "));
    bench.press("Make these the wanted settings");
    bench.pass_ms(300);
    let edits = bench.model().front.settings.unit().expect("it is there").edits().clone();
    assert!(edits.get(&format!("pin.{pin}.min_action")).is_some(), "{edits:?}");
    assert!(bench.sees("Wanted so, not written yet"));
    assert!(bench.sees_part("is not known before its type is written. If that is at its low end, the position of motor 1 becomes 0 at once."));
    bench.press("Write settings");
    bench.pass_ms(300);
    assert_eq!(bench.model().front.general.sheet, Some(Sheet::Write));
    assert!(bench.sees_part("the position of motor 1 becomes 0 at once."), "told again before it is written");
    bench.press("Write to controller");
    bench.pass_ms(3000);
    assert!(bench.sees_part("is at its low end now"), "{:?}", bench.said());
    assert!(bench.sees("It is set so"));
}

#[test]
fn an_action_at_a_switch_that_is_closed_now_is_told_as_happening_at_once() {
    let mut bench = on_recipes(Bench::new());
    let pin = chosen_pin(&mut bench);
    bench.act(&WorldAction::SetPin { pin: pin - 1, signal: PinSignal::Volts { volts: 2.5 } });
    bench.press("Make these the wanted settings");
    bench.press("Write settings");
    bench.press("Write to controller");
    bench.pass_ms(3000);
    bench.press("Motor 2");
    bench.press("Make these the wanted settings");
    bench.pass_ms(500);
    assert!(bench.sees_part("Once ") && bench.sees_part("the position of motor 2 becomes 0."));
    bench.act(&WorldAction::SetPin { pin: pin - 1, signal: PinSignal::Volts { volts: 0.0 } });
    bench.pass_ms(1000);
    assert!(bench.sees_part("as soon as this is written, the position of motor 2 becomes 0."));
    bench.press("Write settings");
    bench.pass_ms(1000);
    assert!(bench.sees_part("as soon as this is written, the position of motor 2 becomes 0."));
}

#[test]
fn every_recipe_can_be_looked_at_and_sets_edits_and_nothing_else() {
    for (model, generation) in [
        ("mcp266", Generation::Gen2),
        ("roboclaw-2x30a", Generation::Gen4),
        ("roboclaw-2x15a", Generation::Gen1),
    ] {
        let Some(model) = lookup(model) else { panic!("{model} is listed") };
        let config = ControllerConfig { model, generation, ..ControllerConfig::default() };
        let unit = Controller::new(config).expect("the configuration is sound");
        let mut bench = on_recipes(Bench::of_sized(unit, [1024.0, 700.0], Theme::Light));
        let mut set = 0;
        for job in Goal::USUAL {
            bench.press(job.title());
            bench.pass_ms(300);
            if bench.harness.query_by_label("Make these the wanted settings").is_some() {
                bench.button("Make these the wanted settings").click();
                bench.pass_ms(300);
                set += 1;
            }
        }
        assert!(set >= 3, "{}: {set}", model.key);
        assert!(bench.both_stand());
        let edits = bench.model().front.settings.unit().expect("it is there").edits().len();
        assert!(edits >= 3, "{}: {edits}", model.key);
        assert_eq!(bench.model().front.general.section, Section::Recipes);
    }
}
