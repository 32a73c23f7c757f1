//! The EEPROM: settings rows that are written one after the other, and 256 bytes of user memory.

use super::Image;
use std::collections::VecDeque;
use std::time::Duration;

/// Bytes that are written at once. Assumed: a common EEPROM page.
pub const ROW_BYTES: usize = 32;

/// Time to write one row. Assumed: 3 ms, a common page write time.
pub const ROW_WRITE_TIME: Duration = Duration::from_millis(3);

/// Words of user memory behind commands 252 and 253: 256 bytes (MCP manual, command 252).
pub const USER_WORDS: usize = 128;

type Row = [u8; ROW_BYTES];

/// Non-volatile memory: keeps its content without power, and half of a save when the power fails in the middle.
#[derive(Clone, Debug)]
pub struct Eeprom {
    rows: Vec<Row>,
    pending: VecDeque<(usize, Row)>,
    next_row_at: Duration,
    user: [u16; USER_WORDS],
    row_writes: u64,
    saves: u64,
}

impl Eeprom {
    /// A memory that already holds `image`, as a unit leaves the factory.
    pub fn holding(image: &Image) -> Self {
        Self {
            rows: rows_of(image),
            pending: VecDeque::new(),
            next_row_at: Duration::ZERO,
            user: [0; USER_WORDS],
            row_writes: 0,
            saves: 0,
        }
    }

    /// Starts to write `image`; a save that is still running is replaced. Every row is written, changed or not.
    pub fn begin_save(&mut self, image: &Image, now: Duration) {
        self.pending = rows_of(image).into_iter().enumerate().collect();
        self.next_row_at = now + ROW_WRITE_TIME;
        self.saves += 1;
    }

    /// Completes the rows whose time has come.
    pub fn advance(&mut self, now: Duration) {
        while !self.pending.is_empty() && self.next_row_at <= now {
            if let Some((index, row)) = self.pending.pop_front() {
                self.store(index, row);
            }
            self.next_row_at += ROW_WRITE_TIME;
        }
    }

    /// The power fails: rows not yet written are lost.
    pub fn cut_power(&mut self) {
        self.pending.clear();
    }

    /// Whether a save is under way.
    pub fn is_saving(&self) -> bool {
        !self.pending.is_empty()
    }

    /// What is stored now.
    pub fn image(&self) -> Image {
        Image(self.rows.concat())
    }

    /// Rows written since the unit was made.
    pub fn row_writes(&self) -> u64 {
        self.row_writes
    }

    /// Saves begun since the unit was made.
    pub fn saves(&self) -> u64 {
        self.saves
    }

    /// User word at a byte-sized address. Assumed: the address counts words and wraps at 128.
    pub fn user_word(&self, address: u8) -> u16 {
        self.user[usize::from(address) % USER_WORDS]
    }

    /// Sets the user word at that address.
    pub fn set_user_word(&mut self, address: u8, value: u16) {
        self.user[usize::from(address) % USER_WORDS] = value;
        self.row_writes += 1;
    }

    /// A byte of the user memory, as scripts count them. Assumed: byte 2n is the low byte of word n, since the processor stores that one
    /// first, and addresses wrap at 256, the size that the manual gives (MCP manual 3.4.1 against commands 252 and 253, whose byte
    /// sized address counts words here).
    pub fn user_byte(&self, address: u32) -> u8 {
        self.user_word((address / 2) as u8).to_le_bytes()[(address % 2) as usize]
    }

    /// Sets a byte of the user memory.
    pub fn set_user_byte(&mut self, address: u32, value: u8) {
        let word = (address / 2) as u8;
        let mut bytes = self.user_word(word).to_le_bytes();
        bytes[(address % 2) as usize] = value;
        self.set_user_word(word, u16::from_le_bytes(bytes));
    }

    fn store(&mut self, index: usize, row: Row) {
        if index >= self.rows.len() {
            self.rows.resize(index + 1, [0xff; ROW_BYTES]);
        }
        self.rows[index] = row;
        self.row_writes += 1;
    }
}

fn rows_of(image: &Image) -> Vec<Row> {
    image
        .0
        .chunks(ROW_BYTES)
        .map(|chunk| {
            let mut row = [0xff; ROW_BYTES];
            row[..chunk.len()].copy_from_slice(chunk);
            row
        })
        .collect()
}
