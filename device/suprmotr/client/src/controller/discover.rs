//! Finding units: each address is selected and asked for its position by one character. Nothing moves, no macro ends and no line is sent.

use crate::controller::facts::SuprMotrFacts;
use crate::controller::speaker::Speaker;
use crate::controller::stopping;
use crate::controller::unit::SuprMotr;
use crate::family::{NAME, SUPRMOTR, VERSION, firmware};
use crate::messages::{SuprMotrCauseMessage, SuprMotrIdentityMessage, SuprMotrRemedyMessage};
use brushwork_link::Message;
use brushwork_link::device::controller::{Controller, DiscoverError, Line, Search};
use brushwork_link::device::{Addresses, DeviceOptions, Facts, Identity, StopBytes};
use brushwork_link::exchange::{ExchangeError, RETRIES};
use brushwork_link::failure::Failure;
use brushwork_link::messages::{ActMessage, CauseMessage};
use brushwork_suprmotr_wire::{Address, Selection, operation};
use std::time::Duration;

/// How long an answer may take in a scan, beyond its time on the wire: some of the controller, and what USB adapters add.
const SCAN_PATIENCE: Duration = Duration::from_millis(40);
/// How long the only address that is asked for is waited for, twice.
const PATIENCE: [Duration; 2] = [Duration::from_millis(120), Duration::from_millis(500)];
/// The rates that a controller can have (BR).
const RATES: [u32; 3] = [9600, 19_200, 38_400];

/// SuprMotrs on one line.
#[derive(Debug, Default)]
pub struct SuprMotrs;

impl SuprMotrs {
    /// The family.
    #[must_use]
    pub fn new() -> Self {
        Self
    }
}

impl Search for SuprMotrs {
    fn discover(
        &mut self,
        line: &mut Line<'_>,
        options: &DeviceOptions,
    ) -> Result<Vec<Box<dyn Controller>>, DiscoverError> {
        let heard_before = line.exchange().statistics().bytes_in;
        let own = line.exchange().baud();
        let mut found = find(line, options.addresses)?;
        let others = RATES.into_iter().filter(|rate| own.is_some_and(|own| own != *rate));
        let mut other_rate = None;
        for rate in others {
            if !found.is_empty() || !line.exchange().set_baud(rate)? {
                break;
            }
            found = find(line, options.addresses)?;
            other_rate = Some(rate);
        }
        if found.is_empty() {
            if let (Some(own), Some(_)) = (own, other_rate) {
                line.exchange().set_baud(own)?;
            }
            return Err(nothing_there(line, options.addresses, heard_before));
        }
        introduce(line, &found, options.simulated, other_rate)
    }

    /// At the rate of the line alone, and the factory address first: all others are asked of a line that is known to have a unit.
    fn discover_gently(
        &mut self,
        line: &mut Line<'_>,
        options: &DeviceOptions,
    ) -> Result<Vec<Box<dyn Controller>>, DiscoverError> {
        let heard_before = line.exchange().statistics().bytes_in;
        let mut found = Vec::new();
        if options.addresses != Addresses::Scan
            || Speaker::new(Address::FACTORY).probe(line, SCAN_PATIENCE)?
        {
            found = find(line, options.addresses)?;
        }
        if found.is_empty() {
            return Err(nothing_there(line, options.addresses, heard_before));
        }
        introduce(line, &found, options.simulated, None)
    }

    fn stop_bytes(&self, addresses: Addresses) -> StopBytes {
        let stop = |selection| stopping::bytes(selection);
        match addresses {
            Addresses::These(set) => {
                let each = set.iter().filter_map(Address::new).map(|address| stop(Selection::Unit(address)));
                each.reduce(StopBytes::with).unwrap_or_default()
            }
            Addresses::Scan | Addresses::Only(_) | Addresses::Factory => stop(Selection::All),
        }
    }

    fn stop_all_bytes(&self, units: &[&Identity]) -> Option<StopBytes> {
        (!units.is_empty()).then(|| stopping::bytes(Selection::All))
    }
}

/// The units that answer at the present rate of the line.
fn find(line: &mut Line<'_>, addresses: Addresses) -> Result<Vec<Speaker>, ExchangeError> {
    let one = |number: u8| Address::new(number).into_iter().collect::<Vec<_>>();
    let (asked, is_scan) = match addresses {
        Addresses::Only(number) => (one(number), false),
        Addresses::Factory => (vec![Address::FACTORY], false),
        Addresses::These(set) => (set.iter().filter_map(Address::new).collect(), false),
        Addresses::Scan => (Address::ALL.to_vec(), true),
    };
    let of = asked.len();
    let mut found = Vec::new();
    for (done, address) in asked.into_iter().enumerate() {
        line.report_progress(done, of, &format!("address {}", char::from(address.character())));
        let speaker = Speaker::new(address);
        let is_there = if is_scan {
            speaker.probe(line, SCAN_PATIENCE)?
        } else {
            speaker.probe(line, PATIENCE[0])? || speaker.probe(line, PATIENCE[1])?
        };
        if is_there {
            found.push(speaker);
        }
    }
    if is_scan && !found.is_empty() {
        ask_again(line, &mut found)?;
    }
    Ok(found)
}

/// Asks those once more that were silent on a line that has units: one that was late by itself would be missing from it.
fn ask_again(line: &mut Line<'_>, found: &mut Vec<Speaker>) -> Result<(), ExchangeError> {
    let heard: Vec<u8> = found.iter().map(|speaker| speaker.address.get()).collect();
    for address in Address::ALL.iter().filter(|address| !heard.contains(&address.get())) {
        let speaker = Speaker::new(*address);
        if speaker.probe(line, SCAN_PATIENCE)? {
            found.push(speaker);
        }
    }
    found.sort_by_key(|speaker| speaker.address.get());
    Ok(())
}

fn introduce(
    line: &mut Line<'_>,
    found: &[Speaker],
    simulated: bool,
    rate: Option<u32>,
) -> Result<Vec<Box<dyn Controller>>, DiscoverError> {
    line.set_retries(RETRIES);
    let mut units: Vec<Box<dyn Controller>> = Vec::new();
    for speaker in found {
        units.push(Box::new(identify(line, *speaker, simulated, rate)?));
    }
    Ok(units)
}

/// Finds out about a unit what one character tells.
fn identify(
    line: &mut Line<'_>,
    mut speaker: Speaker,
    simulated: bool,
    rate: Option<u32>,
) -> Result<SuprMotr, ExchangeError> {
    let (status, _) = speaker.status(line)?;
    let runs = status.operation & (operation::MACRO | operation::WAIT) != 0;
    let notes = [
        runs.then_some(SuprMotrIdentityMessage::MacroRuns),
        (!status.is_motor_on()).then_some(SuprMotrIdentityMessage::MotorOff),
        rate.map(|baud| SuprMotrIdentityMessage::OtherRate { baud }),
    ];
    let identity = Identity {
        address: speaker.address.get(),
        family: SUPRMOTR,
        protocol: SUPRMOTR.label(),
        version_text: NAME.to_owned(),
        model: Some(NAME),
        firmware: VERSION.to_string(),
        generation: firmware(),
        facts: Facts::new(SuprMotrFacts { status }),
        also_answers: Vec::new(),
        simulated,
        port: line.exchange().port(),
        notes: notes.into_iter().flatten().map(Message::from).collect(),
    };
    Ok(SuprMotr::new(speaker, identity))
}

fn nothing_there(line: &mut Line<'_>, addresses: Addresses, heard_before: u64) -> DiscoverError {
    let heard = line.exchange().statistics().bytes_in - heard_before;
    let character = |number: u8| Address::new(number).map_or('?', |address| char::from(address.character()));
    let asked: Message = match addresses {
        Addresses::Scan => SuprMotrCauseMessage::AllAddresses.into(),
        Addresses::Only(number) => SuprMotrCauseMessage::Address { address: character(number) }.into(),
        Addresses::These(set) => {
            let each: Vec<_> = set.iter().map(|number| character(number).to_string()).collect();
            CauseMessage::Addresses { listed: each.join(", ") }.into()
        }
        Addresses::Factory => {
            SuprMotrCauseMessage::Address { address: character(Address::FACTORY.get()) }.into()
        }
    };
    let (came_back, remedy) = match heard {
        0 => (SuprMotrCauseMessage::NothingAnswered { asked }, SuprMotrRemedyMessage::CheckPowerAndPort),
        count => (SuprMotrCauseMessage::BytesCame { count, asked }, SuprMotrRemedyMessage::CheckBaudRate),
    };
    let on = line.exchange().port();
    DiscoverError::NothingThere(Failure::new(ActMessage::FindController, on, came_back, remedy))
}
