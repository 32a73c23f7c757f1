//! Whether motion may be allowed: only while the host library answers, since nothing else on the board takes orders, and its dead-man stops the
//! motors when this program dies.

use crate::controller::unit::Board;
use crate::messages::{
    MotorvatorActMessage, MotorvatorCauseMessage, MotorvatorDriverMessage, MotorvatorRemedyMessage,
};
use brushwork_link::device::controller::{ArmCheck, Line};
use brushwork_link::exchange::ExchangeError;
use brushwork_link::failure::Failure;
use brushwork_motorvator_wire::host::{HostOrder, VERSION};
use std::time::Duration;

/// The dead-man of the library: 32 ticks of 1/128 s.
pub const DEAD_MAN: Duration = Duration::from_millis(250);

/// Asks the library whether it is there, in the version that this program knows.
pub fn check(board: &mut Board, line: &mut Line<'_>) -> Result<ArmCheck, ExchangeError> {
    let on = board.name(line);
    if !board.speaker.has_library {
        board.speaker.look(line)?;
    }
    let answers = match board.speaker.ask(line, &HostOrder::Ping) {
        Ok((answer, _)) => answer.version() == Some(VERSION),
        Err(error) if error.is_link_lost() || error.interruption().is_some() => return Err(error),
        Err(_) => false,
    };
    if answers {
        let warnings =
            vec![MotorvatorDriverMessage::NoEncoder.into(), MotorvatorDriverMessage::Coasts.into()];
        return Ok(ArmCheck { reasons: Vec::new(), controller_timeout: Some(DEAD_MAN), warnings });
    }
    board.speaker.has_library = false;
    let reason = Failure::new(
        MotorvatorActMessage::Arm,
        on,
        MotorvatorCauseMessage::NoLibrary,
        MotorvatorRemedyMessage::RunLibrary,
    );
    Ok(ArmCheck { reasons: vec![reason], controller_timeout: None, warnings: Vec::new() })
}
