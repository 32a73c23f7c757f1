//! The manual's way to a home position (SuprMotr manual, Homing): quickly to the negative limit switch, slowly off it again, and that place is 0.
//!
//! `DV10000 FE1 WS DV500 FE4 WS DH`: no line of it is sent before the board has told that the one before is done. The velocity of moves is the user's
//! again before the place becomes 0, which disarms: all positions mean something else then.

use brushwork_link::Event;
use brushwork_suprmotr_wire::Mnemonic;
use brushwork_values::Value;

use crate::command::Command;

/// Answers to its commands begin with this number.
const FIRST_ID: u64 = 1 << 48;
/// Velocities of the manual's example, counts/s.
const QUICK: f64 = 10_000.0;
const SLOW: f64 = 500.0;

/// A step, in order.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Step {
    /// DV: the velocity of the search.
    Quick,
    /// FE1: to the negative limit switch.
    ToLimit,
    /// DV: the velocity of the way off it.
    Slow,
    /// FE4: off the switch.
    OffLimit,
    /// DV: that of the user.
    PutBack,
    /// DH: this place is 0.
    Zero,
}

impl Step {
    pub const ALL: [Self; 6] =
        [Self::Quick, Self::ToLimit, Self::Slow, Self::OffLimit, Self::PutBack, Self::Zero];

    fn next(self) -> Option<Self> {
        Self::ALL.into_iter().skip_while(|step| *step != self).nth(1)
    }

    /// Whether it is over only when the search for an edge is.
    const fn is_search(self) -> bool {
        matches!(self, Self::ToLimit | Self::OffLimit)
    }
}

/// How far a step is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Stage {
    /// To be sent.
    Due,
    /// Its answer is due.
    Asked,
    /// The axis looks for its edge.
    Searching,
}

/// How a step stands, for a person.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Standing {
    Waits,
    Runs,
    Done,
}

/// Why it did not come to its end.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Trouble {
    /// The search for the limit switch ended without one that is on.
    NoLimit,
    /// The way off it ended on it.
    StillOn,
    /// It was stopped.
    Stopped,
    /// The board or the link says so.
    Refused(String),
}

/// The guide.
#[derive(Debug)]
pub struct Home {
    /// Velocities of the two searches, counts/s.
    pub quick: f64,
    pub slow: f64,
    /// The velocity of moves before it began.
    before: Option<i64>,
    at: Option<(Step, Stage)>,
    /// Steps that are done.
    done: usize,
    /// It goes no further than to give the velocity back.
    is_given_up: bool,
    pub trouble: Option<Trouble>,
    asked: u64,
}

impl Default for Home {
    fn default() -> Self {
        Self {
            quick: QUICK,
            slow: SLOW,
            before: None,
            at: None,
            done: 0,
            is_given_up: false,
            trouble: None,
            asked: 0,
        }
    }
}

impl Home {
    pub fn is_running(&self) -> bool {
        self.at.is_some()
    }

    /// Whether it came to its end.
    pub fn is_done(&self) -> bool {
        self.at.is_none() && self.done == Step::ALL.len()
    }

    pub fn standing(&self, step: Step) -> Standing {
        let place = Step::ALL.iter().position(|known| *known == step).unwrap_or(0);
        match self.at {
            Some((here, _)) if here == step => Standing::Runs,
            _ if place < self.done => Standing::Done,
            _ => Standing::Waits,
        }
    }

    /// Begins, where the velocity of moves is known, which it puts back.
    pub fn begin(&mut self, velocity: i64) {
        if self.is_running() {
            return;
        }
        (self.before, self.trouble, self.done, self.is_given_up) = (Some(velocity), None, 0, false);
        self.at = Some((Step::Quick, Stage::Due));
    }

    /// The next command, when it is time for it.
    pub fn take_order(&mut self) -> Option<Command> {
        let (step, _) = self.at.filter(|(_, stage)| *stage == Stage::Due)?;
        self.at = Some((step, Stage::Asked));
        self.asked += 1;
        let velocity = |counts_per_s: f64| (Mnemonic::DV, Some(counts_per_s.round() as i64));
        let (mnemonic, number) = match step {
            Step::Quick => velocity(self.quick),
            Step::Slow => velocity(self.slow),
            Step::ToLimit => (Mnemonic::FE, Some(1)),
            Step::OffLimit => (Mnemonic::FE, Some(4)),
            Step::PutBack => (Mnemonic::DV, self.before),
            Step::Zero => (Mnemonic::DH, None),
        };
        let values = number.into_iter().map(Value::Int).collect();
        Some(Command::Transact { id: FIRST_ID + self.asked, command: mnemonic.number(), values })
    }

    /// The command was not taken by the link: it is sent again.
    pub fn not_sent(&mut self) {
        if let Some((step, Stage::Asked)) = self.at {
            self.at = Some((step, Stage::Due));
        }
    }

    /// Takes in an event of the link: true where it was the answer to one of its commands.
    pub fn take(&mut self, event: &Event) -> bool {
        if let Event::Status(report) = event {
            let searches = report.is_active("find_edge") || !report.is_active("trajectory_complete");
            self.looked(searches, report.is_active("negative_limit"));
        }
        let Event::Transacted { id, result } = event else { return false };
        if *id <= FIRST_ID {
            return false;
        }
        if *id == FIRST_ID + self.asked {
            match result {
                Ok(_) => self.answered(),
                Err(why) => self.refused(why.to_string()),
            }
        }
        true
    }

    /// Why a command was not even sent, if it is one of its own.
    pub fn refused_of(&mut self, id: u64, why: String) {
        if self.is_running() && id == FIRST_ID + self.asked {
            self.refused(why);
        }
    }

    fn refused(&mut self, why: String) {
        let Some((step, _)) = self.at else { return };
        self.trouble = self.trouble.take().or(Some(Trouble::Refused(why)));
        // What cannot be put back is not tried again.
        match step {
            Step::PutBack | Step::Zero | Step::Quick => self.at = None,
            Step::ToLimit | Step::Slow | Step::OffLimit => self.give_back(),
        }
    }

    fn answered(&mut self) {
        let Some((step, _)) = self.at else { return };
        if step.is_search() {
            self.at = Some((step, Stage::Searching));
        } else {
            self.over(step);
        }
    }

    /// A status: the search is over when the board says so, and has found what it was for or not.
    fn looked(&mut self, searches: bool, is_on_limit: bool) {
        let Some((step, Stage::Searching)) = self.at else { return };
        if searches {
            return;
        }
        let trouble = match step {
            Step::ToLimit if !is_on_limit => Some(Trouble::NoLimit),
            Step::OffLimit if is_on_limit => Some(Trouble::StillOn),
            Step::Quick | Step::ToLimit | Step::Slow | Step::OffLimit | Step::PutBack | Step::Zero => None,
        };
        match trouble {
            Some(trouble) => {
                self.trouble = Some(trouble);
                self.give_back();
            }
            None => self.over(step),
        }
    }

    /// A step is done.
    fn over(&mut self, step: Step) {
        if self.is_given_up {
            self.at = None;
            return;
        }
        self.done += 1;
        self.at = step.next().map(|next| (next, Stage::Due));
    }

    /// Goes no further than to put the velocity of moves back.
    fn give_back(&mut self) {
        self.is_given_up = true;
        self.at = Some((Step::PutBack, Stage::Due));
    }

    /// Nothing may move any more.
    pub fn rest(&mut self) {
        match self.at {
            Some((Step::Quick | Step::ToLimit | Step::Slow | Step::OffLimit, _)) => {
                self.trouble = Some(Trouble::Stopped);
                self.give_back();
            }
            Some((Step::PutBack | Step::Zero, _)) | None => {}
        }
    }

    /// The link has ended, or the unit is another one.
    pub fn forget(&mut self) {
        if self.is_running() {
            self.trouble = Some(Trouble::Stopped);
        }
        (self.at, self.done, self.before) = (None, 0, None);
    }
}

#[cfg(test)]
mod tests {
    use std::time::Duration;

    use brushwork_link::StatusReport;
    use brushwork_suprmotr_client::indicators::INDICATORS;
    use brushwork_values::Values;

    use super::*;

    fn asked(home: &mut Home) -> (u64, Mnemonic, Vec<i64>) {
        match home.take_order() {
            Some(Command::Transact { id, command, values }) => (
                id,
                Mnemonic::from_number(command).expect("it is one"),
                values.iter().filter_map(Value::as_int).collect(),
            ),
            other => panic!("{other:?}"),
        }
    }

    fn answer(home: &mut Home, id: u64) {
        assert!(home.take(&Event::Transacted { id, result: Ok(Values::default()) }));
    }

    fn status(home: &mut Home, keys: &[&str]) {
        let word = INDICATORS.iter().filter(|bit| keys.contains(&bit.key)).map(|bit| bit.mask).sum();
        home.take(&Event::Status(StatusReport::new(0, Duration::ZERO, word, INDICATORS)));
    }

    #[test]
    fn the_manuals_commands_go_out_one_after_the_other_and_the_velocity_is_the_users_again() {
        let mut home = Home::default();
        home.begin(20_000);
        let mut sent = Vec::new();
        while home.is_running() {
            let (id, mnemonic, numbers) = asked(&mut home);
            sent.push((mnemonic, numbers));
            assert!(home.take_order().is_none(), "one at a time");
            // What was told before the answer is of the time before the search.
            status(&mut home, &["trajectory_complete"]);
            answer(&mut home, id);
            if mnemonic == Mnemonic::FE {
                status(&mut home, &["find_edge"]);
                assert!(home.take_order().is_none(), "it searches");
                let is_first = sent.len() == 2;
                status(
                    &mut home,
                    if is_first {
                        &["trajectory_complete", "negative_limit"]
                    } else {
                        &["trajectory_complete"]
                    },
                );
            }
        }
        let one = |number: i64| vec![number];
        assert_eq!(
            sent,
            [
                (Mnemonic::DV, one(10_000)),
                (Mnemonic::FE, one(1)),
                (Mnemonic::DV, one(500)),
                (Mnemonic::FE, one(4)),
                (Mnemonic::DV, one(20_000)),
                (Mnemonic::DH, vec![]),
            ]
        );
        assert!(home.is_done() && home.trouble.is_none());
    }

    #[test]
    fn a_search_that_finds_nothing_and_a_stop_give_the_velocity_back_and_zero_nothing() {
        for is_stopped in [false, true] {
            let mut home = Home::default();
            home.begin(20_000);
            for _ in 0..2 {
                let (id, ..) = asked(&mut home);
                answer(&mut home, id);
            }
            if is_stopped {
                home.rest();
            } else {
                status(&mut home, &["trajectory_complete"]);
            }
            let trouble = if is_stopped { Trouble::Stopped } else { Trouble::NoLimit };
            assert_eq!(home.trouble, Some(trouble));
            let (id, mnemonic, numbers) = asked(&mut home);
            assert_eq!((mnemonic, numbers), (Mnemonic::DV, vec![20_000]));
            answer(&mut home, id);
            assert!(!home.is_running() && !home.is_done() && home.take_order().is_none());
        }
    }
}
