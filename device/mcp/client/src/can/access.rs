//! One access to an object of a node, over an exchange: frames out, frames of that node back, everything else passed by.

use crate::can::place::Place;
use brushwork_canopen::Function;
use brushwork_canopen::adapter::Decoder;
use brushwork_canopen::sdo::{Abort, Progress, Transfer};
use brushwork_link::device::controller::Line;
use brushwork_link::exchange::{ExchangeError, Judgement, Outgoing, Span, Tries};
use std::time::Duration;

/// Bytes of an answer in the shorter form, for the time it takes on a serial line.
const ANSWER_BYTES: usize = 23;

/// Reads an object.
pub fn read(
    line: &mut Line<'_>,
    place: Place,
    index: u16,
    subindex: u8,
) -> Result<(Vec<u8>, Span), ExchangeError> {
    run(line, place, &Transfer::upload(index, subindex), false, Duration::ZERO)
}

/// Writes an object that may be written twice.
pub fn write(
    line: &mut Line<'_>,
    place: Place,
    index: u16,
    subindex: u8,
    value: &[u8],
) -> Result<Span, ExchangeError> {
    run(line, place, &Transfer::download(index, subindex, value), false, Duration::ZERO).map(|(_, span)| span)
}

/// Runs an access to its end, from its beginning again after a fault as often as the line allows. With `once` it goes out once,
/// and a failure after that says that it may have been carried out.
pub fn run(
    line: &mut Line<'_>,
    place: Place,
    transfer: &Transfer,
    once: bool,
    patience: Duration,
) -> Result<(Vec<u8>, Span), ExchangeError> {
    let retries = if once { 0 } else { line.retries() };
    let mut tries = 0;
    loop {
        tries += 1;
        match attempt(line, place, &mut transfer.clone(), once, patience, Tries(tries)) {
            Err(error) if tries <= retries && may_try_again(&error) => {}
            end => return end,
        }
    }
}

fn may_try_again(error: &ExchangeError) -> bool {
    !error.is_link_lost() && error.interruption().is_none() && !matches!(error, ExchangeError::Refused { .. })
}

fn attempt(
    line: &mut Line<'_>,
    place: Place,
    transfer: &mut Transfer,
    once: bool,
    patience: Duration,
    tries: Tries,
) -> Result<(Vec<u8>, Span), ExchangeError> {
    let mut request = transfer.begin();
    let mut requested_at = None;
    loop {
        let bytes = place.request(request);
        let outgoing = Outgoing { bytes: &bytes, reply_length: ANSWER_BYTES, patience, retries: 0, once };
        let mut answer = None;
        let (exchange, watch) = line.parts();
        let mut listener = Listener { decoder: Decoder::new(place.form), heard: 0 };
        let span = exchange
            .exchange(&outgoing, watch, &mut |bytes| listener.judge(bytes, place, transfer, &mut answer))?;
        let begun_at = *requested_at.get_or_insert(span.requested_at);
        match answer {
            Some(Progress::Send(next)) => request = next,
            Some(Progress::Done(value)) => {
                return Ok((value, Span { requested_at: begun_at, replied_at: span.replied_at }));
            }
            Some(Progress::Refused(code)) => return Err(refused(code)),
            Some(Progress::GiveUp { bytes, code }) => {
                exchange.write_now(&place.request(bytes))?;
                return Err(ExchangeError::Malformed { what: code.text().to_owned(), tries });
            }
            Some(Progress::Passed) | None => {
                return Err(ExchangeError::Malformed { what: "it is no answer".to_owned(), tries });
            }
        }
    }
}

/// Finds the node's answer among all that comes from the adapter.
struct Listener {
    decoder: Decoder,
    heard: usize,
}

impl Listener {
    fn judge(
        &mut self,
        bytes: &[u8],
        place: Place,
        transfer: &mut Transfer,
        answer: &mut Option<Progress>,
    ) -> Judgement {
        while let Some(byte) = bytes.get(self.heard) {
            self.heard += 1;
            let Some(frame) = self.decoder.feed(*byte) else { continue };
            if Function::of(frame.id()) != Some(Function::SdoResponse(place.node)) {
                continue;
            }
            match transfer.take(frame.bytes()) {
                Progress::Passed => {}
                progress @ (Progress::Send(_)
                | Progress::Done(_)
                | Progress::Refused(_)
                | Progress::GiveUp { .. }) => {
                    *answer = Some(progress);
                    return Judgement::Good(self.heard);
                }
            }
        }
        Judgement::Elsewhere
    }
}

fn refused(code: Abort) -> ExchangeError {
    ExchangeError::Refused { what: code.to_string(), is_absent: code.is_absence() }
}
