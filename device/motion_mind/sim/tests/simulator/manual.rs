//! The simulated Motion Mind 3 against its manual, bit by bit: each bit of FUNCTION, FUNCTION2 and STATUS acts, each sub-mode works.
//!
//! What is tested elsewhere: commands, replies, limits, modes 1 to 6 and power cycles in `motion_mind`, the bytes of all vectors in
//! the protocol's own tests.

use std::time::Duration;

use brushwork_motion_mind_sim::{Mode, MotionMindConfig, Protocol, assumed, pin};
use brushwork_motion_mind_wire::{Command, REGISTERS, encode_frame, function, function2, status};
use brushwork_plant::bridge::BridgeOutput;
use brushwork_plant::machine::{Machine, StreamIndex};
use brushwork_plant::presets;
use brushwork_plant::world::{PinSignal, WorldAction};
use brushwork_plant::{EncoderKind, ShaftSide};
use brushwork_values::Motor;

use crate::bench::{Bench, PATIENCE, UNIT_1, positioner};

const LOOP: Duration = Duration::from_millis(5);

fn bit(word: u16) -> i64 {
    i64::from(word)
}

fn has(bench: &Bench, word: u16) -> bool {
    bench.get("STATUS") & bit(word) != 0
}

fn output(bench: &Bench) -> BridgeOutput {
    bench.unit().view().axes[0].output
}

/// How long a unit is deaf after its power has come back.
fn power_up_time(bench: &mut Bench) -> Duration {
    bench.bus.apply(0, &WorldAction::Power { on: false });
    bench.seconds(0.1);
    bench.bus.apply(0, &WorldAction::Power { on: true });
    let begun_at = bench.bus.now();
    let ask = encode_frame(UNIT_1, &Command::ReadRegister(18)).expect("it has a binary form");
    while bench.raw(&ask).is_empty() {
        assert!(bench.bus.now() < begun_at + Duration::from_secs(10), "it wakes up");
    }
    bench.bus.now() - begun_at
}

#[test]
fn the_light_blinks_once_more_than_the_mode_at_power_up_unless_it_is_switched_off() {
    // 3.2: 300 ms on and 100 ms off a blink.
    for mode in Mode::ALL {
        let mut bench = Bench::new(mode);
        let blinks = Duration::from_millis(400) * (u32::from(mode.number()) + 1);
        let took = power_up_time(&mut bench);
        assert!((blinks..blinks + Duration::from_millis(250)).contains(&took), "{mode}: {took:?}");
        bench.store("FUNCTION", bit(function::DISABLEBLINK));
        let took = power_up_time(&mut bench);
        assert!(took < Duration::from_millis(250), "{mode}: {took:?}");
    }
}

#[test]
fn every_register_is_kept_in_ram_and_eeprom_apart_and_what_is_measured_in_neither() {
    for row in &REGISTERS {
        let mut bench = Bench::new(Mode::Serial);
        // The address of the unit, its rate and its power-up stay as they are, so that it can be asked.
        let value = match row.name {
            "ADDRESS" => 1,
            "FUNCTION" => bit(function::SATPROT),
            "FUNCTION2" => bit(function2::ADX4),
            _ => row.range.start().max(&-12_345).saturating_add(3),
        };
        let before = bench.get(row.name);
        bench.store(row.name, value);
        if row.is_writable() {
            assert_eq!(
                (bench.ask(row.name), bench.unit().stored(row.number)),
                (value, value),
                "{}",
                row.name
            );
            bench.set(row.name, value + 1 - i64::from(row.name == "ADDRESS"));
            assert_eq!(bench.unit().stored(row.number), value, "{}: a write leaves EEPROM alone", row.name);
            bench.power_cycle();
            // POSITION starts at 0 unless POSPWRUP is set.
            assert_eq!(bench.ask(row.name), if row.name == "POSITION" { 0 } else { value }, "{}", row.name);
        } else if !["TIME", "RCCOUNT"].contains(&row.name) {
            assert_eq!(bench.ask(row.name), before, "{} is read only", row.name);
        }
    }
}

#[test]
fn time_counts_5_ms_since_power_up() {
    let mut bench = Bench::new(Mode::Serial);
    bench.seconds(10.0);
    assert_eq!(bench.get("TIME"), 2000);
    bench.power_cycle();
    assert_eq!(bench.get("TIME"), 800, "four seconds");
}

#[test]
fn a_pulse_encoder_closes_the_loop_of_mode_4_in_steps_of_217_ns() {
    // 4.7: full scale 4.096 ms is 18,875; a 12 bit encoder gives a microsecond a step.
    let mut config = MotionMindConfig::new(Mode::SerialPid);
    let encoder = &mut config.world.axes[0].encoder;
    encoder.kind = EncoderKind::Pulse;
    encoder.side = ShaftSide::Load;
    encoder.counts_per_turn = 4096.0;
    encoder.start_counts = 1000.0;
    let mut bench = Bench::of(config);
    bench.store("FUNCTION2", bit(function2::PULSEFB));
    bench.power_cycle();
    let start = bench.ask("POSITION");
    assert!((start - 4608).abs() <= 5, "1000 us are 4608 steps: {start}");
    assert_eq!(bench.ask("DESIREDPOSITION"), start, "it holds what it finds");
    for (name, value) in [("PTERM", 3000), ("ITERM", 20), ("DTERM", 12_000), ("PIDSCALAR", 11)] {
        bench.set(name, value);
    }
    bench.tell(Command::MoveToAbsolute(9000));
    bench.seconds(5.0);
    assert!((bench.ask("POSITION") - 9000).abs() <= 40, "{}", bench.ask("POSITION"));
    bench.tell(Command::MoveToRelative(-3000));
    bench.seconds(5.0);
    let there = bench.ask("POSITION");
    assert!((there - 6000).abs() <= 60, "{there}");
    bench.pin(pin::INDEX_RC, PinSignal::Pulse { microseconds: 4096.0 });
    bench.seconds(0.1);
    assert_eq!(bench.ask("POSITION"), 18_876, "the range ends at 4.096 ms");
}

#[test]
fn a_stick_is_a_position_with_rcpos_and_the_count_is_limited_to_its_range() {
    let mut config = MotionMindConfig::new(Mode::RadioControl);
    let actuator = presets::lookup("linear-actuator").expect("a preset with an analog encoder");
    config.world.axes[0] = actuator.axis.clone();
    config.signals = vec![
        (pin::INDEX_RC, PinSignal::Pulse { microseconds: 1500.0 }),
        (pin::ANALOG_FEEDBACK, PinSignal::Encoder { motor: Motor::M1 }),
    ];
    let mut bench = Bench::of(config);
    for (name, value) in [("PTERM", 60_000), ("ITERM", 10), ("DTERM", 6000), ("PIDSCALAR", 12)] {
        bench.set(name, value);
    }
    bench.set("DEADBAND", 3);
    bench.set("FUNCTION", bit(function::RCPOS | function::SATPROT | function::ENABLEDB));
    bench.pulse(1.6);
    bench.seconds(0.2);
    // Between RCMIN 576 and RCMAX 1152, 1.6 ms is 922: 346 of 576.
    assert_eq!(bench.ask("DESIREDPOSITION"), 346 * 1023 / 576);
    bench.seconds(15.0);
    assert!((bench.ask("POSITION") - 614).abs() <= 12, "{}", bench.ask("POSITION"));
    bench.pulse(2.2);
    bench.seconds(0.2);
    assert_eq!((bench.ask("RCCOUNT"), bench.ask("DESIREDPOSITION")), (1152, 1023));
    // The limit inputs act in this sub-mode alone.
    bench.volts(pin::POSITIVE_LIMIT, 0.0);
    bench.seconds(0.2);
    assert!(bench.ask("PWMOUT") <= 0 && has(&bench, status::POSLIMIT));
}

#[test]
fn an_rc_signal_is_bad_after_50_ms_and_only_mode_0_looks_for_one() {
    let mut bench = Bench::new(Mode::RadioControl);
    bench.seconds(1.0);
    bench.pin(pin::INDEX_RC, PinSignal::Open);
    // The last pulse was up to 20 ms ago.
    bench.run(Duration::from_millis(25));
    assert!(!has(&bench, status::BADRC), "the last pulse still holds");
    bench.run(Duration::from_millis(30));
    assert!(has(&bench, status::BADRC));
    for mode in [Mode::Analog, Mode::Buttons, Mode::Serial, Mode::SerialPid, Mode::AnalogPid] {
        let mut bench = Bench::new(mode);
        bench.seconds(1.0);
        assert!(!has(&bench, status::BADRC), "{mode}");
    }
}

#[test]
fn a_stick_is_bad_half_a_millisecond_beyond_its_ends_and_not_before() {
    let mut bench = Bench::new(Mode::RadioControl);
    for (milliseconds, is_bad) in [(0.51, false), (0.49, true), (2.49, false), (2.51, true)] {
        bench.pulse(milliseconds);
        bench.seconds(0.2);
        assert_eq!(has(&bench, status::BADRC), is_bad, "{milliseconds} ms");
    }
    // RCBAND 15 steps of 1736 ns: 1.474 to 1.526 ms stand.
    for (milliseconds, stands) in [(1.475, true), (1.525, true), (1.47, false), (1.53, false)] {
        bench.pulse(milliseconds);
        bench.seconds(0.3);
        assert_eq!(bench.ask("PWMOUT") == 0, stands, "{milliseconds} ms");
    }
}

#[test]
fn lastrc_takes_the_mean_of_64_good_pulses() {
    let mut bench = Bench::new(Mode::RadioControl);
    bench.set("FUNCTION", bit(function::LASTRC));
    bench.pulse(1.2);
    bench.seconds(2.0);
    bench.pulse(1.8);
    // Half of the 64 pulses, one every 20 ms.
    bench.run(Duration::from_millis(20 * 32));
    bench.pin(pin::INDEX_RC, PinSignal::Open);
    bench.seconds(0.3);
    let mean = bench.ask("RCCOUNT");
    assert!((mean - 864).abs() <= 12, "1.5 ms is 864: {mean}");
}

#[test]
fn fastpid_runs_the_loop_ten_times_as_often() {
    let climbs = |fast: bool| {
        let mut bench = Bench::new(Mode::AnalogPid);
        bench.bus.apply(0, &WorldAction::LockShaft { motor: Motor::M1, on: true });
        for (name, value) in [("PTERM", 0), ("ITERM", 1), ("DTERM", 0), ("PIDSCALAR", 4)] {
            bench.set(name, value);
        }
        bench.set("FUNCTION2", if fast { bit(function2::FASTPID) } else { 0 });
        bench.volts(pin::ANALOG_FEEDBACK, 0.0);
        bench.volts(pin::ANALOG_CONTROL, 0.5);
        let begun_at = bench.bus.now();
        while bench.get("PWMOUT") < 512 {
            bench.run(Duration::from_micros(500));
            assert!(bench.bus.now() < begun_at + Duration::from_secs(5), "the integral climbs");
        }
        bench.bus.now() - begun_at
    };
    let (slow, fast) = (climbs(false), climbs(true));
    // 0.5 V is 102: 512 x 16 / 102 = 81 loops, of 5 ms or of 0.5 ms, after the analog input has been read.
    assert!((400..=415).contains(&slow.as_millis()), "{slow:?}");
    assert!((40..=47).contains(&fast.as_millis()), "{fast:?}");
}

#[test]
fn satprot_keeps_the_integral_sum_small_and_stops_it_at_full_drive() {
    let drive = |protected: bool| {
        let mut bench = Bench::new(Mode::SerialPid);
        bench.bus.apply(0, &WorldAction::LockShaft { motor: Motor::M1, on: true });
        for (name, value) in [("PTERM", 0), ("ITERM", 1), ("DTERM", 0), ("PIDSCALAR", 3)] {
            bench.set(name, value);
        }
        bench.set("AMPSLIMIT", 0);
        bench.set("FUNCTION", if protected { bit(function::SATPROT) } else { 0 });
        bench.tell(Command::MoveToAbsolute(100));
        bench.seconds(20.0);
        let wound_up = bench.ask("PWMOUT");
        bench.tell(Command::MoveToAbsolute(0));
        (wound_up, bench.ask("PWMOUT"))
    };
    assert_eq!(drive(true).0, 4096 / 8, "the sum ends at 4096");
    assert_eq!(drive(false).0, 1023, "the sum goes on to 120,000");
}

#[test]
fn the_integral_unwinds_from_where_it_was_stopped() {
    // With SATPROT the sum stands still while the drive is at its limit, PWMLIMIT: so it is soon back.
    let loops_to_reverse = |protected: bool| {
        let mut bench = Bench::new(Mode::AnalogPid);
        bench.bus.apply(0, &WorldAction::LockShaft { motor: Motor::M1, on: true });
        for (name, value) in [("PTERM", 10), ("ITERM", 1), ("DTERM", 0), ("PIDSCALAR", 2), ("PWMLIMIT", 200)]
        {
            bench.set(name, value);
        }
        bench.set("FUNCTION", if protected { bit(function::SATPROT) } else { 0 });
        bench.volts(pin::ANALOG_FEEDBACK, 2.5);
        bench.volts(pin::ANALOG_CONTROL, 3.0);
        bench.seconds(3.0);
        assert_eq!(bench.get("PWMOUT"), 200);
        bench.volts(pin::ANALOG_CONTROL, 2.0);
        let mut loops = 0;
        while bench.get("PWMOUT") > 0 && loops < 10_000 {
            bench.run(LOOP);
            loops += 1;
        }
        loops
    };
    let (protected, free) = (loops_to_reverse(true), loops_to_reverse(false));
    assert!(protected <= 12 && free > 100, "{protected} loops with it, {free} without");
}

#[test]
fn feed_forward_is_the_velocity_times_velocityff_over_255() {
    let mut bench = Bench::new(Mode::SerialPid);
    for (name, value) in [("PTERM", 0), ("ITERM", 0), ("DTERM", 0), ("VELOCITYFF", 255)] {
        bench.set(name, value);
    }
    bench.tell(Command::MoveAtVelocity(300));
    bench.seconds(0.1);
    assert_eq!(bench.ask("PWMOUT"), 300);
    bench.set("VELOCITYFF", 128);
    bench.seconds(0.1);
    assert_eq!(bench.ask("PWMOUT"), 150);
    // A move has it with VELLIMIT alone.
    bench.set("VELOCITYLIMIT", 200);
    bench.tell(Command::MoveToRelative(1_000_000));
    bench.seconds(0.1);
    assert_eq!(bench.ask("PWMOUT"), 0);
    bench.set("FUNCTION", bit(function::VELLIMIT));
    bench.tell(Command::MoveToRelative(1_000_000));
    bench.seconds(0.1);
    assert_eq!(bench.ask("PWMOUT"), 200 * 128 / 255);
}

#[test]
fn activestop_shorts_the_standing_motor_and_without_it_the_leads_float() {
    let mut bench = Bench::new(Mode::Serial);
    bench.seconds(0.1);
    assert_eq!(output(&bench), BridgeOutput::Coast);
    bench.set("FUNCTION", bit(function::ACTIVESTOP));
    bench.seconds(0.1);
    assert_eq!(output(&bench), BridgeOutput::Brake);
    bench.volts(pin::BRAKE, 0.0);
    bench.seconds(0.1);
    assert_eq!(output(&bench), BridgeOutput::Coast, "the brake input opens the bridge");
}

#[test]
fn at_9_and_36_khz_the_bridge_has_nine_bits_and_the_register_ten() {
    for bits in [function2::FREQ_HALF, function2::FREQ_DOUBLE, function2::FREQ_HALF | function2::FREQ_DOUBLE]
    {
        let mut bench = Bench::new(Mode::Serial);
        bench.tell(Command::ChangeSpeed(-301));
        bench.seconds(0.2);
        let fine = output(&bench).duty();
        bench.set("FUNCTION2", bit(bits));
        bench.seconds(0.2);
        assert_eq!((bench.ask("PWMOUT"), fine), (-301, -301.0 / 1023.0));
        assert_eq!(output(&bench).duty(), -300.0 / 1023.0);
    }
}

#[test]
fn each_multiplier_of_mode_5_multiplies_and_the_highest_wins() {
    let mut bench = Bench::new(Mode::AnalogPid);
    bench.bus.apply(0, &WorldAction::LockShaft { motor: Motor::M1, on: true });
    bench.volts(pin::ANALOG_CONTROL, 5.0);
    bench.set("FUNCTION", bit(function::RCPOS));
    for power in 1..=6 {
        let lower = (1 << (power + 2)) - 4;
        for word in [1 << (power + 1), lower] {
            bench.set("FUNCTION2", word);
            bench.seconds(0.05);
            assert_eq!(bench.ask("DESIREDPOSITION"), 1023 << power, "{word:#06X}");
        }
    }
    bench.set("FUNCTION", 0);
    bench.seconds(0.05);
    assert_eq!(bench.ask("DESIREDPOSITION"), 1023, "they need the encoder as feedback");
}

#[test]
fn in_position_is_exact_without_the_dead_band() {
    let mut bench = Bench::new(Mode::SerialPid);
    bench.set("FUNCTION", bit(function::DISABLEPID));
    bench.set("POSITION", 500);
    bench.seconds(0.1);
    assert!(has(&bench, status::INPOSITION));
    bench.tell(Command::MoveToAbsolute(501));
    bench.seconds(0.1);
    assert!(!has(&bench, status::INPOSITION));
    bench.set("FUNCTION", bit(function::DISABLEPID | function::ENABLEDB));
    bench.set("DEADBAND", 1);
    bench.seconds(0.1);
    assert!(has(&bench, status::INPOSITION));
}

#[test]
fn the_dead_band_is_not_for_velocities() {
    let mut bench = positioner();
    bench.set("DEADBAND", 1023);
    bench.set("FUNCTION", bit(function::ENABLEDB));
    bench.tell(Command::MoveAtVelocity(5));
    bench.seconds(2.0);
    assert!((bench.ask("VELOCITY") - 5).abs() <= 1, "{}", bench.ask("VELOCITY"));
}

#[test]
fn the_index_input_shows_in_status_and_keeps_the_position_of_its_edge() {
    let mut bench = Bench::new(Mode::SerialPid);
    bench.set("POSITION", 777);
    bench.volts(pin::INDEX_RC, 5.0);
    bench.seconds(0.1);
    assert!(!has(&bench, status::INDEX) && bench.ask("INDEXPOS") == 0);
    bench.volts(pin::INDEX_RC, 0.0);
    bench.seconds(0.1);
    assert!(has(&bench, status::INDEX));
    assert_eq!(bench.ask("INDEXPOS"), 777);
    bench.set("POSITION", 900);
    bench.seconds(0.1);
    assert_eq!(bench.ask("INDEXPOS"), 777, "the edge alone counts");
}

#[test]
fn limit_inputs_count_after_the_time_of_timer() {
    let mut bench = Bench::new(Mode::SerialPid);
    bench.set("TIMER", 40);
    bench.volts(pin::POSITIVE_LIMIT, 0.0);
    bench.seconds(0.15);
    assert!(!has(&bench, status::POSLIMIT), "200 ms of debounce");
    bench.seconds(0.1);
    assert!(has(&bench, status::POSLIMIT) && !has(&bench, status::NEGLIMIT));
    // TIMER 0 is taken as 1.
    bench.set("TIMER", 0);
    bench.volts(pin::POSITIVE_LIMIT, 5.0);
    bench.run(2 * LOOP);
    assert!(!has(&bench, status::POSLIMIT));
}

#[test]
fn unidirectional_buttons_turn_as_switch_5_says() {
    for (is_fast, up, down) in [(true, 300..=1023, 0..=0), (false, 0..=0, -1023..=-300)] {
        let config = MotionMindConfig { is_fast, ..MotionMindConfig::new(Mode::Buttons) };
        let mut bench = Bench::of(config);
        bench.volts(pin::ANALOG_CONTROL, 0.0);
        for (button, expected) in [(pin::POSITIVE_LIMIT, up), (pin::NEGATIVE_LIMIT, down)] {
            bench.volts(button, 0.0);
            bench.seconds(1.0);
            let duty = bench.ask("PWMOUT");
            assert!(expected.contains(&duty), "switch 5 off {is_fast}, pin {button}: {duty}");
            bench.volts(button, 5.0);
            bench.seconds(0.2);
        }
    }
}

#[test]
fn modes_6_and_7_move_nothing_and_answer() {
    for mode in [Mode::FactoryRestore, Mode::FactoryTest] {
        let mut bench = Bench::new(mode);
        for command in
            [Command::ChangeSpeed(1000), Command::MoveToAbsolute(5000), Command::MoveAtVelocity(50)]
        {
            bench.tell(command);
        }
        bench.seconds(0.5);
        assert_eq!((bench.ask("PWMOUT"), bench.ask("MODE")), (0, i64::from(mode.number())));
    }
}

#[test]
fn what_a_mode_has_no_use_for_is_acknowledged_and_moves_nothing() {
    for (mode, used) in [
        (Mode::RadioControl, [false; 4]),
        (Mode::Analog, [false; 4]),
        (Mode::Buttons, [false; 4]),
        (Mode::Serial, [true, false, false, false]),
        (Mode::SerialPid, [false, true, true, true]),
        (Mode::AnalogPid, [false; 4]),
    ] {
        let commands = [
            Command::ChangeSpeed(600),
            Command::MoveToAbsolute(700),
            Command::MoveToRelative(700),
            Command::MoveAtVelocity(60),
        ];
        for (command, is_used) in commands.into_iter().zip(used) {
            let mut bench = Bench::new(mode);
            if mode == Mode::AnalogPid {
                // A loop that stands where its input asks for.
                bench.volts(pin::ANALOG_FEEDBACK, 0.0);
            }
            bench.set("PIDSCALAR", 6);
            bench.seconds(0.2);
            let before = bench.ask("PWMOUT");
            bench.tell(command);
            bench.seconds(0.2);
            assert_eq!(bench.ask("PWMOUT") != before, is_used, "{mode}: {command:?}");
        }
    }
}

#[test]
fn velocity_is_the_mean_of_64_loops_and_mode_5_shows_the_last_one() {
    let mut bench = Bench::new(Mode::SerialPid);
    bench.set("PTERM", 0);
    bench.set("VELOCITYFF", 255);
    bench.tell(Command::MoveAtVelocity(1000));
    bench.run(16 * LOOP);
    let early = bench.get("VELOCITY");
    bench.run(200 * LOOP);
    let late = bench.get("VELOCITY");
    assert!(early > 0 && late > early + early / 4, "{early} then {late}");
    let mut bench = Bench::new(Mode::AnalogPid);
    bench.volts(pin::ANALOG_FEEDBACK, 1.0);
    bench.run(2 * LOOP);
    bench.volts(pin::ANALOG_FEEDBACK, 2.0);
    bench.run(LOOP);
    assert!((200..=210).contains(&bench.get("VELOCITY")), "{}", bench.get("VELOCITY"));
}

#[test]
fn the_return_bits_come_in_their_order_and_alone() {
    let mut bench = Bench::new(Mode::SerialPid);
    for (bits, length) in [
        (function::RETPOS, 6),
        (function::RETVEL, 4),
        (function::RETTIME, 6),
        (function::RETPOS | function::RETVEL, 8),
        (function::RETVEL | function::RETTIME, 8),
        (function::RETPOS | function::RETVEL | function::RETTIME, 12),
    ] {
        bench.set("FUNCTION", bit(bits));
        bench.set("POSITION", 1000);
        let frame = encode_frame(UNIT_1, &Command::MoveToAbsolute(1000)).expect("it has a binary form");
        let reply = bench.raw(&frame);
        assert_eq!((reply.len(), reply[0]), (length, 1), "{bits:#06X}");
        let sum = reply[..length - 1].iter().fold(0_u8, |sum, byte| sum.wrapping_add(*byte));
        assert_eq!(reply[length - 1], sum);
    }
}

#[test]
fn a_write_to_eeprom_leaves_the_unit_deaf_and_the_next_command_is_heard() {
    let mut bench = Bench::new(Mode::Serial);
    let store = encode_frame(UNIT_1, &Command::WriteStore { register: 5, value: 1 }).expect("it has a form");
    let read = encode_frame(UNIT_1, &Command::ReadRegister(5)).expect("it has a form");
    bench.bus.receive(StreamIndex::Usb, &store);
    bench.run(Duration::from_millis(10));
    assert!(bench.bus.exchange(&read, Duration::from_millis(20)).is_empty(), "EEPROM is being written");
    assert_eq!(bench.bus.exchange(&[], PATIENCE), [0x06], "the acknowledge of the store comes at its end");
    bench.run(Duration::from_millis(6));
    assert_eq!(bench.raw(&read), [0x01, 0x01, 0x00, 0x02]);
}

#[test]
fn the_current_limit_of_0_is_none_and_status_tells_of_regulation() {
    let mut bench = Bench::new(Mode::Serial);
    bench.bus.apply(0, &WorldAction::LockShaft { motor: Motor::M1, on: true });
    bench.set("AMPSLIMIT", 20);
    bench.tell(Command::ChangeSpeed(1023));
    bench.seconds(0.5);
    let mut limited = false;
    for _ in 0..100 {
        bench.run(LOOP);
        limited |= has(&bench, status::CURRENTLIMIT);
    }
    assert!(limited && bench.ask("PWMOUT") < 1023);
    bench.set("AMPSLIMIT", 0);
    bench.seconds(0.5);
    assert!(!has(&bench, status::CURRENTLIMIT));
    assert_eq!(bench.ask("PWMOUT"), 1023);
}

#[test]
fn faults_of_the_plant_are_those_of_the_other_family() {
    let mut bench = Bench::new(Mode::Serial);
    bench.tell(Command::ChangeSpeed(800));
    bench.seconds(1.0);
    let running = bench.ask("VELOCITY");
    bench.bus.apply(0, &WorldAction::OpenLead { motor: Motor::M1, on: true });
    bench.seconds(3.0);
    assert!(running > 10 && bench.ask("VELOCITY") < running / 5 && bench.ask("AMPS") == 0);
    bench.bus.apply(0, &WorldAction::OpenLead { motor: Motor::M1, on: false });
    bench.seconds(1.0);
    assert!(bench.ask("VELOCITY") > running / 2);
    assert_eq!(assumed::PULSES_IN_MEAN, 64);
}

#[test]
fn read_97_has_the_negative_limit_first_and_ten_lines() {
    let config = MotionMindConfig { protocol: Protocol::Text, ..MotionMindConfig::new(Mode::SerialPid) };
    let mut bench = Bench::of(config);
    bench.volts(pin::NEGATIVE_LIMIT, 0.0);
    bench.seconds(0.2);
    let lines = String::from_utf8(bench.bus.exchange(b"R01 97\r\n", PATIENCE)).expect("text");
    let lines: Vec<&str> = lines.lines().collect();
    assert_eq!((lines.len(), lines[0], lines[1], lines[9]), (10, "S0ON", "S1OFF", "S9ON"), "{lines:?}");
}

#[test]
fn the_dead_band_of_rc_positions_is_deadband_and_not_rcband() {
    let mut config = MotionMindConfig::new(Mode::RadioControl);
    config.signals = vec![
        (pin::INDEX_RC, PinSignal::Pulse { microseconds: 1600.0 }),
        (pin::ANALOG_FEEDBACK, PinSignal::Volts { volts: 2.5 }),
    ];
    let mut bench = Bench::of(config);
    bench.set("FUNCTION", bit(function::RCPOS | function::ENABLEDB));
    bench.set("RCBAND", 500);
    bench.set("DEADBAND", 0);
    bench.seconds(0.5);
    assert_ne!(bench.ask("PWMOUT"), 0, "103 steps away");
    bench.set("DEADBAND", 200);
    bench.seconds(0.1);
    assert_eq!(bench.ask("PWMOUT"), 0);
}

#[test]
fn twenty_steps_of_deadband_are_a_tenth_of_a_volt_in_mode_1() {
    let mut bench = Bench::new(Mode::Analog);
    bench.set("DEADBAND", 20);
    for (volts, stands) in [(2.5 + 0.09, true), (2.5 - 0.09, true), (2.5 + 0.12, false), (2.5 - 0.12, false)]
    {
        bench.volts(pin::ANALOG_CONTROL, volts);
        bench.seconds(0.3);
        assert_eq!(bench.ask("PWMOUT") == 0, stands, "{volts} V");
    }
}
