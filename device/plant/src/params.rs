//! What an axis is made of: every figure a person would look up on a data sheet or guess, with its unit in its name.
//!
//! The same structures are the preset file format ([`crate::presets`]), so unknown keys are refused.

use serde::{Deserialize, Serialize};

/// One axis: motor, gear, load, encoder and current sensor.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct AxisParams {
    /// The motor itself.
    pub motor: MotorParams,
    /// What stands between the motor shaft and the output shaft.
    #[serde(default)]
    pub gear: GearParams,
    /// What hangs on the output shaft.
    #[serde(default)]
    pub load: LoadParams,
    /// How the controller sees the position.
    pub encoder: EncoderParams,
    /// How the controller sees the current.
    #[serde(default)]
    pub current_sensor: CurrentSensorParams,
}

/// A brushed DC motor with constant field.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct MotorParams {
    /// Winding, brush and lead resistance, above zero.
    pub armature_ohms: f64,
    /// Winding inductance; zero is allowed and means that the current follows at once.
    pub armature_henries: f64,
    /// Torque per ampere, above zero.
    pub torque_constant_newton_metres_per_amp: f64,
    /// Volts per radian per second. Equal to the torque constant in an ideal motor.
    pub back_emf_volts_per_radian_per_second: f64,
    /// Inertia of the rotor and of all that turns with it on the motor shaft, above zero.
    pub rotor_inertia_kilogram_square_metres: f64,
    /// Friction on the motor shaft: bearings, brushes, first gear stage.
    #[serde(default)]
    pub friction: FrictionParams,
}

/// Friction of one shaft. All zero means none.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct FrictionParams {
    /// Torque per speed.
    pub viscous_newton_metre_seconds_per_radian: f64,
    /// Torque against the motion while the shaft turns.
    pub coulomb_newton_metres: f64,
    /// Torque that must be exceeded before a shaft at rest turns; less than Coulomb friction counts as equal to it.
    pub stiction_newton_metres: f64,
}

/// Gear between motor and output shaft.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct GearParams {
    /// Motor turns for one turn of the output, above zero; 1 for direct drive.
    pub ratio: f64,
    /// Whole backlash between the teeth, measured at the output shaft.
    pub backlash_radians: f64,
}

impl Default for GearParams {
    fn default() -> Self {
        Self { ratio: 1.0, backlash_radians: 0.0 }
    }
}

/// What the output shaft carries.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct LoadParams {
    /// Inertia on the output shaft. Must be above zero with backlash or a coupling.
    pub inertia_kilogram_square_metres: f64,
    /// Friction on the output shaft.
    pub friction: FrictionParams,
    /// Constant torque that pulls the output shaft towards lower positions, as a hanging weight does. Negative pulls upwards.
    pub torque_newton_metres: f64,
    /// A springy shaft between gear and load makes the load a second mass.
    pub coupling: Option<CouplingParams>,
    /// Travel end stops on the output shaft; none means that it turns freely.
    pub travel: Option<TravelParams>,
}

/// Spring and damper between gear and load, measured at the output shaft.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct CouplingParams {
    /// Torque per twist, above zero.
    pub stiffness_newton_metres_per_radian: f64,
    /// Torque per twist speed.
    #[serde(default)]
    pub damping_newton_metre_seconds_per_radian: f64,
}

/// Range of the output shaft, from where it starts (0).
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct TravelParams {
    /// Lower end, at most 0.
    pub lower_radians: f64,
    /// Upper end, at least 0 and above the lower one.
    pub upper_radians: f64,
    /// What the stops are made of.
    #[serde(default)]
    pub stop: StopKind,
}

/// What a travel stop is made of.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
pub enum StopKind {
    /// Does not give and does not throw back.
    #[default]
    Hard,
    /// A stiff spring with a damper; it can only push.
    Spring {
        /// Torque per radian beyond the end.
        stiffness_newton_metres_per_radian: f64,
        /// Torque per speed while beyond the end.
        damping_newton_metre_seconds_per_radian: f64,
    },
}

/// How the position is measured.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct EncoderParams {
    /// What the encoder gives.
    pub kind: EncoderKind,
    /// Counts for one turn of the shaft it sits on (quadrature: all four edges), above zero.
    pub counts_per_turn: f64,
    /// The shaft it sits on.
    #[serde(default)]
    pub side: ShaftSide,
    /// Reading at the start position.
    #[serde(default)]
    pub start_counts: f64,
    /// An absolute encoder that turns on from 4095 to 0; otherwise it stays at its end.
    #[serde(default)]
    pub wraps: bool,
    /// Standard deviation of each reading, for absolute encoders that are noisy by nature.
    #[serde(default)]
    pub noise_counts: f64,
}

/// What an encoder gives.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum EncoderKind {
    /// A and B pulses, counted without bound.
    Quadrature,
    /// A voltage of 0 to 5.1 V, read as 0 to 4095 (MCP manual 2.4.9, command 16).
    Analog,
    /// A pulse width, read as 0 to 4095. Assumed: 1 microsecond per count.
    Pulse,
}

/// The shaft an encoder sits on.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum ShaftSide {
    /// The motor shaft, ahead of gear and backlash.
    #[default]
    Motor,
    /// The load, behind gear, backlash and coupling.
    Load,
}

/// How the controller measures the motor current. The 10 mA steps of the wire are not made here.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct CurrentSensorParams {
    /// Standard deviation of one reading.
    pub noise_amps: f64,
    /// What it reads at no current.
    pub offset_amps: f64,
}

/// Why a machine cannot be built.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum ParamsError {
    /// A figure is out of its range or not a number.
    #[error("{name} is {got}: it must be {needed}")]
    OutOfRange {
        /// Path of the figure, as in the preset file.
        name: &'static str,
        /// What was given.
        got: f64,
        /// What would be accepted.
        needed: &'static str,
    },
    /// Two masses were asked for, but the load has none.
    #[error("backlash or a coupling needs a load with inertia: give load.inertia_kilogram_square_metres")]
    NoLoadInertia,
}

impl AxisParams {
    /// Checks every figure; an axis is only built from parameters that pass.
    pub fn validate(&self) -> Result<(), ParamsError> {
        let motor = &self.motor;
        above_zero("motor.armature_ohms", motor.armature_ohms)?;
        not_negative("motor.armature_henries", motor.armature_henries)?;
        above_zero(
            "motor.torque_constant_newton_metres_per_amp",
            motor.torque_constant_newton_metres_per_amp,
        )?;
        above_zero("motor.back_emf_volts_per_radian_per_second", motor.back_emf_volts_per_radian_per_second)?;
        above_zero("motor.rotor_inertia_kilogram_square_metres", motor.rotor_inertia_kilogram_square_metres)?;
        motor.friction.validate()?;
        above_zero("gear.ratio", self.gear.ratio)?;
        not_negative("gear.backlash_radians", self.gear.backlash_radians)?;
        self.load.validate()?;
        if self.is_two_mass() && self.load.inertia_kilogram_square_metres == 0.0 {
            return Err(ParamsError::NoLoadInertia);
        }
        above_zero("encoder.counts_per_turn", self.encoder.counts_per_turn)?;
        finite("encoder.start_counts", self.encoder.start_counts)?;
        not_negative("encoder.noise_counts", self.encoder.noise_counts)?;
        not_negative("current_sensor.noise_amps", self.current_sensor.noise_amps)?;
        finite("current_sensor.offset_amps", self.current_sensor.offset_amps)
    }

    /// Whether the load moves apart from the motor.
    pub fn is_two_mass(&self) -> bool {
        self.load.coupling.is_some() || self.gear.backlash_radians > 0.0
    }

    /// All inertia as the motor shaft feels it when nothing gives.
    pub fn total_inertia_kilogram_square_metres(&self) -> f64 {
        self.motor.rotor_inertia_kilogram_square_metres
            + self.load.inertia_kilogram_square_metres / (self.gear.ratio * self.gear.ratio)
    }

    /// All friction as the motor shaft feels it when nothing gives.
    pub fn total_friction(&self) -> FrictionParams {
        let (motor, load, ratio) = (self.motor.friction, self.load.friction, self.gear.ratio);
        FrictionParams {
            viscous_newton_metre_seconds_per_radian: motor.viscous_newton_metre_seconds_per_radian
                + load.viscous_newton_metre_seconds_per_radian / (ratio * ratio),
            coulomb_newton_metres: motor.coulomb_newton_metres + load.coulomb_newton_metres / ratio,
            stiction_newton_metres: motor.breakaway_newton_metres() + load.breakaway_newton_metres() / ratio,
        }
    }

    /// Steady motor speed in radians per second at a constant armature voltage, friction and load torque included; 0 where
    /// the motor cannot keep turning. The sign is that of the voltage.
    pub fn steady_speed_radians_per_second(&self, volts: f64) -> f64 {
        let motor = &self.motor;
        let friction = self.total_friction();
        let forward = volts.signum();
        let against =
            friction.coulomb_newton_metres + forward * self.load.torque_newton_metres / self.gear.ratio;
        let torque =
            motor.torque_constant_newton_metres_per_amp * volts.abs() / motor.armature_ohms - against;
        let slope = friction.viscous_newton_metre_seconds_per_radian
            + motor.torque_constant_newton_metres_per_amp * motor.back_emf_volts_per_radian_per_second
                / motor.armature_ohms;
        forward * (torque / slope).max(0.0)
    }

    /// Encoder counts per second at that steady speed: what QPPS should be at 100 % duty of `volts`.
    pub fn steady_counts_per_second(&self, volts: f64) -> f64 {
        self.steady_speed_radians_per_second(volts) * self.counts_per_motor_radian()
    }

    /// Encoder counts per radian of the motor shaft.
    pub fn counts_per_motor_radian(&self) -> f64 {
        let gear = match self.encoder.side {
            ShaftSide::Motor => 1.0,
            ShaftSide::Load => self.gear.ratio,
        };
        self.encoder.counts_per_turn / std::f64::consts::TAU / gear
    }

    /// Current in amperes with the shaft locked.
    pub fn stall_amps(&self, volts: f64) -> f64 {
        volts / self.motor.armature_ohms
    }

    /// Time constant of the speed in seconds when the inductance is neglected and nothing gives.
    pub fn mechanical_time_constant_s(&self) -> f64 {
        let motor = &self.motor;
        let damping = self.total_friction().viscous_newton_metre_seconds_per_radian
            + motor.torque_constant_newton_metres_per_amp * motor.back_emf_volts_per_radian_per_second
                / motor.armature_ohms;
        self.total_inertia_kilogram_square_metres() / damping
    }
}

impl FrictionParams {
    /// Torque at which a shaft at rest starts to turn.
    pub fn breakaway_newton_metres(&self) -> f64 {
        self.stiction_newton_metres.max(self.coulomb_newton_metres)
    }

    fn validate(&self) -> Result<(), ParamsError> {
        not_negative(
            "friction.viscous_newton_metre_seconds_per_radian",
            self.viscous_newton_metre_seconds_per_radian,
        )?;
        not_negative("friction.coulomb_newton_metres", self.coulomb_newton_metres)?;
        not_negative("friction.stiction_newton_metres", self.stiction_newton_metres)
    }
}

impl LoadParams {
    fn validate(&self) -> Result<(), ParamsError> {
        not_negative("load.inertia_kilogram_square_metres", self.inertia_kilogram_square_metres)?;
        self.friction.validate()?;
        finite("load.torque_newton_metres", self.torque_newton_metres)?;
        if let Some(coupling) = &self.coupling {
            above_zero(
                "load.coupling.stiffness_newton_metres_per_radian",
                coupling.stiffness_newton_metres_per_radian,
            )?;
            not_negative(
                "load.coupling.damping_newton_metre_seconds_per_radian",
                coupling.damping_newton_metre_seconds_per_radian,
            )?;
        }
        self.travel.as_ref().map_or(Ok(()), TravelParams::validate)
    }
}

impl TravelParams {
    fn validate(&self) -> Result<(), ParamsError> {
        within("load.travel.lower_radians", self.lower_radians, self.lower_radians <= 0.0, "at most 0")?;
        let above = self.upper_radians >= 0.0 && self.upper_radians > self.lower_radians;
        within("load.travel.upper_radians", self.upper_radians, above, "at least 0 and above the lower end")?;
        if let StopKind::Spring {
            stiffness_newton_metres_per_radian,
            damping_newton_metre_seconds_per_radian,
        } = self.stop
        {
            above_zero(
                "load.travel.stop.stiffness_newton_metres_per_radian",
                stiffness_newton_metres_per_radian,
            )?;
            not_negative(
                "load.travel.stop.damping_newton_metre_seconds_per_radian",
                damping_newton_metre_seconds_per_radian,
            )?;
        }
        Ok(())
    }
}

/// A rigid axis described as a data sheet or a population of test plants does: by what it reaches, not by its constants.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Datasheet {
    /// Voltage at which the other figures hold.
    pub volts: f64,
    /// Steady speed of the motor shaft at that voltage, its own friction included.
    pub no_load_radians_per_second: f64,
    /// Current with the shaft locked.
    pub stall_amps: f64,
    /// Time constant of the speed, from voltage to speed, with the whole load on.
    pub mechanical_time_constant_s: f64,
    /// Time constant of the current (L / R).
    pub electrical_time_constant_s: f64,
    /// Coulomb friction over stall torque.
    pub coulomb_share: f64,
    /// Stiction over Coulomb friction, 1 or more.
    pub stiction_ratio: f64,
    /// Viscous friction torque at no-load speed over stall torque.
    pub viscous_share: f64,
    /// Share of the inertia that belongs to the load, 0 to below 1.
    pub load_share: f64,
}

impl Datasheet {
    /// Motor, gear and load that reach these figures; friction stands on the motor shaft, the encoder is as given.
    pub fn axis(&self, gear: GearParams, encoder: EncoderParams) -> AxisParams {
        let armature_ohms = self.volts / self.stall_amps;
        // At no-load speed the current covers friction alone: volts = R i + Ke w with i = (coulomb + viscous) share of stall.
        let constant =
            self.volts * (1.0 - self.coulomb_share - self.viscous_share) / self.no_load_radians_per_second;
        let stall_torque = constant * self.stall_amps;
        let viscous = self.viscous_share * stall_torque / self.no_load_radians_per_second;
        let inertia = self.mechanical_time_constant_s * (viscous + constant * constant / armature_ohms);
        let coulomb = self.coulomb_share * stall_torque;
        AxisParams {
            motor: MotorParams {
                armature_ohms,
                armature_henries: self.electrical_time_constant_s * armature_ohms,
                torque_constant_newton_metres_per_amp: constant,
                back_emf_volts_per_radian_per_second: constant,
                rotor_inertia_kilogram_square_metres: inertia * (1.0 - self.load_share),
                friction: FrictionParams {
                    viscous_newton_metre_seconds_per_radian: viscous,
                    coulomb_newton_metres: coulomb,
                    stiction_newton_metres: coulomb * self.stiction_ratio,
                },
            },
            gear,
            load: LoadParams {
                inertia_kilogram_square_metres: inertia * self.load_share * gear.ratio * gear.ratio,
                ..LoadParams::default()
            },
            encoder,
            current_sensor: CurrentSensorParams::default(),
        }
    }
}

impl CouplingParams {
    /// The spring and damper that give an axis a free resonance of `hertz` (motor and load oscillating against each other) with
    /// `damping_ratio` of critical damping.
    pub fn with_resonance(params: &AxisParams, hertz: f64, damping_ratio: f64) -> Self {
        let omega = std::f64::consts::TAU * hertz;
        let oscillating = swinging_inertia(params);
        Self {
            stiffness_newton_metres_per_radian: omega * omega * oscillating,
            damping_newton_metre_seconds_per_radian: 2.0 * damping_ratio * omega * oscillating,
        }
    }
}

/// Inertia of motor and load oscillating against each other, at the output shaft.
fn swinging_inertia(params: &AxisParams) -> f64 {
    let motor = params.motor.rotor_inertia_kilogram_square_metres * params.gear.ratio * params.gear.ratio;
    let load = params.load.inertia_kilogram_square_metres;
    motor * load / (motor + load)
}

pub(super) fn above_zero(name: &'static str, got: f64) -> Result<(), ParamsError> {
    within(name, got, got > 0.0, "above 0")
}

pub(super) fn not_negative(name: &'static str, got: f64) -> Result<(), ParamsError> {
    within(name, got, got >= 0.0, "0 or more")
}

pub(super) fn finite(name: &'static str, got: f64) -> Result<(), ParamsError> {
    within(name, got, true, "a finite number")
}

fn within(name: &'static str, got: f64, fits: bool, needed: &'static str) -> Result<(), ParamsError> {
    if got.is_finite() && fits { Ok(()) } else { Err(ParamsError::OutOfRange { name, got, needed }) }
}
