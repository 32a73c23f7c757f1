//! RAM, EEPROM and power: what survives what.

use super::support::Bench;
use crate::controller::ControllerConfig;
use crate::settings::{ROW_BYTES, ROW_WRITE_TIME, Settings};
use brushwork_mcp_wire::packet_serial::{Generation, Request, commands, name, number, scale};
use brushwork_plant::machine::Machine;
use brushwork_plant::world::WorldAction;
use brushwork_values::Value;
use std::time::Duration;

const KEY: i64 = scale::SETTINGS_KEY as i64;

/// Longer than a save of any model takes.
const SAVE_TIME: Duration = Duration::from_secs(1);

fn power_cycle(bench: &mut Bench) {
    bench.apply(&WorldAction::Power { on: false });
    bench.wait(Duration::from_millis(100));
    bench.apply(&WorldAction::Power { on: true });
    bench.wait(Duration::from_millis(100));
}

fn qpps(bench: &mut Bench) -> i64 {
    bench.read(commands::READ_VELOCITY_PID_M1, name::QPPS)
}

fn set_qpps(bench: &mut Bench, qpps: i64) {
    bench.ask(commands::SET_VELOCITY_PID_M1, &[1, 2, 3, qpps]); // D, P, I, QPPS
}

#[test]
fn a_setting_that_is_not_saved_is_gone_after_a_power_cycle_and_a_saved_one_is_not() {
    for generation in Generation::ALL {
        let mut bench = Bench::new(generation);
        set_qpps(&mut bench, 1234);
        assert_eq!(bench.unit().stored_settings().motors[0].motion.qpps, 44_000);
        power_cycle(&mut bench);
        assert_eq!(qpps(&mut bench), 44_000, "{generation}");
        set_qpps(&mut bench, 1234);
        bench.ask(commands::SAVE_SETTINGS, &[KEY]);
        bench.wait(SAVE_TIME);
        power_cycle(&mut bench);
        assert_eq!(qpps(&mut bench), 1234, "{generation}");
    }
}

#[test]
fn reload_takes_back_what_was_saved() {
    let mut bench = Bench::new(Generation::Gen1);
    set_qpps(&mut bench, 1234);
    bench.ask(commands::RELOAD_SETTINGS, &[]);
    assert_eq!(qpps(&mut bench), 44_000);
}

#[test]
fn a_reload_right_after_a_save_is_not_answered() {
    let mut bench = Bench::new(Generation::Gen1);
    bench.ask(commands::SAVE_SETTINGS, &[KEY]);
    assert!(bench.try_ask(number::RELOAD_SETTINGS, &[]).is_none());
    bench.wait(SAVE_TIME);
    assert!(bench.try_ask(number::RELOAD_SETTINGS, &[]).is_some());
}

#[test]
fn the_key_decides_from_generation_3_on_and_is_optional_before() {
    for generation in Generation::ALL {
        // Saving and restoring without the key: address, command, CRC.
        let mut bench = Bench::new(generation);
        set_qpps(&mut bench, 1234);
        assert_eq!(bench.raw(&[0x80, 94, 0xa0, 0xa3]), [0xff], "{generation}");
        bench.wait(SAVE_TIME);
        let saved = bench.unit().stored_settings().motors[0].motion.qpps == 1234;
        assert_eq!(saved, generation < Generation::Gen3, "{generation}");
        assert_eq!(bench.raw(&[0x80, 80, 0x41, 0x6d]), [0xff], "{generation}");
        assert_eq!(qpps(&mut bench) == 44_000, generation < Generation::Gen3, "{generation}");
        // And with it.
        assert_eq!(bench.raw(&[0x80, 80, 0xe2, 0x2e, 0xab, 0x7a, 0x2b, 0x0e]), [0xff], "{generation}");
        assert_eq!(qpps(&mut bench), 44_000, "{generation}");
    }
}

#[test]
fn a_power_cut_in_the_middle_of_a_save_leaves_the_first_rows_new_and_the_rest_old() {
    let mut bench = Bench::new(Generation::Gen1);
    bench.ask(commands::SET_ADDRESS_MIXED, &[0x80, 1]); // in the first row
    bench.ask(commands::SET_SIGNAL, &[9, 1, 0, 0, 0, 0, 1000, 0, 0, 4095, 2048, 77, 0, -32_767, 32_767, 0]);
    bench.ask(commands::SAVE_SETTINGS, &[KEY]);
    bench.wait(ROW_WRITE_TIME * 4);
    power_cycle(&mut bench);
    let settings = bench.unit().settings();
    assert_eq!((settings.unit.mixed, settings.signals[9].deadband), (1, 0));
    assert!(!bench.unit().eeprom().is_saving());
}

#[test]
fn a_save_counts_its_rows_and_answers_go_on_meanwhile() {
    let mut bench = Bench::new(Generation::Gen1);
    assert_eq!(bench.unit().eeprom().row_writes(), 0);
    bench.ask(commands::SAVE_SETTINGS, &[KEY]);
    assert!(bench.unit().eeprom().is_saving());
    assert!(bench.try_ask(number::READ_MAIN_BATTERY, &[]).is_some());
    bench.wait(SAVE_TIME);
    let rows = bench.unit().eeprom().image().0.len() / ROW_BYTES;
    assert_eq!(bench.unit().eeprom().row_writes(), rows as u64);
    assert_eq!(bench.unit().eeprom().saves(), 1);
}

#[test]
fn restored_defaults_are_the_factory_settings_but_for_the_address() {
    let config = ControllerConfig::default();
    let mut bench = Bench::of(config.clone());
    bench.ask(commands::SET_ADDRESS_MIXED, &[0x84, 1]);
    set_qpps(&mut bench, 1234);
    bench.ask(commands::RESTORE_DEFAULTS, &[]);
    assert_eq!(bench.unit().settings(), Settings::factory(config.model, 0x84));
}

#[test]
fn an_address_change_holds_from_the_next_packet_on() {
    use brushwork_plant::machine::StreamIndex;
    let mut bench = Bench::on(ControllerConfig::default(), StreamIndex::Uart1);
    let change = Request::new(bench.address, number::SET_ADDRESS_MIXED, &[0x83, 0]);
    assert_eq!(bench.raw(&change.encode(Generation::Gen1).expect("known")), [0xff]);
    assert!(bench.raw(&[0x80, 24]).is_empty());
    assert!(!bench.raw(&[0x83, 24]).is_empty());
}

#[test]
fn the_configuration_word_moves_the_address_too() {
    use brushwork_plant::machine::StreamIndex;
    let mut bench = Bench::on(ControllerConfig::default(), StreamIndex::Uart1);
    bench.ask(commands::SET_CONFIG, &[0x0603]); // bits 8 to 10: 6, which are an address in packet serial mode alone
    assert!(bench.raw(&[0x80, 24]).is_empty());
    assert!(!bench.raw(&[0x86, 24]).is_empty());
}

#[test]
fn user_memory_and_serial_number_survive_as_they_should() {
    let mut bench = Bench::new(Generation::Gen4);
    bench.ask(commands::WRITE_USER_MEMORY, &[7, 0xbeef]);
    let label = Request {
        address: bench.address,
        command: number::SET_SERIAL_NUMBER,
        values: vec![Value::Text("MCP-0042".to_owned())],
    };
    bench.try_send(&label).expect("acknowledged");
    power_cycle(&mut bench);
    assert_eq!(bench.ask(commands::READ_USER_MEMORY, &[7]).int(name::VALUE), 0xbeef);
    assert_eq!(bench.ask(commands::READ_SERIAL_NUMBER, &[]).text(name::SERIAL_NUMBER), Some(""));
}

#[test]
fn a_power_cycle_stops_the_motors_and_forgets_their_commands() {
    let mut bench = Bench::new(Generation::Gen1);
    bench.ask(commands::DUTY_BOTH, &[20_000, 20_000]);
    bench.wait(Duration::from_millis(300));
    power_cycle(&mut bench);
    bench.wait(Duration::from_secs(1));
    assert_eq!(bench.read(commands::READ_PWMS, name::DUTY_M1), 0);
    let turned = bench.unit().view().axes[0].encoder_counts;
    assert!(
        turned > bench.read(commands::READ_ENCODER_M1, name::ENCODER) + 100,
        "the counter starts at zero again"
    );
}

#[test]
fn hidden_settings_are_saved_like_the_rest() {
    let mut bench = Bench::new(Generation::Gen1);
    bench.apply(&WorldAction::SetHidden { key: "dout.1.inverted".to_owned(), value: 1 });
    assert_eq!(bench.unit().settings().hidden("dout.1.inverted"), Ok(1));
    assert_eq!(bench.unit().stored_settings().hidden("dout.1.inverted"), Ok(0));
    bench.ask(commands::SAVE_SETTINGS, &[KEY]);
    bench.wait(SAVE_TIME);
    power_cycle(&mut bench);
    assert_eq!(bench.unit().settings().hidden("dout.1.inverted"), Ok(1));
    let unknown = WorldAction::SetHidden { key: "dout.9.inverted".to_owned(), value: 1 };
    assert!(bench.bus.controllers_mut()[0].apply(&unknown).is_err());
}

#[test]
fn without_main_battery_the_unit_lives_on_its_logic_battery_and_without_both_it_is_dead() {
    let mut bench = Bench::new(Generation::Gen1);
    bench.apply(&WorldAction::ConnectBattery { connected: false });
    bench.wait(Duration::from_secs(60));
    assert!(bench.read(commands::READ_MAIN_BATTERY, name::MAIN_BATTERY) < 10);
    bench.apply(&WorldAction::SetLogicVolts { volts: 0.0 });
    assert!(bench.try_ask(number::READ_MAIN_BATTERY, &[]).is_none());
    assert_eq!(bench.bus.next_output_at(), None);
}
