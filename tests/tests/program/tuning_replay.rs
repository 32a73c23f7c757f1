//! Reports that are kept in the repository, each with its record and its gains: every build, whatever its profile, must find the same
//! gains in the same record to the last bit.
//!
//! After a wanted change of the method: `rm tests/reports/*.json; UPDATE_REPORTS=1 cargo test -p brushwork-tests --test program tuning_replay::kept` records them anew.

use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};

use brushwork_core::tune::file;
use brushwork_core::tune::law::{Report, Request};
use brushwork_tests::program::Program;
use brushwork_tests::wait::LIMIT;
use brushwork_tuning::joined::Joined;
use brushwork_tuning::report::Verdict;
use brushwork_tuning::tune::{Method, tune};
use brushwork_tuning_bench::mcp::population::specimen;
use brushwork_tuning_bench::run::request_of;
use brushwork_tuning_bench::unit::Unit;

const BRUSHWORK: &str = env!("CARGO_BIN_EXE_brushwork-for-tests");

/// File, plant of seed 7, method, level. The first is drawn in the pictures of the window too.
const REPORTS: [(&str, usize, Method, f64); 3] = [
    ("velocity.json", 0, Method::Velocity, 50.0),
    ("piv.json", 3, Method::Piv, 50.0),
    ("pd.json", 7, Method::Pd, 75.0),
];

/// Held while a file is read or written.
static RECORDING: Mutex<()> = Mutex::new(());

fn folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("reports")
}

/// The report of a file; recorded anew where that is asked for.
fn report(name: &str, plant: usize, method: Method, level: f64) -> Report {
    let path = folder().join(name);
    let _one_at_a_time = RECORDING.lock().unwrap_or_else(PoisonError::into_inner);
    if std::env::var_os("UPDATE_REPORTS").is_some() {
        let plant = specimen(7, plant);
        let request = Request { level, ..request_of(&plant, method) };
        file::write(
            &tune(&mut Joined::first(Box::new(Joined::first(Box::new(Unit::axis(&plant))))), &request),
            &path,
            false,
        )
        .expect("the folder is in the repository");
    }
    file::read(&path).expect("it is in the repository")
}

#[test]
fn kept_reports_replay_to_the_last_bit() {
    for (name, plant, method, level) in REPORTS {
        let kept = report(name, plant, method, level);
        assert_ne!(kept.verdict, Verdict::Refused, "{name}: {:?}", kept.causes);
        let again = kept.replay_or_stray().unwrap_or_else(|entry| {
            panic!("{name}: the tuner asks for another step at entry {entry}; record it anew (see the head of this file)")
        });
        let gains =
            |report: &Report| (report.proposed.first.first.velocity, report.proposed.first.first.position);
        assert_eq!(gains(&again), gains(&kept), "{name}");
        assert!(
            again == kept,
            "{name}: something else than the gains differs; record it anew if that is wanted"
        );
    }
}

#[test]
fn the_command_says_so_too_and_ends_with_the_code_of_the_verdict() {
    for (name, plant, method, level) in REPORTS {
        let verdict = report(name, plant, method, level).verdict;
        let path = folder().join(name);
        let ending = Program::start(BRUSHWORK, &["tune", "replay", &path.to_string_lossy()]).finish(LIMIT);
        let code = if verdict == Verdict::Tuned { 0 } else { 8 };
        assert_eq!(ending.status.code(), Some(code), "{name}: {ending:?}");
        assert!(ending.stderr.join("\n").contains("to the last bit"), "{name}: {ending:?}");
    }
}
