//! Addresses as they are typed: one, several with commas between them, a range, or all that are found.

use std::fmt::Display;

use brushwork_link::Addresses;
use brushwork_link::family::{addresses_text, families};
use brushwork_link::unit::parse_number;
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

/// Addresses of controllers, each of them once.
///
/// # Errors
/// A sentence: what of it is no address.
pub fn parse(text: &str) -> Result<AddressList, String> {
    read(text, parse_number, &addresses_text()).map(each_once)
}

/// Addresses on a line, which may be a CAN bus.
///
/// # Errors
/// As for [`parse`].
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

/// Addresses of units that are made, or are to have them. One that is named twice stays so, which their family refuses.
///
/// # Errors
/// As for [`parse`].
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
