//! The stepper of half a board: a move, its configuration, and the search for its waits, step by step with the board's answers.

use brushwork_link::Event;
use brushwork_motorvator_client::Half;
use brushwork_motorvator_wire::host::{STEPPER_DEFAULT, StepperConfig};
use brushwork_values::Value;

use super::search::Search;
use crate::command::Command;

/// Answers to its orders begin with this number.
const FIRST_ID: u64 = 1 << 43;

/// What goes on.
#[derive(Clone, Debug, Default, PartialEq)]
pub enum Phase {
    #[default]
    Idle,
    /// Orders that are to go out, the next one at the head, and whether a trial of the search is what they are for.
    Working { orders: Vec<Order>, is_trial: bool },
    /// A trial has moved there and back: a person is to say whether the mark is where it was.
    Asks,
}

/// An order of a sequence.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Order {
    Configure(StepperConfig),
    /// Steps, with a minus for backward.
    Move(i32),
}

/// How far the order at the head is.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
enum Sent {
    #[default]
    No,
    /// Its answer is due.
    Asked,
    /// It moves, until the board says that it does not.
    Moving,
}

/// The state of the screen.
#[derive(Clone, Debug)]
pub struct Stepper {
    /// Steps of a move, and of a trial.
    pub steps: f64,
    pub min_wait: f64,
    pub max_wait: f64,
    pub hold_percent: f64,
    pub phase: Phase,
    pub search: Option<Search>,
    /// Why it did not go on.
    pub trouble: Option<String>,
    sent: Sent,
    asked: u64,
    /// The board was configured from here: what the settings say of it is to be read anew.
    has_configured: bool,
    /// What the fields were last filled with of what the board has.
    followed: Option<StepperConfig>,
}

impl Default for Stepper {
    fn default() -> Self {
        let StepperConfig { least, most, hold_percent } = STEPPER_DEFAULT;
        Self {
            steps: 200.0,
            min_wait: least.into(),
            max_wait: most.into(),
            hold_percent: hold_percent.into(),
            phase: Phase::Idle,
            search: None,
            trouble: None,
            sent: Sent::No,
            asked: 0,
            has_configured: false,
            followed: None,
        }
    }
}

impl Stepper {
    /// What the fields say.
    pub fn config(&self) -> StepperConfig {
        // The fields keep to these ranges.
        let byte = |value: f64| value.round().clamp(0.0, 255.0) as u8;
        let least = byte(self.min_wait).max(1);
        StepperConfig {
            least,
            most: byte(self.max_wait).max(least),
            hold_percent: byte(self.hold_percent).min(100),
        }
    }

    /// Whether the board was configured since this was asked last. While more orders are due, there is time.
    pub fn take_configured(&mut self) -> bool {
        self.is_idle() && std::mem::take(&mut self.has_configured)
    }

    /// Shows what the board has, when that was read and is not what was read before: what is typed stays otherwise.
    pub fn follow(&mut self, on_board: Option<StepperConfig>) {
        let Some(config) = on_board.filter(|config| self.followed != Some(*config)) else { return };
        if !self.is_idle() || self.search.is_some() {
            return;
        }
        self.followed = Some(config);
        let StepperConfig { least, most, hold_percent } = config;
        (self.min_wait, self.max_wait) = (least.into(), most.into());
        self.hold_percent = hold_percent.into();
    }

    pub fn is_idle(&self) -> bool {
        self.phase == Phase::Idle
    }

    /// Moves, with the configuration of the fields.
    pub fn begin_move(&mut self, forward: bool) {
        let steps = self.step_count();
        self.begin(
            vec![Order::Configure(self.config()), Order::Move(if forward { steps } else { -steps })],
            false,
        );
    }

    /// Configures with the fields alone.
    pub fn configure(&mut self) {
        self.begin(vec![Order::Configure(self.config())], false);
    }

    /// Begins a search, or tries what it wants tried next.
    pub fn try_next(&mut self) {
        let hold = self.config().hold_percent;
        let search = *self.search.get_or_insert_with(|| Search::new(hold));
        if search.is_trying() {
            let steps = self.step_count();
            let orders = vec![
                Order::Configure(search.config()),
                Order::Move(steps),
                Order::Configure(search.slow()),
                Order::Move(-steps),
            ];
            self.begin(orders, true);
        }
    }

    /// Takes a person's word on a trial; the next one begins at once.
    pub fn judge(&mut self, lost_steps: bool) {
        self.phase = Phase::Idle;
        let Some(search) = &mut self.search else { return };
        search.judge(lost_steps);
        if search.is_trying() {
            self.try_next();
        } else {
            self.take_found();
        }
    }

    /// What was found goes into the fields, and to the board.
    fn take_found(&mut self) {
        let Some(search) = self.search.filter(|search| search.stage == super::search::Stage::Found) else {
            return;
        };
        let StepperConfig { least, most, .. } = search.config();
        (self.min_wait, self.max_wait) = (least.into(), most.into());
        self.configure();
    }

    pub fn give_up(&mut self) {
        (self.search, self.phase, self.sent) = (None, Phase::Idle, Sent::No);
    }

    fn step_count(&self) -> i32 {
        self.steps.round().clamp(1.0, 65_535.0) as i32
    }

    fn begin(&mut self, orders: Vec<Order>, is_trial: bool) {
        (self.trouble, self.sent) = (None, Sent::No);
        self.phase = Phase::Working { orders, is_trial };
    }

    /// The next order, when it is time for it.
    pub fn take_order(&mut self) -> Option<Command> {
        let Phase::Working { orders, .. } = &self.phase else { return None };
        let order = *orders.first().filter(|_| self.sent == Sent::No)?;
        (self.sent, self.asked) = (Sent::Asked, self.asked + 1);
        let (command, values) = match order {
            Order::Configure(StepperConfig { least, most, hold_percent }) => {
                (b'C', [least, most, hold_percent].map(|value| Value::Int(value.into())).to_vec())
            }
            Order::Move(steps) => (b'T', vec![Value::Int(steps.into())]),
        };
        Some(Command::Transact { id: FIRST_ID + self.asked, command, values })
    }

    /// Takes in an event of the link to this half.
    pub fn take(&mut self, event: &Event, half: Option<Half>) -> bool {
        if let Event::Transacted { id, result } = event {
            if *id != FIRST_ID + self.asked || self.sent != Sent::Asked {
                return *id > FIRST_ID;
            }
            match result {
                Ok(_) => self.answered(),
                Err(failure) => {
                    self.give_up();
                    self.trouble = Some(failure.to_string());
                }
            }
            return true;
        }
        if let (Event::Status(status), Some(half), Sent::Moving) = (event, half, self.sent) {
            let key = match half {
                Half::First => "stepper_1",
                Half::Second => "stepper_2",
            };
            if status.address == half.number() && !status.is_active(key) {
                self.done();
            }
        }
        false
    }

    fn answered(&mut self) {
        let Phase::Working { orders, .. } = &self.phase else { return };
        match orders.first() {
            Some(Order::Move(_)) => self.sent = Sent::Moving,
            Some(Order::Configure(_)) => {
                self.has_configured = true;
                self.done();
            }
            None => self.done(),
        }
    }

    /// The order at the head is done.
    fn done(&mut self) {
        let Phase::Working { orders, is_trial } = &mut self.phase else { return };
        self.sent = Sent::No;
        if !orders.is_empty() {
            orders.remove(0);
        }
        if orders.is_empty() {
            self.phase = if *is_trial { Phase::Asks } else { Phase::Idle };
        }
    }

    /// Nothing may move any more.
    pub fn rest(&mut self) {
        if matches!(&self.phase, Phase::Working { .. }) {
            self.give_up();
        }
    }
}

#[cfg(test)]
mod tests {
    use std::time::Duration;

    use brushwork_link::StatusReport;
    use brushwork_motorvator_client::indicators::INDICATORS;
    use brushwork_values::Values;

    use super::*;

    fn asked(stepper: &mut Stepper) -> (u64, u8, Vec<Value>) {
        match stepper.take_order() {
            Some(Command::Transact { id, command, values }) => (id, command, values),
            other => panic!("{other:?}"),
        }
    }

    fn answer(stepper: &mut Stepper, id: u64) {
        assert!(stepper.take(&Event::Transacted { id, result: Ok(Values::default()) }, Some(Half::First)));
    }

    fn status(stepper: &mut Stepper, moves: bool) {
        let report = StatusReport::new(1, Duration::ZERO, u32::from(moves), INDICATORS);
        stepper.take(&Event::Status(report), Some(Half::First));
    }

    #[test]
    fn a_trial_configures_moves_there_and_back_and_asks() {
        let mut stepper = Stepper::default();
        stepper.try_next();
        for (wait, steps) in [(20, 200), (60, -200)] {
            let (id, command, values) = asked(&mut stepper);
            assert_eq!((command, values), (b'C', vec![Value::Int(wait), Value::Int(wait), Value::Int(0)]));
            assert!(stepper.take_order().is_none(), "one order at a time");
            answer(&mut stepper, id);
            let (id, command, values) = asked(&mut stepper);
            assert_eq!((command, values), (b'T', vec![Value::Int(steps)]));
            // What was told before the answer is of the move before it.
            status(&mut stepper, false);
            answer(&mut stepper, id);
            status(&mut stepper, true);
            assert!(stepper.take_order().is_none());
            status(&mut stepper, false);
        }
        assert_eq!(stepper.phase, Phase::Asks);
        stepper.judge(false);
        let (_, command, values) = asked(&mut stepper);
        assert_eq!((command, values), (b'C', vec![Value::Int(10), Value::Int(10), Value::Int(0)]));
    }

    #[test]
    fn the_fields_follow_the_board_and_keep_what_is_typed() {
        let mut stepper = Stepper::default();
        let on_board = |least, most| Some(StepperConfig { least, most, hold_percent: 30 });
        stepper.follow(on_board(4, 9));
        assert_eq!(Some(stepper.config()), on_board(4, 9));
        stepper.min_wait = 5.0;
        stepper.follow(on_board(4, 9));
        assert_eq!(stepper.config().least, 5, "typed since it was read");
        stepper.configure();
        assert!(!stepper.take_configured());
        let (id, ..) = asked(&mut stepper);
        answer(&mut stepper, id);
        assert!(stepper.take_configured() && !stepper.take_configured());
        stepper.follow(on_board(5, 9));
        assert_eq!(Some(stepper.config()), on_board(5, 9));
        stepper.try_next();
        stepper.follow(on_board(60, 60));
        assert_eq!(Some(stepper.config()), on_board(5, 9), "a trial's waits are not the user's");
    }

    #[test]
    fn what_is_refused_ends_the_search_and_says_why() {
        let mut stepper = Stepper::default();
        stepper.begin_move(true);
        assert!(!stepper.is_idle());
        stepper.rest();
        assert!(stepper.is_idle() && stepper.search.is_none());
    }
}
