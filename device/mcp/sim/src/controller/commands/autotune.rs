//! The relay test behind auto-tuning: commands 84 to 89.

use super::super::answer::{Answer, Arguments, Handlers, On, tell};
use super::super::firmware::Firmware;
use crate::motion::{MotionCommand, RelayCommand, RelayOn};
use brushwork_mcp_wire::packet_serial::commands;
use brushwork_mcp_wire::packet_serial::name::*;
use brushwork_values::Motor;
use brushwork_values::Motor::{M1, M2};

pub(super) const HANDLERS: Handlers = &[
    &On(commands::AUTOTUNE_VELOCITY_M1, |unit, args| unit.drive(M1, relay(RelayOn::Speed, args))),
    &On(commands::AUTOTUNE_VELOCITY_M2, |unit, args| unit.drive(M2, relay(RelayOn::Speed, args))),
    &On(commands::AUTOTUNE_POSITION_M1, |unit, args| unit.drive(M1, relay(RelayOn::Position, args))),
    &On(commands::AUTOTUNE_POSITION_M2, |unit, args| unit.drive(M2, relay(RelayOn::Position, args))),
    &On(commands::READ_AUTOTUNE_M1, |unit, _| result(unit, M1)),
    &On(commands::READ_AUTOTUNE_M2, |unit, _| result(unit, M2)),
];

fn relay<const L: u8>(on: RelayOn, args: &Arguments<'_, L>) -> MotionCommand {
    MotionCommand::Relay(RelayCommand {
        on,
        amplitude_raw: args.u32(AMPLITUDE),
        hysteresis: args.int_or(HYSTERESIS, 0) as u32,
    })
}

fn result<const L: u8>(unit: &Firmware, motor: Motor) -> Answer<L> {
    let [amplitude, period] = unit.channels[motor.index()].relay_result_raw();
    Answer::of([tell(AMPLITUDE, amplitude.into()), tell(PERIOD, period.into())])
}
