//! What goes over the wire at the end of a run, byte by byte, on each way out.

use brushwork_mcp_axis::McpLaw;
use brushwork_plant::world::WorldAction;
use brushwork_tuning::axis::Axis as _;
use brushwork_tuning::cause::Cause;
use brushwork_tuning::report::Verdict;
use brushwork_tuning::tune::{Method, Request, tune};
use brushwork_tuning_bench::line::Event;
use brushwork_tuning_bench::mcp::population::specimen;
use brushwork_tuning_bench::run::request_of;
use brushwork_tuning_bench::unit::Unit;
use brushwork_values::Motor;
use std::time::Duration;

/// Address, command 52, duty 0 (2 bytes), acceleration 655359 = 0x0009FFFF: the highest (4 bytes); the checksum follows.
const DUTY_ZERO: [u8; 8] = [0x80, 52, 0, 0, 0x00, 0x09, 0xFF, 0xFF];

/// The requests of a run without their checksums, in the order they were sent.
fn requests(
    request: &Request<McpLaw>,
    strike: Option<(f64, WorldAction)>,
) -> (Vec<Vec<u8>>, Option<Cause>, Vec<u8>) {
    let plant = specimen(7, 0);
    let mut axis = Unit::axis(&plant);
    let start = axis.carrier.unit().now();
    if let Some((seconds, action)) = strike {
        axis.carrier.schedule(vec![Event { at: start + Duration::from_secs_f64(seconds), action }]);
    }
    let motion = axis.carrier.unit().settings().motors[0].motion;
    let before: Vec<u8> = [motion.velocity_d_raw, motion.velocity_p_raw, motion.velocity_i_raw, motion.qpps]
        .iter()
        .flat_map(|raw| raw.to_be_bytes())
        .collect();
    let report = tune(&mut axis, request);
    let cause = (report.verdict == Verdict::Refused).then(|| report.causes[0]);
    // Questions are address and command alone; what sets something ends with a checksum of two bytes.
    let body = |bytes: &Vec<u8>| bytes[..(bytes.len() - 2).max(2)].to_vec();
    let sent = axis.carrier.sent.iter().map(body).collect();
    (sent, cause, before)
}

fn is_drive(request: &[u8]) -> bool {
    matches!(request[1], 35 | 52 | 65)
}

/// After the last drive that was not duty 0 come at least three of duty 0.
fn ends_with_three_zeros(sent: &[Vec<u8>]) {
    let last = sent.iter().rposition(|request| is_drive(request) && request[..] != DUTY_ZERO);
    let after = &sent[last.map_or(0, |last| last + 1)..];
    let zeros = after.iter().filter(|request| request[..] == DUTY_ZERO).count();
    assert!(zeros >= 3, "{zeros} times duty 0 at the end");
}

#[test]
fn each_way_out_ends_with_duty_0_three_times_the_old_gains_and_the_old_time_out() {
    let motor = Motor::M1;
    let faults = [
        (None, None),
        (Some((0.0, WorldAction::OpenLead { motor, on: true })), Some(Cause::MotorOpen)),
        (Some((1.4, WorldAction::LockShaft { motor, on: true })), Some(Cause::Stalled)),
        (Some((3.4, WorldAction::LoseEncoder { motor, on: true })), Some(Cause::EncoderLost)),
    ];
    let plant = specimen(7, 0);
    for (strike, wanted) in faults {
        let (sent, cause, before) = requests(&request_of(&plant, Method::Velocity), strike.clone());
        assert_eq!(cause, wanted, "{strike:?}");
        ends_with_three_zeros(&sent);
        // Command 28: address, command, D, P, I, QPPS, four bytes each.
        let loops: Vec<&Vec<u8>> = sent.iter().filter(|request| request[1] == 28).collect();
        if let Some(last) = loops.last() {
            assert_eq!(last[2..], before, "{strike:?}: the old gains are written last");
        }
        // Command 145: address, command, index, type, rate (4), time-out in ms (4).
        let timeouts: Vec<u32> = sent
            .iter()
            .filter(|request| request[1] == 145)
            .map(|request| u32::from_be_bytes([request[8], request[9], request[10], request[11]]))
            .collect();
        assert_eq!(timeouts.first(), Some(&200), "{strike:?}: shortened first");
        assert_eq!(timeouts.last(), Some(&1000), "{strike:?}: the user's own at the end");
        let first_145 = sent.iter().position(|request| request[1] == 145);
        let first_drive = sent.iter().position(|request| is_drive(request));
        assert!(first_145 < first_drive, "{strike:?}: before the first motion");
        // Nothing is ever saved (94), and 32 and 33, which the default acceleration slows, are not used.
        assert!(!sent.iter().any(|request| matches!(request[1], 32 | 33 | 94)), "{strike:?}");
    }
}

/// The counts of the first drive up pass 0, where those of a controller that was reset would begin.
#[test]
fn a_motor_that_gathers_speed_past_count_0_is_no_controller_that_was_reset() {
    let mut passed = 0;
    for number in [0, 2, 11, 27] {
        let plant = specimen(31, number);
        for back_ms in (40..400).step_by(12) {
            let mut axis = Unit::axis(&plant);
            axis.drive_duty(-9_000).expect("the line is whole");
            let until = axis.now() + Duration::from_millis(back_ms);
            axis.wait_until(until).expect("nothing stops it");
            axis.drive_duty(0).expect("the line is whole");
            let mut request: Request<McpLaw> = request_of(&plant, Method::Velocity);
            request.guard.time_limit_s = 3.0;
            let report = tune(&mut axis, &request);
            let case = format!("plant {number}, {back_ms} ms back");
            assert_ne!(report.causes.first(), Some(&Cause::WasReset), "{case}");
            passed += usize::from(report.probe.is_some());
        }
    }
    assert_eq!(passed, 4 * 30, "runs that came to their first drive");
}
