//! `brushwork tune` from outside, against a controller on a port of its own in real time: what is left in RAM and in EEPROM, exit codes,
//! Ctrl-C at every stage. Which verdict a run comes to on a busy machine is not asked here; that it is told alike everywhere is.
#![cfg(unix)]

use std::path::{Path, PathBuf};
use std::time::Duration;

use crate::guardian;
use brushwork_core::tune::file;
use brushwork_core::tune::law::Report;
use brushwork_mcp_sim::controller::ControllerConfig;
use brushwork_mcp_sim::motion::MotionSettings;
use brushwork_mcp_sim::settings::Settings;
use brushwork_mcp_wire::packet_serial::Generation;
use brushwork_plant::machine::StreamIndex;
use brushwork_plant::world::WorldAction;
use brushwork_tests::program::{Ending, Program};
use brushwork_tests::simulated::{OnPort, is_driven};
use brushwork_tuning::cause::Cause;
use brushwork_tuning::report::Verdict;
use brushwork_values::Motor;
use rustix::process::Signal;
use tempfile::TempDir;

const BRUSHWORK: &str = env!("CARGO_BIN_EXE_brushwork-for-tests");

/// Exit codes, as `brushwork tune --help` lists them.
const TUNED: i32 = 0;
const FAILED: i32 = 1;
const LINK_LOST: i32 = 3;
const REFUSED: i32 = 4;
const TUNED_WITH_WARNINGS: i32 = 8;
const TOO_LATE: i32 = 11;
const INTERRUPTED: i32 = 130;

/// A run that does late stretches again takes several times as long as one.
const LIMIT: Duration = Duration::from_secs(240);

/// The user's time-out of the port, ms.
const USERS_MS: u32 = 1_300;

/// A controller and a folder for what is kept and written.
struct Bench<const IS_PTY: bool> {
    controller: OnPort<IS_PTY>,
    folder: TempDir,
}

impl Bench<false> {
    fn new(change: impl FnOnce(&mut Settings)) -> Self {
        Self::on_port(change)
    }
}

impl Bench<true> {
    /// On a pseudo-terminal, which is late on a busy machine: a run there ends as it may.
    fn on_pty(change: impl FnOnce(&mut Settings)) -> Self {
        Self::on_port(change)
    }
}

impl<const IS_PTY: bool> Bench<IS_PTY> {
    fn on_port(change: impl FnOnce(&mut Settings)) -> Self {
        let mut config = ControllerConfig { generation: Generation::Gen2, ..ControllerConfig::default() };
        let mut settings = Settings::factory(config.model, config.address.get());
        settings.streams[0].timeout_ms = USERS_MS;
        change(&mut settings);
        config.settings = Some(settings);
        let controller = OnPort::start_with(config, StreamIndex::Usb);
        Self { controller, folder: tempfile::tempdir().expect("a folder") }
    }

    fn report_path(&self) -> PathBuf {
        self.folder.path().join("out.json")
    }

    /// `brushwork tune velocity` with a report, and what a run keeps in the folder of this test.
    fn tune(&self, arguments: &[&str]) -> Program {
        self.tune_loop("velocity", arguments)
    }

    /// The same with any loop.
    fn tune_loop(&self, which: &str, arguments: &[&str]) -> Program {
        let target = format!("{},stream=usb", self.controller.target());
        let mut command = std::process::Command::new(BRUSHWORK);
        command.args(["tune", which, "-c", &target, "--report"]).arg(self.report_path()).args(arguments);
        for name in ["HOME", "XDG_DATA_HOME", "XDG_CONFIG_HOME", "XDG_STATE_HOME"] {
            command.env(name, self.folder.path());
        }
        Program::spawn(command)
    }

    fn report(&self) -> Report {
        file::read(&self.report_path()).expect("the report was written")
    }

    /// Gains of motor 1 and the time-out of the port, in RAM and in EEPROM.
    fn held(&self) -> [(MotionSettings, u32); 2] {
        self.controller.look(|unit| {
            let of = |settings: &Settings| (settings.motors[0].motion, settings.streams[0].timeout_ms);
            [of(&unit.settings()), of(&unit.stored_settings())]
        })
    }
}

fn code(ending: &Ending) -> Option<i32> {
    ending.status.code()
}

fn code_of(report: &Report) -> i32 {
    match report.verdict {
        Verdict::Tuned => TUNED,
        Verdict::TunedWithWarnings => TUNED_WITH_WARNINGS,
        Verdict::Refused => match report.causes.first() {
            Some(Cause::AnsweredLate { .. }) => TOO_LATE,
            Some(Cause::LinkLost) => LINK_LOST,
            _ => REFUSED,
        },
    }
}

fn gains(motion: &MotionSettings) -> [u32; 4] {
    [motion.velocity_p_raw, motion.velocity_i_raw, motion.velocity_d_raw, motion.qpps]
}

fn replayed(path: &Path) -> Ending {
    Program::start(BRUSHWORK, &["tune", "replay", &path.to_string_lossy()]).finish(LIMIT)
}

#[test]
fn saved_gains_are_in_ram_and_in_eeprom_with_the_users_time_out_and_the_report_replays() {
    let bench = Bench::on_pty(|_| {});
    let before = bench.held();
    let ending = bench.tune(&["--save", "--level", "40"]).finish(LIMIT);
    let report = bench.report();
    assert_eq!(code(&ending), Some(code_of(&report)), "{ending:?}");
    assert!(bench.controller.look(|unit| !is_driven(unit)));
    let [ram, eeprom] = bench.held();
    assert_eq!((ram.1, eeprom.1), (USERS_MS, USERS_MS));
    match report.proposed.first.first.velocity {
        Some(new) if report.verdict != Verdict::Refused => {
            assert_eq!(gains(&ram.0), [new.p, new.i, new.d, new.qpps]);
            assert_eq!(gains(&eeprom.0), gains(&ram.0));
        }
        _ => assert_eq!([ram, eeprom], before),
    }
    let again = replayed(&bench.report_path());
    assert_eq!(code(&again), Some(code_of(&report)), "{again:?}");
    assert!(again.stderr.join("\n").contains("to the last bit"), "{again:?}");
}

#[test]
fn torque_mode_is_refused_before_anything_moves_and_the_report_says_so() {
    let bench = Bench::on_pty(|settings| {
        let motion = &mut settings.motors[0].motion;
        (motion.inductance_raw, motion.resistance_raw) = (67_109, 134_217_728);
    });
    let before = bench.held();
    let ending = bench.tune(&["--apply"]).finish(LIMIT);
    assert_eq!(code(&ending), Some(REFUSED), "{ending:?}");
    assert_eq!(bench.report().causes, [Cause::TorqueMode]);
    assert_eq!(bench.held(), before);
    assert!(bench.controller.look(|unit| unit.view().axes[0].encoder_counts.abs() < 3));
}

#[test]
fn a_reversed_encoder_is_refused_and_its_report_replays_to_the_same_code() {
    let bench = Bench::new(|_| {});
    let before = bench.held();
    bench.controller.apply(WorldAction::ReverseEncoder { motor: Motor::M1, on: true });
    let run = || bench.tune(&["--dry-run", "--json"]).finish(LIMIT);
    let ending = (0..ATTEMPTS).map(|_| run()).find(|ending| code(ending) != Some(TOO_LATE));
    let ending = ending.expect("a computer that is in time now and then");
    assert_eq!(code(&ending), Some(REFUSED), "{ending:?}");
    let reported: serde_json::Value = serde_json::from_str(&ending.stdout.join("\n")).expect("JSON");
    assert_eq!(reported["verdict"], "refused", "{reported}");
    assert_eq!(bench.held(), before);
    assert_eq!(code(&replayed(&bench.report_path())), Some(REFUSED));
    let text = std::fs::read_to_string(bench.report_path()).expect("written");
    let damaged = bench.folder.path().join("damaged.json");
    std::fs::write(&damaged, text.replace("\"velocity\"", "\"upwards\"")).expect("a folder of ours");
    let wrong = replayed(&damaged);
    assert_eq!(code(&wrong), Some(FAILED), "{wrong:?}");
    let said = wrong.stderr.join("\n");
    assert!(said.contains("damaged.json: line ") && said.contains("field \""), "{said}");
}

/// What is said when a stage begins, from the first settings that are read to the last gains that are tried.
const STAGES: [&str; 6] = [
    "read M1 velocity PID",
    "keep a backup",
    "Checking the wiring",
    "Measuring the motor",
    "Measuring the lag",
    "Trying the gains",
];

/// The stages that come before the first verdict: every run reaches them, however crowded the computer is.
const BEFORE_ANY_VERDICT: usize = 4;

/// Runs that a crowded computer may be too late for, or refuse before they come to one of the later stages.
const ATTEMPTS: usize = 5;

/// One stage after another: six programs with six controllers at once would be the crowd that makes a run late.
#[test]
fn ctrl_c_at_every_stage_stops_the_motors_and_puts_the_old_gains_back() {
    for (at, stage) in STAGES.into_iter().enumerate() {
        let reached = (0..ATTEMPTS).any(|_| interrupt_at(stage));
        assert!(reached || at >= BEFORE_ANY_VERDICT, "{stage}: not reached");
        if !reached {
            println!("{stage}: not reached in {ATTEMPTS} runs, each of which was refused before");
        }
    }
}

/// Whether a run came to `stage` and was ended there; if not, it was refused before. Either way nothing drives and the old gains stand.
fn interrupt_at(stage: &str) -> bool {
    let bench = Bench::new(|_| {});
    let before = bench.held();
    let mut program = bench.tune(&["--apply"]);
    let reached = program.reach_error(stage, LIMIT).is_ok();
    if reached {
        program.signal("INT");
    }
    let ending = program.finish(LIMIT);
    let wanted = if reached { &[INTERRUPTED][..] } else { &[REFUSED, TOO_LATE] };
    assert!(code(&ending).is_some_and(|code| wanted.contains(&code)), "{stage}: {ending:?}");
    bench.controller.wait_until("both bridges off", |unit| !is_driven(unit));
    assert_eq!(bench.held(), before, "{stage}: {ending:?}");
    reached
}

/// How long a program that gets no processor stands still: longer than a motion lives.
const STALLED: Duration = Duration::from_millis(700);

#[test]
fn a_run_that_this_computer_was_too_late_for_says_so_and_ends_as_no_signal_does() {
    let bench = Bench::new(|_| {});
    let before = bench.held();
    let mut program = bench.tune(&["--dry-run"]);
    program.wait_for_error("Measuring the motor", LIMIT);
    // Its guardian is as late as the rest of the computer, and sees that; one that stays awake ends a program that stands still.
    guardian::signal(program.id(), Signal::STOP);
    program.signal("STOP");
    std::thread::sleep(STALLED);
    program.signal("CONT");
    guardian::signal(program.id(), Signal::CONT);
    let ending = program.finish(LIMIT);
    let wanted = [TUNED, TUNED_WITH_WARNINGS, REFUSED, TOO_LATE];
    assert!(code(&ending).is_some_and(|code| wanted.contains(&code)), "{ending:?}");
    if matches!(code(&ending), Some(REFUSED | TOO_LATE)) {
        let said = [ending.stdout.join("\n"), ending.stderr.join("\n")].concat();
        assert!(said.contains("his computer answered late"), "{ending:?}");
    }
    bench.controller.wait_until("both bridges off", |unit| !is_driven(unit));
    assert_eq!(bench.held(), before, "{ending:?}");
}

#[test]
fn the_exit_code_of_each_verdict_is_in_the_help() {
    let help = Program::start(BRUSHWORK, &["tune", "--help"]).finish(LIMIT).stdout.join("\n");
    for line in ["0  TUNED", "8  TUNED WITH WARNINGS", "4  REFUSED", "130  ended by Ctrl-C"] {
        assert!(help.contains(line), "{line}: {help}");
    }
}

#[test]
fn a_method_is_picked_and_its_rule_stands_beside_the_others() {
    for (method, rule) in [("step", "SIMC (of this method)"), ("relay", "Tyreus-Luyben (of this method)")] {
        let bench = Bench::new(|_| {});
        let before = bench.held();
        let ending = bench.tune(&["--method", method, "--about", "45"]).finish(LIMIT);
        let report = bench.report();
        assert_eq!(code(&ending), Some(code_of(&report)), "{ending:?}");
        let is_by_it = report.step.is_some() || report.relay.is_some();
        assert!(is_by_it || report.verdict == Verdict::Refused, "{:?}", report.causes);
        if report.verdict != Verdict::Refused {
            let printed = ending.stdout.join("\n");
            let loads = ["inertia, stable", "load change", "inertia x 0.5", "steady load held"];
            for words in [rule, "phase margin", "delay margin", "bandwidth"].into_iter().chain(loads) {
                assert!(printed.contains(words), "{words}: {printed}");
            }
        }
        assert_eq!(bench.held(), before, "{ending:?}");
    }
}

#[test]
fn the_controllers_own_test_is_for_simulated_ones_alone() {
    // Behind a port a controller passes for a real one, whatever it is.
    let bench = Bench::new(|_| {});
    let before = bench.held();
    let ending = bench.tune(&["--method", "controller"]).finish(LIMIT);
    assert_eq!(code(&ending), Some(REFUSED), "{ending:?}");
    let said = [ending.stdout.join("\n"), ending.stderr.join("\n")].concat();
    assert!(said.contains("sent to simulated controllers only"), "{ending:?}");
    assert_eq!(bench.report().causes, [Cause::OwnTestOnSimulated]);
    assert!(bench.report().probe.is_none(), "nothing was moved");
    assert_eq!(bench.held(), before, "{ending:?}");
    for arguments in [
        &["tune", "velocity", "-c", "sim:mcp266", "--method", "controller"][..],
        &[
            "tune",
            "position",
            "-c",
            "sim:mcp266",
            "--turns-freely",
            "--method",
            "pid",
            "--identify",
            "controller",
        ],
    ] {
        let ending = Program::start(BRUSHWORK, arguments).finish(LIMIT);
        let printed = ending.stdout.join("\n");
        if code(&ending) != Some(REFUSED) {
            for words in ["controller's own test", "its period", "Tyreus-Luyben (of this method)"] {
                assert!(printed.contains(words), "{words}: {ending:?}");
            }
        }
    }
}

#[test]
fn a_report_whose_name_ends_in_html_is_one_page_with_plots() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("run.html");
    let words = ["tune", "velocity", "-c", "sim:mcp266", "--dry-run", "--report"];
    let words: Vec<&str> = words.into_iter().chain(path.to_str()).collect();
    let ending = Program::start(BRUSHWORK, &words).finish(LIMIT);
    let page = std::fs::read_to_string(&path).unwrap_or_else(|error| panic!("{error}: {ending:?}"));
    assert!(page.starts_with("<!DOCTYPE html>") && page.ends_with("</body></html>\n"));
    assert!(page.contains("<h2>The run as it was measured</h2>"), "{page}");
    if matches!(code(&ending), Some(TUNED | TUNED_WITH_WARNINGS)) {
        assert!(
            page.contains("phase margin")
                && page.contains("inertia x 0.5")
                && page.matches("<svg").count() >= 7,
            "{page}"
        );
    }
}

#[test]
fn what_load_the_loop_stands_is_in_the_figures_for_programs_too() {
    let words = ["tune", "velocity", "-c", "sim:mcp266", "--dry-run", "--json"];
    let ending = Program::start(BRUSHWORK, &words).finish(LIMIT);
    if code(&ending) == Some(REFUSED) {
        return;
    }
    let printed: serde_json::Value = serde_json::from_str(&ending.stdout.join("\n")).expect("it is JSON");
    let stood = &printed["load_change"];
    let low = stood["calm"]["low"].as_f64().expect("a light load makes a velocity loop sensitive");
    assert!(low > 0.1 && low < 1.0, "{stood}");
    let row = |inertia: f64| {
        let rows = stood["changed"].as_array().expect("rows");
        rows.iter().find(|row| row["change"]["inertia"] == inertia).expect("it is a row")["ms"].as_f64()
    };
    assert!(row(0.5) > row(1.0) && row(1.0) > Some(1.0), "{stood}");
    assert!(stood["held"]["duty"].as_f64().is_some_and(|duty| duty > 0.1 && duty < 0.6), "{stood}");
}

#[test]
fn a_position_is_not_tuned_without_saying_how_far_the_axis_may_go_nor_as_piv_by_the_controllers_own_test() {
    for (arguments, words) in [
        (&["tune", "position", "-c", "sim:mcp266"][..], "--turns-freely"),
        (&["tune", "position", "--method", "step", "-c", "sim:mcp266"], "--turns-freely"),
        (&["tune", "position", "--method", "controller", "-c", "sim:mcp266"], "not of PIV"),
        (
            &["tune", "position", "--method", "piv", "--identify", "controller", "-c", "sim:mcp266"],
            "not of PIV",
        ),
        (
            &[
                "tune",
                "position",
                "--method",
                "step",
                "--identify",
                "relay",
                "--turns-freely",
                "-c",
                "sim:mcp266",
            ],
            "not by both",
        ),
    ] {
        let ending = Program::start(BRUSHWORK, arguments).finish(LIMIT);
        assert_eq!(code(&ending), Some(2), "{ending:?}");
        assert!(ending.stderr.join("\n").contains(words), "{ending:?}");
    }
}

#[test]
fn a_position_is_tuned_by_a_relay_about_where_it_stands_and_the_rules_stand_beside_it() {
    let bench = Bench::new(|_| {});
    let arguments = ["--turns-freely", "--method", "pd", "--identify", "relay"];
    let ending = bench.tune_loop("position", &arguments).finish(LIMIT);
    let found = code(&ending);
    assert!([TUNED, TUNED_WITH_WARNINGS, TOO_LATE].map(Some).contains(&found), "{ending:?}");
    if found == Some(TOO_LATE) {
        return;
    }
    let printed = ending.stdout.join("\n");
    for words in ["limit cycle", "duty/count", "Ziegler-Nichols (of this method)", "position P"] {
        assert!(printed.contains(words), "{words}: {printed}");
    }
    let relay = bench.report().position_relay;
    assert!(relay.is_some_and(|relay| relay.cycles == 12), "{relay:?}");
}

#[test]
fn arguments_that_make_no_sense_are_told_before_anything_is_opened() {
    for (arguments, word) in [
        (&["--level", "101"][..], "101"),
        (&["--travel", "10..5"], "no travel"),
        (&["--max-current", "0"], "no current"),
        (&["--apply", "--dry-run"], "--dry-run"),
        (&["--motor", "3"], "3"),
    ] {
        let ending = Program::start(BRUSHWORK, &[&["tune", "position"], arguments].concat()).finish(LIMIT);
        assert_eq!(code(&ending), Some(2), "{arguments:?}: {ending:?}");
        assert!(ending.stderr.join("\n").contains(word), "{arguments:?}: {ending:?}");
    }
}
