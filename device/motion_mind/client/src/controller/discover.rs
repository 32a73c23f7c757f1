//! Finding units: addresses 1 to 98 in both protocols, by reads alone. A read moves nothing, writes nothing and is the only kind
//! of command sent here.

use crate::controller::facts::MotionMindFacts;
use crate::controller::registers::{mask, returns_of, value_in};
use crate::controller::speaker::{GAP, Speaker};
use crate::controller::stopping;
use crate::controller::unit::MotionMind;
use crate::family::{MOTION_MIND, NAME, firmware_of};
use crate::messages::{MotionMindCauseMessage, MotionMindIdentityMessage, MotionMindRemedyMessage};
use brushwork_link::Message;
use brushwork_link::device::StopBytes;
use brushwork_link::device::controller::{Controller, DiscoverError, Line, Search};
use brushwork_link::device::{Addresses, DeviceOptions};
use brushwork_link::device::{Facts, Identity};
use brushwork_link::exchange::{ExchangeError, RETRIES};
use brushwork_link::failure::Failure;
use brushwork_link::messages::{ActMessage, CauseMessage};
use brushwork_motion_mind_wire::{Address, Command, Mode, Protocol, function, register_number as number};
use std::time::Duration;

/// How long an answer may take in a scan, beyond its time on the wire: 10 ms of the controller, and what USB adapters add.
const SCAN_PATIENCE: [Duration; 2] = [Duration::from_millis(28), Duration::from_millis(34)];
/// How long units may complain about a line that was a frame of the other protocol.
const COMPLAINTS: Duration = Duration::from_millis(60);
/// How long the factory address, or the only one asked for, is waited for.
const PATIENCE: [Duration; 2] = [Duration::from_millis(120), Duration::from_millis(500)];

/// Motion Minds on one line.
#[derive(Debug, Default)]
pub struct MotionMinds;

impl MotionMinds {
    /// The family.
    #[must_use]
    pub fn new() -> Self {
        Self
    }
}

impl Search for MotionMinds {
    fn discover(
        &mut self,
        line: &mut Line<'_>,
        options: &DeviceOptions,
    ) -> Result<Vec<Box<dyn Controller>>, DiscoverError> {
        let units = find(line, options);
        line.exchange().set_patience(Duration::ZERO);
        units
    }

    /// The unit at the factory address first, in whichever protocol it speaks: all 98 addresses are asked of a bus that is known to have one. Of a
    /// silent port that would take seconds for nothing.
    fn discover_gently(
        &mut self,
        line: &mut Line<'_>,
        options: &DeviceOptions,
    ) -> Result<Vec<Box<dyn Controller>>, DiscoverError> {
        if !matches!(options.addresses, Addresses::Scan | Addresses::Factory) {
            return self.discover(line, options);
        }
        let factory = DeviceOptions { addresses: Addresses::Only(Address::FACTORY.get()), ..options.clone() };
        let found = self.discover(line, &factory)?;
        if options.addresses == Addresses::Scan { self.discover(line, options) } else { Ok(found) }
    }

    fn stop_bytes(&self, addresses: Addresses) -> StopBytes {
        let reported = match addresses {
            Addresses::These(set) => set.iter().filter_map(Address::unit).collect(),
            Addresses::Scan | Addresses::Only(_) | Addresses::Factory => vec![Address::BROADCAST],
        };
        let modes = [Mode::Serial, Mode::SerialPid];
        let each = |address| {
            let stop = |protocol| stopping::of_modes(&Speaker::new(address, protocol), &modes);
            stop(Protocol::Binary).with(stop(Protocol::Text))
        };
        reported.into_iter().map(each).reduce(StopBytes::with).unwrap_or_default()
    }

    fn stop_all_bytes(&self, units: &[&Identity]) -> Option<StopBytes> {
        let facts: Vec<_> = units.iter().filter_map(|unit| MotionMindFacts::of(unit)).collect();
        let bytes = Protocol::ALL.map(|protocol| {
            let modes: Vec<_> =
                facts.iter().filter(|facts| facts.protocol == protocol).map(|facts| facts.mode).collect();
            stopping::broadcast(&modes, protocol)
        });
        let [binary, text] = bytes;
        Some(binary.with(text)).filter(|bytes| !bytes.is_empty())
    }
}

fn find(line: &mut Line<'_>, options: &DeviceOptions) -> Result<Vec<Box<dyn Controller>>, DiscoverError> {
    let heard_before = line.exchange().statistics().bytes_in;
    let found = match options.addresses {
        Addresses::Only(number) => match Address::unit(number) {
            Some(address) => patiently(line, address)?.into_iter().collect(),
            None => Vec::new(),
        },
        Addresses::Factory => patiently(line, Address::FACTORY)?.into_iter().collect(),
        Addresses::These(set) => {
            let mut found = Vec::new();
            for address in set.iter().filter_map(Address::unit) {
                found.extend(patiently(line, address)?);
            }
            found
        }
        Addresses::Scan => scan(line)?,
    };
    if found.is_empty() {
        return Err(nothing_there(line, options.addresses, heard_before));
    }
    // A line that needed patience keeps it until all units are known: what is learned of its lateness is learned from their replies.
    let lateness = found.iter().map(|found| found.lateness).max().unwrap_or_default();
    line.exchange().set_patience(lateness);
    let mut units: Vec<Box<dyn Controller>> = Vec::new();
    for Found { speaker, .. } in found {
        units.push(Box::new(identify(line, speaker, options.simulated)?));
    }
    Ok(units)
}

/// A unit that answered.
struct Found {
    speaker: Speaker,
    /// How much longer than usual its line must be waited for: what its answer took, and a quarter for one that takes longer.
    lateness: Duration,
}

/// The unit at one address that is worth waiting for.
fn patiently(line: &mut Line<'_>, address: Address) -> Result<Option<Found>, ExchangeError> {
    let heard_before = line.exchange().statistics().bytes_in;
    for (round, patience) in PATIENCE.into_iter().enumerate() {
        if round > 0 {
            // What the round before asked for may still be on its way, and answers nothing any more.
            let (exchange, watch) = line.parts();
            exchange.drain(PATIENCE[1] - PATIENCE[0], watch)?;
        }
        for protocol in Protocol::ALL {
            change_to(line, protocol)?;
            let speaker = Speaker::new(address, protocol);
            let asked_at = line.exchange().clock().now();
            if is_there(line, speaker, patience)? {
                let took = line.exchange().clock().now().saturating_sub(asked_at);
                let lateness = if took > SCAN_PATIENCE[0] { took * 5 / 4 } else { Duration::ZERO };
                return Ok(Some(Found { speaker, lateness }));
            }
        }
    }
    if line.exchange().statistics().bytes_in == heard_before {
        return Ok(None);
    }
    // Somebody answers, though not as a unit does: a simulator that knows the read of all registers alone.
    let loose = Speaker { is_loose: true, ..Speaker::new(address, Protocol::Text) };
    change_to(line, Protocol::Text)?;
    let [.., patience] = PATIENCE;
    let answer = loose.probe(line, number::ADDRESS, patience)?;
    Ok(answer.map(|_| Found { speaker: loose, lateness: Duration::ZERO }))
}

/// All units: the factory address first, in both protocols; then every other one in the protocol that it spoke, since units of one
/// bus must speak the same. Where nobody has the factory address, all are asked in binary, and if none answers, all in text.
fn scan(line: &mut Line<'_>) -> Result<Vec<Found>, ExchangeError> {
    line.report_progress(0, usize::from(*Address::UNITS.end()), "the factory address");
    if let Some(first) = patiently(line, Address::FACTORY)? {
        let others = ask_each(line, first.speaker.protocol, first.lateness)?;
        return Ok(std::iter::once(first).chain(others).collect());
    }
    for protocol in Protocol::ALL {
        change_to(line, protocol)?;
        let found = ask_each(line, protocol, Duration::ZERO)?;
        if !found.is_empty() {
            return Ok(found);
        }
    }
    Ok(Vec::new())
}

/// The units at the other addresses than the factory's. A line that is late by 400 ms is asked for 40 s; it can be told which address to ask.
fn ask_each(
    line: &mut Line<'_>,
    protocol: Protocol,
    lateness: Duration,
) -> Result<Vec<Found>, ExchangeError> {
    let of = usize::from(*Address::UNITS.end());
    let mut found = Vec::new();
    for number in Address::UNITS.skip(1) {
        line.report_progress(usize::from(number) - 1, of, &format!("address {number}, {protocol}"));
        let Some(address) = Address::unit(number) else { continue };
        let speaker = Speaker::new(address, protocol);
        let patience = SCAN_PATIENCE[usize::from(protocol == Protocol::Text)].max(lateness);
        if is_there(line, speaker, patience)? {
            found.push(Found { speaker, lateness });
        }
    }
    Ok(found)
}

/// Lets units in text forget what they took frames for: a line end makes a bad command of it, and all of them may say so.
fn change_to(line: &mut Line<'_>, protocol: Protocol) -> Result<(), ExchangeError> {
    if protocol == Protocol::Text {
        let (exchange, watch) = line.parts();
        exchange.wait(GAP, watch)?;
        exchange.write_now(b"\r\n")?;
        exchange.wait(COMPLAINTS, watch)?;
    }
    Ok(())
}

/// Whether a unit answers: the question must come back with the address that was asked.
fn is_there(line: &mut Line<'_>, speaker: Speaker, patience: Duration) -> Result<bool, ExchangeError> {
    let own = i64::from(speaker.address.get());
    Ok(speaker.probe(line, number::ADDRESS, patience)? == Some(own))
}

/// Finds out all about a unit.
fn identify(line: &mut Line<'_>, mut speaker: Speaker, simulated: bool) -> Result<MotionMind, ExchangeError> {
    line.set_retries(RETRIES);
    let wanted = mask(&[number::FUNCTION, number::REVISION, number::MODE]);
    let (reply, _) = speaker.ask(line, &Command::Read(wanted))?;
    let value = |index: u8| value_in(&reply, index).unwrap_or_default();
    let revision = u8::try_from(value(number::REVISION)).unwrap_or_default();
    let version = format!("{NAME} revision {revision}");
    line.exchange().capabilities().introduce(speaker.address.get(), &version);
    let mode = u8::try_from(value(number::MODE)).ok().and_then(Mode::from_number);
    speaker.returns = Some(returns_of(value(number::FUNCTION)));
    let mut notes = Vec::new();
    if mode.is_none() {
        notes.push(MotionMindIdentityMessage::UnknownMode { number: value(number::MODE) }.into());
    }
    let closes_a_loop = matches!(mode, Some(Mode::SerialPid | Mode::AnalogPid));
    if closes_a_loop && value(number::FUNCTION) & i64::from(function::DISABLEPID) != 0 {
        notes.push(MotionMindIdentityMessage::LoopIsOff.into());
    }
    if speaker.is_loose {
        notes.push(MotionMindIdentityMessage::Loose.into());
    }
    let identity = Identity {
        address: speaker.address.get(),
        family: MOTION_MIND,
        protocol: MOTION_MIND.label(),
        version_text: version,
        model: Some(NAME),
        firmware: revision.to_string(),
        generation: firmware_of(revision),
        facts: Facts::new(MotionMindFacts {
            mode: mode.unwrap_or(Mode::FactoryTest),
            protocol: speaker.protocol,
        }),
        also_answers: Vec::new(),
        simulated,
        port: line.exchange().port(),
        notes,
    };
    Ok(MotionMind::new(speaker, identity))
}

fn nothing_there(line: &mut Line<'_>, addresses: Addresses, heard_before: u64) -> DiscoverError {
    let heard = line.exchange().statistics().bytes_in - heard_before;
    let asked: Message = match addresses {
        Addresses::Scan => MotionMindCauseMessage::AllAddresses.into(),
        Addresses::Only(address) => MotionMindCauseMessage::Address { address }.into(),
        Addresses::These(set) => {
            let each: Vec<_> = set.iter().map(|address| address.to_string()).collect();
            CauseMessage::Addresses { listed: each.join(", ") }.into()
        }
        Addresses::Factory => MotionMindCauseMessage::Address { address: Address::FACTORY.get() }.into(),
    };
    let (came_back, remedy) = match heard {
        0 => (MotionMindCauseMessage::NothingAnswered { asked }, MotionMindRemedyMessage::CheckPowerAndPort),
        count => (MotionMindCauseMessage::BytesCame { count, asked }, MotionMindRemedyMessage::CheckBaudRate),
    };
    let on = line.exchange().port();
    DiscoverError::NothingThere(Failure::new(ActMessage::FindController, on, came_back, remedy))
}
