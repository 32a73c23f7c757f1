//! PUTS and GETS over the streams, and how packet serial comes back.

use super::super::support::Bench;
use super::{USB_TO_SCRIPTS, ms, running};
use brushwork_mcp_wire::packet_serial::{Generation, commands, name, number};
use brushwork_plant::machine::{Machine, StreamIndex};
use brushwork_plant::world::ScriptRun;
use brushwork_plant::world::{CanPeer, WorldAction};

const USB: StreamIndex = StreamIndex::Usb;

#[test]
fn a_usb_port_in_mcl_mode_carries_puts_and_gets() {
    // The manual's example of GETS: four bytes make a number.
    let mut bench = running(
        "value var long\nmain\ngets 0,[value.byte3, value.byte2, value.byte1, value.byte0]\nputs 0,[dec value,13]\nend\n",
    );
    bench.bus.receive(USB, &[0x00, 0x01, 0x02]);
    bench.wait(ms(10));
    assert_eq!(bench.said(USB), "");
    bench.bus.receive(USB, &[0x03]);
    bench.wait(ms(10));
    assert_eq!(bench.said(USB), "66051\r");
    assert_eq!(bench.script(), ScriptRun::Ended { line: 5 });
}

#[test]
fn a_port_that_speaks_packet_serial_loses_what_a_script_says() {
    let mut bench = Bench::new(Generation::Gen2);
    bench.start("main\nputs 0,[\"hello\"]\npause 10\ngoto main\n");
    bench.wait(ms(100));
    assert_eq!(bench.said(USB), "");
    assert_eq!(bench.read(commands::READ_STATUS, name::STATUS), 0, "replies are whole");
}

#[test]
fn rts_brings_packet_serial_back_and_its_release_gives_the_port_back_to_the_script() {
    let mut bench = running("main\nputs 0,[\".\"]\npause 10\ngoto main\n");
    bench.wait(ms(35));
    assert_eq!(bench.said(USB), "....");
    assert_eq!(bench.try_ask(number::READ_STATUS, &[]), None, "the port belongs to the script");
    bench.apply(&WorldAction::SetRts { on: true });
    bench.said(USB);
    assert_eq!(bench.read(commands::READ_STATUS, name::STATUS), 0);
    bench.wait(ms(50));
    assert_eq!(bench.said(USB), "", "packet serial is not disturbed");
    bench.apply(&WorldAction::SetRts { on: false });
    bench.wait(ms(20));
    assert_eq!(bench.said(USB), "..");
}

#[test]
fn rs232_is_stream_3_and_ttl_uart_1_is_stream_2() {
    let mut bench = Bench::new(Generation::Gen2);
    for index in [1, 2] {
        bench.ask(commands::SET_STREAM, &[index, 0, 115_200, 1000]);
    }
    bench.start("letter var byte\nmain\ngets 3,[letter]\nputs 2,[letter+1]\ngoto main\n");
    bench.bus.receive(StreamIndex::Uart0, b"HAL");
    bench.wait(ms(10));
    assert_eq!(bench.said(StreamIndex::Uart1), "IBM");
    assert_eq!(bench.said(StreamIndex::Uart0), "");
}

#[test]
fn a_slow_port_makes_a_script_wait_for_its_room() {
    let mut bench = Bench::new(Generation::Gen2);
    bench.ask(commands::SET_STREAM, &[1, 0, 9_600, 1000]);
    bench.start("main\nputs 3,[rep \"x\"\\100]\ngoto main\n");
    bench.wait(ms(1_000));
    // 960 bytes a second leave the port; 64 more wait in it, and up to one text of 100 is on its way.
    let said = bench.said(StreamIndex::Uart0).len();
    assert!((1_000..1_200).contains(&said), "{said}");
}

#[test]
fn a_stream_buffer_holds_255_bytes_and_streamcount_tells_them() {
    let mut bench = running("main\npause 100\nputs 0,[dec STREAMCOUNT(0),13]\nend\n");
    bench.bus.receive(USB, &[7; 300]);
    bench.wait(ms(200));
    assert_eq!(bench.said(USB), "255\r");
}

#[test]
fn what_nobody_reads_does_not_grow_for_ever() {
    let mut bench = running("main\nputs 0,[rep \"x\"\\1000]\ngoto main\n");
    bench.wait(ms(2_000));
    assert_eq!(bench.said(USB).len(), 64 * 1024);
}

#[test]
fn the_can_stream_is_there_while_uart_0_is_disabled() {
    let program = "letter var byte\nmain\nputs 1,[\"ab\"]\ngets 1,[letter]\nputs 0,[letter]\ngets 1,[letter]\nputs 0,[letter,\".\"]\ngoto main\n";
    let mut bench = running(program);
    bench.apply(&WorldAction::SetCanPeer { peer: CanPeer::Echoing });
    bench.wait(ms(20));
    assert_eq!(bench.said(USB), "", "UART0 has the pins");
    let mut bench = Bench::new(Generation::Gen2);
    bench.apply(&WorldAction::SetCanPeer { peer: CanPeer::Echoing });
    bench.ask(commands::SET_STREAM, &[1, 2, 115_200, 1000]);
    bench.start(program);
    bench.ask(commands::SET_STREAM, &USB_TO_SCRIPTS);
    bench.wait(ms(10));
    assert!(bench.said(USB).starts_with("ab.ab."));
    bench.apply(&WorldAction::SetCanPeer { peer: CanPeer::Listening });
    bench.wait(ms(10));
    bench.said(USB);
    bench.apply(&WorldAction::SendCan { bytes: b"xy".to_vec() });
    bench.wait(ms(10));
    assert_eq!(bench.said(USB), "xy.");
    assert_eq!(bench.unit().view().can_heard.last(), Some(&b'b'));
}
