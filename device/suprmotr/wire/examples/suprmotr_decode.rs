//! What a line asks for: `cargo run -p brushwork-suprmotr-wire --example suprmotr_decode -- "MA0,WS500,MR500,WS100,RP49"`.
#![expect(clippy::print_stdout, reason = "an example talks to the terminal")]

use brushwork_suprmotr_wire::{Radix, describe_line, parse_line};

/// The demonstration of the manual.
const BROUGHT_ALONG: &str = "MA0,WS500,MR500,WS100,RP49";

fn main() {
    let given: Vec<String> = std::env::args().skip(1).collect();
    let text = if given.is_empty() { BROUGHT_ALONG.to_owned() } else { given.join(" ") };
    let parsed = parse_line(text.as_bytes(), Radix::Decimal);
    println!("{}", describe_line(&parsed.line));
    if let Some(error) = parsed.error {
        println!("{error}");
    }
}
