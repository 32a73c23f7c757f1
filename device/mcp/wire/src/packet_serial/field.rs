//! The fields that many commands share. Each takes the name it has in its layout.

use super::name::Name;
use super::scale;
use brushwork_values::{Field, Kind, Unit};

/// A plain number.
pub(super) const fn field<N: Name>(_name: N, kind: Kind, doc: &'static str) -> Field {
    Field::new(N::TEXT, kind, doc)
}

/// Signed duty.
pub(super) const fn duty(name: impl Name) -> Field {
    field(name, Kind::I16, "signed duty of the bridge")
        .scaled(Unit::Percent, scale::DUTY_PERCENT, 2)
        .range(-scale::FULL_DUTY_RAW, scale::FULL_DUTY_RAW)
}

/// Rate of change of duty.
pub(super) const fn duty_accel(name: impl Name) -> Field {
    field(name, Kind::U32, "how fast the duty changes")
        .scaled(Unit::PercentPerSecond, scale::DUTY_ACCEL_PERCENT_PER_S, 1)
        .range(0, scale::MAX_DUTY_ACCEL_RAW)
}

/// Signed speed.
pub(super) const fn speed(name: impl Name) -> Field {
    field(name, Kind::I32, "signed speed").unit(Unit::CountsPerSecond)
}

/// Acceleration or deceleration of a speed.
pub(super) const fn accel(name: impl Name) -> Field {
    field(name, Kind::U32, "how fast the speed changes").unit(Unit::CountsPerSecondSquared)
}

/// Unsigned distance; the direction is the sign of the speed.
pub(super) const fn distance(name: impl Name) -> Field {
    field(name, Kind::U32, "distance to travel; the sign of the speed gives the direction").unit(Unit::Counts)
}

/// Signed position or encoder count.
pub(super) const fn position(name: impl Name) -> Field {
    field(name, Kind::I32, "signed position").unit(Unit::Counts)
}

/// Battery voltage or limit.
pub(super) const fn volts(name: impl Name) -> Field {
    field(name, Kind::U16, "voltage in tenths of a volt").scaled(Unit::Volts, scale::VOLTAGE_VOLTS, 1)
}

/// Board temperature.
pub(super) const fn celsius(name: impl Name) -> Field {
    field(name, Kind::I16, "temperature in tenths of a degree").scaled(
        Unit::Celsius,
        scale::TEMPERATURE_CELSIUS,
        1,
    )
}

/// Motor current as measured.
pub(super) const fn amps(name: impl Name) -> Field {
    field(name, Kind::I16, "current in steps of 10 mA").scaled(Unit::Amps, scale::CURRENT_AMPS, 2)
}

/// One byte.
pub(super) const fn byte(name: impl Name, doc: &'static str) -> Field {
    field(name, Kind::U8, doc)
}
