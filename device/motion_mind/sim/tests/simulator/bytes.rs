//! The simulated Motion Mind 3, asked through the bytes of its manual, mode by mode.

use std::time::Duration;

use brushwork_motion_mind_sim::{
    EncoderDecode, Mode, MotionMind, MotionMindBus, MotionMindConfig, Protocol, assumed, pin,
};
use brushwork_motion_mind_wire::{
    Address, Command, Part, REGISTERS, encode_frame, encode_line, function, function2, status,
};
use brushwork_plant::machine::{Machine, StreamIndex};
use brushwork_plant::world::{PinSignal, WorldAction};
use brushwork_values::Motor;

use crate::bench::{Bench, PATIENCE, UNIT_1, positioner};

const LOOP: Duration = Duration::from_millis(5);

#[test]
fn the_frames_of_the_manual_are_answered_with_its_bytes() {
    let mut bench = Bench::new(Mode::Serial);
    // 5.7.1: WRITE VELOCITYLIMIT 100; 5.10.1: READ REGISTER.
    assert_eq!(bench.raw(&[0x18, 0x01, 0x01, 0x64, 0x00, 0x7E]), [0x06]);
    assert_eq!(bench.get("VELOCITYLIMIT"), 100);
    assert_eq!(bench.raw(&[0x18, 0x01, 0x01, 0xFF, 0x03, 0x1C]), [0x06]);
    assert_eq!(bench.raw(&[0x1D, 0x01, 0x01, 0x1F]), [0x01, 0xFF, 0x03, 0x03]);
    // POSITION 20000: 0x4E20.
    assert_eq!(bench.raw(&[0x18, 0x01, 0x00, 0x20, 0x4E, 0x00, 0x00, 0x87]), [0x06]);
    assert_eq!(bench.raw(&[0x1A, 0x01, 0x01, 0x00, 0x00, 0x00, 0x1C]), [0x01, 0x20, 0x4E, 0x00, 0x00, 0x6F]);
    // All registers: 70 bytes between address and checksum.
    assert_eq!(bench.raw(&[0x1A, 0x01, 0xFF, 0xFF, 0xFF, 0xFF, 0x17]).len(), 72);
    assert_eq!(bench.raw(&[0x1C, 0x01, 0x1D]), [0x06]);
}

#[test]
fn wrong_checksums_other_addresses_pauses_and_broadcasts_are_met_with_silence() {
    let mut bench = Bench::new(Mode::Serial);
    let good = encode_frame(UNIT_1, &Command::ChangeSpeed(500)).expect("it has a binary form");
    let mut wrong = good.clone();
    wrong[4] ^= 1;
    assert!(bench.raw(&wrong).is_empty());
    let other =
        encode_frame(Address::unit(2).expect("a unit"), &Command::ChangeSpeed(500)).expect("it has one");
    assert!(bench.raw(&other).is_empty());
    let (head, tail) = good.split_at(2);
    bench.bus.receive(StreamIndex::Usb, head);
    bench.run(Duration::from_millis(6));
    assert!(bench.raw(tail).is_empty());
    assert_eq!(bench.get("PWMOUT"), 0);
    let all = encode_frame(Address::BROADCAST, &Command::ChangeSpeed(500)).expect("it has a binary form");
    assert!(bench.raw(&all).is_empty());
    bench.seconds(0.2);
    assert_eq!(bench.get("PWMOUT"), 500, "a broadcast is executed");
    assert_eq!(bench.raw(&good), [0x06]);
}

#[test]
fn bytes_one_at_a_time_make_a_command() {
    let mut bench = Bench::new(Mode::Serial);
    let frame = encode_frame(UNIT_1, &Command::ReadRegister(1)).expect("it has a binary form");
    for byte in &frame[..3] {
        bench.bus.receive(StreamIndex::Usb, &[*byte]);
        bench.run(Duration::from_millis(4));
    }
    assert_eq!(bench.raw(&frame[3..]).len(), 4);
}

#[test]
fn the_ramp_of_the_manual_takes_five_seconds() {
    let mut bench = Bench::new(Mode::Serial);
    bench.set("VELOCITYLIMIT", 10);
    bench.set("TIMER", 10);
    bench.tell(Command::ChangeSpeed(1000));
    bench.seconds(4.8);
    assert!((950..1000).contains(&bench.get("PWMOUT")), "{}", bench.get("PWMOUT"));
    bench.seconds(0.3);
    assert_eq!(bench.ask("PWMOUT"), 1000);
    assert!(bench.ask("VELOCITY") > 0 && bench.ask("POSITION") > 0);
    bench.set("PWMLIMIT", 512);
    bench.seconds(0.02);
    assert_eq!(bench.ask("PWMOUT"), 512);
    assert_ne!(bench.ask("STATUS") & i64::from(status::PWMLIMIT), 0);
}

#[test]
fn a_write_is_gone_after_a_power_cycle_and_a_store_is_not() {
    let mut bench = Bench::new(Mode::Serial);
    bench.set("PTERM", 1234);
    bench.store("ITERM", 77);
    assert_eq!((bench.ask("PTERM"), bench.ask("ITERM")), (1234, 77));
    bench.power_cycle();
    assert_eq!((bench.ask("PTERM"), bench.ask("ITERM")), (6000, 77));
    bench.tell(Command::Restore);
    assert_eq!((bench.ask("ITERM"), bench.unit().stored(5)), (35, 35));
}

#[test]
fn a_store_stops_the_motor_and_answers_after_the_eeprom_is_written() {
    let mut bench = Bench::new(Mode::Serial);
    bench.tell(Command::ChangeSpeed(800));
    bench.seconds(0.5);
    assert_eq!(bench.get("PWMOUT"), 800);
    let before = bench.bus.now();
    let frame =
        encode_frame(UNIT_1, &Command::WriteStore { register: 5, value: 1 }).expect("it has a binary form");
    assert_eq!(bench.bus.exchange(&frame, PATIENCE), [0x06]);
    let took = bench.bus.now() - before;
    assert!((40..=50).contains(&took.as_millis()), "{took:?}");
    bench.seconds(0.5);
    assert_eq!(bench.get("PWMOUT"), 0, "and it does not start again");
}

#[test]
fn out_of_range_values_and_read_only_registers_are_acknowledged() {
    let mut bench = Bench::new(Mode::Serial);
    bench.set("VELOCITYLIMIT", 0);
    bench.set("PWMLIMIT", 0);
    assert_eq!(bench.ask("PWMLIMIT"), 0);
    bench.set("REVISION", 99);
    assert_eq!(bench.ask("REVISION"), i64::from(assumed::REVISION));
    bench.tell(Command::MoveToAbsolute(1000));
    bench.seconds(0.5);
    assert_eq!(bench.get("POSITION"), 0, "mode 3 has no moves");
}

#[test]
fn the_return_bits_replace_the_acknowledge_of_moves_and_not_of_writes() {
    let mut bench = Bench::new(Mode::SerialPid);
    bench.set("POSITION", 1000);
    bench.set("FUNCTION", i64::from(function::RETPOS | function::RETTIME));
    let frame = encode_frame(UNIT_1, &Command::MoveToAbsolute(1000)).expect("it has a binary form");
    let reply = bench.raw(&frame);
    assert_eq!((reply.len(), &reply[..5]), (10, &[0x01, 0xE8, 0x03, 0x00, 0x00][..]));
    assert_eq!(bench.raw(&[0x18, 0x01, 0x02, 0x80, 0x9B]), [0x06]);
}

#[test]
fn a_move_ends_in_position_and_a_relative_one_adds_to_it() {
    let mut bench = positioner();
    bench.tell(Command::MoveToAbsolute(2000));
    assert_eq!(bench.ask("DESIREDPOSITION"), 2000);
    bench.seconds(3.0);
    assert!((bench.ask("POSITION") - 2000).abs() <= 5, "{}", bench.ask("POSITION"));
    bench.tell(Command::MoveToRelative(-500));
    bench.seconds(3.0);
    assert!((bench.ask("POSITION") - 1500).abs() <= 10, "{}", bench.ask("POSITION"));
    bench.set("DEADBAND", 30);
    bench.set("FUNCTION", i64::from(function::ENABLEDB));
    bench.seconds(0.1);
    assert_eq!(bench.ask("PWMOUT"), 0);
    assert_ne!(bench.ask("STATUS") & i64::from(status::INPOSITION), 0);
}

#[test]
fn vellimit_limits_the_velocity_of_a_move() {
    let mut bench = positioner();
    bench.set("VELOCITYLIMIT", 2);
    bench.set("FUNCTION", i64::from(function::VELLIMIT));
    bench.tell(Command::MoveToAbsolute(2000));
    bench.seconds(1.0);
    // Two counts every 5 ms.
    assert!((bench.ask("POSITION") - 400).abs() < 60, "{}", bench.ask("POSITION"));
    assert!((1..=3).contains(&bench.ask("VELOCITY")), "{}", bench.ask("VELOCITY"));
}

#[test]
fn a_velocity_is_kept_in_both_velocity_loops() {
    for newer in [false, true] {
        let mut bench = positioner();
        if newer {
            bench.set("FUNCTION2", i64::from(function2::NEWVELMODE));
            bench.set("PTERM", 10_000);
            bench.set("DTERM", 0);
            bench.set("PIDSCALAR", 10);
        }
        bench.tell(Command::MoveAtVelocity(-10));
        bench.seconds(3.0);
        let velocity = bench.ask("VELOCITY");
        assert!((velocity + 10).abs() <= 1, "NEWVELMODE {newer}: {velocity}");
        if newer {
            assert_eq!(bench.ask("DESIREDPOSITION"), -10, "it shows velocities");
        }
    }
}

#[test]
fn disablepid_takes_the_drive_away() {
    let mut bench = positioner();
    bench.set("FUNCTION", i64::from(function::DISABLEPID));
    bench.tell(Command::MoveToAbsolute(2000));
    bench.seconds(0.5);
    assert_eq!((bench.ask("PWMOUT"), bench.ask("POSITION")), (0, 0));
}

#[test]
fn virtual_limits_and_limit_inputs_stop_one_direction_only() {
    let mut bench = positioner();
    bench.set("VPLIMIT", 800);
    bench.set("FUNCTION", i64::from(function::VIRTLIMIT | function::ACTIVESTOP));
    bench.tell(Command::MoveToAbsolute(3000));
    bench.seconds(2.0);
    let position = bench.ask("POSITION");
    assert!((795..=805).contains(&position), "it is forced to stop at the limit: {position}");
    assert_eq!(bench.ask("STATUS") & i64::from(status::VPLIMIT) != 0, position >= 800);
    bench.tell(Command::MoveToAbsolute(100));
    bench.seconds(2.0);
    assert!((bench.ask("POSITION") - 100).abs() < 20, "{}", bench.ask("POSITION"));
    bench.volts(pin::NEGATIVE_LIMIT, 0.0);
    bench.seconds(0.2);
    bench.tell(Command::MoveToAbsolute(-2000));
    bench.seconds(1.0);
    assert!(bench.ask("POSITION") > -50, "{}", bench.ask("POSITION"));
    assert_ne!(bench.ask("STATUS") & i64::from(status::NEGLIMIT), 0);
}

#[test]
fn a_move_at_a_velocity_loses_its_drive_at_the_virtual_limit_in_both_forms() {
    for form in [0, function2::NEWVELMODE] {
        let mut bench = positioner();
        bench.set("FUNCTION", i64::from(function::VIRTLIMIT | function::ACTIVESTOP));
        bench.set("FUNCTION2", i64::from(form));
        bench.set("VPLIMIT", 4000);
        bench.tell(Command::MoveAtVelocity(10));
        bench.seconds(8.0);
        let turned = bench.unit().truth().motor_radians;
        assert_ne!(bench.ask("STATUS") & i64::from(status::VPLIMIT), 0, "{form}");
        bench.seconds(1.0);
        let since = bench.unit().truth().motor_radians - turned;
        assert!(since.abs() < 0.01, "{form}: it stands, and turned by {since} rad in a second");
    }
}

#[test]
fn what_mode_1_is_wired_for_counts_from_the_first_moment_on() {
    let mut bench = Bench::new(Mode::Analog);
    bench.power_cycle();
    for _ in 0..200 {
        bench.seconds(0.005);
        assert_eq!(bench.unit().duty(), 0.0, "a stick at rest moves nothing at power-up");
    }
}

#[test]
fn the_limit_of_the_current_settles() {
    for limit in [20, 60, 150, 400] {
        let mut bench = Bench::new(Mode::Serial);
        bench.bus.apply(0, &WorldAction::LockShaft { motor: Motor::M1, on: true });
        bench.set("AMPSLIMIT", limit);
        bench.tell(Command::ChangeSpeed(1023));
        bench.seconds(2.0);
        let duties: Vec<_> = (0..40)
            .map(|_| {
                bench.seconds(0.005);
                bench.ask("PWMOUT")
            })
            .collect();
        let (low, high) = (duties.iter().min().unwrap(), duties.iter().max().unwrap());
        println!("{limit}: {low} to {high}");
        assert!(high - low <= 40, "at {limit} the drive goes from {low} to {high}");
    }
}

#[test]
fn the_brake_input_and_heat_open_the_bridge() {
    let mut bench = Bench::new(Mode::Serial);
    bench.tell(Command::ChangeSpeed(900));
    bench.seconds(1.0);
    let fast = bench.ask("VELOCITY");
    bench.volts(pin::BRAKE, 0.0);
    bench.seconds(2.0);
    assert!(bench.ask("VELOCITY") < fast / 10);
    assert_ne!(bench.ask("STATUS") & i64::from(status::BRAKE), 0);
    bench.volts(pin::BRAKE, 5.0);
    bench.seconds(1.0);
    assert!(bench.ask("VELOCITY") > fast / 2);
    for (celsius, is_off) in [(85.0, false), (95.0, true), (85.0, true), (75.0, false)] {
        bench.bus.apply(0, &WorldAction::SetBoardCelsius { celsius: Some(celsius) });
        bench.seconds(0.1);
        assert_eq!(bench.ask("STATUS") & i64::from(status::TEMPFAULT) != 0, is_off, "{celsius} degrees");
    }
    // 25 degrees read as 952.5 by the manual's formula.
    bench.bus.apply(0, &WorldAction::SetBoardCelsius { celsius: Some(25.0) });
    assert!((952..=953).contains(&bench.ask("THERMISTOR")));
    bench.set("FUNCTION2", i64::from(function2::OVERTEMP));
    bench.bus.apply(0, &WorldAction::SetBoardCelsius { celsius: Some(120.0) });
    bench.seconds(0.1);
    assert_eq!(bench.ask("STATUS") & i64::from(status::TEMPFAULT), 0, "the bit switches the protection off");
}

#[test]
fn a_locked_motor_is_held_at_the_limit_of_its_current() {
    let mut bench = Bench::new(Mode::Serial);
    bench.bus.apply(0, &WorldAction::LockShaft { motor: Motor::M1, on: true });
    bench.set("AMPSLIMIT", 0);
    bench.tell(Command::ChangeSpeed(1023));
    bench.seconds(1.0);
    let free = bench.ask("AMPS");
    let limit = free / 3;
    bench.set("AMPSLIMIT", limit);
    bench.seconds(1.0);
    let held = bench.ask("AMPS");
    assert!((held - limit).abs() <= limit / 4 + 2, "limit {limit}, current {held}, without limit {free}");
    assert!(bench.ask("PWMOUT") < 600);
}

#[test]
fn a_stick_drives_mode_0_and_a_bad_pulse_stops_it() {
    let mut bench = Bench::new(Mode::RadioControl);
    for (milliseconds, duty) in [(1.5, 0), (2.0, 1023), (1.0, -1023), (1.51, 0), (2.3, 1023)] {
        bench.pulse(milliseconds);
        bench.seconds(0.3);
        assert!((bench.ask("PWMOUT") - duty).abs() <= 2, "{milliseconds} ms: {}", bench.ask("PWMOUT"));
    }
    assert_eq!(bench.ask("RCCOUNT"), 1325);
    for signal in [PinSignal::Open, PinSignal::Pulse { microseconds: 2600.0 }] {
        bench.pulse(2.0);
        bench.seconds(0.5);
        bench.pin(pin::INDEX_RC, signal);
        bench.seconds(0.2);
        assert_eq!(bench.ask("PWMOUT"), 0);
        assert_ne!(bench.ask("STATUS") & i64::from(status::BADRC), 0);
    }
    bench.set("FUNCTION", i64::from(function::LASTRC));
    bench.pulse(2.0);
    bench.seconds(1.0);
    bench.pin(pin::INDEX_RC, PinSignal::Open);
    bench.seconds(0.5);
    assert_eq!(bench.ask("PWMOUT"), 1023, "the mean of the good pulses goes on");
}

#[test]
fn the_step_pin_or_velocitylimit_after_a_reset_slows_mode_1() {
    let mut bench = Bench::new(Mode::Analog);
    bench.volts(pin::ANALOG_CONTROL, 5.0);
    bench.seconds(0.2);
    assert_eq!(bench.ask("PWMOUT"), 1023);
    bench.volts(pin::ANALOG_CONTROL, 2.5);
    bench.seconds(0.2);
    assert_eq!(bench.ask("PWMOUT"), 0);
    bench.store("VELOCITYLIMIT", 10);
    bench.store("FUNCTION", i64::from(function::ADSTEP));
    bench.volts(pin::ANALOG_CONTROL, 0.0);
    bench.seconds(0.2);
    assert_eq!(bench.ask("PWMOUT"), -1023, "the bit acts after a reset only");
    bench.volts(pin::ANALOG_CONTROL, 2.5);
    bench.tell(Command::Reset);
    bench.seconds(0.6);
    bench.volts(pin::ANALOG_CONTROL, 0.0);
    bench.seconds(1.0);
    let duty = bench.ask("PWMOUT");
    assert!((-230..=-180).contains(&duty), "20 updates of 10: {duty}");
    // One direction: ANA_MODE open, ANA_DIR at ground is reverse.
    bench.pin(pin::NEGATIVE_LIMIT, PinSignal::Open);
    bench.volts(pin::POSITIVE_LIMIT, 0.0);
    bench.volts(pin::ANALOG_CONTROL, 0.5);
    bench.seconds(3.0);
    assert_eq!(bench.ask("PWMOUT"), -102);
}

#[test]
fn buttons_step_the_drive_and_rest_at_zero() {
    let mut bench = Bench::new(Mode::Buttons);
    bench.volts(pin::POSITIVE_LIMIT, 0.0);
    bench.seconds(0.5);
    let up = bench.ask("PWMOUT");
    assert!((400..=1023).contains(&up), "{up}");
    bench.volts(pin::POSITIVE_LIMIT, 5.0);
    bench.seconds(0.5);
    let kept = bench.ask("PWMOUT");
    bench.seconds(0.5);
    assert_eq!(bench.ask("PWMOUT"), kept, "free buttons change nothing");
    bench.volts(pin::NEGATIVE_LIMIT, 0.0);
    let mut at_zero = Duration::ZERO;
    while bench.get("PWMOUT") >= 0 && bench.bus.now() < Duration::from_secs(10) {
        at_zero += if bench.get("PWMOUT") == 0 { LOOP } else { Duration::ZERO };
        bench.run(LOOP);
    }
    assert!((190..=260).contains(&at_zero.as_millis()), "stood for {at_zero:?}");
}

#[test]
fn mode_5_follows_its_voltage_on_an_analog_encoder() {
    let mut config = MotionMindConfig::new(Mode::AnalogPid);
    config.world.axes[0] = brushwork_plant::presets::lookup("linear-actuator")
        .expect("there is a preset with an analog encoder")
        .axis
        .clone();
    let mut bench = Bench::of(config);
    for (name, value) in [("PTERM", 60_000), ("ITERM", 10), ("DTERM", 6000), ("PIDSCALAR", 12)] {
        bench.set(name, value);
    }
    bench.set("FUNCTION", i64::from(function::SATPROT));
    let start = bench.ask("POSITION");
    assert_eq!(bench.get("POSITION"), bench.get("ANALOGFBCK"));
    let goal = if start > 512 { start - 150 } else { start + 150 };
    bench.volts(pin::ANALOG_CONTROL, goal as f64 / 1023.0 * 5.0);
    bench.seconds(15.0);
    assert!((bench.ask("POSITION") - goal).abs() <= 12, "from {start} to {goal}: {}", bench.ask("POSITION"));
    bench.set("FUNCTION", i64::from(function::SATPROT | function::ADSERIAL));
    bench.tell(Command::MoveToAbsolute(i32::try_from(start).expect("small")));
    bench.seconds(15.0);
    assert!((bench.ask("POSITION") - start).abs() <= 12, "{}", bench.ask("POSITION"));
}

#[test]
fn mode_5_multiplies_its_voltage_for_an_encoder() {
    let mut bench = Bench::new(Mode::AnalogPid);
    for (name, value) in [("PTERM", 20_000), ("ITERM", 0), ("DTERM", 40_000), ("PIDSCALAR", 11)] {
        bench.set(name, value);
    }
    bench.set("FUNCTION", i64::from(function::RCPOS));
    bench.set("FUNCTION2", i64::from(function2::ADX2 | function2::ADX8));
    bench.volts(pin::ANALOG_CONTROL, 1.0);
    bench.seconds(3.0);
    // 1 V is 205 of 1023; the highest of the bits wins.
    assert_eq!(bench.ask("DESIREDPOSITION"), 205 * 8);
    assert!((bench.ask("POSITION") - 1640).abs() <= 10, "{}", bench.ask("POSITION"));
}

#[test]
fn mode_6_restores_the_factory_values_with_both_limits_at_ground() {
    for at_ground in [false, true] {
        let mut config = MotionMindConfig::new(Mode::FactoryRestore);
        if at_ground {
            config.signals = [pin::POSITIVE_LIMIT, pin::NEGATIVE_LIMIT]
                .map(|pin| (pin, PinSignal::Volts { volts: 0.0 }))
                .to_vec();
        }
        let mut bench = Bench::of(config);
        bench.store("ITERM", 99);
        bench.power_cycle();
        assert_eq!(bench.ask("ITERM"), if at_ground { 35 } else { 99 });
    }
}

#[test]
fn the_position_survives_when_it_is_told_to() {
    let mut bench = positioner();
    bench.store("FUNCTION", i64::from(function::POSPWRUP | function::SAVEPOS));
    bench.set("POSITION", 4321);
    bench.run(assumed::SAVE_POSITION_AFTER - Duration::from_secs(2));
    assert_eq!(bench.unit().stored(0), 0);
    bench.seconds(5.0);
    assert_eq!(bench.unit().stored(0), 4321);
    let writes = bench.unit().eeprom_writes();
    bench.seconds(2.0);
    assert_eq!(bench.unit().eeprom_writes(), writes, "once");
    bench.power_cycle();
    assert_eq!(bench.ask("POSITION"), 4321);
}

#[test]
fn one_edge_in_four_is_counted_when_the_switch_says_so() {
    let mut positions = Vec::new();
    for decode in [EncoderDecode::Times4, EncoderDecode::Times1] {
        let mut bench = Bench::of(MotionMindConfig { decode, ..MotionMindConfig::new(Mode::Serial) });
        bench.tell(Command::ChangeSpeed(1023));
        bench.seconds(1.0);
        positions.push(bench.ask("POSITION"));
    }
    assert!(positions[0] > 100 && (positions[0] - 4 * positions[1]).abs() <= 4, "{positions:?}");
}

#[test]
fn the_rate_changes_with_the_next_power_up() {
    let mut bench = Bench::new(Mode::Serial);
    assert_eq!(bench.bus.bits_per_second(StreamIndex::Usb), 19_200);
    bench.store("FUNCTION2", i64::from(function2::BAUD38400));
    assert_eq!(bench.bus.bits_per_second(StreamIndex::Usb), 19_200);
    bench.power_cycle();
    assert_eq!(bench.bus.bits_per_second(StreamIndex::Usb), 38_400);
    bench.store("FUNCTION2", i64::from(function2::BAUD38400 | function2::BAUD115200));
    bench.power_cycle();
    assert_eq!(bench.bus.bits_per_second(StreamIndex::Usb), 115_200);
}

/// Text that comes back for text.
fn say(bus: &mut MotionMindBus, line: &str) -> String {
    String::from_utf8(bus.exchange(line.as_bytes(), PATIENCE)).expect("text is ASCII")
}

fn in_text(mode: Mode) -> MotionMindBus {
    let config = MotionMindConfig { protocol: Protocol::Text, ..MotionMindConfig::new(mode) };
    MotionMindBus::new(vec![MotionMind::new(config).expect("the preset is sound")])
}

#[test]
fn the_lines_of_the_manual_are_answered_with_its_text() {
    let mut bus = in_text(Mode::SerialPid);
    assert_eq!(say(&mut bus, "R01 04\r\n"), "PTRM=6000\r\n");
    assert_eq!(say(&mut bus, "W01 00 -10000\r\n"), "OK\r\n");
    assert_eq!(say(&mut bus, "R01 00\r\n"), "APOS=-10000\r\n");
    assert_eq!(say(&mut bus, "W01 01 120\r\n"), "OK\r\n");
    assert_eq!(say(&mut bus, "HELLO\r\n"), "BAD COMMAND\r\n");
    assert_eq!(say(&mut bus, "Q02 1\r\n"), "", "another unit's mistake");
    assert_eq!(say(&mut bus, "V99 0\r\n"), "", "to all");
    let all = say(&mut bus, "R01 99\r\n");
    assert_eq!((all.matches(',').count(), all.ends_with(",\r\n")), (REGISTERS.len(), true), "{all}");
    assert!(all.starts_with("-10000,120,128,0,6000,35,0,1,14,10,"), "{all}");
    let bits = say(&mut bus, "R01 97\r\n");
    assert_eq!((bits.lines().count(), bits.lines().next()), (10, Some("S0OFF")));
    assert_eq!(say(&mut bus, "R01 98\r\n").lines().count(), 16);
    let set =
        encode_line(UNIT_1, &Command::Write { register: 3, value: 7 << 1 }).expect("it has a form in text");
    assert_eq!(say(&mut bus, &set), "OK\r\n");
    let returned = say(&mut bus, "P01 -0010000\r\n");
    assert!(returned.starts_with("APOS=-10000\r\nVELO=0\r\nTIME="), "{returned}");
    assert_eq!(Part::from_index(97), Some(Part::StatusBits));
}

#[test]
fn a_self_test_needs_a_power_cycle() {
    let mut bus = in_text(Mode::Serial);
    assert_eq!(say(&mut bus, "Z01\r\n"), "");
    assert_eq!(say(&mut bus, "R01 04\r\n"), "");
    for on in [false, true] {
        bus.apply(0, &WorldAction::Power { on });
        let now = bus.now();
        bus.advance(now + Duration::from_secs(2));
    }
    assert_eq!(say(&mut bus, "R01 04\r\n"), "PTRM=6000\r\n");
}

#[test]
fn units_on_one_wire_answer_each_to_its_own_address() {
    let unit = |number| {
        let address = Address::unit(number).expect("a unit");
        MotionMind::new(MotionMindConfig { address, ..MotionMindConfig::new(Mode::Serial) }).expect("sound")
    };
    let mut bus = MotionMindBus::new(vec![unit(1), unit(2), unit(7)]);
    for number in [1, 2, 7] {
        let frame = encode_frame(Address::unit(number).expect("a unit"), &Command::ReadRegister(7));
        let reply = bus.exchange(&frame.expect("it has a binary form"), PATIENCE);
        assert_eq!(reply, [number, number, number * 2], "address, ADDRESS, checksum");
    }
    let stop = encode_frame(Address::BROADCAST, &Command::ChangeSpeed(300)).expect("it has a binary form");
    assert!(bus.exchange(&stop, PATIENCE).is_empty());
    assert!(bus.motion_minds().iter().all(|unit| unit.read_one(21) == 300));
}

#[test]
fn the_same_bytes_at_the_same_times_give_the_same_run() {
    let run = || {
        let mut bench = positioner();
        bench.tell(Command::MoveToAbsolute(1500));
        bench.seconds(1.0);
        (bench.get("POSITION"), bench.get("AMPS"), format!("{:?}", bench.unit().view().axes[0].truth))
    };
    assert_eq!(run(), run());
}
