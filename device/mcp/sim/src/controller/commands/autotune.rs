//! The relay test behind auto-tuning: commands 84 to 89.

use super::super::answer::{Answer, Arguments, Handlers};
use super::super::firmware::Firmware;
use crate::motion::{MotionCommand, RelayCommand, RelayOn};
use brushwork_mcp_wire::packet_serial::number;
use brushwork_values::Motor;
use brushwork_values::Motor::{M1, M2};

pub(super) const HANDLERS: Handlers = &[
    (number::AUTOTUNE_VELOCITY_M1, |unit, args| unit.drive(M1, relay(RelayOn::Speed, args))),
    (number::AUTOTUNE_VELOCITY_M2, |unit, args| unit.drive(M2, relay(RelayOn::Speed, args))),
    (number::AUTOTUNE_POSITION_M1, |unit, args| unit.drive(M1, relay(RelayOn::Position, args))),
    (number::AUTOTUNE_POSITION_M2, |unit, args| unit.drive(M2, relay(RelayOn::Position, args))),
    (number::READ_AUTOTUNE_M1, |unit, _| result(unit, M1)),
    (number::READ_AUTOTUNE_M2, |unit, _| result(unit, M2)),
];

fn relay(on: RelayOn, args: &Arguments<'_>) -> MotionCommand {
    MotionCommand::Relay(RelayCommand {
        on,
        amplitude_raw: args.u32("amplitude"),
        hysteresis: args.u32("hysteresis"),
    })
}

fn result(unit: &Firmware, motor: Motor) -> Answer {
    let [amplitude, period] = unit.channels[motor.index()].relay_result_raw();
    Answer::ints([("amplitude", amplitude.into()), ("period", period.into())])
}
