//! Plans: the exact bytes that changes put on the wire, how few commands, in which order, and what is
//! refused.
//!
//! The bytes are written by hand from the manual and from public clients; their CRCs come from another
//! implementation.

use brushwork_mcp_wire::packet_serial::{Address, Generation};

use crate::tests::settings::table;
use brushwork_link::settings::{
    Plan, Refusal, SettingValue, SettingsImage, SettingsTable, Stage, WriteOptions, plan,
};
use brushwork_link::transport::Stream;

const SIMULATED: WriteOptions = WriteOptions { own_stream: None, simulated: true, as_read: false };
const REAL: WriteOptions = WriteOptions { own_stream: None, simulated: false, as_read: false };

fn image(table: &SettingsTable, values: &[(&str, &str)]) -> SettingsImage {
    let parse = |(key, text): &(&str, &str)| {
        let row = table.row(key).unwrap_or_else(|| panic!("{key} is missing"));
        ((*key).to_owned(), row.parse_any(text).unwrap_or_else(|why| panic!("{key}: {why}")))
    };
    values.iter().map(parse).collect()
}

fn plan_of(table: &SettingsTable, changes: &[(&str, &str)], options: WriteOptions) -> Plan {
    let ram = table.default_image();
    plan(table, &ram, &image(table, changes), options).unwrap_or_else(|refusals| panic!("{refusals:?}"))
}

fn refused(table: &SettingsTable, changes: &[(&str, &str)]) -> Vec<String> {
    let ram = table.default_image();
    let refusals: Vec<Refusal> = plan(table, &ram, &image(table, changes), REAL).expect_err("it is refused");
    refusals.into_iter().map(|refusal| refusal.sentence.to_string()).collect()
}

fn hex(bytes: &[u8]) -> String {
    bytes.iter().map(|byte| format!("{byte:02X}")).collect()
}

/// Checks that `changes` of the defaults are one command with exactly these bytes; blanks part the fields.
fn assert_bytes(model: &str, generation: Generation, changes: &[(&str, &str)], expected: &str) {
    let table = table(model, generation);
    let plan = plan_of(&table, changes, SIMULATED);
    assert_eq!(plan.steps.len(), 1, "{changes:?}");
    let bytes = plan.steps[0]
        .bytes(crate::unit_address(Address::DEFAULT), crate::firmware_of(generation))
        .expect("the plan fits the command");
    assert_eq!(hex(&bytes), expected.replace(' ', ""), "{changes:?} in {generation}");
}

const ONE: Generation = Generation::Gen1;
const FOUR: Generation = Generation::Gen4;

#[test]
fn velocity_gains_are_written_in_the_order_d_p_i_qpps() {
    for generation in [ONE, FOUR] {
        assert_bytes(
            "mcp266",
            generation,
            &[("motor1.velocity.p", "2")],
            // address, command 28, D 0.25, P 2.0, I 0.5, QPPS 44000, CRC
            "80 1C 00004000 00020000 00008000 0000ABE0 5E00",
        );
    }
}

#[test]
fn position_gains_are_written_in_the_order_d_p_i_and_their_limits_signed() {
    for generation in [ONE, FOUR] {
        assert_bytes(
            "mcp266",
            generation,
            &[
                ("motor1.position.p", "2000"),
                ("motor1.position.i", "1"),
                ("motor1.position.d", "2"),
                ("motor1.position.max_i", "100"),
                ("motor1.position.deadzone", "10"),
                ("motor1.position.min", "-1000"),
                ("motor1.position.max", "1000"),
            ],
            // address, command 61, D 2.0, P 2000.0, I 1.0 (each x 1024), max I 100, deadzone 10, min -1000,
            // max 1000, CRC
            "80 3D 00000800 001F4000 00000400 00000064 0000000A FFFFFC18 000003E8 279D",
        );
    }
}

#[test]
fn generation_4_adds_the_automatic_offset_to_the_main_battery_limits() {
    // address, command 57, min 10.0 V, max 24.0 V, CRC
    assert_bytes("mcp266", ONE, &[("limits.main_battery.max_volts", "24")], "80 39 0064 00F0 D806");
    // address, command 57, min 10.0 V, max 24.0 V, automatic offset 0 V, CRC
    assert_bytes("mcp266", FOUR, &[("limits.main_battery.max_volts", "24")], "80 39 0064 00F0 00 4C75");
}

#[test]
fn the_default_deceleration_is_written_from_generation_2() {
    // address, command 68, acceleration 100 %/s = 32768, CRC
    assert_bytes("mcp266", ONE, &[("motor1.default_accel", "100")], "80 44 00008000 57D6");
    // address, command 68, acceleration 32768, deceleration 655359 as it was, CRC
    assert_bytes("mcp266", FOUR, &[("motor1.default_accel", "100")], "80 44 00008000 0009FFFF 70BC");
}

#[test]
fn the_minimum_current_is_signed_in_generation_1_and_a_magnitude_in_generation_4() {
    let ram = |generation| {
        let table = table("mcp266", generation);
        let mut ram = table.default_image();
        ram.set("motor1.current.min_amps", SettingValue::Number(-60.0));
        (table, ram)
    };
    for (generation, expected) in [
        // address, command 133, maximum 20.00 A, minimum -60.00 A, CRC
        (ONE, "80 85 000007D0 FFFFE890 4D8B"),
        // address, command 133, maximum 20.00 A, minimum 60.00 A without its sign, CRC
        (FOUR, "80 85 000007D0 00001770 379A"),
    ] {
        let (table, ram) = ram(generation);
        let changes = image(&table, &[("motor1.current.max_amps", "20")]);
        let plan = plan(&table, &ram, &changes, REAL).expect("it can be written");
        let bytes = plan.steps[0]
            .bytes(crate::unit_address(Address::DEFAULT), crate::firmware_of(generation))
            .expect("it fits");
        assert_eq!(hex(&bytes), expected.replace(' ', ""));
    }
}

#[test]
fn the_pwm_mode_is_one_byte_in_generation_1_and_one_for_each_motor_in_generation_4() {
    // address, command 148, sign magnitude, CRC
    assert_bytes("mcp266", ONE, &[("unit.pwm_mode", "sign_magnitude")], "80 94 01 FF54");
    // address, command 148, motor 1 locked antiphase as it was, motor 2 sign magnitude, CRC
    assert_bytes("mcp266", FOUR, &[("motor2.pwm_mode", "sign_magnitude")], "80 94 00 01 69E0");
}

#[test]
fn address_and_mixing_share_a_command() {
    for generation in [ONE, FOUR] {
        let changes = [("unit.address", "0x82"), ("unit.mixing", "yes")];
        // address it still has, command 141, address 0x82, mixed 1, CRC
        assert_bytes("mcp266", generation, &changes, "80 8D 82 01 C9E8");
    }
}

#[test]
fn the_estop_reset_methods_have_their_own_numbers() {
    // address, command 201, 0xAA: software, CRC
    assert_bytes("mcp266", ONE, &[("unit.estop_reset", "software")], "80 C9 AA 8336");
    // address, command 201, 0x55: automatic, CRC
    assert_bytes("mcp266", FOUR, &[("unit.estop_reset", "automatic")], "80 C9 55 9DC6");
}

#[test]
fn a_stream_is_named_by_its_index() {
    let changes = [("stream.rs232.rate", "57600")];
    // address, command 145, index 1: UART0, packet serial, 57600 bps, 1000 ms, CRC
    assert_bytes("mcp266", ONE, &changes, "80 91 01 01 0000E100 000003E8 CDF4");
}

/// The settings of a joystick on the first pin.
const JOYSTICK: [(&str, &str); 7] = [
    ("pin.1.type", "analog"),
    ("pin.1.target", "motor1"),
    ("pin.1.min", "100"),
    ("pin.1.max", "4000"),
    ("pin.1.deadband", "20"),
    ("pin.1.power_exp", "1"),
    ("pin.1.center", "2048"),
];

#[test]
fn a_pin_of_generation_1_takes_46_bytes() {
    assert_bytes(
        "mcp266",
        ONE,
        &JOYSTICK,
        // address, command 143, index 0, type analog, mode position, target motor 1, no actions (u8 each),
        // time-out 1000 ms, load home 0, min 100, max 4000, center 2048, deadband 20, power exponent 1.0, min
        // output -32767, max output 32767, power min 0, CRC
        "80 8F 00 01 00 01 00 00 000003E8 00000000 00000064 00000FA0 00000800 00000014 00010000 FFFF8001 \
         00007FFF 00000000 485C",
    );
}

#[test]
fn a_pin_of_generation_4_takes_53_bytes() {
    let mut changes = JOYSTICK.to_vec();
    changes.extend([
        ("pin.1.min_action", "m1_safe_stop"),
        ("pin.1.max_action", "m2_safe_stop"),
        ("pin.1.low_pass", "6"),
    ]);
    assert_bytes(
        "mcp266",
        FOUR,
        &changes,
        // address, command 143, index 0, type, mode, target, min action 0x0001, max action 0x0100 (u16 each),
        // low pass 6, then as in generation 1, then potentiometer 0, CRC
        "80 8F 00 01 00 01 0001 0100 06 000003E8 00000000 00000064 00000FA0 00000800 00000014 00010000 \
         FFFF8001 00007FFF 00000000 00000000 E6A4",
    );
}

#[test]
fn narrow_and_signed_fields_are_written_as_the_generation_has_them() {
    // address, command 160, motor 1: mode 1 in bit 7 and 0.5 s in the rest, motor 2: 0, CRC
    assert_bytes(
        "mcp266",
        FOUR,
        &[("motor1.idle.mode", "1"), ("motor1.idle.delay_seconds", "0.5")],
        "80 A0 85 00 84C9",
    );
    // address, command 115, main battery -0.3 V, logic battery 0, CRC
    assert_bytes("mcp266", FOUR, &[("limits.main_battery.offset_volts", "-0.3")], "80 73 FD 00 39FD");
    // address, command 109, motor 1: 1000 counts/s, motor 2: off (u32 each), CRC
    assert_bytes(
        "mcp266",
        Generation::Gen3,
        &[("motor1.error_limit.speed", "1000")],
        "80 6D 000003E8 00000000 B5E3",
    );
    // address, command 109, motor 1: 1000 counts/s, motor 2: off (u16 each), CRC
    assert_bytes("mcp266", FOUR, &[("motor1.error_limit.speed", "1000")], "80 6D 03E8 0000 7ECA");
    // address, command 137, second output, over-voltage, CRC
    assert_bytes("mcp266", ONE, &[("dout.2.action", "over_voltage")], "80 89 01 07 3B25");
}

#[test]
fn bits_of_a_word_leave_its_other_bits_alone() {
    let table = table("roboclaw-2x7a", ONE);
    let mut ram = table.default_image();
    // Bit 11 has no row; bits 0 and 1 say packet serial, bit 9 address number 2.
    for (key, value) in [
        ("roboclaw.config.word", SettingValue::Int(0x0A03)),
        ("roboclaw.config.mode", SettingValue::Choice("packet_serial")),
        ("roboclaw.config.address", SettingValue::Int(2)),
    ] {
        ram.set(key, value);
    }
    let changes = image(&table, &[("roboclaw.config.mode", "simple_serial")]);
    let plan = plan(&table, &ram, &changes, REAL).expect("it can be written");
    assert_eq!(plan.steps[0].arguments, [("config", 0x0A02)]);
    assert_eq!(plan.steps[0].stage, Stage::OwnPort);
    assert!(plan.warnings[0].to_string().contains("the link may be lost"), "{:?}", plan.warnings);
}

#[test]
fn changes_of_one_command_are_one_step_and_nothing_else_is_written() {
    let table = table("mcp266", ONE);
    let changes = [
        ("motor1.velocity.p", "2"),
        ("motor1.velocity.qpps", "10000"),
        ("motor2.velocity.p", "2"),
        ("pin.3.type", "analog"),
        ("pin.3.max", "3000"),
    ];
    let plan = plan_of(&table, &changes, REAL);
    let commands: Vec<u8> = plan.steps.iter().map(|step| step.command).collect();
    assert_eq!(commands, [28, 29, 143]);
    let no_changes = SettingsImage::default();
    let empty = brushwork_link::settings::plan(&table, &table.default_image(), &no_changes, REAL)
        .expect("nothing is wrong");
    assert!(empty.steps.is_empty() && empty.hidden.is_empty() && empty.warnings.is_empty());
}

#[test]
fn limits_are_written_first_and_the_way_to_the_controller_last() {
    let table = table("mcp266", FOUR);
    let changes = [
        ("unit.address", "0x81"),
        ("stream.rs232.rate", "9600"),
        ("stream.ttl1.rate", "9600"),
        ("script.autorun_delay", "500"),
        ("priority.1", "pulse"),
        ("priority.2", "serial"),
        ("pin.1.type", "pulse"),
        ("pin.1.target", "both"),
        ("dout.1.action", "over_voltage"),
        ("motor1.velocity.p", "2"),
        ("motor2.current.max_amps", "10"),
    ];
    let options = WriteOptions { own_stream: Some(Stream::Rs232), simulated: false, as_read: false };
    let plan = plan_of(&table, &changes, options);
    let order: Vec<(u8, Stage)> = plan.steps.iter().map(|step| (step.command, step.stage)).collect();
    assert_eq!(
        order,
        [
            (134, Stage::Limits),
            (28, Stage::Motors),
            (137, Stage::Outputs),
            (143, Stage::Pins),
            (145, Stage::Ports),
            (139, Stage::Priorities),
            (246, Stage::Autonomy),
            (141, Stage::Address),
            (145, Stage::OwnPort),
        ]
    );
    assert_eq!(
        plan.warnings,
        [
            "The controller answers to its new address from then on; save it, or a power cycle brings the \
             old one back.",
            "This program is connected through RS232 UART0, which changes to 9600 bit/s: connect again at \
             that rate.",
            "DIN1/AN1/P1/TX3 commands both motors as soon as this is written, since pulse inputs are at \
             priority level 1: the motor can start.",
            "A stored script starts 500 ms after each power-up and can move the motors.",
            "DIN1/AN1/P1/TX3 is set to pulse, but TTL UART3 is in use and holds the pin. Disable TTL UART3, or \
             set the pin to None.",
        ]
    );
}

#[test]
fn what_keeps_this_program_from_arming_or_changes_what_duty_means_is_told() {
    let usb = WriteOptions { own_stream: Some(Stream::Usb), simulated: false, as_read: false };
    let warnings = |changes: &[(&str, &str)]| plan_of(&table("mcp266", ONE), changes, usb).warnings;
    assert_eq!(
        warnings(&[("stream.usb.timeout", "0")]),
        ["USB has no time-out then: the motors would go on if this program died, so it cannot be armed."]
    );
    assert_eq!(
        warnings(&[("priority.1", "disabled")]),
        ["Serial is at no priority level then, so this program cannot be armed to move motors."]
    );
    assert_eq!(warnings(&[("motor1.resistance_ohms", "0.1")]), [""; 0]);
    assert_eq!(
        warnings(&[("motor1.resistance_ohms", "0.1"), ("motor1.inductance_henries", "0.2 mH")]),
        ["Motor 1 has both L and R then: duty commands set its current instead of its voltage, and duty 0 \
          lets it coast."]
    );
    assert_eq!(warnings(&[("stream.usb.rate", "9600")]), [""; 0], "a rate means nothing on USB");
}

#[test]
fn mixing_alone_says_which_address_goes_with_it_where_none_is_reported() {
    let plan = plan_of(&table("mcp266", ONE), &[("unit.mixing", "yes")], REAL);
    assert!(
        plan.warnings[0].to_string().contains("0x80 is written, the address this link speaks to"),
        "{:?}",
        plan.warnings
    );
    assert_eq!(plan_of(&table("mcp266", FOUR), &[("unit.mixing", "yes")], REAL).warnings, [""; 0]);
}

#[test]
fn one_change_that_cannot_be_written_refuses_all() {
    let table = table("mcp266", ONE);
    let reported = refused(&table, &[("motor1.velocity.p", "2"), ("motor1.current.max_amps", "80")]);
    assert_eq!(reported, ["Motor 1: maximum current 80.00 A is above the MCP266's 60.00 A."]);
    let reported = refused(&table, &[("unit.bridge_channels", "yes")]);
    assert!(
        reported[0].starts_with("Bridge channels is not written. No packet serial command"),
        "{reported:?}"
    );
    let reported = refused(&table, &[("pin.1.min_action", "m1_off")]);
    assert!(reported[0].contains("The numbers of the actions in generation 1 are a guess"), "{reported:?}");
    let reported =
        refused(&table, &[("limits.main_battery.min_volts", "30"), ("limits.main_battery.max_volts", "24")]);
    assert_eq!(reported, ["Main battery minimum 30.0 V would be above Main battery maximum 24.0 V."]);
    let mut unknown = SettingsImage::default();
    unknown.set("motor3.velocity.p", SettingValue::Number(1.0));
    let refusals = plan(&table, &table.default_image(), &unknown, REAL).expect_err("there are two motors");
    assert_eq!(
        refusals[0].sentence,
        "The MCP266 with firmware generation 1 has no setting motor3.velocity.p."
    );
}

#[test]
fn a_command_whose_other_fields_are_not_known_is_not_written() {
    let table = table("mcp266", ONE);
    let mut ram = table.default_image();
    ram.remove("motor1.velocity.d");
    let refusals =
        plan(&table, &ram, &image(&table, &[("motor1.velocity.p", "2")]), REAL).expect_err("D is not known");
    assert_eq!(
        refusals[0].sentence,
        "Motor 1: velocity P cannot be written, since Motor 1: velocity D shares its command and its value \
         is not known."
    );
}

#[test]
fn what_has_no_wire_form_is_planned_past_the_wire_on_a_simulated_controller_only() {
    let table = table("mcp266", ONE);
    let plan = plan_of(&table, &[("unit.bridge_channels", "yes"), ("can.rate", "500000")], SIMULATED);
    assert!(plan.steps.is_empty());
    assert_eq!(plan.hidden, [("unit.bridge_channels".to_owned(), 1), ("can.rate".to_owned(), 500_000)]);
}

#[test]
fn bridging_the_channels_comes_with_its_wiring_warning() {
    let options = WriteOptions { own_stream: Some(Stream::Usb), simulated: true, as_read: false };
    let warnings =
        |on: &str| plan_of(&table("mcp266", ONE), &[("unit.bridge_channels", on)], options).warnings;
    assert!(warnings("yes")[0].to_string().contains("only after this is written and saved to EEPROM"));
}
