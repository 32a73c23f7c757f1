//! Several boards on a line: who listens, who answers, and what becomes of two answers (SuprMotr manual, "Address Selection").

use crate::{SuprMotr, SuprMotrConfig};
use brushwork_plant::machine::Machine;
use brushwork_plant::world::WorldAction;
use brushwork_suprmotr_wire::{Address, ReportForm};

use crate::tests::bench::Bench;

fn config(number: u8) -> SuprMotrConfig {
    SuprMotrConfig::new(Address::new(number).expect("there are 16"))
}

/// Boards of these addresses, all without echo, none selected.
fn line(numbers: &[u8]) -> Bench {
    let mut bench = Bench::line(numbers.iter().map(|number| config(*number)).collect());
    bench.raw(b"\x01VEF\r\x01z");
    bench
}

#[test]
fn a_board_that_is_not_selected_says_nothing_and_does_nothing() {
    let mut bench = Bench::line(vec![config(5)]);
    assert_eq!(bench.raw(b"TT\rMA500\r'%"), "");
    // The manual's own test: 4 is not 5.
    assert_eq!(bench.raw(b"\x014TT\r"), "");
    assert_eq!(bench.raw(b"\x015TT\r"), "\u{1}5TT\r5T0:+0000000000\r\n\u{3}");
    // "01 35 54 54 0D", with the echo off.
    bench.raw(b"EF\r");
    assert_eq!(bench.raw(&[0x01, 0x35, 0x54, 0x54, 0x0D]), "5T0:+0000000000\r\n\u{3}");
}

#[test]
fn each_address_of_sixteen_is_found_by_asking_for_it() {
    let numbers = [0, 3, 9, 10, 15];
    let mut bench = line(&numbers);
    for address in Address::ALL {
        let reply = bench.raw(&[0x01, address.character(), b'T', b'B', b'\r']);
        let number = address.get();
        let expected = format!("{}B0:+{number:010}\r\n\u{3}", char::from(address.character()));
        assert_eq!(reply, if numbers.contains(&number) { expected } else { String::new() }, "{number}");
    }
    // In small letters, and a single character is enough.
    assert!(bench.raw(b"\x01f'").starts_with("FP0:"));
}

#[test]
fn a_board_goes_on_with_its_move_and_its_macro_when_another_is_selected() {
    let mut bench = line(&[1, 2]);
    bench.raw(b"\x011MA0,WS0,MA3000,WS0,TP,RP\r\x012");
    bench.ms(1_000);
    assert_eq!(bench.raw(b""), "", "it reports nothing");
    let before = bench.bus.suprmotrs()[0].position();
    bench.ms(150);
    assert_ne!(bench.bus.suprmotrs()[0].position(), before);
    assert!(bench.raw(b"'").starts_with("2P0:"));
    assert_eq!(bench.bus.suprmotrs()[1].position(), 0);
}

#[test]
fn all_boards_take_a_line_that_is_for_all() {
    let mut bench = line(&[1, 2, 3]);
    bench.raw(b"\x01VDV2000\r");
    bench.raw(b"\x01VDP55,DI10,DL100,DD200\r");
    bench.raw(b"\x01v MR2000\r");
    bench.ms(2_000);
    for unit in bench.bus.suprmotrs() {
        assert!(unit.position() > 1_900, "{}", unit.position());
    }
    assert_eq!(
        bench.raw(b"\x011TG\r"),
        "1G0:+0000000055\r\n1I0:+0000000010\r\n1D0:+0000000200\r\n1L0:+0000000100\r\n\u{3}"
    );
    assert_eq!(bench.raw(b"\x013GV\r"), "3Y0:+0000002000\r\n\u{3}");
}

/// Two answers at once: '1' and '2' are 0x31 and 0x32, of which 0x30 is left; what is the same comes through.
#[test]
fn two_answers_at_once_collide() {
    let mut bench = line(&[1, 2]);
    assert_eq!(bench.raw(b"\x01VTT\r"), "0T0:+0000000000\r\n\u{3}");
    let mut bench = line(&[0, 15]);
    // '0' and 'F' leave no bit; -7 and +0 meet in their signs and digits.
    bench.raw(b"\x010MA-7\r");
    assert_eq!(bench.raw(b"\x01VTT\r"), "\0T0:)0000000000\r\n\u{3}");
}

#[test]
fn what_the_longer_of_two_answers_says_last_comes_through() {
    let mut bench = Bench::line(vec![config(1), SuprMotrConfig { reply_form: ReportForm::Id, ..config(2) }]);
    bench.raw(b"\x01VEF\r");
    // "1T0:+0000000000" and "T:+0000000000": letters meet figures, and the end of the one a figure of the other.
    assert_eq!(bench.raw(b"TT\r"), "\u{10}\u{10} 0 00000000\0\0\u{1}\n\u{3}");
}

#[test]
fn the_exclamation_mark_stops_boards_that_are_not_selected_too() {
    let mut bench = line(&[1, 2]);
    bench.raw(b"\x01VMA50000\r\x012");
    bench.ms(500);
    bench.raw(b"!");
    let stopped: Vec<i64> = bench.bus.suprmotrs().iter().map(SuprMotr::position).collect();
    bench.ms(1_000);
    for (unit, at) in bench.bus.suprmotrs().iter().zip(stopped) {
        assert!(unit.is_motion_complete() && (unit.position() - at).abs() < 400, "{}", unit.position());
    }
    assert!(!bench.bus.suprmotrs()[0].is_selected());
}

/// A macro begins its next move after a stop: why a stop needs backspace too, and that needs a selection.
#[test]
fn the_exclamation_mark_does_not_end_a_macro_and_backspace_ends_those_that_are_selected() {
    let mut bench = line(&[1, 2]);
    bench.raw(b"\x01VMR1000,WS100,RP\r\x012");
    bench.ms(500);
    bench.raw(b"!");
    bench.ms(150);
    assert!(bench.bus.suprmotrs().iter().any(|unit| !unit.is_motion_complete()), "they go on");
    bench.raw(b"\x01V\x08!");
    bench.ms(1_000);
    assert!(bench.bus.suprmotrs().iter().all(SuprMotr::is_motion_complete));
}

#[test]
fn all_selected_boards_take_a_new_address() {
    let mut bench = line(&[0]);
    assert_eq!(bench.raw(b"\x010DB7\rTB\r"), "7B0:+0000000007\r\n\u{3}");
    assert_eq!(bench.raw(b"\x010TB\r"), "");
    bench.power_cycle();
    assert_eq!(bench.bus.suprmotrs()[0].address(), Address::new(7).expect("there are 16"));
}

#[test]
fn pins_make_the_address_at_a_start_where_they_are_asked_to() {
    let mut pinned = config(9);
    pinned.has_address_pins = true;
    let mut bench = Bench::line(vec![pinned]);
    assert_eq!(bench.unit().address().get(), 0);
    let high = |bench: &mut Bench, channel: usize| bench.channel(channel, true);
    high(&mut bench, 14);
    high(&mut bench, 16);
    assert_eq!(bench.unit().address().get(), 0, "only a start looks");
    bench.raw(b"\x010RT\r");
    bench.ms(150);
    assert_eq!(bench.unit().address().get(), 0b101);
    bench.power_cycle();
    assert_eq!(bench.unit().address().get(), 0b101);
}

#[test]
fn reports_have_the_form_that_the_board_has() {
    for (form, position, status) in [
        (ReportForm::Full, "AP0:+0000000000\r\n\u{3}", "AS:"),
        (ReportForm::Address, "AP:+0000000000\r\n\u{3}", "AS:"),
        (ReportForm::Id, "P:+0000000000\r\n\u{3}", "S:"),
    ] {
        let mut bench = Bench::line(vec![SuprMotrConfig { reply_form: form, ..config(10) }]);
        bench.raw(b"\x01AEF\r");
        assert_eq!(bench.ask("TP"), position);
        assert!(bench.ask("TS").starts_with(status));
    }
}

#[test]
fn a_unit_that_is_unplugged_leaves_the_others_the_line() {
    let mut bench = line(&[1, 2]);
    bench.bus.apply(0, &WorldAction::Unplug { unplugged: true });
    assert_eq!(bench.raw(b"\x011TB\r"), "");
    assert_eq!(bench.raw(b"\x012TB\r"), "2B0:+0000000002\r\n\u{3}");
    assert!(bench.bus.plugged());
}

#[test]
fn a_selection_drops_what_was_typed_of_a_line() {
    let mut bench = line(&[1, 2]);
    assert_eq!(bench.raw(b"\x011MA500,\x012\x011TT\r"), "1T0:+0000000000\r\n\u{3}");
}
