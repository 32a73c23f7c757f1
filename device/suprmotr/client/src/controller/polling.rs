//! What is read from a unit in a sweep: by commands of one character alone, so that macros and waits go on.

use crate::controller::channels::{COMPUTED_TARGET, COMPUTED_VELOCITY};
use crate::controller::indicators::{INDICATORS, word_of};
use crate::controller::unit::SuprMotr;
use brushwork_link::device::controller::{Line, PollItem, PollList};
use brushwork_link::device::{Channel, Sample, StatusReport};
use brushwork_link::exchange::ExchangeError;
use brushwork_suprmotr_wire::{Mnemonic, Single};

const POSITION: PollItem = PollItem { id: 0, name: "position" };
const ERROR: PollItem = PollItem { id: 1, name: "following error" };
const STATUS: PollItem = PollItem { id: 2, name: "status" };

pub fn list() -> PollList {
    PollList { fast: vec![POSITION, ERROR, STATUS], slow: Vec::new(), status: Some(STATUS), signals: None }
}

/// Reads one item.
pub fn read(
    unit: &mut SuprMotr,
    line: &mut Line<'_>,
    item: PollItem,
    sample: &mut Sample,
) -> Result<Option<StatusReport>, ExchangeError> {
    if item == STATUS {
        let (status, span) = unit.speaker.status(line)?;
        let address = unit.identity.address;
        return Ok(Some(StatusReport::new(address, span.replied_at, word_of(status), INDICATORS)));
    }
    let (single, mnemonic) = match item {
        ERROR => (Single::FollowingError, Mnemonic::TF),
        _ => (Single::Position, Mnemonic::TP),
    };
    let (report, span) = unit.speaker.ask_single(line, single)?;
    let Some(counts) = report.number(mnemonic) else { return Ok(None) };
    let mut set = |channel, value| sample.set(channel, value, span.requested_at, span.replied_at);
    if mnemonic == Mnemonic::TF {
        set(Channel::M1_POSITION_ERROR, counts.into());
        if let Some((position, _)) = unit.last_position {
            set(COMPUTED_TARGET, f64::from(position) + f64::from(counts));
        }
        return Ok(None);
    }
    set(Channel::M1_POSITION, counts.into());
    let read_at = span.requested_at + span.replied_at.saturating_sub(span.requested_at) / 2;
    if let Some((before, at)) = unit.last_position
        && read_at > at
    {
        let moved = f64::from(counts) - f64::from(before);
        set(COMPUTED_VELOCITY, moved / read_at.saturating_sub(at).as_secs_f64());
    }
    unit.last_position = Some((counts, read_at));
    Ok(None)
}
