//! Writes of registers as steps of a plan.

use crate::messages::MotionMindSettingsMessage;
use brushwork_link::Message;
use brushwork_link::messages::PlanMessage;
use brushwork_motion_mind_wire::register_number as number;
use brushwork_motion_mind_wire::{Address, Command, describe_command, encode_frame};

use brushwork_link::settings::SettingValue;
use brushwork_link::settings::SettingsImage;
use brushwork_link::settings::{Stage, Step};
use brushwork_link::unit::UnitAddress;

/// The name of the first value of a write; the second is the register's own.
pub const INDEX: &str = "register";

/// When a register is written: limits first, then what they limit, then the switches, the address last.
pub fn stage(index: u8) -> Stage {
    match index {
        number::AMPSLIMIT | number::PWMLIMIT | number::VNLIMIT | number::VPLIMIT => Stage::Limits,
        number::RCMAX | number::RCMIN | number::RCBAND => Stage::Pins,
        number::FUNCTION | number::FUNCTION2 => Stage::Priorities,
        number::ADDRESS => Stage::Address,
        _ => Stage::Motors,
    }
}

/// Puts a PIDSCALAR that grows before the terms that it divides. They are written in the order of their numbers, the divisor last: so
/// a mix of old and new ones is never stronger than both, and a motor that its loop holds is not kicked in between.
pub fn weaken_first(steps: &mut [Step], ram: &SettingsImage) {
    const TERMS: [u8; 4] = [number::PTERM, number::ITERM, number::DTERM, number::PIDSCALAR];
    let writes =
        |step: &Step, number: u8| step.arguments.first().map(|(_, raw)| *raw) == Some(i64::from(number));
    let Some(scalar) = steps.iter().position(|step| writes(step, number::PIDSCALAR)) else { return };
    let Some(first) = steps.iter().position(|step| TERMS.iter().any(|term| writes(step, *term))) else {
        return;
    };
    let wanted = steps[scalar].arguments.get(1).map(|(_, value)| *value);
    let held = ram.get("register.pidscalar").and_then(SettingValue::int);
    if first < scalar && wanted > held {
        steps[first..=scalar].rotate_right(1);
    }
}

/// "write PTERM".
pub fn step_title(step: &Step) -> String {
    let name = step.arguments.get(1).map_or("a register", |(name, _)| *name);
    format!("write {name}")
}

/// The bytes of a step in the binary protocol.
pub fn step_bytes(step: &Step, address: UnitAddress) -> Result<Vec<u8>, Message> {
    let (address, command) = parts(step, address)?;
    encode_frame(address, &command).map_err(Message::error)
}

/// A step in words.
pub fn step_words(step: &Step, address: UnitAddress) -> String {
    parts(step, address)
        .map_or_else(|why| why.to_string(), |(address, command)| describe_command(address, &command))
}

fn parts(step: &Step, address: UnitAddress) -> Result<(Address, Command), MotionMindSettingsMessage> {
    let address = Address::unit(address.get()).ok_or(MotionMindSettingsMessage::NoAddress { address })?;
    let values: Vec<i64> = step.arguments.iter().map(|(_, value)| *value).collect();
    let command = Command::from_parts(step.command, &values);
    command.map(|command| (address, command)).ok_or(MotionMindSettingsMessage::ValuesDoNotFit)
}

/// What the user should know of the steps besides their values.
pub fn warnings(steps: &[Step]) -> Vec<Message> {
    let mut warnings = Vec::new();
    if steps.iter().any(|step| step.stage == Stage::Address) {
        warnings.push(PlanMessage::NewAddress.into());
    }
    let baud = |key: &str| key == "function2.baud38400" || key == "function2.baud115200";
    if steps.iter().flat_map(|step| &step.keys).any(|key| baud(key)) {
        warnings.push(MotionMindSettingsMessage::BaudRate.into());
    }
    warnings
}

#[cfg(test)]
mod tests {
    use super::*;
    use brushwork_link::settings::SettingsTable;
    use brushwork_link::settings::{WriteOptions, plan};

    /// The names of the registers that are written to get from the factory's values to these, in order.
    fn order(values: &[(&str, i64)]) -> Vec<&'static str> {
        brushwork_link::register(&crate::MotionMindDriver);
        let table = SettingsTable::new(crate::subject(3));
        let ram = table.default_image();
        let changes =
            values.iter().map(|(key, value)| ((*key).to_owned(), SettingValue::Int(*value))).collect();
        let plan = plan(&table, &ram, &changes, WriteOptions::default()).expect("it can be written");
        plan.steps.iter().filter_map(|step| Some(step.arguments.get(1)?.0)).collect()
    }

    #[test]
    fn gains_never_meet_a_divisor_that_makes_them_stronger_than_both_sets_are() {
        let terms = [("register.pterm", 50_000), ("register.dterm", 60_000)];
        let with = |scalar| order(&[terms[0], terms[1], ("register.pidscalar", scalar)]);
        assert_eq!(with(17), ["PIDSCALAR", "PTERM", "DTERM"], "a divisor that grows comes first");
        assert_eq!(with(9), ["PTERM", "DTERM", "PIDSCALAR"], "one that shrinks comes last");
    }
}
