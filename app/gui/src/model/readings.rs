//! The newest reading of every channel, for the row of monitored parameters.

use brushwork_link::device::{Channel, Newest, PinSignal, Sample};

/// The newest readings of one controller. A channel that was never read has none.
#[derive(Clone, Debug, Default)]
pub struct Readings {
    newest: Newest,
    signals: Vec<PinSignal>,
}

impl Readings {
    /// Takes over what the sample has read and keeps the rest.
    pub fn update(&mut self, sample: &Sample) {
        self.newest.update(sample);
        if !sample.signals.is_empty() {
            self.signals.clone_from(&sample.signals);
        }
    }

    /// The newest of an input pin, counted from 1. Pins are read only while a screen wants them.
    pub fn signal(&self, pin: usize) -> Option<PinSignal> {
        self.signals.get(pin.checked_sub(1)?).copied()
    }

    /// The input pins are not read any more.
    pub fn forget_signals(&mut self) {
        self.signals.clear();
    }

    pub fn get(&self, channel: Channel) -> Option<f64> {
        self.newest.get(channel)
    }

    /// As text with the channel's digits after the point.
    pub fn text(&self, channel: Channel) -> Option<String> {
        let decimals = channel.decimals;
        // Adding zero turns -0.0 into 0.0; rounding comes first, so that -0.04 does not read "-0.0".
        let factor = 10f64.powi(decimals as i32);
        self.get(channel).map(|value| format!("{:.decimals$}", (value * factor).round() / factor + 0.0))
    }
}

#[cfg(test)]
mod tests {
    use std::time::Duration;

    use super::*;

    #[test]
    fn a_sample_that_leaves_a_channel_out_keeps_its_last_reading() {
        let mut readings = Readings::default();
        let mut sample = Sample::new(0x80);
        sample.set(Channel::TEMPERATURE_1, 27.25, Duration::ZERO, Duration::ZERO);
        readings.update(&sample);
        readings.update(&Sample::new(0x80));
        assert_eq!(readings.text(Channel::TEMPERATURE_1).as_deref(), Some("27.3"));
        assert_eq!(readings.get(Channel::TEMPERATURE_2), None);
    }

    #[test]
    fn nothing_ever_reads_minus_zero() {
        let mut readings = Readings::default();
        let mut sample = Sample::new(0x80);
        sample.set(Channel::M1_CURRENT, -0.004, Duration::ZERO, Duration::ZERO);
        readings.update(&sample);
        assert_eq!(readings.text(Channel::M1_CURRENT).as_deref(), Some("0.00"));
    }
}
