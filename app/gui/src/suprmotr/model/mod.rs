//! What a SuprMotr has of its own in the window: how far its slider goes, how far a step, its inputs and outputs, and its macros.

use std::time::Duration;

use brushwork_link::Failure;
use brushwork_link::device::{Drive, DriveCommand, Event, Identity, Request};
use brushwork_suprmotr_wire::FURTHEST_COUNTS;
use brushwork_values::Motor;

use crate::family::Own;
use crate::model::Connection;
use crate::model::setpoints::Setpoints;

pub mod board;
pub mod channels;
pub mod family;
pub mod home;
pub mod terminal;

use board::Board;
use channels::Channels;
use home::Home;
use terminal::Terminal;

/// The state of its screens.
#[derive(Debug)]
pub struct SuprMotrConnection {
    /// How far the slider goes either way, counts.
    pub span_counts: f64,
    /// What one press of a step button moves, counts.
    pub step_counts: f64,
    /// Its inputs and outputs.
    pub channels: Channels,
    /// The macros on it.
    pub board: Board,
    /// The way to its home position.
    pub home: Home,
    pub terminal: Terminal,
}

impl Default for SuprMotrConnection {
    fn default() -> Self {
        Self {
            span_counts: 25_000.0,
            step_counts: 500.0,
            channels: Channels::default(),
            board: Board::default(),
            home: Home::default(),
            terminal: Terminal::default(),
        }
    }
}

impl Own for SuprMotrConnection {
    fn take(&mut self, event: &Event) -> bool {
        self.terminal.note(event);
        let is_of_board = self.board.take(event);
        let is_of_home = self.home.take(event);
        self.channels.take(event) || is_of_board || is_of_home
    }

    fn read(&mut self, identity: &Identity, now: Duration) -> Option<Request> {
        self.channels.read(identity, now)
    }

    fn not_read(&mut self) {
        self.channels.not_sent();
    }

    fn not_transacted(&mut self) {
        self.channels.not_sent();
        self.home.not_sent();
    }

    fn refused(&mut self, id: u64, why: Failure) {
        self.home.refused_of(id, why.to_string());
    }

    fn rest(&mut self) {
        self.home.rest();
    }

    fn is_busy(&self) -> bool {
        self.board.is_busy()
    }

    fn forget_unit(&mut self) {
        self.board.forget();
        self.channels.forget();
        self.home.forget();
    }

    fn not_sent(&mut self, id: u64) {
        self.terminal.0.not_sent(id);
    }

    fn link_ended(&mut self) {
        self.terminal.0.link_ended();
        self.home.forget();
        self.board.forget();
        self.channels.forget();
    }
}

impl Connection {
    /// What is kept of a SuprMotr.
    pub fn suprmotr(&self) -> &SuprMotrConnection {
        self.own()
    }

    pub fn suprmotr_mut(&mut self) -> &mut SuprMotrConnection {
        self.own_mut()
    }

    /// Asks for a position within what the unit takes.
    pub fn move_suprmotr(&mut self, counts: f64) {
        let furthest = f64::from(FURTHEST_COUNTS);
        if counts.is_finite() {
            self.position.setpoints.set_one(Motor::M1, counts.clamp(-furthest, furthest));
        }
    }

    /// Asks for a position so far from the one asked for last, or from where the motor is.
    pub fn step_suprmotr(&mut self, counts: f64) {
        let from = self.position.setpoints.values[0];
        self.move_suprmotr(from + counts);
    }
}

/// What the unit has to be told for a slider that stands so, if anything. Its speed on the way is a setting of its own (DV).
fn to_send(setpoints: Setpoints) -> Option<Drive> {
    setpoints.to_send(|_, value| {
        Some(DriveCommand::Position {
            position_counts: value.round() as i32,
            speed_counts_per_s: 0,
            accel_counts_per_s2: 0,
            decel_counts_per_s2: 0,
            queued: false,
        })
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn steps_add_up_and_stay_within_what_the_unit_takes() {
        let mut connection = Connection::default();
        connection.step_suprmotr(500.0);
        connection.step_suprmotr(500.0);
        assert_eq!(connection.position.setpoints.values[0], 1000.0);
        connection.move_suprmotr(2e9);
        let there = DriveCommand::Position {
            position_counts: FURTHEST_COUNTS,
            speed_counts_per_s: 0,
            accel_counts_per_s2: 0,
            decel_counts_per_s2: 0,
            queued: false,
        };
        assert_eq!(to_send(connection.position.setpoints), Some(Drive::one(Motor::M1, there)));
    }
}
