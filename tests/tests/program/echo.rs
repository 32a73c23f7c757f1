//! The smallest family there can be, registered here alone. It keeps shared code free of the families that the program has.

use brushwork_link::device::{
    ArmScope, Channel, DeviceOptions, DisarmReason, Drive, DriveCommand, Event, Job, JobEnding, PlaceState,
    Request,
};
use brushwork_link::settings::{SettingValue, SettingsTable, Subject, WriteOptions, read_all, write};
use brushwork_link::unit::FirmwareGeneration;
use brushwork_link::{FamilyChoice, register};
use brushwork_plant::machine::{Machine, StreamIndex};
use brushwork_plant::world::{WorldAction, WorldView};
use brushwork_tests::said::Said;
use brushwork_tests::virtual_link::VirtualLink;
use brushwork_values::{Motor, Severity};
use family::{CHANNELS, ECHO, Echo, EchoMachine, MODELS};
use std::time::Duration;

mod family;

fn ms(ms: u64) -> Duration {
    Duration::from_millis(ms)
}

/// A link to an echo that nobody else's family was asked for.
fn connected() -> VirtualLink<EchoMachine> {
    register(&Echo);
    let options =
        DeviceOptions { family: FamilyChoice::of(ECHO), simulated: true, ..DeviceOptions::default() };
    let mut link = VirtualLink::over(EchoMachine::default(), options, Vec::new(), 1);
    link.run_for(ms(300));
    link
}

fn speed(speed_counts_per_s: i32) -> Drive {
    Drive::one(Motor::M1, DriveCommand::Speed { speed_counts_per_s, accel_counts_per_s2: None })
}

#[test]
fn a_family_of_one_motor_and_text_lines_runs_on_the_same_loop_by_the_same_rules() {
    let mut link = connected();
    let found = link.events.iter().find_map(|(_, event)| match event {
        Event::Connected(units) => Some(units.clone()),
        _ => None,
    });
    let unit = found.expect("it was found");
    assert_eq!((unit.family, unit.place(), unit.channels()), (ECHO, "echo 1".to_owned(), CHANNELS));
    assert!(unit.objection(&Drive::one(Motor::M1, DriveCommand::duty(0.5))).is_some());
    assert_eq!(unit.status_row(None, None)[0].state, PlaceState::Unknown);
    let is_position = |event: &Event| matches!(event, Event::Sample(sample) if sample.get(Channel::M1_POSITION) == Some(0.0));
    assert!(link.events.iter().any(|(_, event)| is_position(event)));

    link.ask(Request::Drive(speed(100)));
    link.run_for(ms(50));
    assert_eq!(link.bus(|echo| echo.speed_counts_per_s), 0.0, "unarmed");
    assert!(link.arm(ArmScope::Velocity));
    link.ask(Request::Drive(Drive::one(Motor::M1, DriveCommand::duty(0.5))));
    link.ask(Request::Drive(speed(100)));
    link.run_for(ms(200));
    assert_eq!(link.bus(|echo| echo.speed_counts_per_s), 100.0);
    link.freeze_window();
    link.run_for(ms(400));
    link.thaw_window();
    link.run_for(ms(50));
    assert_eq!(link.bus(|echo| echo.speed_counts_per_s), 0.0, "the dead-man stopped it");
    let disarmed = |wanted: DisarmReason| move |(_, event): &(Duration, Event)| matches!(event, Event::Disarmed(reason) if *reason == wanted);
    assert!(link.events.iter().any(disarmed(DisarmReason::DeadMan)));
    assert!(link.stops().last().is_some_and(|stop| stop.confirmed()));

    assert!(link.arm(ArmScope::Velocity));
    link.ask(Request::Drive(speed(-50)));
    link.run_for(ms(100));
    link.bus(|echo| echo.is_hot = true);
    link.run_for(ms(300));
    assert_eq!(link.bus(|echo| echo.speed_counts_per_s), 0.0, "its one fault stopped it");
    let hot = link.events.iter().rev().find_map(|(_, event)| match event {
        Event::Status(report) => Some(unit.status_row(Some(report), None)[0].state),
        _ => None,
    });
    assert_eq!(hot, Some(PlaceState::Active(Severity::Error)));
}

#[test]
fn the_settings_of_a_family_of_one_are_read_written_and_held_to_their_range() {
    let mut link = connected();
    let subject = Subject::new(&MODELS[0], FirmwareGeneration::new(ECHO, 1));
    let wanted = |value| [("loop.gain".to_owned(), SettingValue::Int(value))].into_iter().collect();
    let job = Job::new(Said::Write, ms(5000), move |wire| {
        let table = SettingsTable::new(subject);
        let report = write(wire, &table, &wanted(7), WriteOptions::default());
        let refused = write(wire, &table, &wanted(101), WriteOptions::default());
        let is_taken = report.is_ok_and(|report| report.is_complete());
        Ok((is_taken, refused.is_err(), read_all(wire, subject)?.image.get("loop.gain")))
    });
    let Some(JobEnding::Done(done)) = link.finish(job, ms(5000)) else { panic!("the job did not end") };
    assert_eq!(done, (true, true, Some(SettingValue::Int(7))));
    assert_eq!(link.bus(|echo| echo.gain), 7);
}

/// Takes everything and says nothing.
#[derive(Default)]
struct Silent(EchoMachine);

impl Machine for Silent {
    fn now(&self) -> Duration {
        self.0.now()
    }

    fn receive(&mut self, _stream: StreamIndex, _bytes: &[u8]) {}

    fn advance(&mut self, to: Duration) {
        self.0.advance(to);
    }

    fn next_output_at(&self) -> Option<Duration> {
        None
    }

    fn take_output(&mut self, _stream: StreamIndex) -> Option<Vec<u8>> {
        None
    }

    fn bits_per_second(&self, stream: StreamIndex) -> u32 {
        self.0.bits_per_second(stream)
    }

    fn units(&self) -> usize {
        1
    }

    fn apply(&mut self, _unit: usize, _action: &WorldAction) {}

    fn views(&self) -> Vec<WorldView> {
        Vec::new()
    }

    fn plugged(&self) -> bool {
        true
    }
}

#[test]
fn on_a_silent_port_all_families_are_looked_for_and_where_one_may_be_all_the_same_is_told() {
    let mut link = VirtualLink::over(Silent::default(), DeviceOptions::default(), Vec::new(), 1);
    link.run_for(Duration::from_secs(20));
    let reported = link.events.iter().find_map(|(_, event)| match event {
        Event::Lost(reason) => Some(reason.to_string()),
        _ => None,
    });
    let reported = reported.expect("the search ends");
    assert!(reported.contains("nothing answered at addresses 0x80 to 0x87"), "{reported}");
    assert!(
        reported.ends_with("choose its family (family=motion-mind), so that all are asked."),
        "{reported}"
    );
}
