//! Whether a driven motor has ceased to draw a current: readings in a row that are no more than the noise of the sensor, of a motor whose current was
//! clearly more before.

use crate::thresholds::thresholds;
use std::collections::VecDeque;

thresholds! {
    /// From which missing current on a motor counts as not connected.
    pub(crate) SILENCE: Thresholds {
        /// Highest reading that counts as no current of a sensor without noise, in amperes: the wire's resolution.
        no_current_amps: f64 = 0.0151,
        /// Highest reading that counts as no current of a sensor with noise, in standard deviations of the readings at rest: of twenty readings of no current one in a
        /// hundred runs has one beyond it.
        noises: f64 = 3.5,
        /// How long a motor has to be without current to be open, in seconds.
        open_s: f64 = 0.2,
        /// How many times the highest reading of no current a motor has to draw, typically, for its silence to raise an alarm: at 1.2 a motor that its load helps is
        /// called open.
        clearly: f64 = 2.0,
        /// How many times that reading a motor must have drawn at some time for its silence to give an alarm of any kind its name.
        clearly_once: f64 = 2.5,
        /// How many times the lowest duty at which a held motor drew a current another duty has to be for the silence at it to count: currents are read in steps.
        held: f64 = 1.5,
        /// Share of a new reading in the typical current: some ten readings, a third of a second, make it.
        newest: f64 = 0.1,
        /// Mean size that readings of no current may have, as a multiple of their root mean square: it is 0.8, and the whole is taken since that was measured too.
        mean: f64 = 1.0,
        /// Three standard deviations of that mean size, as a multiple of the root mean square: each is 0.6 for a single reading, and falls with the root of their number.
        three_deviations: f64 = 1.8,
    }
}

/// The current of the motor while it is driven.
#[derive(Clone, Debug, Default)]
pub(crate) struct CurrentSilence {
    /// What it draws when its duty has settled, A; `None` before any was read.
    typical_amps: Option<f64>,
    /// Whether a reading ever was clearly more than no current.
    pub(crate) has_been_clear: bool,
    /// The lowest duty at which a motor that a loop holds was seen to draw clearly more than none.
    held_duty: Option<f64>,
    /// Readings of no current in a row, oldest first: when, A, and whether the duty had settled. The first
    /// is as old as makes an open motor.
    silent: VecDeque<(f64, f64, bool)>,
}

impl CurrentSilence {
    /// A reading of the driven motor. `most_amps` is the highest one that counts as no current.
    pub(crate) fn see(&mut self, t: f64, amps: f64, is_settled: bool, most_amps: f64) {
        self.has_been_clear |= amps > SILENCE.clearly_once * most_amps;
        self.silent.push_back((t, amps, is_settled));
        while self.silent.get(1).is_some_and(|next| t - next.0 > SILENCE.open_s) {
            self.silent.pop_front();
        }
        if amps > most_amps {
            // A silence that ended was none, so that it belongs to what the motor draws.
            let settled = self.silent.drain(..).filter(|reading| reading.2);
            for (_, amps, _) in settled {
                let typical = self.typical_amps.get_or_insert(amps);
                *typical += SILENCE.newest * (amps - *typical);
            }
        }
    }

    /// A reading of a motor that a loop holds with a duty.
    pub(crate) fn see_held(&mut self, duty: f64, amps: f64, most_amps: f64) {
        if amps > SILENCE.clearly_once * most_amps {
            self.held_duty = Some(self.held_duty.map_or(duty, |lowest| lowest.min(duty)));
        }
    }

    /// Whether a motor that a loop holds with a duty has to draw a current, as it did with a clearly smaller one.
    pub(crate) fn is_drawn_at(&self, duty: f64) -> bool {
        self.held_duty.is_some_and(|lowest| duty > SILENCE.held * lowest)
    }

    /// The motor is not driven.
    pub(crate) fn rest(&mut self) {
        self.silent.clear();
    }

    /// Whether it typically draws clearly more than no current.
    pub(crate) fn is_clear(&self, most_amps: f64) -> bool {
        self.typical_amps.is_some_and(|typical| typical > SILENCE.clearly * most_amps)
    }

    /// Whether all readings for long were no current, one by one and in their mean, given the root mean square of readings at rest.
    pub(crate) fn is_long(&self, noise_amps: f64) -> bool {
        let (Some(first), Some(last)) = (self.silent.front(), self.silent.back()) else { return false };
        let n = self.silent.len() as f64;
        let mean_amps = self.silent.iter().map(|reading| reading.1).sum::<f64>() / n;
        let most_amps =
            SILENCE.no_current_amps.max(noise_amps * (SILENCE.mean + SILENCE.three_deviations / n.sqrt()));
        last.0 - first.0 > SILENCE.open_s && mean_amps <= most_amps
    }
}
