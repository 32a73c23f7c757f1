//! `brushwork terminal`: commands as they are typed, with what comes back and what it means.
//!
//! How a command is written, shown and understood its family says. Nothing that moves the motor goes out: that takes arming, which a terminal
//! does not do.

use std::time::{Duration, Instant};

use brushwork_link::device::{Event, PollRate, Request};
use brushwork_values::hex;
use clap::Args;
use serde_json::json;

use super::client::ask;
use super::family::{self, Terminal};
use super::interrupt::meanwhile;
use super::messages::CliLinkMessage;
use super::{Client, ConnectArgs, Exit, Interrupt, Output, examples, say};

/// How long a reply may take.
const REPLY_LIMIT: Duration = Duration::from_secs(10);

/// Arguments of `brushwork terminal`.
#[derive(Debug, Args)]
#[command(after_help = examples::terminal_help())]
pub struct TerminalArgs {
    /// The controller.
    #[command(flatten)]
    pub connect: ConnectArgs,
    /// What to send.
    #[arg(value_name = "COMMAND")]
    pub commands: Vec<String>,
    /// Print each exchange as a JSON object a line.
    #[arg(long)]
    pub json: bool,
}

/// Sends each command that is given, or each line of standard input.
pub fn run(args: &TerminalArgs, out: &mut Output, interrupt: &Interrupt) -> Result<Exit, Exit> {
    let client = Client::connect(&args.connect, PollRate::Off, interrupt)?;
    let Some(terminal) = family::of(client.identity.family).terminal(&client.identity) else {
        let title = client.identity.title().to_owned();
        return Err(Exit::Refused.saying(CliLinkMessage::NoTerminal { title }));
    };
    say(CliLinkMessage::TerminalOf {
        title: client.identity.title().to_owned(),
        unit: client.identity.place(),
        port: client.identity.port.clone(),
        set_up: terminal.set_up(),
    });
    let mut given = args.commands.iter().cloned();
    let mut failed = false;
    for id in 1.. {
        let line = if args.commands.is_empty() { typed(&client, interrupt)? } else { given.next() };
        let Some(line) = line else { break };
        failed |= !exchange(&line, id, &*terminal, args, &client, out, interrupt)?;
    }
    Ok(if failed { Exit::Refused } else { Exit::Done })
}

/// The next line of standard input; `None` at its end.
fn typed(client: &Client, interrupt: &Interrupt) -> Result<Option<String>, Exit> {
    let read = || std::io::stdin().lines().next()?.ok();
    let breathe = || {
        if let Some(Event::Failure(failure)) = client.next_event(interrupt)? {
            say(failure.to_string());
        }
        Ok(())
    };
    Ok(meanwhile(read, &breathe)?.flatten())
}

/// Sends one command; whether it went out.
fn exchange(
    line: &str,
    id: u64,
    terminal: &dyn Terminal,
    args: &TerminalArgs,
    client: &Client,
    out: &mut Output,
    interrupt: &Interrupt,
) -> Result<bool, Exit> {
    if line.trim().is_empty() {
        return Ok(true);
    }
    let bytes = match terminal.bytes_of(line) {
        Ok(bytes) => bytes,
        Err(sentence) => {
            say(sentence);
            return Ok(false);
        }
    };
    if terminal.stops_the_motor(&bytes) {
        say(CliLinkMessage::TerminalStops);
    }
    ask(client.device(), Request::Raw { id, bytes: bytes.clone() })?;
    let deadline = Instant::now() + REPLY_LIMIT;
    while Instant::now() < deadline {
        match client.next_event(interrupt)? {
            Some(Event::RawReply { id: answered, result }) if answered == id => {
                return match result {
                    Ok(reply) => tell(&bytes, &reply, terminal, args, out).map(|()| true),
                    Err(failure) => {
                        say(failure.to_string());
                        Ok(false)
                    }
                };
            }
            Some(Event::Failure(failure)) => say(failure.to_string()),
            _ => {}
        }
    }
    Err(Exit::NoLink.saying(CliLinkMessage::NoAnswer))
}

fn tell(
    sent: &[u8],
    reply: &[u8],
    terminal: &dyn Terminal,
    args: &TerminalArgs,
    out: &mut Output,
) -> Result<(), Exit> {
    let asked = terminal.describe_sent(sent);
    let (shown, meaning) = if reply.is_empty() {
        (String::new(), "silence".to_owned())
    } else {
        (terminal.shown(reply), terminal.describe_received(sent, reply).text)
    };
    let printed = if args.json {
        out.json_line(&json!({
            "sent": hex(sent),
            "asked": asked.text,
            "received": hex(reply),
            "meaning": meaning,
        }))
    } else {
        out.line(format!("> {:<32}  {}", terminal.shown(sent), asked.text))
            .and_then(|()| out.line(format!("< {shown:<32}  {meaning}")))
    };
    printed.map_err(Exit::from)
}
