//! The unit as a whole: commands 14, 15, 80, 94 to 97, 141, 142, 148, 149, 160, 161, 252, 253.

use super::super::answer::{Answer, Arguments, Handlers, On, tell, tell_value};
use super::super::firmware::Firmware;
use crate::settings::Settings;
use brushwork_mcp_wire::packet_serial::name::*;
use brushwork_mcp_wire::packet_serial::{Address, Generation, commands, scale};
use brushwork_values::Value;

pub(super) const HANDLERS: Handlers = &[
    &On(commands::SET_SERIAL_TIMEOUT, |unit, args| {
        unit.settings.unit.serial_timeout_tenths = args.u8(TIMEOUT);
        Answer::Ack
    }),
    &On(commands::READ_SERIAL_TIMEOUT, |unit, _| {
        Answer::of([tell(TIMEOUT, unit.settings.unit.serial_timeout_tenths.into())])
    }),
    &On(commands::RESTORE_DEFAULTS, |unit, args| {
        if is_unlocked(unit, args) {
            unit.restore_defaults();
        }
        Answer::Ack
    }),
    &On(commands::SAVE_SETTINGS, |unit, args| {
        if is_unlocked(unit, args) {
            unit.save_settings();
        }
        Answer::Ack
    }),
    &On(commands::RELOAD_SETTINGS, |unit, _| {
        // Sent right after a save it times out on a real unit (public clients, 2015-2025).
        if unit.memory.eeprom.is_saving() {
            return Answer::Silence;
        }
        unit.reload_settings();
        Answer::Ack
    }),
    &On(commands::SET_SERIAL_NUMBER, |unit, args| {
        unit.settings.unit.serial_number = args.text(SERIAL_NUMBER).to_owned();
        Answer::Ack
    }),
    &On(commands::READ_SERIAL_NUMBER, |unit, _| {
        let label = label_text(&unit.settings.unit.serial_number, unit.generation);
        Answer::of([tell_value(SERIAL_NUMBER, Value::Text(label))])
    }),
    &On(commands::SET_ADDRESS_MIXED, |unit, args| {
        if let Some(address) = Address::new(args.u8(ADDRESS)) {
            unit.settings.unit.address = address.get();
        }
        unit.settings.unit.mixed = args.u8(MIXED);
        Answer::Ack
    }),
    &On(commands::READ_ADDRESS_MIXED, |unit, _| {
        let settings = &unit.settings.unit;
        Answer::of([tell(ADDRESS, settings.address.into()), tell(MIXED, settings.mixed.into())])
    }),
    &On(commands::SET_PWM_MODE, |unit, args| {
        let both = args.int_or(MODE, 0);
        unit.settings.motors[0].pwm_mode = args.int_or(MODE_M1, both) as u8;
        unit.settings.motors[1].pwm_mode = args.int_or(MODE_M2, both) as u8;
        Answer::Ack
    }),
    &On(commands::READ_PWM_MODE, |unit, _| {
        let [m1, m2] = [0, 1].map(|motor: usize| i64::from(unit.settings.motors[motor].pwm_mode));
        Answer::of([tell(MODE, m1), tell(MODE_M1, m1), tell(MODE_M2, m2)])
    }),
    &On(commands::SET_PWM_IDLE, |unit, args| {
        unit.settings.motors[0].motion.pwm_idle_raw = args.u8(IDLE_M1);
        unit.settings.motors[1].motion.pwm_idle_raw = args.u8(IDLE_M2);
        Answer::Ack
    }),
    &On(commands::READ_PWM_IDLE, |unit, _| {
        let [m1, m2] = [0, 1].map(|motor: usize| i64::from(unit.settings.motors[motor].motion.pwm_idle_raw));
        Answer::of([tell(IDLE_M1, m1), tell(IDLE_M2, m2)])
    }),
    &On(commands::READ_USER_MEMORY, |unit, args| {
        Answer::of([tell(VALUE, unit.memory.eeprom.user_word(args.u8(ADDRESS)).into())])
    }),
    &On(commands::WRITE_USER_MEMORY, |unit, args| {
        unit.memory.eeprom.set_user_word(args.u8(ADDRESS), args.u16(VALUE));
        Answer::Ack
    }),
];

impl Firmware {
    /// Command 80: factory settings in RAM; the EEPROM keeps what it has. Assumed: the address stays, so that the unit can still
    /// be reached where several share a wire.
    fn restore_defaults(&mut self) {
        let (address, streams) = (self.settings.unit.address, self.settings.streams.clone());
        self.settings = Settings::factory(self.model, address);
        self.keep_rates(&streams);
    }
}

/// As much of a serial number as 36 bytes hold: 18 characters of two bytes in generation 3, ASCII later.
fn label_text(label: &str, generation: Generation) -> String {
    if generation < Generation::Gen4 {
        let units: Vec<u16> = label.encode_utf16().take(18).collect();
        return String::from_utf16_lossy(&units);
    }
    label.chars().take(36).map(|letter| if letter.is_ascii() { letter } else { '?' }).collect()
}

/// From generation 3 on, 80 and 94 do nothing without the key, though they are acknowledged (public clients, 2015-2025).
fn is_unlocked<const L: u8>(unit: &Firmware, args: &Arguments<'_, L>) -> bool {
    match args.get(KEY) {
        Some(key) => key == i64::from(scale::SETTINGS_KEY),
        None => unit.generation < Generation::Gen3,
    }
}
