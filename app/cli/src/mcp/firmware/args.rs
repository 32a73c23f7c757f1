//! The arguments of `brushwork firmware`.

use std::path::PathBuf;

use clap::{Args, Subcommand};

use crate::{ConnectArgs, Replace};

/// Arguments of `brushwork firmware`.
#[derive(Debug, Args)]
#[command(after_help = "Examples:\n  \
    brushwork firmware info --connect /dev/ttyACM0\n  \
    brushwork firmware image new.bin --model mcp266 --version 1.1.0\n  \
    brushwork firmware update new.bin --connect sim:mcp266\n\n\
    No firmware image is published: an update needs a file that you have.")]
pub struct FirmwareArgs {
    /// What to do.
    #[command(subcommand)]
    pub action: FirmwareAction,
}

/// What to do about firmware.
#[derive(Debug, Subcommand)]
pub enum FirmwareAction {
    /// Show what is installed and what is known about it.
    Info(InfoArgs),
    /// Back the settings up and send an image to the controller.
    Update(UpdateArgs),
    /// Make an image for simulated controllers, to try an update with.
    Image(ImageArgs),
}

/// Arguments of `brushwork firmware info`.
#[derive(Debug, Args)]
#[command(after_help = "Example:\n  brushwork firmware info --connect /dev/ttyACM0 --json")]
pub struct InfoArgs {
    /// The controller.
    #[command(flatten)]
    pub connect: ConnectArgs,
    /// Print JSON.
    #[arg(long)]
    pub json: bool,
}

/// Arguments of `brushwork firmware update`.
#[derive(Debug, Args)]
#[command(after_help = "Examples:\n  \
    brushwork firmware update mcp266.bin --connect /dev/ttyACM0\n  \
    brushwork firmware update mcp266.bin --connect /dev/ttyACM0 --resume --model mcp266\n\n\
    The risks are shown first and have to be accepted, by typing \"update\" or with --accept-risk. The settings are read into a \
    backup before anything is erased. Ctrl-C ends the update only as long as nothing was erased. Afterwards the controller is \
    connected again: its version and its settings are compared with the earlier ones.\n\n\
    Exit codes: 0 updated and the settings are those of the backup; 5 the version did not change, or is not the image's; 6 updated, and \
    settings differ; 3 it did not come back. A controller that does not come back: switch it off and on, then --resume. To practise \
    that: brushwork sim --control, and \"power cycle\" on its standard input.")]
pub struct UpdateArgs {
    /// The image.
    #[arg(value_name = "FILE")]
    pub file: PathBuf,
    /// The controller.
    #[command(flatten)]
    pub connect: ConnectArgs,
    /// Where the settings are backed up to, as a profile (default: beside the image, with model and time in its name).
    #[arg(long, value_name = "FILE", conflicts_with = "resume")]
    pub backup: Option<PathBuf>,
    /// Whether an older backup of that name is replaced.
    #[command(flatten)]
    pub replace: Replace,
    /// Write the settings of the backup back, and save them, where they differ after the update.
    #[arg(long)]
    pub restore: bool,
    /// Accept the risks without being asked.
    #[arg(long)]
    pub accept_risk: bool,
    /// The controller waits in its loader since an update broke: send the image at once.
    #[arg(long, requires = "model")]
    pub resume: bool,
    /// The controller's model, which it cannot tell from its loader.
    #[arg(long, value_name = "MODEL", requires = "resume")]
    pub model: Option<String>,
    /// The controller is simulated by another program: images made for simulated controllers are sent to it.
    #[arg(long)]
    pub simulated: bool,
}

/// Arguments of `brushwork firmware image`.
#[derive(Debug, Args)]
#[command(
    after_help = "Example:\n  brushwork firmware image new.bin --model mcp266 --version 1.1.0 --generation 3"
)]
pub struct ImageArgs {
    /// Where it is written.
    #[arg(value_name = "FILE")]
    pub file: PathBuf,
    /// Whether an older image is replaced.
    #[command(flatten)]
    pub replace: Replace,
    /// The model it is for.
    #[arg(long, value_name = "MODEL", default_value = "mcp266")]
    pub model: String,
    /// The version that the simulated controller reports afterwards.
    #[arg(long, value_name = "1.1.0", default_value = "1.1.0")]
    pub version: String,
    /// The generation that it is of afterwards.
    #[arg(long, value_name = "1..4", default_value_t = 1, value_parser = clap::value_parser!(u8).range(1..=4))]
    pub generation: u8,
}
