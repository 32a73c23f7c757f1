//! The link of the bench to a simulated SuprMotr: the bytes that a client sends, in virtual time, at a baud rate, with latency, jitter and loss.

use super::population::BoardSpecimen;
use crate::line::{Bench, SimulatedLine};
use brushwork_plant::world::{WorldAction, WorldView};
use brushwork_suprmotr_axis::{Answer, SuprMotrCarrier, worked_at};
use brushwork_suprmotr_sim::SuprMotr;
use brushwork_suprmotr_wire::{
    Address, Command, Line, Mnemonic, Progress, Radix, Report, Reports, Selection, Single, parse_report,
};
use brushwork_tuning::axis::{AxisError, Exchange};
use std::time::Duration;

/// How long a report is waited for beyond its bytes.
const PATIENCE: Duration = Duration::from_millis(50);

/// By how much longer than the quickest an exchange is one with a retry, or a late one, as in the program.
const LATE: Duration = Duration::from_millis(12);

impl Bench for SuprMotr {
    fn time(&self) -> Duration {
        self.now()
    }

    fn pass(&mut self, to: Duration) {
        self.advance(to);
    }

    fn look(&self) -> WorldView {
        self.view()
    }

    fn undergo(&mut self, action: &WorldAction) {
        self.apply(action);
    }
}

/// A line to a board.
#[derive(Debug)]
pub struct BoardLine {
    /// The line beneath.
    pub line: SimulatedLine<SuprMotr>,
    byte_time: Duration,
    /// Of the readings of a position: one that took longer by [`LATE`] is not dated, and the program takes it for none.
    quickest: Option<Duration>,
}

impl BoardLine {
    /// The line of a plant, its board switched on half a second ago.
    #[must_use]
    pub fn new(specimen: &BoardSpecimen) -> Self {
        Self::of(specimen.controller(), specimen)
    }

    /// The same to a board that is set up otherwise.
    #[must_use]
    pub fn of(unit: SuprMotr, specimen: &BoardSpecimen) -> Self {
        let mut line = SimulatedLine::new(unit, specimen.link);
        line.idle(Duration::from_millis(500));
        let byte_time = Duration::from_secs_f64(10.0 / f64::from(specimen.unit.bits_per_second()));
        Self { line, byte_time, quickest: None }
    }

    /// Sends bytes and reads the report to a command. `up` of them are those up to the last of the command.
    fn exchange(
        &mut self,
        bytes: &[u8],
        up: usize,
        asked: Mnemonic,
    ) -> Result<(Exchange, Report), AxisError> {
        let line = &mut self.line;
        if line.is_stopped() {
            return Err(AxisError::Stopped);
        }
        let dead = line.is_dead();
        let (lost_request, lost_reply) = (line.is_lost() || dead, line.is_lost() || dead);
        let (there, back) = (line.latency(), line.latency());
        let sent = line.now;
        line.advance(sent + there);
        line.sent.push(bytes.to_vec());
        for byte in bytes {
            line.advance(line.now + self.byte_time);
            if !lost_request {
                line.unit.receive(&[*byte]);
            }
        }
        let deadline = line.now + PATIENCE;
        let mut heard = Vec::new();
        while let Some(leaves) = line.unit.next_output_at().filter(|at| *at <= deadline) {
            line.advance(leaves);
            heard.extend(line.unit.take_output().map(|(_, bytes)| bytes).unwrap_or_default());
            let Progress::Done { report, used } =
                parse_report(&Command::plain(asked), Radix::Decimal, bytes, &heard)
            else {
                continue;
            };
            let down = used.saturating_sub(bytes.len());
            line.advance(line.now + self.byte_time * u32::try_from(down).unwrap_or(u32::MAX) + back);
            if lost_reply {
                break;
            }
            line.read_late();
            if asked == Mnemonic::TP {
                let took = line.now.saturating_sub(sent);
                let least = self.quickest.map_or(took, |quickest| quickest.min(took));
                self.quickest = Some(least);
                if took > least + LATE {
                    return Err(AxisError::Late);
                }
            }
            let down = down + bytes.len() - up;
            let at = worked_at((sent, line.now), (up, down), self.byte_time);
            return Ok((at, report));
        }
        line.advance(deadline.max(line.now));
        while line.unit.take_output().is_some() {}
        Err(AxisError::NoReply)
    }

    /// The status, as a client asks for it before a line.
    fn check_idle(&mut self) -> Result<(), AxisError> {
        let bytes = single(&[Single::Status]);
        self.exchange(&bytes, bytes.len(), Mnemonic::TS).map(drop)
    }
}

fn single(singles: &[Single]) -> Vec<u8> {
    let selection = Selection::Unit(Address::FACTORY).bytes();
    selection.into_iter().chain(singles.iter().map(|single| single.character())).collect()
}

impl SuprMotrCarrier for BoardLine {
    fn transact(&mut self, command: Command) -> Result<(Exchange, Answer), AxisError> {
        let (bytes, up, asked) = match (command.mnemonic, command.number) {
            (Mnemonic::AB, None) => (single(&[Single::Abort, Single::Status]), 3, Mnemonic::TS),
            (Mnemonic::TS, _) => (single(&[Single::Status]), 3, Mnemonic::TS),
            (Mnemonic::TP, _) => (single(&[Single::Position]), 3, Mnemonic::TP),
            (mnemonic, _) => {
                self.check_idle()?;
                let line = Line::of(command).encode(Radix::Decimal);
                let line = line.map_err(|why| AxisError::Refused(why.to_string()))?;
                let mut bytes = [Selection::Unit(Address::FACTORY).bytes().as_slice(), &line].concat();
                let up = bytes.len();
                let reports = command.row().reports != Reports::Nothing;
                bytes.extend((!reports).then_some(Single::Status.character()));
                (bytes, up, if reports { mnemonic } else { Mnemonic::TS })
            }
        };
        let (at, report) = self.exchange(&bytes, up, asked)?;
        let answer = match report.status() {
            Some(status) if status.error != 0 => return Err(AxisError::Refused("the line".into())),
            Some(status) => Some(Answer::Status(status)),
            None => report.number(asked).map(Answer::Number),
        };
        answer.map(|answer| (at, answer)).ok_or(AxisError::NoReply)
    }

    fn now(&mut self) -> Duration {
        self.line.now
    }

    fn wait_until(&mut self, time: Duration) -> Result<(), AxisError> {
        self.line.wait(time)
    }

    fn stolen(&mut self) -> Duration {
        self.line.take_stolen()
    }
}
