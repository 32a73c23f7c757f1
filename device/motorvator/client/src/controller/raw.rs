//! Bytes as a person typed them: one line, checked before it goes out.
//!
//! Data goes to whatever program runs. The host library's questions do nothing, its orders may move a motor; any other program may make
//! anything of them, so that they need what a start of a program needs.

use crate::controller::speaker::Speaker;
use crate::messages::MotorvatorCauseMessage;
use brushwork_link::device::controller::Line;
use brushwork_link::exchange::{ExchangeError, Judgement, Outgoing};
use brushwork_motorvator_wire::host::HostOrder;
use brushwork_motorvator_wire::{LINE_END, Order};
use std::time::Duration;

/// How long answers are listened to.
const LISTEN_FOR: Duration = Duration::from_millis(250);

/// What typed bytes are.
pub fn look(bytes: &[u8]) -> Result<Order, ExchangeError> {
    let line = bytes.strip_suffix(&[LINE_END]).filter(|line| !line.contains(&LINE_END));
    line.and_then(Order::of_line).ok_or_else(|| ExchangeError::impossible(MotorvatorCauseMessage::OneLine))
}

/// Sends typed bytes and gives what came back, whatever it was.
pub fn send(speaker: &mut Speaker, line: &mut Line<'_>, bytes: &[u8]) -> Result<Vec<u8>, ExchangeError> {
    let order = look(bytes)?;
    gate(*speaker, line, &order)?;
    let mut heard = Vec::new();
    let outgoing = Outgoing { bytes, reply_length: 28, patience: LISTEN_FOR, retries: 0, once: true };
    let (exchange, watch) = line.parts();
    let done = exchange.exchange(&outgoing, watch, &mut |bytes| {
        heard = bytes.to_vec();
        Judgement::More(1)
    });
    if order == Order::Go {
        speaker.has_library = false;
    }
    match done {
        Err(error) if error.is_link_lost() || error.interruption().is_some() => Err(error),
        // Silence is an answer too: a program answers what it likes.
        Ok(_) | Err(_) => Ok(heard),
    }
}

/// Starts the program in the board's memory. Whatever it is, it has not answered yet.
pub fn start(speaker: &mut Speaker, line: &mut Line<'_>) -> Result<(), ExchangeError> {
    speaker.has_library = false;
    let bytes = [b'G', LINE_END];
    let outgoing = Outgoing { bytes: &bytes, reply_length: 28, patience: LISTEN_FOR, retries: 0, once: true };
    let (exchange, watch) = line.parts();
    match exchange.exchange(&outgoing, watch, &mut |_| Judgement::More(1)) {
        Err(error) if error.is_link_lost() || error.interruption().is_some() => Err(error),
        // The manual names no answer to it.
        Ok(_) | Err(_) => Ok(()),
    }
}

fn gate(speaker: Speaker, line: &Line<'_>, order: &Order) -> Result<(), ExchangeError> {
    let permit = line.permit();
    let needs_arming = |command: String| Err(ExchangeError::NotArmed { command });
    match order {
        Order::Help | Order::Ignored => Ok(()),
        Order::Unknown if permit.guesses => Ok(()),
        Order::Unknown => {
            Err(ExchangeError::Unproven { command: "this line".to_owned(), why: Order::Unknown.describe() })
        }
        Order::Go if permit.script => {
            line.motion_begins();
            Ok(())
        }
        Order::Go => needs_arming(order.describe()),
        Order::Data(frame) => match HostOrder::parse(frame) {
            Some((order, _)) if speaker.has_library => {
                if order.may_move() {
                    if !permit.motion {
                        return needs_arming(order.to_string());
                    }
                    line.motion_begins();
                }
                Ok(())
            }
            _ if permit.script => {
                line.motion_begins();
                Ok(())
            }
            _ => needs_arming(order.describe()),
        },
    }
}
