//! The programs that come with Brushwork, from `assets/mcl` and `assets/mecc`.

/// An example.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Example {
    /// As its tab reads.
    pub title: &'static str,
    pub text: &'static str,
}

macro_rules! example {
    ($folder:literal, $name:literal) => {
        Example { title: $name, text: include_str!(concat!("../../../../assets/", $folder, "/", $name)) }
    };
}

/// In the order of the File menu.
pub const EXAMPLES: [Example; 9] = [
    example!("mcl", "hello.mcl"),
    example!("mcl", "blink.mcl"),
    example!("mcl", "ramp.mcl"),
    example!("mcl", "there-and-back.mcl"),
    example!("mcl", "drive-by-keys.mcl"),
    example!("mcl", "melody.mcl"),
    example!("mcl", "starts-in-eeprom.mcl"),
    example!("mecc", "flash.mecc"),
    example!("mecc", "motors.mecc"),
];

#[cfg(test)]
mod tests {
    use super::*;
    use brushwork_script::language::Language;

    #[test]
    fn every_example_compiles_without_a_word_of_complaint() {
        for example in EXAMPLES {
            let language = Language::of_file(example.title);
            assert_eq!(language.index(example.text).diagnostics, [], "{}", example.title);
        }
    }
}
