//! `brushwork settings copy-motor`: one motor's settings for the other.

use brushwork_link::settings::copy_motor;

use super::args::CopyMotorArgs;
use super::controller::Controller;
use super::write::{self, Wanted};
use crate::{Exit, Interrupt, Output};

/// Shows, asks, writes, reads back.
pub fn run(args: &CopyMotorArgs, out: &mut Output, interrupt: &Interrupt) -> Result<Exit, Exit> {
    let controller = Controller::connect(&args.connect, interrupt)?;
    let ram = controller.read()?;
    let copied = copy_motor(&ram.table, &ram.image, usize::from(args.from), controller.identity().simulated);
    let mut wanted = Wanted::of(copied.wanted);
    wanted.left_out_lines = copied.left_out.iter().map(ToString::to_string).collect();
    wanted.left_out = copied.left_out;
    write::carry_out(&controller, &ram, &wanted, &args.how, out)
}
