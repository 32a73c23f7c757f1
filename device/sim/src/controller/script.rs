//! The script memory behind commands 246 to 251: it takes and keeps an image. Running it does nothing yet.
//!
//! Assumed: erase and write times, the size of the memory, and status 0xFF for "done" and 0 for "not done" (the meaning of the
//! second byte is not public; the libraries of 2015 and 2020 only wait for it).

use std::time::Duration;

/// Time an erase takes; libraries wait 2 to 5 s for it.
pub const ERASE_TIME: Duration = Duration::from_millis(1500);
/// Time to write one block.
pub const BLOCK_WRITE_TIME: Duration = Duration::from_millis(2);
/// Bytes of the memory.
pub const MEMORY_BYTES: usize = 0x1_0000;
/// Autorun delays below this switch autorun off (MCP manual, command 246).
pub const MIN_AUTORUN_MS: u32 = 100;

/// Second byte of the answers to 250 and 251.
pub const STATUS_DONE: u8 = 0xff;
/// Second byte when the block lies outside the memory.
pub const STATUS_NOT_DONE: u8 = 0;

const ERASED: u8 = 0xff;

/// What the flash memory holds. It survives a power cycle.
#[derive(Clone, Debug, Default)]
pub struct ScriptMemory {
    bytes: Vec<u8>,
}

impl ScriptMemory {
    /// Erases everything.
    pub fn erase(&mut self) {
        self.bytes.clear();
    }

    /// Stores one block as it came over the wire and says whether it lies in the memory.
    pub fn write(&mut self, address: usize, block: &[u8]) -> bool {
        let Some(end) = address.checked_add(block.len()).filter(|end| *end <= MEMORY_BYTES) else {
            return false;
        };
        if self.bytes.len() < end {
            self.bytes.resize(end, ERASED);
        }
        self.bytes[address..end].copy_from_slice(block);
        true
    }

    /// Whether an image is stored.
    pub fn holds_image(&self) -> bool {
        !self.bytes.is_empty()
    }

    /// The image as far as it was written.
    pub fn image(&self) -> &[u8] {
        &self.bytes
    }
}

/// The script's state in RAM.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct ScriptState {
    running: bool,
    autorun_done: bool,
}

impl ScriptState {
    /// Whether a script runs.
    pub fn is_running(self) -> bool {
        self.running
    }

    /// Starts the stored image, if there is one.
    pub fn start(&mut self, memory: &ScriptMemory) {
        self.running = memory.holds_image();
    }

    /// Stops the script; it does not start by itself any more until the next power up.
    pub fn stop(&mut self) {
        self.running = false;
        self.autorun_done = true;
    }

    /// Starts the image once, when the autorun delay after power up has passed.
    pub fn autorun(&mut self, delay_ms: u32, up_for: Duration, memory: &ScriptMemory) {
        let due = up_for >= Duration::from_millis(delay_ms.into());
        if !self.autorun_done && delay_ms >= MIN_AUTORUN_MS && due {
            self.autorun_done = true;
            self.start(memory);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn blocks_are_kept_where_they_were_written_until_an_erase() {
        let mut memory = ScriptMemory::default();
        assert!(memory.write(16, &[7; 16]));
        assert_eq!(memory.image()[..16], [0xff; 16]);
        assert_eq!(memory.image()[16..], [7; 16]);
        assert!(!memory.write(MEMORY_BYTES - 15, &[1; 16]));
        assert!(!memory.write(usize::MAX, &[1; 16]));
        memory.erase();
        assert!(!memory.holds_image());
    }

    #[test]
    fn a_script_autoruns_once_after_its_delay_and_not_below_100_ms() {
        let mut memory = ScriptMemory::default();
        let mut state = ScriptState::default();
        let ms = Duration::from_millis;
        state.autorun(200, ms(300), &memory);
        assert!(!state.is_running(), "there is nothing to run");
        memory.write(0, &[1; 16]);
        state = ScriptState::default();
        state.autorun(99, ms(1000), &memory);
        state.autorun(200, ms(199), &memory);
        assert!(!state.is_running());
        state.autorun(200, ms(200), &memory);
        assert!(state.is_running());
        state.stop();
        state.autorun(200, ms(400), &memory);
        assert!(!state.is_running());
    }
}
