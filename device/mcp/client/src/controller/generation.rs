//! Which generation a unit's firmware is of, told by the length of its replies.
//!
//! Nothing on the wire names the generation (public clients, 2015-2025). Five reads have replies whose length changed; a
//! unit need not answer all of them. A reply counts with the length at which its CRC fits.

use crate::can::{Place, Probe as Found, probe as probe_object};
use crate::messages::McpIdentityMessage;
use brushwork_link::Message;
use brushwork_link::device::controller::Line;
use brushwork_link::exchange::{ExchangeError, Fault, Judgement, Outgoing};
use brushwork_mcp_wire::crc::crc16_xmodem;
use brushwork_mcp_wire::packet_serial::{Address, Generation, number};
use std::time::Duration;

/// What was found out.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Finding {
    /// The generation that fits best.
    pub generation: Generation,
    /// What is odd about it, as sentences.
    pub notes: Vec<Message>,
}

/// A read whose reply has two lengths: the short one, the long one, and the first generation that has the long one.
struct Probe {
    command: u8,
    short: usize,
    long: usize,
    long_since: Generation,
    /// The part of its object that only the long form has, or that is this wide in it.
    subindex: u8,
    long_width: usize,
}

/// Lengths with CRC (public clients, 2015-2025).
const PROBES: [Probe; 5] = [
    probe(number::READ_STATUS, [4, 6], Generation::Gen3, (0, 4)),
    probe(number::READ_MAIN_VOLTAGES, [6, 7], Generation::Gen4, (3, 1)),
    probe(number::READ_DEFAULT_ACCELS, [10, 18], Generation::Gen2, (3, 4)),
    probe(number::READ_PWM_MODE, [3, 4], Generation::Gen3, (1, 1)),
    probe(number::READ_ADDRESS_MIXED, [3, 4], Generation::Gen2, (1, 1)),
];

const fn probe(
    command: u8,
    [short, long]: [usize; 2],
    long_since: Generation,
    (subindex, long_width): (u8, usize),
) -> Probe {
    Probe { command, short, long, long_since, subindex, long_width }
}

/// Asks the unit at `address`. A contradiction is asked about once more, since one reply in 65536 fits by chance.
pub fn detect(line: &mut Line<'_>, address: Address) -> Result<Finding, ExchangeError> {
    let finding = judge(&observe(line, address)?);
    if finding.notes.is_empty() {
        return Ok(finding);
    }
    Ok(judge(&observe(line, address)?))
}

/// The same of a node, by the parts its objects have.
pub fn detect_node(line: &mut Line<'_>, place: Place) -> Result<Finding, ExchangeError> {
    let mut observations = [None; PROBES.len()];
    for (observation, probe) in observations.iter_mut().zip(&PROBES) {
        let part = probe_object(line, place, probe.command, probe.subindex)?;
        // Where the part is missing the object itself may be too, which tells nothing.
        *observation = match part {
            Found::Wide(width) => Some(width >= probe.long_width),
            Found::Absent => (probe_object(line, place, probe.command, 0)? != Found::Absent).then_some(false),
        };
    }
    Ok(judge(&observations))
}

/// For each probe whether the long reply came; `None` if no usable one did.
type Observations = [Option<bool>; PROBES.len()];

fn observe(line: &mut Line<'_>, address: Address) -> Result<Observations, ExchangeError> {
    let mut observations = [None; PROBES.len()];
    for (observation, probe) in observations.iter_mut().zip(&PROBES) {
        if line.exchange().capabilities().lacks(address.get(), probe.command) {
            continue;
        }
        *observation = match ask(line, address, probe) {
            Ok(long) => Some(long),
            Err(error) if error.is_link_lost() || error.interruption().is_some() => return Err(error),
            Err(_) => None,
        };
    }
    Ok(observations)
}

/// Sends one probe; whether the long reply came.
fn ask(line: &mut Line<'_>, address: Address, probe: &Probe) -> Result<bool, ExchangeError> {
    let bytes = [address.get(), probe.command];
    let outgoing = Outgoing {
        bytes: &bytes,
        reply_length: probe.short,
        patience: Duration::ZERO,
        retries: line.retries(),
        once: false,
    };
    let mut long = false;
    let (exchange, watch) = line.parts();
    exchange.exchange(&outgoing, watch, &mut |reply| {
        let fits = |length: usize| crc_fits(&bytes, reply, length);
        long = fits(probe.long);
        if long || fits(probe.short) {
            return Judgement::Good(if long { probe.long } else { probe.short });
        }
        match probe.long.checked_sub(reply.len()) {
            Some(missing) if missing > 0 => Judgement::More(missing),
            _ => Judgement::Bad(Fault::Malformed("it fits no known length".to_owned())),
        }
    })?;
    Ok(long)
}

/// Whether the first `length` bytes are data with their CRC over request and data.
fn crc_fits(request: &[u8], reply: &[u8], length: usize) -> bool {
    let Some((data, crc)) = reply.get(..length).and_then(|reply| reply.split_last_chunk::<2>()) else {
        return false;
    };
    crc16_xmodem(&[request, data].concat()) == u16::from_be_bytes(*crc)
}

/// The generation that agrees with most observations, the oldest of several.
fn judge(observations: &Observations) -> Finding {
    let agrees = |generation: Generation, probe: &Probe, long: bool| (generation >= probe.long_since) == long;
    let seen: Vec<_> =
        PROBES.iter().zip(observations).filter_map(|(probe, long)| long.map(|long| (probe, long))).collect();
    let score =
        |generation: Generation| seen.iter().filter(|(probe, long)| agrees(generation, probe, *long)).count();
    let generation = Generation::ALL.into_iter().rev().max_by_key(|generation| score(*generation));
    let generation = generation.unwrap_or(Generation::Gen1);
    let mut notes: Vec<_> = seen
        .iter()
        .filter(|(probe, long)| !agrees(generation, probe, *long))
        .map(|(probe, _)| McpIdentityMessage::OtherGeneration { command: probe.command }.into())
        .collect();
    if seen.is_empty() {
        notes.push(McpIdentityMessage::NothingTells.into());
    }
    Finding { generation, notes }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn observations(generation: Generation) -> Observations {
        std::array::from_fn(|index| Some(generation >= PROBES[index].long_since))
    }

    #[test]
    fn each_generation_is_told_by_its_lengths() {
        for generation in Generation::ALL {
            let finding = judge(&observations(generation));
            assert_eq!(finding, Finding { generation, notes: Vec::new() });
        }
    }

    #[test]
    fn a_unit_that_answers_only_some_is_told_as_far_as_they_go() {
        // A RoboClaw answers neither 142 nor 149.
        for generation in Generation::ALL {
            let mut partial = observations(generation);
            (partial[3], partial[4]) = (None, None);
            assert_eq!(judge(&partial).generation, generation);
        }
        let only_status = [Some(true), None, None, None, None];
        assert_eq!(judge(&only_status).generation, Generation::Gen3, "the oldest that fits");
    }

    #[test]
    fn a_contradiction_is_noted_and_the_majority_wins() {
        let mut odd = observations(Generation::Gen4);
        odd[3] = Some(false);
        let finding = judge(&odd);
        assert_eq!(finding.generation, Generation::Gen4);
        assert_eq!(finding.notes, ["Command 149 answers as another generation does."]);
    }

    #[test]
    fn a_unit_that_tells_nothing_is_taken_for_the_first_and_it_says_so() {
        let finding = judge(&[None; PROBES.len()]);
        assert_eq!(finding.generation, Generation::Gen1);
        assert_eq!(finding.notes.len(), 1);
    }
}
