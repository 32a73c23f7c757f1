//! CANopen between its two ends, whole and damaged: client against server at every length, and any bytes at all into the readers.
//! Seeds are fixed and named on failure.

use std::collections::BTreeMap;

use brushwork_canopen::adapter::{Decoder, Form};
use brushwork_canopen::sdo::{Abort, Dictionary, Progress, Server, Transfer};
use brushwork_canopen::{CanId, Frame};
use brushwork_mcp_wire::canopen::describe_frame;
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::{Rng, SeedableRng};

/// Damaged streams tried for each form.
const SEEDS: u64 = 4_000;

#[derive(Default)]
struct Objects(BTreeMap<(u16, u8), Vec<u8>>);

impl Dictionary for Objects {
    fn read(&mut self, index: u16, subindex: u8) -> Result<Vec<u8>, Abort> {
        self.0.get(&(index, subindex)).cloned().ok_or(Abort::NO_OBJECT)
    }

    fn write(&mut self, index: u16, subindex: u8, value: &[u8]) -> Result<(), Abort> {
        self.0.insert((index, subindex), value.to_vec());
        Ok(())
    }
}

/// Lets a transfer run to its end and says what became of it and how many frames the client sent.
fn run(transfer: &mut Transfer, server: &mut Server, objects: &mut Objects) -> (Progress, usize) {
    let mut request = transfer.begin();
    for frames in 1.. {
        let response = server.take(&request, objects).expect("each request has an answer");
        match transfer.take(&response) {
            Progress::Send(next) => request = next,
            end => return (end, frames),
        }
    }
    unreachable!("values end")
}

#[test]
fn values_of_every_length_are_written_and_read_back() {
    let (mut server, mut objects) = (Server::default(), Objects::default());
    for length in 0..=256_usize {
        let value: Vec<u8> = (0..length).map(|at| (at * 7 + length) as u8).collect();
        let (written, frames) = run(&mut Transfer::download(0x2036, 2, &value), &mut server, &mut objects);
        assert_eq!(written, Progress::Done(Vec::new()), "{length}");
        let (read, _) = run(&mut Transfer::upload(0x2036, 2), &mut server, &mut objects);
        assert_eq!(read, Progress::Done(value), "{length}");
        let expected = if (1..=4).contains(&length) { 1 } else { 1 + length.div_ceil(7).max(1) };
        assert_eq!(frames, expected, "frames for {length} bytes");
    }
}

#[test]
fn an_upload_in_segments_goes_over_the_bus_as_cia_301_has_it() {
    let (mut server, mut objects) = (Server::default(), Objects::default());
    objects.0.insert((0x2015, 1), b"MCP266 2x60A v1.0.0".to_vec());
    let conversation: [([u8; 8], [u8; 8]); 4] = [
        // 40: upload of 2015:01. 41: 19 bytes follow in segments.
        ([0x40, 0x15, 0x20, 0x01, 0, 0, 0, 0], [0x41, 0x15, 0x20, 0x01, 19, 0, 0, 0]),
        // 60: segment, toggle 0. 00: toggle 0, seven bytes, more to come: "MCP266 ".
        ([0x60, 0, 0, 0, 0, 0, 0, 0], [0x00, b'M', b'C', b'P', b'2', b'6', b'6', b' ']),
        // 70: toggle 1. 10: toggle 1: "2x60A v".
        ([0x70, 0, 0, 0, 0, 0, 0, 0], [0x10, b'2', b'x', b'6', b'0', b'A', b' ', b'v']),
        // 60: toggle 0. 05: two of seven bytes unused, the last: "1.0.0".
        ([0x60, 0, 0, 0, 0, 0, 0, 0], [0x05, b'1', b'.', b'0', b'.', b'0', 0, 0]),
    ];
    for (request, response) in conversation {
        assert_eq!(server.take(&request, &mut objects), Some(response));
    }
}

#[test]
fn a_refusal_is_passed_on_and_the_next_access_works() {
    let (mut server, mut objects) = (Server::default(), Objects::default());
    let (end, _) = run(&mut Transfer::upload(0x1234, 5), &mut server, &mut objects);
    assert_eq!(end, Progress::Refused(Abort::NO_OBJECT));
    assert_eq!(
        run(&mut Transfer::download(0x1234, 5, &[1]), &mut server, &mut objects).0,
        Progress::Done(Vec::new())
    );
}

#[test]
fn a_toggle_out_of_step_is_given_up_on_both_sides() {
    let (mut server, mut objects) = (Server::default(), Objects::default());
    objects.0.insert((0x2015, 1), vec![1; 20]);
    server.take(&Transfer::upload(0x2015, 1).begin(), &mut objects);
    // 70: the second segment is asked for before the first.
    let answer = server.take(&[0x70, 0, 0, 0, 0, 0, 0, 0], &mut objects).unwrap();
    // 80: abort of 2015:01, 0503 0000.
    assert_eq!(answer, [0x80, 0x15, 0x20, 0x01, 0x00, 0x00, 0x03, 0x05]);
    let mut transfer = Transfer::upload(0x2015, 1);
    assert_eq!(transfer.begin()[0], 0x40);
    assert!(matches!(transfer.take(&[0x41, 0x15, 0x20, 0x01, 20, 0, 0, 0]), Progress::Send(_)));
    assert!(matches!(
        transfer.take(&[0x10, 1, 1, 1, 1, 1, 1, 1]),
        Progress::GiveUp { code: Abort::TOGGLE, .. }
    ));
}

#[test]
fn answers_to_an_earlier_access_are_passed_by() {
    let mut transfer = Transfer::upload(0x2018, 0);
    for late in [
        [0x4B, 0x19, 0x20, 0x00, 1, 2, 0, 0], // 2019:00 holds something
        [0x60, 0x18, 0x20, 0x00, 0, 0, 0, 0], // a write was taken
        [0x20, 0, 0, 0, 0, 0, 0, 0],          // a segment was taken
        [0x00, 1, 2, 3, 4, 5, 6, 7],          // a segment
        [0x80, 0x19, 0x20, 0x00, 0, 0, 2, 6], // 2019:00 does not exist
    ] {
        assert_eq!(transfer.take(&late), Progress::Passed, "{late:02X?}");
    }
    assert_eq!(transfer.take(&[0x4B, 0x18, 0x20, 0x00, 0xF3, 0x00, 0, 0]), Progress::Done(vec![0xF3, 0x00]));
}

#[test]
fn block_transfer_is_refused() {
    let (mut server, mut objects) = (Server::default(), Objects::default());
    // A0: initiate block upload of 1008:00. 80: abort 0504 0001.
    let answer = server.take(&[0xA0, 0x08, 0x10, 0x00, 0x7F, 0, 0, 0], &mut objects);
    assert_eq!(answer, Some([0x80, 0x08, 0x10, 0x00, 0x01, 0x00, 0x04, 0x05]));
}

#[test]
fn any_bytes_at_all_stop_neither_client_nor_server() {
    for seed in 0..SEEDS {
        let mut dice = ChaCha8Rng::seed_from_u64(seed);
        let (mut server, mut objects) = (Server::default(), Objects::default());
        objects.0.insert((0x2015, 1), vec![7; 40]);
        let mut client =
            if seed % 2 == 0 { Transfer::upload(0x2015, 1) } else { Transfer::download(1, 1, &[0; 30]) };
        let mut last = client.begin();
        for _ in 0..40 {
            let mut bytes = last;
            if dice.next_u32().is_multiple_of(3) {
                bytes[dice.next_u32() as usize % 8] = dice.next_u32() as u8;
            }
            let Some(mut answer) = server.take(&bytes, &mut objects) else { break };
            if dice.next_u32().is_multiple_of(3) {
                answer[dice.next_u32() as usize % 8] = dice.next_u32() as u8;
            }
            match client.take(&answer) {
                Progress::Send(next) | Progress::GiveUp { bytes: next, .. } => last = next,
                _ => last = client.begin(),
            }
        }
        server.reset();
        let (read, _) = run(&mut Transfer::upload(0x2015, 1), &mut server, &mut objects);
        assert!(matches!(read, Progress::Done(_)), "seed {seed}: {read:?}");
    }
}

fn any_frame(dice: &mut ChaCha8Rng, form: Form) -> Frame {
    let id = match dice.next_u32() % 4 {
        0 if form == Form::Ascii => CanId::Extended(dice.next_u32() & CanId::MAX_EXTENDED),
        _ => CanId::Standard(dice.next_u32() as u16 & CanId::MAX_STANDARD),
    };
    let length = dice.next_u32() % 9;
    if dice.next_u32().is_multiple_of(8) {
        return Frame::remote(id, length as u8).expect("at most eight");
    }
    // FF often, since the binary form treats it apart.
    let bytes: Vec<u8> = (0..length)
        .map(|_| if dice.next_u32().is_multiple_of(3) { 0xFF } else { dice.next_u32() as u8 })
        .collect();
    Frame::data(id, &bytes).expect("at most eight")
}

#[test]
fn frames_pass_adapters_unchanged_in_pieces_of_any_size() {
    for form in Form::ALL {
        for seed in 0..SEEDS {
            let mut dice = ChaCha8Rng::seed_from_u64(seed);
            let frames: Vec<Frame> = (0..5).map(|_| any_frame(&mut dice, form)).collect();
            let bytes: Vec<u8> = frames.iter().filter_map(|frame| form.encode(frame)).flatten().collect();
            let mut decoder = Decoder::new(form);
            assert_eq!(decoder.feed_all(&bytes), frames, "{form:?}, seed {seed}");
            assert_eq!(decoder.discarded(), 0);
        }
    }
}

#[test]
fn a_damaged_stream_costs_the_frames_it_hits_and_no_frame_after_the_next_two() {
    for form in Form::ALL {
        for seed in 0..SEEDS {
            let mut dice = ChaCha8Rng::seed_from_u64(seed);
            let before: Vec<Frame> = (0..3).map(|_| any_frame(&mut dice, form)).collect();
            let mut bytes: Vec<u8> = before.iter().filter_map(|frame| form.encode(frame)).flatten().collect();
            for _ in 0..1 + dice.next_u32() % 4 {
                let at = dice.next_u32() as usize % bytes.len();
                match dice.next_u32() % 3 {
                    0 => bytes[at] = dice.next_u32() as u8,
                    1 => drop(bytes.remove(at)),
                    _ => bytes.insert(at, dice.next_u32() as u8),
                }
            }
            let after: Vec<Frame> = (0..3).map(|_| any_frame(&mut dice, form)).collect();
            bytes.extend(after.iter().filter_map(|frame| form.encode(frame)).flatten());
            let read = Decoder::new(form).feed_all(&bytes);
            read.iter().for_each(|frame| drop(describe_frame(frame)));
            assert_eq!(read.last(), after.last(), "{form:?}, seed {seed}: {bytes:02X?}");
        }
    }
}
