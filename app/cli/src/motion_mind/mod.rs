//! The Motion Mind 3 on the command line: its part of the shared commands.

mod decoder;
mod sim;
mod terminal;

use brushwork_link::device::Identity;
use brushwork_link::family::{FamilyRef, Model};
use brushwork_motion_mind::sim_spec::MODEL;
use brushwork_motion_mind_client::{MOTION_MIND, MotionMindFacts, taken};
use brushwork_motion_mind_wire::{reference, reference_entry, reference_page};
use clap::{Arg, ArgMatches, Args as _, Command};

use crate::exit::Exit;
use crate::family::{Examples, Family, Page, Simulated, SimulatedModel, Terminal};
use crate::monitor::follower::Follower;
use brushwork_core::settings::Act;
use brushwork_core::words::capital;
use decoder::Decoder;
use sim::Switches;

/// The Motion Mind 3 as commands see it.
#[derive(Debug)]
pub struct MotionMindCommands;

impl Family for MotionMindCommands {
    fn family(&self) -> FamilyRef {
        MOTION_MIND
    }

    fn examples(&self) -> Examples {
        Examples {
            model: MODEL,
            options: "[,mode=4,protocol=ascii]",
            lines: &[
                "drive --connect /dev/ttyUSB0,family=motion-mind --by -500 --for 2",
                "sim --model motion-mind-3 --mode 4 --protocol ascii --address 1,2 --pty /tmp/mm",
                "protocol --family motion-mind WRITE_STORE PTERM",
                "terminal --connect /dev/ttyUSB0,family=motion-mind 'R01 04' 'W01 04 5000'",
                "terminal --connect sim:motion-mind-3 '1A 01 01 00 01 00'",
                "monitor --connect /dev/ttyUSB0,family=motion-mind --pty /tmp/tap",
                "monitor --family motion-mind --decode frames.txt",
            ],
            typed: "A Motion Mind in ASCII takes lines, one in binary the bytes of a frame in hexadecimal without their checksum.",
        }
    }

    fn simulated(&self, _model: &Model) -> SimulatedModel {
        SimulatedModel { rating: sim::RATING, assumed: sim::ASSUMED }
    }

    fn sim_arguments(&self) -> Vec<Arg> {
        // Their places on the help page are those of the command that takes them.
        Switches::augment_args(Command::default().next_display_order(None)).get_arguments().cloned().collect()
    }

    fn misplaced(&self, sim: &ArgMatches) -> Option<String> {
        sim::misplaced(sim)
    }

    fn simulate(&self, sim: &ArgMatches) -> Result<Simulated, Exit> {
        sim::simulate(sim).map_err(|sentence| Exit::Usage.saying(sentence))
    }

    fn first_simulated(&self, text: &str) -> Option<u8> {
        sim::first_of(text)
    }

    fn protocol(&self, names: &[String]) -> Result<Page, String> {
        let named = |name: &String| {
            reference_entry(name).ok_or_else(|| {
                format!(
                    "There is no command or register \"{name}\" of a Motion Mind. Use a name such as WRITE_STORE or PTERM; \
                     `brushwork protocol --family motion-mind` prints all."
                )
            })
        };
        let entries: Vec<_> = names.iter().map(named).collect::<Result<_, _>>()?;
        let entries: Vec<_> = entries.iter().map(|entry| entry.trim_end()).collect();
        let text = if entries.is_empty() { reference_page() } else { entries.join("\n") };
        Ok(Page::new(&text, &reference()))
    }

    fn follower(&self, _generation: Option<u8>) -> Box<dyn Follower> {
        Box::new(Decoder::default())
    }

    fn note_of(&self, act: &Act) -> Option<&'static str> {
        match act {
            Act::Save => Some(
                "Each write to EEPROM stops the motor for up to 40 ms; in mode 3 it does not start again by itself.",
            ),
            Act::Reload => Some(
                "A Motion Mind restarts for it: its motor stops, and its position is 0 unless POSPWRUP is set.",
            ),
            Act::RestoreDefaults => Some(
                "RESTORE writes RAM and EEPROM and stops the motor; the unit answers at address 1 afterwards.",
            ),
            Act::Read | Act::ReadKeys(_) | Act::Write { .. } => None,
        }
    }

    fn terminal(&self, identity: &Identity) -> Option<Box<dyn Terminal>> {
        Some(Box::new(MotionMindFacts::of(identity)?))
    }

    fn set_up(&self, identity: &Identity) -> Option<String> {
        let facts = MotionMindFacts::of(identity)?;
        Some(format!(
            "{}, {} protocol. Over the serial line it takes {}.",
            capital(&facts.mode.to_string()),
            facts.protocol,
            taken(facts.mode)
        ))
    }

    fn stopped_addresses(&self) -> Vec<u8> {
        Vec::new()
    }
}
