//! Settings survive what they should and no more.

use super::*;
use brushwork_mcp_wire::models::{MODELS, Model, lookup};
use std::time::Duration;

fn mcp266() -> &'static Model {
    lookup("mcp266").expect("in the list")
}

fn changed() -> Settings {
    let mut settings = Settings::factory(mcp266(), 0x83);
    settings.unit.mixed = 1;
    settings.unit.serial_number = "A17 \u{e9}".to_owned();
    settings.battery.main_offset_tenths = -4;
    settings.motors[1].motion.position_min_counts = -90_000;
    settings.outputs[1].inverted = true;
    settings.priority = [3, 1, 0];
    settings.signals[9].power_exp_raw = -65_536;
    settings.streams[4].rate_bps = 1_000_000;
    settings.roboclaw.inputs[1].max = 0x1234;
    settings
}

#[test]
fn an_image_gives_back_every_setting_of_every_model() {
    for model in MODELS {
        let mut settings = Settings::factory(model, 0x87);
        settings.motors[0].motion.qpps = 123_456;
        settings.streams[0].timeout_ms = 0;
        let back = Image::of(&settings).settings(Shape::of(model), Settings::factory(model, 0x80));
        assert_eq!(back.as_ref(), Some(&settings), "{}", model.key);
    }
    let settings = changed();
    let back = Image::of(&settings).settings(Shape::of(mcp266()), Settings::factory(mcp266(), 0x80));
    assert_eq!(back, Some(settings));
}

#[test]
fn an_empty_eeprom_holds_no_settings() {
    let blank = Image(vec![0xff; 2048]);
    assert_eq!(blank.settings(Shape::of(mcp266()), Settings::factory(mcp266(), 0x80)), None);
    assert_eq!(Image(Vec::new()).settings(Shape::of(mcp266()), Settings::factory(mcp266(), 0x80)), None);
}

#[test]
fn the_factory_address_voltages_and_currents_are_those_of_the_model() {
    let settings = Settings::factory(mcp266(), 0x80);
    assert_eq!(settings.motors[0].motion.max_current_raw, 6000);
    assert_eq!((settings.battery.main_min_tenths, settings.battery.main_max_tenths), (100, 600));
    assert_eq!((settings.motors[0].encoder_mode, settings.motors[1].encoder_mode), (6, 7)); // ENC1A, ENC2A
    assert_eq!(settings.signals.len(), 10);
}

#[test]
fn a_save_takes_one_write_time_per_row() {
    let image = Image::of(&changed());
    let mut eeprom = Eeprom::holding(&Image::of(&Settings::factory(mcp266(), 0x80)));
    let rows = image.0.len().div_ceil(ROW_BYTES) as u32;
    eeprom.begin_save(&image, Duration::ZERO);
    eeprom.advance(ROW_WRITE_TIME * rows - Duration::from_nanos(1));
    assert!(eeprom.is_saving());
    eeprom.advance(ROW_WRITE_TIME * rows);
    assert!(!eeprom.is_saving());
    assert_eq!(eeprom.image().0[..image.0.len()], image.0);
    assert_eq!((eeprom.row_writes(), eeprom.saves()), (u64::from(rows), 1));
}

#[test]
fn a_power_cut_in_the_middle_of_a_save_leaves_old_and_new_rows_side_by_side() {
    let old = Settings::factory(mcp266(), 0x80);
    let mut new = old.clone();
    new.unit.mixed = 1; // in the first row
    new.signals[9].power_min = 77; // in the last one
    let mut eeprom = Eeprom::holding(&Image::of(&old));
    eeprom.begin_save(&Image::of(&new), Duration::ZERO);
    eeprom.advance(ROW_WRITE_TIME * 3);
    eeprom.cut_power();
    eeprom.advance(Duration::from_secs(10));
    let mix = eeprom.image().settings(Shape::of(mcp266()), old.clone()).expect("a valid image");
    assert_eq!((mix.unit.mixed, mix.signals[9].power_min), (1, 0));
}

#[test]
fn user_words_stay_apart_and_count_as_writes() {
    let mut eeprom = Eeprom::holding(&Image::of(&changed()));
    eeprom.set_user_word(0, 0x1234);
    eeprom.set_user_word(1, 0xabcd);
    assert_eq!((eeprom.user_word(0), eeprom.user_word(1), eeprom.user_word(128)), (0x1234, 0xabcd, 0x1234));
    assert_eq!(eeprom.row_writes(), 2);
}

#[test]
fn every_hidden_setting_is_read_back_as_set_and_limited() {
    let mut settings = Settings::factory(mcp266(), 0x80);
    for (key, value, held) in [
        ("unit.bridge_channels", 1, 1),
        ("dout.2.inverted", 7, 1),
        ("pin.10.digital", 1, 1),
        ("pin.1.low_pass", 99, 15),
        ("stream.ttl3.multi_unit", 1, 1),
        ("can.rate", 1_000_000, 1_000_000),
        ("i2c.rate", -5, 0),
    ] {
        settings.set_hidden(key, value).expect("a known key");
        assert_eq!(settings.hidden(key), Ok(held), "{key}");
    }
    assert!(settings.streams[4].multi_unit);
    for key in
        ["dout.3.inverted", "pin.0.digital", "pin.11.digital", "stream.usb.multi_unit", "unit", "", "a.b.c"]
    {
        assert_eq!(settings.set_hidden(key, 1), Err(UnknownKey(key.to_owned())), "{key}");
    }
}
