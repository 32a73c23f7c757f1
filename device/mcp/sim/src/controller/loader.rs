//! The firmware loader that command 255 enters, and the flash memory it fills. The codec is `brushwork_mcp_wire::loader`.
//!
//! A unit whose power fails while it erases is dead for good (MCP manual 1.3.2). One whose transfer broke later has no firmware
//! and waits for it in the loader, after each power-up again (MCP manual 1.6.3, "waiting for new firmware").
//!
//! Assumed: that the loader erases everything when it is greeted, the times of erase and page, that it waits for the rest of a
//! page for ever, that it takes the size that is published first for its family, and that it checks nothing of the image.

use brushwork_mcp_wire::loader::{GREETING, PAGE_BYTES, READY, RESET, SimulatedImage, image_sizes};
use brushwork_mcp_wire::models::Family;
use std::time::Duration;

/// Time the erase takes. Assumed; clients wait up to 10 s for its end.
pub const ERASE_TIME: Duration = Duration::from_secs(3);
/// Time to write a page. Assumed.
pub const PAGE_WRITE_TIME: Duration = Duration::from_millis(2);

/// What the flash memory holds. It survives a power cycle.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub enum Flash {
    /// The firmware that the unit left the factory with.
    #[default]
    Factory,
    /// An image that was sent over.
    Image(Vec<u8>),
    /// It is being erased until this moment.
    Erasing {
        /// When the erase is done.
        until: Duration,
    },
    /// It is erased, and pages are being written: what has arrived so far.
    Filling(Vec<u8>),
    /// The power failed during an erase: nothing runs on this unit any more.
    Dead,
}

impl Flash {
    /// The power fails at `now`.
    pub fn cut_power(&mut self, now: Duration) {
        *self = match std::mem::take(self) {
            Self::Erasing { until } if now < until => Self::Dead,
            Self::Erasing { .. } | Self::Filling(_) => Self::Filling(Vec::new()),
            kept @ (Self::Factory | Self::Image(_) | Self::Dead) => kept,
        };
    }

    /// Whether there is firmware to run.
    pub fn is_whole(&self) -> bool {
        matches!(self, Self::Factory | Self::Image(_))
    }

    /// What the unit has become by an image that was made for simulated controllers.
    pub fn installed(&self) -> Option<SimulatedImage> {
        match self {
            Self::Image(bytes) => SimulatedImage::read(bytes),
            Self::Factory | Self::Erasing { .. } | Self::Filling(_) | Self::Dead => None,
        }
    }
}

/// The loader at work.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Loader {
    image_bytes: usize,
    greeted: bool,
}

/// What one byte leads to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LoaderStep {
    /// Nothing to say.
    Wait,
    /// This byte goes back after this time.
    Answer {
        /// The byte.
        byte: u8,
        /// How long the work takes.
        after: Duration,
    },
    /// The unit restarts.
    Restart,
}

impl Loader {
    /// A loader that waits for the greeting.
    pub fn new(family: Family) -> Self {
        Self { image_bytes: image_sizes(family).first().copied().unwrap_or_default(), greeted: false }
    }

    /// Takes one byte at `now`.
    pub fn feed(&mut self, byte: u8, now: Duration, flash: &mut Flash) -> LoaderStep {
        if !self.greeted {
            return if byte == GREETING { self.erase(now, flash) } else { LoaderStep::Wait };
        }
        match flash {
            Flash::Erasing { until } if now < *until => LoaderStep::Wait,
            Flash::Erasing { .. } => {
                *flash = Flash::Filling(Vec::with_capacity(self.image_bytes));
                self.feed(byte, now, flash)
            }
            Flash::Filling(bytes) => {
                bytes.push(byte);
                if !bytes.len().is_multiple_of(PAGE_BYTES) {
                    return LoaderStep::Wait;
                }
                if bytes.len() >= self.image_bytes {
                    *flash = Flash::Image(std::mem::take(bytes));
                }
                LoaderStep::Answer { byte: READY, after: PAGE_WRITE_TIME }
            }
            Flash::Factory | Flash::Image(_) if byte == RESET => LoaderStep::Restart,
            Flash::Factory | Flash::Image(_) | Flash::Dead => LoaderStep::Wait,
        }
    }

    fn erase(&mut self, now: Duration, flash: &mut Flash) -> LoaderStep {
        self.greeted = true;
        *flash = Flash::Erasing { until: now + ERASE_TIME };
        LoaderStep::Answer { byte: READY, after: ERASE_TIME }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const LATER: Duration = Duration::from_secs(60);
    const ERASED: LoaderStep = LoaderStep::Answer { byte: 0xaa, after: ERASE_TIME };
    const WRITTEN: LoaderStep = LoaderStep::Answer { byte: 0xaa, after: PAGE_WRITE_TIME };

    fn send(loader: &mut Loader, flash: &mut Flash, bytes: &[u8]) -> Vec<LoaderStep> {
        bytes.iter().map(|byte| loader.feed(*byte, LATER, flash)).collect()
    }

    #[test]
    fn an_update_is_a_greeting_pages_and_a_reset() {
        let (mut loader, mut flash) = (Loader::new(Family::RoboClaw), Flash::default());
        assert_eq!(loader.feed(0x80, Duration::ZERO, &mut flash), LoaderStep::Wait);
        assert_eq!(loader.feed(GREETING, Duration::ZERO, &mut flash), ERASED);
        let steps = send(&mut loader, &mut flash, &[RESET; 0x8000]);
        assert_eq!(steps.iter().filter(|step| **step == WRITTEN).count(), 128);
        assert_eq!((steps[255], steps[0x7fff]), (WRITTEN, WRITTEN));
        assert_eq!(flash, Flash::Image(vec![RESET; 0x8000]));
        assert_eq!(loader.feed(0x55, LATER, &mut flash), LoaderStep::Wait);
        assert_eq!(loader.feed(RESET, LATER, &mut flash), LoaderStep::Restart);
    }

    #[test]
    fn bytes_during_the_erase_are_lost() {
        let (mut loader, mut flash) = (Loader::new(Family::RoboClaw), Flash::default());
        loader.feed(GREETING, Duration::ZERO, &mut flash);
        let early = Duration::from_secs(1);
        assert_eq!(loader.feed(1, early, &mut flash), LoaderStep::Wait);
        let steps = send(&mut loader, &mut flash, &[1; PAGE_BYTES]);
        assert_eq!(steps.iter().position(|step| *step == WRITTEN), Some(PAGE_BYTES - 1));
    }

    #[test]
    fn only_a_power_failure_during_the_erase_kills() {
        let after = |flash: &Flash, at| {
            let mut flash = flash.clone();
            flash.cut_power(at);
            flash
        };
        let erasing = Flash::Erasing { until: ERASE_TIME };
        assert_eq!(after(&erasing, Duration::from_millis(2999)), Flash::Dead);
        assert_eq!(after(&erasing, ERASE_TIME), Flash::Filling(Vec::new()));
        assert_eq!(after(&Flash::Filling(vec![1; 300]), LATER), Flash::Filling(Vec::new()));
        assert_eq!(after(&Flash::Image(vec![1]), LATER), Flash::Image(vec![1]));
        assert_eq!(after(&Flash::Factory, LATER), Flash::Factory);
        assert_eq!(after(&Flash::Dead, LATER), Flash::Dead);
    }
}
