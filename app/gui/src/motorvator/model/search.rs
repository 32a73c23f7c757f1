//! The search for the smallest waits of a stepper that lose no steps: first the smallest at which it can be started, then the smallest that it
//! reaches from there (MotorVator manual, ConfigStepper).
//!
//! The board does not know where a rotor stands. So each trial moves there as it is to be tried and back slowly, and a person says whether the
//! mark on the shaft has come back: a rotor that stood still both ways would bring it back too. Waits that are longer than one that loses
//! nothing are taken to lose nothing either.

use brushwork_motorvator_wire::host::StepperConfig;

/// What is looked for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Stage {
    /// MaxWait: moves without a ramp.
    Start,
    /// MinWait: moves that begin and end with that MaxWait.
    Top,
    /// Both are found.
    Found,
    /// Steps are lost even with the longest wait.
    Hopeless,
}

/// A search under way.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Search {
    pub stage: Stage,
    /// The longest wait that is known to lose steps; 0 where none is.
    loses: u8,
    /// The shortest one that is known to lose none.
    holds: Option<u8>,
    trying: u8,
    max_wait: u8,
    hold_percent: u8,
    /// Trials that were judged.
    pub trials: usize,
}

/// The wait that is tried first.
const FIRST: u8 = 20;
/// The wait of the way back while none is known to lose nothing.
const SLOW: u8 = 60;

impl Search {
    /// A search that begins with slow steps.
    pub fn new(hold_percent: u8) -> Self {
        Self {
            stage: Stage::Start,
            loses: 0,
            holds: None,
            trying: FIRST,
            max_wait: FIRST,
            hold_percent,
            trials: 0,
        }
    }

    /// What is to be tried now, or what was found.
    pub fn config(&self) -> StepperConfig {
        let (least, most) = match self.stage {
            Stage::Start | Stage::Hopeless => (self.trying, self.trying),
            Stage::Top => (self.trying, self.max_wait),
            Stage::Found => {
                // A motor that just follows loses steps when it gets warm, or its load grows.
                let most = with_margin(self.max_wait);
                (with_margin(self.holds.unwrap_or(self.max_wait)).min(most), most)
            }
        };
        StepperConfig { least, most, hold_percent: self.hold_percent }
    }

    /// How a trial goes back.
    pub fn slow(&self) -> StepperConfig {
        let wait = self.holds.map_or(SLOW, |holds| holds.saturating_mul(2));
        StepperConfig { least: wait, most: wait, hold_percent: self.hold_percent }
    }

    /// Whether there is something to be tried.
    pub fn is_trying(&self) -> bool {
        matches!(self.stage, Stage::Start | Stage::Top)
    }

    /// Takes a person's word on the trial.
    pub fn judge(&mut self, lost_steps: bool) {
        if !self.is_trying() {
            return;
        }
        self.trials += 1;
        if lost_steps {
            self.loses = self.trying;
        } else {
            self.holds = Some(self.trying);
        }
        match self.holds {
            None if self.trying == u8::MAX => self.stage = Stage::Hopeless,
            None => self.trying = self.trying.saturating_mul(2),
            Some(holds) if holds - self.loses > 1 => self.trying = self.loses + (holds - self.loses) / 2,
            Some(holds) => self.advance(holds),
        }
    }

    /// Goes to the next stage, with the wait that was found.
    fn advance(&mut self, holds: u8) {
        if self.stage == Stage::Top || holds == 1 {
            self.max_wait = if self.stage == Stage::Top { self.max_wait } else { holds };
            self.stage = Stage::Found;
            return;
        }
        self.stage = Stage::Top;
        self.max_wait = holds;
        self.loses = 0;
        self.trying = holds / 2;
    }
}

/// A fifth more.
fn with_margin(wait: u8) -> u8 {
    wait.saturating_add(wait.div_ceil(5))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A motor that can be started with waits from `start` on and reaches `top`.
    fn found(start: u8, top: u8) -> (Search, StepperConfig) {
        let mut search = Search::new(30);
        while search.is_trying() {
            let StepperConfig { least, most, .. } = search.config();
            search.judge(most < start || least < top);
            assert!(search.trials < 30);
        }
        (search, search.config())
    }

    #[test]
    fn both_waits_are_found_and_get_a_fifth_more() {
        for (start, top) in [(12, 5), (20, 20), (1, 1), (2, 1), (255, 254), (100, 1), (33, 17)] {
            let (search, config) = found(start, top);
            assert_eq!(search.stage, Stage::Found);
            let expected = (with_margin(top).min(with_margin(start)), with_margin(start));
            assert_eq!(
                (config.least, config.most, config.hold_percent),
                (expected.0, expected.1, 30),
                "{start} {top}"
            );
            assert!(search.trials <= 22, "{}", search.trials);
        }
    }

    #[test]
    fn a_motor_that_follows_no_wait_ends_the_search() {
        let mut search = Search::new(0);
        while search.is_trying() {
            search.judge(true);
        }
        assert_eq!((search.stage, search.trials), (Stage::Hopeless, 5));
    }
}
