//! Several boards in the window: their addresses, one profile for all, a row for each on whatever link, numbers written raw, and a firmware
//! whose commands are learned anew.

use std::time::Duration;

use brushwork_core::keep::UnitId;
use brushwork_gui::focus::Region;
use brushwork_gui::model::Arming;
use brushwork_mcp_sim::controller::{Bus, Controller, ControllerConfig, Quirks};
use brushwork_mcp_wire::models;
use brushwork_mcp_wire::packet_serial::{Address, Generation, number};
use brushwork_motion_mind_sim::{Mode, MotionMindConfig};
use brushwork_plant::machine::StreamIndex;
use brushwork_plant::world::WorldAction;
use brushwork_values::Motor;
use egui::accesskit::Role;
use egui::{Key, Modifiers};
use egui_kittest::kittest::{NodeT as _, Queryable as _};

use crate::support::bench::{Bench, SECOND};

fn board(address: u8) -> Controller {
    let model = models::lookup("roboclaw-2x30a").expect("it is in the list");
    let address = Address::new(address).expect("an address of the family");
    let config = ControllerConfig { address, generation: Generation::Gen4, ..ControllerConfig::of(model) };
    Controller::new(config).expect("the default world is sound")
}

/// A board that its owner has given another limit of the main battery, in 0.1 V.
fn limited(address: u8, tenths: u16) -> Controller {
    let unit = board(address);
    let mut settings = unit.settings();
    settings.battery.main_max_tenths = tenths;
    let config = ControllerConfig { settings: Some(settings), ..unit.config().clone() };
    Controller::new(config).expect("the default world is sound")
}

/// Boards on one line. Those from `off` on have no power yet.
fn rover(addresses: &[u8], off: usize) -> Bench {
    let boards = addresses.iter().map(|address| board(*address)).collect();
    let bench = Bench::of_bus(Bus::new(boards, StreamIndex::Uart1).expect("TTL lines can be shared"));
    for unit in off..addresses.len() {
        power(&bench, unit, true, false);
    }
    bench
}

fn power(bench: &Bench, unit: usize, was: bool, on: bool) {
    if was != on {
        bench.act_on(unit, &WorldAction::Power { on });
    }
}

/// The addresses at which the boards answer now, and those that they answer at after a power cycle.
fn addresses(bench: &Bench) -> Vec<(u8, u8)> {
    let of = |unit: &Controller| (unit.settings().unit.address, unit.stored_settings().unit.address);
    bench.line.with(|bus| bus.controllers().iter().map(of).collect())
}

fn from_menu(bench: &mut Bench, item: &str) {
    bench.press("Device");
    bench.button(item).scroll_to_me();
    bench.pass_ms(300);
    bench.press(item);
    bench.pass_ms(300);
}

/// Replaces what stands in a field.
fn type_into(bench: &mut Bench, field: &str, text: &str) {
    bench.focus_label(field);
    bench.key_with(Modifiers::COMMAND, Key::A);
    bench.harness.event(egui::Event::Text(text.to_owned()));
    bench.pass_ms(200);
}

/// Lets time pass until something can be read.
#[track_caller]
fn wait_for(bench: &mut Bench, part: &str) {
    for _ in 0..600 {
        if bench.sees_part(part) {
            return;
        }
        bench.pass_ms(100);
    }
    let labels = bench.harness.query_all_by_role(Role::Label);
    let texts: Vec<_> = labels.filter_map(|node| node.accesskit_node().value()).collect();
    panic!("{part:?} is not to be read: {texts:#?}, said {:?}", bench.said());
}

fn is_enabled(bench: &Bench, button: &str) -> bool {
    !bench.button(button).accesskit_node().is_disabled()
}

fn begin_addressing(bench: &mut Bench, list: &str) {
    from_menu(bench, "Give Boards Their Addresses…");
    type_into(bench, "Addresses to give", list);
    bench.press("Begin");
}

// ---- addresses ----

#[test]
fn boards_get_their_addresses_one_after_the_other_with_one_yes_each() {
    let mut bench = rover(&[0x80, 0x80, 0x80], 1);
    bench.connect();
    from_menu(&mut bench, "Give Boards Their Addresses…");
    assert_eq!(bench.model().addressing.typed, "0x80-0x84", "a rover's, from the factory's address on");
    type_into(&mut bench, "Addresses to give", "0x80-0x82");
    bench.press("Begin");
    assert!(
        bench.sees_part("Plug in the board that is to have 0x81."),
        "{:?} {:?}",
        bench.said(),
        bench.model().addressing
    );

    bench.press("Find the board");
    wait_for(&mut bench, "RoboClaw 2x30A at 0x80 gets the address 0x81");
    assert_eq!(addresses(&bench)[0], (0x80, 0x80), "nothing is written before somebody says yes");
    bench.press("Give it 0x81");
    wait_for(&mut bench, "The RoboClaw 2x30A answers at 0x81.");
    assert_eq!(addresses(&bench)[0].1, 0x81, "it is saved");

    bench.press("Find the board");
    wait_for(&mut bench, "that waits for an address. Connect it");
    power(&bench, 1, false, true);
    bench.press("Find the board");
    wait_for(&mut bench, "gets the address 0x82");
    bench.press("Give it 0x82");
    wait_for(&mut bench, "The RoboClaw 2x30A answers at 0x82.");

    power(&bench, 2, false, true);
    bench.press("Find the board");
    wait_for(&mut bench, "RoboClaw 2x30A at 0x80 stays at 0x80");
    bench.press("Give it 0x80");
    wait_for(&mut bench, "All 3 boards have their addresses.");
    bench.pass_ms(5000);
    assert_eq!(addresses(&bench), [(0x81, 0x81), (0x82, 0x82), (0x80, 0x80)]);
    let mut found: Vec<u8> = bench.model().front.link.units.iter().map(|unit| unit.address).collect();
    found.sort_unstable();
    assert_eq!(found, [0x80, 0x81, 0x82], "all are shown in the end");
    assert!(!bench.model().addressing.is_running());
}

#[test]
fn two_boards_at_one_address_are_not_given_another_together() {
    let mut bench = rover(&[0x80, 0x80], 1);
    bench.connect();
    begin_addressing(&mut bench, "0x81-0x82");
    power(&bench, 1, false, true);
    bench.press("Find the board");
    bench.pass_ms(12_000);
    assert!(!bench.sees("Give it 0x81"), "{:?}", bench.model().addressing.said);
    let (gravity, text) = bench.model().addressing.said.clone().expect("it is said");
    assert_eq!(gravity, brushwork_gui::model::Gravity::Error, "{text}");
    assert_eq!(addresses(&bench), [(0x80, 0x80), (0x80, 0x80)]);
}

#[test]
fn an_address_that_another_board_has_is_refused_and_of_several_that_wait_one_is_chosen() {
    let mut bench = rover(&[0x80, 0x83], 2);
    bench.connect();
    begin_addressing(&mut bench, "0x81,0x81");
    assert!(
        bench.sees_part("An address is named twice"),
        "{:?} {:?}",
        bench.said(),
        bench.model().addressing
    );
    for (list, why) in
        [("these", "These are no addresses"), ("0x81,0x90", "No family of controllers has all")]
    {
        type_into(&mut bench, "Addresses to give", list);
        bench.press("Begin");
        assert!(bench.sees_part(why), "{list}");
    }
    type_into(&mut bench, "Addresses to give", "0x80");
    bench.press("Begin");
    bench.press("Find the board");
    wait_for(&mut bench, "0x80 was not given to another unit");
    bench.press("End");
    type_into(&mut bench, "Addresses to give", "0x84-0x85");
    bench.press("Begin");
    bench.press("Find the board");
    wait_for(&mut bench, "wait for an address, at 0x80, 0x83");
    assert_eq!(addresses(&bench), [(0x80, 0x80), (0x83, 0x83)]);
    bench.press("The one at 0x83");
    wait_for(&mut bench, "RoboClaw 2x30A at 0x83 gets the address 0x84");
    bench.press("Give it 0x84");
    wait_for(&mut bench, "The RoboClaw 2x30A answers at 0x84.");
    assert_eq!(addresses(&bench), [(0x80, 0x80), (0x84, 0x84)]);
}

#[test]
fn boards_that_have_an_address_of_the_list_already_are_shown_and_not_asked_for() {
    let mut bench = rover(&[0x80, 0x81], 2);
    bench.connect();
    begin_addressing(&mut bench, "0x81-0x82");
    let places = bench.model().addressing.places().to_vec();
    assert_eq!(places[0].has.as_deref(), Some("RoboClaw 2x30A"));
    assert!(bench.sees_part("Plug in the board that is to have 0x82."));
}

#[test]
fn over_usb_a_board_answers_at_every_address_and_is_known_by_its_settings_when_it_stays_plugged_in() {
    let mut bench = Bench::of(board(0x80));
    bench.connect();
    assert!(!bench.model().front.link.units[0].also_answers.is_empty(), "as over USB");
    begin_addressing(&mut bench, "0x81-0x82");
    bench.press("Find the board");
    wait_for(&mut bench, "gets the address 0x81");
    bench.press("Give it 0x81");
    wait_for(&mut bench, "The RoboClaw 2x30A answers at 0x81.");
    bench.press("Find the board");
    wait_for(&mut bench, "This RoboClaw 2x30A has 0x81 already. Plug in the next one.");
    assert_eq!(addresses(&bench), [(0x81, 0x81)]);
}

#[test]
fn a_unit_of_another_family_is_given_its_address_by_what_that_family_says() {
    let mut bench = Bench::with_minds(vec![MotionMindConfig::new(Mode::SerialPid)]);
    bench.pass_ms(200);
    bench.choose("Simulated model", "Motion Mind 3");
    bench.press("Connect");
    bench.pass_ms(3000);
    begin_addressing(&mut bench, "5");
    bench.press("Find the board");
    wait_for(&mut bench, "gets the address 5");
    bench.press("Give it 5");
    wait_for(&mut bench, "The board has its address.");
    let register = brushwork_motion_mind_wire::register_named("ADDRESS").map_or(0, |row| row.number);
    assert_eq!(bench.minds.with(|bus| bus.motion_minds()[0].read_one(register)), 5);
}

// ---- one profile for all ----

fn limits(bench: &Bench) -> Vec<u16> {
    bench
        .line
        .with(|bus| bus.controllers().iter().map(|unit| unit.settings().battery.main_max_tenths).collect())
}

/// Opens a profile that was taken of the unit that is looked at, with another voltage limit.
fn open_profile(bench: &mut Bench, folder: &tempfile::TempDir) {
    bench.press("General Settings");
    bench.pass_ms(8000);
    let path = folder.path().join("rover.json");
    let mut profile = bench.model().front.settings.unit().and_then(|unit| unit.profile(false)).expect("read");
    let limit = brushwork_link::settings::SettingValue::Number(28.0);
    profile.settings.set("limits.main_battery.max_volts", limit);
    profile.save_new(&path).expect("it can be written");
    bench.press("Open profile");
    bench.model().front.general.profiles.path = path.display().to_string();
    bench.pass_ms(200);
    bench.press("Open");
}

#[test]
fn one_profile_goes_to_all_units_of_all_links_with_the_differences_of_each_and_one_question() {
    let folder = tempfile::tempdir().unwrap();
    let boards = vec![board(0x80), limited(0x81, 300), board(0x82)];
    let mut bench = Bench::of_bus(Bus::new(boards, StreamIndex::Uart1).expect("TTL lines can be shared"));
    bench.connect();
    open_profile(&mut bench, &folder);
    bench.press("Write to all units…");
    wait_for(&mut bench, "All are compared. Nothing was written yet.");
    let texts = bench.harness.query_all_by_label_contains("-> 28.0 V").count();
    assert_eq!(texts, 3, "each shows what changes");
    assert!(bench.sees_part("30.0 V -> 28.0 V"), "each its own");
    let before = limits(&bench);
    assert_ne!(before[0], 280);
    bench.press("Write to 3 units");
    assert!(bench.model().front.is_turned_elsewhere());
    bench.press("PWM Settings");
    bench.press("Arm");
    assert_eq!(
        bench.model().front.link.arming,
        Arming::Disarmed,
        "another unit than is shown might be armed"
    );
    wait_for(&mut bench, "All 3 units have the profile.");
    assert_eq!(limits(&bench), [280; 3]);
    let now: Vec<u8> = addresses(&bench).into_iter().map(|(now, _)| now).collect();
    assert_eq!(now, [0x80, 0x81, 0x82], "each unit keeps its address");
    bench.pass_ms(3000);
    assert_eq!(bench.model().front.link.selected, Some(0x80), "the unit that was looked at is again");
    assert_eq!(bench.harness.query_all_by_label_contains("1 setting written and read back.").count(), 3);
}

#[test]
fn nothing_is_written_to_any_unit_where_one_cannot_take_the_profile() {
    let folder = tempfile::tempdir().unwrap();
    let mut bench = rover(&[0x80, 0x81, 0x82], 3);
    bench.connect();
    open_profile(&mut bench, &folder);
    let before = limits(&bench);
    power(&bench, 2, true, false);
    bench.press("Write to all units…");
    wait_for(&mut bench, "Not all that are ticked can take the profile");
    assert!(!is_enabled(&bench, "Write"));
    assert_eq!(limits(&bench)[..2], before[..2]);
    let silent = bench.model().to_all.units[2].name();
    bench.harness.get_by_role_and_label(Role::CheckBox, &silent).click();
    bench.pass_ms(300);
    bench.press("Write to 2 units");
    wait_for(&mut bench, "All 2 units have the profile.");
    assert_eq!(limits(&bench)[..2], [280; 2]);
}

#[test]
fn stop_in_mid_round_writes_to_no_further_unit_and_says_who_has_the_profile() {
    let folder = tempfile::tempdir().unwrap();
    let late = |address| {
        let quirks = Quirks { late: Duration::from_millis(10), ..Quirks::default() };
        let config = ControllerConfig { quirks, ..board(address).config().clone() };
        Controller::new(config).expect("the default world is sound")
    };
    let boards = [0x80, 0x81, 0x82].map(late).to_vec();
    let mut bench = Bench::of_bus(Bus::new(boards, StreamIndex::Uart1).expect("TTL lines can be shared"));
    bench.press("Connect");
    bench.pass_ms(5000);
    open_profile(&mut bench, &folder);
    bench.pass_ms(10_000);
    let before = limits(&bench);
    bench.press("Write to all units…");
    wait_for(&mut bench, "All are compared. Nothing was written yet.");
    bench.press("Write to 3 units");
    for _ in 0..100 {
        if limits(&bench)[0] == 280 {
            break;
        }
        bench.pass_ms(20);
    }
    assert_eq!(limits(&bench)[0], 280);
    bench.key(Key::Escape);
    bench.pass_ms(8000);
    assert_eq!(limits(&bench)[2], before[2], "the last is not begun");
    assert!(
        bench.sees_part(" of 3 units have the profile. Each row says"),
        "{:?}",
        bench.model().to_all.ended
    );
    assert!(!bench.model().to_all.is_running());
}

#[test]
fn a_profile_goes_to_units_of_other_links_too_and_is_saved_where_that_is_asked_for() {
    let folder = tempfile::tempdir().unwrap();
    let mut bench = Bench::new();
    bench.connect();
    open_profile(&mut bench, &folder);
    bench.model().devices.typed = SECOND.to_owned();
    bench.model().devices.choice = brushwork_gui::model::Choice::Typed;
    bench.pass_ms(200);
    bench.press("Connect");
    bench.pass_ms(3000);
    let second = bench.model().front.id();
    let first = bench.model().others[0].id();
    assert_ne!(first, second);
    bench.press("Simulated MCP266: MCP266 · 0x80 · v1.0.0, connected");
    assert_eq!(bench.model().front.id(), first);
    bench.press("General Settings");
    bench.pass_ms(500);
    bench.press("Compare settings");
    bench.press("Write to all units…");
    wait_for(&mut bench, "All are compared. Nothing was written yet.");
    bench.harness.get_by_role_and_label(Role::CheckBox, "Save all settings of each to EEPROM too").click();
    bench.pass_ms(200);
    bench.press("Write to 2 units");
    wait_for(&mut bench, "All 2 units have the profile.");
    let stored = |bus: &mut Bus| bus.controllers()[0].stored_settings().battery.main_max_tenths;
    assert_eq!((bench.line.with(stored), bench.second.with(stored)), (280, 280));
}

// ---- a row for each unit ----

#[test]
fn units_of_other_links_have_rows_beside_those_of_the_line_and_are_turned_to_by_a_press() {
    let mut bench = rover(&[0x80, 0x81], 2);
    bench.connect();
    bench.model().devices.typed = SECOND.to_owned();
    bench.model().devices.choice = brushwork_gui::model::Choice::Typed;
    bench.pass_ms(200);
    bench.press("Connect");
    bench.pass_ms(4000);
    assert_eq!(bench.model().front.link.units.len(), 1);
    let rows = ["0x80  RoboClaw 2x30A on sim:mcp266", "0x81  RoboClaw 2x30A on sim:mcp266"];
    for row in rows {
        assert!(bench.sees(row), "{row}");
    }
    let boards = &bench.model().others[0].link.boards;
    let figures = boards.figures(0x81);
    assert!(figures.contains(" V") && figures.contains("M1 ") && figures.contains("M2 "), "{figures}");
    bench.act_on(1, &WorldAction::EStop { pressed: true });
    bench.pass_ms(4000);
    assert!(bench.sees_part("E-Stop"), "the fault of a unit of another link is to be read");
    bench.press(rows[1]);
    bench.pass_ms(1000);
    assert_eq!(bench.model().front.link.selected, Some(0x81));
    assert_eq!(bench.model().front.link.units.len(), 2, "its link is in front now");
}

// ---- numbers written raw ----

const PIN: &str = "motor1.encoder.pin";

/// An MCP that passes for a real one, with the page open on the pin of its first encoder, whose numbers have no public meaning.
fn raw_page() -> Bench {
    raw_page_of(Bench::new())
}

fn raw_page_of(mut bench: Bench) -> Bench {
    bench.pass_for_real();
    bench.connect();
    bench.pass_ms(8000);
    from_menu(&mut bench, "Raw Settings…");
    bench.model().front.raw.key = PIN.to_owned();
    bench.pass_ms(200);
    bench
}

fn write_raw(bench: &mut Bench, raw: &str) {
    type_into(bench, "Raw number", raw);
    bench.harness.get_by_role_and_label(Role::CheckBox, "I answer for what this number does").click();
    bench.pass_ms(200);
    bench.press("Write this number");
}

fn unit_of(bench: &mut Bench) -> UnitId {
    let identity = bench.model().front.link.identity().cloned().expect("it is connected");
    UnitId::new(&identity, &[])
}

#[test]
fn a_raw_number_is_written_at_the_owners_word_read_back_noted_and_undone() {
    let mut bench = raw_page();
    let before = bench.model().front.raw_held().expect("it was read");
    assert_ne!(before, 2);
    type_into(&mut bench, "Raw number", "2");
    assert!(!is_enabled(&bench, "Write this number"), "nobody answers for it yet");
    write_raw(&mut bench, "0x02");
    wait_for(&mut bench, "The register of motor1.encoder.pin holds 2, as reading it back has shown.");
    let unit = unit_of(&mut bench);
    let noted = bench.store().raw_writes(&unit).unwrap();
    assert_eq!((noted[0].before, noted[0].wanted, noted[0].found), (Some(before), 2, Some(2)));
    assert!(!noted[0].is_open);
    assert!(!is_enabled(&bench, "Write this number"), "each number is agreed to by itself");
    bench.pass_ms(8000);
    bench.press(&format!("Undo: {before} for {PIN}"));
    wait_for(&mut bench, &format!("The register of {PIN} holds {before}, as reading"));
    write_raw(&mut bench, "two");
    assert!(bench.sees_part("\"two\" is no whole number"));
}

#[test]
fn nothing_is_written_raw_while_something_is_armed() {
    let mut bench = raw_page();
    bench.model().front.raw.open = false;
    bench.arm();
    from_menu(&mut bench, "Raw Settings…");
    write_raw(&mut bench, "2");
    assert!(bench.sees_part("Disarm first"));
    let unit = unit_of(&mut bench);
    assert_eq!(bench.store().raw_writes(&unit).unwrap().len(), 0);
}

#[test]
fn a_raw_write_that_is_cut_off_is_noted_and_named_at_the_next_connection() {
    let mut bench = raw_page();
    let before = bench.model().front.raw_held().expect("it was read");
    let unit = unit_of(&mut bench);
    bench.line.after(number::SET_ENCODER_MODE_M1, 1, WorldAction::Unplug { unplugged: true });
    write_raw(&mut bench, "2");
    bench.pass_ms(5000);
    assert!(!bench.model().is_connected(), "{:?}", bench.said());
    assert!(bench.store().raw_writes(&unit).unwrap()[0].is_open, "it was noted before it went out");
    bench.act(&WorldAction::Unplug { unplugged: false });
    bench.connect();
    let is_named = |bench: &mut Bench| bench.said().iter().any(|text| text.contains("The raw number 2 was"));
    bench.pass_ms(10_000);
    assert!(is_named(&mut bench), "{:?}", bench.said());
    let noted = bench.store().raw_writes(&unit).unwrap();
    assert!(!noted[0].is_open);
    assert!(noted[0].found == Some(2) || noted[0].found == Some(before), "{noted:?}");
}

#[test]
fn a_raw_write_in_which_the_window_dies_is_named_by_the_next_window() {
    let quirks = Quirks { late: Duration::from_millis(10), ..Quirks::default() };
    let late = Controller::new(ControllerConfig { quirks, ..ControllerConfig::default() });
    let mut bench = raw_page_of(Bench::of(late.expect("it is sound")));
    type_into(&mut bench, "Raw number", "2");
    bench.harness.get_by_role_and_label(Role::CheckBox, "I answer for what this number does").click();
    bench.pass_ms(200);
    let unit = unit_of(&mut bench);
    let held = |bench: &Bench| bench.line.with(|bus| bus.controllers()[0].settings());
    let before = held(&bench);
    bench.button("Write this number").click();
    for _ in 0..2000 {
        bench.pass_ms(5);
        if held(&bench) != before {
            break;
        }
    }
    assert_ne!(held(&bench), before, "the number has gone out");
    assert!(bench.store().raw_writes(&unit).unwrap()[0].is_open, "it has not ended yet");
    let mut bench = bench.after_a_crash();
    bench.pass_for_real();
    bench.connect();
    bench.pass_ms(10_000);
    let said = bench.said();
    assert!(said.iter().any(|text| text.contains("The raw number 2 was")), "{said:?}");
    assert!(!bench.store().raw_writes(&unit).unwrap()[0].is_open);
}

// ---- keyboard ----

/// What has the keyboard, by its name.
fn focused(bench: &Bench) -> Option<String> {
    let mut nodes = bench.harness.root().children_recursive();
    nodes.find(|node| node.accesskit_node().is_focused())?.accesskit_node().label()
}

#[test]
fn each_assistant_is_opened_from_the_palette_and_has_the_keyboard() {
    for (typed, button) in [("boards their addresses", "Addresses to give"), ("raw settings", "Setting")] {
        let mut bench = Bench::new();
        bench.connect();
        bench.pass_ms(8000);
        bench.key_with(Modifiers::COMMAND | Modifiers::SHIFT, Key::P);
        bench.harness.event(egui::Event::Text(typed.to_owned()));
        bench.pass_ms(200);
        bench.key(Key::Enter);
        bench.pass_ms(500);
        assert!(bench.sees(button), "{typed}: {:?}", bench.said());
        assert_eq!(focused(&bench).as_deref(), Some(button), "{typed}");
        // F6 comes back to it.
        let mut passed = Vec::new();
        for _ in 0..Region::ALL.len() {
            bench.key(Key::F6);
            bench.pass_ms(300);
            passed.push(focused(&bench));
        }
        assert!(passed.iter().any(|label| label.as_deref() == Some(button)), "{typed}: {passed:?}");
    }
}

#[test]
fn boards_are_given_their_addresses_by_the_enter_key_alone() {
    let mut bench = rover(&[0x80], 1);
    bench.connect();
    from_menu(&mut bench, "Give Boards Their Addresses…");
    type_into(&mut bench, "Addresses to give", "0x83");
    bench.focus("Begin");
    bench.key(Key::Enter);
    bench.pass_ms(300);
    for (button, part) in
        [("Find the board", "gets the address 0x83"), ("Give it 0x83", "The board has its address.")]
    {
        assert_eq!(focused(&bench).as_deref(), Some(button));
        bench.key(Key::Enter);
        wait_for(&mut bench, part);
        bench.pass_ms(300);
    }
    assert_eq!(addresses(&bench), [(0x83, 0x83)]);
}

// ---- commands learned anew ----

#[test]
fn commands_that_were_taken_for_absent_are_learned_anew_from_the_menu_and_the_status_page() {
    let unit = |silent: &[u8]| {
        let quirks = Quirks { silent: silent.iter().copied().collect(), ..Quirks::default() };
        Controller::new(ControllerConfig { quirks, ..ControllerConfig::default() }).expect("it is sound")
    };
    let mut bench = Bench::of(unit(&[number::READ_TEMPERATURE_1]));
    bench.connect();
    bench.pass_ms(8000);
    assert!(bench.sees_part("This firmware does not have"), "{:?}", bench.said());
    bench.line.with(|bus| bus.controllers_mut()[0] = unit(&[]));
    from_menu(&mut bench, "Learn Its Commands Again");
    bench.pass_ms(4000);
    assert!(!bench.sees_part("This firmware does not have"));
    bench.line.with(|bus| bus.controllers_mut()[0] = unit(&[number::READ_TEMPERATURE_1]));
    bench.button("Learn Again").scroll_to_me();
    bench.pass_ms(300);
    bench.press("Learn Again");
    bench.pass_ms(40_000);
    assert!(
        bench.sees_part("This firmware does not have"),
        "it is there also where nothing is lacking: {:?}",
        bench.said()
    );
    assert!(bench.real_duty(Motor::M1).abs() < f64::EPSILON);
}
