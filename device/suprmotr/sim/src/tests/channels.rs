//! Digital channels, analog inputs and the analog output (SuprMotr manual, connector J3 and commands SO to XF).

use crate::pin;

use crate::tests::bench::Bench;

#[test]
fn channels_are_told_all_or_one() {
    let mut bench = Bench::new();
    assert_eq!(bench.ask("TC"), "0H0: 0000 0000\r\n\u{3}");
    bench.channel(1, true);
    bench.channel(16, true);
    assert_eq!(bench.ask("TC0"), "0H0: 0000 8001\r\n\u{3}");
    assert_eq!(bench.ask("TC1"), "0H1: 1\r\n\u{3}");
    assert_eq!(bench.ask("TC2"), "0H2: 0\r\n\u{3}");
    assert_eq!(bench.raw(b"#"), "0H0: 0000 8001\r\n\u{3}");
    bench.tell("CN3");
    assert_eq!((bench.unit().outputs(), bench.ask("TC").as_str()), (0x0004, "0H0: 0004 8005\r\n\u{3}"));
}

#[test]
fn outputs_are_switched_one_by_one_all_or_by_a_pattern() {
    let mut bench = Bench::new();
    for (line, outputs) in [
        ("CN1", 0x0001),
        ("CN16", 0x8001),
        ("CF 1", 0x8000),
        ("CN", 0xFFFF),
        ("CF0", 0x0000),
        ("CN0", 0xFFFF),
        ("CF", 0x0000),
        ("CP513", 0x0201),
        ("CI1", 0x0200),
        ("CT1", 0x0201),
    ] {
        bench.tell(line);
        assert_eq!(bench.unit().outputs(), outputs, "{line}");
    }
}

/// 5 V at 255, 19.5 mV a step.
#[test]
fn analog_inputs_are_told_both_or_one() {
    let mut bench = Bench::new();
    bench.volts(pin::ANALOG_1, 2.49);
    bench.volts(pin::ANALOG_2, 4.5);
    assert_eq!(bench.ask("TA"), "0A0: 127 230\r\n\u{3}");
    assert_eq!(bench.ask("TA1"), "0A1:127\r\n\u{3}");
    assert_eq!(bench.ask("TA2"), "0A2:230\r\n\u{3}");
}

#[test]
fn nothing_on_the_analog_inputs_is_0_and_the_pull_up() {
    let mut bench = Bench::new();
    assert_eq!(bench.ask("TA"), "0A0: 0 255\r\n\u{3}");
}

#[test]
fn the_analog_output_is_set_changed_and_told() {
    let mut bench = Bench::new();
    bench.tell("SO255");
    assert_eq!(bench.ask("TO"), "0O0:255\r\n\u{3}");
    bench.tell("SO10,IO2");
    assert_eq!(bench.unit().analog_output(), 12);
    bench.tell("IO-20");
    assert_eq!(bench.unit().analog_output(), 248);
}

/// Lines that wait for channels, and lines that depend on them: the manual's examples.
#[test]
fn lines_wait_for_channels_and_depend_on_them() {
    let mut bench = Bench::new();
    bench.begin("WN1,MA1000,WF1,MA0");
    bench.ms(100);
    assert_eq!(bench.unit().position(), 0);
    bench.channel(1, true);
    bench.ms(500);
    assert!(bench.unit().position() > 950);
    bench.channel(1, false);
    bench.ms(500);
    assert!(bench.unit().position() < 50);
    for (on, moves) in [(&[1, 2][..], true), (&[1][..], false), (&[1, 2, 3][..], false)] {
        let mut bench = Bench::new();
        on.iter().for_each(|channel| bench.channel(*channel, true));
        bench.begin("XN1,XN2,XF3,MR599,WS10");
        assert_eq!(!bench.unit().is_motion_complete(), moves, "{on:?}");
    }
}
