//! One question or order to one unit and its report.

use crate::messages::SuprMotrCauseMessage;
use brushwork_link::Message;
use brushwork_link::device::controller::Line;
use brushwork_link::exchange::{ExchangeError, Fault, Judgement, Outgoing, Span};
use brushwork_suprmotr_wire::{
    Address, Command, Effect, EncodeError, ErrorCode, Line as Commands, Mnemonic, Progress, Radix, Report,
    Selection, Single, Status, operation, parse_report,
};
use std::time::Duration;

/// Time for the work behind a report. Assumed: the manual says nothing.
const WORK: Duration = Duration::from_millis(20);
/// The same for what writes EEPROM. Assumed.
const STORE_WORK: Duration = Duration::from_millis(600);
/// The same for a list of macros or commands: the time of its bytes at 9600 baud.
const LIST_WORK: Duration = Duration::from_millis(4500);
/// The shortest report: letter, colon, digit, its end.
const SHORTEST: usize = 6;

/// Who is spoken to and how.
#[derive(Clone, Copy, Debug)]
pub struct Speaker {
    pub address: Address,
    /// How its numbers are written, as its status says.
    pub radix: Radix,
}

impl Speaker {
    pub fn new(address: Address) -> Self {
        Self { address, radix: Radix::Decimal }
    }

    /// A command of one character, with the selection of its unit.
    pub fn single(self, single: Single) -> Vec<u8> {
        let mut bytes = Selection::Unit(self.address).bytes().to_vec();
        bytes.push(single.character());
        bytes
    }

    /// A line, with the selection of its unit.
    pub fn line(self, commands: &Commands) -> Result<Vec<u8>, ExchangeError> {
        let mut bytes = Selection::Unit(self.address).bytes().to_vec();
        bytes.extend(commands.encode(self.radix).map_err(|why| cannot(&why))?);
        Ok(bytes)
    }

    /// Asks by one character, which no macro and no wait minds.
    pub fn ask_single(
        &mut self,
        line: &mut Line<'_>,
        single: Single,
    ) -> Result<(Report, Span), ExchangeError> {
        let Some(mnemonic) = single.mnemonic() else {
            return Err(cannot(&EncodeError::Empty));
        };
        let retries = line.retries();
        let bytes = self.single(single);
        self.exchange(line, &bytes, &Command::plain(mnemonic), retries, WORK)
    }

    /// Reads the status, which takes the last error away.
    pub fn status(&mut self, line: &mut Line<'_>) -> Result<(Status, Span), ExchangeError> {
        let (report, span) = self.ask_single(line, Single::Status)?;
        let status = report.status().unwrap_or_default();
        self.note(status);
        Ok((status, span))
    }

    /// Ends the move at once by `!`, with `%` behind it.
    pub fn abort(&mut self, line: &mut Line<'_>) -> Result<(Status, Span), ExchangeError> {
        let mut bytes = self.single(Single::Abort);
        bytes.push(Single::Status.character());
        let retries = line.retries();
        let (report, span) = self.exchange(line, &bytes, &Command::plain(Mnemonic::TS), retries, WORK)?;
        let status = report.status().unwrap_or_default();
        self.note(status);
        Ok((status, span))
    }

    /// As [`Speaker::ask_single`], once and with so much time for the answer: is anybody there?
    pub fn probe(self, line: &mut Line<'_>, patience: Duration) -> Result<bool, ExchangeError> {
        let bytes = self.single(Single::Position);
        let asked = Command::plain(Mnemonic::TP);
        let (exchange, watch) = line.parts();
        let answered = exchange.exchange_within(&bytes, SHORTEST, patience, watch, &mut |heard| {
            // Its radix is not known yet.
            let read = |radix| parse_report(&asked, radix, &bytes, heard);
            match (read(Radix::Decimal), read(Radix::Hexadecimal)) {
                (Progress::Done { report, used }, _) | (_, Progress::Done { report, used })
                    if report.address.is_none_or(|address| address == self.address) =>
                {
                    Judgement::Good(used)
                }
                _ => Judgement::More(1),
            }
        });
        match answered {
            Ok(_) => Ok(true),
            Err(error) if error.is_link_lost() || error.interruption().is_some() => Err(error),
            Err(_) => Ok(false),
        }
    }

    /// Sends a command that reports, as a line.
    pub fn ask(&mut self, line: &mut Line<'_>, command: &Command) -> Result<(Report, Span), ExchangeError> {
        let bytes = self.line(&Commands::of(*command))?;
        let work = if command.row().effect == Effect::Report { WORK } else { STORE_WORK };
        let work = if is_list(command.mnemonic) { LIST_WORK } else { work };
        let retries = line.retries();
        self.exchange(line, &bytes, command, retries, work)
    }

    /// Sends commands that report nothing, as a line with `%` behind it, whose report says what became of them.
    pub fn order(
        &mut self,
        line: &mut Line<'_>,
        commands: &Commands,
    ) -> Result<(Status, Span), ExchangeError> {
        let mut bytes = self.line(commands)?;
        bytes.push(Single::Status.character());
        let effects = || commands.commands.iter().map(|command| command.row().effect);
        let is_lasting = commands.defines.is_some() || effects().any(|effect| effect == Effect::Lasting);
        let is_repeatable =
            effects().all(|effect| !matches!(effect, Effect::RelativeMotion | Effect::Run | Effect::Unknown));
        let retries = if is_repeatable { line.retries() } else { 0 };
        let work = if is_lasting { STORE_WORK } else { WORK };
        let asked = Command::plain(Mnemonic::TS);
        let outgoing =
            Outgoing { bytes: &bytes, reply_length: SHORTEST, patience: work, retries, once: !is_repeatable };
        // A unit that has just been given an address answers from there.
        let new_address = commands.commands.iter().find(|command| command.mnemonic == Mnemonic::DB);
        let answers_from = new_address
            .and_then(|command| Address::new(u8::try_from(command.number?).ok()?))
            .unwrap_or(self.address);
        let (report, span) = self.send(line, &outgoing, &asked, answers_from)?;
        let status = report.status().unwrap_or_default();
        self.note(status);
        match status.error {
            0 => Ok((status, span)),
            error => Err(refused(error)),
        }
    }

    fn exchange(
        &mut self,
        line: &mut Line<'_>,
        bytes: &[u8],
        asked: &Command,
        retries: u32,
        patience: Duration,
    ) -> Result<(Report, Span), ExchangeError> {
        let outgoing = Outgoing { bytes, reply_length: SHORTEST, patience, retries, once: false };
        self.send(line, &outgoing, asked, self.address)
    }

    fn send(
        &mut self,
        line: &mut Line<'_>,
        outgoing: &Outgoing<'_>,
        asked: &Command,
        answers_from: Address,
    ) -> Result<(Report, Span), ExchangeError> {
        let mut found = Report::default();
        let radix = self.radix;
        let (exchange, watch) = line.parts();
        let span = exchange.exchange(outgoing, watch, &mut |heard| match parse_report(
            asked,
            radix,
            outgoing.bytes,
            heard,
        ) {
            Progress::Incomplete => Judgement::More(1),
            Progress::Bad(bad) => Judgement::Bad(Fault::Malformed(bad.to_string())),
            Progress::Done { report, used } => match report.address {
                Some(other) if other != answers_from => {
                    let address = char::from(other.character());
                    let what = SuprMotrCauseMessage::OtherAnswered { address };
                    Judgement::Bad(Fault::Malformed(what.to_string()))
                }
                _ => {
                    found = report;
                    Judgement::Good(used)
                }
            },
        })?;
        Ok((found, span))
    }

    fn note(&mut self, status: Status) {
        let is_hexadecimal = status.operation & operation::HEXADECIMAL != 0;
        self.radix = if is_hexadecimal { Radix::Hexadecimal } else { Radix::Decimal };
    }

    /// Refuses a line while a macro or a wait is in process, which it would end. Its last error is gone afterwards.
    pub fn check_idle(&mut self, line: &mut Line<'_>, name: &'static str) -> Result<(), ExchangeError> {
        let (status, _) = self.status(line)?;
        if status.operation & (operation::MACRO | operation::WAIT) == 0 {
            return Ok(());
        }
        Err(ExchangeError::impossible(SuprMotrCauseMessage::MacroRuns { name }))
    }
}

/// What a unit says of a command that it did not take.
pub fn refused(error: u8) -> ExchangeError {
    let code = ErrorCode::from_number(error);
    let what = match code {
        Some(code) => SuprMotrCauseMessage::Disagrees { error, text: code.text() },
        None => SuprMotrCauseMessage::NotListed { error },
    };
    ExchangeError::Refused { what: what.to_string(), is_absent: code == Some(ErrorCode::NotAvailable) }
}

fn is_list(mnemonic: Mnemonic) -> bool {
    [Mnemonic::TM, Mnemonic::TZ, Mnemonic::HE].contains(&mnemonic)
}

pub fn cannot(source: &EncodeError) -> ExchangeError {
    ExchangeError::impossible(Message::error(source.clone()))
}
