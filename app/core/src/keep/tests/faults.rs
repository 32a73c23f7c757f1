//! Everything that is kept, on a disk that fails at each call in turn and is cut off behind each, in the manner of SQLite's tests.

use std::sync::Arc;

use brushwork_link::capability::{CapabilityMap, KeepsCapabilities as _};
use brushwork_link::files::{DiskFault, Remains, SimulatedDisk};
use brushwork_link::settings::Journal;

use super::*;
use crate::examine::RawWrite;

const ROOT: &str = "/keep";
const PLACE: &str = "/dev/ttyACM0";

fn store_on(disk: &SimulatedDisk) -> Store {
    Store::on(Arc::new(disk.clone()), ROOT)
}

fn profile(number: i64) -> Profile {
    Profile { unit: unit().place, ..numbered_profile(number) }
}

fn journal(act: Act, number: i64) -> Journal {
    let profile = profile(number);
    Journal { act, before: profile.clone(), wanted: profile }
}

fn raw_write(wanted: i64) -> RawWrite {
    RawWrite {
        date: "2026-01-05".to_owned(),
        key: "key".to_owned(),
        command: 1,
        index: None,
        field: String::new(),
        before: None,
        wanted,
        found: None,
        is_open: false,
    }
}

fn update(before: &str) -> OpenUpdate {
    OpenUpdate {
        place: PLACE.to_owned(),
        model: unit().model,
        before: before.to_owned(),
        file: "new.bin".into(),
        backup: "000001".to_owned(),
    }
}

/// All that is kept of the unit, as whoever starts the program next reads it. Nothing of it may be damaged.
#[derive(Debug, PartialEq, Eq, Clone)]
struct Seen {
    backups: Vec<i64>,
    journals: Vec<(Act, i64)>,
    saves: u64,
    eeprom: Option<i64>,
    raw: Vec<i64>,
    update: Option<String>,
}

fn look(disk: &SimulatedDisk) -> Seen {
    let store = store_on(disk);
    let backups = store.listed_backups(Some(&unit())).unwrap();
    let (journals, faults) = store.open_journals(&unit());
    assert!(faults.is_empty(), "{faults:?}");
    let number = |profile: &Profile| number_of_profile(profile);
    Seen {
        backups: backups.iter().map(|backup| number(&backup.open_on(disk).unwrap().profile)).collect(),
        journals: journals.iter().map(|open| (open.journal.act, number(&open.journal.before))).collect(),
        saves: store.wear(&unit()).unwrap().saves,
        eeprom: store.eeprom(&unit()).unwrap().as_ref().map(number),
        raw: store.raw_writes(&unit()).unwrap().iter().map(|write| write.wanted).collect(),
        update: store.update_at(PLACE).unwrap().map(|update| update.before),
    }
}

/// A unit with a past.
fn disk_with_a_past() -> SimulatedDisk {
    let disk = SimulatedDisk::default();
    let store = store_on(&disk);
    store.back_up(&unit(), Act::Write, &numbered_profile(1)).unwrap();
    store.open_journal(&unit(), &journal(Act::Write, 1)).unwrap();
    store.count_saves(&unit(), 5, "2026-01-05").unwrap();
    store.note_eeprom(&unit(), Some(&profile(1))).unwrap();
    store.note_raw_write(&unit(), raw_write(1)).unwrap();
    store.open_update(&update("v1")).unwrap();
    store.keep("v1", &CapabilityMap::default());
    disk
}

type Operation = (&'static str, Record, fn(&Store) -> Result<(), KeepError>, fn(&mut Seen));

/// Each thing that is kept: its name, what it is, how it is done, and what it changes.
const OPERATIONS: [Operation; 9] = [
    (
        "a backup",
        Record::Backup,
        |store| store.back_up(&unit(), Act::Write, &numbered_profile(2)).map(drop),
        |seen| seen.backups.insert(0, 2),
    ),
    (
        "a journal begun",
        Record::Journal,
        |store| store.open_journal(&unit(), &journal(Act::Save, 2)).map(drop),
        |seen| seen.journals.push((Act::Save, 2)),
    ),
    (
        "a journal ended",
        Record::Journal,
        |store| {
            let (open, faults) = store.open_journals(&unit());
            faults.into_iter().next().map_or(Ok(()), Err)?;
            store.close_journals(&open)
        },
        |seen| seen.journals.clear(),
    ),
    (
        "a save counted",
        Record::Wear,
        |store| store.count_saves(&unit(), 1, "2026-01-06").map(drop),
        |seen| seen.saves += 1,
    ),
    (
        "what EEPROM holds",
        Record::Eeprom,
        |store| store.note_eeprom(&unit(), Some(&profile(2))),
        |seen| seen.eeprom = Some(2),
    ),
    (
        "EEPROM not known any more",
        Record::Eeprom,
        |store| store.note_eeprom(&unit(), None),
        |seen| seen.eeprom = None,
    ),
    (
        "a raw number",
        Record::RawWrites,
        |store| store.note_raw_write(&unit(), raw_write(2)),
        |seen| seen.raw.push(2),
    ),
    (
        "an update begun",
        Record::Update,
        |store| store.open_update(&update("v2")),
        |seen| seen.update = Some("v2".to_owned()),
    ),
    (
        "what a firmware answers",
        Record::Capabilities,
        |store| {
            store.keep("v2", &CapabilityMap::default());
            Ok(())
        },
        |_| {},
    ),
];

/// What a removal does may be undone by a crash: what was closed is told once more.
fn is_removal(name: &str) -> bool {
    ["a journal ended", "EEPROM not known any more"].contains(&name)
}

#[test]
fn each_thing_that_is_kept_is_the_old_or_the_new_one_whatever_fails_at_whichever_call() {
    let mut tried = 0;
    for (name, record, operation, change) in OPERATIONS {
        for fault in DiskFault::ALL {
            for call in 1.. {
                let disk = disk_with_a_past();
                let old = look(&disk);
                let mut new = old.clone();
                change(&mut new);
                disk.fail_at(call, fault);
                let kept = operation(&store_on(&disk));
                if disk.calls() < call {
                    let seen = look(&disk.after_crash(Remains { names: true, halves: 2 }));
                    assert!(kept.is_ok() && seen == new, "{name}");
                    break;
                }
                if let Err(error) = &kept {
                    let told = error.to_string();
                    assert!(told.contains(record.name()), "{name}, {fault:?} at call {call}: {told}");
                    let means = [record.unkept(), record.unread()].iter().any(|means| told.contains(means));
                    assert!(means && told.contains(ROOT), "{name}, {fault:?} at call {call}: {told}");
                }
                for remains in Remains::ALL {
                    let seen = look(&disk.after_crash(remains));
                    let may_be_old = kept.is_err() || is_removal(name);
                    assert!(
                        seen == new || may_be_old && seen == old,
                        "{name}, {fault:?} at call {call}, {remains:?}: {kept:?}\n{seen:?}\nof\n{old:?}\nor\n{new:?}"
                    );
                    tried += 1;
                }
            }
        }
    }
    assert!(tried > 1000, "{tried}");
}

/// A save to EEPROM as the device thread has it kept, with the disk failing at each call from its beginning to its end.
#[test]
fn nothing_is_saved_before_backup_journal_and_count_last_and_an_end_that_is_not_kept_is_told() {
    let (mut refused, mut told) = (0, 0);
    for fault in DiskFault::ALL {
        for call in 1.. {
            let disk = disk_with_a_past();
            let old = look(&disk);
            disk.fail_at(call, fault);
            let keeping = Keeping::new(store_on(&disk));
            let mut keeper = keeping.keeper(unit(), "");
            let image = table().default_image();
            let begun = begin(&mut *keeper, entry(Act::Save, image.clone()));
            if let Err(failure) = &begun {
                let text = failure.to_string();
                let named = [Record::Backup, Record::Journal, Record::Wear, Record::Eeprom]
                    .iter()
                    .any(|record| text.contains(record.name()) && text.contains("BRUSHWORK_DATA_DIR"));
                let read = text.contains("Reading ");
                assert!(named || read, "{fault:?} at call {call}: {text}");
                refused += 1;
                continue;
            }
            // The save goes on only now: whatever happens to the computer, what was there is known.
            for remains in Remains::ALL {
                let seen = look(&disk.after_crash(remains));
                assert_eq!(seen.backups.len(), old.backups.len() + 1, "{fault:?} at call {call}");
                assert!(seen.journals.iter().any(|(act, _)| *act == Act::Save), "{fault:?} at call {call}");
                assert_eq!(seen.saves, old.saves + 1, "{fault:?} at call {call}");
            }
            keeper.end(Ending::EepromKnown(image));
            while !keeper.ended() {}
            let faults = keeping.take_faults();
            let seen = look(&disk.after_crash(Remains { names: true, halves: 2 }));
            let is_open = seen.journals.iter().any(|(act, _)| *act == Act::Save);
            assert_eq!(is_open, !faults.is_empty(), "{fault:?} at call {call}: {faults:?}");
            told += faults.len();
            drop(keeper);
            if disk.calls() < call {
                break;
            }
        }
    }
    assert!(refused > 50 && told > 5, "{refused} {told}");
}
