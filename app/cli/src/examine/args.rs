//! Arguments of `brushwork examine`.

use std::path::PathBuf;

use brushwork_values::Motor;
use clap::Args;

use crate::{ConnectArgs, Replace};

/// Arguments of `brushwork examine`.
#[derive(Debug, Args)]
#[command(after_help = "Examples:\n  \
    brushwork examine --connect /dev/ttyACM0\n  \
    brushwork examine --connect /dev/ttyUSB0,baud=115200 --json unit.json -o unit.txt\n  \
    brushwork examine --connect sim:mcp266,generation=4 --yes guesses,layout,motor --json unit.json\n  \
    brushwork sim --like unit.json\n\n\
    It reads at first. Before each step that does more (guesses, layout, motor, saving) it says what would happen and asks; --yes STEP\n\
    agrees beforehand, to that step alone. The report says what was not asked, and holds nothing of this computer. Its JSON is an object with\n\
    schema \"brushwork-examination\", version 1: unit, line, commands (command, presence, reply_bytes, generations), answers (key, state\n\
    answered|unclear|not_asked, value, sentence), not_askable. Members may be added within a version.")]
pub struct ExamineArgs {
    /// The controller.
    #[command(flatten)]
    pub connect: ConnectArgs,
    /// Whose loops are looked at in the step that moves a motor.
    #[arg(long, value_name = "1|2", default_value = "1", value_parser = clap::value_parser!(u8).range(1..=2))]
    pub motor: u8,
    /// Take a step without being asked, or several with commas between them; no other is agreed to by it.
    #[arg(long, value_name = "STEP", value_delimiter = ',')]
    pub yes: Vec<String>,
    /// Write the report as JSON to FILE.
    #[arg(long, value_name = "FILE")]
    pub json: Option<PathBuf>,
    /// Write the report as text to FILE instead of standard output.
    #[arg(long, short = 'o', value_name = "FILE")]
    pub output: Option<PathBuf>,
    /// Whether older reports are replaced.
    #[command(flatten)]
    pub replace: Replace,
}

impl ExamineArgs {
    /// The motor that is meant.
    pub fn motor(&self) -> Motor {
        if self.motor == 2 { Motor::M2 } else { Motor::M1 }
    }
}
