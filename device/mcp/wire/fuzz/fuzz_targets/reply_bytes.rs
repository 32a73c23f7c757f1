//! Any bytes as the reply to any request into a client: no panic, and what is reported fits what came.
#![no_main]

use brushwork_mcp_wire::packet_serial::{Address, COMMANDS, Generation, ReplyProgress, Request, describe_reply, parse_reply};
use libfuzzer_sys::fuzz_target;

fuzz_target!(|data: &[u8]| {
    let &[first, number, ref bytes @ ..] = data else { return };
    let generation = Generation::ALL[usize::from(first % 4)];
    let command = &COMMANDS[usize::from(number) % COMMANDS.len()];
    let arguments = command.form(generation).map_or(0, |form| form.request.len());
    let request = Request::new(Address::DEFAULT, command.number, &vec![0; arguments]);
    match parse_reply(&request, generation, bytes) {
        ReplyProgress::NeedMore { at_least } => assert!(at_least > bytes.len()),
        ReplyProgress::Done { values, used } => {
            assert!(used <= bytes.len());
            let _ = describe_reply(&request, &values, generation);
        }
        ReplyProgress::BadCrc { expected, got, used } => assert!(expected != got && used <= bytes.len()),
        ReplyProgress::BadAck { got } => assert_ne!(got, 0xFF),
        ReplyProgress::Malformed { .. } => {}
    }
});
