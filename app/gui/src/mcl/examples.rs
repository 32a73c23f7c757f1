//! The programs that come with Brushwork, from `assets/mcl`.

/// An example.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Example {
    /// As its tab reads.
    pub title: &'static str,
    pub text: &'static str,
}

macro_rules! example {
    ($name:literal) => {
        Example { title: $name, text: include_str!(concat!("../../../../assets/mcl/", $name)) }
    };
}

/// In the order of the File menu.
pub const EXAMPLES: [Example; 7] = [
    example!("hello.mcl"),
    example!("blink.mcl"),
    example!("ramp.mcl"),
    example!("there-and-back.mcl"),
    example!("drive-by-keys.mcl"),
    example!("melody.mcl"),
    example!("starts-in-eeprom.mcl"),
];

#[cfg(test)]
mod tests {
    use super::*;
    use brushwork_script::mcl::index::check;

    #[test]
    fn every_example_compiles_without_a_word_of_complaint() {
        for example in EXAMPLES {
            assert_eq!(check(example.text), [], "{}", example.title);
        }
    }
}
