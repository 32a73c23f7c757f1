//! What a plant really is, linearly: the detailed axis, its battery, its firmware's filter and delay, exact at the tick.

use crate::population::Specimen;
use brushwork_plant::{AxisParams, ShaftSide};
use brushwork_tuning::law::Law;
use brushwork_tuning::linear::{DiscretePlant, LoopPlant};
use brushwork_tuning::model::Lag;
use nalgebra::{DMatrix, DVector};

/// Duty at which the battery's sag is taken.
const WORKING_DUTY: f64 = 0.4;

/// The true figures of a plant.
#[derive(Clone, Debug)]
pub struct Truth<L: Law> {
    /// Speed per duty, friction aside, counts/s.
    pub gain_counts_per_s: f64,
    /// Mechanical time constant, s.
    pub tau_s: f64,
    /// Steady speed at full duty, counts/s, battery sag included.
    pub qpps: f64,
    /// Duty that dry friction eats while the shaft turns.
    pub coulomb_duty: f64,
    /// The law, in the tuner's terms.
    pub law: L,
    /// Filter and delay of the firmware.
    pub lag: Lag,
    /// Time constant of the winding, s.
    pub winding_s: f64,
    /// The linear loop at the tick.
    pub nominal: LoopPlant,
    /// The same with the inertia halved, and half as large again.
    pub varied: [LoopPlant; 2],
}

impl<L: Law> Truth<L> {
    /// All that the loop loses between the motion and the torque, beyond the hold and the count difference of a tick, s.
    #[must_use]
    pub fn whole_lag_s(&self) -> f64 {
        self.lag.total_s(self.law.tick_s()) + self.winding_s
    }
}

/// The truth of a plant under a law with a lag.
pub(crate) fn truth_under<U, L: Law>(specimen: &Specimen<U>, law: L, lag: Lag) -> Truth<L> {
    let axis = &specimen.axis;
    let volts = specimen.volts();
    let step = axis.steady_counts_per_second(volts) - axis.steady_counts_per_second(0.9 * volts);
    let of = |inertia: f64| LoopPlant::new(discrete(specimen, inertia, law.tick_s()), &law, lag);
    Truth {
        gain_counts_per_s: 10.0 * step,
        tau_s: axis.mechanical_time_constant_s(),
        qpps: full_speed(specimen),
        coulomb_duty: coulomb_duty(specimen),
        law,
        lag,
        winding_s: axis.motor.armature_henries / ohms(specimen),
        nominal: of(1.0),
        varied: [of(0.5), of(1.5)],
    }
}

/// Friction of the turning shaft over the torque at full duty with the shaft locked.
fn coulomb_duty<U>(specimen: &Specimen<U>) -> f64 {
    let motor = &specimen.axis.motor;
    let stall = motor.torque_constant_newton_metres_per_amp * specimen.axis.stall_amps(specimen.volts());
    specimen.axis.total_friction().coulomb_newton_metres / stall
}

/// Steady speed at full duty with the battery sagging under the running current.
pub(crate) fn full_speed<U>(specimen: &Specimen<U>) -> f64 {
    let axis = &specimen.axis;
    let motor = &axis.motor;
    let mut volts = specimen.volts();
    for _ in 0..20 {
        let speed = axis.steady_speed_radians_per_second(volts);
        let amps = (volts - motor.back_emf_volts_per_radian_per_second * speed) / motor.armature_ohms;
        volts = specimen.volts() - specimen.supply.internal_ohms * amps;
    }
    axis.steady_counts_per_second(volts)
}

/// The axis from duty to counts over one tick, with every inertia scaled.
fn discrete<U>(specimen: &Specimen<U>, inertia: f64, tick_s: f64) -> DiscretePlant {
    let axis = &specimen.axis;
    let (a, b, c) =
        if axis.is_two_mass() { two_mass(specimen, axis, inertia) } else { rigid(specimen, axis, inertia) };
    let n = a.nrows();
    let mut both = DMatrix::zeros(n + 1, n + 1);
    both.view_mut((0, 0), (n, n)).copy_from(&(&a * tick_s));
    both.view_mut((0, n), (n, 1)).copy_from(&(&b * tick_s));
    let whole = both.exp();
    DiscretePlant {
        a: whole.view((0, 0), (n, n)).into_owned(),
        b: whole.view((0, n), (n, 1)).column(0).into_owned(),
        c,
    }
}

type Continuous = (DMatrix<f64>, DVector<f64>, DVector<f64>);

fn ohms<U>(specimen: &Specimen<U>) -> f64 {
    specimen.axis.motor.armature_ohms + WORKING_DUTY * WORKING_DUTY * specimen.supply.internal_ohms
}

/// States: current, motor speed, motor angle.
fn rigid<U>(specimen: &Specimen<U>, axis: &AxisParams, inertia: f64) -> Continuous {
    let m = &axis.motor;
    let (l, j) = (m.armature_henries.max(1e-6), inertia * axis.total_inertia_kilogram_square_metres());
    let (kt, ke) = (m.torque_constant_newton_metres_per_amp, m.back_emf_volts_per_radian_per_second);
    let viscous = axis.total_friction().viscous_newton_metre_seconds_per_radian;
    let a = DMatrix::from_row_slice(
        3,
        3,
        &[-ohms(specimen) / l, -ke / l, 0.0, kt / j, -viscous / j, 0.0, 0.0, 1.0, 0.0],
    );
    let b = DVector::from_vec(vec![specimen.volts() / l, 0.0, 0.0]);
    (a, b, DVector::from_vec(vec![0.0, 0.0, axis.counts_per_motor_radian()]))
}

/// States: current, motor speed, load speed, twist, motor angle.
fn two_mass<U>(specimen: &Specimen<U>, axis: &AxisParams, inertia: f64) -> Continuous {
    let m = &axis.motor;
    let n = axis.gear.ratio;
    let l = m.armature_henries.max(1e-6);
    let (kt, ke) = (m.torque_constant_newton_metres_per_amp, m.back_emf_volts_per_radian_per_second);
    let jm = inertia * m.rotor_inertia_kilogram_square_metres;
    let jl = inertia * axis.load.inertia_kilogram_square_metres;
    let bm = m.friction.viscous_newton_metre_seconds_per_radian;
    let bl = axis.load.friction.viscous_newton_metre_seconds_per_radian;
    let (k, d) = axis.load.coupling.map_or((1e6, 1.0), |coupling| {
        (coupling.stiffness_newton_metres_per_radian, coupling.damping_newton_metre_seconds_per_radian)
    });
    #[rustfmt::skip]
    let a = DMatrix::from_row_slice(5, 5, &[
        -ohms(specimen) / l, -ke / l, 0.0, 0.0, 0.0,
        kt / jm, -(bm + d / (n * n)) / jm, d / n / jm, -k / n / jm, 0.0,
        0.0, d / n / jl, -(bl + d) / jl, k / jl, 0.0,
        0.0, 1.0 / n, -1.0, 0.0, 0.0,
        0.0, 1.0, 0.0, 0.0, 0.0,
    ]);
    let b = DVector::from_vec(vec![specimen.volts() / l, 0.0, 0.0, 0.0, 0.0]);
    let per_turn = axis.encoder.counts_per_turn / std::f64::consts::TAU;
    let c = match axis.encoder.side {
        ShaftSide::Motor => vec![0.0, 0.0, 0.0, 0.0, per_turn],
        ShaftSide::Load => vec![0.0, 0.0, 0.0, -per_turn, per_turn / n],
    };
    (a, b, DVector::from_vec(c))
}
