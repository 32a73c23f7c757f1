//! Who follows the traffic that the arguments ask for.

use brushwork_link::FamilyChoice;

use super::args::MonitorArgs;
use super::follower::Follower;
use crate::{Exit, client, family};

/// The follower of the family that is meant, or of the first one.
pub fn follower(args: &MonitorArgs) -> Result<Box<dyn Follower>, Exit> {
    let target = client::target(&args.connect)?;
    // Bytes from a file come from no target, unless one is named for its family.
    let choice = match args.connect.family {
        named if args.decode.is_some() && named != FamilyChoice::AUTO => named,
        _ => client::family(&target, &args.connect),
    };
    Ok(family::chosen(choice).follower(args.generation))
}
