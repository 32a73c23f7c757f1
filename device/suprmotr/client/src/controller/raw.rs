//! Bytes as a person typed them: characters, and one line at the most, checked before they go out.
//!
//! A carriage return alone is never sent, since it repeats the last line, nor is a selection of other units. What is no command of the manual
//! goes to simulated units alone.

use crate::controller::speaker::Speaker;
use crate::messages::SuprMotrCauseMessage;
use brushwork_link::device::controller::Line;
use brushwork_link::exchange::{ExchangeError, Judgement, Outgoing};
use brushwork_suprmotr_wire::{
    Command, Effect, Mnemonic, Parsed, Progress, Reader, Received, Reports, Selection, echo_length,
    parse_line, parse_report,
};
use std::time::Duration;

/// How long bytes that answer nothing known are listened to.
const LISTEN_FOR: Duration = Duration::from_millis(150);
/// A list of macros takes this long at 9600 baud.
const LIST_FOR: Duration = Duration::from_millis(4500);

/// What typed bytes are.
#[derive(Debug)]
pub struct Typed {
    bytes: Vec<u8>,
    parsed: Parsed,
    /// What is to be reported last, if anything is.
    asked: Option<Command>,
    is_known: bool,
}

impl Typed {
    /// The commands of its line.
    pub fn commands(&self) -> &[Command] {
        &self.parsed.line.commands
    }

    /// Whether a command of the line runs now; those of a macro do when it is called.
    fn may_move(&self) -> bool {
        self.moving().next().is_some()
    }

    /// Whether nothing of it moves but macros that it runs.
    fn runs_macros_alone(&self) -> bool {
        self.moving().all(|effect| effect == Effect::Run)
    }

    fn moving(&self) -> impl Iterator<Item = Effect> {
        let effects = self.commands().iter().map(|command| command.row().effect);
        effects.filter(|effect| self.parsed.line.defines.is_none() && effect.may_move())
    }
}

/// Looks at bytes before they go out. Refuses what must not be sent at all.
pub fn look(bytes: &[u8], speaker: Speaker) -> Result<Typed, ExchangeError> {
    let mut reader = Reader::new();
    let mut typed = Typed {
        bytes: Selection::Unit(speaker.address).bytes().to_vec(),
        parsed: Parsed::default(),
        asked: None,
        is_known: true,
    };
    let mut lines = 0;
    let mut open = false;
    for byte in bytes {
        let found = reader.feed(*byte, true);
        open = found.is_none();
        match found {
            Some(Received::Repeat) => return impossible(SuprMotrCauseMessage::NeverRepeat),
            Some(Received::Selection(selection)) if selection != Selection::Unit(speaker.address) => {
                return impossible(SuprMotrCauseMessage::OtherUnit);
            }
            Some(Received::Selection(_)) | None => {}
            Some(Received::Single(single)) => {
                typed.asked = single.mnemonic().map(Command::plain).filter(reports);
            }
            Some(Received::Line(line)) => {
                lines += 1;
                typed.parsed = parse_line(&line, speaker.radix);
                typed.asked = typed.commands().iter().rev().find(|command| reports(command)).copied();
                typed.is_known &= typed.parsed.error.is_none();
            }
        }
    }
    // Half a line would wait for its end in the unit's buffer.
    if lines > 1 || open || bytes.is_empty() {
        return impossible(SuprMotrCauseMessage::OneLine);
    }
    typed.bytes.extend_from_slice(bytes);
    Ok(typed)
}

fn reports(command: &Command) -> bool {
    command.row().reports != Reports::Nothing
}

/// Sends typed bytes and gives what came back, whatever it was, without the echo of the selection that was put in front.
pub fn send(speaker: &mut Speaker, line: &mut Line<'_>, typed: &Typed) -> Result<Vec<u8>, ExchangeError> {
    gate(line, typed)?;
    let mut heard = Vec::new();
    let is_list =
        typed.asked.is_some_and(|asked| matches!(asked.row().reports, Reports::Macros | Reports::Text));
    let patience = if is_list { LIST_FOR } else { LISTEN_FOR };
    let outgoing = Outgoing { bytes: &typed.bytes, reply_length: 8, patience, retries: 0, once: true };
    let radix = speaker.radix;
    let (exchange, watch) = line.parts();
    let done = exchange.exchange(&outgoing, watch, &mut |bytes| {
        heard = bytes.to_vec();
        let whole = typed.asked.map(|asked| parse_report(&asked, radix, &typed.bytes, bytes));
        match whole {
            Some(Progress::Done { used, .. }) if used == bytes.len() => Judgement::Good(used),
            _ => Judgement::More(1),
        }
    });
    match done {
        Ok(_) => {}
        Err(error) if error.is_link_lost() || error.interruption().is_some() => return Err(error),
        // Silence is an answer too: most commands report nothing.
        Err(_) => {}
    }
    // How its numbers are written may be otherwise now.
    if typed.commands().iter().any(|command| [Mnemonic::DM, Mnemonic::HM].contains(&command.mnemonic)) {
        speaker.status(line)?;
    }
    let selection = Selection::Unit(speaker.address).bytes();
    let echo = echo_length(&selection, &heard);
    Ok(heard.split_off(echo.min(heard.len())))
}

fn gate(line: &Line<'_>, typed: &Typed) -> Result<(), ExchangeError> {
    if !typed.is_known && !line.permit().guesses {
        return Err(ExchangeError::Unproven {
            command: "this line".to_owned(),
            why: typed.parsed.error.map(|error| error.to_string()).unwrap_or_default(),
        });
    }
    if typed.may_move() {
        let may = line.permit().motion || line.permit().script && typed.runs_macros_alone();
        if !may {
            return Err(ExchangeError::NotArmed { command: "a command that may move the motor".to_owned() });
        }
        line.motion_begins();
    }
    Ok(())
}

fn impossible<T>(what: SuprMotrCauseMessage) -> Result<T, ExchangeError> {
    Err(ExchangeError::impossible(what))
}
