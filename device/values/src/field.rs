//! One field of a packet: its name, how it lies on the wire, and what its number means.

use serde::Serialize;

use crate::code::Code;

/// One field of a request or of a reply.
#[derive(Debug, Clone, Copy)]
pub struct Field {
    /// Name in snake_case, unique in its layout: "duty", or "duty_m1" and "duty_m2" where a command has both.
    pub name: &'static str,
    /// What the traffic decoder and the reference page call it.
    pub label: &'static str,
    /// How it lies on the wire.
    pub kind: Kind,
    /// The unit of the physical value, `raw * scale`.
    pub unit: Unit,
    /// Physical value of one raw count; 1 for plain numbers.
    pub scale: f64,
    /// Decimals that a physical value is shown with.
    pub decimals: u8,
    /// The raw range the manual gives, both ends included; `None` if it gives none. Not enforced by the codec: how a
    /// controller takes a value beyond it is the controller's business.
    pub raw_range: Option<(i64, i64)>,
    /// The named values of a coded field; empty for a plain number.
    pub codes: &'static [Code],
    /// The constant that the field always carries: a key, or the second stop bytes of the loader.
    pub fixed: Option<i64>,
    /// Where the decoder shows it: lower first, equal ones in wire order. PID gains lie D, P, I on the wire and are
    /// read P, I, D.
    pub rank: u8,
    /// What it means.
    pub doc: &'static str,
}

/// How a field lies on the wire. Numbers are big-endian.
#[derive(Debug, Clone, Copy)]
pub enum Kind {
    /// One byte, 0 to 255.
    U8,
    /// One byte, -128 to 127.
    I8,
    /// Two bytes, unsigned.
    U16,
    /// Two bytes, two's complement.
    I16,
    /// Three bytes, unsigned.
    U24,
    /// Four bytes, unsigned.
    U32,
    /// Four bytes, two's complement.
    I32,
    /// Text ended by 0x0A 0x00, at most `max` bytes with both (reply to command 21).
    Text {
        /// The longest run on the wire, end included.
        max: usize,
    },
    /// A length byte, then always 36 bytes of ASCII, the rest zero (commands 96 and 97 from generation 4).
    Ascii36,
    /// A length byte that counts bytes, then always 36 bytes of UTF-16, low byte first (96 and 97 in generation 3).
    Utf16Le36,
    /// That many bytes as they are.
    Bytes(usize),
    /// A count byte, then that many records of the same fields, all of them numbers.
    Counted(&'static [Field]),
}

/// The unit of a physical value.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Unit {
    /// A plain number, a code or a set of bits.
    None,
    /// A set of bits, shown in hexadecimal.
    Bits,
    /// The bits of a status register, whose meaning depends on the generation.
    Status,
    /// A controller gain.
    Gain,
    /// Percent.
    Percent,
    /// Percent of full duty per second.
    PercentPerSecond,
    /// Encoder counts.
    Counts,
    /// Encoder counts per second.
    CountsPerSecond,
    /// Encoder counts per second per second.
    CountsPerSecondSquared,
    /// Volts.
    Volts,
    /// Amperes.
    Amps,
    /// Degrees Celsius.
    Celsius,
    /// Seconds.
    Seconds,
    /// Milliseconds.
    Milliseconds,
    /// Henries.
    Henries,
    /// Ohms.
    Ohms,
    /// Bits per second.
    BitsPerSecond,
}

impl Field {
    /// A plain number named `name`.
    pub const fn new(name: &'static str, kind: Kind, doc: &'static str) -> Self {
        Self {
            name,
            label: "",
            kind,
            unit: Unit::None,
            scale: 1.0,
            decimals: 0,
            raw_range: None,
            codes: &[],
            fixed: None,
            rank: 10,
            doc,
        }
    }

    /// The same with a unit whose raw number is the physical one.
    #[must_use]
    pub const fn unit(mut self, unit: Unit) -> Self {
        self.unit = unit;
        self
    }

    /// The same with a unit, the physical value of one raw count and the decimals that are shown.
    #[must_use]
    pub const fn scaled(mut self, unit: Unit, scale: f64, decimals: u8) -> Self {
        self.unit = unit;
        self.scale = scale;
        self.decimals = decimals;
        self
    }

    /// The same with the raw range that the manual gives, both ends included.
    #[must_use]
    pub const fn range(mut self, low: i64, high: i64) -> Self {
        self.raw_range = Some((low, high));
        self
    }

    /// The same with the name that people see.
    #[must_use]
    pub const fn label(mut self, label: &'static str) -> Self {
        self.label = label;
        self
    }

    /// The same with its named values.
    #[must_use]
    pub const fn codes(mut self, codes: &'static [Code]) -> Self {
        self.codes = codes;
        self
    }

    /// The same as a constant that the field always carries.
    #[must_use]
    pub const fn fixed(mut self, value: i64) -> Self {
        self.fixed = Some(value);
        self
    }

    /// The same with its place in what is shown, lower first.
    #[must_use]
    pub const fn rank(mut self, rank: u8) -> Self {
        self.rank = rank;
        self
    }

    /// Whether the sources give a meaning to a raw number: it is the field's constant, lies in its range and, where values are
    /// named, is one of them.
    pub fn allows(&self, raw: i64) -> bool {
        self.fixed.is_none_or(|fixed| raw == fixed)
            && self.raw_range.is_none_or(|(low, high)| (low..=high).contains(&raw))
            && (self.codes.is_empty() || self.codes.iter().any(|code| code.raw == raw))
    }

    /// The physical value of a raw one, in [`Field::unit`](field@Field::unit).
    pub fn physical(&self, raw: i64) -> f64 {
        raw as f64 * self.scale
    }

    /// The nearest raw value of a physical one, kept within what the field can carry. Not a number gives 0.
    pub fn raw(&self, physical: f64) -> i64 {
        let raw = (physical / self.scale).round() as i64;
        self.kind.limits().map_or(raw, |(low, high)| raw.clamp(low, high))
    }
}

impl Kind {
    /// The least and greatest raw number; `None` for what is no number.
    pub const fn limits(&self) -> Option<(i64, i64)> {
        match self {
            Self::U8 => Some((0, 0xFF)),
            Self::I8 => Some((-0x80, 0x7F)),
            Self::U16 => Some((0, 0xFFFF)),
            Self::I16 => Some((-0x8000, 0x7FFF)),
            Self::U24 => Some((0, 0xFF_FFFF)),
            Self::U32 => Some((0, 0xFFFF_FFFF)),
            Self::I32 => Some((-0x8000_0000, 0x7FFF_FFFF)),
            Self::Text { .. } | Self::Ascii36 | Self::Utf16Le36 | Self::Bytes(_) | Self::Counted(_) => None,
        }
    }

    /// Bytes on the wire; `None` if that depends on the content.
    pub const fn width(&self) -> Option<usize> {
        match self {
            Self::U8 | Self::I8 => Some(1),
            Self::U16 | Self::I16 => Some(2),
            Self::U24 => Some(3),
            Self::U32 | Self::I32 => Some(4),
            Self::Ascii36 | Self::Utf16Le36 => Some(1 + SERIAL_BYTES),
            Self::Bytes(count) => Some(*count),
            Self::Text { .. } | Self::Counted(_) => None,
        }
    }

    /// Whether it is a number with a sign.
    pub const fn is_signed(&self) -> bool {
        matches!(self, Self::I8 | Self::I16 | Self::I32)
    }
}

/// Bytes of a serial number on the wire, without its length byte.
pub const SERIAL_BYTES: usize = 36;

impl Unit {
    /// The symbol behind a number; empty for plain numbers, gains and bits.
    pub const fn symbol(self) -> &'static str {
        match self {
            Self::None | Self::Bits | Self::Status | Self::Gain => "",
            Self::Percent => "%",
            Self::PercentPerSecond => "%/s",
            Self::Counts => "counts",
            Self::CountsPerSecond => "counts/s",
            Self::CountsPerSecondSquared => "counts/s²",
            Self::Volts => "V",
            Self::Amps => "A",
            Self::Celsius => "°C",
            Self::Seconds => "s",
            Self::Milliseconds => "ms",
            Self::Henries => "H",
            Self::Ohms => "Ω",
            Self::BitsPerSecond => "bit/s",
        }
    }
}

/// Bytes of a run of fields; `None` if that depends on the content.
pub const fn width_of(fields: &[Field]) -> Option<usize> {
    let mut total = 0;
    let mut index = 0;
    while index < fields.len() {
        match fields[index].kind.width() {
            Some(width) => total += width,
            None => return None,
        }
        index += 1;
    }
    Some(total)
}
