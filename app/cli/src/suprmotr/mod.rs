//! The SuprMotr V9 on the command line: its part of the shared commands.

mod decoder;
mod macros;
mod sim;
mod terminal;

use brushwork_link::device::Identity;
use brushwork_link::family::{FamilyRef, Model};
use brushwork_suprmotr::sim_spec::MODEL;
use brushwork_suprmotr_client::{SUPRMOTR, SuprMotrFacts};
use brushwork_suprmotr_wire::{Radix, reference, reference_entry, reference_page};
use clap::{Arg, ArgMatches, Args as _, Command};

use crate::exit::Exit;
use crate::family::{Examples, Family, Page, Simulated, SimulatedModel, Terminal};
use crate::monitor::follower::Follower;
use crate::tool::Tool;
use brushwork_core::settings::Act;
use decoder::Decoder;
use sim::Switches;

/// The SuprMotr V9 as commands see it.
#[derive(Debug)]
pub struct SuprMotrCommands;

impl Family for SuprMotrCommands {
    fn family(&self) -> FamilyRef {
        SUPRMOTR
    }

    fn commands(&self) -> Vec<Tool> {
        vec![Tool::new("macro", 22, "Check, format and try macros of a SuprMotr", macros::run)]
    }

    fn examples(&self) -> Examples {
        Examples {
            model: MODEL,
            options: "[,address=0]",
            lines: &[
                "drive --connect /dev/ttyUSB0,family=suprmotr --address 3 --by -5000 --for 2",
                "sim --model suprmotr-v9 --address 0,3,F --pty /tmp/sm",
                "terminal --connect sim:suprmotr-v9 tp 'dp80,gp' '%'",
                "protocol --family suprmotr MR TS",
                "monitor --family suprmotr --decode bytes.txt",
            ],
            typed: "A SuprMotr takes a line of commands, or commands of one character such as % and '. A line alone is not repeated.",
        }
    }

    fn simulated(&self, _model: &Model) -> SimulatedModel {
        SimulatedModel { rating: sim::RATING, assumed: sim::ASSUMED }
    }

    fn sim_arguments(&self) -> Vec<Arg> {
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
                    "There is no command \"{name}\" of a SuprMotr. Use two letters such as MR, or a word such as limits; \
                     `brushwork protocol --family suprmotr` prints all."
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
            Act::Reload => Some(
                "A SuprMotr restarts for it (RT): its position is 0 afterwards, and it is refused where a macro 0 would run.",
            ),
            Act::RestoreDefaults => {
                Some("The factory values of the manual are written into RAM, one by one; the address stays.")
            }
            Act::Save | Act::Read | Act::ReadKeys(_) | Act::Write { .. } => None,
        }
    }

    fn terminal(&self, identity: &Identity) -> Option<Box<dyn Terminal>> {
        Some(Box::new(terminal::Typed(SuprMotrFacts::of(identity)?)))
    }

    fn set_up(&self, identity: &Identity) -> Option<String> {
        let facts = SuprMotrFacts::of(identity)?;
        let numbers = if facts.radix() == Radix::Decimal { "decimal" } else { "hexadecimal" };
        let echo = if facts.has_echo() { "echo on" } else { "echo off" };
        let motor = if facts.status.is_motor_on() { "Motor on" } else { "Motor off" };
        Some(format!(
            "{motor}, {echo}, numbers {numbers}. Over the serial line it takes moves and nothing else."
        ))
    }

    fn stopped_addresses(&self) -> Vec<u8> {
        Vec::new()
    }
}
