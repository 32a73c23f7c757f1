//! Gains as registers of a Motion Mind 3, and back.

use super::position_law::{FULL_PWM, MotionMindLaw, is_protected, on_position, sum_bound_s};
use super::scale::{on_speed, scaled, unscaled};
use brushwork_tuning::axis::AxisError;
use brushwork_tuning::joined::{LawPart, Part};
use brushwork_tuning::model::Gains;
use serde::{Deserialize, Serialize};

/// Bits of FUNCTION, FUNCTION2 and STATUS that concern a run (Motion Mind manual, figures 20 to 22).
pub mod bits {
    pub use brushwork_motion_mind_wire::function::{
        ACTIVESTOP, DISABLEPID, ENABLEDB, SATPROT, VELLIMIT, VIRTLIMIT,
    };
    pub use brushwork_motion_mind_wire::function2::{FASTPID, NEWVELMODE, PULSEFB};
    use brushwork_motion_mind_wire::status;

    /// STATUS: a limit input or the brake input is at ground, which takes the drive away, one way or both.
    pub const INPUTS: u16 = status::NEGLIMIT | status::POSLIMIT | status::BRAKE;
}

/// The registers that a run writes and puts back.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct MotionMindRegisters {
    /// PTERM.
    pub pterm: u16,
    /// ITERM.
    pub iterm: u16,
    /// DTERM.
    pub dterm: u16,
    /// PIDSCALAR: the power of two that the sum of the terms is divided by.
    pub pidscalar: u8,
    /// VELOCITYFF.
    pub velocity_ff: u8,
    /// DEADBAND, counts.
    pub deadband: u16,
    /// FUNCTION.
    pub function: u16,
    /// FUNCTION2.
    pub function2: u16,
    /// VNLIMIT and VPLIMIT, counts.
    pub virtual_limits: (i32, i32),
}

/// What a Motion Mind holds before a run.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct MotionMindSetup {
    /// Register 18: what moves the motor. The switches of the board choose it at power-up.
    pub mode: u8,
    /// What is put back.
    pub registers: MotionMindRegisters,
    /// Readings come without the unit's time: one line of text for each register.
    #[serde(default)]
    pub is_undated: bool,
}

/// Something of this family beside the same of others: what a unit holds, what is proposed, its law.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct MotionMindPart<T> {
    /// It, where the controller is a Motion Mind.
    #[serde(default = "none")]
    pub motion_mind: Option<T>,
}

impl<T> Part for MotionMindPart<T> {
    fn is_there(&self) -> bool {
        self.motion_mind.is_some()
    }
}

impl LawPart for MotionMindPart<MotionMindLaw> {
    type Law = MotionMindLaw;

    fn law(&self) -> Option<MotionMindLaw> {
        self.motion_mind
    }

    fn of(law: MotionMindLaw) -> Self {
        Self { motion_mind: Some(law) }
    }
}

fn none<T>() -> Option<T> {
    None
}

/// What a unit holds before a run.
pub type MotionMindHeld = MotionMindPart<MotionMindSetup>;
/// What is proposed; none in a refusal.
pub type MotionMindProposal = MotionMindPart<MotionMindRegisters>;

/// What goes over in one write.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum MotionMindWrite {
    /// The registers of a loop. The motor is off until the next command.
    Loop(MotionMindRegisters),
    /// The end of a run: these registers, as they are, and the position of the motor as the wanted one.
    End(MotionMindRegisters),
}

/// The same with its answer.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum MotionMindNote {
    /// Registers written.
    MotionMind(MotionMindRegisters, Result<(), AxisError>),
    /// The run ended with these.
    MotionMindEnd(MotionMindRegisters, Result<(), AxisError>),
}

impl MotionMindSetup {
    /// The mode whose loops can be tuned: serial commands, encoder (Motion Mind manual 4.7).
    pub const SERIAL_PID: u8 = 4;

    /// Whether the unit is set to take what a run sends: mode 4 with an encoder.
    #[must_use]
    pub fn can_be_tuned(&self) -> bool {
        self.mode == Self::SERIAL_PID && self.registers.function2 & bits::PULSEFB == 0
    }
}

impl MotionMindRegisters {
    /// These registers with gains in them: PIDSCALAR as large as the gains allow. DEADBAND and its bit follow the gains; NEWVELMODE,
    /// FASTPID (not for serial commands, figure 21) and DISABLEPID are cleared, and ACTIVESTOP is set, since a duty of 0 is taken
    /// to brake.
    #[must_use]
    pub fn with(&self, gains: &Gains, qpps: f64, law: MotionMindLaw) -> Self {
        let (terms, pidscalar) = scaled(&on_position(gains), qpps);
        let mut function = self.function | bits::ACTIVESTOP;
        function &= !(bits::DISABLEPID | bits::ENABLEDB);
        let deadband = gains.deadzone_counts.round().clamp(0.0, FULL_PWM) as u16;
        if gains.position.is_some() && deadband > 0 {
            function |= bits::ENABLEDB;
        }
        if terms[1] > 0 {
            function &= !bits::SATPROT;
            function |= if is_protected(gains.max_integral) { bits::SATPROT } else { 0 };
        }
        Self {
            pterm: terms[0],
            iterm: terms[1],
            dterm: terms[2],
            pidscalar,
            velocity_ff: law.velocity_ff,
            deadband: if deadband > 0 { deadband } else { self.deadband },
            function,
            function2: self.function2 & !(bits::NEWVELMODE | bits::FASTPID),
            ..*self
        }
    }

    /// The gains that they stand for: of position moves, or of speed moves.
    #[must_use]
    pub fn gains(&self, qpps: f64, is_position: bool) -> Gains {
        let pid = unscaled([self.pterm, self.iterm, self.dterm], self.pidscalar, qpps);
        let max_integral = sum_bound_s(if self.has(bits::SATPROT) { 0.0 } else { f64::INFINITY });
        if !is_position {
            let max_integral = if self.iterm > 0 { max_integral } else { 0.0 };
            return Gains { max_integral, ..on_speed(pid) };
        }
        let deadzone_counts = if self.has(bits::ENABLEDB) { f64::from(self.deadband) } else { 0.0 };
        Gains { position: Some(pid), max_integral, deadzone_counts, ..Gains::default() }
    }

    /// Share of the duty of a steady speed, friction aside, that the feed-forward gives.
    #[must_use]
    pub fn covered(&self, qpps: f64) -> f64 {
        MotionMindLaw { velocity_ff: self.velocity_ff, ..MotionMindLaw::default() }.covered(qpps)
    }

    /// Whether the loop is the one that the gains are computed for: the one on positions, every 5 ms, giving a duty.
    #[must_use]
    pub fn is_usual_loop(&self) -> bool {
        self.function2 & (bits::NEWVELMODE | bits::FASTPID | bits::PULSEFB) == 0
            && !self.has(bits::DISABLEPID)
    }

    /// Whether a bit of FUNCTION is set.
    #[must_use]
    pub fn has(&self, bit: u16) -> bool {
        self.function & bit != 0
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::law::scale::rounded;
    use brushwork_tuning::law::Law;
    use brushwork_tuning::model::Pid;

    fn pd(p: f64, i: f64, d: f64) -> Gains {
        Gains { position: Some(Pid { p, i, d }), max_integral: 600.0, ..Gains::default() }
    }

    #[test]
    fn a_count_more_in_a_loop_makes_the_duty_that_the_formula_of_the_manual_says() {
        // P of the one count and D of the slope that it is: (6000 + 2000) / 2^14 steps of 1023.
        let written = MotionMindRegisters { pterm: 6000, dterm: 2000, pidscalar: 14, ..Default::default() };
        let step_duty_of = |written: MotionMindRegisters| {
            let mut registers = MotionMindProposal::default();
            MotionMindLaw::take(&mut registers, &MotionMindWrite::Loop(written));
            MotionMindLaw::default().step_duty(&registers)
        };
        let step_duty = step_duty_of(written);
        assert!((step_duty - 8000.0 / 16_384.0 / 1023.0).abs() < 1e-12, "{step_duty}");
        let most = MotionMindRegisters { pterm: u16::MAX, pidscalar: 0, ..written };
        assert_eq!(step_duty_of(most), 1.0);
    }

    #[test]
    fn the_factory_gains_stand_for_what_the_formula_of_the_manual_says() {
        // 6000 / 2^14 steps of duty for each count; QPPS 1023 makes a step of duty one count/s.
        let factory = MotionMindRegisters { pterm: 6000, iterm: 35, pidscalar: 14, ..Default::default() };
        let gains = factory.gains(1023.0, true).position.unwrap();
        assert!((gains.p - 6000.0 / 16_384.0).abs() < 1e-12);
        assert!((gains.i - 35.0 / 16_384.0 * 200.0).abs() < 1e-12);
        assert_eq!(gains.d, 0.0);
    }

    #[test]
    fn the_scale_uses_the_range_of_the_registers_and_gains_come_back() {
        for (qpps, gains) in [(20_460.0, pd(10.0, 2.0, 0.1)), (900.0, pd(25.0, 0.0, 0.6))] {
            let law = MotionMindLaw::of_qpps(qpps);
            let registers = MotionMindRegisters::default().with(&gains, qpps, law);
            let largest = registers.pterm.max(registers.dterm).max(registers.iterm);
            assert!(largest > 32_767, "{registers:?}");
            let back = registers.gains(qpps, true).position.unwrap();
            let wanted = gains.position.unwrap();
            assert!((back.p / wanted.p - 1.0).abs() < 1e-3, "{back:?}");
            assert!((back.d / wanted.d - 1.0).abs() < 1e-3, "{back:?}");
            assert!((back.i - wanted.i).abs() < 0.05 * wanted.i.max(0.01), "{back:?}");
            assert_eq!(
                rounded(&gains, qpps).position,
                Some(back),
                "rounding is what a way there and back does"
            );
        }
    }

    #[test]
    fn under_a_speed_command_iterm_is_the_integral_of_the_integral_and_goes_back_into_the_register() {
        // 35 / 2^14 a loop on the sum of errors; QPPS 1023 makes a step of duty one count/s.
        let factory = MotionMindRegisters { pterm: 6000, iterm: 35, pidscalar: 14, ..Default::default() };
        let gains = factory.gains(1023.0, false);
        assert!((gains.velocity_sum - 35.0 / 16_384.0 * 200.0).abs() < 1e-12);
        assert_eq!((gains.velocity.p, gains.max_integral), (0.0, 600.0));
        let again = factory.with(&gains, 1023.0, MotionMindLaw::of_qpps(1023.0));
        let halves = 2.0_f64.powi(i32::from(again.pidscalar) - 14);
        assert!((f64::from(again.iterm) / halves - 35.0).abs() < 0.1, "{again:?}");
        assert!((f64::from(again.pterm) / halves - 6000.0).abs() < 0.1, "{again:?}");
    }

    #[test]
    fn bits_that_make_another_loop_are_reported() {
        let usual = MotionMindRegisters { function: bits::SATPROT | bits::ACTIVESTOP, ..Default::default() };
        assert!(usual.is_usual_loop());
        for function2 in [bits::NEWVELMODE, bits::FASTPID, bits::PULSEFB] {
            assert!(!MotionMindRegisters { function2, ..usual }.is_usual_loop());
        }
        assert!(!MotionMindRegisters { function: bits::DISABLEPID, ..usual }.is_usual_loop());
    }

    #[test]
    fn a_velocity_loop_is_dterm_and_pterm() {
        let gains = Gains { velocity: Pid { p: 3.0, i: 40.0, d: 0.0 }, ..Gains::default() };
        let registers = MotionMindRegisters { function: bits::ENABLEDB, ..Default::default() }.with(
            &gains,
            40_000.0,
            MotionMindLaw::of_qpps(40_000.0),
        );
        assert_eq!(registers.iterm, 0);
        let power = 2.0_f64.powi(i32::from(registers.pidscalar));
        assert!((f64::from(registers.dterm) / power - 1023.0 * 3.0 * 200.0 / 40_000.0).abs() < 1e-3);
        assert!((f64::from(registers.pterm) / power - 1023.0 * 40.0 / 40_000.0).abs() < 1e-3);
        assert!(!registers.has(bits::ENABLEDB), "the dead band is not for speeds");
        let back = registers.gains(40_000.0, false).velocity;
        assert!((back.p - 3.0).abs() < 1e-3 && (back.i - 40.0).abs() < 1e-2, "{back:?}");
    }
}
