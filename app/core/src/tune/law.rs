//! The families whose loops can be tuned, and what a run of any of them speaks of.

use brushwork_family::tuned::{OneOf, Tuned};
use brushwork_tuning::law::Law;

/// All of them.
pub type Families = OneOf<brushwork_mcp::McpTuned, brushwork_motion_mind::MotionMindTuned>;
/// The law of whatever controller is at the wire.
pub type AnyLaw = <Families as Tuned>::Law;
/// Its registers.
pub type AnyRegisters = <AnyLaw as Law>::Registers;
/// What goes over in one write.
pub type AnyWrite = <AnyLaw as Law>::Write;

/// The report of a run.
pub type Report = brushwork_tuning::report::Report<AnyLaw>;
/// What a run is asked for.
pub type Request = brushwork_tuning::tune::Request<AnyLaw>;
/// What a controller holds before a run.
pub type Setup = brushwork_tuning::setup::Setup<AnyLaw>;
/// What a design is made for.
pub type Task = brushwork_tuning::design::Task<AnyLaw>;
/// A run as a picture shows it.
pub type Trace = brushwork_tuning::trace::Trace<AnyLaw>;
/// Gains tried by themselves.
pub type Trial = brushwork_tuning::trial::Trial<AnyLaw>;
/// What is to be tried.
pub type TrialRequest = brushwork_tuning::trial::TrialRequest<AnyLaw>;
