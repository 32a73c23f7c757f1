//! A command that is not every program's: a family's own, or a tool of the developers.

use clap::{ArgMatches, Args, Command};

use super::{Exit, Interrupt, Output};

/// Arguments as their type has them; ends the program where they do not fit, which only happens to those that were not read before.
pub fn typed<A: Args>(arguments: &ArgMatches) -> A {
    A::from_arg_matches(arguments).unwrap_or_else(|error| error.exit())
}

/// What does a command; gives its exit code either way.
type Act = dyn Fn(&ArgMatches, &mut Output, &Interrupt) -> Result<Exit, Exit>;

/// A command with what does it.
pub struct Tool {
    /// Its name, arguments and help.
    pub command: Command,
    run: Box<Act>,
}

impl Tool {
    /// A command of that name, at that place among those of the help page, where they stand by [`Command::display_order`].
    #[must_use]
    pub fn new<A: Args + 'static>(
        name: &'static str,
        place: usize,
        about: &'static str,
        run: fn(&A, &mut Output, &Interrupt) -> Result<Exit, Exit>,
    ) -> Self {
        Self::of_typed(name, place, about, move |args: A, _, out, interrupt| run(&args, out, interrupt))
    }

    /// The same for one that has a look at what was typed, too.
    #[must_use]
    pub fn of_typed<A: Args>(
        name: &'static str,
        place: usize,
        about: &'static str,
        run: impl Fn(A, &ArgMatches, &mut Output, &Interrupt) -> Result<Exit, Exit> + 'static,
    ) -> Self {
        let command = A::augment_args(Command::new(name)).about(about).long_about(None);
        let run = move |arguments: &ArgMatches, out: &mut Output, interrupt: &Interrupt| {
            run(typed(arguments), arguments, out, interrupt)
        };
        Self { command: command.display_order(place), run: Box::new(run) }
    }

    /// Does it.
    pub fn run(&self, arguments: &ArgMatches, out: &mut Output, interrupt: &Interrupt) -> Result<Exit, Exit> {
        (self.run)(arguments, out, interrupt)
    }
}
