//! The store as a whole: what an act leaves behind, and what happens when nothing can be kept.

use brushwork_mcp_client::{MCP, McpDriver, subject};
use std::fs;
use std::path::Path;

use brushwork_link::settings::{Act, Ending, Entry};
use brushwork_link::{Keeper, Profile, SettingValue, SettingsImage, SettingsTable, UnitAddress};
use brushwork_mcp_wire::models;
use brushwork_mcp_wire::packet_serial::Generation;

use super::*;

mod faults;

fn table() -> SettingsTable {
    brushwork_link::install(&[&McpDriver]);
    SettingsTable::new(subject(models::lookup("mcp266").expect("it is listed"), Generation::Gen1))
}

fn unit() -> UnitId {
    UnitId {
        model: "mcp266".to_owned(),
        place: "/dev/ttyACM0".to_owned(),
        has_serial_number: false,
        address: 0x80,
        is_simulated: false,
    }
}

fn entry(act: Act, wanted: SettingsImage) -> Entry {
    let table = table();
    Entry { act, ram: table.default_image(), table, address: UnitAddress::factory(MCP), wanted }
}

fn one(key: &str, value: SettingValue) -> SettingsImage {
    [(key.to_owned(), value)].into_iter().collect()
}

/// Waits as the device thread does.
fn begin(keeper: &mut dyn Keeper, entry: Entry) -> Result<(), brushwork_link::Failure> {
    keeper.begin(entry);
    (0..1000).find_map(|_| keeper.begun()).expect("a disk answers within ten seconds")
}

#[test]
fn a_write_leaves_a_backup_and_its_journal_is_open_until_it_ends() {
    let folder = tempfile::tempdir().unwrap();
    let keeping = Keeping::new(Store::at(folder.path()));
    let mut keeper = keeping.keeper(unit(), "MCP266 2x60A v1.0.0\n");
    let wanted = one("unit.mixing", SettingValue::Bool(true));
    begin(&mut *keeper, entry(Act::Write, wanted)).unwrap();
    let store = keeping.store().clone();
    let (journals, faults) = store.open_journals(&unit());
    assert_eq!((journals.len(), faults.len()), (1, 0));
    let aftermath = &aftermaths(&journals, &table(), &table().default_image())[0];
    assert_eq!((aftermath.old.len(), aftermath.new.len()), (1, 0), "{aftermath:?}");

    keeper.end(Ending::Known);
    drop((keeper, keeping));
    assert!(store.open_journals(&unit()).0.is_empty());
    let backups = store.backups(Some(&unit()));
    assert_eq!(backups.len(), 1);
    assert!(backups[0].name.ends_with("-before-write"), "{}", backups[0].name);
    let profile = backups[0].open().unwrap().profile;
    assert_eq!(profile.settings, table().default_image());
    assert_eq!((profile.note.as_str(), profile.unit.as_str()), ("before write", "/dev/ttyACM0"));
}

#[test]
fn a_save_is_counted_and_what_eeprom_holds_is_known_only_once_it_is_proven() {
    let folder = tempfile::tempdir().unwrap();
    let store = Store::at(folder.path());
    let image = table().default_image();
    for (ending, saves, is_known) in [
        (Ending::EepromKnown(image.clone()), 1, true),
        (Ending::Open, 2, false),
        (Ending::EepromKnown(image.clone()), 3, true),
        (Ending::NotDone, 3, true),
        (Ending::Known, 4, false),
    ] {
        let keeping = Keeping::new(store.clone());
        let mut keeper = keeping.keeper(unit(), "");
        begin(&mut *keeper, entry(Act::Save, image.clone())).unwrap();
        keeper.end(ending.clone());
        drop((keeper, keeping));
        assert_eq!(store.wear(&unit()).unwrap().saves, saves, "{ending:?}");
        assert_eq!(store.eeprom(&unit()).unwrap().is_some(), is_known, "{ending:?}");
    }
    assert_eq!(store.open_journals(&unit()).0.len(), 1, "the one that was left open");
}

#[test]
fn a_journal_is_found_under_the_new_address_and_not_by_another_unit() {
    let folder = tempfile::tempdir().unwrap();
    let keeping = Keeping::new(Store::at(folder.path()));
    let mut keeper = keeping.keeper(unit(), "");
    begin(&mut *keeper, entry(Act::Write, one("unit.address", SettingValue::Int(0x83)))).unwrap();
    let open = |unit: &UnitId| keeping.store().open_journals(unit).0.len();
    assert_eq!(open(&unit()), 1);
    assert_eq!(open(&UnitId { address: 0x83, ..unit() }), 1);
    assert_eq!(open(&UnitId { address: 0x84, ..unit() }), 0);
    assert_eq!(open(&UnitId { place: "/dev/ttyACM1".to_owned(), ..unit() }), 0);
    assert_eq!(open(&UnitId { model: "mcp233".to_owned(), ..unit() }), 0);
}

#[test]
fn nothing_is_begun_when_nothing_can_be_kept_and_the_sentence_says_what_to_do() {
    let folder = tempfile::tempdir().unwrap();
    let in_the_way = folder.path().join("file");
    fs::write(&in_the_way, "a file where a folder should be").unwrap();
    let keeping = Keeping::new(Store::at(&in_the_way));
    let mut keeper = keeping.keeper(unit(), "");
    let failure = begin(&mut *keeper, entry(Act::Write, SettingsImage::default())).unwrap_err().to_string();
    assert!(failure.contains("keep a backup before the write"), "{failure}");
    assert!(failure.contains("BRUSHWORK_DATA_DIR"), "{failure}");
    assert_eq!(fs::read_to_string(&in_the_way).unwrap(), "a file where a folder should be");
}

#[test]
fn a_damaged_journal_is_told_and_hides_no_other() {
    let folder = tempfile::tempdir().unwrap();
    let store = Store::at(folder.path());
    let keeping = Keeping::new(store.clone());
    let mut keeper = keeping.keeper(unit(), "");
    begin(&mut *keeper, entry(Act::Write, SettingsImage::default())).unwrap();
    let path = store.open_journals(&unit()).0[0].path.clone();
    let half = fs::read_to_string(&path).unwrap();
    let copy = path.with_file_name(format!("2000-{}", path.file_name().unwrap().to_string_lossy()));
    fs::write(&copy, &half[..half.len() / 2]).unwrap();
    let (journals, faults) = store.open_journals(&unit());
    assert_eq!((journals.len(), faults.len()), (1, 1));
    assert!(faults[0].to_string().contains("damaged"), "{}", faults[0]);
}

#[test]
fn every_backup_can_be_opened_and_they_are_listed_newest_first() {
    let folder = tempfile::tempdir().unwrap();
    let store = Store::at(folder.path());
    for number in 0..60 {
        store.back_up(&unit(), Act::Defaults, &numbered_profile(number)).unwrap();
    }
    let backups = store.backups(None);
    assert!((40..=41).contains(&backups.len()), "bounded: {}", backups.len());
    assert_eq!(number_of(&backups[0]), 59);
    assert!(backups.iter().all(|backup| backup.open().is_ok() && Path::exists(&backup.path)));
}

/// A clock that starts at the epoch with each start of the computer, as on a board without a battery for it.
const CLOCK_BEHIND: std::time::SystemTime = std::time::SystemTime::UNIX_EPOCH;

fn numbered_profile(number: i64) -> Profile {
    Profile {
        subject: *table().subject(),
        firmware: String::new(),
        address: UnitAddress::factory(MCP),
        date: today(),
        unit: String::new(),
        note: String::new(),
        settings: one("motor1.velocity.qpps", SettingValue::Int(number)),
    }
}

fn number_of(backup: &Backup) -> i64 {
    number_of_profile(&backup.open().unwrap().profile)
}

/// 0 where there is none.
fn number_of_profile(profile: &Profile) -> i64 {
    match profile.settings.get("motor1.velocity.qpps") {
        Some(SettingValue::Int(number)) => number,
        None => 0,
        other => panic!("{other:?}"),
    }
}

#[test]
fn with_the_clock_behind_a_new_backup_is_kept_and_is_the_newest() {
    let folder = tempfile::tempdir().unwrap();
    let store = Store::at(folder.path());
    let ours = folder.path().join("backups").join(unit().file_name());
    fs::create_dir_all(&ours).unwrap();
    // What version 0.1 left, more than is kept, with the clock right.
    for number in 0..120 {
        let name =
            format!("2026-{:02}-{:02}T10-00-00.000Z-before-write.json", 1 + number / 28, 1 + number % 28);
        fs::write(ours.join(name), numbered_profile(number).to_json()).unwrap();
    }
    assert_eq!(number_of(&store.backups(Some(&unit()))[0]), 119, "old names sort by their date");
    for number in 1000..1100 {
        let made = store.back_up_at(CLOCK_BEHIND, &unit(), Act::Write, &numbered_profile(number)).unwrap();
        assert!(made.path.exists(), "{}", made.name);
        let listed = store.backups(Some(&unit()));
        assert_eq!((&listed[0], number_of(&listed[0])), (&made, number));
        assert!(listed.len() <= 101, "bounded: {}", listed.len());
    }
    // The clock is set at last, and the newest was deleted by hand.
    fs::remove_file(&store.backups(None)[0].path).unwrap();
    let made = store.back_up(&unit(), Act::Write, &numbered_profile(2000)).unwrap();
    let order: Vec<i64> = store.backups(Some(&unit())).iter().take(3).map(number_of).collect();
    assert_eq!(order, [2000, 1098, 1097], "{}", made.name);
}

#[test]
fn programs_that_make_backups_at_once_get_a_number_each() {
    let folder = tempfile::tempdir().unwrap();
    std::thread::scope(|scope| {
        for program in 0..4 {
            // Each has a store of its own, as another program has.
            let store = Store::at(folder.path());
            scope.spawn(move || {
                for _ in 0..8 {
                    let made =
                        store.back_up_at(CLOCK_BEHIND, &unit(), Act::Write, &numbered_profile(program));
                    made.unwrap();
                }
            });
        }
    });
    let mut numbers: Vec<String> =
        Store::at(folder.path()).backups(None).iter().map(|backup| backup.name[..6].to_owned()).collect();
    numbers.sort();
    let expected: Vec<String> = (1..=32).map(|number| format!("{number:06}")).collect();
    assert_eq!(numbers, expected);
}

#[test]
fn the_newest_journal_is_the_one_begun_last_whatever_the_clock_shows() {
    let folder = tempfile::tempdir().unwrap();
    let keeping = Keeping::new(Store::at(folder.path()));
    let mut keeper = keeping.keeper(unit(), "");
    begin(&mut *keeper, entry(Act::Write, SettingsImage::default())).unwrap();
    let store = keeping.store().clone();
    let first = store.open_journals(&unit()).0[0].path.clone();
    // As version 0.1 names it, with a clock that was ahead.
    fs::rename(&first, first.with_file_name(format!("2099-01-01T00-00-00.000Z-{}.json", unit().file_name())))
        .unwrap();
    begin(&mut *keeper, entry(Act::Trial, SettingsImage::default())).unwrap();
    let (journals, faults) = store.open_journals(&unit());
    assert_eq!((journals.len(), faults.len()), (2, 0));
    assert_eq!(journals[1].journal.act, Act::Trial);
}

#[test]
fn damaged_files_of_a_unit_are_named_and_never_count_as_nothing() {
    let folder = tempfile::tempdir().unwrap();
    let store = Store::at(folder.path());
    let name = format!("{}.json", unit().file_name());
    for kind in ["wear", "eeprom", "raw"] {
        fs::create_dir_all(folder.path().join(kind)).unwrap();
    }
    for text in [&b""[..], b"{", b"\0\0\0\0", b"[1]", b"\xFF\xFE"] {
        for kind in ["wear", "eeprom", "raw"] {
            fs::write(folder.path().join(kind).join(&name), text).unwrap();
        }
        let wear = store.wear(&unit()).unwrap_err().to_string();
        assert!(wear.contains("is damaged") && wear.contains("the next save begins a new count"), "{wear}");
        assert!(store.eeprom(&unit()).unwrap_err().to_string().contains("counts as not known"));
        assert!(store.raw_writes(&unit()).unwrap_err().to_string().contains("written raw"));
    }
    let wear = store.count_saves(&unit(), 1, "2026-01-05").unwrap();
    assert_eq!((wear.saves, wear.earlier_lost, wear.level()), (1, true, WearLevel::Half));
    assert_eq!(store.wear(&unit()).unwrap(), wear);
    assert!(
        folder.path().join("wear").join(format!("{name}.damaged")).exists(),
        "it is there to be looked at"
    );
}

#[test]
fn a_damaged_journal_is_told_until_it_is_put_aside() {
    let folder = tempfile::tempdir().unwrap();
    let store = Store::at(folder.path());
    fs::create_dir_all(folder.path().join("journals")).unwrap();
    fs::write(folder.path().join("journals").join(format!("000007-{}.json", unit().file_name())), "")
        .unwrap();
    let (journals, faults) = store.open_journals(&unit());
    assert_eq!((journals.len(), faults.len()), (0, 1));
    let told = faults[0].to_string();
    assert!(told.contains("the journal") && told.contains("may have been cut short"), "{told}");
    store.put_damaged_journals_aside(&faults).unwrap();
    assert_eq!(store.open_journals(&unit()).1.len(), 0);
}

#[test]
fn a_folder_that_cannot_be_listed_is_told_and_not_taken_for_empty() {
    let folder = tempfile::tempdir().unwrap();
    for kind in ["journals", "backups"] {
        fs::write(folder.path().join(kind), "a file where a folder should be").unwrap();
    }
    let store = Store::at(folder.path());
    assert_eq!(store.open_journals(&unit()).1.len(), 1);
    assert!(store.listed_backups(None).unwrap_err().to_string().contains("backup"));
    assert!(store.back_up(&unit(), Act::Write, &numbered_profile(1)).is_err());
}
