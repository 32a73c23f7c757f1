//! What a drive is in commands of a SuprMotr: a move to a place.
//!
//! A distance goes out as the place where it ends, so that nothing that carries a line out twice moves twice: neither a retry nor a carriage
//! return.

use crate::controller::unit::SuprMotr;
use crate::messages::SuprMotrCauseMessage;
use brushwork_link::Message;
use brushwork_link::device::controller::Line;
use brushwork_link::device::{Drive, DriveCommand};
use brushwork_link::exchange::ExchangeError;
use brushwork_suprmotr_wire::{
    Address, Command, FURTHEST_COUNTS, Line as Commands, Mnemonic, Radix, Selection, Single,
};

/// Where a drive goes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Goal {
    Position(i64),
    Distance(i64),
}

/// What a drive asks for. Speeds and ramps of moves are settings of the controller (DV, DA), so those of the drive are not looked at.
fn goal(drive: &Drive) -> Result<Goal, ExchangeError> {
    let (Some(wanted), None) = (drive.m1, drive.m2) else {
        return impossible(SuprMotrCauseMessage::OneMotor);
    };
    let goal = match wanted {
        DriveCommand::Position { position_counts, .. } => Goal::Position(position_counts.into()),
        DriveCommand::Distance { speed_counts_per_s, distance_counts, .. } => {
            let distance = i64::from(distance_counts);
            Goal::Distance(if speed_counts_per_s < 0 { -distance } else { distance })
        }
        DriveCommand::Duty { .. } | DriveCommand::Speed { .. } => {
            return impossible(SuprMotrCauseMessage::MovesAlone);
        }
    };
    match goal {
        // From the far end to the other is the longest way.
        Goal::Distance(counts) if counts.abs() > 2 * i64::from(FURTHEST_COUNTS) => too_far(counts),
        Goal::Position(counts) => place(counts).map(|_| goal),
        Goal::Distance(_) => Ok(goal),
    }
}

/// A position that the controller takes.
fn place(counts: i64) -> Result<i32, ExchangeError> {
    match i32::try_from(counts) {
        Ok(place) if place.abs() <= FURTHEST_COUNTS => Ok(place),
        Ok(_) | Err(_) => too_far(counts),
    }
}

fn too_far<T>(counts: i64) -> Result<T, ExchangeError> {
    impossible(SuprMotrCauseMessage::TooFar { counts })
}

/// Moves the motor.
pub fn drive(unit: &mut SuprMotr, line: &mut Line<'_>, drive: &Drive) -> Result<(), ExchangeError> {
    let goal = goal(drive)?;
    if !line.permit().motion {
        return Err(ExchangeError::NotArmed { command: Mnemonic::MA.row().title.to_owned() });
    }
    let target = match goal {
        Goal::Position(counts) => place(counts)?,
        Goal::Distance(counts) => {
            let (report, _) = unit.speaker.ask_single(line, Single::Position)?;
            place(i64::from(report.number(Mnemonic::TP).unwrap_or_default()) + counts)?
        }
    };
    unit.speaker.check_idle(line, Mnemonic::MA.name())?;
    line.motion_begins();
    unit.speaker.order(line, &Commands::of(Command::with(Mnemonic::MA, target))).map(drop)
}

/// Why a drive cannot be; `None` if it can.
pub fn objection(drive: &Drive) -> Option<Message> {
    goal(drive).err().map(Message::error)
}

/// The bytes of a drive. Those of a distance are known when it is known where the motor stands.
pub fn preview(drive: &Drive, address: u8, radix: Radix) -> Vec<Vec<u8>> {
    let bytes = || {
        let unit = Selection::Unit(Address::new(address)?);
        let Ok(Goal::Position(counts)) = goal(drive) else { return None };
        let line = Commands::of(Command::with(Mnemonic::MA, place(counts).ok()?)).encode(radix).ok()?;
        Some([unit.bytes().as_slice(), &line, &[Single::Status.character()]].concat())
    };
    bytes().into_iter().collect()
}

fn impossible<T>(what: SuprMotrCauseMessage) -> Result<T, ExchangeError> {
    Err(ExchangeError::impossible(what))
}
