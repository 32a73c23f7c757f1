//! Addresses as they are typed: one, several with commas between them, a range, or all that are found.

use std::fmt::Display;

use brushwork_link::family::{addresses_text, families};
use brushwork_link::unit::parse_number;
use brushwork_link::{Addresses, FamilyChoice};
use brushwork_values::parse_byte;

/// Which units of a line are meant.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum AddressList {
    /// One, named alone.
    One(u8),
    /// Several, in the order in which they were named, each once unless they are to be made. A list of one is one too.
    These(Vec<u8>),
    /// All that are found.
    All,
}

impl AddressList {
    /// The numbers that were named; none where all are meant.
    pub fn numbers(&self) -> &[u8] {
        match self {
            Self::One(number) => std::slice::from_ref(number),
            Self::These(numbers) => numbers,
            Self::All => &[],
        }
    }

    /// How a link looks for them.
    pub fn sought(&self) -> Addresses {
        match self {
            Self::One(number) => Addresses::Only(*number),
            Self::These(numbers) => Addresses::These(numbers.iter().copied().collect()),
            Self::All => Addresses::Scan,
        }
    }

    /// Whether one family has all of them, as a line can.
    pub fn is_of_one_family(&self) -> bool {
        families().iter().any(|family| self.numbers().iter().all(|number| family.has_address(*number)))
    }
}

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

/// What `--address` of controllers takes.
pub fn parse(text: &str) -> Result<AddressList, String> {
    read(text, parse_number, &addresses_text()).map(each_once)
}

/// What `--address` of a line takes, which may be a CAN bus.
pub fn parse_on_line(text: &str) -> Result<AddressList, String> {
    let number = |text: &str| {
        parse_number(text).or_else(|| parse_byte(text).filter(|number| (1..=0x87).contains(number)))
    };
    read(text, number, &format!("{}, CANopen node at 1 to 127", addresses_text())).map(each_once)
}

/// Who is named twice is meant once.
fn each_once(list: AddressList) -> AddressList {
    let AddressList::These(numbers) = list else { return list };
    let mut once: Vec<u8> = Vec::new();
    for number in numbers {
        if !once.contains(&number) {
            once.push(number);
        }
    }
    AddressList::These(once)
}

/// What `--address` of units that are made takes. One that is named twice stays so, which their family refuses.
pub fn parse_made(text: &str) -> Result<AddressList, String> {
    let number = |text: &str| parse_number(text).or_else(|| parse_byte(text));
    let list = read(text, number, &addresses_text())?;
    if list == AddressList::All {
        return Err("a unit that is made has an address: name it, or several as 0x80-0x84".to_owned());
    }
    Ok(list)
}

fn read(text: &str, number: fn(&str) -> Option<u8>, names: &impl Display) -> Result<AddressList, String> {
    let text = text.trim();
    if text.eq_ignore_ascii_case("all") {
        return Ok(AddressList::All);
    }
    let one = |text: &str| {
        number(text.trim()).ok_or_else(|| format!("\"{text}\" is no address: use that of {names}"))
    };
    if !text.contains([',', '-']) {
        return one(text).map(AddressList::One);
    }
    let mut numbers: Vec<u8> = Vec::new();
    for part in text.split(',') {
        let (first, last) = match part.split_once('-') {
            Some((first, last)) => (one(first)?, one(last)?),
            None => (one(part)?, one(part)?),
        };
        if first > last {
            return Err(format!("\"{part}\" is no range: the lower address comes first"));
        }
        for number in first..=last {
            one(&number.to_string())?;
            numbers.push(number);
        }
    }
    Ok(AddressList::These(numbers))
}

/// An address as its family writes it.
pub fn name(address: u8) -> String {
    let family = families().iter().find(|family| family.has_address(address));
    family.map_or_else(|| format!("0x{address:02X}"), |family| family.address_text(address))
}

/// Addresses with runs drawn together: "0x81, 0x83 to 0x87".
pub fn in_words(addresses: &[u8]) -> String {
    let runs = addresses.chunk_by(|left, right| left + 1 == *right);
    let words = runs.map(|run| match run {
        [first, .., last] if run.len() > 2 => format!("{} to {}", name(*first), name(*last)),
        run => run.iter().map(|address| name(*address)).collect::<Vec<_>>().join(", "),
    });
    words.collect::<Vec<_>>().join(", ")
}

#[cfg(test)]
mod tests {
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
