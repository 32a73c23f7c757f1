//! Finding the range of an input by moving it: both ends, then the center. Readings that jump are not believed.

use crate::messages::CalibrationMessage;
use std::collections::VecDeque;

/// What calibration is at.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum CalibrationStage {
    /// The input is to be moved to both ends.
    #[default]
    Ends,
    /// The input is to be left at rest.
    Center,
}

/// A calibration under way. It takes bare readings one by one, however they come.
#[derive(Clone, Debug, Default)]
pub struct Calibration {
    pub stage: CalibrationStage,
    recent: VecDeque<f64>,
    lowest: Option<f64>,
    highest: Option<f64>,
    ends: Option<(f64, f64)>,
}

/// What a calibration found, in units of the reading.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Calibrated {
    /// Lowest reading that lasted.
    pub min: f64,
    /// Reading at rest.
    pub center: f64,
    /// Highest reading that lasted.
    pub max: f64,
    /// How far the readings at rest lie from their middle at most.
    pub noise: f64,
}

/// Readings that a median is taken of: a jump of one or two of them never gets through.
const MEDIAN_OF: usize = 5;
/// Readings at rest that the center is taken of.
const REST_READINGS: usize = 10;
/// The least way between the ends that counts as moved.
const LEAST_WAY: f64 = 50.0;
/// The share of the way that readings at rest may spread over.
const REST_SPREAD: f64 = 0.04;
/// The share of the way that the center keeps from either end.
const END_MARGIN: f64 = 0.05;

impl Calibration {
    /// Takes one bare reading.
    pub fn read(&mut self, reading: f64) {
        if self.recent.len() == REST_READINGS {
            self.recent.pop_front();
        }
        self.recent.push_back(reading);
        if self.stage == CalibrationStage::Ends
            && let Some(lasting) = self.lasting()
        {
            self.lowest = Some(self.lowest.map_or(lasting, |lowest| lowest.min(lasting)));
            self.highest = Some(self.highest.map_or(lasting, |highest| highest.max(lasting)));
        }
    }

    /// The latest reading with jumps left out, once there are enough.
    pub fn lasting(&self) -> Option<f64> {
        let skipped = self.recent.len().checked_sub(MEDIAN_OF)?;
        Some(median(self.recent.iter().skip(skipped).copied()))
    }

    /// The lowest and highest reading so far that lasted.
    pub fn seen(&self) -> Option<(f64, f64)> {
        self.ends.or(self.lowest.zip(self.highest))
    }

    /// Takes the ends and goes on to the center; a refusal is a sentence.
    pub fn take_ends(&mut self) -> Result<(), CalibrationMessage> {
        let (lowest, highest) = self.seen().ok_or(CalibrationMessage::NoReadings)?;
        if highest - lowest < LEAST_WAY {
            return Err(CalibrationMessage::ShortTravel { travel: highest - lowest });
        }
        self.ends = Some((lowest, highest));
        self.stage = CalibrationStage::Center;
        self.recent.clear();
        Ok(())
    }

    /// Takes the center, which ends it; a refusal is a sentence.
    pub fn take_center(&self) -> Result<Calibrated, CalibrationMessage> {
        let (min, max) = self.ends.ok_or(CalibrationMessage::EndsFirst)?;
        if self.recent.len() < REST_READINGS {
            return Err(CalibrationMessage::FewReadings);
        }
        let center = median(self.recent.iter().copied());
        let mut distances: Vec<f64> = self.recent.iter().map(|reading| (reading - center).abs()).collect();
        distances.sort_by(f64::total_cmp);
        // One reading may jump.
        let noise = distances[REST_READINGS - 2];
        if noise > REST_SPREAD * (max - min) {
            return Err(CalibrationMessage::NotAtRest { noise, center });
        }
        let margin = END_MARGIN * (max - min);
        if center < min + margin || center > max - margin {
            return Err(CalibrationMessage::RestsAtEnd { center, min, max });
        }
        Ok(Calibrated { min, center, max, noise })
    }
}

fn median(readings: impl Iterator<Item = f64>) -> f64 {
    let mut sorted: Vec<f64> = readings.collect();
    sorted.sort_by(f64::total_cmp);
    sorted.get(sorted.len() / 2).copied().unwrap_or(f64::NAN)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn hold(calibration: &mut Calibration, reading: f64, times: usize) {
        for _ in 0..times {
            calibration.read(reading);
        }
    }

    fn with_ends() -> Calibration {
        let mut calibration = Calibration::default();
        hold(&mut calibration, 1100.0, 6);
        hold(&mut calibration, 1900.0, 6);
        calibration.take_ends().unwrap();
        calibration
    }

    #[test]
    fn both_ends_and_the_center_are_found() {
        let mut calibration = with_ends();
        assert_eq!(calibration.stage, CalibrationStage::Center);
        hold(&mut calibration, 1510.0, 10);
        let found = calibration.take_center().unwrap();
        assert_eq!(found, Calibrated { min: 1100.0, center: 1510.0, max: 1900.0, noise: 0.0 });
    }

    #[test]
    fn a_jump_of_the_reading_is_no_end() {
        let mut calibration = Calibration::default();
        hold(&mut calibration, 1100.0, 6);
        calibration.read(65_000.0);
        calibration.read(0.0);
        hold(&mut calibration, 1900.0, 6);
        assert_eq!(calibration.seen(), Some((1100.0, 1900.0)));
    }

    #[test]
    fn a_jump_at_rest_is_no_center_and_unrest_is_refused() {
        let mut calibration = with_ends();
        hold(&mut calibration, 1500.0, 5);
        calibration.read(9999.0);
        hold(&mut calibration, 1502.0, 4);
        let found = calibration.take_center().unwrap();
        assert!((1500.0..=1502.0).contains(&found.center) && found.noise <= 2.0, "{found:?}");
        for step in 0..10 {
            calibration.read(1300.0 + 50.0 * f64::from(step));
        }
        assert!(calibration.take_center().unwrap_err().to_string().contains("does not rest"));
    }

    #[test]
    fn an_input_that_was_not_moved_is_told() {
        let mut calibration = Calibration::default();
        assert!(calibration.take_ends().unwrap_err().to_string().contains("No readings"));
        hold(&mut calibration, 2000.0, 9);
        calibration.read(2020.0);
        assert!(calibration.take_ends().unwrap_err().to_string().contains("moved over 0 only"));
        assert_eq!(calibration.stage, CalibrationStage::Ends);
    }

    #[test]
    fn a_center_at_an_end_is_refused() {
        let mut calibration = with_ends();
        assert!(calibration.take_center().unwrap_err().to_string().contains("Too few readings"));
        hold(&mut calibration, 1110.0, 10);
        assert!(calibration.take_center().unwrap_err().to_string().contains("one of its ends"));
    }
}
