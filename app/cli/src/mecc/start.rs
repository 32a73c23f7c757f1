//! `brushwork mecc start`: starts the program in a board's memory, which nothing here can look into.

use std::time::{Duration, Instant};

use brushwork_link::device::RiskAccepted;
use brushwork_link::messages::ActMessage;
use brushwork_link::{Event, PollRate, Request};
use brushwork_motorvator_client::{MOTORVATOR, MotorvatorFacts};

use super::args::StartArgs;
use crate::client::ask;
use crate::messages::{CliLinkMessage, CliMeccMessage};
use crate::settings::ask::agreed_while;
use crate::{Client, Exit, Interrupt, Output};

/// How long a board may take: the line that starts it, and a look at each half of it.
const ANSWER_LIMIT: Duration = Duration::from_secs(15);
/// How long one look for the answer of a person waits.
const BREATH: Duration = Duration::from_millis(20);

/// Asks, starts it, and prints who answers then.
pub fn run(args: &StartArgs, out: &mut Output, interrupt: &Interrupt) -> Result<Exit, Exit> {
    let client = Client::connect(&args.connect, PollRate::Off, interrupt)?;
    let (unit, port) = (client.identity.title().to_owned(), client.identity.port.clone());
    if client.identity.family != MOTORVATOR {
        return Err(Exit::Refused.saying(CliMeccMessage::NoBoard { unit, port }));
    }
    let breathe = || if interrupt.sleep(BREATH) { Err(Exit::Interrupted) } else { Ok(()) };
    let question = CliMeccMessage::Start { port: port.clone() };
    agreed_while(&question.to_string(), args.yes, &breathe)?;
    ask(client.device(), Request::StartProgram(RiskAccepted::by_the_user()))?;
    let mut library = None;
    let deadline = Instant::now() + ANSWER_LIMIT;
    while Instant::now() < deadline {
        match client.next_event(interrupt)? {
            Some(Event::Connected(identity)) => {
                library = library.or(MotorvatorFacts::of(&identity).and_then(|facts| facts.library));
            }
            Some(Event::ProgramStarted { .. }) => {
                out.line(match library {
                    Some(version) => CliMeccMessage::LibraryRuns { version, port },
                    None => CliMeccMessage::OtherRuns { port },
                })?;
                return Ok(Exit::Done);
            }
            Some(Event::Failure(failure))
                if matches!(failure.tried.get(), Some(ActMessage::StartProgram)) =>
            {
                return Err(Exit::Refused.saying(failure));
            }
            Some(_) | None => {}
        }
    }
    Err(Exit::NoLink.saying(CliLinkMessage::NoAnswerWithin { seconds: ANSWER_LIMIT.as_secs() }))
}
