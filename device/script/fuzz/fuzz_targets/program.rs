//! Any text: it compiles or is refused, and what compiles runs, comes back from its image and keeps its meaning when it is formatted.
#![no_main]

mod nobody;

use brushwork_script::image::{decode, encode};
use brushwork_script::mcl::{compile, format::format};
use brushwork_script::vm::Machine;
use libfuzzer_sys::fuzz_target;
use nobody::Nobody;
use std::sync::Arc;

fuzz_target!(|text: &str| {
    let formatted = format(text);
    assert_eq!(format(&formatted), formatted);
    let Some(program) = compile(text).program else { return };
    assert_eq!(decode(&encode(&program)).as_ref(), Ok(&program));
    Machine::new(Arc::new(program)).run(&mut Nobody, 5_000);
});
