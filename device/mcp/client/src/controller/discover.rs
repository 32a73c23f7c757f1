//! Finding the units of a link: which addresses answer, whether they are one unit, and who each is.

use crate::can::Place;
use crate::controller::speaker::{Speaker, Wire};
use crate::controller::unit::Mcp;
use crate::controller::{generation, polling, stopping};
use crate::messages::{McpCauseMessage, McpIdentityMessage, McpRemedyMessage};
use crate::{MCP, McpFacts, firmware_of as generation_number};
use brushwork_canopen::bus::Monitor;
use brushwork_link::Message;
use brushwork_link::device::StopBytes;
use brushwork_link::device::controller::{Controller, DiscoverError, Line, Search};
use brushwork_link::device::{Addresses, DeviceOptions};
use brushwork_link::device::{Facts, Identity};
use brushwork_link::exchange::{ExchangeError, RETRIES};
use brushwork_link::failure::Failure;
use brushwork_link::messages::{ActMessage, CauseMessage};
use brushwork_link::transport::Stream;
use brushwork_mcp_wire::models;
use brushwork_mcp_wire::models::Model;
use brushwork_mcp_wire::packet_serial::{Address, Generation, Typed, commands, name};
use std::time::Duration;

/// MCP and RoboClaw controllers.
#[derive(Debug, Default)]
pub struct PacketSerial;

/// A scan asks each address once more than this; most of the eight have nobody to answer.
const SCAN_RETRIES: u32 = 1;
/// How much longer a reply may take when nobody has answered before: a computer under load leaves no process its turn
/// within the usual time, and a controller may just be starting. Nobody is asked twice who has answered.
const PATIENCE: [Duration; 3] = [Duration::ZERO, Duration::from_millis(150), Duration::from_millis(500)];

impl Search for PacketSerial {
    fn discover(
        &mut self,
        line: &mut Line<'_>,
        options: &DeviceOptions,
    ) -> Result<Vec<Box<dyn Controller>>, DiscoverError> {
        let units = find(line, options);
        line.exchange().set_patience(Duration::ZERO);
        units
    }

    fn stop_bytes(&self, addresses: Addresses) -> StopBytes {
        let speaker = |address| Speaker::packets(address, Generation::Gen1);
        // Nobody knows yet who runs scripts; the device thread ends them once it does.
        let each = |address| stopping::bytes(speaker(address), false, false);
        let reported = |address: &Address| match addresses {
            Addresses::These(set) => set.contains(address.get()),
            Addresses::Scan | Addresses::Only(_) | Addresses::Factory => true,
        };
        Address::ALL.into_iter().filter(reported).map(each).reduce(StopBytes::with).unwrap_or_default()
    }
}

fn find(line: &mut Line<'_>, options: &DeviceOptions) -> Result<Vec<Box<dyn Controller>>, DiscoverError> {
    let heard_before = line.exchange().statistics().bytes_in;
    line.exchange().set_scanning(true);
    let answers = scan(line, options.addresses);
    line.exchange().set_scanning(false);
    let answers = answers?;
    if answers.is_empty() {
        let heard = line.exchange().statistics().bytes_in - heard_before;
        return Err(DiscoverError::NothingThere(nothing_there(line, options.addresses, heard)));
    }
    let one_unit = is_one_unit(line, &answers, options.stream)?;
    let mut units: Vec<Box<dyn Controller>> = Vec::new();
    for (address, version) in &answers {
        let mut unit = identify(line, *address, version, options.simulated)?;
        if one_unit {
            let others = answers.iter().map(|(other, _)| other.get()).filter(|other| *other != address.get());
            unit.identity.also_answers = others.collect();
        }
        units.push(Box::new(unit));
        if one_unit {
            break;
        }
    }
    Ok(units)
}

/// The addresses that answer with a version, and their answers. A line that needed patience keeps it until all units
/// are known.
fn scan(line: &mut Line<'_>, addresses: Addresses) -> Result<Vec<(Address, String)>, ExchangeError> {
    let candidates = match addresses {
        Addresses::Scan => Address::ALL.to_vec(),
        Addresses::Only(byte) => Address::new(byte).into_iter().collect(),
        Addresses::These(set) => set.iter().filter_map(Address::new).collect(),
        Addresses::Factory => vec![Address::DEFAULT],
    };
    let mut answers = Vec::new();
    let heard_before = line.exchange().statistics().bytes_in;
    for (round, patience) in PATIENCE.into_iter().enumerate() {
        // A line that is later than that has brought its first replies by now; a silent one is not scanned for long.
        if round > 1 && candidates.len() > 1 && line.exchange().statistics().bytes_in == heard_before {
            break;
        }
        if round > 0 {
            // What the round before asked for may still be on its way, and answers nothing any more.
            let (exchange, watch) = line.parts();
            exchange.drain(patience, watch)?;
        }
        line.exchange().set_patience(patience);
        line.set_retries(match (round, candidates.len()) {
            (0, 0..=1) => RETRIES,
            (0, _) => SCAN_RETRIES,
            _ => 0,
        });
        answers = ask_each(line, &candidates)?;
        if !answers.is_empty() {
            break;
        }
    }
    if matches!(addresses, Addresses::These(_)) && !answers.is_empty() {
        again(line, &candidates, &mut answers)?;
    }
    line.set_retries(RETRIES);
    Ok(answers)
}

/// Asks those that somebody has named and that were silent once more, with the patience of a late line: one reply that came late is no missing
/// unit.
fn again(
    line: &mut Line<'_>,
    candidates: &[Address],
    answers: &mut Vec<(Address, String)>,
) -> Result<(), ExchangeError> {
    let silent = |address: &&Address| !answers.iter().any(|(known, _)| known == *address);
    let silent: Vec<Address> = candidates.iter().filter(silent).copied().collect();
    if silent.is_empty() {
        return Ok(());
    }
    let patience = PATIENCE[1];
    let (exchange, watch) = line.parts();
    exchange.drain(patience, watch)?;
    line.exchange().set_patience(patience);
    line.set_retries(0);
    answers.extend(ask_each(line, &silent)?);
    answers.sort_by_key(|(address, _)| *address);
    Ok(())
}

fn ask_each(line: &mut Line<'_>, candidates: &[Address]) -> Result<Vec<(Address, String)>, ExchangeError> {
    let mut answers = Vec::new();
    for &address in candidates {
        let speaker = Speaker::packets(address, Generation::Gen1);
        match speaker.ask(line, commands::READ_VERSION, &[]) {
            Ok(reply) => {
                answers
                    .push((address, reply.values.text(name::VERSION).unwrap_or_default().trim().to_owned()));
            }
            Err(error) if error.is_link_lost() || error.interruption().is_some() => return Err(error),
            // Nobody there, or noise; what was heard is told if no address answers at all.
            Err(_) => {}
        }
    }
    Ok(answers)
}

/// Whether all answers come from one unit, as over USB, where each answers all eight addresses (MCP manual 2.1).
///
/// A port that is known to be USB settles it. Else all eight must answer with the same version and be in the same state:
/// same gains and limits, encoders and voltages alike.
fn is_one_unit(
    line: &mut Line<'_>,
    answers: &[(Address, String)],
    stream: Option<Stream>,
) -> Result<bool, ExchangeError> {
    let Some((first, version)) = answers.first() else { return Ok(false) };
    if answers.len() < 2 || answers.iter().any(|(_, other)| other != version) {
        return Ok(false);
    }
    if stream == Some(Stream::Usb) {
        return Ok(true);
    }
    if answers.len() < Address::ALL.len() {
        return Ok(false);
    }
    for (address, _) in &answers[1..] {
        // Read next to each other, so that what moves has moved little.
        let (mine, theirs) = (state(line, *first)?, state(line, *address)?);
        let alike = mine.len() == theirs.len()
            && mine.iter().zip(&theirs).all(|(mine, theirs)| (mine.0 - theirs.0).abs() <= mine.1);
        if !alike {
            return Ok(false);
        }
    }
    Ok(true)
}

/// What is compared, each with how far two readings of one unit may lie apart.
fn state(line: &mut Line<'_>, address: Address) -> Result<Vec<(i64, i64)>, ExchangeError> {
    let speaker = Speaker::packets(address, Generation::Gen1);
    let mut state = Vec::new();
    speaker.compare(line, commands::READ_ENCODERS, 200, &mut state)?;
    speaker.compare(line, commands::READ_MAIN_BATTERY, 3, &mut state)?;
    speaker.compare(line, commands::READ_LOGIC_BATTERY, 3, &mut state)?;
    speaker.compare(line, commands::READ_TEMPERATURE_1, 5, &mut state)?;
    speaker.compare(line, commands::READ_VELOCITY_PID_M1, 0, &mut state)?;
    speaker.compare(line, commands::READ_VELOCITY_PID_M2, 0, &mut state)?;
    speaker.compare(line, commands::READ_POSITION_PID_M1, 0, &mut state)?;
    Ok(state)
}

impl Speaker {
    /// Adds what a command reads, if the unit knows it, to what is compared.
    fn compare<const L: u8>(
        self,
        line: &mut Line<'_>,
        command: Typed<L>,
        tolerance: i64,
        state: &mut Vec<(i64, i64)>,
    ) -> Result<(), ExchangeError> {
        if let Some(reply) = self.ask_if_known(line, command)? {
            state.extend(reply.values.ints().map(|value| (value, tolerance)));
        }
        Ok(())
    }
}

/// Finds out all about one unit.
fn identify(
    line: &mut Line<'_>,
    address: Address,
    version: &str,
    simulated: bool,
) -> Result<Mcp, ExchangeError> {
    line.exchange().capabilities().introduce(address.get(), version);
    let finding = generation::detect(line, address)?;
    let speaker = Speaker::packets(address, finding.generation);
    finish(line, speaker, None, version, simulated, finding.notes)
}

/// Finds out all about one node of a CAN bus; `notes` are told with its identity.
pub fn identify_node(
    line: &mut Line<'_>,
    place: Place,
    monitor: &Monitor,
    version: &str,
    simulated: bool,
    mut notes: Vec<Message>,
) -> Result<Mcp, ExchangeError> {
    let finding = generation::detect_node(line, place)?;
    notes.extend(finding.notes);
    let speaker =
        Speaker { wire: Wire::Objects(place), ..Speaker::packets(Address::DEFAULT, finding.generation) };
    finish(line, speaker, Some(monitor.clone()), version, simulated, notes)
}

/// What remains to be found out, on whichever wire.
fn finish(
    line: &mut Line<'_>,
    speaker: Speaker,
    monitor: Option<Monitor>,
    version: &str,
    simulated: bool,
    mut notes: Vec<Message>,
) -> Result<Mcp, ExchangeError> {
    let polls = polling::find(speaker, line)?;
    let model = models::identify(version);
    let missing = polling::missing(&polls);
    if !missing.is_empty() {
        notes.push(McpIdentityMessage::Unanswered { names: missing.join(", ") }.into());
    }
    let is_mcp = model.is_some_and(|model| model.name.starts_with("MCP"));
    let is_node = matches!(speaker.wire, Wire::Objects(_));
    let motors = if model.is_some_and(|model| model.motors == 1) { 1 } else { 2 };
    let identity = Identity {
        address: speaker.id(),
        family: MCP,
        protocol: if is_node { "CANopen" } else { "packet serial" },
        version_text: version.to_owned(),
        model: model.map(|model| model.name),
        firmware: firmware_of(version).to_owned(),
        generation: generation_number(speaker.generation),
        facts: Facts::new(McpFacts { generation: speaker.generation, is_mcp, is_node, motors }),
        also_answers: Vec::new(),
        simulated,
        port: line.exchange().port(),
        notes,
    };
    let runs_scripts = model.is_some_and(Model::runs_scripts);
    Ok(Mcp { speaker, identity, model, polls, runs_scripts, has_buffered: false, monitor })
}

/// The version behind the last " v" of the text: "1.0.0" of "MCP266 2x60A v1.0.0".
fn firmware_of(version: &str) -> &str {
    let last = version.split_whitespace().next_back().unwrap_or_default();
    let number = last.strip_prefix(['v', 'V']).unwrap_or(last);
    if number.starts_with(|first: char| first.is_ascii_digit()) { number } else { "" }
}

fn nothing_there(line: &mut Line<'_>, addresses: Addresses, heard: u64) -> Failure {
    let on = line.exchange().port();
    let asked: Message = match addresses {
        Addresses::Scan => McpCauseMessage::AllAddresses.into(),
        Addresses::Only(address) => McpCauseMessage::Address { address }.into(),
        Addresses::These(set) => {
            let each: Vec<_> = set.iter().map(|address| format!("0x{address:02X}")).collect();
            CauseMessage::Addresses { listed: each.join(", ") }.into()
        }
        Addresses::Factory => McpCauseMessage::Address { address: Address::DEFAULT.get() }.into(),
    };
    let (came_back, remedy) = match heard {
        0 => (McpCauseMessage::NothingAnswered { asked }, McpRemedyMessage::CheckPowerAndPort),
        1 => (McpCauseMessage::OneByteCame { asked }, McpRemedyMessage::CheckBaudRate),
        count => (McpCauseMessage::BytesCame { count, asked }, McpRemedyMessage::CheckBaudRate),
    };
    Failure::new(ActMessage::FindController, on, came_back, remedy)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_firmware_version_is_the_last_word_without_its_v() {
        assert_eq!(firmware_of("MCP266 2x60A v1.0.0"), "1.0.0");
        assert_eq!(firmware_of("USB Roboclaw 2x7a v4.2.8"), "4.2.8");
        assert_eq!(firmware_of("Something else"), "");
        assert_eq!(firmware_of(""), "");
    }
}
