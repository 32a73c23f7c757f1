//! The host's side of a transfer: what to send next, and what an answer means.

use super::image::Image;
use super::protocol::{GREETING, READY, RESET};

/// Where a transfer stands.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Stage {
    /// The greeting is to be sent, upon which the device erases its memory. Nothing has been erased yet.
    Greeting,
    /// This page is to be sent, counted from 0.
    Page(usize),
    /// All pages are there; the reset is to be sent. It is not answered.
    Reset,
}

/// What a byte from the device means.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Advance {
    /// What was sent is done; the next stage begins.
    Done,
    /// It answers nothing: while the device starts, other bytes may be on their way.
    Passed,
    /// Something else than the answer that is due. The two ends may be out of step.
    Unexpected(u8),
}

/// A transfer of an image.
#[derive(Clone, Debug)]
pub struct Transfer<'i> {
    image: &'i Image,
    stage: Stage,
}

impl<'i> Transfer<'i> {
    /// A transfer that has not begun.
    #[must_use]
    pub fn new(image: &'i Image) -> Self {
        Self { image, stage: Stage::Greeting }
    }

    /// Where it stands.
    #[must_use]
    pub fn stage(&self) -> Stage {
        self.stage
    }

    /// The bytes to send at this stage, once and never again.
    #[must_use]
    pub fn bytes(&self) -> &[u8] {
        match self.stage {
            Stage::Greeting => &[GREETING],
            Stage::Page(number) => self.image.page(number),
            Stage::Reset => &[RESET],
        }
    }

    /// Takes one byte that came after the bytes of this stage.
    pub fn take(&mut self, byte: u8) -> Advance {
        match (self.stage, byte) {
            (Stage::Greeting, READY) => self.go_to_page(0),
            (Stage::Page(number), READY) => self.go_to_page(number + 1),
            (Stage::Greeting | Stage::Reset, _) => Advance::Passed,
            (Stage::Page(_), other) => Advance::Unexpected(other),
        }
    }

    fn go_to_page(&mut self, number: usize) -> Advance {
        self.stage = if number < self.image.page_count() { Stage::Page(number) } else { Stage::Reset };
        Advance::Done
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::loader::PAGE_BYTES;
    use crate::models::Family;

    fn image() -> Image {
        Image::new((0..0x8000_usize).map(|at| (at / PAGE_BYTES) as u8).collect(), Family::RoboClaw).unwrap()
    }

    #[test]
    fn a_transfer_is_a_greeting_the_pages_and_a_reset() {
        let image = image();
        let mut transfer = Transfer::new(&image);
        assert_eq!((transfer.stage(), transfer.bytes()), (Stage::Greeting, &[0x01][..])); // 01: greeting
        assert_eq!(transfer.take(0xFF), Advance::Passed); // FF: the late acknowledgement of command 255
        assert_eq!(transfer.take(0xAA), Advance::Done); // AA: erased
        for page in 0..128 {
            assert_eq!(transfer.stage(), Stage::Page(page));
            assert_eq!(transfer.bytes(), [page as u8; 256]);
            assert_eq!(transfer.take(0xAA), Advance::Done); // AA: page written
        }
        assert_eq!((transfer.stage(), transfer.bytes()), (Stage::Reset, &[0x04][..])); // 04: restart
        assert_eq!(transfer.take(0xAA), Advance::Passed);
        assert_eq!(transfer.stage(), Stage::Reset);
    }

    #[test]
    fn another_answer_to_a_page_than_the_one_due_is_told_and_moves_nothing() {
        let image = image();
        let mut transfer = Transfer::new(&image);
        transfer.take(0xAA);
        for byte in (0..=u8::MAX).filter(|byte| *byte != 0xAA) {
            assert_eq!(transfer.take(byte), Advance::Unexpected(byte));
            assert_eq!(transfer.stage(), Stage::Page(0));
        }
    }
}
