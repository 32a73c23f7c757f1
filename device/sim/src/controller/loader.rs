//! The firmware loader that command 255 enters: raw bytes instead of packets (public clients, 2015-2020).
//!
//! Host 0x01, device 0xAA; then the image in pages of 256 bytes, 0xAA after each; then 0x04, upon which the unit restarts. The
//! image goes nowhere: the firmware of a simulated controller does not change.

/// What the device answers to the greeting and to each page.
const READY: u8 = 0xaa;
const GREETING: u8 = 0x01;
const RESET: u8 = 0x04;
const PAGE_BYTES: usize = 256;

/// Bytes of a firmware image of an MCP.
pub const MCP_IMAGE_BYTES: usize = 0xf_0000;
/// Bytes of a firmware image of a RoboClaw.
pub const ROBOCLAW_IMAGE_BYTES: usize = 0x1_0000;

/// The loader at work.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Loader {
    image_bytes: usize,
    received: Option<usize>,
}

/// What one byte leads to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LoaderStep {
    /// Nothing to say.
    Wait,
    /// This byte goes back.
    Answer(u8),
    /// The unit restarts.
    Restart,
}

impl Loader {
    /// A loader that waits for the greeting.
    pub fn new(image_bytes: usize) -> Self {
        Self { image_bytes, received: None }
    }

    /// Takes one byte.
    pub fn feed(&mut self, byte: u8) -> LoaderStep {
        match self.received {
            None if byte == GREETING => {
                self.received = Some(0);
                LoaderStep::Answer(READY)
            }
            None => LoaderStep::Wait,
            Some(count) if count < self.image_bytes => {
                self.received = Some(count + 1);
                if (count + 1).is_multiple_of(PAGE_BYTES) {
                    LoaderStep::Answer(READY)
                } else {
                    LoaderStep::Wait
                }
            }
            Some(_) if byte == RESET => LoaderStep::Restart,
            Some(_) => LoaderStep::Wait,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_update_is_a_greeting_pages_and_a_reset() {
        let mut loader = Loader::new(512);
        assert_eq!(loader.feed(0x80), LoaderStep::Wait);
        assert_eq!(loader.feed(GREETING), LoaderStep::Answer(0xaa));
        let answers: Vec<_> = (0..512).map(|_| loader.feed(RESET)).collect();
        assert_eq!(answers.iter().filter(|step| **step == LoaderStep::Answer(0xaa)).count(), 2);
        assert_eq!((answers[255], answers[511]), (LoaderStep::Answer(0xaa), LoaderStep::Answer(0xaa)));
        assert_eq!(loader.feed(0x55), LoaderStep::Wait);
        assert_eq!(loader.feed(RESET), LoaderStep::Restart);
    }
}
