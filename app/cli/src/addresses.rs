//! The controllers of a line that a command is meant for.

use brushwork_core::addresses::AddressList;
use brushwork_link::{Addresses, FamilyChoice};

/// A line, and which of its controllers are meant; none is all that it has.
#[derive(Clone, Copy)]
pub struct Line<'a> {
    /// As it was typed.
    pub connect: &'a str,
    /// The addresses.
    pub address: Option<&'a AddressList>,
    /// Which family to look for.
    pub family: FamilyChoice,
}

impl Line<'_> {
    /// How its controllers are looked for.
    pub fn sought(&self) -> Addresses {
        self.address.map_or(Addresses::Scan, AddressList::sought)
    }

    /// The numbers that were named.
    pub fn numbers(&self) -> &[u8] {
        self.address.map_or(&[], AddressList::numbers)
    }
}

#[cfg(test)]
mod tests {
    use brushwork_link::family::addresses_text;

    use brushwork_core::addresses::{in_words, parse, parse_on_line};

    use super::*;

    fn families_are_known() {
        brushwork_link::install(&[
            &brushwork_mcp_client::McpDriver,
            &brushwork_motion_mind_client::MotionMindDriver,
        ]);
    }

    #[test]
    fn one_address_is_one_and_whatever_lists_them_is_a_list() {
        families_are_known();
        let these = |numbers: &[u8]| Ok(AddressList::These(numbers.to_vec()));
        assert_eq!(parse("0x80"), Ok(AddressList::One(0x80)));
        assert_eq!(parse("0x80,"), Err("\"\" is no address: use that of ".to_owned() + &addresses_text()));
        assert_eq!(parse("0x80,0x81, 0x84"), these(&[0x80, 0x81, 0x84]));
        assert_eq!(parse("0x80-0x84"), these(&[0x80, 0x81, 0x82, 0x83, 0x84]));
        assert_eq!(parse("128-129,0x84,0x81"), these(&[0x80, 0x81, 0x84]));
        assert_eq!(parse("0x81-0x81"), these(&[0x81]));
        assert_eq!(parse("3,1-2"), these(&[3, 1, 2]));
        assert_eq!(parse("ALL"), Ok(AddressList::All));
    }

    #[test]
    fn what_no_unit_can_have_is_refused_also_in_the_midst_of_a_range() {
        families_are_known();
        for text in ["0x88", "0x80-0x88", "97-0x80", "0x84-0x80", "-", "0x80-", "some"] {
            assert!(parse(text).is_err(), "{text}");
        }
        assert_eq!(parse_on_line("99-101").map(|list| list.numbers().len()), Ok(3), "nodes of a CAN bus");
    }

    #[test]
    fn runs_of_addresses_are_drawn_together() {
        families_are_known();
        assert_eq!(in_words(&[0x80]), "0x80");
        assert_eq!(in_words(&[0x80, 0x82, 0x83]), "0x80, 0x82, 0x83");
        assert_eq!(in_words(&[0x81, 0x83, 0x84, 0x85, 0x87]), "0x81, 0x83 to 0x85, 0x87");
        assert_eq!(in_words(&[3, 7]), "3, 7");
    }
}
