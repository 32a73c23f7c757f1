//! An MCP or RoboClaw on the bench: its axis over packet serial, its true law, its registers.

use super::population::{PacketSpecimen, absolute_specimen, specimen};
use super::trial::{position_trial, velocity_trial};
use crate::line::SimulatedLine;
use crate::optimum::{Optima, Optimum};
use crate::trial::Outcome;
use crate::truth::{Truth, truth_under};
use crate::unit::{UnderTest, Unit};
use brushwork_mcp_axis::{McpHeld, McpLaw, McpRegisters, PacketAxis};
use brushwork_mcp_sim::controller::{Controller, ControllerConfig};
use brushwork_mcp_sim::motion::{ControlLaw, GainTiming, VelocityEstimate};
use brushwork_plant::EncoderKind;
use brushwork_tuning::axis::EncoderClass;
use brushwork_tuning::law::Law;
use brushwork_tuning::model::{Gains, Lag};
use brushwork_tuning::tune::Method;
use brushwork_values::Motor;
use serde::{Deserialize, Serialize};

/// Position limits of a trial, counts: none to speak of.
const WIDE: (i64, i64) = (-2_000_000_000, 2_000_000_000);

/// The optima of one plant.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct PacketOptima {
    /// Velocity PI.
    pub velocity: Option<Optimum>,
    /// Position PD.
    pub pd: Option<Optimum>,
    /// Position PID.
    pub pid: Option<Optimum>,
    /// Position PIV.
    pub piv: Option<Optimum>,
}

impl Optima for PacketOptima {
    fn worked_out(of: impl Fn(Method) -> Option<Optimum>) -> Self {
        Self {
            velocity: of(Method::Velocity),
            pd: of(Method::Pd),
            pid: of(Method::Pid),
            piv: of(Method::Piv),
        }
    }

    fn of(&self, method: Method) -> Option<Optimum> {
        match method {
            Method::Velocity => self.velocity,
            Method::Pd => self.pd,
            Method::Pid => self.pid,
            Method::Piv => self.piv,
        }
    }
}

impl Unit for ControlLaw {
    type Law = McpLaw;
    type Axis = PacketAxis<SimulatedLine<Controller>>;
    type Machine = Controller;
    type Fresh = ControllerConfig;
    type Optima = PacketOptima;
    const TASKS: &'static [(&'static str, Method)] =
        &[("velocity", Method::Velocity), ("pd", Method::Pd), ("pid", Method::Pid), ("piv", Method::Piv)];
    const ABSOLUTE: Option<fn(u64, usize) -> PacketSpecimen> = Some(absolute_specimen);
    const WHOLE: [Method; 2] = [Method::Velocity, Method::Piv];
    const REPORTS_VOLTS: bool = true;
    const LINK_DEADLINE_S: f64 = 0.25;

    fn specimen(seed: u64, number: usize) -> PacketSpecimen {
        specimen(seed, number)
    }

    fn known(seed: u64) -> &'static str {
        match seed {
            7 => include_str!("../../oracle/seed-7.json"),
            11 => include_str!("../../oracle/seed-11.json"),
            _ => "",
        }
    }

    fn truth(specimen: &PacketSpecimen) -> Truth<McpLaw> {
        let law = McpLaw {
            rate_hz: specimen.unit.rate_hz,
            per_tick: specimen.unit.gain_timing == GainTiming::PerTick,
            position_scale: specimen.unit.position_gain_scale,
            feed_forward: f64::from(u8::from(specimen.unit.feed_forward)),
            ..McpLaw::default()
        };
        let of_derivative = |timing| if timing == GainTiming::PerTick { law.tick_s() } else { 1.0 };
        let law = McpLaw { derivative_s: specimen.unit.derivative_timing.map(of_derivative), ..law };
        let filter_s = match specimen.unit.velocity_estimate {
            VelocityEstimate::LowPass { time_constant_s } => time_constant_s,
            VelocityEstimate::LastTick => 0.0,
            VelocityEstimate::MovingAverage { ticks } => {
                0.5 * f64::from(ticks.saturating_sub(1)) * law.tick_s()
            }
        };
        let lag = Lag { filter_s, delay_ticks: f64::from(specimen.unit.output_delay_ticks) };
        truth_under(specimen, law, lag)
    }

    fn axis(specimen: &PacketSpecimen) -> Self::Axis {
        let unit = Controller::new(specimen.controller_config()).expect("every drawn figure is in its range");
        let mut line = SimulatedLine::new(unit, specimen.link);
        line.idle(std::time::Duration::from_millis(500));
        PacketAxis::new(line, Motor::M1, encoder_of(specimen))
    }

    fn line(axis: &mut Self::Axis) -> &mut SimulatedLine<Controller> {
        &mut axis.carrier
    }

    fn fresh(specimen: &PacketSpecimen) -> ControllerConfig {
        specimen.controller_config()
    }

    fn registers(law: &McpLaw, gains: &Gains, qpps: f64) -> McpRegisters {
        law.registers(&McpHeld::default(), gains, qpps, Some(WIDE))
    }

    fn held_qpps(registers: &McpRegisters) -> Option<f64> {
        registers.velocity.map(|velocity| f64::from(velocity.qpps).max(1.0))
    }

    fn trial(under_test: &UnderTest<Self>, method: Method, registers: &McpRegisters) -> Outcome {
        match method {
            Method::Velocity => velocity_trial(under_test, registers),
            Method::Pd | Method::Pid | Method::Piv => position_trial(under_test, registers),
        }
    }
}

/// What a person would say of its encoder.
fn encoder_of(specimen: &PacketSpecimen) -> EncoderClass {
    let encoder = &specimen.axis.encoder;
    match (encoder.kind, encoder.wraps) {
        (EncoderKind::Quadrature, _) => EncoderClass::Quadrature,
        (_, false) => EncoderClass::Absolute,
        (_, true) => EncoderClass::AbsoluteWrapping,
    }
}
