//! The whole program in real time over a pseudo-terminal at 115200 bit/s: it finds the model that virtual time finds.
//!
//! `cargo bench -p brushwork-tests --bench tuning_real_time`; it takes some 6 s, and a busy machine shows in it.
#![expect(clippy::print_stdout, reason = "the table is what the benchmark is for")]

fn main() -> std::process::ExitCode {
    #[cfg(unix)]
    return real_time::run();
    #[cfg(not(unix))]
    std::process::ExitCode::SUCCESS
}

/// Pseudo-terminals exist on Unix alone.
#[cfg(unix)]
mod real_time {
    use std::path::Path;
    use std::process::ExitCode;
    use std::time::Duration;

    use brushwork_core::tune::law::{Report, Request};
    use brushwork_mcp_axis::PacketAxis;
    use brushwork_mcp_sim::controller::ControllerConfig;
    use brushwork_mcp_wire::packet_serial::Generation;
    use brushwork_plant::machine::StreamIndex;
    use brushwork_tests::program::Program;
    use brushwork_tests::simulated::{OnPty, is_at_rest};
    use brushwork_tuning::experiment_guard::GuardOptions;
    use brushwork_tuning::joined::Joined;
    use brushwork_tuning::report::Verdict;
    use brushwork_tuning::tune::tune;
    use brushwork_tuning_bench::line::SimulatedLine;
    use brushwork_tuning_bench::population::LinkParams;

    const BRUSHWORK: &str = env!("CARGO_BIN_EXE_brushwork-for-tests");

    /// What interval and link leave: two standard deviations of each fit, and the rounding of the polls.
    const ROUNDING: f64 = 0.02;

    fn config() -> ControllerConfig {
        ControllerConfig { generation: Generation::Gen4, ..ControllerConfig::default() }
    }

    fn in_virtual_time() -> Report {
        let unit =
            brushwork_mcp_sim::controller::Controller::new(config()).expect("the default world is sound");
        let link = LinkParams { poll_s: 0.010, jitter_s: 0.001, latency_s: 0.001, loss: 0.0, seed: 1 };
        let mut line = SimulatedLine::new(unit, link);
        line.idle(Duration::from_millis(500));
        let axis = PacketAxis::new(
            line,
            brushwork_values::Motor::M1,
            brushwork_tuning::axis::EncoderClass::Quadrature,
        );
        tune(
            &mut Joined::first(Box::new(Joined::first(Box::new(axis)))),
            &Request { guard: GuardOptions::default(), ..Request::default() },
        )
    }

    fn in_real_time(report: &Path) -> Report {
        let controller = OnPty::start_with(config(), StreamIndex::Uart1);
        let target = format!("{},baud=115200,stream=ttl1", controller.port().display());
        let report_text = report.to_string_lossy().into_owned();
        let arguments = ["tune", "velocity", "--connect", &target, "--dry-run", "--report", &report_text];
        let ending = Program::start(BRUSHWORK, &arguments).finish(Duration::from_secs(90));
        assert!(matches!(ending.status.code(), Some(0 | 8)), "{ending:?}");
        controller.wait_until("motors at rest", is_at_rest);
        let text = std::fs::read_to_string(report).expect("the report was written");
        serde_json::from_str(&text).expect("the report reads back")
    }

    /// One line of the table: what differs, by how much, and what it may differ by.
    fn line(what: &str, off: f64, interval: f64) -> bool {
        let verdict = if off <= interval { "within" } else { "OUTSIDE" };
        println!("{what:<16} off by {:>6.2} %, interval {:>6.2} %: {verdict}", 100.0 * off, 100.0 * interval);
        off <= interval
    }

    pub fn run() -> ExitCode {
        let folder = tempfile::tempdir().expect("a temporary folder can be made");
        let real = in_real_time(&folder.path().join("report.json"));
        let ideal = in_virtual_time();
        assert_ne!(ideal.verdict, Verdict::Refused, "{:?}", ideal.causes);
        let (a, b) = (real.fit.expect("a fit"), ideal.fit.expect("a fit"));
        let gain = (a.model.gain_counts_per_s / b.model.gain_counts_per_s).ln().abs();
        let tau = (a.model.tau_s / b.model.tau_s).ln().abs();
        let qpps = (real.qpps.expect("measured") / ideal.qpps.expect("measured") - 1.0).abs();
        let are_within = [
            line("gain", gain, 2.0 * a.sd_ln_gain.hypot(b.sd_ln_gain) + ROUNDING),
            line("time constant", tau, 2.0 * a.sd_ln_tau.hypot(b.sd_ln_tau) + 2.0 * ROUNDING),
            line("QPPS", qpps, ROUNDING),
        ];
        assert!(real.replay().is_some_and(|again| again == real), "the replay differs");
        ExitCode::from(u8::from(are_within.contains(&false)))
    }
}
