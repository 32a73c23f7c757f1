//! The two servos of a board: where they are to turn, and where they were last told to.

use brushwork_link::Event;
use brushwork_values::Value;

use crate::command::Command;

/// Answers to its orders begin with this number.
const FIRST_ID: u64 = 1 << 45;

/// As far as a servo is turned from its middle, degrees. Assumed: the maker's page names an angle and no range.
pub const FURTHEST_DEGREES: f64 = 90.0;

/// Servo outputs of a board.
pub const SERVOS: usize = 2;

/// The state of the row.
#[derive(Debug, Default)]
pub struct Servos {
    /// Where they are to turn, degrees from the middle, with a minus for backward.
    pub wanted: [f64; SERVOS],
    /// Where they were told to turn, as far as the board has confirmed it.
    pub told: [Option<i32>; SERVOS],
    /// Why the last one was not turned.
    pub trouble: Option<String>,
    waiting: Vec<(u64, usize, i32)>,
    asked: u64,
}

impl Servos {
    /// Has a servo, counted from 0, turn to where it is wanted.
    pub fn turn(&mut self, index: usize) -> Option<Command> {
        let degrees = self.wanted.get(index)?.round().clamp(-FURTHEST_DEGREES, FURTHEST_DEGREES) as i32;
        self.asked += 1;
        let id = FIRST_ID + self.asked;
        self.trouble = None;
        self.waiting.push((id, index, degrees));
        let values = vec![Value::Int(index as i64 + 1), Value::Int(degrees.into())];
        Some(Command::Transact { id, command: b'V', values })
    }

    /// Takes in an answer. True where it is one of its own.
    pub fn take(&mut self, event: &Event) -> bool {
        let Event::Transacted { id, result } = event else { return false };
        let Some(place) = self.waiting.iter().position(|(waiting, ..)| waiting == id) else { return false };
        let (_, index, degrees) = self.waiting.remove(place);
        match result {
            Ok(_) => self.told[index] = Some(degrees),
            Err(why) => self.trouble = Some(why.to_string()),
        }
        true
    }

    /// Another unit, or the link has ended: what servos do nobody knows.
    pub fn forget(&mut self) {
        self.told = [None; SERVOS];
        self.waiting.clear();
    }
}

#[cfg(test)]
mod tests {
    use brushwork_values::Values;

    use super::*;

    #[test]
    fn a_servo_is_where_it_was_told_once_the_board_has_answered() {
        let mut servos = Servos { wanted: [0.0, -30.4], ..Servos::default() };
        let Some(Command::Transact { id, command, values }) = servos.turn(1) else { panic!("it is there") };
        assert_eq!((command, values), (b'V', vec![Value::Int(2), Value::Int(-30)]));
        assert_eq!(servos.told, [None; 2]);
        assert!(servos.take(&Event::Transacted { id, result: Ok(Values::default()) }));
        assert_eq!(servos.told, [None, Some(-30)]);
        assert!(!servos.take(&Event::Transacted { id, result: Ok(Values::default()) }), "once");
        assert!(servos.turn(2).is_none());
        servos.forget();
        assert_eq!(servos.told, [None; 2]);
    }
}
