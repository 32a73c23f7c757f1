//! Power lost and plug pulled at every transaction of a full write and at every row of a save: on the next connection
//! the user is told of each setting whether it is old or new. All in virtual time, so every run is the same.

use std::collections::BTreeSet;
use std::sync::{Arc, Mutex, PoisonError};
use std::time::Duration;

use brushwork_link::exchange::Exchange;
use brushwork_link::settings::{
    Act, Aftermath, Ending, Entry, Journal, Keeper, Kind, Known, Profile, Row, RowState, SettingValue,
    SettingsImage, SettingsTable, WriteOptions, WriteReport, read_all, save_kept, write, write_kept,
    write_kept_knowing, write_watched,
};
use brushwork_link::{Clock, Failure, Message, Stream, Transport, TransportError};
use brushwork_mcp_client::packet::PacketWire;
use brushwork_mcp_sim::controller::{Bus, Controller, ControllerConfig};
use brushwork_mcp_sim::settings::{Image, ROW_BYTES, ROW_WRITE_TIME};
use brushwork_mcp_wire::models;
use brushwork_mcp_wire::packet_serial::{Address, Generation, number};
use brushwork_plant::faults::{Direction, Fault, FaultEffect, Faulty};
use brushwork_plant::machine::{Machine as _, StreamIndex};
use brushwork_plant::world::WorldAction;
use brushwork_tests::virtual_line::VirtualLine;

const OPTIONS: WriteOptions =
    WriteOptions { own_stream: Some(Stream::Usb), simulated: false, as_read: false };
const GENERATION: Generation = Generation::Gen1;
/// In RAM and not in EEPROM when everything begins, and not to be written: a power loss takes it away.
const UNSAVED: (&str, SettingValue) = ("motor1.velocity.p", SettingValue::Number(5.0));

type Line = VirtualLine<Faulty<Bus>>;
/// When each request went out, and which command it was.
type Sent = Arc<Mutex<Vec<(Duration, u8)>>>;

fn table() -> SettingsTable {
    table_of(GENERATION)
}

fn table_of(generation: Generation) -> SettingsTable {
    brushwork::install();
    let model = models::lookup("mcp233").expect("it is listed");
    SettingsTable::new(brushwork_mcp_client::subject(model, generation))
}

/// A unit from the factory, with one setting changed in RAM, and what is to happen to it.
fn line(faults: Vec<Fault>) -> Line {
    line_of(GENERATION, faults)
}

fn line_of(generation: Generation, faults: Vec<Fault>) -> Line {
    let model = models::lookup("mcp233").expect("it is listed");
    let config = ControllerConfig { model, generation, ..ControllerConfig::default() };
    let controller = Controller::new(config).expect("the default world is sound");
    let line =
        VirtualLine::new(Faulty::new(Bus::single(controller, StreamIndex::Usb), faults, 1), StreamIndex::Usb);
    let change = [(UNSAVED.0.to_owned(), UNSAVED.1)].into_iter().collect();
    let mut wire = line.wire(Address::DEFAULT, generation, false);
    write(&mut wire, &table_of(generation), &change, OPTIONS).expect("nothing has happened yet");
    line
}

fn wire(line: &Line) -> PacketWire {
    line.wire(Address::DEFAULT, GENERATION, false)
}

/// A wire that notes when each request goes out, and which command it is.
fn recorded_wire(line: &Line) -> (PacketWire, Sent) {
    let sent = Arc::new(Mutex::new(Vec::new()));
    let recorder = Recorder { line: line.clone(), sent: sent.clone() };
    let exchange = Exchange::new(Box::new(recorder), Arc::new(line.clock().clone()));
    (PacketWire::new(exchange, Address::DEFAULT, GENERATION, false), sent)
}

struct Recorder {
    line: Line,
    sent: Sent,
}

impl Transport for Recorder {
    fn write(&mut self, bytes: &[u8]) -> Result<(), TransportError> {
        let command = bytes.get(1).copied().unwrap_or_default();
        self.sent.lock().unwrap_or_else(PoisonError::into_inner).push((self.line.clock().now(), command));
        self.line.write(bytes)
    }

    fn read(&mut self, buffer: &mut [u8], timeout: Duration) -> Result<usize, TransportError> {
        self.line.read(buffer, timeout)
    }

    fn discard_input(&mut self) -> Result<usize, TransportError> {
        self.line.discard_input()
    }

    fn describe(&self) -> String {
        self.line.describe()
    }

    fn byte_time(&self) -> Option<Duration> {
        self.line.byte_time()
    }
}

/// Keeps the journal as text, as a file would be.
#[derive(Default)]
struct Memory {
    journal: Option<String>,
    ending: Option<Ending>,
    /// What EEPROM held, where a save is to know it.
    eeprom: SettingsImage,
    /// What the unit held, as the backup has it.
    backup: SettingsImage,
}

impl Keeper for Memory {
    fn begin(&mut self, entry: Entry) {
        let profile = |settings| Profile {
            subject: *entry.table.subject(),
            firmware: String::new(),
            address: entry.address,
            date: "2026-01-05T10:00:00Z".to_owned(),
            unit: "the simulated controller".to_owned(),
            note: String::new(),
            settings,
        };
        let before = if entry.act == Act::Save { self.eeprom.clone() } else { entry.ram.clone() };
        let journal =
            Journal { act: entry.act, before: profile(before), wanted: profile(entry.wanted.clone()) };
        self.journal = Some(journal.to_json());
        self.backup = entry.ram;
    }

    fn begun(&mut self) -> Option<Result<(), Failure>> {
        Some(Ok(()))
    }

    fn end(&mut self, ending: Ending) {
        self.ending = Some(ending);
    }
}

impl Memory {
    /// What the user is told at the next connection; none when the act ended with everything known.
    fn reported(&self, now: &SettingsImage) -> Option<Aftermath> {
        match &self.ending {
            Some(Ending::Open) | None => {
                let journal = Journal::parse(self.journal.as_ref()?).expect("it is as it was written");
                Some(journal.aftermath(&table(), now))
            }
            Some(_) => None,
        }
    }
}

/// Every setting that this program can change over a wire without cutting its own line, with another value.
fn everything_changed() -> SettingsImage {
    everything_changed_in(&table())
}

fn everything_changed_in(table: &SettingsTable) -> SettingsImage {
    let ours = |row: &&Row| {
        row.locked(false).is_none()
            && row.has_wire_form()
            && !matches!(row.key.as_str(), "stream.usb.type" | "unit.address")
            && row.key != UNSAVED.0
    };
    table.rows().iter().filter(ours).map(|row| (row.key.clone(), another_value(row))).collect()
}

fn another_value(row: &Row) -> SettingValue {
    match row.kind {
        Kind::Bool => SettingValue::Bool(row.default != SettingValue::Bool(true)),
        Kind::Choice(codes) if row.pattern == "pin.{n}.type" => SettingValue::Choice(codes[0].key),
        Kind::Choice(codes) => {
            let other = codes.iter().rev().find(|code| row.default != SettingValue::Choice(code.key));
            SettingValue::Choice(other.expect("a list has more than one value").key)
        }
        Kind::Int | Kind::Fixed { .. } => {
            let share = if row.key.contains("min") { 0.25 } else { 0.75 };
            let number = row.range.min + (row.range.max - row.range.min) * share;
            match row.kind {
                Kind::Int => SettingValue::Int(number as i64),
                _ => row.settle(SettingValue::Number(number)),
            }
        }
    }
}

fn at(from: Duration, until: Option<Duration>, action: WorldAction) -> Fault {
    Fault { effect: FaultEffect::World(vec![action]), direction: Direction::default(), unit: 0, from, until }
}

fn power_loss(from: Duration) -> Fault {
    at(from, None, WorldAction::Power { on: false })
}

fn pulled_plug(from: Duration) -> Fault {
    at(from, None, WorldAction::Unplug { unplugged: true })
}

/// Power and plug are back, if they were away; a new connection reads everything.
fn next_connection(line: &Line) -> SettingsImage {
    next_connection_of(line, GENERATION)
}

fn next_connection_of(line: &Line, generation: Generation) -> SettingsImage {
    // What was to happen has happened.
    line.pass(Duration::from_millis(100));
    line.with(|machine| {
        if machine.plugged() && machine.inner_mut().views()[0].powered {
            return;
        }
        for action in [WorldAction::Unplug { unplugged: false }, WorldAction::Power { on: true }] {
            machine.inner_mut().controllers_mut()[0].apply(&action).expect("it has a plug and a switch");
        }
    });
    line.pass(Duration::from_secs(3));
    let mut wire = line.wire(Address::DEFAULT, generation, false);
    read_all(&mut wire, *table_of(generation).subject()).expect("it answers again").image
}

/// When each request of a full write goes out.
fn write_times() -> Vec<Duration> {
    let line = line(Vec::new());
    let (mut wire, sent) = recorded_wire(&line);
    let report = write_kept(&mut wire, &table(), &everything_changed(), OPTIONS, &mut Memory::default());
    assert!(report.expect("nothing disturbs it").is_complete());
    let sent = sent.lock().expect("nobody panicked");
    sent.iter().map(|(at, _)| *at).collect()
}

/// The moments around each request: as it goes out, and while its reply is awaited.
fn moments(times: &[Duration]) -> Vec<Duration> {
    let ends = times
        .iter()
        .skip(1)
        .copied()
        .chain([*times.last().expect("there are some") + Duration::from_millis(1)]);
    times.iter().zip(ends).flat_map(|(&start, end)| [start, start + (end - start) / 2]).collect()
}

struct Cut {
    before: SettingsImage,
    result: Option<WriteReport>,
    reported: Option<Aftermath>,
    now: SettingsImage,
}

fn cut_write(fault: Fault) -> Cut {
    let line = line(vec![fault]);
    let before = expected_before();
    let mut keeper = Memory::default();
    let result = write_kept(&mut wire(&line), &table(), &everything_changed(), OPTIONS, &mut keeper).ok();
    let now = next_connection(&line);
    let reported = keeper.journal.as_ref().and_then(|_| keeper.reported(&now));
    Cut { before, result, reported, now }
}

/// What the controller works with when a write begins.
fn expected_before() -> SettingsImage {
    let mut before: SettingsImage = table()
        .rows()
        .iter()
        .filter(|row| row.has_wire_form())
        .map(|row| (row.key.clone(), row.default))
        .collect();
    before.set(UNSAVED.0, UNSAVED.1);
    before
}

/// Compares what is told with what is; says whether the controller holds a mix.
fn check(cut: &Cut, wanted: &SettingsImage, what: &str) -> bool {
    let changed: SettingsImage = wanted
        .iter()
        .filter(|(key, value)| cut.before.get(key) != Some(*value))
        .map(|(key, value)| (key.to_owned(), value))
        .collect();
    let keys = |holds: &dyn Fn(&str, SettingValue) -> bool| -> BTreeSet<String> {
        changed.iter().filter(|(key, value)| holds(key, *value)).map(|(key, _)| key.to_owned()).collect()
    };
    let new = keys(&|key, value| cut.now.get(key) == Some(value));
    let old = keys(&|key, _| cut.now.get(key) == cut.before.get(key));
    let Some(reported) = &cut.reported else {
        // The write never began, or was over: then the report is what the user was told.
        match &cut.result {
            None => assert!(new.is_empty(), "{what}: nothing was told and {new:?} are new"),
            Some(report) => {
                assert!(report.is_complete(), "{what}: {:?}", report.sentences(&table()));
            }
        }
        return false;
    };
    let named = |list: &[brushwork_link::settings::Held]| -> BTreeSet<String> {
        list.iter().map(|held| held.key.clone()).collect()
    };
    assert_eq!(named(&reported.new), new, "{what}: new");
    assert_eq!(named(&reported.old), old, "{what}: old");
    let torn = keys(&|key, value| cut.now.get(key) != Some(value) && cut.now.get(key) != cut.before.get(key));
    assert_eq!(named(&reported.other), torn, "{what}: neither old nor new");
    let disturbed: BTreeSet<String> = cut
        .before
        .iter()
        .filter(|(key, value)| changed.get(key).is_none() && cut.now.get(key) != Some(*value))
        .map(|(key, _)| key.to_owned())
        .collect();
    assert_eq!(named(&reported.disturbed), disturbed, "{what}: disturbed");
    let sentences = reported.sentences(&table());
    assert_eq!(sentences.len(), changed.len() + disturbed.len(), "{what}: a sentence each");
    !new.is_empty() && !old.is_empty()
}

#[test]
fn a_plug_pulled_at_any_transaction_of_a_full_write_leaves_nothing_untold() {
    let moments = moments(&write_times());
    let mut mixes = 0;
    for at in &moments {
        let cut = cut_write(pulled_plug(*at));
        mixes += usize::from(check(&cut, &everything_changed(), &format!("unplugged at {at:?}")));
    }
    println!("{} moments, {mixes} mixes", moments.len());
    assert!(mixes > 40, "a cut really leaves a mix: {mixes} of {}", moments.len());
}

#[test]
fn power_lost_at_any_transaction_of_a_full_write_leaves_nothing_untold() {
    let moments = moments(&write_times());
    let (mut reported, mut disturbed) = (0, 0);
    for at in &moments {
        let cut = cut_write(power_loss(*at));
        if let Some(aftermath) = &cut.reported {
            reported += 1;
            disturbed += usize::from(aftermath.disturbed.iter().any(|held| held.key == UNSAVED.0));
        }
        // RAM is gone: everything is as EEPROM has it, which is told, or the write was over before.
        let over = cut.reported.is_none() && cut.result.as_ref().is_some_and(WriteReport::is_complete);
        assert!(!check(&cut, &everything_changed(), &format!("power lost at {at:?}")) || over, "{at:?}");
    }
    println!("{} moments, {reported} told, {disturbed} with the unsaved setting", moments.len());
    assert_eq!(reported, disturbed, "what was not saved is lost too, and told each time");
    assert!(reported > 80, "{reported}");
}

/// A glitch that is over before the write gives up: the write goes on with a unit that has forgotten things.
#[test]
fn a_short_power_loss_within_a_write_is_told_by_the_write_itself() {
    let times = write_times();
    let mut incomplete = 0;
    for at in times.iter().step_by(3) {
        let what = format!("glitch at {at:?}");
        let cut = cut_write(glitch(*at));
        let Some(report) = &cut.result else { continue };
        for row in report.rows.iter().filter(|row| row.state == RowState::Taken) {
            assert_eq!(cut.now.get(&row.key), Some(row.wanted), "{what}: {row:?}");
        }
        let wanted = everything_changed();
        let lost = cut.now.get(UNSAVED.0) != Some(UNSAVED.1);
        assert!(wanted.get(UNSAVED.0).is_none());
        if report.is_complete() {
            continue;
        }
        incomplete += 1;
        let told_by_report = report.warnings.iter().any(|warning| warning.to_string().contains("velocity P"));
        let told_later = cut
            .reported
            .as_ref()
            .is_some_and(|reported| reported.disturbed.iter().any(|held| held.key == UNSAVED.0));
        assert!(!lost || told_by_report || told_later, "{what}: {:?}", report.warnings);
    }
    println!("{incomplete} of {} did not go through", times.len().div_ceil(3));
    assert!(incomplete > 0);
}

/// Power fails for 20 ms at a thousand moments between the beginning and the end of a write of a few settings, as an import is, on every generation.
/// Whatever comes of it, nobody is told that all is well when it is not, whichever of the ways the write goes.
#[test]
fn of_a_thousand_glitches_within_a_write_none_is_silent() {
    let (mut told, mut unharmed) = (0, 0);
    for generation in Generation::ALL {
        let table = table_of(generation);
        let wanted: SettingsImage = everything_changed_in(&table)
            .iter()
            .step_by(9)
            // Nothing that reads back what only RAM holds.
            .filter(|(key, _)| !key.starts_with("motor1.velocity."))
            .map(|(key, value)| (key.to_owned(), value))
            .collect();
        let moments = Way::ALL.into_iter().flat_map(|way| {
            let (begun, ended, undisturbed, ..) = glitched(generation, way, &wanted, None);
            // What is said of these settings whatever happens tells nothing of a restart.
            let usual = undisturbed.expect("nothing happens").warnings;
            (0..84).map(move |part| (way, begun + (ended - begun) * (2 * part + 1) / 168, usual.clone()))
        });
        for (way, at, usual) in moments {
            let (_, _, report, before, now) = glitched(generation, way, &wanted, Some(glitch(at)));
            let Ok(report) = report else {
                told += 1;
                continue;
            };
            let is_new = |warning: &Message| !usual.contains(warning);
            let is_told =
                !report.is_complete() || report.warnings.iter().any(is_new) || report.ended_early.is_some();
            let is_as_wanted =
                before.iter().all(|(key, value)| now.get(key) == Some(wanted.get(key).unwrap_or(value)));
            assert!(
                is_told || is_as_wanted,
                "{generation}, {way:?}, glitch at {at:?}: {:?}",
                report.sentences(&table)
            );
            told += usize::from(is_told);
            unharmed += usize::from(is_as_wanted);
        }
    }
    println!("1008 glitches: {told} told, {unharmed} without harm");
    assert!(told > 800, "a glitch harms as a rule: {told}");
}

/// The ways by which command line and window write settings.
#[derive(Clone, Copy, Debug)]
enum Way {
    /// All that is written at once: `settings write` and `import`, the window's write sheet.
    Import,
    /// One of a series of small writes, as the window's driving screens apply them: only the first has read everything.
    Series,
    /// Within a backup and a journal of somebody's own: the window's calibration of an input, an examination.
    Calibration,
}

impl Way {
    const ALL: [Self; 3] = [Self::Import, Self::Series, Self::Calibration];
}

/// Writes some settings to a unit to which something happens: when that began and ended, what came of it, what the unit held before and what it holds
/// in the end.
fn glitched(
    generation: Generation,
    way: Way,
    wanted: &SettingsImage,
    fault: Option<Fault>,
) -> (Duration, Duration, Result<WriteReport, String>, SettingsImage, SettingsImage) {
    let table = table_of(generation);
    let line = line_of(generation, fault.into_iter().collect());
    let wire = || line.wire(Address::DEFAULT, generation, false);
    let mut before: SettingsImage = table
        .rows()
        .iter()
        .filter(|row| row.has_wire_form())
        .map(|row| (row.key.clone(), row.default))
        .collect();
    before.set(UNSAVED.0, UNSAVED.1);
    let (mut keeper, mut known) = (Memory::default(), Known::default());
    let held = match way {
        Way::Import => SettingsImage::default(),
        Way::Series => {
            let nothing_new = SettingsImage::from_iter([(UNSAVED.0.to_owned(), UNSAVED.1)]);
            write_kept_knowing(&mut wire(), &table, &nothing_new, OPTIONS, &mut keeper, &mut known)
                .expect("nothing happens yet");
            SettingsImage::default()
        }
        Way::Calibration => read_all(&mut wire(), *table.subject()).expect("nothing happens yet").image,
    };
    let begun = line.clock().now();
    let report = match way {
        Way::Import => {
            let report = write_kept(&mut wire(), &table, wanted, OPTIONS, &mut keeper);
            // What was lost before the backup read it is in neither: of that nobody knows.
            before.merge(&keeper.backup);
            report
        }
        Way::Series => write_kept_knowing(&mut wire(), &table, wanted, OPTIONS, &mut keeper, &mut known),
        Way::Calibration => write_watched(&mut wire(), &table, wanted, OPTIONS, &held),
    };
    let ended = line.clock().now();
    let now = next_connection_of(&line, generation);
    (begun, ended, report.map_err(|error| error.to_string()), before, now)
}

fn glitch(from: Duration) -> Fault {
    at(from, Some(from + Duration::from_millis(20)), WorldAction::Power { on: false })
}

/// When the save command goes out, and how many rows the EEPROM has.
fn save_time() -> (Duration, u32) {
    let line = prepared_for_save(Vec::new());
    let (mut wire, sent) = recorded_wire(&line);
    let report =
        save_kept(&mut wire, &table(), OPTIONS, &mut Memory::default()).expect("nothing disturbs it");
    assert!(report.differences.is_empty(), "{}", report.sentence());
    let sent = sent.lock().expect("nobody panicked");
    let (at, _) = sent.iter().find(|(_, command)| *command == number::SAVE_SETTINGS).expect("it was sent");
    let bytes =
        line.with(|machine| Image::of(&machine.inner_mut().controllers()[0].stored_settings()).0.len());
    (*at, u32::try_from(bytes.div_ceil(ROW_BYTES)).expect("a small memory"))
}

/// Everything is changed in RAM, and nothing of it is saved.
fn prepared_for_save(faults: Vec<Fault>) -> Line {
    let line = line(faults);
    let report = write(&mut wire(&line), &table(), &everything_changed(), OPTIONS).expect("it answers");
    assert!(report.is_complete(), "{:?}", report.sentences(&table()));
    line
}

#[test]
fn power_lost_at_any_row_of_a_save_is_told_setting_by_setting() {
    let (saved_at, rows) = save_time();
    let mut eeprom = expected_before();
    eeprom.set(UNSAVED.0, table().row(UNSAVED.0).expect("a row").default);
    let (mut mixes, mut torn) = (0, 0);
    let mut seen_new = BTreeSet::new();
    for row in 0..=rows {
        let at = saved_at + ROW_WRITE_TIME * row + ROW_WRITE_TIME / 2;
        let line = prepared_for_save(vec![power_loss(at)]);
        let wanted = read_all(&mut wire(&line), *table().subject()).expect("it answers").image;
        let mut keeper = Memory { eeprom: eeprom.clone(), ..Memory::default() };
        let result = save_kept(&mut wire(&line), &table(), OPTIONS, &mut keeper);
        let now = next_connection(&line);
        let reported = keeper.reported(&now);
        assert!(reported.is_some(), "row {row}: {:?}", result.map(|report| report.sentence()));
        let cut = Cut { before: eeprom.clone(), result: None, reported, now };
        mixes += usize::from(check(&cut, &wanted, &format!("power lost at row {row} of {rows}")));
        let reported = cut.reported.as_ref();
        // A number that lies across two rows comes out as neither the old nor the new one.
        torn += reported.map_or(0, |reported| reported.other.len());
        seen_new.insert(reported.map_or(0, |reported| reported.new.len()));
    }
    println!("{rows} rows, {mixes} mixes, {} different ones, {torn} torn numbers", seen_new.len());
    assert!(torn > 0);
    assert!(mixes > rows as usize / 2, "a cut really leaves a mix: {mixes} of {rows} rows");
    assert!(seen_new.len() > rows as usize / 2, "rows differ: {seen_new:?}");
}

#[test]
fn without_knowing_what_eeprom_held_the_old_settings_are_named_all_the_same() {
    let (saved_at, rows) = save_time();
    let line = prepared_for_save(vec![power_loss(saved_at + ROW_WRITE_TIME * (rows / 2))]);
    let wanted = read_all(&mut wire(&line), *table().subject()).expect("it answers").image;
    let mut keeper = Memory::default();
    let _ = save_kept(&mut wire(&line), &table(), OPTIONS, &mut keeper);
    let now = next_connection(&line);
    let reported = keeper.reported(&now).expect("the save was cut");
    let old: BTreeSet<&str> = reported.old.iter().map(|held| held.key.as_str()).collect();
    let truth: BTreeSet<&str> =
        wanted.iter().filter(|(key, value)| now.get(key) != Some(*value)).map(|(key, _)| key).collect();
    assert!(!truth.is_empty());
    assert_eq!(old, truth);
}

#[test]
fn a_plug_pulled_within_a_save_leaves_the_question_of_eeprom_open_and_says_so() {
    let (saved_at, rows) = save_time();
    for row in (0..=rows).step_by(4) {
        let line = prepared_for_save(vec![pulled_plug(saved_at + ROW_WRITE_TIME * row + ROW_WRITE_TIME / 2)]);
        let mut keeper = Memory::default();
        let _ = save_kept(&mut wire(&line), &table(), OPTIONS, &mut keeper);
        let now = next_connection(&line);
        let reported = keeper.reported(&now).expect("the save was cut");
        assert!(reported.is_all_new(), "row {row}: {reported:?}");
        assert!(reported.headline().to_string().contains("save again to be sure"), "{}", reported.headline());
    }
}
