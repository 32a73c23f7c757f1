//! The commands by name, each with its layout as a type.

use super::number::command_numbers;
use super::typed::{Typed, layout_of};

macro_rules! typed_commands {
    ($($name:ident = $number:literal;)*) => {
        $(
            #[doc = concat!("Command ", stringify!($number), "; see its row in [`COMMANDS`](super::COMMANDS).")]
            pub const $name: Typed<{ layout_of($number) }> = Typed::new($number);
        )*
    };
}

command_numbers!(typed_commands);
