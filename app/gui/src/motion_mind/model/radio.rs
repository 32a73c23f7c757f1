//! The R/C calibration assistant (Motion Mind manual 4.3): the stick in the middle, forward, back; what RCMAX and RCMIN come to.

use crate::messages::RadioMessage;
/// Steps of RCCOUNT in 1.5 ms.
const MIDDLE: i64 = 864;
/// The middle should be so near to 1.5 ms before the ends are taken (manual, step 1).
const MIDDLE_TOLERANCE: i64 = 12;
/// Ends nearer to the middle than this are no full stick.
const LEAST_THROW: i64 = 60;
/// In the position sub-mode the ends lie this far inside what was measured, so that the full scale is reached.
const INSIDE: i64 = 4;
/// Widest ends that the manual proposes for measuring: 0.75 ms and 2.25 ms.
pub const WIDE: (i64, i64) = (432, 1296);

/// Where the stick is to be.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd)]
pub enum Stage {
    #[default]
    Idle,
    Middle,
    Forward,
    Backward,
    Done,
}

/// The state of the assistant. All values are raw RCCOUNT.
#[derive(Debug, Default)]
pub struct Radio {
    pub stage: Stage,
    middle: Option<i64>,
    /// Least and greatest pulse while the stick was in the middle.
    jitter: Option<(i64, i64)>,
    forward: Option<i64>,
    backward: Option<i64>,
}

impl Radio {
    pub fn start(&mut self) {
        *self = Self { stage: Stage::Middle, ..Self::default() };
    }

    pub fn give_up(&mut self) {
        *self = Self::default();
    }

    /// Takes in a pulse as it is measured.
    pub fn note(&mut self, count: i64) {
        match self.stage {
            Stage::Middle => {
                let (low, high) = self.jitter.unwrap_or((count, count));
                self.jitter = Some((low.min(count), high.max(count)));
            }
            Stage::Forward => self.forward = Some(self.forward.map_or(count, |most| most.max(count))),
            Stage::Backward => self.backward = Some(self.backward.map_or(count, |least| least.min(count))),
            Stage::Idle | Stage::Done => {}
        }
    }

    /// The end that the stick has reached in this stage.
    pub fn reached(&self) -> Option<i64> {
        match self.stage {
            Stage::Forward => self.forward,
            Stage::Backward => self.backward,
            Stage::Idle | Stage::Middle | Stage::Done => None,
        }
    }

    /// Goes on with the stick as it is now; why not, as a sentence.
    pub fn go_on(&mut self, count: Option<i64>) -> Result<(), RadioMessage> {
        let Some(count) = count else {
            return Err(RadioMessage::NoPulse);
        };
        match self.stage {
            Stage::Idle | Stage::Done => {}
            Stage::Middle => {
                let off = count - MIDDLE;
                if off.abs() > MIDDLE_TOLERANCE {
                    return Err(RadioMessage::OffMiddle { milliseconds: off as f64 * STEP_MS });
                }
                self.middle = Some(count);
                self.stage = Stage::Forward;
            }
            Stage::Forward => {
                if self.forward.is_none_or(|most| most < MIDDLE + LEAST_THROW) {
                    return Err(RadioMessage::NotLonger);
                }
                self.stage = Stage::Backward;
            }
            Stage::Backward => {
                if self.backward.is_none_or(|least| least > MIDDLE - LEAST_THROW) {
                    return Err(RadioMessage::NotShorter);
                }
                self.stage = Stage::Done;
            }
        }
        Ok(())
    }

    /// RCMAX, RCMIN and RCBAND, once all was measured; `for_position` in the position sub-mode.
    pub fn result(&self, for_position: bool) -> Option<[i64; 3]> {
        if self.stage != Stage::Done {
            return None;
        }
        let inside = if for_position { INSIDE } else { 0 };
        let (low, high) = self.jitter?;
        let jitter = (high - MIDDLE).abs().max((low - MIDDLE).abs());
        Some([self.forward? - inside, self.backward? + inside, (jitter + 2).max(15)])
    }
}

/// One step of RCCOUNT (Motion Mind manual 4.3: 1736 ns).
pub const STEP_MS: f64 = 0.001_736;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_stick_gives_the_three_registers_in_the_manuals_order() {
        let mut radio = Radio::default();
        radio.start();
        for count in [862, 866, 864] {
            radio.note(count);
        }
        radio.go_on(Some(864)).unwrap();
        for count in [900, 1140, 1151, 1149] {
            radio.note(count);
        }
        radio.go_on(Some(1149)).unwrap();
        for count in [600, 577, 580] {
            radio.note(count);
        }
        radio.go_on(Some(580)).unwrap();
        assert_eq!(radio.result(false), Some([1151, 577, 15]));
        assert_eq!(radio.result(true), Some([1147, 581, 15]), "inside what was measured");
    }

    #[test]
    fn a_middle_that_is_off_and_a_stick_that_was_not_moved_are_told() {
        let mut radio = Radio::default();
        radio.start();
        assert!(radio.go_on(Some(900)).unwrap_err().to_string().contains("+0.062 ms"));
        assert!(radio.go_on(None).is_err());
        radio.note(864);
        radio.go_on(Some(864)).unwrap();
        radio.note(870);
        assert!(radio.go_on(Some(870)).unwrap_err().to_string().contains("fully forward"));
        assert_eq!(radio.result(false), None);
    }
}
