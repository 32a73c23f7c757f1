//! What the device thread asks of a Motion Mind, each act in its file.

use crate::controller::MotionMindFacts;
use crate::controller::borrowed::Borrowed;
use crate::controller::traffic::{describe_received, describe_sent};
use crate::controller::unit::MotionMind;
use crate::controller::{arming, driving, inquiry, polling, raw, stopping};
use crate::messages::MotionMindCauseMessage;
use brushwork_link::device::Described;
use brushwork_link::device::Drive;
use brushwork_link::device::Identity;
use brushwork_link::device::Sample;
use brushwork_link::device::StatusReport;
use brushwork_link::device::controller::{ArmCheck, Controller, Line, PollItem, PollList};
use brushwork_link::device::{Heard, Inquiry};
use brushwork_link::device::{StopBytes, UnitStop};
use brushwork_link::exchange::{ExchangeError, Reply as Answer};
use brushwork_link::settings::SettingsImage;
use brushwork_link::transport::Stream;
use brushwork_motion_mind_wire::{
    Address, Command, Effect, Reply, fields, numbers, register_number as number,
};
use brushwork_values::{Motor, Value, Values};

impl Controller for MotionMind {
    fn identity(&self) -> &Identity {
        &self.identity
    }

    fn poll_list(&self) -> PollList {
        polling::list(self.speaker.protocol)
    }

    fn poll(
        &mut self,
        line: &mut Line<'_>,
        item: PollItem,
        sample: &mut Sample,
    ) -> Result<Option<StatusReport>, ExchangeError> {
        polling::read(&mut self.speaker, MotionMindFacts::of(&self.identity), line, item, sample)
    }

    fn drive(&mut self, line: &mut Line<'_>, drive: &Drive) -> Result<(), ExchangeError> {
        let command = driving::command(self.mode(), drive)?;
        self.speaker.ask(line, &command).map(drop)
    }

    fn stop_bytes(&self, _scripts: bool) -> StopBytes {
        stopping::bytes(&self.speaker, self.mode(), self.ramp)
    }

    fn confirm_stop(&mut self, line: &mut Line<'_>, _scripts: bool) -> Result<UnitStop, ExchangeError> {
        stopping::confirm(self, line)
    }

    fn other_drivers(&mut self, line: &mut Line<'_>) -> Result<Vec<brushwork_link::Message>, ExchangeError> {
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

    fn lends(&self) -> SettingsImage {
        self.lends.into_iter().map(Borrowed::setting).collect()
    }

    fn lent(&self) -> SettingsImage {
        self.borrowed.iter().copied().map(Borrowed::setting).collect()
    }

    fn set_encoder(&mut self, line: &mut Line<'_>, motor: Motor, counts: i32) -> Result<(), ExchangeError> {
        if motor == Motor::M2 {
            return impossible(MotionMindCauseMessage::SecondMotor);
        }
        let command = Command::Write { register: number::POSITION, value: counts.into() };
        self.speaker.ask(line, &command).map(drop)
    }

    fn transact(
        &mut self,
        line: &mut Line<'_>,
        command: u8,
        values: Vec<Value>,
    ) -> Result<Answer, ExchangeError> {
        let raw: Vec<i64> = values.iter().filter_map(Value::as_int).collect();
        let Some(command) = Command::from_parts(command, &raw) else {
            return impossible(MotionMindCauseMessage::NoCommand { command, count: raw.len() });
        };
        let (reply, span) = self.speaker.ask(line, &command)?;
        self.note(&command);
        Ok(Answer { values: values_of(&command, &reply), span })
    }

    fn raw(&mut self, line: &mut Line<'_>, bytes: &[u8]) -> Result<Vec<u8>, ExchangeError> {
        let typed = raw::look(bytes, self.speaker.protocol)?;
        let heard = raw::send(self.speaker, line, bytes, &typed)?;
        if let raw::Typed::Command(address, command) = typed
            && (address == self.speaker.address || address.is_broadcast())
        {
            self.note(&command);
        }
        Ok(heard)
    }

    fn inquire(&mut self, line: &mut Line<'_>, asked: &Inquiry<'_>) -> Result<Heard, ExchangeError> {
        inquiry::inquire(self.speaker, line, asked)
    }

    fn raw_undermines_arming(&self, bytes: &[u8]) -> bool {
        match raw::look(bytes, self.speaker.protocol) {
            Ok(raw::Typed::Command(_, command)) => command.effect() == Effect::Stopping,
            _ => false,
        }
    }

    fn set_address(&mut self, address: u8) -> bool {
        let Some(new) = Address::unit(address) else { return false };
        self.speaker.address = new;
        self.identity.address = address;
        true
    }

    fn can_move(&self, command: u8) -> bool {
        matches!(effect(command), Some(Effect::Motion | Effect::RelativeMotion))
    }

    fn undermines_arming(&self, command: u8) -> bool {
        matches!(effect(command), Some(Effect::Stopping))
    }

    fn describe_traffic(&self, request: &[u8], reply: Option<&[u8]>) -> Described {
        match reply {
            None => describe_sent(request, self.speaker.protocol),
            Some(reply) => describe_received(request, reply, self.speaker.protocol),
        }
    }
}

fn impossible<T>(what: MotionMindCauseMessage) -> Result<T, ExchangeError> {
    Err(ExchangeError::impossible(what))
}

fn effect(command: u8) -> Option<Effect> {
    use numbers as n;
    Some(match command {
        n::CHANGE_SPEED | n::MOVE_TO_ABSOLUTE | n::MOVE_AT_VELOCITY => Effect::Motion,
        n::MOVE_TO_RELATIVE => Effect::RelativeMotion,
        n::WRITE => Effect::Setting,
        n::WRITE_STORE | n::RESTORE | n::RESET => Effect::Stopping,
        n::READ | n::READ_REGISTER => Effect::Query,
        _ => return None,
    })
}

/// A reply as named values: registers by their names, nothing for an acknowledge.
#[allow(clippy::wildcard_enum_match_arm, reason = "one answer for all the rest, new members too")]
fn values_of(command: &Command, reply: &Reply) -> Values {
    let Reply::Registers(registers) = reply else { return Values::default() };
    // In text a read of several registers brings all of them.
    let is_wanted = |index: u8| match command {
        Command::Read(mask) => mask.checked_shr(index.into()).is_some_and(|rest| rest & 1 == 1),
        _ => true,
    };
    let wanted = registers.iter().filter(|(index, _)| is_wanted(*index));
    Values::picked(fields(), wanted.map(|(index, value)| (usize::from(*index), Value::Int(*value))))
}
