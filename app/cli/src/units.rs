//! A command that goes to several controllers: the same for each, one after the other, with one answer and one exit code.
//!
//! Each is found, asked and told by itself, so that one that is silent keeps nobody else from answering. What writes settings is done in two
//! rounds: first every controller is read and its changes are shown, then, if all of them can take theirs, all are written.

use brushwork_core::addresses::{AddressList, name};
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use brushwork_link::ConnectTarget;
use clap::{ArgMatches, Args};
use serde_json::{Value, json};

use super::addresses::Line;
use super::args::Command;
use super::client;
use super::messages::CliUnitsMessage;
use super::settings::args::{Round, WriteHow};
use super::settings::ask;
use super::tool::Tool;
use super::{ConnectArgs, Exit, Interrupt, Output, dispatch, say};

/// How long one look for an answer waits.
const LOOK: Duration = Duration::from_millis(20);

/// A command that may go to several controllers, one by one.
pub trait PerUnit {
    /// Where its controller is; `None` for what goes to one alone, has no controller, or has its own way with several.
    fn connect_mut(&mut self) -> Option<&mut ConnectArgs>;

    /// How it writes settings, if it does.
    fn how_mut(&mut self) -> Option<&mut WriteHow> {
        None
    }

    /// The files that it writes of one controller.
    fn files_mut(&mut self) -> Vec<&mut PathBuf> {
        Vec::new()
    }

    /// Whether it is done to the others where one of them failed.
    fn goes_on(&self) -> bool {
        true
    }

    /// Does it to the controller that its arguments name.
    ///
    /// # Errors
    /// Says on standard error what went wrong and gives the exit code.
    fn run(&self, out: &mut Output, interrupt: &Interrupt) -> Result<Exit, Exit>;
}

/// Runs a command of every program, once for each of the controllers that it is to go to.
pub fn run(
    mut command: Command,
    typed: &ArgMatches,
    out: &mut Output,
    interrupt: &Interrupt,
) -> Result<Exit, Exit> {
    let together = together(&mut command);
    let mut command = Shared { command, typed };
    let (Some(together), Some(args)) = (together, command.connect_mut().map(|args| args.clone())) else {
        return each(command, typed, out, interrupt);
    };
    let mut several = Several::of(command, &args, true, interrupt)?;
    loop {
        several.objects.clear();
        let begun = Instant::now();
        let exit = several.run(out, interrupt)?;
        match (together.json, together.again) {
            (true, Some(_)) => out.json_line(&several.objects)?,
            (true, None) => out.json(&several.objects)?,
            (false, _) => print_together(&several, out)?,
        }
        let Some(interval) = together.again else { return Ok(exit) };
        if exit == Exit::Interrupted || interrupt.sleep(interval.saturating_sub(begun.elapsed())) {
            return Err(Exit::Interrupted);
        }
    }
}

/// A command of a family that may go to several controllers.
pub fn tool<A: Args + PerUnit>(name: &'static str, place: usize, about: &'static str) -> Tool {
    Tool::of_typed(name, place, about, |args: A, typed, out, interrupt| each(args, typed, out, interrupt))
}

/// Does a command once for each of the controllers that it is to go to.
pub fn each(
    mut command: impl PerUnit,
    typed: &ArgMatches,
    out: &mut Output,
    interrupt: &Interrupt,
) -> Result<Exit, Exit> {
    let Some(args) = command.connect_mut().filter(|args| args.is_several()).map(|args| args.clone()) else {
        return command.run(out, interrupt);
    };
    let is_json = asks_for_json(typed);
    let mut several = Several::of(command, &args, is_json, interrupt)?;
    let exit = several.run(out, interrupt);
    if is_json {
        out.json(&several.objects)?;
    }
    exit
}

/// How a status of several is told in one table.
#[derive(Clone, Copy)]
struct Together {
    json: bool,
    /// How soon again.
    again: Option<Duration>,
}

/// Whether a status is to be told in one table; each controller is then asked for its JSON, once.
fn together(command: &mut Command) -> Option<Together> {
    let Command::Status(args) = command else { return None };
    if !args.together {
        return None;
    }
    let together = Together { json: args.json, again: args.watch.then_some(args.interval) };
    // The table tells nothing that the settings are needed for, and reading them takes the time of many rounds.
    (args.json, args.watch, args.together) = (true, false, !together.json);
    Some(together)
}

/// A row for each controller, with what it reports or why it did not.
fn print_together(several: &Several<impl PerUnit>, out: &mut Output) -> Result<(), Exit> {
    const FIGURES: [(&str, &str, usize); 6] = [
        ("BATTERY V", "main_battery", 1),
        ("LOGIC V", "logic_battery", 1),
        ("TEMP °C", "temperature_1", 1),
        ("TEMP 2 °C", "temperature_2", 1),
        ("M1 A", "m1_current", 2),
        ("M2 A", "m2_current", 2),
    ];
    let figures = FIGURES.iter().map(|(head, ..)| *head);
    let heads: Vec<&str> = ["CONTROLLER", "MODEL"].into_iter().chain(figures).chain(["REPORTS"]).collect();
    let row = |(unit, object): (&Unit, &Value)| {
        let result = &object["result"];
        let figure = |(head, key, digits): &(&str, &str, usize)| {
            let value = result["readings"][key].as_f64();
            let text = value.map_or_else(|| "-".to_owned(), |value| format!("{value:.digits$}"));
            // "-12.34" is as wide as a current gets.
            format!("{text:>width$}", width = head.chars().count().max(6))
        };
        let active: Vec<&str> =
            result["conditions"].as_array().into_iter().flatten().filter_map(Value::as_str).collect();
        let reports = match (result.is_null(), active.as_slice()) {
            (true, _) => "NO ANSWER".to_owned(),
            (false, []) => "nothing".to_owned(),
            (false, active) => active.join(", "),
        };
        let model = result["identity"]["model"].as_str().unwrap_or("-").to_owned();
        [unit.name.clone(), model].into_iter().chain(FIGURES.iter().map(figure)).chain([reports]).collect()
    };
    let rows: Vec<Vec<String>> = several.units.iter().zip(&several.objects).map(row).collect();
    Ok(out.table(&heads, &rows)?)
}

/// One of the controllers that are meant.
struct Unit {
    /// Its line, as it was typed.
    place: String,
    /// How it alone is reached.
    args: ConnectArgs,
    /// "0x81 on /dev/ttyUSB0".
    name: String,
    /// What its files have in their names: "0x81", with its port where there are several lines.
    tag: String,
    /// Why there is nobody to ask.
    missing: Option<Exit>,
}

struct Several<C> {
    command: C,
    units: Vec<Unit>,
    /// The files that the command was given to write.
    files: Vec<PathBuf>,
    is_json: bool,
    objects: Vec<Value>,
}

impl<C: PerUnit> Several<C> {
    fn of(mut command: C, args: &ConnectArgs, is_json: bool, interrupt: &Interrupt) -> Result<Self, Exit> {
        let units = units(args, interrupt)?;
        let files = command.files_mut().into_iter().map(|file| file.clone()).collect();
        Ok(Self { command, units, files, is_json, objects: Vec::new() })
    }

    fn run(&mut self, out: &mut Output, interrupt: &Interrupt) -> Result<Exit, Exit> {
        let Some(how) = self.command.how_mut() else { return self.round(out, interrupt) };
        how.several = true;
        if how.dry_run {
            return self.round(out, interrupt);
        }
        if let Some(exit) = self.agree(out, interrupt)? {
            return Ok(exit);
        }
        self.round(out, interrupt)
    }

    /// Shows what each would be written, and asks. The exit code if it ends with that.
    fn agree(&mut self, out: &mut Output, interrupt: &Interrupt) -> Result<Option<Exit>, Exit> {
        self.set_round(Round::Review);
        let exit = self.round(out, interrupt)?;
        self.set_round(Round::Agreed);
        let (saves, yes) = self.command.how_mut().map_or((false, false), |how| (how.save, how.yes));
        let count = self.units.len();
        if !matches!(exit, Exit::Done | Exit::Different) {
            return Ok(Some(exit.saying(CliUnitsMessage::NoneWritten)));
        }
        if exit == Exit::Done && !saves {
            return Ok(Some(exit));
        }
        let question = match saves {
            true => CliUnitsMessage::WriteToAllAndSave { count },
            false => CliUnitsMessage::WriteToAll { count },
        };
        let breathe = || if interrupt.sleep(LOOK) { Err(Exit::Interrupted) } else { Ok(()) };
        ask::agreed_while(&question.to_string(), yes, &breathe)?;
        self.objects.clear();
        Ok(None)
    }

    fn set_round(&mut self, round: Round) {
        if let Some(how) = self.command.how_mut() {
            how.round = round;
        }
    }

    /// Does it to one after the other. A signal ends it; what one of them comes to does not.
    fn round(&mut self, out: &mut Output, interrupt: &Interrupt) -> Result<Exit, Exit> {
        let (mut worst, mut failed) = (Exit::Done, Vec::new());
        for index in 0..self.units.len() {
            if index > 0 && !self.is_json {
                out.line("")?;
            }
            let exit = self.one(index, out, interrupt)?;
            worst = worst.or_worse(exit);
            if !matches!(exit, Exit::Done | Exit::Different) {
                failed.push(self.units[index].name.clone());
            }
            if exit == Exit::Interrupted {
                break;
            }
            let left = &self.units[index + 1..];
            if !failed.is_empty() && !self.command.goes_on() && !left.is_empty() {
                let left: Vec<&str> = left.iter().map(|unit| unit.name.as_str()).collect();
                say(CliUnitsMessage::NotBegun { units: left.join(", ") });
                break;
            }
        }
        if !failed.is_empty() {
            say(CliUnitsMessage::NotTillTheEnd { units: failed.join(", "), of: self.units.len() });
        }
        Ok(worst)
    }

    fn one(&mut self, index: usize, out: &mut Output, interrupt: &Interrupt) -> Result<Exit, Exit> {
        let unit = &self.units[index];
        let head = CliUnitsMessage::Begins { unit: unit.name.clone() };
        if !self.is_json {
            out.line(head)?;
        }
        if let Some(args) = self.command.connect_mut() {
            args.clone_from(&unit.args);
        }
        for (file, whole) in self.command.files_mut().into_iter().zip(&self.files) {
            *file = tagged(whole, &unit.tag);
        }
        if self.is_json {
            out.keep_json();
        }
        let ended = match unit.missing {
            Some(exit) => Err(exit.saying(CliUnitsMessage::NoneAt { place: unit.place.clone() })),
            None => self.command.run(out, interrupt),
        };
        let exit = ended.unwrap_or_else(|exit| exit);
        if self.is_json {
            let address = unit.args.address.as_ref().and_then(|list| list.numbers().first().copied());
            self.objects.push(json!({
                "connect": unit.place,
                "address": address,
                "exit_code": exit as u8,
                "result": out.take_json(),
            }));
        }
        Ok(exit)
    }
}

/// The controllers that the arguments name, line by line. Where all of a line are meant they are looked for now.
fn units(args: &ConnectArgs, interrupt: &Interrupt) -> Result<Vec<Unit>, Exit> {
    let mut units = Vec::new();
    let several_lines = args.connect.len() > 1;
    for place in &args.connect {
        let line = Line { connect: place, address: args.address.as_ref(), family: args.family };
        let target = client::line_target(&line)?;
        let is_simulated = matches!(target, ConnectTarget::Sim(_));
        let unit = |address: Option<u8>, missing| {
            let number = address.map(name);
            let on_line = several_lines.then(|| plain(place));
            Unit {
                name: number.iter().map(|number| format!("{number} on ")).chain([place.clone()]).collect(),
                tag: on_line.into_iter().chain(number).collect::<Vec<_>>().join("-"),
                place: place.clone(),
                args: ConnectArgs {
                    // Simulated units are all made, whichever is asked.
                    connect: vec![if is_simulated { target.to_string() } else { place.clone() }],
                    address: address.map(AddressList::One),
                    family: args.family,
                },
                missing,
            }
        };
        match &args.address {
            None => units.push(unit(None, None)),
            Some(AddressList::All) => match client::found(&target, &line, interrupt)?.as_slice() {
                [] => units.push(unit(None, Some(Exit::NoLink))),
                found => units.extend(found.iter().map(|found| unit(Some(found.address), None))),
            },
            Some(list) => units.extend(list.numbers().iter().map(|number| unit(Some(*number), None))),
        }
    }
    Ok(units)
}

/// A command that every program has, with what was typed.
struct Shared<'a> {
    command: Command,
    typed: &'a ArgMatches,
}

impl PerUnit for Shared<'_> {
    fn connect_mut(&mut self) -> Option<&mut ConnectArgs> {
        match &mut self.command {
            Command::Status(args) if !args.watch => Some(&mut args.connect),
            Command::Examine(args) => Some(&mut args.connect),
            Command::Settings(args) => args.action.connect_mut(),
            Command::Tune(args) => args.command.run_mut().map(|run| &mut run.connect),
            // These go to one, have no controller, or have their own way with several.
            Command::Status(_)
            | Command::List(_)
            | Command::Nodes(_)
            | Command::Address(_)
            | Command::Drive(_)
            | Command::Stop(_)
            | Command::Sim(_)
            | Command::Terminal(_)
            | Command::Protocol(_)
            | Command::Monitor(_) => None,
        }
    }

    fn how_mut(&mut self) -> Option<&mut WriteHow> {
        let Command::Settings(args) = &mut self.command else { return None };
        args.action.how_mut()
    }

    fn files_mut(&mut self) -> Vec<&mut PathBuf> {
        match &mut self.command {
            Command::Examine(args) => args.json.iter_mut().chain(&mut args.output).collect(),
            Command::Tune(args) => {
                args.command.run_mut().and_then(|run| run.report.as_mut()).into_iter().collect()
            }
            Command::Settings(args) => args.action.files_mut(),
            Command::Status(_)
            | Command::List(_)
            | Command::Nodes(_)
            | Command::Address(_)
            | Command::Drive(_)
            | Command::Stop(_)
            | Command::Sim(_)
            | Command::Terminal(_)
            | Command::Protocol(_)
            | Command::Monitor(_) => Vec::new(),
        }
    }

    fn run(&self, out: &mut Output, interrupt: &Interrupt) -> Result<Exit, Exit> {
        dispatch(&self.command, self.typed, out, interrupt)
    }
}

/// A file's name with something before its ending: "cart.json" becomes "cart-0x81.json".
fn tagged(file: &Path, tag: &str) -> PathBuf {
    let stem = file.file_stem().unwrap_or_default().to_string_lossy();
    let ending = file.extension().map(|ending| format!(".{}", ending.to_string_lossy())).unwrap_or_default();
    file.with_file_name(format!("{stem}-{tag}{ending}"))
}

/// The end of a target's name, as a file's name can have it.
fn plain(place: &str) -> String {
    let end = place.rsplit(['/', '\\']).next().unwrap_or(place);
    end.chars().map(|letter| if letter.is_ascii_alphanumeric() { letter } else { '_' }).collect()
}

/// Whether the command that was typed is to print JSON.
fn asks_for_json(typed: &ArgMatches) -> bool {
    match typed.subcommand() {
        Some((_, action)) => asks_for_json(action),
        None => typed.try_get_one::<bool>("json").ok().flatten().copied().unwrap_or_default(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_files_of_several_controllers_have_names_of_their_own() {
        let named = |file: &str, tag: &str| tagged(Path::new(file), tag).display().to_string();
        assert_eq!(named("kept/cart.json", "0x81"), "kept/cart-0x81.json");
        assert_eq!(named("cart", "ttyACM0-0x81"), "cart-ttyACM0-0x81");
        assert_eq!(plain("/dev/ttyACM0"), "ttyACM0");
        assert_eq!(plain("tcp:127.0.0.1:7000"), "tcp_127_0_0_1_7000");
        assert_eq!(plain(r"\\.\COM12"), "COM12");
    }
}
