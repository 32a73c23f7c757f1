//! The MotorVator V3 on the command line: its part of the shared commands, and `brushwork mecc`: programs without a window, which are checked, run and
//! formatted, the start of a board's own, and the language reference.

mod args;
mod decoder;
mod language;
mod run;
mod sim;
mod start;
mod terminal;

use brushwork_link::device::Identity;
use brushwork_link::family::{FamilyRef, Model};
use brushwork_motorvator::MODEL;
use brushwork_motorvator_client::{Half, MOTORVATOR, MotorvatorFacts};
use brushwork_motorvator_wire::reference;
use brushwork_script::mecc::reference as words;
use clap::{Arg, ArgMatches, Args as _, Command};

use crate::family::{Examples, Family, Simulated, SimulatedModel, Terminal};
use crate::monitor::follower::Follower;
use crate::scripts;
use crate::tool::Tool;
use crate::{Exit, Interrupt, Output, Page};
use args::{MeccArgs, MeccCommand};
use brushwork_core::settings::Act;
use decoder::Decoder;
use language::MECC;
use sim::Switches;

/// The MotorVator as commands see it.
#[derive(Debug)]
pub struct MotorvatorCommands;

impl Family for MotorvatorCommands {
    fn family(&self) -> FamilyRef {
        MOTORVATOR
    }

    fn commands(&self) -> Vec<Tool> {
        let about =
            "Check, run and format MeccCode programs, start that of a board; print the language reference";
        vec![Tool::new("mecc", 41, about, run)]
    }

    fn examples(&self) -> Examples {
        Examples {
            model: MODEL,
            options: "[,address=1]",
            lines: &[
                "drive --connect /dev/ttyUSB0,family=motorvator --address 2 --duty -40 --for 2",
                "sim --model motorvator-3 --program crane.mecc --pty /tmp/mv",
                "terminal --connect sim:motorvator-3 H I083001",
                "protocol --family motorvator M",
                "monitor --family motorvator --decode bytes.txt",
            ],
            typed: "A MotorVator takes G, H, or I and triplets such as I001002003; what may move a motor is refused.",
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
        sim::simulate(sim)
    }

    fn first_simulated(&self, text: &str) -> Option<u8> {
        sim::first_of(text)
    }

    fn protocol(&self, names: &[String]) -> Result<Page, String> {
        let rows = names
            .iter()
            .map(|name| {
                reference::row(name).ok_or_else(|| {
                    format!(
                        "There is no line \"{name}\" of a MotorVator. Use I, G, H, or the letter of an order such as M; \
                         `brushwork protocol --family motorvator` prints all."
                    )
                })
            })
            .collect::<Result<Vec<_>, _>>()?;
        let text = if rows.is_empty() { reference::page() } else { reference::text_of(&rows) };
        Ok(Page::new(&text, &reference::ROWS))
    }

    fn follower(&self, _generation: Option<u8>) -> Box<dyn Follower> {
        Box::new(Decoder::default())
    }

    fn terminal(&self, identity: &Identity) -> Option<Box<dyn Terminal>> {
        Some(Box::new(terminal::Typed(MotorvatorFacts::of(identity)?)))
    }

    fn note_of(&self, act: &Act) -> Option<&'static str> {
        match act {
            Act::Save | Act::Reload => Some(
                "Nothing on a MotorVator is kept over a restart but its program: put the ConfigStepper line into it.",
            ),
            Act::RestoreDefaults => Some("The values that the host library begins with are written."),
            Act::Read | Act::ReadKeys(_) | Act::Write { .. } => None,
        }
    }

    fn set_up(&self, identity: &Identity) -> Option<String> {
        let facts = MotorvatorFacts::of(identity)?;
        let library = match facts.library {
            Some(version) => format!("Host library {version} runs"),
            None => "The host library does not answer".to_owned(),
        };
        let stepper = facts.half.number();
        Some(format!("{library}; motors {}, or stepper {stepper}.", facts.half.letters()))
    }

    /// One stop stands the whole board.
    fn stopped_addresses(&self) -> Vec<u8> {
        Half::ALL.map(Half::number).to_vec()
    }
}

/// Does what was asked for.
fn run(args: &MeccArgs, out: &mut Output, interrupt: &Interrupt) -> Result<Exit, Exit> {
    match &args.command {
        MeccCommand::Check(args) => scripts::check(MECC, &args.files, args.json, args.deny_warnings, out),
        MeccCommand::Run(args) => run::run(args, out, interrupt),
        MeccCommand::Start(args) => start::run(args, out, interrupt),
        MeccCommand::Fmt(args) => scripts::fmt(MECC, &args.files, args.check, out),
        MeccCommand::Reference(args) => {
            Page::new(&words::page(), &words::reference()).print(args.json, out)?;
            Ok(Exit::Done)
        }
    }
}
