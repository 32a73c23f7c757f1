//! The table against a foreign client: what the vendor's Python library of 2025 sends must be framed in the layout of
//! generation 4 and encode to the same bytes, and what it reads back must have the same fields.

use std::time::Duration;

use brushwork_mcp_wire::packet_serial::{Framed, FramerEvent, Generation, Request, RequestFramer, lookup};
use brushwork_values::{Field, Kind};

const RECORDED: &str = include_str!("../data/python_2025.txt");

struct Line {
    number: u8,
    sent: Vec<u8>,
    /// Width in bytes and value, in wire order.
    arguments: Vec<(usize, i64)>,
    /// Width in bytes of each field read back.
    reply: Vec<usize>,
    method: &'static str,
}

fn lines() -> impl Iterator<Item = Line> {
    RECORDED.lines().filter(|line| !line.starts_with('#')).map(|line| {
        let columns: Vec<&'static str> = line.split(" | ").collect();
        let [number, sent, arguments, reply, method] = columns.try_into().expect("five columns");
        Line {
            number: number.parse().expect("a number"),
            sent: bytes(sent),
            arguments: words(arguments).map(argument).collect(),
            reply: words(reply).map(|width| width.parse().expect("a width")).collect(),
            method,
        }
    })
}

fn bytes(hex: &str) -> Vec<u8> {
    let pairs = hex.as_bytes().chunks(2);
    pairs.map(|pair| u8::from_str_radix(std::str::from_utf8(pair).expect("text"), 16).expect("hex")).collect()
}

fn words(column: &'static str) -> impl Iterator<Item = &'static str> {
    column.split(' ').filter(|word| *word != "-")
}

fn argument(word: &str) -> (usize, i64) {
    let (width, value) = word.split_once('=').expect("width=value");
    (width.parse().expect("a width"), value.parse().expect("a value"))
}

fn framed(line: &Line) -> Framed {
    let mut framer = RequestFramer::new(Generation::Gen4);
    let events: Vec<FramerEvent> =
        line.sent.iter().filter_map(|&byte| framer.feed(byte, Duration::ZERO)).collect();
    match <[FramerEvent; 1]>::try_from(events) {
        Ok([FramerEvent::Request(framed)]) => framed,
        other => panic!("{} gave {other:?}", line.method),
    }
}

/// The widths of the numbers that a layout is made of; a run of bytes counts as so many bytes, one record as it is.
fn widths(fields: &[Field]) -> Vec<usize> {
    fields
        .iter()
        .flat_map(|field| match field.kind {
            Kind::Bytes(count) => vec![1; count],
            Kind::Ascii36 => vec![1; 37],
            Kind::Counted(record) => [vec![1], widths(record)].concat(),
            ref kind => vec![kind.width().expect("fixed")],
        })
        .collect()
}

#[test]
fn every_packet_it_sends_is_framed_in_the_layout_of_generation_4() {
    let mut count = 0;
    for line in lines() {
        let framed = framed(&line);
        assert_eq!((framed.command.number, framed.address.get()), (line.number, 0x81), "{}", line.method);
        assert!(framed.native, "{}", line.method);
        count += 1;
    }
    assert_eq!(count, 148);
}

#[test]
fn every_packet_it_sends_encodes_to_the_same_bytes() {
    for line in lines() {
        let framed = framed(&line);
        let request: Request = framed.request();
        assert_eq!(request.encode(Generation::Gen4).expect("fits"), line.sent, "{}", line.method);
    }
}

#[test]
fn its_arguments_lie_in_fields_of_the_same_width_with_the_same_values() {
    for line in lines() {
        // Command 253 sends its word as two bytes, which are the same on the wire.
        if line.number == 253 {
            assert_eq!(framed(&line).values.ints().collect::<Vec<_>>(), [4, 5]);
            continue;
        }
        let framed = framed(&line);
        let expected: Vec<usize> = line.arguments.iter().map(|(width, _)| *width).collect();
        assert_eq!(widths(framed.values.fields()), expected, "{}", line.method);
        if framed.values.ints().count() == line.arguments.len() {
            for ((width, expected), got) in line.arguments.iter().zip(framed.values.ints()) {
                let bits = width * 8;
                assert_eq!(got.rem_euclid(1 << bits), expected.rem_euclid(1 << bits), "{}", line.method);
            }
        }
    }
}

#[test]
fn what_it_reads_back_has_fields_of_the_same_width() {
    for line in lines() {
        let form = lookup(line.number).and_then(|row| row.form(Generation::Gen4)).expect("in generation 4");
        assert_eq!(widths(form.reply.fields()), line.reply, "{}", line.method);
    }
}
