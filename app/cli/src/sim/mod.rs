//! `brushwork sim`: simulated controllers for other programs, on a pseudo-terminal or a TCP port.

pub mod motion_mind;
mod scripting;

use std::net::SocketAddr;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use brushwork_canopen::adapter::Form;
use brushwork_mcp_sim::controller::Bus;
use brushwork_mcp_wire::models::MODELS;
use brushwork_mcp_wire::packet_serial::Address;
use brushwork_plant::faults::{FAULT_SYNTAX, Fault};
use brushwork_plant::machine::{Machine, StreamIndex};
use brushwork_plant::presets::presets;
use brushwork_plant::server::{Endpoint, Server, ServerOptions, SimHandle};

use crossbeam_channel::Receiver;

use super::args::{SimArgs, StreamArg};
use super::exit::Exit;
use super::interrupt::Interrupt;
use super::new_file::NewFile;
use super::output::{Output, OutputError, say};
use brushwork_mcp::sim_spec::SimOptions;
use brushwork_mcp::{self as simulation, SimSpec};
use brushwork_motion_mind::sim_spec as motion_mind_spec;

/// Time between two looks at the server, and between two writes of the truth.
const WATCH_INTERVAL: Duration = Duration::from_millis(100);

/// Serves until interrupted.
pub fn run(args: &SimArgs, out: &mut Output, interrupt: &Interrupt) -> Exit {
    if args.list {
        return list(out).map_or_else(Exit::from, |()| Exit::Done);
    }
    let served = if motion_mind::is_asked_for(args) {
        motion_mind::bus_of(args)
            .map_err(usage)
            .and_then(|(bus, what)| serve(args, bus, &what, out, interrupt))
    } else {
        mcp_bus(args).and_then(|(bus, what)| serve(args, bus, &what, out, interrupt))
    };
    served.unwrap_or_else(|exit| exit)
}

fn usage(sentence: String) -> Exit {
    say(sentence);
    Exit::Usage
}

/// Controllers of the MCP family, and what they are in one line.
fn mcp_bus(args: &SimArgs) -> Result<(Bus, String), Exit> {
    if args.mode.is_some() || args.switches.is_given() {
        return Err(usage(format!(
            "--mode, --baud, --encoder and --revision are for --model {}.",
            motion_mind_spec::MODEL
        )));
    }
    let options = SimOptions {
        models: args.model.iter().map(String::as_str).collect(),
        generation: args.generation,
        presets: args.preset.iter().map(String::as_str).collect(),
        addresses: if args.address.is_empty() { vec![Address::ALL[0].get()] } else { args.address.clone() },
        seed: args.seed,
        can: args.can,
        nodes: args.node.clone(),
    };
    let spec = SimSpec::from_options(&options)
        .map_err(|error| usage(format!("Could not start the simulated controller: {error}.")))?;
    let stream = stream_index(args.port);
    let mut bus = simulation::bus_of(&spec, stream).map_err(|error| usage(error.to_string()))?;
    scripting::prepare(args, &mut bus)?;
    let what = if args.can.is_some() { spec.to_string() } else { format!("{spec}, port {}", stream.key()) };
    Ok((bus, what))
}

fn start<M: Machine + 'static>(args: &SimArgs, machine: M) -> Result<SimHandle<M>, Exit> {
    let endpoint = endpoint(args).map_err(usage)?;
    let faults = args.fault.iter().map(|text| fault(text)).collect::<Result<Vec<_>, _>>().map_err(usage)?;
    let stream = stream_index(args.port);
    let options = ServerOptions { stream, pace: args.pace, faults, seed: args.seed };
    Server::spawn(machine, options, &endpoint).map_err(|error| {
        say(format!("Could not start the simulated controller: {error}."));
        Exit::Failed
    })
}

fn endpoint(args: &SimArgs) -> Result<Endpoint, String> {
    match (&args.pty, &args.tcp) {
        (Some(link), _) => Ok(Endpoint::Pty { link: link.clone() }),
        (None, Some(address)) => address.parse::<SocketAddr>().map(Endpoint::Tcp).map_err(|_| {
            format!("\"{address}\" is no address to listen on. Use for example --tcp 127.0.0.1:7000.")
        }),
        (None, None) if cfg!(windows) => Ok(Endpoint::Tcp(SocketAddr::from(([127, 0, 0, 1], 0)))),
        (None, None) => Ok(Endpoint::Pty { link: default_link() }),
    }
}

fn default_link() -> PathBuf {
    std::env::temp_dir().join("brushwork-sim")
}

fn fault(text: &str) -> Result<Fault, String> {
    text.parse().map_err(|error| format!("Could not read --fault {text}: {error}.\n\n{FAULT_SYNTAX}"))
}

fn stream_index(port: StreamArg) -> StreamIndex {
    match port {
        StreamArg::Usb => StreamIndex::Usb,
        StreamArg::Rs232 => StreamIndex::Uart0,
        StreamArg::Ttl1 => StreamIndex::Uart1,
        StreamArg::Ttl2 => StreamIndex::Uart2,
        StreamArg::Ttl3 => StreamIndex::Uart3,
    }
}

fn serve<M: Machine + 'static>(
    args: &SimArgs,
    machine: M,
    what: &str,
    out: &mut Output,
    interrupt: &Interrupt,
) -> Result<Exit, Exit> {
    let mut truth = args.truth.as_deref().map(|path| truth_file(path, args));
    truth.as_ref().map_or(Ok(()), NewFile::check)?;
    let server = &start(args, machine)?;
    let place = server.address();
    let greeting = match args.can {
        Some(form) => {
            let form = if form == Form::default() { String::new() } else { format!(",form={}", form.key()) };
            format!(
                "{what}, behind a CAN adapter on {place}\nConnect with: brushwork --open can:{place}{form}"
            )
        }
        None if motion_mind::is_asked_for(args) => format!("{what}, on {place}"),
        None => format!("{what}, on {place}\nConnect with: brushwork --open {place}"),
    };
    if out.line(greeting).is_err() {
        return Err(Exit::Interrupted);
    }
    say("Ctrl-C ends it.");
    let control = if args.control { scripting::control() } else { None };
    let mut next_truth = Instant::now();
    while !interrupt.sleep(WATCH_INTERVAL) {
        if !server.is_running() {
            say("The simulated controller has ended by itself.");
            return Err(Exit::Failed);
        }
        for line in control.iter().flat_map(Receiver::try_iter) {
            scripting::obey(&line, server);
        }
        if let Some(file) = &mut truth
            && Instant::now() >= next_truth
        {
            next_truth = Instant::now() + WATCH_INTERVAL;
            let text = serde_json::to_string_pretty(&*server.views()).unwrap_or_default();
            // Replaced as a whole, so that a reader never sees half of it.
            file.write(text.as_bytes())?;
        }
    }
    Ok(Exit::Done)
}

fn truth_file<'p>(path: &'p Path, args: &SimArgs) -> NewFile<'p> {
    let file = NewFile::new(path, args.replace);
    match &args.script {
        Some(script) => file.apart_from(script),
        None => file,
    }
}

fn list(out: &mut Output) -> Result<(), OutputError> {
    let mut models: Vec<Vec<String>> = MODELS
        .iter()
        .map(|model| vec![model.key.to_owned(), model.rating().to_owned(), model.assumed.to_owned()])
        .collect();
    models.push(
        [motion_mind_spec::MODEL, motion_mind::RATING, motion_mind::ASSUMED].map(str::to_owned).to_vec(),
    );
    out.table(&["MODEL", "RATING", "ASSUMED"], &models)?;
    out.line("")?;
    let rows: Vec<Vec<String>> =
        presets().iter().map(|preset| vec![preset.key.clone(), preset.description.clone()]).collect();
    out.table(&["PRESET", "WHAT"], &rows)
}
