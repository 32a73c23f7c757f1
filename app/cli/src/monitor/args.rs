//! The arguments of `brushwork monitor`.

use std::path::PathBuf;
use std::time::Duration;

use clap::Args;

use crate::examples;
use crate::shared_args::{ConnectArgs, parse_seconds};

const NOTE: &str = "With --pty or --tcp every byte is passed on unchanged, both ways. When that ends while the other program has motors \
                    running, they are stopped.\n\
                    --decode reads bytes in hexadecimal, with or without 0x, separated by spaces or commas; # starts a comment. An \
                    empty line is a pause.";

/// Arguments of `brushwork monitor`.
#[derive(Debug, Args)]
#[command(after_help = examples::after("monitor", &[
    "monitor --connect {sim} --for 2",
    "monitor --connect /dev/ttyACM0 --pty /tmp/tap     (another program opens /tmp/tap)",
    "monitor --connect /dev/ttyUSB0,baud=115200 --tcp 127.0.0.1:7001 --json",
    "echo '80 15  80 18' | monitor --decode -",
], NOTE))]
pub struct MonitorArgs {
    /// The controller.
    #[command(flatten)]
    pub connect: ConnectArgs,
    /// Stand between another program and the controller: serve a pseudo-terminal at PATH and show what passes.
    #[arg(long, value_name = "PATH", conflicts_with_all = ["tcp", "decode"])]
    pub pty: Option<PathBuf>,
    /// As --pty, on a TCP port of this computer; port 0 picks a free one.
    #[arg(long, value_name = "127.0.0.1:PORT", conflicts_with = "decode")]
    pub tcp: Option<String>,
    /// Decode requests from FILE ("-" for standard input) instead of a live line.
    #[arg(long, value_name = "FILE", conflicts_with = "duration")]
    pub decode: Option<PathBuf>,
    /// Firmware generation of packet serial (default: told by the traffic, starting at 1).
    #[arg(long, value_name = "1..4", value_parser = clap::value_parser!(u8).range(1..=4))]
    pub generation: Option<u8>,
    /// End after this time (default: on Ctrl-C).
    #[arg(long = "for", value_name = "SECONDS", value_parser = parse_seconds)]
    pub duration: Option<Duration>,
    /// Print a JSON object a line.
    #[arg(long)]
    pub json: bool,
}
