//! What outlives the power and what does not: UD, RT, macro 0, the image of the EEPROM.

use std::time::Duration;

use crate::{Eeprom, SuprMotrConfig};
use brushwork_plant::machine::{Machine, StreamIndex};
use brushwork_suprmotr_wire::{Address, operation};

use crate::tests::bench::Bench;

#[test]
fn a_board_leaves_the_factory_as_the_manual_lists_it() {
    let mut bench = Bench::new();
    let numbers: Vec<i64> =
        ["GV", "GA", "GP", "GI", "GD", "GL"].iter().map(|line| bench.number(line)).collect();
    assert_eq!(numbers, [20_000, 200_000, 75, 0, 0, 100]);
    // EN, LN and LL; SM is told by nobody.
    let mut bench = Bench::line(vec![SuprMotrConfig::new(Address::FACTORY)]);
    assert_eq!(bench.raw(b"\x010TS\r"), "\u{1}0TS\r0S:A1 80 01 04 00 00\r\n\u{3}");
    assert_eq!(bench.bus.bits_per_second(StreamIndex::Usb), 9_600);
}

#[test]
fn what_is_not_stored_is_gone_and_what_is_stored_comes_back() {
    let mut bench = Bench::new();
    bench.tell("DP99,DV5000,UD,DP88");
    assert_eq!((bench.number("GP"), bench.unit().eeprom_writes()), (88, 1));
    bench.power_cycle();
    assert_eq!(bench.ask("GP"), "", "it is not selected any more");
    bench.raw(b"\x010");
    assert_eq!(
        (bench.number("GP"), bench.number("GV")),
        (99, 5_000),
        "and its echo was off when it was stored"
    );
}

#[test]
fn a_reset_is_as_a_power_up() {
    let mut bench = Bench::new();
    bench.tell("DP99,EF,UD");
    bench.tell("MA1000");
    bench.ms(500);
    bench.tell("DP88,HM,CN1,SO7,RT");
    assert_eq!(bench.ask("TP"), "", "it starts, and is not selected");
    bench.ms(150);
    bench.raw(b"\x010");
    assert_eq!((bench.number("GP"), bench.number("TP"), bench.number("TT")), (99, 0, 0));
    assert_eq!((bench.unit().outputs(), bench.unit().analog_output()), (0, 0));
    assert!(bench.unit().is_motor_on());
}

#[test]
fn a_board_that_starts_hears_nothing() {
    let mut bench = Bench::new();
    bench.tell("EF,UD,RT");
    bench.ms(90);
    assert_eq!(bench.raw(b"\x010TP\r"), "");
    bench.ms(20);
    assert_eq!(bench.raw(b"\x010TP\r"), "0P0:+0000000000\r\n\u{3}");
}

#[test]
fn macro_0_runs_at_a_start() {
    let mut bench = Bench::new();
    bench.tell("EF,UD");
    bench.tell("MD0,CN3,MA2000");
    assert_eq!(bench.unit().outputs(), 0, "not before");
    for is_reset in [true, false] {
        if is_reset {
            bench.raw(b"RT\r");
        } else {
            bench.power_cycle();
        }
        bench.ms(600);
        assert_eq!(bench.unit().outputs(), 4);
        assert!(bench.unit().position() > 1_900);
        bench.raw(b"\x010");
    }
    bench.tell("RZ");
    bench.power_cycle();
    bench.ms(500);
    assert_eq!((bench.unit().outputs(), bench.unit().position()), (0, 0));
}

#[test]
fn a_board_that_is_addressed_after_a_start_says_who_it_is() {
    let config = SuprMotrConfig { is_addressed: true, ..SuprMotrConfig::new(Address::FACTORY) };
    let mut bench = Bench::line(vec![config]);
    assert!(bench.raw(b"").contains("SuprMotr V9"));
    assert_eq!(bench.ask("EF,TP"), "EF,TP\r0P0:+0000000000\r\n\u{3}");
    assert_eq!(bench.status().operation & operation::ADDRESSED, operation::ADDRESSED);
}

#[test]
fn the_rate_of_the_line_is_set_and_stored() {
    let mut bench = Bench::new();
    for (line, rate) in [("BR1", 19_200), ("BR2", 38_400), ("BR0", 9_600), ("BR2,UD", 38_400)] {
        bench.tell(line);
        assert_eq!(bench.bus.bits_per_second(StreamIndex::Usb), rate, "{line}");
    }
    bench.tell("BR0");
    bench.power_cycle();
    assert_eq!(bench.bus.bits_per_second(StreamIndex::Usb), 38_400);
}

#[test]
fn the_content_of_the_eeprom_makes_the_same_board_again() {
    let mut bench = Bench::new();
    bench.tell("DP99,EF,UD");
    bench.tell("MD4,MR500,WS100,RP9");
    bench.tell("DB6");
    let text = Eeprom::text_of([bench.unit().eeprom()]);
    let eeprom = Eeprom::all_in(&text).expect("it was just written").remove(0);
    let config = SuprMotrConfig { eeprom, ..SuprMotrConfig::new(Address::FACTORY) };
    let mut again = Bench::line(vec![config]);
    again.raw(b"\x016");
    assert_eq!(again.number("GP"), 99);
    assert_eq!(again.ask("TM4"), "MD4, MR+0000000500,WS+0000000100,RP+0000000009\r\n\u{3}");
}

#[test]
fn without_power_nothing_is_heard_and_the_motor_is_free() {
    use brushwork_plant::world::WorldAction;
    let mut bench = Bench::new();
    bench.begin("MA50000");
    bench.ms(300);
    bench.bus.apply(0, &WorldAction::Power { on: false });
    assert_eq!(bench.ask("TP"), "");
    bench.ms(1_000);
    assert!(bench.unit().view().leds.is_none() && !bench.unit().is_motor_on());
    assert_eq!(bench.unit().truth().motor_radians_per_second, 0.0, "friction stopped it");
    let at = bench.unit().view().axes[0].encoder_counts;
    bench.bus.apply(0, &WorldAction::Power { on: true });
    bench.ms(500);
    assert_eq!(bench.unit().position(), 0, "where it is, is 0");
    assert_eq!(bench.unit().view().axes[0].encoder_counts, at);
}

/// What is played twice comes out the same to the last byte, however time is cut.
#[test]
fn the_same_conversation_gives_the_same_bytes_however_time_is_cut() {
    let play = |slice_us: u64| {
        let mut bench = Bench::new();
        let mut heard = Vec::new();
        for line in ["MA3000,WS0,TP,MA0,WS0,TP,RP3", "TS"] {
            bench.begin(line);
            let until = bench.bus.now() + Duration::from_millis(1_500);
            while bench.bus.now() < until {
                let to = (bench.bus.now() + Duration::from_micros(slice_us)).min(until);
                bench.bus.advance(to);
                while let Some(bytes) = bench.bus.take_output(StreamIndex::Usb) {
                    heard.extend(bytes);
                }
            }
        }
        heard
    };
    let whole = play(1_500_000);
    assert!(whole.len() > 100);
    for slice_us in [137, 1_000, 7_919] {
        assert_eq!(play(slice_us), whole, "{slice_us} us");
    }
}
