//! The families whose loops can be tuned, and what a run of any of them speaks of.

use brushwork_family::tuned::{OneOf, Tuned};
use brushwork_tuning::experiment_guard::GuardOptions;
use brushwork_tuning::law::Law;
use brushwork_tuning::tune::{Excitation, Method};
use brushwork_values::Motor;

/// All of them.
pub type Families = OneOf<
    OneOf<brushwork_mcp::McpTuned, brushwork_motion_mind::MotionMindTuned>,
    brushwork_suprmotr::SuprMotrTuned,
>;
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

/// A run as a person asks for it: from soft (0) to stiff (100), within a travel in counts or free, up to a duty in percent (at least 20)
/// and a current in amperes. It puts the old gains back at its end.
#[must_use]
pub fn request(
    method: Method,
    level: f64,
    motor: Motor,
    travel: Option<(i64, i64)>,
    max_duty_percent: f64,
    max_amps: Option<f64>,
) -> Request {
    let max_duty = (max_duty_percent / 100.0).clamp(0.2, 1.0);
    let guard = GuardOptions { motor: motor.index(), max_duty, travel, max_amps, ..GuardOptions::default() };
    Request {
        method,
        level,
        excitation: Excitation::within(travel),
        guard,
        keep: false,
        ..Request::default()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use brushwork_tuning::law::Windup;
    use brushwork_tuning::model::Gains;

    #[test]
    fn what_a_run_finds_of_the_law_of_one_family_is_found_of_the_law_of_all() {
        let law = AnyLaw::default();
        assert_eq!(law.windup(), Windup::Open);
        assert_eq!(law.with_windup(Windup::Held).map(|law| law.windup()), Some(Windup::Held));
        assert!(law.with_other_sum(&Gains::default()).is_some());
    }
}
