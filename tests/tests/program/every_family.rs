//! What every family promises, on a simulated unit of each of its models. A family that joins the program's list is tested here without a line more.

use brushwork_tests::said::Said;
use std::time::Duration;

use brushwork::{FAMILIES, Family};
use brushwork_core::session::line::SimulatedLine;
use brushwork_family::Started;
use brushwork_link::device::{
    ArmScope, DeviceOptions, DisarmReason, Drive, DriveCommand, Event, Identity, Job, JobEnding,
};
use brushwork_link::family::Model;
use brushwork_link::settings::{
    Group, Profile, Row, SettingValue, SettingsImage, SettingsTable, Strictness, WriteOptions, plan,
    read_all, write,
};
use brushwork_link::{FamilyChoice, UnitAddress};
use brushwork_plant::world::WorldAction;
use brushwork_tests::virtual_link::VirtualLink;
use brushwork_values::Motor;

const SECOND: Duration = Duration::from_secs(1);

/// A model of a family, and the family.
struct Case {
    family: &'static Family,
    model: &'static Model,
}

impl Case {
    fn key(&self) -> &'static str {
        self.model.key
    }

    fn started(&self) -> Started {
        let started = self.family.simulator.start(self.model.key);
        started.unwrap_or_else(|error| panic!("{}: {error}", self.key()))
    }

    /// A link to a simulated unit of the model, found by a search for its family alone.
    fn connected(&self) -> (VirtualLink<SimulatedLine>, Identity) {
        let started = self.started();
        let options = DeviceOptions {
            family: FamilyChoice::of(self.family.driver.family()),
            stream: Some(started.stream),
            simulated: true,
            ..DeviceOptions::default()
        };
        let mut link = VirtualLink::to_simulated(started, options);
        link.run_for(5 * SECOND);
        let identity = link.events.iter().find_map(|(_, event)| match event {
            Event::Connected(identity) => Some(identity.clone()),
            _ => None,
        });
        (link, identity.unwrap_or_else(|| panic!("{} was not found", self.key())))
    }
}

/// Every model of every family that the program has.
fn cases() -> Vec<Case> {
    brushwork::install();
    let models = |family: &'static Family| {
        family.driver.family().models().iter().map(move |model| Case { family, model })
    };
    FAMILIES.iter().flat_map(models).collect()
}

/// Why arming was refused.
fn refusals(link: &VirtualLink<SimulatedLine>) -> Vec<String> {
    let reasons = link.events.iter().filter_map(|(_, event)| match event {
        Event::ArmRefused { reasons, .. } => Some(reasons),
        _ => None,
    });
    reasons.flatten().map(ToString::to_string).collect()
}

/// A gentle motion that the unit takes as it comes from the factory.
fn gentle(unit: &Identity) -> Drive {
    let takes = unit.capabilities();
    let command = match (takes.duty, takes.speed) {
        (true, _) => DriveCommand::duty(0.3),
        (false, true) => DriveCommand::Speed { speed_counts_per_s: 500, accel_counts_per_s2: None },
        // So far that it is on its way whenever the test looks.
        (false, false) => DriveCommand::Position {
            position_counts: 60_000,
            speed_counts_per_s: 0,
            accel_counts_per_s2: 0,
            decel_counts_per_s2: 0,
            queued: false,
        },
    };
    Drive::one(Motor::M1, command)
}

#[test]
fn the_list_holds_each_family_once_and_each_has_models() {
    brushwork::install();
    let mut keys: Vec<_> = FAMILIES.iter().map(|family| family.driver.family().key()).collect();
    let count = keys.len();
    keys.sort_unstable();
    keys.dedup();
    assert_eq!(keys.len(), count);
    for family in &FAMILIES {
        let names = family.driver.family();
        assert_eq!(names, family.simulator.family());
        assert!(!names.models().is_empty(), "{}", names.key());
        assert!(names.has_address(names.factory_address()), "{}", names.key());
        for model in names.models() {
            assert_eq!(names.model(model.key), Some(model));
            assert_eq!(names.model(model.name), Some(model));
        }
    }
}

#[test]
fn a_unit_of_each_model_is_found_says_who_it_is_and_is_polled() {
    for case in cases() {
        let (link, unit) = case.connected();
        assert_eq!(unit.family, case.family.driver.family(), "{}", case.key());
        assert_eq!(unit.model, Some(case.model.name), "{}", case.key());
        let polled = link.events.iter().filter_map(|(_, event)| match event {
            Event::Sample(sample) => Some(sample),
            _ => None,
        });
        let polled: Vec<_> = polled.collect();
        assert!(polled.len() > 10, "{}: {} samples", case.key(), polled.len());
        let channels = unit.channels();
        let strange = polled
            .iter()
            .flat_map(|sample| sample.readings())
            .find(|reading| !channels.contains(&reading.channel));
        assert!(strange.is_none(), "{}: {strange:?}", case.key());
        assert!(link.events.iter().any(|(_, event)| matches!(event, Event::Status(_))), "{}", case.key());
        assert!(!unit.status_row(None, None).is_empty(), "{}", case.key());
    }
}

#[test]
fn a_unit_of_each_model_moves_only_while_it_is_armed_and_stops_with_the_window() {
    let mut driven = Vec::new();
    for case in cases() {
        let (mut link, unit) = case.connected();
        let drive = gentle(&unit);
        assert!(!unit.preview(&drive).is_empty(), "{}", case.key());
        link.ask(brushwork_link::device::Request::Drive(drive));
        link.run_for(SECOND / 5);
        assert_eq!(link.speeds(0)[0], 0.0, "{} moves unarmed", case.key());

        if !link.arm(ArmScope::CommandLine) {
            // A unit that cannot be driven safely as it comes says why.
            println!("{}: {:?}", case.key(), refusals(&link));
            assert!(!refusals(&link).is_empty(), "{}", case.key());
            continue;
        }
        driven.push(case.family.driver.family());
        link.ask(brushwork_link::device::Request::Drive(drive));
        link.run_for(SECOND / 2);
        assert!(link.speeds(0)[0] > 1.0, "{}: {} rad/s", case.key(), link.speeds(0)[0]);
        link.handle.stop_all();
        link.run_for(SECOND);
        // A loop that holds a speed of 0 may still put out a little.
        assert!(link.speeds(0)[0].abs() < 0.5, "{}: Stop: {} rad/s", case.key(), link.speeds(0)[0]);
        assert!(link.stops().last().is_some_and(|stop| stop.confirmed()), "{}", case.key());

        assert!(link.arm(ArmScope::CommandLine), "{}", case.key());
        link.ask(brushwork_link::device::Request::Drive(drive));
        link.run_for(SECOND / 2);
        assert!(link.speeds(0)[0] > 1.0, "{}", case.key());
        link.freeze_window();
        link.run_for(SECOND * 5 / 4);
        assert!(link.speeds(0)[0].abs() < 0.5, "{}: the dead-man: {} rad/s", case.key(), link.speeds(0)[0]);
        link.thaw_window();
        link.run_for(SECOND / 10);
        let reason = link.events.iter().find_map(|(_, event)| match event {
            Event::Disarmed(reason) => Some(reason),
            _ => None,
        });
        assert_eq!(reason, Some(&DisarmReason::DeadMan), "{}", case.key());
    }
    assert!(FAMILIES.iter().all(|family| driven.contains(&family.driver.family())), "{driven:?}");
}

#[test]
fn the_settings_of_each_model_are_read_are_in_range_and_take_each_other_value_that_they_offer() {
    for case in cases() {
        let (mut link, unit) = case.connected();
        let subject = unit.subject().unwrap_or_else(|| panic!("{} has no settings", case.key()));
        let job = Job::new(Said::Settings, 60 * SECOND, move |wire| {
            let table = SettingsTable::new(subject);
            let before = read_all(wire, subject)?.image;
            // The least change of each setting, one write for all that can be planned beside each other.
            let mut wanted = SettingsImage::default();
            // What the line itself depends on stays as it is.
            let is_of_the_line = |row: &Row| matches!(row.group, Group::UNIT | Group::STREAMS | Group::BUSES);
            let free = |row: &&Row| row.locked(true).is_none() && row.has_wire_form() && !is_of_the_line(row);
            for row in table.rows().iter().filter(free) {
                let Some(value) = before.get(&row.key).and_then(|value| {
                    neighbour(row.encode(value)?, |raw| row.decode(raw), |value| row.check(value).is_ok())
                }) else {
                    continue;
                };
                let mut more = wanted.clone();
                more.set(&row.key, value);
                if plan(&table, &before, &more, WriteOptions { simulated: true, ..WriteOptions::default() })
                    .is_ok()
                {
                    wanted = more;
                }
            }
            let taken =
                write(wire, &table, &wanted, WriteOptions { simulated: true, ..WriteOptions::default() });
            let after = read_all(wire, subject)?.image;
            Ok((
                before,
                wanted,
                taken.map(|report| report.is_complete()).map_err(|error| error.to_string()),
                after,
            ))
        });
        let Some(JobEnding::Done((before, wanted, taken, after))) = link.finish(job, 60 * SECOND) else {
            panic!("{}: the job did not end: {:?}", case.key(), link.events)
        };
        let table = SettingsTable::new(subject);
        let readable =
            table.rows().iter().filter(|row| row.has_wire_form() && before.get(&row.key).is_none());
        let missing: Vec<_> = readable.map(|row| &row.key).collect();
        println!(
            "{}: {} settings, {} written, not read: {missing:?}",
            case.key(),
            before.len(),
            wanted.len()
        );
        for row in table.rows() {
            if let Some(value) = before.get(&row.key) {
                assert_eq!(row.check(value), Ok(()), "{}", case.key());
            }
        }
        assert_eq!(taken, Ok(true), "{}", case.key());
        // What is shown for comparison alone follows from the rest.
        let mut expected = before;
        expected.merge(&wanted);
        table
            .rows()
            .iter()
            .filter(|row| row.locked(true).is_some())
            .for_each(|row| expected.remove(&row.key));
        let differs: Vec<_> = expected
            .iter()
            .filter(|(key, value)| after.get(key) != Some(*value))
            .map(|(key, value)| (key, value, after.get(key)))
            .collect();
        assert!(differs.is_empty(), "{}: {differs:?}", case.key());
        assert!(
            wanted.len() * 2 > table.rows().len(),
            "{}: {} of {}",
            case.key(),
            wanted.len(),
            table.rows().len()
        );

        let profile = Profile {
            subject,
            firmware: unit.version_text.clone(),
            address: unit.unit_address(),
            date: "2026-01-01T00:00:00Z".to_owned(),
            unit: String::new(),
            note: String::new(),
            settings: expected,
        };
        let opened = Profile::read(&profile.to_json(), Strictness::Refuse);
        assert_eq!(opened.map(|opened| opened.profile), Ok(profile), "{}", case.key());
    }
}

/// The raw number beside `raw` that stands for a value that may be written, if there is one.
fn neighbour(
    raw: i64,
    value: impl Fn(i64) -> SettingValue,
    may_be: impl Fn(SettingValue) -> bool,
) -> Option<SettingValue> {
    [raw + 1, raw - 1].into_iter().map(value).find(|value| may_be(*value))
}

#[test]
fn a_unit_of_each_model_that_is_unplugged_is_told_as_lost() {
    for case in cases() {
        let (mut link, _) = case.connected();
        link.events.clear();
        link.apply(0, &WorldAction::Unplug { unplugged: true });
        link.run_for(5 * SECOND);
        let lost = link.events.iter().any(|(_, event)| matches!(event, Event::Lost(_)));
        assert!(lost, "{}: {:?}", case.key(), link.events);
    }
}

#[test]
fn a_unit_that_is_asked_for_at_another_address_is_not_made_up() {
    for case in cases() {
        let names = case.family.driver.family();
        let Some(other) = (0..=u8::MAX).rev().find(|number| names.has_address(*number)) else { continue };
        let started = case.started();
        if started.addresses.contains(&UnitAddress::new(names, other).expect("it has this address")) {
            continue;
        }
        let options = DeviceOptions {
            family: FamilyChoice::of(names),
            addresses: brushwork_link::device::Addresses::Only(other),
            stream: Some(started.stream),
            simulated: true,
            ..DeviceOptions::default()
        };
        let mut link = VirtualLink::to_simulated(started, options);
        link.run_for(10 * SECOND);
        let found = link.events.iter().find_map(|(_, event)| match event {
            Event::Connected(identity) => Some(identity.address),
            _ => None,
        });
        assert!(found.is_none_or(|address| address == other), "{}: {found:?}", case.key());
    }
}
