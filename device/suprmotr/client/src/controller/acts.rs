//! What the device thread asks of a SuprMotr, each act in its file.

use crate::controller::traffic::{describe_received, describe_sent};
use crate::controller::unit::SuprMotr;
use crate::controller::values::{
    FOLLOWING_ERROR, FOLLOWING_ERROR_FIELD, RESTART, command_of, status_values, values_of,
};
use crate::controller::{SuprMotrFacts, arming, driving, polling, raw, stopping};
use crate::messages::SuprMotrCauseMessage;
use brushwork_link::Message;
use brushwork_link::device::controller::{ArmCheck, Controller, Line, PollItem, PollList};
use brushwork_link::device::{Described, Drive, Identity, Sample, StatusReport, StopBytes, UnitStop};
use brushwork_link::exchange::{ExchangeError, Reply as Answer};
use brushwork_link::transport::Stream;
use brushwork_suprmotr_wire::{
    Address, Command, Effect, Line as Commands, Mnemonic, Radix, Reports, Selection, Single,
};
use brushwork_values::{Motor, Value, Values};

impl Controller for SuprMotr {
    fn identity(&self) -> &Identity {
        &self.identity
    }

    fn poll_list(&self) -> PollList {
        polling::list()
    }

    fn poll(
        &mut self,
        line: &mut Line<'_>,
        item: PollItem,
        sample: &mut Sample,
    ) -> Result<Option<StatusReport>, ExchangeError> {
        polling::read(self, line, item, sample)
    }

    fn drive(&mut self, line: &mut Line<'_>, drive: &Drive) -> Result<(), ExchangeError> {
        driving::drive(self, line, drive)
    }

    fn stop_bytes(&self, _scripts: bool) -> StopBytes {
        stopping::bytes(Selection::Unit(self.speaker.address))
    }

    fn confirm_stop(&mut self, line: &mut Line<'_>, _scripts: bool) -> Result<UnitStop, ExchangeError> {
        stopping::confirm(self, line)
    }

    fn other_drivers(&mut self, line: &mut Line<'_>) -> Result<Vec<Message>, ExchangeError> {
        stopping::other_drivers(self, line)
    }

    fn has_timeout(&self) -> bool {
        false
    }

    fn check_arming(
        &mut self,
        line: &mut Line<'_>,
        _stream: Option<Stream>,
    ) -> Result<ArmCheck, ExchangeError> {
        arming::check(self, line)
    }

    fn set_encoder(&mut self, line: &mut Line<'_>, motor: Motor, counts: i32) -> Result<(), ExchangeError> {
        match (motor, counts) {
            (Motor::M2, _) => impossible(SuprMotrCauseMessage::SecondMotor),
            (Motor::M1, 0) => self.carry_out(line, Command::plain(Mnemonic::DH)).map(drop),
            (Motor::M1, _) => impossible(SuprMotrCauseMessage::ZeroAlone),
        }
    }

    fn transact(
        &mut self,
        line: &mut Line<'_>,
        command: u8,
        values: Vec<Value>,
    ) -> Result<Answer, ExchangeError> {
        let raw: Vec<i64> = values.iter().filter_map(Value::as_int).collect();
        match command {
            FOLLOWING_ERROR => return self.following_error(line),
            RESTART => return self.restart(line),
            _ => {}
        }
        let Some(command) = command_of(command, &raw) else {
            return impossible(SuprMotrCauseMessage::NoCommand { command, count: raw.len() });
        };
        self.carry_out(line, command)
    }

    fn raw(&mut self, line: &mut Line<'_>, bytes: &[u8]) -> Result<Vec<u8>, ExchangeError> {
        let typed = raw::look(bytes, self.speaker)?;
        let heard = raw::send(&mut self.speaker, line, &typed)?;
        self.note(typed.commands());
        Ok(heard)
    }

    fn raw_undermines_arming(&self, bytes: &[u8]) -> bool {
        raw::look(bytes, self.speaker)
            .is_ok_and(|typed| typed.commands().iter().any(|command| undermines(command.mnemonic)))
    }

    fn set_address(&mut self, address: u8) -> bool {
        let Some(new) = Address::new(address) else { return false };
        self.speaker.address = new;
        self.identity.address = address;
        true
    }

    fn can_move(&self, command: u8) -> bool {
        Mnemonic::from_number(command).is_some_and(|mnemonic| mnemonic.row().effect.may_move())
    }

    fn undermines_arming(&self, command: u8) -> bool {
        if command == RESTART {
            return true;
        }
        let known = command_of(command, &[0]).or_else(|| command_of(command, &[]));
        Mnemonic::from_number(command).or(known.map(|command| command.mnemonic)).is_some_and(undermines)
    }

    fn describe_traffic(&self, request: &[u8], reply: Option<&[u8]>) -> Described {
        let radix = SuprMotrFacts::of(&self.identity).map_or(Radix::Decimal, SuprMotrFacts::radix);
        match reply {
            None => describe_sent(request, radix),
            Some(reply) => describe_received(request, reply, radix),
        }
    }
}

impl SuprMotr {
    /// Sends one command: by its character where it has one, so that macros go on (AB without its number is `!`); else as a line, which is not sent while a macro or a wait
    /// is in process, but where it is to end it.
    fn carry_out(&mut self, line: &mut Line<'_>, command: Command) -> Result<Answer, ExchangeError> {
        let row = command.row();
        if command == Command::plain(Mnemonic::AB) {
            let (status, span) = self.speaker.abort(line)?;
            return Ok(Answer { values: status_values(status), span });
        }
        let by_character = Single::ALL.into_iter().find(|single| {
            single.mnemonic() == Some(command.mnemonic)
                && row.effect == Effect::Report
                && command.number.is_none()
        });
        if let Some(single) = by_character {
            let (report, span) = self.speaker.ask_single(line, single)?;
            return Ok(Answer { values: values_of(&report), span });
        }
        if row.effect.may_move() && !line.permit().motion {
            return Err(ExchangeError::NotArmed { command: row.title.to_owned() });
        }
        if row.effect != Effect::Stop {
            self.speaker.check_idle(line, row.name)?;
        }
        if row.effect.may_move() {
            line.motion_begins();
        }
        if row.reports != Reports::Nothing {
            let (report, span) = self.speaker.ask(line, &command)?;
            return Ok(Answer { values: values_of(&report), span });
        }
        let (status, span) = self.speaker.order(line, &Commands::of(command))?;
        self.note(&[command]);
        Ok(Answer { values: status_values(status), span })
    }

    /// Starts the unit anew, where no macro 0 would run then. It says nothing to that, and is no longer selected.
    fn restart(&mut self, line: &mut Line<'_>) -> Result<Answer, ExchangeError> {
        self.speaker.check_idle(line, Mnemonic::RT.name())?;
        let (report, span) = self.speaker.ask(line, &Command::plain(Mnemonic::TZ))?;
        if !report.lines.is_empty() {
            return impossible(SuprMotrCauseMessage::MacroZero);
        }
        let restart = Command::plain(Mnemonic::RT);
        let bytes = self.speaker.line(&Commands::of(restart))?;
        line.exchange().write_now(&bytes)?;
        self.note(&[restart]);
        Ok(Answer { values: Values::default(), span })
    }

    /// The limit of the following error as it was last set here. The unit is asked whether it is there.
    fn following_error(&mut self, line: &mut Line<'_>) -> Result<Answer, ExchangeError> {
        let (_, span) = self.speaker.status(line)?;
        let Some(counts) = self.following_error else {
            return Err(ExchangeError::Untold { what: SuprMotrCauseMessage::SmUntold.into() });
        };
        Ok(Answer { values: Values::new(&FOLLOWING_ERROR_FIELD, vec![Value::Int(counts.into())]), span })
    }
}

/// Whether a command takes away what arming has found: the hold of the motor, its limits, the meaning of its positions, the unit itself.
fn undermines(mnemonic: Mnemonic) -> bool {
    [Mnemonic::RT, Mnemonic::MF, Mnemonic::LF, Mnemonic::LL, Mnemonic::LH, Mnemonic::DH, Mnemonic::DB]
        .contains(&mnemonic)
}

fn impossible<T>(what: SuprMotrCauseMessage) -> Result<T, ExchangeError> {
    Err(ExchangeError::impossible(what))
}
