//! Bytes at the baud rate, computed in virtual time.

use crate::support::{Parrot, USB, exchange};
use brushwork_plant::machine::Machine;
use brushwork_plant::pacing::{Paced, byte_time};
use std::time::Duration;

const WINDOW: Duration = Duration::from_millis(100);
const TURNAROUND: Duration = Duration::from_micros(50);

fn paced(bits_per_second: u32) -> Paced<Parrot> {
    let mut parrot = Parrot::new();
    parrot.bits_per_second = bits_per_second;
    parrot.turnaround = TURNAROUND;
    Paced::new(parrot, true)
}

#[test]
fn a_byte_takes_ten_bits() {
    assert_eq!(byte_time(1_000_000), Duration::from_micros(10));
    assert_eq!(byte_time(38_400), Duration::from_nanos(260_416));
    assert_eq!(byte_time(0), Duration::from_secs(10), "no rate is no reason to panic");
}

#[test]
fn a_transaction_takes_request_turnaround_and_reply() {
    for bits_per_second in [2400, 38_400, 115_200, 1_000_000] {
        let mut line = paced(bits_per_second);
        let byte = byte_time(bits_per_second);
        let pieces = exchange(&mut line, &[0x80, 0x15], WINDOW);
        let at = |index| byte * 2 + TURNAROUND + byte * index;
        assert_eq!(pieces, [1, 2, 3, 4].map(|index| (at(index), vec![0x15])), "{bits_per_second}");
        let heard = &line.inner_mut().heard;
        assert_eq!(*heard, [(byte, 0x80), (byte * 2, 0x15)], "each byte arrives at its own time");
    }
}

#[test]
fn requests_sent_together_queue_on_the_line_and_so_do_their_replies() {
    let mut line = paced(115_200);
    let pieces = exchange(&mut line, &[0x80, 1, 0x80, 2, 0x80, 3], WINDOW);
    let byte = byte_time(115_200);
    // The first reply begins after the first request; each reply is longer than a request, so the line out is then full.
    let begins = byte * 2 + TURNAROUND;
    let expected = (1..=12).map(|index| (begins + byte * index, vec![index.div_ceil(4) as u8]));
    assert_eq!(pieces, expected.collect::<Vec<_>>());
}

#[test]
fn a_late_driver_does_not_change_the_times_on_the_line() {
    let mut line = paced(115_200);
    line.receive(USB, &[0x80, 0x15]);
    line.advance(Duration::from_secs(1));
    assert_eq!(line.take_output(USB), Some(vec![0x15; 4]));
    let byte = byte_time(115_200);
    assert_eq!(line.inner_mut().heard, [(byte, 0x80), (byte * 2, 0x15)]);
}

#[test]
fn without_pacing_nothing_takes_time() {
    let mut line = Paced::new(Parrot::new(), false);
    assert_eq!(exchange(&mut line, &[0x80, 0x15], WINDOW), [(Duration::ZERO, vec![0x15; 4])]);
}

#[test]
fn clearing_takes_away_what_is_on_its_way() {
    let mut line = Paced::new(Parrot::new(), true);
    line.receive(USB, &[0x80, 0x15, 0x80]);
    line.advance(byte_time(115_200) * 2);
    line.clear();
    line.advance(WINDOW);
    assert_eq!((line.take_output(USB), line.next_output_at()), (None, None));
}
