//! A motor whose loops are looked at: its guard, and how registers of this law are written through it.

use crate::registers::{McpWrite, VELOCITY_SCALE, VelocityRegisters};
use brushwork_tuning::cause::Cause;
use brushwork_tuning::experiment_guard::ExperimentGuard;
use brushwork_tuning::law::Law;

/// QPPS while probing: so high that the command is large beside whatever the motor still creeps.
pub(crate) const QPPS: f64 = 10_000_000.0;
/// Loop rates that are known, Hz.
pub(crate) const RATES_HZ: [u32; 2] = [300, 625];

/// The motor with its loops as this law writes them.
pub(crate) struct Probed<'p, 'g, L: Law> {
    pub(crate) guard: &'p mut ExperimentGuard<'g, L>,
    pub(crate) write: &'p dyn Fn(McpWrite) -> L::Write,
}

impl<L: Law> Probed<'_, '_, L> {
    pub(crate) fn set(&mut self, registers: McpWrite) -> Result<(), Cause> {
        self.guard.write((self.write)(registers))
    }
}

impl<'g, L: Law> std::ops::Deref for Probed<'_, 'g, L> {
    type Target = ExperimentGuard<'g, L>;

    fn deref(&self) -> &Self::Target {
        self.guard
    }
}

impl<L: Law> std::ops::DerefMut for Probed<'_, '_, L> {
    fn deref_mut(&mut self) -> &mut Self::Target {
        self.guard
    }
}

pub(crate) fn gains(p: f64, i: f64) -> McpWrite {
    let (p, i) = ((p * VELOCITY_SCALE) as u32, (i * VELOCITY_SCALE).round() as u32);
    McpWrite::Velocity(VelocityRegisters { p, i, d: 0, qpps: QPPS as u32 })
}
