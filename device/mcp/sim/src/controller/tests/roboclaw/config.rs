//! The configuration word: what it says is so.

use super::*;
use brushwork_mcp_wire::packet_serial::Generation::{Gen1, Gen4};
use brushwork_mcp_wire::roboclaw::{BAUD_RATES, ControlMode};

fn word(bench: &mut Bench) -> ConfigWord {
    ConfigWord(bench.read(commands::READ_CONFIG, name::CONFIG) as u16)
}

#[test]
fn every_unit_tells_that_it_speaks_packet_serial_and_at_which_rate_and_address() {
    for model in models::MODELS {
        for generation in Generation::ALL {
            let mut bench = Bench::of(ControllerConfig { generation, ..ControllerConfig::of(model) });
            let word = word(&mut bench);
            let rate = bench.unit().bits_per_second(StreamIndex::Uart1);
            assert_eq!(word.mode(), ControlMode::PacketSerial, "{}", model.key);
            assert_eq!((word.baud_bps(), word.address_number()), (Some(rate), Some(0)), "{}", model.key);
        }
    }
}

#[test]
fn an_mcp_tells_the_rate_and_the_address_that_its_own_commands_set() {
    let mut bench = Bench::new(Gen4);
    bench.ask(commands::SET_STREAM, &[2, 1, 9_600, 1000]);
    bench.ask(commands::SET_ADDRESS_MIXED, &[0x83, 0]);
    bench.address = brushwork_mcp_wire::packet_serial::Address::new(0x83).expect("it is one");
    let told = word(&mut bench);
    assert_eq!((told.baud_bps(), told.address_number()), (Some(9_600), Some(3)));
}

#[test]
fn an_address_moves_at_once_and_mode_and_rate_with_the_next_power_up() {
    for generation in Generation::ALL {
        let mut bench = claw_with(generation, ConfigWord::packet_serial(0), StreamIndex::Uart1);
        assert_eq!(bench.unit().bits_per_second(StreamIndex::Uart1), 38_400);
        let wanted = ConfigWord::packet_serial(5).with_baud_bps(115_200);
        bench.ask(commands::SET_CONFIG, &[wanted.0.into()]);
        assert!(bench.try_ask(commands::READ_VERSION.number(), &[]).is_none(), "{generation}");
        bench.address = brushwork_mcp_wire::packet_serial::Address::new(0x85).expect("it is one");
        assert_eq!(word(&mut bench), wanted, "{generation}");
        assert_eq!(bench.unit().bits_per_second(StreamIndex::Uart1), 38_400, "{generation}");
        save_and_restart(&mut bench);
        bench.wait(A_MOMENT);
        assert_eq!(bench.unit().bits_per_second(StreamIndex::Uart1), 115_200, "{generation}");
        assert_eq!(word(&mut bench), wanted, "{generation}");
    }
}

#[test]
fn each_rate_of_the_word_is_the_rate_of_the_line_after_a_power_up() {
    for rate in BAUD_RATES {
        let bench = claw_with(Gen1, ConfigWord::packet_serial(0).with_baud_bps(rate), StreamIndex::Uart1);
        assert_eq!(bench.unit().bits_per_second(StreamIndex::Uart1), rate);
    }
}

#[test]
fn loading_settings_and_defaults_leaves_the_rate_of_the_line_as_it_is() {
    let mut bench = claw_with(Gen4, ConfigWord::packet_serial(0).with_baud_bps(9_600), StreamIndex::Uart1);
    bench.ask(commands::RELOAD_SETTINGS, &[]);
    assert_eq!(bench.unit().bits_per_second(StreamIndex::Uart1), 9_600);
    bench.ask(commands::RESTORE_DEFAULTS, &[i64::from(scale::SETTINGS_KEY)]);
    assert_eq!(bench.unit().bits_per_second(StreamIndex::Uart1), 9_600);
}

#[test]
fn a_served_rate_stands_in_the_word() {
    let mut config = config(Gen4);
    config.set_rate(StreamIndex::Uart1, 230_400);
    let mut bench = Bench::on(config, StreamIndex::Uart1);
    assert_eq!(bench.unit().bits_per_second(StreamIndex::Uart1), 230_400);
    assert_eq!(word(&mut bench).baud_bps(), Some(230_400));
}

#[test]
fn s1_and_s2_are_no_serial_line_in_the_other_modes_and_usb_always_is() {
    for mode in [ControlMode::Rc, ControlMode::Analog, ControlMode::SimpleSerial] {
        let other = ConfigWord::packet_serial(0).with_mode(mode);
        let mut bench = claw_with(Gen4, other, StreamIndex::Uart1);
        assert!(bench.try_ask(commands::READ_VERSION.number(), &[]).is_none(), "{mode:?}");
        let mut bench = claw_with(Gen4, other, StreamIndex::Usb);
        assert_eq!(word(&mut bench).mode(), mode);
    }
}

#[test]
fn options_of_the_inputs_are_no_address() {
    let mut bench = claw(Gen4);
    let options = ConfigWord(0x0300).with_mode(ControlMode::Rc);
    bench.ask(commands::SET_CONFIG, &[options.0.into()]);
    // It answers where it did, and tells the options as they were given.
    assert_eq!(word(&mut bench), options);
    assert_eq!(bench.unit().settings().unit.address, 0x80);
}

#[test]
fn swapped_and_reversed_encoders_count_as_they_are_told() {
    let swapped = ConfigWord(ConfigWord::packet_serial(0).0 | 1 << 13);
    let mut bench = claw_with(Gen4, swapped, StreamIndex::Usb);
    bench.ask(commands::DUTY_M1, &[10_000]);
    bench.wait(Duration::from_secs(1));
    let counts = bench.ask(commands::READ_ENCODERS, &[]);
    let [first, second] =
        [counts.int(name::ENCODER_M1), counts.int(name::ENCODER_M2)].map(|raw| i64::from(raw as u32 as i32));
    assert!(first.abs() < 10 && second > 100, "{first} {second}");
    for (mode, turns_forward, counts_up) in [(0x20, false, false), (0x40, true, false), (0x60, false, true)] {
        let mut bench = claw(Gen4);
        bench.ask(commands::SET_ENCODER_MODE_M1, &[mode]);
        bench.ask(commands::DUTY_M1, &[10_000]);
        bench.wait(Duration::from_secs(1));
        assert_eq!(shaft(&bench) > 0.0, turns_forward, "{mode:#x}");
        assert_eq!(position(&mut bench) > 0, counts_up, "{mode:#x}");
        assert!(bench.unit().unit().expect("it has power").current_raw(Motor::M1) >= 0, "{mode:#x}");
    }
}

#[test]
fn a_number_of_cells_sets_the_battery_limits() {
    for (battery, supply, is_low, is_high) in [
        (0, 24.0, false, false),
        (5, 24.0, false, true),
        (6, 24.0, false, false),
        (6, 17.9, true, false),
        (6, 25.3, false, true),
        (7, 20.9, true, false),
        // Detected at power-up: six cells at 24 V.
        (1, 24.0, false, false),
        (1, 17.9, true, false),
        (1, 25.3, false, true),
    ] {
        let word = ConfigWord(ConfigWord::packet_serial(0).0 | battery << 2);
        let mut bench = claw_with(Gen4, word, StreamIndex::Usb);
        bench.apply(&WorldAction::SetBatteryVolts { volts: supply });
        bench.wait(A_MOMENT);
        let found = [Condition::MainBatteryLowWarning, Condition::MainBatteryHighWarning]
            .map(|condition| has(&mut bench, condition));
        assert_eq!(found, [is_low, is_high], "battery {battery} at {supply} V");
    }
}

#[test]
fn an_automatic_offset_puts_the_maximum_above_the_voltage_at_power_up() {
    let mut bench = claw(Gen4);
    bench.ask(commands::SET_MAIN_VOLTAGES, &[60, 340, 20]);
    bench.apply(&WorldAction::SetBatteryVolts { volts: 25.5 });
    bench.wait(A_MOMENT);
    assert!(!has(&mut bench, Condition::MainBatteryHighWarning));
    bench.apply(&WorldAction::SetBatteryVolts { volts: 26.5 });
    bench.wait(A_MOMENT);
    assert!(has(&mut bench, Condition::MainBatteryHighWarning));
}
