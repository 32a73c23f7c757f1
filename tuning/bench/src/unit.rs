//! What the bench asks of a family: its plants, the axis over its wire, its registers, and trials of them on the true plant.

use crate::line::{Bench, SimulatedLine};
use crate::optimum::Optima;
use crate::population::Specimen;
use crate::trial::Outcome;
use crate::truth::Truth;
use brushwork_tuning::law::Law;
use brushwork_tuning::law_probe::LawProbe;
use brushwork_tuning::model::Gains;
use brushwork_tuning::setup::LoopAxis;
use brushwork_tuning::tune::Method;
use brushwork_tuning::{report, tune};

/// How the controller of a plant is built or set up, which tells its family.
pub trait Unit: Clone + Send + Sync + 'static {
    /// The law of its loops.
    type Law: LawProbe<Held: Sync, Registers: Sync, Note: Sync, Findings: Sync>;
    /// Its axis over the wire.
    type Axis: LoopAxis<Self::Law>;
    /// The simulated controller.
    type Machine: Bench;
    /// What each trial of a plant begins with.
    type Fresh: Send + Sync;
    /// The optima of a plant, as a file has them.
    type Optima: Optima;
    /// The methods and their names in the table.
    const TASKS: &'static [(&'static str, Method)];
    /// A plant of the population of machines with absolute encoders, where there is one.
    const ABSOLUTE: Option<fn(u64, usize) -> Specimen<Self>> = None;
    /// The methods whose trials faults strike, and whose runs have to be quiet.
    const WHOLE: [Method; 2];
    /// Whether the wire carries the battery's voltage.
    const REPORTS_VOLTS: bool;
    /// How soon the motor must be off when the link is gone, s.
    const LINK_DEADLINE_S: f64;

    /// Plant `number` of a seed, whatever the size of the population.
    fn specimen(seed: u64, number: usize) -> Specimen<Self>;
    /// The file of the optima of a seed; empty for one that is not quoted.
    fn known(seed: u64) -> &'static str;
    /// What a plant really is.
    fn truth(specimen: &Specimen<Self>) -> Truth<Self::Law>;
    /// The axis of a plant, switched on half a second ago.
    fn axis(specimen: &Specimen<Self>) -> Self::Axis;
    /// The line beneath an axis.
    fn line(axis: &mut Self::Axis) -> &mut SimulatedLine<Self::Machine>;
    /// What each trial begins with.
    fn fresh(specimen: &Specimen<Self>) -> Self::Fresh;
    /// Gains as registers of a fresh unit.
    fn registers(law: &Self::Law, gains: &Gains, qpps: f64) -> Registers<Self>;
    /// The full speed that registers hold, where they do.
    fn held_qpps(_registers: &Registers<Self>) -> Option<f64> {
        None
    }
    /// The registers from the factory, where they are not those of the textbook.
    fn factory(_truth: &Truth<Self::Law>, _method: Method) -> Option<Registers<Self>> {
        None
    }
    /// A trial of registers on the true plant.
    fn trial(under_test: &UnderTest<Self>, method: Method, registers: &Registers<Self>) -> Outcome;
}

/// Registers of a unit's loops.
pub type Registers<U> = <<U as Unit>::Law as Law>::Registers;
/// What a run is asked for.
pub type Request<U> = tune::Request<<U as Unit>::Law>;
/// The report of a run.
pub type Report<U> = report::Report<<U as Unit>::Law>;

/// A plant that gains are tried on.
pub struct UnderTest<U: Unit> {
    /// The plant.
    pub specimen: Specimen<U>,
    /// What it really is.
    pub truth: Truth<U::Law>,
    /// What each trial begins with.
    pub fresh: U::Fresh,
}

impl<U: Unit> UnderTest<U> {
    /// This plant under test.
    #[must_use]
    pub fn new(specimen: Specimen<U>) -> Self {
        Self { truth: U::truth(&specimen), fresh: U::fresh(&specimen), specimen }
    }
}

/// The population of a seed: `n` plants, the kinds in turn.
#[must_use]
pub fn population<U: Unit>(seed: u64, n: usize) -> Vec<Specimen<U>> {
    (0..n).map(|number| U::specimen(seed, number)).collect()
}
