//! The serial line and the command line.

use crate::assumed::HELP;
use crate::tests::bench::Bench;
use crate::{Motorvator, What};
use std::time::Duration;

const ECHO: &str = "\
Declare DataTable t
Reserve 8
End DataTable
Declare DataPointer p
Declare EventHandler back()
p = SetPointer(t)
Receive p
p = SetPointer(t)
Transmit p
End EventHandler
Begin Program
SetEvent ReceiveEvent, back
Enable Events
Loop
End Loop
End Program
";

#[test]
fn data_goes_to_the_program_and_what_makes_no_frame_does_not() {
    let mut bench = Bench::new(ECHO);
    bench.run(0.1);
    for line in ["I001002003", "I256", "I1", "hello", "I255000255000255000255000001"] {
        let from = bench.board.now().as_secs_f64();
        bench.send(line).run(from + 0.5);
    }
    assert_eq!(bench.sent(), ["073001002003000000000000000", "073255000255000255000255000"]);
    assert_eq!(bench.words, "?\r\n?\r\n?\r\n");
}

#[test]
fn a_frame_is_out_after_its_28_characters() {
    let mut bench = Bench::new(ECHO);
    bench.run(0.1).send("I001");
    let leaves = |bench: &mut Bench| {
        bench.board.advance(Duration::from_millis(105));
        bench.board.next_output_at().expect("a frame is under way").as_secs_f64() - 0.1
    };
    let at = leaves(&mut bench);
    assert!((0.0291..0.0296).contains(&at), "{at}");
}

#[test]
fn the_command_line_stays_alive_while_a_program_runs_and_g_begins_it_anew() {
    let text =
        "Declare Byte n\nBegin Program\nLoop\nIncrement n\nDisplayHex n\nWait 128\nEnd Loop\nEnd Program\n";
    let mut bench = Bench::new(text);
    bench.run(2.5);
    assert_eq!(bench.board.display(), *b"03");
    bench.send("H").run(2.9);
    assert_eq!(bench.words, HELP);
    bench.send("g").run(3.5);
    assert_eq!(bench.board.display(), *b"01");
}

#[test]
fn a_board_waits_for_g_and_says_when_it_has_no_program() {
    let mut board = Motorvator::new(None);
    board.receive(b"G\r");
    board.advance(Duration::from_secs(1));
    assert_eq!(board.take_output().as_deref(), Some(&b"No program\r\n"[..]));
    assert!(!board.is_running());
}

#[test]
fn a_transmission_while_one_is_under_way_is_lost_and_seen_to_be() {
    let text = ECHO.replace("Transmit p\n", "Transmit p\np = SetPointer(t)\nTransmit p\n");
    let mut bench = Bench::new(&text);
    bench.run(0.1).send("I007").run(1.0);
    assert_eq!(bench.sent(), ["073007000000000000000000000"]);
    let lost: Vec<bool> = bench
        .trace
        .iter()
        .filter_map(|seen| match seen.what {
            What::Transmit { lost, .. } => Some(lost),
            _ => None,
        })
        .collect();
    assert_eq!(lost, [false, true]);
}

#[test]
fn a_program_that_cannot_go_on_says_unknown_instruction() {
    let text = "Declare DataPointer p\nDeclare Byte b\nBegin Program\np = 60000\nb = ReadData(p)\nDisplayHex b\nEnd Program\n";
    let mut bench = Bench::new(text);
    bench.run(1.0);
    assert_eq!(bench.words, "Unknown Instruction\r\n");
    let fault = bench.board.fault().unwrap();
    assert_eq!(
        (fault.line, fault.kind.to_string().as_str()),
        (5, "the pointer is at byte 60000; the variables have 11 bytes")
    );
    let seen = bench.trace.last().unwrap();
    assert_eq!(
        serde_json::to_string(seen).unwrap(),
        "{\"t\":0.00008,\"event\":\"fault\",\"line\":5,\"message\":\"Unknown Instruction: the pointer is at byte 60000; the variables have 11 bytes\"}"
    );
}
