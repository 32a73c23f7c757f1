//! What is measured of a Motion Mind: its stop at the motor.

use brushwork_link::FamilyChoice;
use brushwork_link::device::{Drive, DriveCommand};
use brushwork_link::transport::Stream;
use brushwork_motion_mind::sim_spec::MotionMindSpec;
use brushwork_motion_mind_client::MOTION_MIND;
use brushwork_plant::server::ServerOptions;
use brushwork_values::Motor;

use crate::bench::Measure;
use crate::bench::arguments::BenchArg;
use crate::bench::at_motor::{self, Case};
use crate::bench::rig::Far;

/// What is measured, and what measures it.
pub const MEASURES: &[Measure] = &[(BenchArg::Stop, |effort, interrupt| {
    let mut figures = Vec::new();
    for (mode, protocol, baud) in
        [(3, "binary", 19_200), (3, "ascii", 19_200), (4, "binary", 19_200), (3, "binary", 9_600)]
    {
        let spec =
            MotionMindSpec::parse(&format!("motion-mind-3,mode={mode},protocol={protocol},baud={baud}"))?;
        let far = Far {
            machine: Box::new(spec.bus().map_err(|error| error.to_string())?),
            index: ServerOptions::default().stream,
            stream: Stream::Rs232,
            family: FamilyChoice::of(MOTION_MIND),
            address: 1,
        };
        // In mode 3 the duty is commanded, in mode 4 the loop finds its own.
        let drive = if mode == 3 { (DriveCommand::duty(DUTY), DUTY) } else { (SPEED, 0.01) };
        let case = Case {
            name: format!("mode {mode}, {protocol}"),
            far,
            drive: (Drive::one(Motor::M1, drive.0), drive.1),
        };
        figures.extend(at_motor::measure(case, effort, interrupt)?);
    }
    Ok(figures)
})];

/// As for the other family.
const DUTY: f64 = 0.1;
/// A part of what the default motor reaches.
const SPEED: DriveCommand = DriveCommand::Speed { speed_counts_per_s: 2_000, accel_counts_per_s2: None };
