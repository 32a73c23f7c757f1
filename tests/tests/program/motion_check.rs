//! A motor that does not do what it was told is named, in virtual time, over every family; a healthy one never is.

use std::time::Duration;

use brushwork_core::motion::check::{Finding, Kind, MotionCheck};
use brushwork_core::session::line::SimulatedLine;
use brushwork_family::simulator;
use brushwork_link::FamilyChoice;
use brushwork_link::device::{ArmScope, DeviceOptions, DisarmReason, Drive, DriveCommand, Event, Request};
use brushwork_mcp_wire::packet_serial::number;
use brushwork_motion_mind_wire::register_number;
use brushwork_plant::faults::{Direction, Fault, FaultEffect};
use brushwork_plant::world::{UnitFault, WorldAction};
use brushwork_tests::virtual_link::VirtualLink;
use brushwork_values::{Motor, Value};

const SECOND: Duration = Duration::from_secs(1);
/// How often the events are looked at.
const LOOK: Duration = Duration::from_millis(20);

/// A unit whose motor is driven, and what is said of that.
struct Driven {
    name: String,
    link: VirtualLink<SimulatedLine>,
    check: MotionCheck,
    seen: usize,
    findings: Vec<Finding>,
    disarmed: Vec<DisarmReason>,
}

impl Driven {
    fn new(name: &str) -> Self {
        Self::on_a_line(name, Vec::new())
    }

    fn on_a_line(name: &str, faults: Vec<Fault>) -> Self {
        brushwork::install();
        let simulator = simulator::asked_for(name).expect("it is one");
        let started = simulator.start(name).expect("the presets make motors");
        let options = DeviceOptions {
            family: FamilyChoice::of(simulator.family()),
            stream: Some(started.stream),
            simulated: true,
            ..DeviceOptions::default()
        };
        let mut driven = Self {
            name: name.to_owned(),
            link: VirtualLink::over_stream(started, options, faults),
            check: MotionCheck::default(),
            seen: 0,
            findings: Vec::new(),
            disarmed: Vec::new(),
        };
        driven.run(5 * SECOND);
        driven
    }

    /// Arms; a RoboClaw needs a serial time-out for it.
    fn arm(&mut self) {
        if self.name.starts_with("roboclaw") {
            let values = vec![Value::Int(10)];
            self.link.ask(Request::Transact { id: 1, command: number::SET_SERIAL_TIMEOUT, values });
        }
        self.link.ask(Request::Arm(ArmScope::CommandLine));
        self.run(2 * SECOND);
        let is_armed = self.link.events.iter().any(|(_, event)| matches!(event, Event::Armed { .. }));
        let refusals = self.link.events.iter().filter(|(_, event)| matches!(event, Event::ArmRefused { .. }));
        assert!(is_armed, "{}: {:?}", self.name, refusals.collect::<Vec<_>>());
    }

    fn drive(&mut self, command: DriveCommand) {
        self.link.ask(Request::Drive(Drive::one(Motor::M1, command)));
    }

    /// Arms, and drives for 2 s, after which a healthy motor moves and nothing is said.
    fn begin(&mut self, command: DriveCommand) {
        self.arm();
        self.drive(command);
        self.run(2 * SECOND);
        assert_eq!(self.findings, [], "{}: a healthy start", self.name);
        assert_eq!(self.disarmed, [], "{}", self.name);
    }

    /// Lets time pass, and the check hear what is told.
    fn run(&mut self, time: Duration) {
        let end = self.link.now() + time;
        while self.link.now() < end {
            self.link.run_for(LOOK);
            for (_, event) in &self.link.events[self.seen..] {
                self.findings.extend(self.check.take(event));
                if let Event::Disarmed(reason) = event {
                    self.disarmed.push(reason.clone());
                }
            }
            self.seen = self.link.events.len();
        }
    }

    fn apply(&mut self, action: &WorldAction) {
        self.link.apply(0, action);
    }

    /// What is not as it should be where one thing of a kind should be found, in a sentence with these words.
    fn wrong(&self, kind: Kind, words: &[&str]) -> Option<String> {
        let is_right = match &self.findings[..] {
            [finding] => {
                let sentence = finding.sentence.to_string();
                (finding.kind, finding.motor) == (kind, Motor::M1)
                    && finding.is_fault() == (kind != Kind::Stands)
                    && sentence.ends_with('.')
                    && words.iter().all(|word| sentence.contains(word))
            }
            _ => false,
        };
        let found = || format!("{}: {:?}, disarmed {:?}", self.name, self.findings, self.disarmed);
        (!is_right).then(found)
    }
}

const QUARTER: DriveCommand = DriveCommand::Duty { duty: 0.25, accel_duty_per_s: None };
const SPEED: DriveCommand =
    DriveCommand::Speed { speed_counts_per_s: 3000, accel_counts_per_s2: Some(12_000) };

/// Both ends of the generations, another family of the same wire, and one that tells a duty in mode 3.
const UNITS: [&str; 4] =
    ["mcp266", "mcp266,generation=4", "roboclaw-2x7a,generation=3", "motion-mind-3,mode=3"];

#[test]
fn a_bridge_that_gives_nothing_is_named_where_no_status_tells_it() {
    let mut wrong = Vec::new();
    for name in ["mcp266", "mcp266,generation=4", "roboclaw-2x7a,generation=3", "roboclaw-2x7a,generation=4"]
    {
        for fault in [UnitFault::M1Driver, UnitFault::M1Current] {
            let mut driven = Driven::new(name);
            driven.begin(QUARTER);
            driven.apply(&WorldAction::SetUnitFault { fault, on: true });
            driven.run(2 * SECOND);
            // A status that has a bit for it ends the motion by itself.
            match driven.disarmed.first() {
                Some(DisarmReason::Fault(what)) => println!("{name}, {fault:?}: {what:?}"),
                Some(_) | None => {
                    println!("{name}, {fault:?}: {:?}", driven.findings);
                    wrong.extend(driven.wrong(Kind::NoOutput, &["driver fault", "25.0 %"]));
                }
            }
        }
    }
    assert_eq!(wrong, [""; 0]);
}

/// A reply that is missing, or a running time that began again, is told by the device thread itself.
#[test]
fn a_unit_that_lost_its_power_for_a_moment_is_never_passed_over() {
    let mut wrong = Vec::new();
    for name in UNITS {
        for lost_ms in [10, 100, 300] {
            let mut driven = Driven::new(name);
            driven.begin(QUARTER);
            driven.apply(&WorldAction::Power { on: false });
            driven.run(Duration::from_millis(lost_ms));
            driven.apply(&WorldAction::Power { on: true });
            driven.run(3 * SECOND);
            println!("{name}, {lost_ms} ms: {:?}, {:?}", driven.findings, driven.disarmed);
            if driven.disarmed.is_empty() {
                wrong.extend(driven.wrong(Kind::StartedAnew, &["has restarted", "supply"]));
            }
        }
    }
    assert_eq!(wrong, [""; 0]);
}

#[test]
fn a_unit_whose_power_stays_away_is_silent_and_its_power_is_named() {
    for name in UNITS {
        let mut driven = Driven::new(name);
        driven.begin(QUARTER);
        driven.apply(&WorldAction::Power { on: false });
        driven.run(5 * SECOND);
        assert_eq!(driven.disarmed.first(), Some(&DisarmReason::NoAnswer), "{name}: {:?}", driven.findings);
        assert_eq!(driven.findings, [], "{name}: silence is told once");
    }
    let sentence = DisarmReason::NoAnswer.to_string();
    assert!(
        sentence.contains("no answer came in time")
            && sentence.contains("power")
            && sentence.contains("busy"),
        "{sentence}"
    );
}

#[test]
fn a_shaft_that_is_held_is_a_stall_and_an_open_lead_is_told_from_it() {
    let mut wrong = Vec::new();
    for name in UNITS {
        let mut driven = Driven::new(name);
        driven.begin(QUARTER);
        driven.apply(&WorldAction::LockShaft { motor: Motor::M1, on: true });
        driven.run(3 * SECOND);
        println!("{name}: {:?}", driven.findings);
        wrong.extend(driven.wrong(Kind::Stall, &["blocked", " A"]));

        let mut driven = Driven::new(name);
        driven.begin(QUARTER);
        driven.apply(&WorldAction::OpenLead { motor: Motor::M1, on: true });
        driven.run(6 * SECOND);
        println!("{name}: {:?}", driven.findings);
        wrong.extend(driven.wrong(Kind::Stall, &["open motor lead"]));
    }
    assert_eq!(wrong, [""; 0]);
}

#[test]
fn a_loop_whose_motor_is_held_is_a_stall_from_the_start() {
    let mut wrong = Vec::new();
    for name in ["mcp266", "mcp266,generation=4", "roboclaw-2x7a,generation=3", "motion-mind-3,mode=4"] {
        let mut driven = Driven::new(name);
        driven.arm();
        driven.apply(&WorldAction::LockShaft { motor: Motor::M1, on: true });
        driven.drive(SPEED);
        driven.run(5 * SECOND);
        println!("{name}: {:?}", driven.findings);
        wrong.extend(driven.wrong(Kind::Stall, &["blocked"]));
    }
    assert_eq!(wrong, [""; 0]);
}

#[test]
fn gains_that_drive_a_motor_to_and_fro_are_a_limit_cycle() {
    let mut wrong = Vec::new();
    for name in ["mcp266", "mcp266,generation=4", "roboclaw-2x7a,generation=3"] {
        let mut driven = Driven::new(name);
        // D, P, I, QPPS: a P of 60 makes each count more than the whole output.
        let values = [0, 60 << 16, 0, 3000].map(Value::Int).to_vec();
        driven.link.ask(Request::Transact { id: 1, command: number::SET_VELOCITY_PID_M1, values });
        driven.run(SECOND);
        driven.arm();
        driven.drive(SPEED);
        driven.run(5 * SECOND);
        println!("{name}: {:?}", driven.findings);
        wrong.extend(driven.wrong(Kind::LimitCycle, &["gains are too high", "3000 counts/s"]));
    }
    let mut driven = Driven::new("motion-mind-3,mode=4");
    // The largest P at the smallest scale, and nothing that damps (manual 4.3).
    for (index, value) in
        [(register_number::PTERM, 65_535), (register_number::DTERM, 0), (register_number::PIDSCALAR, 1)]
    {
        let values = [index.into(), value].map(Value::Int).to_vec();
        driven.link.ask(Request::Transact { id: index.into(), command: 0x18, values });
        driven.run(SECOND);
    }
    driven.arm();
    driven.drive(SPEED);
    driven.run(5 * SECOND);
    println!("motion-mind-3: {:?}", driven.findings);
    wrong.extend(driven.wrong(Kind::LimitCycle, &["gains are too high", "3000 counts/s"]));
    assert_eq!(wrong, [""; 0]);
}

#[test]
fn too_little_for_friction_is_told_as_that_and_so_is_a_motor_without_an_encoder() {
    let mut wrong = Vec::new();
    for name in UNITS {
        let mut driven = Driven::new(name);
        driven.arm();
        driven.drive(DriveCommand::duty(0.005));
        driven.run(3 * SECOND);
        println!("{name}: {:?}", driven.findings);
        wrong.extend(driven.wrong(Kind::Stands, &["friction"]));

        let mut driven = Driven::new(name);
        driven.apply(&WorldAction::LoseEncoder { motor: Motor::M1, on: true });
        driven.arm();
        driven.drive(QUARTER);
        driven.run(3 * SECOND);
        wrong.extend(driven.wrong(Kind::Stands, &["no encoder"]));
    }
    assert_eq!(wrong, [""; 0]);
}

/// Slow machines, soft ramps, moves to their end, reversals, late and lossy lines, a late computer.
#[test]
fn a_healthy_motor_is_never_accused() {
    let accel = |counts| Some(counts);
    let soft = DriveCommand::Duty { duty: 0.3, accel_duty_per_s: Some(0.02) };
    let slow = DriveCommand::Speed { speed_counts_per_s: 2000, accel_counts_per_s2: accel(100) };
    let back = DriveCommand::Speed { speed_counts_per_s: -3000, accel_counts_per_s2: accel(2000) };
    let to = DriveCommand::Distance {
        speed_counts_per_s: 2000,
        accel_counts_per_s2: accel(4000),
        distance_counts: 3000,
        queued: false,
    };
    let mut wrong = Vec::new();
    for generation in [1, 4] {
        for preset in ["small-gearmotor", "flywheel", "coarse-encoder", "arm-joint", "large-gearmotor"] {
            let mut driven = Driven::new(&format!("mcp266,generation={generation},preset={preset}"));
            driven.arm();
            // The gains of the factory make a real limit cycle of a move of a machine that is heavier than they are for.
            let moves = [to].into_iter().filter(|_| preset == "small-gearmotor");
            for command in [soft, slow, back, QUARTER].into_iter().chain(moves) {
                driven.drive(command);
                driven.run(6 * SECOND);
                wrong.extend(
                    driven.findings.drain(..).map(|finding| format!("{}: {}", driven.name, finding.sentence)),
                );
            }
        }
    }
    for (name, command) in [
        ("roboclaw-2x7a,generation=3", SPEED),
        ("motion-mind-3,mode=3", soft),
        ("motion-mind-3,mode=4", back),
        ("motion-mind-3,mode=4", to),
    ] {
        let mut driven = Driven::new(name);
        driven.begin(command);
        driven.run(10 * SECOND);
        wrong.extend(driven.findings.drain(..).map(|finding| format!("{name}: {}", finding.sentence)));
    }
    assert_eq!(wrong, [""; 0]);
}

#[test]
fn a_late_lossy_line_and_a_late_computer_accuse_nobody() {
    let fault =
        |effect| Fault { effect, direction: Direction::Both, unit: 0, from: Duration::ZERO, until: None };
    for name in ["mcp266", "mcp266,generation=4", "motion-mind-3,mode=3"] {
        for effect in [
            FaultEffect::Delay { by: Duration::from_millis(60), share: 1.0 },
            FaultEffect::Drop { share: 0.002 },
        ] {
            let mut driven = Driven::on_a_line(name, vec![fault(effect.clone())]);
            driven.arm();
            driven.drive(QUARTER);
            driven.run(8 * SECOND);
            assert_eq!(driven.findings, [], "{name} with {effect:?}");
        }
        let mut driven = Driven::new(name);
        driven.begin(QUARTER);
        driven.link.freeze_window();
        driven.run(2 * SECOND);
        driven.link.thaw_window();
        driven.run(2 * SECOND);
        assert_eq!(driven.findings, [], "{name}");
        assert_eq!(driven.disarmed.first(), Some(&DisarmReason::DeadMan), "{name}");
    }
}
