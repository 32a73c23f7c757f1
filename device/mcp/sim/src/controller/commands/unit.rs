//! The unit as a whole: commands 14, 15, 80, 94 to 97, 141, 142, 148, 149, 160, 161, 252, 253.

use super::super::answer::{Answer, Arguments, Handlers};
use super::super::firmware::Firmware;
use crate::settings::Settings;
use brushwork_mcp_wire::packet_serial::{Address, Generation, number, scale};
use brushwork_values::Value;

pub(super) const HANDLERS: Handlers = &[
    (number::SET_SERIAL_TIMEOUT, |unit, args| {
        unit.settings.unit.serial_timeout_tenths = args.u8("timeout");
        Answer::Ack
    }),
    (number::READ_SERIAL_TIMEOUT, |unit, _| {
        Answer::ints([("timeout", unit.settings.unit.serial_timeout_tenths.into())])
    }),
    (number::RESTORE_DEFAULTS, |unit, args| {
        if is_unlocked(unit, args) {
            unit.restore_defaults();
        }
        Answer::Ack
    }),
    (number::SAVE_SETTINGS, |unit, args| {
        if is_unlocked(unit, args) {
            unit.save_settings();
        }
        Answer::Ack
    }),
    (number::RELOAD_SETTINGS, |unit, _| {
        // Sent right after a save it times out on a real unit (public clients, 2015-2025).
        if unit.memory.eeprom.is_saving() {
            return Answer::Silence;
        }
        unit.reload_settings();
        Answer::Ack
    }),
    (number::SET_SERIAL_NUMBER, |unit, args| {
        unit.settings.unit.serial_number = args.values.text("serial_number").unwrap_or_default().to_owned();
        Answer::Ack
    }),
    (number::READ_SERIAL_NUMBER, |unit, _| {
        let label = label_text(&unit.settings.unit.serial_number, unit.generation);
        Answer::Data(vec![("serial_number", Value::Text(label))])
    }),
    (number::SET_ADDRESS_MIXED, |unit, args| {
        // Assumed: an address outside 0x80 to 0x87 leaves the old one.
        if let Some(address) = Address::new(args.u8("address")) {
            unit.settings.unit.address = address.get();
        }
        unit.settings.unit.mixed = args.u8("mixed");
        Answer::Ack
    }),
    (number::READ_ADDRESS_MIXED, |unit, _| {
        let settings = &unit.settings.unit;
        Answer::ints([("address", settings.address.into()), ("mixed", settings.mixed.into())])
    }),
    (number::SET_PWM_MODE, |unit, args| {
        let both = args.int_or("mode", 0);
        unit.settings.motors[0].pwm_mode = args.int_or("mode_m1", both) as u8;
        unit.settings.motors[1].pwm_mode = args.int_or("mode_m2", both) as u8;
        Answer::Ack
    }),
    (number::READ_PWM_MODE, |unit, _| {
        let [m1, m2] = [0, 1].map(|motor: usize| i64::from(unit.settings.motors[motor].pwm_mode));
        Answer::ints([("mode", m1), ("mode_m1", m1), ("mode_m2", m2)])
    }),
    (number::SET_PWM_IDLE, |unit, args| {
        unit.settings.motors[0].motion.pwm_idle_raw = args.u8("idle_m1");
        unit.settings.motors[1].motion.pwm_idle_raw = args.u8("idle_m2");
        Answer::Ack
    }),
    (number::READ_PWM_IDLE, |unit, _| {
        let [m1, m2] = [0, 1].map(|motor: usize| i64::from(unit.settings.motors[motor].motion.pwm_idle_raw));
        Answer::ints([("idle_m1", m1), ("idle_m2", m2)])
    }),
    (number::READ_USER_MEMORY, |unit, args| {
        Answer::ints([("value", unit.memory.eeprom.user_word(args.u8("address")).into())])
    }),
    (number::WRITE_USER_MEMORY, |unit, args| {
        unit.memory.eeprom.set_user_word(args.u8("address"), args.u16("value"));
        Answer::Ack
    }),
];

impl Firmware {
    /// Command 80: factory settings in RAM; the EEPROM keeps what it has. Assumed: the address stays, so that the unit can still
    /// be reached where several share a wire.
    fn restore_defaults(&mut self) {
        let address = self.settings.unit.address;
        self.settings = Settings::factory(self.model, address);
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
fn is_unlocked(unit: &Firmware, args: &Arguments<'_>) -> bool {
    match args.values.try_int("key") {
        Some(key) => key == i64::from(scale::SETTINGS_KEY),
        None => unit.generation < Generation::Gen3,
    }
}
