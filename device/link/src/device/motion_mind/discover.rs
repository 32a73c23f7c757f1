//! Finding units: addresses 1 to 98 in both protocols, by reads alone. A read moves nothing, writes nothing and is the only kind
//! of command sent here.

use super::speaker::Speaker;
use super::stopping;
use super::{MotionMind, mask, number, returns_of, value_in};
use crate::device::controller::{Controller, DiscoverError, Family, Line};
use crate::device::identity::{Identity, MOTION_MIND, MotionMindFacts};
use crate::device::options::{Addresses, DeviceOptions};
use crate::device::stop::StopBytes;
use crate::exchange::{ExchangeError, RETRIES};
use crate::failure::Failure;
use crate::unit::FirmwareGeneration;
use brushwork_protocol::models::MOTION_MIND_3;
use brushwork_protocol::motion_mind::{Address, Command, Mode, Protocol};
use std::time::Duration;

/// How long an answer may take in a scan, beyond its time on the wire: 10 ms of the controller, and what USB adapters add.
const SCAN_PATIENCE: [Duration; 2] = [Duration::from_millis(35), Duration::from_millis(45)];
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

    /// The unit at the factory address, in whichever protocol it speaks. No other address is asked.
    pub fn at_the_factory_address(
        &self,
        line: &mut Line<'_>,
        options: &DeviceOptions,
    ) -> Result<Vec<Box<dyn Controller>>, DiscoverError> {
        let heard_before = line.exchange().statistics().bytes_in;
        match patiently(line, Address::FACTORY)? {
            Some(speaker) => Ok(vec![Box::new(identify(line, speaker, options.simulated)?)]),
            None => Err(nothing_there(line, Addresses::Only(Address::FACTORY.get()), heard_before)),
        }
    }
}

impl Family for MotionMinds {
    fn discover(
        &mut self,
        line: &mut Line<'_>,
        options: &DeviceOptions,
    ) -> Result<Vec<Box<dyn Controller>>, DiscoverError> {
        let heard_before = line.exchange().statistics().bytes_in;
        let found = match options.addresses {
            Addresses::Only(number) => match Address::unit(number) {
                Some(address) => patiently(line, address)?.into_iter().collect(),
                None => Vec::new(),
            },
            Addresses::Factory => patiently(line, Address::FACTORY)?.into_iter().collect(),
            Addresses::Scan => scan(line)?,
        };
        if found.is_empty() {
            return Err(nothing_there(line, options.addresses, heard_before));
        }
        let mut units: Vec<Box<dyn Controller>> = Vec::new();
        for speaker in found {
            units.push(Box::new(identify(line, speaker, options.simulated)?));
        }
        Ok(units)
    }

    fn stop_bytes(&self) -> StopBytes {
        let modes = [Mode::Serial, Mode::SerialPid];
        stopping::broadcast(&modes, Protocol::Binary).then(stopping::broadcast(&modes, Protocol::Text))
    }

    fn stop_all_bytes(&self, units: &[&Identity]) -> Option<StopBytes> {
        let facts: Vec<_> = units.iter().filter_map(|unit| unit.motion_mind).collect();
        let bytes = Protocol::ALL.map(|protocol| {
            let modes: Vec<_> =
                facts.iter().filter(|facts| facts.protocol == protocol).map(|facts| facts.mode).collect();
            stopping::broadcast(&modes, protocol)
        });
        let [binary, text] = bytes;
        Some(binary.then(text)).filter(|bytes| !bytes.is_empty())
    }
}

/// The unit at one address that is worth waiting for.
fn patiently(line: &mut Line<'_>, address: Address) -> Result<Option<Speaker>, ExchangeError> {
    for patience in PATIENCE {
        for protocol in Protocol::ALL {
            let speaker = Speaker::new(address, protocol);
            if is_there(line, speaker, patience)? {
                return Ok(Some(speaker));
            }
        }
    }
    Ok(None)
}

/// All units: the factory address first, then every other one. Once one has answered, the others are asked in its protocol alone,
/// since units of one bus must speak the same.
fn scan(line: &mut Line<'_>) -> Result<Vec<Speaker>, ExchangeError> {
    let addresses = Address::UNITS.filter_map(Address::unit);
    let of = addresses.clone().count();
    line.report_progress(0, of, "the factory address");
    let mut found: Vec<Speaker> = patiently(line, Address::FACTORY)?.into_iter().collect();
    for (done, address) in addresses.enumerate().skip(1) {
        line.report_progress(done, of, &format!("address {}", address.get()));
        let known = found.first().map(|speaker| speaker.protocol);
        for protocol in
            Protocol::ALL.into_iter().filter(|protocol| known.is_none_or(|known| known == *protocol))
        {
            let speaker = Speaker::new(address, protocol);
            if is_there(line, speaker, SCAN_PATIENCE[usize::from(protocol == Protocol::Text)])? {
                found.push(speaker);
                break;
            }
        }
    }
    Ok(found)
}

/// Whether a unit answers: the question must come back with the address that was asked.
fn is_there(line: &mut Line<'_>, speaker: Speaker, patience: Duration) -> Result<bool, ExchangeError> {
    let own = i64::from(speaker.address.get());
    if speaker.protocol == Protocol::Text {
        // What came before stands in a unit's line still, and the first line end turns it into a bad command.
        line.exchange().write_now(b"\r\n")?;
    }
    Ok(speaker.probe(line, number::ADDRESS, patience)? == Some(own))
}

/// Finds out all about a unit.
fn identify(line: &mut Line<'_>, mut speaker: Speaker, simulated: bool) -> Result<MotionMind, ExchangeError> {
    line.set_retries(RETRIES);
    let wanted = mask(&[number::FUNCTION, number::REVISION, number::MODE]);
    let (reply, _) = speaker.ask(line, &Command::Read(wanted))?;
    let value = |index: u8| value_in(&reply, index).unwrap_or_default();
    let revision = u8::try_from(value(number::REVISION)).unwrap_or_default();
    let mode = u8::try_from(value(number::MODE)).ok().and_then(Mode::from_number);
    speaker.returns = Some(returns_of(value(number::FUNCTION)));
    let mut notes = Vec::new();
    if mode.is_none() {
        notes.push(format!(
            "It says that its mode is {}, which the manual does not have.",
            value(number::MODE)
        ));
    }
    let identity = Identity {
        address: speaker.address.get(),
        family: MOTION_MIND,
        version_text: format!("{} revision {revision}", MOTION_MIND_3.title),
        model: Some(MOTION_MIND_3.name),
        firmware: revision.to_string(),
        generation: FirmwareGeneration::MotionMind { revision },
        motion_mind: Some(MotionMindFacts {
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
    let asked = match addresses {
        Addresses::Scan => "addresses 1 to 98".to_owned(),
        Addresses::Only(address) => format!("address {address}"),
        Addresses::Factory => format!("address {}", Address::FACTORY.get()),
    };
    let (came_back, mend) = match heard {
        0 => (
            format!("nothing answered at {asked}, in binary or in ASCII"),
            "Check that the controller has power, that the cable and the port are right, and the baud rate: 9600 or 19200 by switch 5, or what \
             FUNCTION2 was set to",
        ),
        count => (
            format!("{count} bytes came, but no Motion Mind, from {asked}"),
            "Check the baud rate: 9600 or 19200 by switch 5, or what FUNCTION2 was set to",
        ),
    };
    let on = line.exchange().port();
    DiscoverError::NothingThere(Failure::new("find a controller", on, came_back, mend))
}
