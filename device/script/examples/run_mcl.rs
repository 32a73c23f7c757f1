//! Compiles an MCL script and runs it on the terminal: `cargo run -p brushwork-script --example run_mcl -- assets/mcl/ramp.mcl`.
//!
//! What the script sends to stream 0 is printed as it is, its motion commands with the time they come at. Pauses take no time, and a
//! script that goes on for ever is ended after ten minutes of its own. Without an argument it runs a script that it brings along.
#![expect(clippy::print_stdout, reason = "an example talks to the terminal")]

use brushwork_script::mcl::ast::Motion;
use brushwork_script::mcl::compile;
use brushwork_script::mcl::registers::RegisterId;
use brushwork_script::text::Lines;
use brushwork_script::vm::{Host, Machine, State};
use std::collections::HashMap;
use std::error::Error;
use std::sync::Arc;
use std::time::Duration;

/// Runs motor 1 up and down again.
const BROUGHT_ALONG: &str = r#"
duty VAR SLong
for duty = 0 to 30000 step 10000
    power 0, duty, 0
    puts 0, ["duty ", sdec duty * 100 / 32767, " %", 13, 10]
    pause 500
next
power 0, 0, 0
end
"#;

/// Instructions between two looks at the clock, how long they are taken to need, and when a script has run long enough.
const SLICE: u32 = 1_000;
const SLICE_TIME: Duration = Duration::from_millis(10);
const LONG_ENOUGH: Duration = Duration::from_secs(600);

fn main() -> Result<(), Box<dyn Error>> {
    let (name, text) = match std::env::args().nth(1) {
        Some(path) => (path.clone(), std::fs::read_to_string(path)?),
        None => ("brought along".to_owned(), BROUGHT_ALONG.to_owned()),
    };
    let compiled = compile(&text);
    let lines = Lines::of(&text);
    for diagnostic in &compiled.diagnostics {
        print!("{}", diagnostic.render(&name, &text, &lines));
    }
    let program = compiled.program.ok_or("the script has errors")?;
    let size = program.size();
    println!("{} instructions, {} bytes of variables", size.instructions, size.ram_bytes);

    let mut machine = Machine::new(Arc::new(program));
    let mut terminal = Terminal::default();
    while terminal.now < LONG_ENOUGH {
        match machine.run(&mut terminal, SLICE) {
            State::Ready => terminal.now += SLICE_TIME,
            State::Pausing { until } => terminal.now = *until,
            State::Listening { stream } => {
                return Err(format!("it waits for a byte of stream {stream}").into());
            }
            State::Ended => break,
            State::Faulted(fault) => return Err(fault.to_string().into()),
        }
    }
    println!(
        "after {:.3} s and {} instructions: {:?}",
        terminal.now.as_secs_f64(),
        machine.executed(),
        machine.state()
    );
    Ok(())
}

/// A controller of which only the output is there: registers keep what is written to them, and nobody types.
#[derive(Default)]
struct Terminal {
    now: Duration,
    registers: HashMap<(RegisterId, u8), u32>,
    eeprom: HashMap<u32, u8>,
}

impl Host for Terminal {
    fn now(&self) -> Duration {
        self.now
    }

    fn register(&mut self, id: RegisterId, element: u8) -> u32 {
        self.registers.get(&(id, element)).copied().unwrap_or(0)
    }

    fn set_register(&mut self, id: RegisterId, element: u8, value: u32) {
        self.registers.insert((id, element), value);
    }

    fn put(&mut self, stream: u32, byte: u8) {
        if stream == 0 {
            print!("{}", char::from(byte));
        }
    }

    fn get(&mut self, _stream: u32) -> Option<u8> {
        None
    }

    fn motion(&mut self, command: Motion, arguments: &[i32]) {
        println!("{:8.3} s  {} {arguments:?}", self.now.as_secs_f64(), command.word());
    }

    fn read_eeprom(&mut self, address: u32) -> u8 {
        self.eeprom.get(&address).copied().unwrap_or(0xFF)
    }

    fn write_eeprom(&mut self, address: u32, value: u8) {
        self.eeprom.insert(address, value);
    }

    fn i2c_write(&mut self, _bytes: &[u8], _stop: bool, _timeout: Option<Duration>) -> bool {
        false
    }

    fn i2c_read(&mut self, _count: usize, _timeout: Option<Duration>) -> Option<Vec<u8>> {
        None
    }
}
