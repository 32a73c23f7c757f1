//! Registers of a Motion Mind tried by themselves, and redrawn for other levels from the model of a run, with no new experiment.

use brushwork_motion_mind_axis::MindAxis;
use brushwork_motion_mind_axis::law::{
    MotionMindLaw, MotionMindProposal, MotionMindRegisters, MotionMindWrite, bits,
};
use brushwork_tuning::cause::Cause;
use brushwork_tuning::design::Task;
use brushwork_tuning::model::Gains;
use brushwork_tuning::report::Verdict;
use brushwork_tuning::trace::Trace;
use brushwork_tuning::trial::{Trial, TrialRequest, on_model, run_trial};
use brushwork_tuning::tune::Method;
use brushwork_tuning::whatif::{forecast, redesign_registers};
use brushwork_tuning_bench::motion_mind::line::MindLine;
use brushwork_tuning_bench::motion_mind::population::{MindSetup, MindSpecimen, specimen};
use brushwork_tuning_bench::optimum::Optimum;
use brushwork_tuning_bench::run::{judge_report, request_of, tune_plant};
use brushwork_tuning_bench::unit::{self, UnderTest, Unit};

type Report = unit::Report<MindSetup>;
type SimulatedMind = MindAxis<MindLine>;

/// A gearmotor and a wheel: nothing about them is odd.
const PLANTS: [usize; 2] = [0, 1];

fn tuned(number: usize, method: Method) -> (MindSpecimen, Report) {
    let plant = specimen(7, number);
    let (report, _) = tune_plant(&plant, &request_of(&plant, method));
    assert_ne!(report.verdict, Verdict::Refused, "plant {number}: {:?}", report.causes);
    (plant, report)
}

fn wanted(report: &Report, registers: MotionMindRegisters) -> TrialRequest<MotionMindLaw> {
    TrialRequest {
        request: report.request,
        task: report.task.expect("a model"),
        probe: report.probe.expect("a probe"),
        registers: MotionMindProposal { motion_mind: Some(registers) },
    }
}

fn held(axis: &SimulatedMind) -> Vec<i64> {
    [2, 3, 4, 5, 6, 8, 23, 24, 26, 28, 30].map(|n| axis.carrier.line.unit().read_one(n)).to_vec()
}

/// The trial, after which all is as before and nothing turns.
fn tried(plant: &MindSpecimen, wanted: &TrialRequest<MotionMindLaw>) -> Trial<MotionMindLaw> {
    let mut axis = Unit::axis(plant);
    let (before, stored) = (held(&axis), axis.carrier.line.unit().eeprom_writes());
    let trial = run_trial(&mut axis, wanted, &mut |_| {});
    assert_eq!(held(&axis), before, "the registers from before are in force again");
    assert_eq!(axis.carrier.line.unit().eeprom_writes(), stored);
    // The old gains hold the motor where it stands, as before.
    assert!(axis.carrier.line.unit().duty().abs() < 0.02);
    trial
}

#[test]
fn what_a_run_proposed_is_verified_again_and_so_is_less_of_it_by_hand() {
    for (number, method) in PLANTS.into_iter().flat_map(|n| [(n, Method::Velocity), (n, Method::Pd)]) {
        let (plant, report) = tuned(number, method);
        let proposed = report.proposed.motion_mind.expect("registers");
        let softer =
            MotionMindRegisters { pterm: proposed.pterm / 2, dterm: proposed.dterm / 10 * 7, ..proposed };
        for registers in [proposed, softer] {
            let wanted = wanted(&report, registers);
            let trial = tried(&plant, &wanted);
            assert_eq!(trial.cause, None, "plant {number} {method:?}: {:?}", trial.measured);
            assert!(trial.measured.is_some());
            let trace = Trace::of(0, &trial.record);
            assert!(trace.writes.iter().any(|(_, what)| *what == MotionMindWrite::Loop(registers)));
            let stretch = *trace.stretches().last().expect("a loop held the motor");
            let (task, gains) = wanted.on_model();
            assert!(!trace.predict(&task, &gains, &stretch).is_empty());
        }
    }
}

#[test]
fn far_too_much_gain_is_found_on_the_machine_and_foretold_by_the_model() {
    let (plant, report) = tuned(1, Method::Pd);
    let proposed = report.proposed.motion_mind.expect("registers");
    // Thirty-two times the loop.
    let wild = MotionMindRegisters { pidscalar: proposed.pidscalar - 5, ..proposed };
    let wanted = wanted(&report, wild);
    let (task, gains) = wanted.on_model();
    assert!(!forecast(&task, &gains).is_stable);
    assert_eq!(tried(&plant, &wanted).cause, Some(Cause::NotVerified));
}

#[test]
fn bits_that_make_another_loop_are_refused_before_anything_moves() {
    let (plant, report) = tuned(0, Method::Velocity);
    let proposed = report.proposed.motion_mind.expect("registers");
    for function2 in [bits::NEWVELMODE, bits::FASTPID] {
        let other = MotionMindRegisters { function2: proposed.function2 | function2, ..proposed };
        let trial = tried(&plant, &wanted(&report, other));
        assert_eq!(trial.cause, Some(Cause::OtherLoop));
        assert!(
            Trace::of(0, &trial.record)
                .drives
                .iter()
                .all(|drive| { drive.input == brushwork_tuning::experiment_guard::Input::Duty(0.0) })
        );
    }
}

#[test]
fn another_level_is_other_registers_and_a_stiffer_one_goes_nearer_to_its_bound() {
    for method in [Method::Velocity, Method::Pd, Method::Pid] {
        let (_, report) = tuned(0, method);
        let task = report.task.expect("a model");
        assert_eq!(redesign_registers(&report, report.request.level), Some(report.proposed));
        let shown = [0.0, 30.0, 90.0].map(|level| {
            let registers = redesign_registers(&report, level).expect("registers");
            let (task, gains) = on_model(&task, &registers, method);
            let shown = forecast(&task, &gains);
            assert!(shown.is_stable, "{method:?} at level {level}");
            shown
        });
        assert!(shown[0].ms < shown[1].ms, "{method:?}: {} {}", shown[0].ms, shown[1].ms);
        assert!(shown[2].load_dip < shown[0].load_dip, "{method:?}");
    }
}

/// Arms that rattle in their backlash with three times their gains, and with twice them do not.
#[test]
fn gains_that_stand_to_be_doubled_are_not_lowered_for_what_three_times_as_much_shows() {
    for number in [7, 15, 79] {
        let under_test = UnderTest::new(specimen(11, number));
        let (report, _) = tune_plant(&under_test.specimen, &request_of(&under_test.specimen, Method::Pd));
        assert_eq!(report.causes, [Cause::MarginUnsure], "plant {number}");
        let nothing = Optimum { cost: 1.0, duty_rms: 0.08, gains: Gains::default() };
        let judged = judge_report(&under_test, &nothing, &report);
        assert!(judged.ms > 1.3 && judged.ms < 1.8, "plant {number}: a true Ms of {:.2}", judged.ms);
    }
}

#[test]
fn no_level_gives_the_speed_more_gain_than_the_machine_was_heard_to_bear() {
    let plant = specimen(11, 47);
    let (report, _) = tune_plant(&plant, &request_of(&plant, Method::Pd));
    let task = report.task.expect("a model");
    let bound = task.most_speed_gain.expect("its raised gains oscillated");
    let gain_at = |report: &Report, level: f64| {
        let registers =
            redesign_registers(report, level).unwrap_or_else(|| panic!("registers at level {level}"));
        on_model(&task, &registers, Method::Pd).1.speed_gain()
    };
    for level in [0.0, 30.0, 70.0, 100.0] {
        let gain = gain_at(&report, level);
        // Rounded to the registers.
        assert!(gain < 1.05 * bound, "level {level}: {gain} of {bound}");
    }
    let unbounded = Report { task: Some(Task { most_speed_gain: None, ..task }), ..report };
    let free = gain_at(&unbounded, 100.0);
    assert!(free > 1.1 * bound, "{free} of {bound}");
}

/// An arm whose gains, as they are searched, step from calm ones past the border to unstable ones whose margins look calm again.
#[test]
fn the_stiffest_level_has_registers_too() {
    let plant = specimen(11, 23);
    let (report, _) = tune_plant(&plant, &request_of(&plant, Method::Pd));
    let task = Task { most_speed_gain: None, ..report.task.expect("a model") };
    let report = Report { task: Some(task), ..report };
    let registers = redesign_registers(&report, 100.0).expect("registers");
    let (task, gains) = on_model(&task, &registers, Method::Pd);
    assert!(forecast(&task, &gains).is_stable);
}

#[test]
fn the_sensitivity_of_a_report_is_that_of_its_rounded_registers() {
    for method in [Method::Velocity, Method::Pd, Method::Pid] {
        let (_, report) = tuned(0, method);
        let (task, gains) = on_model(&report.task.expect("a model"), &report.proposed, method);
        let design = report.design.expect("a design");
        assert!((forecast(&task, &gains).ms - design.ms).abs() < 1e-9, "{method:?}");
    }
}
