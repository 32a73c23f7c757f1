//! A current whose readings are noise, as real ones are: a refusal names a cause by the current only where the current is clear of it.

use brushwork_mcp_axis::{McpLaw, PacketAxis};
use brushwork_mcp_sim::controller::{Controller, ControllerConfig};
use brushwork_plant::world::WorldAction;
use brushwork_tuning::axis::EncoderClass;
use brushwork_tuning::cause::Cause;
use brushwork_tuning::experiment_guard::GuardOptions;
use brushwork_tuning::report::{Report, Verdict};
use brushwork_tuning::tune::{Method, Request, tune};
use brushwork_tuning_bench::line::{Event, SimulatedLine};
use brushwork_tuning_bench::mcp::population::specimen;
use brushwork_tuning_bench::run::request_of;
use brushwork_values::Motor;
use std::time::Duration;

/// Standard deviation of the readings, A: three steps of the wire.
const NOISE_AMPS: f64 = 0.03;
const PLANTS: usize = 8;

/// Of the noise.
const SEED: u64 = 11;

fn run_with(number: usize, at: Duration, action: WorldAction, weighs_evidence: bool) -> Report<McpLaw> {
    let mut plant = specimen(31, number);
    plant.axis.current_sensor.noise_amps = NOISE_AMPS;
    let config = ControllerConfig { seed: SEED, ..plant.controller_config() };
    let unit = Controller::new(config).expect("every drawn figure is in its range");
    let mut line = SimulatedLine::new(unit, plant.link);
    line.idle(Duration::from_millis(500));
    line.schedule(vec![Event { at, action }]);
    let mut axis = PacketAxis::new(line, Motor::M1, EncoderClass::Quadrature);
    let request: Request<McpLaw> = request_of(&plant, Method::Velocity);
    let guard = GuardOptions { weighs_evidence, ..request.guard };
    tune(&mut axis, &Request { guard, ..request })
}

/// The first cause of an open lead, and whether it is one that a lead may have.
fn named_of_open_lead(number: usize, at_ms: u64, weighs_evidence: bool) -> (Option<Cause>, bool) {
    let action = WorldAction::OpenLead { motor: Motor::M1, on: true };
    let report = run_with(number, Duration::from_millis(at_ms), action, weighs_evidence);
    assert_eq!(report.verdict, Verdict::Refused, "plant {number}, {at_ms} ms");
    let cause = report.causes.first().copied();
    (cause, matches!(cause, Some(Cause::CurrentUnclear | Cause::MotorOpen | Cause::MotorOpened)))
}

#[test]
fn an_open_lead_under_noise_is_called_by_no_other_name() {
    let mut misnamed = 0;
    for number in 0..PLANTS {
        for at_ms in [0, 1_600, 2_400] {
            let (cause, is_right) = named_of_open_lead(number, at_ms, true);
            let (guess, is_guess_right) = named_of_open_lead(number, at_ms, false);
            println!("plant {number}, {at_ms} ms: {cause:?}, by the readings alone {guess:?}");
            assert!(is_right, "plant {number}, {at_ms} ms: {cause:?}");
            misnamed += usize::from(!is_guess_right);
        }
    }
    // Since the noise is measured at rest, the readings alone say it too; before, some of these were a dead encoder or a locked shaft.
    assert_eq!(misnamed, 0, "by the readings alone");
}

#[test]
fn a_locked_shaft_draws_more_than_noise_and_is_named() {
    let motor = Motor::M1;
    let mut named = 0;
    for number in 0..PLANTS {
        let report = run_with(number, Duration::ZERO, WorldAction::LockShaft { motor, on: true }, true);
        let cause = report.causes.first().copied();
        println!("plant {number}: {cause:?}");
        assert!(
            matches!(cause, Some(Cause::CurrentUnclear | Cause::ShaftLocked)),
            "plant {number}: {:?}",
            report.causes
        );
        named += usize::from(cause == Some(Cause::ShaftLocked));
    }
    assert!(named > PLANTS / 2, "{named} of {PLANTS}");
}
