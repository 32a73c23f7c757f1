//! Which registers a firmware answers: a read that nothing comes to is told from a lost reply, and is not asked for again.

use crate::controller::registers::mask;
use crate::controller::speaker::Speaker;
use brushwork_link::device::controller::Line;
use brushwork_link::exchange::{ExchangeError, Span, Tries};
use brushwork_motion_mind_wire::{Command, Reply, register, register_number as number};
use std::time::Duration;

impl Speaker {
    /// Sends a command and gives what came back. Registers that this firmware is known to lack are not asked for.
    pub fn ask(&mut self, line: &mut Line<'_>, command: &Command) -> Result<(Reply, Span), ExchangeError> {
        let command = self.in_own_words(command);
        self.gate(line, &command)?;
        ask(self, line, &command)
    }
}

fn ask(
    speaker: &mut Speaker,
    line: &mut Line<'_>,
    command: &Command,
) -> Result<(Reply, Span), ExchangeError> {
    let Some(wanted) = wanted(command).filter(|_| can_be_learned(speaker, line)) else {
        return speaker.send(line, command);
    };
    let lacking = numbers(wanted)
        .filter(|register| line.exchange().capabilities().lacks(speaker.address.get(), *register))
        .fold(0, |lacking, register| lacking | mask(&[register]));
    if wanted & !lacking == 0 {
        return Err(absent(numbers(wanted).next().unwrap_or_default()));
    }
    let is_mask = matches!(command, Command::Read(_));
    let narrowed = if is_mask { Command::Read(wanted & !lacking) } else { *command };
    let retries_before = line.exchange().retries();
    match speaker.send(line, &narrowed) {
        Ok((reply, span)) => {
            let again = line.exchange().retries() - retries_before;
            note(speaker, line, &reply, span, u32::try_from(again).unwrap_or(u32::MAX));
            Ok((reply, span))
        }
        // While the motor may run, nothing is asked only in order to learn.
        Err(error) => {
            let Some(tries) = in_vain(&error).filter(|_| !line.permit().motion) else { return Err(error) };
            if !is_there(speaker, line)? {
                return Err(error);
            }
            match single(&narrowed) {
                Some(register) => Err(judge(speaker, line, register, tries).unwrap_or(error)),
                None => one_by_one(speaker, line, &narrowed).unwrap_or(Err(error)),
            }
        }
    }
}

/// How often a read was asked that nothing came to, or by text the word that it is none.
#[allow(clippy::wildcard_enum_match_arm, reason = "one answer for all the rest, new members too")]
fn in_vain(error: &ExchangeError) -> Option<Tries> {
    match error {
        ExchangeError::TimedOut { heard: 0, tries, .. } | ExchangeError::NotUnderstood { tries, .. } => {
            Some(*tries)
        }
        _ => None,
    }
}

/// The registers that a read names; `None` where it names none that are known.
fn wanted(command: &Command) -> Option<u32> {
    Some(command.named_registers()).filter(|registers| *registers != 0)
}

fn single(command: &Command) -> Option<u8> {
    wanted(command).filter(|wanted| wanted.is_power_of_two()).and_then(|wanted| numbers(wanted).next())
}

fn numbers(wanted: u32) -> impl Iterator<Item = u8> {
    (0..32_u8).filter(move |bit| wanted >> bit & 1 == 1)
}

fn can_be_learned(speaker: &Speaker, line: &mut Line<'_>) -> bool {
    !speaker.is_loose && !line.is_stopping() && line.exchange().capabilities().knows(speaker.address.get())
}

fn note(speaker: &Speaker, line: &mut Line<'_>, reply: &Reply, span: Span, again: u32) {
    let Reply::Registers(registers) = reply else { return };
    let took: Duration = span.replied_at.saturating_sub(span.requested_at);
    for (index, (register, _)) in registers.iter().enumerate() {
        let lost = if index == 0 { again } else { 0 };
        line.exchange().capabilities().answered(speaker.address.get(), *register, took, lost);
    }
}

/// Whether the unit answers what every revision has.
fn is_there(speaker: &mut Speaker, line: &mut Line<'_>) -> Result<bool, ExchangeError> {
    match speaker.send(line, &speaker.in_own_words(&Command::ReadRegister(number::REVISION))) {
        Ok(_) => Ok(true),
        Err(error) if error.is_link_lost() || error.interruption().is_some() => Err(error),
        Err(_) => Ok(false),
    }
}

/// What a silent register is called, once it is known to be lacking.
fn judge(speaker: &Speaker, line: &mut Line<'_>, register: u8, tries: Tries) -> Option<ExchangeError> {
    let is_lacking = line.exchange().capabilities().silent(speaker.address.get(), register, tries.0);
    is_lacking.then(|| absent(register))
}

/// Reads each register alone where a read of several was not answered; `None` where none of them was.
fn one_by_one(
    speaker: &mut Speaker,
    line: &mut Line<'_>,
    command: &Command,
) -> Option<Result<(Reply, Span), ExchangeError>> {
    let mut read = Vec::new();
    let mut whole: Option<Span> = None;
    for register in numbers(wanted(command)?) {
        match ask(speaker, line, &speaker.in_own_words(&Command::ReadRegister(register))) {
            Ok((Reply::Registers(registers), span)) => {
                read.extend(registers);
                let begun = whole.map_or(span.requested_at, |whole| whole.requested_at);
                whole = Some(Span { requested_at: begun, ..span });
            }
            Err(error) if error.is_link_lost() || error.interruption().is_some() => return Some(Err(error)),
            Ok(_) | Err(_) => {}
        }
    }
    whole.map(|span| Ok((Reply::Registers(read), span)))
}

fn absent(register_number: u8) -> ExchangeError {
    let name = register(register_number).map_or("", |row| row.name);
    ExchangeError::Absent { command: format!("read {name}") }
}
