//! What becomes of every setting on every other model and generation: the same, another form of it, or a sentence that says what changes.
//!
//! `fixtures/upgrade-matrix.txt` shows it; write it anew with `BRUSHWORK_UPDATE=1`, and read the difference.

use std::fmt::Write as _;
use std::path::Path;

use brushwork_mcp_wire::packet_serial::Generation;

use crate::tests::settings::table;
use brushwork_link::settings::{Access, Group, Kind, Profile, Row, SettingValue, SettingsTable, diff};
use brushwork_link::unit::UnitAddress;

/// One of each product line and rating: both voltages of small boards, the most current, a board that nobody lists.
const MODELS: [&str; 6] = ["mcp233", "mcp266", "mcp2163", "mcp2206", "mcp", "roboclaw-2x7a"];

/// One setting that is two on another generation.
const DIVIDED: [(&str, [&str; 2]); 5] = [
    ("motor1.default_accel", ["motor1.default_accel", "motor1.default_decel"]),
    ("motor2.default_accel", ["motor2.default_accel", "motor2.default_decel"]),
    ("unit.pwm_mode", ["motor1.pwm_mode", "motor2.pwm_mode"]),
    ("roboclaw.deadband.reverse", ["roboclaw.s1.reverse_deadband", "roboclaw.s2.reverse_deadband"]),
    ("roboclaw.deadband.forward", ["roboclaw.s1.forward_deadband", "roboclaw.s2.forward_deadband"]),
];

/// Settings that move, stop and limit nothing by themselves, so that without a place their own value is all there is to tell.
const QUIET: [&str; 28] = [
    // How the unit is reached.
    "unit.address",
    "stream.{n}.type",
    "stream.{n}.rate",
    "stream.{n}.multi_unit",
    "can.rate",
    "can.node_id",
    "i2c.rate",
    "roboclaw.config.baud",
    "roboclaw.config.address",
    "roboclaw.config.slave_select",
    "roboclaw.config.open_drain",
    // What an input measures, which acts by its target and its actions alone.
    "pin.{n}.type",
    "pin.{n}.digital",
    "pin.{n}.mode",
    "pin.{n}.timeout",
    "pin.{n}.load_home",
    "pin.{n}.min",
    "pin.{n}.center",
    "pin.{n}.max",
    "pin.{n}.low_pass",
    "pin.{n}.deadband",
    "pin.{n}.power_exp",
    "pin.{n}.power_min",
    "pin.{n}.min_output",
    "pin.{n}.max_output",
    // What it does is not published.
    "pin.{n}.potentiometer",
    "roboclaw.config.bit_11",
    "roboclaw.config.bit_14",
];

/// What became of a setting.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum Outcome {
    /// The same value at the same key, and nothing is said.
    Same,
    /// Its meaning stands at other keys, or in another number, which is told where it changes anything.
    Converted,
    /// A sentence names it with its value, and says what follows if it can move, stop or limit anything.
    Told,
}

/// Which values a profile holds in a test.
#[derive(Clone, Copy)]
enum Probe {
    /// In every range, and not the default.
    Small,
    /// The end of the range, or the last choice.
    End,
}

impl Probe {
    fn value(self, row: &Row) -> SettingValue {
        match (row.kind, row.default) {
            (Kind::Bool, default) => SettingValue::Bool(default == SettingValue::Bool(false)),
            (Kind::Choice(codes), default) => {
                let mut others = codes.iter().map(|code| SettingValue::Choice(code.key));
                let other = match self {
                    Self::Small => others.find(|value| *value != default),
                    Self::End => others.rfind(|value| *value != default),
                };
                other.unwrap_or(default)
            }
            (Kind::Int | Kind::Fixed { .. }, default) => {
                let near = if row.range.max > 0.0 { row.range.min.max(0.0) } else { row.range.max };
                let other_end = if row.range.max > 0.0 { row.range.max } else { row.range.min };
                let step = row.coding.to_physical(1).abs();
                let far = near + step * 3.0 * (other_end - near).signum();
                let of = |number: f64| match row.kind {
                    Kind::Int => SettingValue::Int(number as i64),
                    Kind::Bool | Kind::Fixed { .. } | Kind::Choice(_) => {
                        row.settle(SettingValue::Number(number))
                    }
                };
                let candidates = match self {
                    Self::Small => [far, near, other_end],
                    Self::End => [other_end, far, near],
                };
                let allowed = candidates.into_iter().map(of).filter(|value| row.check(*value).is_ok());
                allowed.into_iter().find(|value| *value != default).unwrap_or(default)
            }
        }
    }
}

fn profile(from: &SettingsTable, probe: Probe) -> Profile {
    let reported = String::new;
    let held = from.rows().iter().filter(|row| row.key != "unit.address");
    Profile {
        subject: *from.subject(),
        firmware: reported(),
        address: UnitAddress::factory(from.subject().family()),
        date: reported(),
        unit: reported(),
        note: reported(),
        settings: held.map(|row| (row.key.clone(), probe.value(row))).collect(),
    }
}

/// A profile on another controller, with all that is said of it.
struct Upgrade<'t> {
    from: &'t SettingsTable,
    to: &'t SettingsTable,
    profile: Profile,
    fitted: Profile,
    /// In small letters, since labels stand within them too.
    sentences: Vec<String>,
}

impl<'t> Upgrade<'t> {
    fn new(from: &'t SettingsTable, to: &'t SettingsTable, probe: Probe) -> Self {
        let profile = profile(from, probe);
        let fitted = profile.fitted_to(to);
        let sentences = fitted.changes.iter().map(|sentence| sentence.to_string().to_lowercase()).collect();
        Self { from, to, profile, fitted: fitted.profile, sentences }
    }

    fn pair(&self) -> String {
        let (from, to) = (self.from.subject(), self.to.subject());
        format!("{} {} -> {} {}", from.model.key, from.generation, to.model.key, to.generation)
    }

    /// Whether one sentence has all of these words.
    fn says(&self, words: &[&str]) -> bool {
        let is_in = |sentence: &str, word: &&str| sentence.contains(&word.to_lowercase());
        self.sentences.iter().any(|sentence| words.iter().all(|word| is_in(sentence, word)))
    }

    fn value(&self, row: &Row) -> SettingValue {
        self.profile.settings.get(&row.key).expect("every row has a value")
    }

    /// Whether a row over there holds the value of one of the profile.
    fn holds(&self, key: &str, row: &Row) -> bool {
        let held = self.to.row(key).zip(self.fitted.settings.get(key));
        let value = self.value(row);
        // A choice means what its key says; the words beside it may be longer where there are more choices.
        let is_same_choice = |now: SettingValue| matches!(now, SettingValue::Choice(_)) && now == value;
        held.is_some_and(|(there, now)| is_same_choice(now) || there.format(now) == row.format(value))
    }

    /// What became of one setting; one that changed or went away unsaid fails the test.
    fn outcome(&self, row: &Row) -> Outcome {
        if self.holds(&row.key, row) {
            return Outcome::Same;
        }
        let (title, value) = (row.title(), self.value(row));
        let text = row.format(value);
        let unsaid = || panic!("{}: {title} {text} is lost unsaid\n{:#?}", self.pair(), self.sentences);
        if self.to.row(&row.key).is_some() {
            let is_told = self.says(&[&title, &text])
                || row.key == "unit.estop_reset"
                    && self.says(&["no automatic E-Stop reset", "Hardware is used"]);
            return if is_told { Outcome::Converted } else { unsaid() };
        }
        for (one, two) in DIVIDED {
            if one == row.key && two.iter().all(|key| self.holds(key, row)) {
                let is_told = |key| {
                    let there = self.to.row(key).expect("it holds a value");
                    value == there.default || self.says(&[&there.title(), &text, &title])
                };
                return if two.into_iter().all(is_told) { Outcome::Converted } else { unsaid() };
            }
            if two.contains(&&*row.key) && self.holds(one, row) {
                return Outcome::Converted;
            }
        }
        let thing = row.instance.as_ref().map_or_else(|| title.clone(), |instance| instance.name.clone());
        let is_default = value == row.default;
        let is_named = is_default || self.says(&[&thing, &format!("{} {text}", row.label)]);
        let follows = is_default || QUIET.contains(&row.pattern) || self.says_first(&format!("{thing}: "));
        if is_named && follows && self.says(&["has no place for", &thing]) { Outcome::Told } else { unsaid() }
    }

    fn says_first(&self, words: &str) -> bool {
        self.sentences.iter().any(|sentence| sentence.starts_with(&words.to_lowercase()))
    }

    /// Whether a setting over there, of which the profile's controller has nothing, is said to stay, or follows from another.
    fn is_besides_told(&self, there: &Row) -> bool {
        let is_named = |name: &str| self.says(&["they stay as they are", name]);
        let instance = there.instance.as_ref().is_some_and(|instance| is_named(&instance.name));
        self.fitted.settings.get(&there.key).is_some()
            || instance
            || is_named(there.label)
            || is_named(there.group.label())
    }
}

/// Settings that a controller has and that somebody can set.
fn settable(table: &SettingsTable) -> impl Iterator<Item = &Row> {
    table
        .rows()
        .iter()
        .filter(|row| !matches!(row.access, Access::ReadOnly { .. }) && row.key != "unit.address")
}

/// Inputs go by their names to another model of the product line, which has a test of its own.
fn goes_by_name(upgrade: &Upgrade<'_>, row: &Row) -> bool {
    let (from, to) = (upgrade.from.subject().model, upgrade.to.subject().model);
    from != to && (row.group == Group::PINS || row.pattern == "motor{n}.encoder.pin")
}

#[test]
fn nothing_is_lost_unsaid_between_any_two_models_and_generations() {
    let tables: Vec<SettingsTable> =
        MODELS.iter().flat_map(|model| Generation::ALL.map(|generation| table(model, generation))).collect();
    let mut seen = [0; 3];
    for (from, to) in tables.iter().flat_map(|from| tables.iter().map(move |to| (from, to))) {
        for probe in [Probe::Small, Probe::End] {
            let upgrade = Upgrade::new(from, to, probe);
            for row in settable(from).filter(|row| !goes_by_name(&upgrade, row)) {
                seen[upgrade.outcome(row) as usize] += 1;
            }
            let is_foreign = |row: &&Row| from.row(&row.key).is_none() && !goes_by_name(&upgrade, row);
            for there in settable(to).filter(is_foreign) {
                let is_told = upgrade.is_besides_told(there);
                assert!(is_told, "{}: {}\n{:#?}", upgrade.pair(), there.title(), upgrade.sentences);
            }
            // Fitted, it is of that controller: it can be written there, and nothing differs that it does not have.
            assert!(upgrade.fitted.changes_for(to, &upgrade.fitted.settings, true).is_ok());
            let ram = to.default_image();
            let differing = diff(to, &ram, &upgrade.fitted.settings).into_iter();
            assert!(differing.filter(|each| each.right.is_some()).all(|each| to.row(&each.key).is_some()));
            if from.subject() == to.subject() {
                assert_eq!((upgrade.fitted, upgrade.sentences), (upgrade.profile, Vec::new()));
            }
        }
    }
    let [same, converted, told] = seen;
    assert!(same > 100_000 && converted > 1_000 && told > 10_000, "{seen:?}");
}

#[test]
fn the_matrix_of_all_settings_is_as_kept() {
    let mut matrix = String::from(LEGEND);
    for (from, to) in [
        ("mcp266", "mcp266"),
        ("roboclaw-2x7a", "roboclaw-2x7a"),
        ("mcp266", "roboclaw-2x7a"),
        ("roboclaw-2x7a", "mcp266"),
    ] {
        block(&mut matrix, from, to);
    }
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("src/tests/settings/fixtures/upgrade-matrix.txt");
    if std::env::var_os("BRUSHWORK_UPDATE").is_some() {
        std::fs::write(&path, &matrix).expect("the folder is there");
    }
    let kept = std::fs::read_to_string(&path).unwrap_or_default();
    assert_eq!(matrix, kept, "write it anew with BRUSHWORK_UPDATE=1 and read the difference");
}

const LEGEND: &str =
    "What becomes of each setting of a profile on a controller of another generation or product line.
Columns are the generations, from above to below.

=  the same
~  converted: it stands at other keys or in another number, which is told where it changes anything
!  no place: told with its value, and with what changes in the motion if it moves, stops or limits anything
>  new there, and follows from another setting of the profile
+  new there, and told to stay as the controller has it
   on neither
";

fn first_of<'t>(table: &'t SettingsTable, pattern: &str) -> Option<&'t Row> {
    settable(table).find(|row| row.pattern == pattern)
}

/// The lines of one pair of models: a line for each setting, the first of several alike, and a column for each pair of generations.
fn block(matrix: &mut String, from: &str, to: &str) {
    let tables = |model| Generation::ALL.map(|generation| table(model, generation));
    let (from_tables, to_tables) = (tables(from), tables(to));
    let pairs: Vec<(usize, usize)> = (0..4)
        .flat_map(|one| (0..4).map(move |other| (one, other)))
        .filter(|(one, other)| from != to || one != other)
        .collect();
    let upgrades: Vec<Upgrade<'_>> = pairs
        .iter()
        .map(|(one, other)| Upgrade::new(&from_tables[*one], &to_tables[*other], Probe::Small))
        .collect();
    let mut patterns: Vec<&str> = Vec::new();
    for row in from_tables.iter().chain(&to_tables).flat_map(settable) {
        if !patterns.contains(&row.pattern) {
            patterns.push(row.pattern);
        }
    }
    let generations = |pick: fn(&(usize, usize)) -> usize| -> String {
        pairs.iter().map(|pair| char::from(b'1' + pick(pair) as u8)).collect()
    };
    let (above, below) = (generations(|pair| pair.0), generations(|pair| pair.1));
    let _ = write!(matrix, "\n{:42}{above}\n{:42}{below}\n", format!("{from} -> {to}"), "");
    for pattern in patterns {
        let outcome =
            |upgrade: &Upgrade<'_>| match (first_of(upgrade.from, pattern), first_of(upgrade.to, pattern)) {
                (Some(row), _) => match upgrade.outcome(row) {
                    Outcome::Same => '=',
                    Outcome::Converted => '~',
                    Outcome::Told => '!',
                },
                (None, Some(there)) if upgrade.fitted.settings.get(&there.key).is_some() => '>',
                (None, Some(_)) => '+',
                (None, None) => ' ',
            };
        let line: String = upgrades.iter().map(outcome).collect();
        let _ = writeln!(matrix, "{}", format!("{pattern:42}{line}").trim_end());
    }
}

fn said(from: &SettingsTable, to: &SettingsTable, changes: &[(&str, &str)]) -> (Profile, Vec<String>) {
    let mut profile = profile(from, Probe::Small);
    profile.settings = from.default_image();
    for (key, text) in changes {
        let row = from.row(key).expect("the tests name settings that are there");
        profile.settings.set(key, row.parse(text).expect("it is in range"));
    }
    let fitted = profile.fitted_to(to);
    let besides = |sentence: &String| !sentence.starts_with("The ");
    (fitted.profile, fitted.changes.iter().map(ToString::to_string).filter(besides).collect())
}

#[test]
fn one_acceleration_becomes_two_and_two_become_one_and_what_that_changes_is_told() {
    let [one, four] = [Generation::Gen1, Generation::Gen4].map(|generation| table("mcp266", generation));
    let (profile, sentences) = said(&one, &four, &[("motor1.default_accel", "50")]);
    assert_eq!(profile.settings.get("motor1.default_decel"), Some(SettingValue::Number(50.0)));
    assert_eq!(
        sentences,
        [
            "Motor 1: default duty deceleration becomes 50 %/s, since \"Motor 1: default duty acceleration\" counted \
          for it before."
        ]
    );
    let both = [("motor2.default_accel", "50"), ("motor2.default_decel", "1000")];
    let (profile, sentences) = said(&four, &one, &both);
    assert_eq!(profile.settings.get("motor2.default_accel"), Some(SettingValue::Number(50.0)));
    assert_eq!(
        sentences,
        [
            "Motor 2: default duty deceleration 1000 %/s has no setting of its own there: 50 %/s counts for it too, as \
          \"Motor 2: default duty acceleration\". The motor brakes as fast as it accelerates."
        ]
    );
}

#[test]
fn one_pwm_mode_becomes_two_and_two_become_one() {
    let [two, three] = [Generation::Gen2, Generation::Gen3].map(|generation| table("mcp266", generation));
    let (profile, sentences) = said(&two, &three, &[("unit.pwm_mode", "sign_magnitude")]);
    for motor in ["motor1.pwm_mode", "motor2.pwm_mode"] {
        assert_eq!(profile.settings.get(motor), Some(SettingValue::Choice("sign_magnitude")));
    }
    assert_eq!(sentences.len(), 2);
    let (profile, sentences) = said(&three, &two, &[("motor1.pwm_mode", "sign_magnitude")]);
    assert_eq!(profile.settings.get("unit.pwm_mode"), Some(SettingValue::Choice("sign_magnitude")));
    assert_eq!(
        sentences,
        [
            "Motor 2: PWM mode Locked antiphase has no setting of its own there: Sign magnitude counts for it too, as \
          \"PWM mode\". The bridge switches, and brakes between pulses, as that of the other motor."
        ]
    );
}

#[test]
fn one_deadband_of_a_roboclaw_becomes_two() {
    let [two, four] =
        [Generation::Gen2, Generation::Gen4].map(|generation| table("roboclaw-2x7a", generation));
    let (profile, _) =
        said(&two, &four, &[("roboclaw.deadband.reverse", "4"), ("roboclaw.deadband.forward", "9")]);
    for (key, wanted) in [("reverse", 4), ("forward", 9)] {
        for input in ["s1", "s2"] {
            let key = format!("roboclaw.{input}.{key}_deadband");
            assert_eq!(profile.settings.get(&key), Some(SettingValue::Int(wanted)), "{key}");
        }
    }
}

#[test]
fn what_stops_a_motor_and_has_no_place_is_told_with_what_follows() {
    let [three, two] = [Generation::Gen3, Generation::Gen2].map(|generation| table("mcp266", generation));
    let (_, sentences) = said(&three, &two, &[("motor1.error_limit.speed", "1000")]);
    assert_eq!(sentences, ["Motor 1: The controller does not stop a motor that falls behind."]);
    let [four, three] = [Generation::Gen4, Generation::Gen3].map(|generation| table("mcp266", generation));
    let (profile, sentences) = said(&four, &three, &[("unit.estop_reset", "automatic")]);
    assert_eq!(profile.settings.get("unit.estop_reset"), Some(SettingValue::Choice("hardware")));
    assert!(sentences[0].starts_with("This firmware has no automatic E-Stop reset."), "{sentences:?}");
}
