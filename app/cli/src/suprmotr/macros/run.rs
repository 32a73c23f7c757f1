//! `brushwork macro run`: a macro on a simulated controller in virtual time, command by command.

use std::time::Duration;

use brushwork_plant::presets;
use brushwork_suprmotr::rehearsal::{Happening, Rehearsal, State};
use brushwork_suprmotr::sim_spec;
use brushwork_suprmotr_macros::Macro;
use brushwork_suprmotr_sim::{Step, SuprMotrConfig, world_of};
use brushwork_suprmotr_wire::{Address, Radix};

use super::args::RunArgs;
use super::source::Source;
use crate::messages::CliMacroMessage;
use crate::{Exit, Interrupt, Output, say};

/// More commands are not printed: a loop without a wait does thousands in a second.
const MOST_STEPS: usize = 10_000;

/// Runs it to its end, its fault or its time.
pub fn run(args: &RunArgs, out: &mut Output, interrupt: &Interrupt) -> Result<Exit, Exit> {
    let source = Source::read(&args.file)?;
    let said = source.rendered();
    if !said.is_empty() {
        say(said.trim_end());
    }
    if !source.checked.is_right() {
        return Err(Exit::ScriptWrong);
    }
    let chosen = chosen(&source, args.of.as_deref())?;
    let mut run = rehearsal(&source, args)?;
    run.start(chosen.number);
    let mut steps = 0;
    loop {
        let happened = run.advance();
        steps += happened.iter().filter(|happening| matches!(happening, Happening::Step(_))).count();
        for happening in happened {
            if let Some(line) = line_of(&happening, &run, &source) {
                out.line(line)?;
            }
        }
        let (took_s, counts) = (seconds(run.elapsed()), run.unit().position());
        let (exit, how) = match run.state() {
            _ if interrupt.is_raised() => return Err(Exit::Interrupted),
            State::Ended => (Exit::Done, CliMacroMessage::Ended { took_s, counts }),
            State::Refused(error) => {
                (Exit::ScriptFaulted, CliMacroMessage::Refused { took_s, error: error.to_string() })
            }
            State::LetGo => (Exit::ScriptFaulted, CliMacroMessage::LetGo { took_s, counts }),
            State::Running if run.elapsed() >= args.time => {
                (Exit::Done, CliMacroMessage::TimeIsUp { took_s, counts })
            }
            State::Running if steps >= MOST_STEPS => {
                (Exit::Done, CliMacroMessage::TooManySteps { took_s, steps })
            }
            State::Running => continue,
        };
        say(how);
        return Ok(exit);
    }
}

fn chosen<'s>(source: &'s Source, name: Option<&str>) -> Result<&'s Macro, Exit> {
    let macros = &source.checked.macros;
    let Some(first) = macros.first() else {
        return Err(Exit::Usage.saying(CliMacroMessage::NoMacros { name: source.name.clone() }));
    };
    match name {
        None => Ok(macros.iter().find(|known| known.number == 0).unwrap_or(first)),
        Some(name) => source.checked.find(name).ok_or_else(|| {
            let names: Vec<&str> = macros.iter().map(|known| known.name.as_str()).collect();
            Exit::Usage.saying(CliMacroMessage::NoMacro {
                name: source.name.clone(),
                wanted: name.to_owned(),
                names: names.join(", "),
            })
        }),
    }
}

fn rehearsal(source: &Source, args: &RunArgs) -> Result<Rehearsal, Exit> {
    let mut config = SuprMotrConfig::new(Address::FACTORY);
    if let Some(name) = &args.preset {
        let key = sim_spec::preset(name)
            .map_err(|clause| Exit::Usage.saying(CliMacroMessage::NoPreset { clause }))?;
        config.world = presets::lookup(&key).map_or(config.world, |preset| world_of(&preset.axis));
    }
    Rehearsal::new(config, &source.checked.macros).map_err(|error| {
        let name = source.name.clone();
        Exit::Failed.saying(CliMacroMessage::NotRun { name, error: error.to_string() })
    })
}

fn line_of(happening: &Happening, run: &Rehearsal, source: &Source) -> Option<String> {
    let now = seconds(run.elapsed());
    match happening {
        Happening::Step(step) => step_line(step, run, source),
        Happening::Said(text) => {
            let text: String = text.trim_end_matches('\u{3}').trim_end().replace("\r\n", " | ");
            Some(format!("{now:>9} s  says {text}"))
        }
        Happening::Outputs(outputs) => Some(format!("{now:>9} s  outputs {outputs:016b}")),
    }
}

/// A command of a macro; the call that began it all stands in no file.
fn step_line(step: &Step, run: &Rehearsal, source: &Source) -> Option<String> {
    let number = step.of_macro?;
    let known = source.checked.macros.iter().find(|known| known.number == number)?;
    let place = source.lines.place(&source.text, known.places.get(step.index)?.start);
    let at = seconds(run.time_of(step));
    let place = format!("{}:{}:{}", source.name, place.line, place.column);
    let command = step.command.text(Radix::Decimal);
    Some(format!("{at:>9} s  {place}  {}: {command} at {}", known.name, run.unit().position()))
}

fn seconds(time: Duration) -> String {
    format!("{:.3}", time.as_secs_f64())
}
