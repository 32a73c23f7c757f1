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
use std::sync::Arc;
use std::time::Duration;

/// How long answers are listened to, beyond what the line takes.
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
    let heard = listened(line, bytes);
    if order == Order::Go {
        speaker.has_library = false;
    }
    heard
}

/// Sends bytes and gives what came back, which may be nothing: a program answers what it likes. One that goes on sending, as the host library
/// does twice a second, is listened to for no longer.
fn listened(line: &mut Line<'_>, bytes: &[u8]) -> Result<Vec<u8>, ExchangeError> {
    let mut heard = Vec::new();
    let outgoing = Outgoing { bytes, reply_length: 28, patience: LISTEN_FOR, retries: 0, once: true };
    let (exchange, watch) = line.parts();
    let clock = Arc::clone(exchange.clock());
    let until = clock.now() + LISTEN_FOR + exchange.longest_turnaround();
    let done = exchange.exchange(&outgoing, watch, &mut |bytes| {
        heard = bytes.to_vec();
        if clock.now() < until { Judgement::More(1) } else { Judgement::Good(bytes.len()) }
    });
    match done {
        Err(error) if error.is_link_lost() || error.interruption().is_some() => Err(error),
        Ok(_) | Err(_) => Ok(heard),
    }
}

/// Starts the program in the board's memory. Whatever it is, it has not answered yet.
pub fn start(speaker: &mut Speaker, line: &mut Line<'_>) -> Result<(), ExchangeError> {
    speaker.has_library = false;
    // The manual names no answer to it.
    listened(line, &[b'G', LINE_END]).map(drop)
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
