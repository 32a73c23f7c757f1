//! A family with quite other bytes on the same loop: one motor, text lines, no addresses, no scripts, no buffers. It keeps
//! the loop free of packet serial.

use super::harness::Link;
use crate::clock::{Clock, VirtualClock};
use crate::device::channel::{Channel, Sample};
use crate::device::controller::{
    ArmCheck, Controller, Described, DiscoverError, Family, Line, PollItem, PollList,
};
use crate::device::drive::{ArmScope, Drive, DriveCommand};
use crate::device::event::{DisarmReason, Event};
use crate::device::identity::Identity;
use crate::device::options::{Addresses, DeviceOptions};
use crate::device::request::Request;
use crate::device::run::DeviceLoop;
use crate::device::status::StatusReport;
use crate::device::stop::{StopBytes, UnitStop};
use crate::exchange::{ExchangeError, Judgement, Outgoing, Reply, Span};
use crate::testing::{Answers, ScriptedTransport, ms};
use crate::transport::Stream;
use brushwork_mcp_wire::packet_serial::Generation;
use brushwork_values::{Motor, Value};
use std::sync::{Arc, Mutex};
use std::time::Duration;

/// "P" reads the position, "D n" sets the duty in percent; each is answered with a line.
struct Toy {
    identity: Identity,
}

struct Toys;

/// Sends a line and returns the number in the answer.
fn ask(line: &mut Line<'_>, text: &str) -> Result<(f64, Span), ExchangeError> {
    let retries = line.retries();
    let outgoing =
        Outgoing { bytes: text.as_bytes(), reply_length: 2, patience: Duration::ZERO, retries, once: false };
    let mut number = 0.0;
    let (exchange, watch) = line.parts();
    let span = exchange.exchange(&outgoing, watch, &mut |bytes| match bytes
        .iter()
        .position(|byte| *byte == b'\n')
    {
        None => Judgement::More(1),
        Some(end) => {
            number = String::from_utf8_lossy(&bytes[..end]).parse().unwrap_or(f64::NAN);
            Judgement::Good(end + 1)
        }
    })?;
    Ok((number, span))
}

fn impossible<T>() -> Result<T, ExchangeError> {
    Err(ExchangeError::Impossible { what: "this controller has no such thing".to_owned() })
}

impl Controller for Toy {
    fn identity(&self) -> &Identity {
        &self.identity
    }

    fn poll_list(&self) -> PollList {
        PollList {
            fast: vec![PollItem { id: 7, name: "position" }],
            slow: Vec::new(),
            status: None,
            signals: None,
        }
    }

    fn poll(
        &mut self,
        line: &mut Line<'_>,
        _item: PollItem,
        sample: &mut Sample,
    ) -> Result<Option<StatusReport>, ExchangeError> {
        let (position, span) = ask(line, "P\n")?;
        sample.set(Channel::M1_POSITION, position, span.requested_at, span.replied_at);
        Ok(None)
    }

    fn drive(&mut self, line: &mut Line<'_>, drive: &Drive) -> Result<(), ExchangeError> {
        let (Some(DriveCommand::Duty { duty, .. }), None) = (drive.m1, drive.m2) else { return impossible() };
        if !line.permit().motion {
            return Err(ExchangeError::NotArmed { command: "duty".to_owned() });
        }
        line.motion_begins();
        ask(line, &format!("D {}\n", (duty * 100.0).round())).map(drop)
    }

    fn stop_bytes(&self, _scripts: bool) -> StopBytes {
        StopBytes::at_once(vec![b"D 0\n".to_vec()])
    }

    fn confirm_stop(&mut self, line: &mut Line<'_>, _scripts: bool) -> Result<UnitStop, ExchangeError> {
        ask(line, "D 0\n")?;
        let (address, confirmed) = (self.identity.address, true);
        let (still_driven_by, failures) = (Vec::new(), Vec::new());
        Ok(UnitStop {
            address,
            confirmed,
            script_ended: None,
            buffers_empty: None,
            still_driven_by,
            loop_left_off: false,
            failures,
        })
    }

    fn other_drivers(&mut self, _line: &mut Line<'_>) -> Result<Vec<String>, ExchangeError> {
        Ok(Vec::new())
    }

    fn check_arming(
        &mut self,
        _line: &mut Line<'_>,
        _stream: Option<Stream>,
    ) -> Result<ArmCheck, ExchangeError> {
        let (reasons, warnings) = (Vec::new(), Vec::new());
        Ok(ArmCheck { reasons, controller_timeout: Some(ms(300)), warnings })
    }

    fn set_encoder(&mut self, _: &mut Line<'_>, _: Motor, _: i32) -> Result<(), ExchangeError> {
        impossible()
    }

    fn zero_encoders(&mut self, _: &mut Line<'_>) -> Result<(), ExchangeError> {
        impossible()
    }

    fn reset_estop(&mut self, _: &mut Line<'_>) -> Result<(), ExchangeError> {
        impossible()
    }

    fn start_script(&mut self, _: &mut Line<'_>) -> Result<(), ExchangeError> {
        impossible()
    }

    fn stop_script(&mut self, _: &mut Line<'_>) -> Result<(), ExchangeError> {
        impossible()
    }

    fn transact(&mut self, _: &mut Line<'_>, _: u8, _: Vec<Value>) -> Result<Reply, ExchangeError> {
        impossible()
    }

    fn set_address(&mut self, _: u8) -> bool {
        false
    }

    fn can_move(&self, _: u8) -> bool {
        false
    }

    fn starts_script(&self, _: u8) -> bool {
        false
    }

    fn undermines_arming(&self, _: u8) -> bool {
        false
    }

    fn describe_traffic(&self, request: &[u8], _: Option<&[u8]>) -> Described {
        Described { text: String::from_utf8_lossy(request).into_owned(), sound: true }
    }
}

impl Family for Toys {
    fn discover(
        &mut self,
        line: &mut Line<'_>,
        options: &DeviceOptions,
    ) -> Result<Vec<Box<dyn Controller>>, DiscoverError> {
        ask(line, "P\n")?;
        let identity = Identity {
            address: 0,
            family: "toy",
            version_text: "Toy 1".to_owned(),
            model: None,
            firmware: "1".to_owned(),
            generation: Generation::Gen1.into(),
            motion_mind: None,
            also_answers: Vec::new(),
            simulated: options.simulated,
            port: line.exchange().port(),
            notes: Vec::new(),
        };
        Ok(vec![Box::new(Toy { identity })])
    }

    fn stop_bytes(&self, _: Addresses) -> StopBytes {
        StopBytes::at_once(vec![b"D 0\n".to_vec()])
    }
}

/// Lines and when they were written.
type Lines = Arc<Mutex<Vec<(Duration, String)>>>;

/// A loop on a toy, and everything that was written to it.
fn toy() -> (Link, Lines) {
    let clock = VirtualClock::new();
    let lines = Lines::default();
    let heard = lines.clone();
    let far_end = move |bytes: &[u8], now: Duration| -> Answers {
        let text = String::from_utf8_lossy(bytes).trim().to_owned();
        heard.lock().unwrap().push((now, text));
        vec![(ms(2), b"1234\n".to_vec())]
    };
    let (transport, tap) = ScriptedTransport::new(&clock, far_end);
    let options = DeviceOptions::default();
    let ((device_loop, handle), _) =
        DeviceLoop::with_family(transport, Arc::new(clock.clone()), options, Box::new(Toys));
    (Link::over(clock, device_loop, handle, tap), lines)
}

#[test]
fn a_family_of_one_motor_and_text_lines_runs_on_the_same_loop_by_the_same_rules() {
    let (mut link, lines) = toy();
    link.run_for(ms(300));
    assert!(link.has(
        |event| matches!(event, Event::Sample(sample) if sample.get(Channel::M1_POSITION) == Some(1234.0))
    ));
    let duty = |duty| Drive::one(Motor::M1, DriveCommand::duty(duty));
    link.ask(Request::Drive(duty(0.5)));
    link.run_for(ms(50));
    assert!(!lines.lock().unwrap().iter().any(|(_, line)| line == "D 50"), "unarmed");
    link.ask(Request::Arm(ArmScope::Pwm));
    link.ask(Request::Drive(duty(0.5)));
    link.run_for(ms(500));
    assert!(lines.lock().unwrap().iter().any(|(_, line)| line == "D 50"));
    link.handle.renew();
    let renewed_at = link.clock.now();
    link.window_alive = false;
    link.run_for(ms(500));
    let stop = lines.lock().unwrap().iter().find(|(_, line)| line == "D 0").cloned();
    assert_eq!(stop.map(|(at, _)| at - renewed_at), Some(ms(250)));
    assert_eq!(link.disarm_reasons(), [DisarmReason::DeadMan]);
    assert!(link.stops()[0].confirmed());
}
