//! The window for Motion Mind 3, by role and label, against simulated ones in virtual time: the device list, screens by mode,
//! indicators, registers in RAM and EEPROM, and the terminal.

use crate::support::bench::{Bench, FRAME};
use brushwork_gui::model::screen::Screen;
use brushwork_link::exchange::LinkStatistics;
use brushwork_motion_mind_sim::{Mode, MotionMindConfig, Protocol, pin};
use brushwork_motion_mind_wire::{Address, function, register_named};
use brushwork_plant::machine::Machine as _;
use brushwork_plant::world::{PinSignal, WorldAction};
use brushwork_values::Motor;
use egui::accesskit::Role;
use egui::{Key, Theme};
use egui_kittest::kittest::Queryable as _;

fn config(mode: Mode) -> MotionMindConfig {
    MotionMindConfig::new(mode)
}

/// A window of 1920 by 1080, in which every register and bit is in sight, connected to one Motion Mind in a mode.
fn connected(mode: Mode) -> Bench {
    let mut bench = Bench::with_minds_sized(vec![config(mode)], [1920.0, 1080.0], Theme::Dark);
    choose(&mut bench);
    bench.connect();
    bench.pass_ms(3000);
    bench
}

/// Makes the first row of the list a Motion Mind.
fn choose(bench: &mut Bench) {
    bench.pass(FRAME * 2);
    bench.choose("Simulated model", "Motion Mind 3");
}

/// A register as the simulated unit has it.
fn ram(bench: &Bench, unit: usize, name: &str) -> i64 {
    let number = register_named(name).expect("a register of the manual").number;
    bench.minds.with(|bus| bus.motion_minds()[unit].read_one(number))
}

fn eeprom(bench: &Bench, name: &str) -> i64 {
    let number = register_named(name).expect("a register of the manual").number;
    bench.minds.with(|bus| bus.motion_minds()[0].stored(number))
}

fn put(bench: &Bench, pin: usize, signal: PinSignal) {
    bench.minds.with(|bus| bus.apply(0, &WorldAction::SetPin { pin, signal }));
}

fn has_screen(bench: &Bench, title: &str) -> bool {
    bench.harness.query_all_by_role_and_label(Role::Button, title).next().is_some()
}

// ---- the device list ----

#[test]
fn a_simulated_motion_mind_stands_beside_the_mcps_with_mode_protocol_and_address() {
    let mut bench = Bench::with_minds(vec![config(Mode::SerialPid)]);
    choose(&mut bench);
    for label in ["Mode", "Protocol", "Unit address", "Units on the bus"] {
        assert!(bench.sees(label), "{label}");
    }
    bench.choose("Mode", "3 Serial");
    bench.choose("Protocol", "ASCII");
    assert_eq!(
        bench.model().devices.target().unwrap().to_string(),
        "sim:motion-mind-3,mode=3,protocol=ascii,address=1"
    );
    bench.choose("Simulated model", "MCP233");
    assert!(!bench.sees("Protocol") && bench.sees_part("Simulated MCP233"));
}

#[test]
fn a_port_is_asked_for_the_family_that_was_chosen() {
    let mut bench = Bench::new();
    bench.plug_in_port("/dev/ttyUSB3");
    bench.pass_ms(300);
    bench.press("/dev/ttyUSB3: USB, available");
    bench.choose("Controller family", "Motion Mind");
    let target = bench.model().devices.target().unwrap().to_string();
    assert!(target.ends_with("family=motion-mind"), "{target}");
    assert_eq!(bench.model().devices.baud, 19_200, "the rate of switch 5 as delivered");
    bench.choose("Baud rate", "9600");
    let target = bench.model().devices.target().unwrap().to_string();
    assert!(target.contains("baud=9600"), "{target}");
    bench.choose("Address", "unit 3");
    assert!(bench.model().devices.addresses() == brushwork_link::device::Addresses::Only(3));
}

#[test]
fn both_protocols_connect_and_say_who_they_are() {
    for protocol in [Protocol::Binary, Protocol::Text] {
        let mut bench = Bench::with_minds(vec![MotionMindConfig { protocol, ..config(Mode::SerialPid) }]);
        choose(&mut bench);
        bench.connect();
        assert!(bench.sees_part("Motion Mind 3 · unit 1"), "{protocol:?}");
        bench.pass_ms(4000);
        bench.press("Registers");
        bench.pass_ms(3000);
        assert!(bench.sees("PTERM in RAM: 6000"), "{protocol:?}");
    }
}

#[test]
fn several_units_on_one_bus_are_listed_and_each_has_its_own_registers() {
    let at = |number| MotionMindConfig {
        address: Address::unit(number).expect("a unit's address"),
        ..config(Mode::SerialPid)
    };
    let mut bench = Bench::with_minds(vec![at(1), at(2)]);
    bench.minds.with(|bus| bus.advance(std::time::Duration::ZERO));
    choose(&mut bench);
    bench.enter("Units on the bus", "2");
    bench.press("Connect");
    bench.pass_ms(200);
    assert!(bench.sees_part("Searching: "), "a scan of 98 addresses tells how far it is");
    bench.pass_ms(20_000);
    assert!(bench.model().is_connected(), "{:?}", bench.model().messages.past().collect::<Vec<_>>());
    assert_eq!(bench.model().front.link.units.len(), 2);
    bench.press("unit 2  Motion Mind 3");
    bench.pass_ms(3000);
    assert_eq!(bench.model().front.link.selected, Some(2));
    bench.press("Registers");
    bench.pass_ms(4000);
    assert!(bench.sees("ADDRESS in RAM: 2"));
}

#[test]
fn a_search_can_be_called_off() {
    let mut bench = Bench::with_minds(vec![MotionMindConfig {
        address: Address::unit(90).expect("a unit's address"),
        ..config(Mode::SerialPid)
    }]);
    choose(&mut bench);
    bench.enter("Units on the bus", "2");
    bench.press("Connect");
    bench.pass_ms(1000);
    bench.press("Cancel");
    bench.pass_ms(1000);
    assert!(!bench.model().front.phase.is_open());
}

// ---- screens by family and mode ----

#[test]
fn what_does_not_apply_is_not_shown() {
    let expected: [(Mode, &[&str], &[&str]); 4] = [
        (Mode::Serial, &["Duty"], &["Velocity", "Position", "Motion"]),
        (Mode::SerialPid, &["Velocity", "Position"], &["Duty", "Motion"]),
        (Mode::RadioControl, &["Motion"], &["Duty", "Velocity", "Position"]),
        (Mode::AnalogPid, &["Motion"], &["Duty", "Velocity", "Position"]),
    ];
    for (mode, there, not_there) in expected {
        let bench = connected(mode);
        for title in ["Device Status", "Registers", "Inputs and R/C", "Terminal"].iter().chain(there) {
            assert!(has_screen(&bench, title), "{title} in {mode:?}");
        }
        for title in ["General Settings", "PWM Settings", "MCL Editor"].iter().chain(not_there) {
            assert!(!has_screen(&bench, title), "{title} in {mode:?}");
        }
        assert!(!bench.sees("Zero M2 encoder") && bench.sees("Zero M1 encoder"));
        assert!(!bench.sees("M1OC: OK"), "the indicators are this family's");
    }
}

#[test]
fn the_screens_of_an_mcp_come_back_with_an_mcp() {
    let mut bench = connected(Mode::SerialPid);
    bench.press("Registers");
    bench.choose("Simulated model", "MCP266");
    bench.press("Connect");
    bench.pass_ms(1500);
    assert!(has_screen(&bench, "MCL Editor") && !has_screen(&bench, "Registers"));
    assert!(bench.sees("M1OC: OK"));
    assert_eq!(bench.model().screen, Screen::GeneralSettings);
}

#[test]
fn a_mode_that_is_not_driven_from_here_says_which_to_set() {
    for (mode, word) in [(Mode::RadioControl, "R/C"), (Mode::Analog, "analog"), (Mode::Buttons, "BTN_UP")] {
        let mut bench = connected(mode);
        bench.press("Motion");
        bench.pass_ms(1000);
        assert!(bench.sees_part(word), "{mode:?}");
        assert!(bench.sees_part("set SW1 to mode 3"), "{mode:?}");
        assert!(!bench.sees("Arm"), "nothing can be armed here");
    }
    let mut bench = connected(Mode::AnalogPid);
    bench.press("Motion");
    bench.pass_ms(300);
    bench.press("Show ADSERIAL");
    bench.pass_ms(2000);
    assert!(bench.sees("FUNCTION ADSERIAL"));
}

#[test]
fn a_bit_that_hands_over_the_setpoint_brings_the_position_screen() {
    let mut bench = connected(Mode::AnalogPid);
    bench.press("Registers");
    bench.press("Bits of FUNCTION");
    bench.press("FUNCTION ADSERIAL");
    write(&mut bench);
    assert!(has_screen(&bench, "Position") && !has_screen(&bench, "Motion"));
}

// ---- dashboard ----

#[test]
fn the_indicators_follow_the_status_in_word_and_history() {
    let mut bench = connected(Mode::SerialPid);
    assert!(bench.sees("BRK: OK"));
    put(&bench, pin::BRAKE, PinSignal::Volts { volts: 0.0 });
    bench.pass_ms(1500);
    assert!(bench.sees("BRK: error"));
    put(&bench, pin::BRAKE, PinSignal::Open);
    put(&bench, pin::POSITIVE_LIMIT, PinSignal::Volts { volts: 0.0 });
    bench.pass_ms(1500);
    assert!(bench.sees("BRK: OK") && bench.sees("POS: warning"));
    bench.press("Device Status");
    bench.pass_ms(1000);
    assert!(bench.sees_part("Brake input at ground: the bridge is off came"));
    assert!(bench.sees_part("Brake input at ground: the bridge is off went"));
}

#[test]
fn the_top_row_has_this_familys_figures() {
    let mut bench = connected(Mode::Serial);
    bench.arm_on("Duty");
    bench.enter("Motor duty exact", "40");
    bench.pass_ms(2000);
    for (label, digits) in
        [("Position: ", true), ("Velocity: ", true), ("PWM: ", true), ("Current: ", true), ("Board: ", true)]
    {
        let found = bench.harness.query_all_by_label_contains(label).next();
        assert!(found.is_some() == digits, "{label}");
        assert!(!bench.sees(&format!("{label}no value")), "{label}");
    }
    assert!(!bench.sees_part("Main battery"));
}

// ---- registers ----

/// Writes the edits through the sheet.
fn write(bench: &mut Bench) {
    bench.press("Write settings");
    bench.press("Write to controller");
    bench.pass_ms(4000);
    assert!(bench.model().front.settings.running().is_none(), "the write has ended");
}

#[test]
fn all_32_registers_are_shown_with_ram_and_eeprom() {
    let mut bench = Bench::with_minds_sized(vec![config(Mode::SerialPid)], [1920.0, 1080.0], Theme::Dark);
    choose(&mut bench);
    bench.connect();
    bench.press("Registers");
    bench.pass_ms(4000);
    for register in &brushwork_motion_mind_wire::REGISTERS {
        assert!(bench.sees(&format!("Register {}", register.name)), "{}", register.name);
        assert!(!bench.sees(&format!("{} in RAM: –", register.name)), "{} was read", register.name);
    }
    assert!(bench.sees("MODE in RAM: 4") && bench.sees("PTERM in RAM: 6000"));
}

#[test]
fn a_register_is_written_to_ram_and_then_stored_and_what_differs_is_marked() {
    let mut bench = connected(Mode::SerialPid);
    bench.press("Registers");
    bench.pass_ms(1000);
    bench.press("Register PTERM");
    bench.enter("P", "7000");
    assert!(bench.sees("PTERM is changed and not written"));
    assert_eq!(ram(&bench, 0, "PTERM"), 6000, "nothing goes out before Write");
    write(&mut bench);
    assert_eq!((ram(&bench, 0, "PTERM"), eeprom(&bench, "PTERM")), (7000, 6000));
    assert!(bench.sees("PTERM in RAM: 7000"));
    bench.press("Save to EEPROM");
    assert!(bench.sees_part("The motor stops while the EEPROM is written"));
    bench.press("Save");
    bench.pass_ms(8000);
    let reported: Vec<_> = bench.model().messages.past().map(|message| message.text.to_string()).collect();
    assert_eq!(eeprom(&bench, "PTERM"), 7000, "{reported:?}");
    assert!(bench.sees("PTERM in EEPROM: 7000"), "it was read back");
    bench.enter("P", "7100");
    write(&mut bench);
    assert!(bench.sees("PTERM in RAM differs from EEPROM"));
}

#[test]
fn a_value_out_of_range_is_refused_with_its_range() {
    let mut bench = connected(Mode::SerialPid);
    bench.press("Registers");
    bench.press("Register PIDSCALAR");
    bench.enter("PID scalar", "40");
    assert!(bench.sees_part("32"), "the range is named");
    assert!(bench.model().front.settings.unit().unwrap().edits().is_empty());
}

#[test]
fn bits_are_edited_by_name_and_others_stay() {
    let mut bench = connected(Mode::SerialPid);
    bench.press("Registers");
    bench.press("Bits of FUNCTION");
    for bit in ["SATPROT", "ACTIVESTOP"] {
        bench.press(&format!("FUNCTION {bit}"));
    }
    write(&mut bench);
    assert_eq!(ram(&bench, 0, "FUNCTION"), i64::from(function::SATPROT | function::ACTIVESTOP));
    assert!(bench.sees("FUNCTION in RAM: 0x0090"));
}

#[test]
fn restore_says_that_the_motor_stops_and_brings_the_factory_back() {
    let mut bench = connected(Mode::SerialPid);
    bench.press("Registers");
    bench.enter("I", "50");
    write(&mut bench);
    assert_eq!(ram(&bench, 0, "ITERM"), 50);
    bench.press("Default settings");
    assert!(bench.sees_part("The motor stops"));
    bench.press("Restore factory values");
    bench.pass_ms(8000);
    let reported: Vec<_> = bench.model().messages.past().map(|message| message.text.to_string()).collect();
    assert_eq!((ram(&bench, 0, "ITERM"), eeprom(&bench, "ITERM")), (35, 35), "{reported:?}");
}

#[test]
fn the_status_register_names_its_bits() {
    let mut bench = connected(Mode::SerialPid);
    bench.press("Registers");
    bench.press("Bits of STATUS");
    bench.pass_ms(1000);
    assert!(bench.sees("STATUS BRAKE: clear"));
    put(&bench, pin::BRAKE, PinSignal::Volts { volts: 0.0 });
    bench.pass_ms(1500);
    assert!(bench.sees("STATUS BRAKE: set"));
}

// ---- terminal ----

#[test]
fn the_terminal_decodes_sends_and_shows_the_answer() {
    let mut bench = connected(Mode::SerialPid);
    bench.press("Terminal");
    type_line(&mut bench, "W01 04 6100");
    assert!(bench.sees("Means: unit 1: write PTERM 6100"));
    assert!(bench.sees_part("18 01 04 D4 17 08"));
    bench.press("Send command");
    bench.pass_ms(6000);
    assert_eq!(ram(&bench, 0, "PTERM"), 6100);
    assert!(bench.sees("Answer: OK"));
    assert_eq!(bench.store().backups(None).len(), 1, "what was there before is kept");
    type_line(&mut bench, "R01 04");
    bench.key(Key::Enter);
    bench.pass_ms(1000);
    assert!(bench.sees_part("Answer: PTERM 6100"));
}

/// The keyboard stays in the field: a space in the next line is no stop.
#[test]
fn the_terminal_takes_the_next_line_after_enter() {
    let mut bench = connected(Mode::SerialPid);
    bench.press("Terminal");
    type_line(&mut bench, "R01 04");
    bench.key(Key::Enter);
    bench.pass_ms(1000);
    let stops = |bench: &mut Bench| bench.said().iter().filter(|said| said.starts_with("Stopped.")).count();
    let before = stops(&mut bench);
    bench.harness.event(egui::Event::Text("R01".to_owned()));
    bench.harness.key_press(Key::Space);
    bench.harness.event(egui::Event::Text(" ".to_owned()));
    bench.harness.event(egui::Event::Text("05".to_owned()));
    bench.pass_ms(300);
    assert_eq!(bench.model().front.mind_mut().terminal.typed, "R01 05");
    bench.key(Key::Enter);
    bench.pass_ms(1000);
    assert_eq!(bench.model().front.mind_mut().terminal.entries.len(), 2);
    assert_eq!(stops(&mut bench), before);
}

#[test]
fn the_terminal_shows_both_directions_byte_for_byte_and_in_words() {
    for (protocol, sent, back) in [
        // READ REGISTER 4: address, 6000 with the low byte first, sum; the line and its code.
        (Protocol::Binary, "> 1D 01 04 22", "< 01 70 17 88"),
        (Protocol::Text, "> R01 04", "< PTRM=6000"),
    ] {
        let mut bench = Bench::with_minds(vec![MotionMindConfig { protocol, ..config(Mode::SerialPid) }]);
        choose(&mut bench);
        bench.connect();
        bench.pass_ms(3000);
        bench.press("Terminal");
        type_line(&mut bench, "R01 04");
        bench.key(Key::Enter);
        bench.pass_ms(1000);
        assert!(bench.sees(sent) && bench.sees(back), "{protocol:?}");
        assert!(bench.sees_part("Answer: ") && bench.sees_part("PTERM 6000"), "{protocol:?}");
    }
}

#[test]
fn what_is_no_command_can_be_sent_as_typed_to_see_what_comes_back() {
    let mut bench = connected(Mode::SerialPid);
    bench.press("Terminal");
    bench.choose("Form of the command", "Hex");
    type_line(&mut bench, "1D 01 04 23");
    assert!(bench.sees_part("should be 22"));
    bench.press("Send as typed");
    bench.pass_ms(1500);
    assert!(bench.sees("> 1D 01 04 23") && bench.sees("Answer: silence"), "{:?}", bench.said());
    let text = MotionMindConfig { protocol: Protocol::Text, ..config(Mode::SerialPid) };
    let mut bench = Bench::with_minds(vec![text]);
    choose(&mut bench);
    bench.connect();
    bench.pass_ms(3000);
    bench.press("Terminal");
    type_line(&mut bench, "W01 04");
    bench.press("Send as typed");
    bench.pass_ms(1500);
    assert!(bench.sees("< BAD COMMAND"), "{:?}", bench.said());
}

#[test]
fn the_terminal_sends_neither_the_self_test_nor_motion() {
    let mut bench = connected(Mode::SerialPid);
    bench.press("Terminal");
    type_line(&mut bench, "Z01");
    assert!(bench.sees_part("The self-test is not sent"));
    assert!(!bench.sees("Send command"));
    bench.key(Key::Escape);
    let field = bench.model();
    field.front.mind_mut().terminal.typed.clear();
    type_line(&mut bench, "V01 20");
    assert!(bench.sees_part("this moves the motor"));
    bench.key(Key::Enter);
    bench.pass_ms(1000);
    assert_eq!(mind_duty(&bench), 0.0);
}

fn type_line(bench: &mut Bench, line: &str) {
    bench.harness.get_by_role_and_label(Role::TextInput, "Command line").focus();
    bench.pass(FRAME);
    bench.harness.get_by_role_and_label(Role::TextInput, "Command line").type_text(line);
    bench.pass(FRAME);
}

/// The duty that the motor of the first unit gets.
fn mind_duty(bench: &Bench) -> f64 {
    match bench.minds.with(|bus| bus.views().remove(0)).axes[Motor::M1.index()].output {
        brushwork_plant::bridge::BridgeOutput::Duty(duty) => duty,
        _ => 0.0,
    }
}

// ---- the simulated world ----

#[test]
fn the_world_panel_turns_pins_load_and_switches_which_count_from_the_next_power_up_on() {
    let mut bench = connected(Mode::SerialPid);
    bench.key_with(egui::Modifiers::COMMAND, Key::B);
    bench.pass_ms(500);
    for name in
        ["P4 control", "P3 feedback", "P17 pos. limit", "P16 neg. limit", "P12 brake", "J6 R/C, index"]
    {
        assert!(bench.sees(&format!("{name} is connected to")), "{name}");
    }
    assert!(
        !bench.sees("Logic voltage") && !bench.sees("E-stop pressed"),
        "what it does not have is not shown"
    );
    bench.choose("P12 brake is connected to", "a voltage");
    bench.enter("P12 brake value", "0");
    bench.pass_ms(1500);
    assert!(bench.sees("BRK: error"), "a pin at ground acts");
    bench.choose("P12 brake is connected to", "nothing");
    bench.choose("Mode switches", "3 Serial");
    bench.press("Text protocol (6)");
    bench.pass_ms(1500);
    assert_eq!(ram(&bench, 0, "MODE"), 4, "they are read at power-up");
    bench.press("Power");
    bench.pass_ms(1500);
    bench.press("Power");
    bench.pass_ms(8000);
    assert_eq!(ram(&bench, 0, "MODE"), 3);
    if bench.model().is_connected() {
        bench.press("Disconnect");
        bench.pass_ms(3000);
    }
    bench.connect();
    bench.pass_ms(4000);
    assert!(has_screen(&bench, "Duty") && !has_screen(&bench, "Velocity"), "{:?}", bench.said());
}

#[test]
fn the_registers_look_as_they_did() {
    let mut bench = Bench::with_minds_sized(vec![config(Mode::SerialPid)], [1024.0, 700.0], Theme::Dark);
    choose(&mut bench);
    bench.connect();
    bench.press("Registers");
    bench.pass_ms(3000);
    bench.press("Bits of FUNCTION");
    bench.harness.set_render_cursor(false);
    bench.pass_ms(200);
    // How busy the link is belongs to no picture of the registers.
    bench.model().front.link.statistics = LinkStatistics::default();
    bench.harness.step();
    bench.harness.snapshot("motion_mind_registers");
}
