//! Why an access was refused or given up (CiA 301, table of SDO abort codes).

use std::fmt;

/// An abort code.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Abort(pub u32);

macro_rules! aborts {
    ($($name:ident = $code:literal, $text:literal;)*) => {
        impl Abort {
            $(
                #[doc = concat!("Code ", stringify!($code), ": ", $text, ".")]
                pub const $name: Self = Self($code);
            )*

            /// All codes of the standard with what they say.
            pub const KNOWN: &'static [(Self, &'static str)] = &[$((Self($code), $text)),*];
        }
    };
}

aborts! {
    TOGGLE = 0x0503_0000, "the toggle bit did not alternate";
    TIMED_OUT = 0x0504_0000, "the SDO protocol timed out";
    UNKNOWN_COMMAND = 0x0504_0001, "the command specifier is not valid or unknown";
    BLOCK_SIZE = 0x0504_0002, "the block size is invalid";
    SEQUENCE_NUMBER = 0x0504_0003, "the sequence number is invalid";
    CRC = 0x0504_0004, "the CRC does not fit";
    OUT_OF_MEMORY = 0x0504_0005, "out of memory";
    UNSUPPORTED_ACCESS = 0x0601_0000, "this access to the object is not supported";
    WRITE_ONLY = 0x0601_0001, "the object can only be written";
    READ_ONLY = 0x0601_0002, "the object can only be read";
    NO_OBJECT = 0x0602_0000, "the object does not exist";
    NOT_MAPPABLE = 0x0604_0041, "the object cannot be mapped to a PDO";
    PDO_LENGTH = 0x0604_0042, "the mapped objects are longer than a PDO";
    INCOMPATIBLE = 0x0604_0043, "the parameters do not go together";
    INTERNAL = 0x0604_0047, "the device is incompatible in itself";
    HARDWARE = 0x0606_0000, "the hardware failed";
    LENGTH = 0x0607_0010, "the length of the value does not fit";
    TOO_LONG = 0x0607_0012, "the value is too long";
    TOO_SHORT = 0x0607_0013, "the value is too short";
    NO_SUBINDEX = 0x0609_0011, "the subindex does not exist";
    VALUE = 0x0609_0030, "the value is invalid";
    TOO_HIGH = 0x0609_0031, "the value is too high";
    TOO_LOW = 0x0609_0032, "the value is too low";
    MAX_BELOW_MIN = 0x0609_0036, "the maximum is below the minimum";
    NO_RESOURCE = 0x060A_0023, "a resource is not available";
    GENERAL = 0x0800_0000, "general error";
    NOT_STORED = 0x0800_0020, "the value cannot be taken over";
    LOCAL_CONTROL = 0x0800_0021, "the value cannot be taken over because of local control";
    DEVICE_STATE = 0x0800_0022, "the value cannot be taken over in the present state of the device";
    NO_DICTIONARY = 0x0800_0023, "there is no object dictionary";
    NO_DATA = 0x0800_0024, "there is no value";
}

impl Abort {
    /// What the standard says about it; "unknown abort code" for any other.
    #[must_use]
    pub fn text(self) -> &'static str {
        let known = Self::KNOWN.iter().find(|(code, _)| *code == self);
        known.map_or("unknown abort code", |(_, text)| text)
    }

    /// Whether it says that there is nothing at this place, as a node does that lacks an object.
    #[must_use]
    pub fn is_absence(self) -> bool {
        matches!(self, Self::NO_OBJECT | Self::NO_SUBINDEX)
    }
}

impl fmt::Display for Abort {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} ({:04X} {:04X})", self.text(), self.0 >> 16, self.0 & 0xFFFF)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn codes_are_told_with_their_number() {
        assert_eq!(Abort(0x0602_0000).to_string(), "the object does not exist (0602 0000)");
        assert_eq!(Abort(0x1234_5678).to_string(), "unknown abort code (1234 5678)");
    }

    #[test]
    fn each_code_stands_once() {
        for (index, (code, _)) in Abort::KNOWN.iter().enumerate() {
            assert!(Abort::KNOWN[index + 1..].iter().all(|(other, _)| other != code), "{code}");
        }
        assert_eq!(Abort::KNOWN.len(), 31);
    }
}
