//! What the device thread asks of half a board, each act in its file.

use crate::controller::traffic::{describe_received, describe_sent};
use crate::controller::unit::Board;
use crate::controller::values::{order_of, values_of};
use crate::controller::{arming, discover, driving, polling, raw, stopping};
use crate::messages::MotorvatorCauseMessage;
use brushwork_link::Message;
use brushwork_link::device::controller::{ArmCheck, Controller, Line, PollItem, PollList};
use brushwork_link::device::{Described, Drive, Identity, Sample, StatusReport, StopBytes, UnitStop};
use brushwork_link::exchange::{ExchangeError, Reply};
use brushwork_link::transport::Stream;
use brushwork_motorvator_wire::Order;
use brushwork_values::Value;

impl Controller for Board {
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
        stopping::bytes()
    }

    fn confirm_stop(&mut self, line: &mut Line<'_>, _scripts: bool) -> Result<UnitStop, ExchangeError> {
        stopping::confirm(self, line)
    }

    fn other_drivers(&mut self, _line: &mut Line<'_>) -> Result<Vec<Message>, ExchangeError> {
        Ok(stopping::other_drivers(self))
    }

    fn check_arming(
        &mut self,
        line: &mut Line<'_>,
        _stream: Option<Stream>,
    ) -> Result<ArmCheck, ExchangeError> {
        arming::check(self, line)
    }

    fn transact(
        &mut self,
        line: &mut Line<'_>,
        command: u8,
        values: Vec<Value>,
    ) -> Result<Reply, ExchangeError> {
        let raw: Vec<i64> = values.iter().filter_map(Value::as_int).collect();
        let Some(order) = order_of(self.half, command, &raw) else {
            let what = MotorvatorCauseMessage::NoOrder { command, count: raw.len() };
            return Err(ExchangeError::impossible(what));
        };
        let (answer, span) = self.speaker.ask(line, &order)?;
        Ok(Reply { values: values_of(&answer), span })
    }

    fn raw(&mut self, line: &mut Line<'_>, bytes: &[u8]) -> Result<Vec<u8>, ExchangeError> {
        raw::send(&mut self.speaker, line, bytes)
    }

    fn start_program(&mut self, line: &mut Line<'_>) -> Result<(), ExchangeError> {
        raw::start(&mut self.speaker, line)
    }

    fn look_again(&mut self, line: &mut Line<'_>) -> Result<(), ExchangeError> {
        let found = self.speaker.look(line)?;
        self.identity = discover::identify(line, self.half, found, self.identity.simulated);
        Ok(())
    }

    /// A program that begins anew is another one, for all that anybody knows.
    fn raw_undermines_arming(&self, bytes: &[u8]) -> bool {
        raw::look(bytes).is_ok_and(|order| order == Order::Go)
    }

    fn can_move(&self, command: u8) -> bool {
        [b'M', b'T', b'V'].contains(&command)
    }

    fn undermines_arming(&self, _command: u8) -> bool {
        false
    }

    fn describe_traffic(&self, request: &[u8], reply: Option<&[u8]>) -> Described {
        match reply {
            None => describe_sent(request),
            Some(reply) => describe_received(reply),
        }
    }
}
