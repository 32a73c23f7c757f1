//! Bytes, varints and names of an image.

use super::error::ImageError;

#[derive(Debug, Default)]
pub struct Writer {
    bytes: Vec<u8>,
}

impl Writer {
    pub fn byte(&mut self, byte: u8) {
        self.bytes.push(byte);
    }

    pub fn bytes(&mut self, bytes: &[u8]) {
        self.bytes.extend_from_slice(bytes);
    }

    pub fn varint(&mut self, mut value: u32) {
        while value >= 0x80 {
            self.bytes.push(value as u8 | 0x80);
            value >>= 7;
        }
        self.bytes.push(value as u8);
    }

    pub fn count(&mut self, count: usize) {
        self.varint(u32::try_from(count).unwrap_or(u32::MAX));
    }

    pub fn name(&mut self, name: &str) {
        self.count(name.len());
        self.bytes(name.as_bytes());
    }

    pub fn done(self) -> Vec<u8> {
        self.bytes
    }
}

#[derive(Debug)]
pub struct Reader<'a> {
    bytes: &'a [u8],
}

impl<'a> Reader<'a> {
    pub fn new(bytes: &'a [u8]) -> Self {
        Self { bytes }
    }

    pub fn byte(&mut self) -> Result<u8, ImageError> {
        self.bytes(1).map(|bytes| bytes[0])
    }

    pub fn bytes(&mut self, count: usize) -> Result<&'a [u8], ImageError> {
        let (here, rest) =
            self.bytes.split_at_checked(count).ok_or(ImageError::Malformed("it ends too early"))?;
        self.bytes = rest;
        Ok(here)
    }

    pub fn flag(&mut self) -> Result<bool, ImageError> {
        match self.byte()? {
            0 => Ok(false),
            1 => Ok(true),
            _ => Err(ImageError::Malformed("a flag that is neither 0 nor 1")),
        }
    }

    /// Only the shortest form of a number is taken, so that a program has one image.
    pub fn varint(&mut self) -> Result<u32, ImageError> {
        let mut value = 0u64;
        for shift in (0..35).step_by(7) {
            let byte = self.byte()?;
            value |= u64::from(byte & 0x7F) << shift;
            if byte & 0x80 == 0 {
                let shortest = byte != 0 || shift == 0;
                let fits = u32::try_from(value).ok().filter(|_| shortest);
                return fits.ok_or(ImageError::Malformed("a number in a wrong form"));
            }
        }
        Err(ImageError::Malformed("a number that is too long"))
    }

    pub fn at_most(&mut self, most: u32, what: &'static str) -> Result<u32, ImageError> {
        self.varint()
            .and_then(|value| if value <= most { Ok(value) } else { Err(ImageError::Malformed(what)) })
    }

    pub fn count(&mut self, most: usize, what: &'static str) -> Result<usize, ImageError> {
        let most = u32::try_from(most).unwrap_or(u32::MAX);
        self.at_most(most, what).map(|count| count as usize)
    }

    pub fn name(&mut self) -> Result<String, ImageError> {
        let count = self.count(crate::mcl::lexer::LONGEST_NAME, "a name that is too long")?;
        let name = std::str::from_utf8(self.bytes(count)?);
        name.map(str::to_owned).map_err(|_| ImageError::Malformed("a name that is no text"))
    }
}
