//! What a firmware answers: learned while it is used, kept for the next time, and not asked for again where it lacks a command.
//!
//! Silence alone does not tell that a command is lacking, since lines lose replies. It counts only when the unit answers something else right
//! after, and only after so many tries that a line which loses as much as this one has shown would hardly have lost them all.

use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::fmt;
use std::sync::Arc;
use std::time::Duration;

/// How likely it may be that a line lost every reply to a command that is called absent.
const DOUBT: f64 = 1e-3;
/// A command is slow from so many times what others take on.
const SLOW_TIMES: f64 = 3.0;
/// And by so much more at least: a task of a computer's own scheduler lasts as long.
const SLOW_BY: Duration = Duration::from_millis(20);

brushwork_values::listed! {
    /// How a firmware takes a command.
    #[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
    #[serde(rename_all = "snake_case")]
    pub enum Presence {
        /// It answers.
        Present "present",
        /// It answers, and needs much longer than for others.
        Slow "slow",
        /// It answers that it will not, or with something else.
        Refused "refused",
        /// It never answers, while it answers others.
        Absent "absent",
    }
    /// In a word.
    fn label;
}

/// What was learned of one command.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Learned {
    /// The quickest reply, ms, of which the time of the bytes is a part; none where none ever came.
    pub quickest_ms: Option<f64>,
    /// Tries in a row to which nothing came while others were answered.
    pub silent_tries: u32,
    /// Whether it is known to be lacking.
    pub is_absent: bool,
    /// Whether the last answer was a refusal.
    pub is_refused: bool,
}

/// What one firmware answers, by the numbers of its commands.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct CapabilityMap {
    commands: BTreeMap<u8, Learned>,
}

impl CapabilityMap {
    /// What was learned of each command, by number.
    pub fn entries(&self) -> impl Iterator<Item = (u8, Presence, Learned)> {
        let usual_ms = self.usual_ms();
        self.commands.iter().map(move |(command, learned)| (*command, learned.presence(usual_ms), *learned))
    }

    /// The commands that the firmware is known to lack.
    pub fn absent(&self) -> impl Iterator<Item = u8> {
        self.commands.iter().filter(|(_, learned)| learned.is_absent).map(|(command, _)| *command)
    }

    /// Whether nothing was learned yet.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.commands.is_empty()
    }

    fn lacks(&self, command: u8) -> bool {
        self.commands.get(&command).is_some_and(|learned| learned.is_absent)
    }

    /// The median of the quickest replies.
    fn usual_ms(&self) -> Option<f64> {
        let mut all: Vec<f64> = self.commands.values().filter_map(|learned| learned.quickest_ms).collect();
        all.sort_by(f64::total_cmp);
        all.get(all.len() / 2).copied()
    }
}

impl Learned {
    fn presence(&self, usual_ms: Option<f64>) -> Presence {
        let is_slow = |(quickest, usual): (f64, f64)| {
            quickest > usual * SLOW_TIMES && quickest > usual + SLOW_BY.as_secs_f64() * 1e3
        };
        if self.is_absent {
            Presence::Absent
        } else if self.is_refused {
            Presence::Refused
        } else if self.quickest_ms.zip(usual_ms).is_some_and(is_slow) {
            Presence::Slow
        } else {
            Presence::Present
        }
    }
}

/// Where maps are kept from one session to the next, by what a firmware calls itself.
pub trait KeepsCapabilities: fmt::Debug + Send + Sync {
    /// What is kept of a firmware; nothing is an empty map.
    fn load(&self, firmware: &str) -> CapabilityMap;

    /// Keeps it. What cannot be kept is learned again.
    fn keep(&self, firmware: &str, map: &CapabilityMap);
}

/// What the units of one line answer.
#[derive(Debug, Default)]
pub struct CapabilityBook {
    units: BTreeMap<u8, Unit>,
    keeper: Option<Arc<dyn KeepsCapabilities>>,
    answered: u32,
    lost: u32,
}

#[derive(Debug, Default)]
struct Unit {
    firmware: String,
    map: CapabilityMap,
    has_news: bool,
}

impl CapabilityBook {
    /// A book whose maps come from `keeper` and go there.
    #[must_use]
    pub fn new(keeper: Option<Arc<dyn KeepsCapabilities>>) -> Self {
        Self { keeper, ..Self::default() }
    }

    /// The unit at an address calls its firmware so: what is known of that counts from now on.
    pub fn introduce(&mut self, address: u8, firmware: &str) {
        let mut map = self.keeper.as_ref().map(|keeper| keeper.load(firmware)).unwrap_or_default();
        // Another session's silence is not to be judged by what this session's line loses.
        map.commands.values_mut().filter(|known| !known.is_absent).for_each(|known| known.silent_tries = 0);
        let has_news = !map.is_empty();
        self.units.insert(address, Unit { firmware: firmware.to_owned(), map, has_news });
    }

    /// Whether it is known who is at an address.
    #[must_use]
    pub fn knows(&self, address: u8) -> bool {
        self.units.contains_key(&address)
    }

    /// What is known of the unit at an address.
    #[must_use]
    pub fn of(&self, address: u8) -> CapabilityMap {
        self.units.get(&address).map(|unit| unit.map.clone()).unwrap_or_default()
    }

    /// Forgets what was learned of the firmware at an address, here and where it is kept, so that all of it is learned anew.
    pub fn forget(&mut self, address: u8) {
        if let Some(unit) = self.units.get_mut(&address) {
            unit.map = CapabilityMap::default();
            unit.has_news = true;
        }
    }

    /// Whether a unit is known to lack a command, so that asking is in vain.
    #[must_use]
    pub fn lacks(&self, address: u8, command: u8) -> bool {
        self.units.get(&address).is_some_and(|unit| unit.map.lacks(command))
    }

    /// A reply came after `took`, and after `lost` tries to which none did.
    pub fn answered(&mut self, address: u8, command: u8, took: Duration, lost: u32) {
        self.answered = self.answered.saturating_add(1);
        self.lost = self.lost.saturating_add(lost);
        self.change(address, command, |learned| {
            let took_ms = took.as_secs_f64() * 1e3;
            let quickest_ms = learned.quickest_ms.map_or(took_ms, |known| known.min(took_ms));
            *learned = Learned { quickest_ms: Some(quickest_ms), ..Learned::default() };
        });
    }

    /// The unit refused the command; `is_absent` where it says that it lacks it.
    pub fn refused(&mut self, address: u8, command: u8, is_absent: bool) {
        self.change(address, command, |learned| (learned.is_refused, learned.is_absent) = (true, is_absent));
    }

    /// Nothing came in so many tries, and the unit answered something else after them. Whether the command counts as absent now.
    pub fn silent(&mut self, address: u8, command: u8, tries: u32) -> bool {
        self.change(address, command, |learned| {
            // A command that has been answered before is not lacking: something else is wrong.
            if learned.quickest_ms.is_none() {
                learned.silent_tries = learned.silent_tries.saturating_add(tries);
            }
        });
        self.judge();
        self.lacks(address, command)
    }

    /// Judges the silent commands by what the line has shown by now.
    fn judge(&mut self) {
        // The rule of succession (Laplace): the share of lost replies, were the next one lost too.
        let share = f64::from(self.lost + 1) / f64::from(self.answered + self.lost + 2);
        for unit in self.units.values_mut() {
            for learned in unit.map.commands.values_mut().filter(|learned| !learned.is_absent) {
                let tries = i32::try_from(learned.silent_tries).unwrap_or(i32::MAX);
                learned.is_absent = tries > 0 && share.powi(tries) < DOUBT;
                unit.has_news |= learned.is_absent;
            }
        }
    }

    /// The maps in which something has changed that is worth telling, once.
    pub fn take_news(&mut self) -> Vec<(u8, CapabilityMap)> {
        self.judge();
        let mut news = Vec::new();
        for (address, unit) in &mut self.units {
            if std::mem::take(&mut unit.has_news) {
                if let Some(keeper) = &self.keeper {
                    keeper.keep(&unit.firmware, &unit.map);
                }
                news.push((*address, unit.map.clone()));
            }
        }
        news
    }

    fn change(&mut self, address: u8, command: u8, change: impl FnOnce(&mut Learned)) {
        // Before its version is known, a unit is nobody of whom anything could be kept.
        let Some(unit) = self.units.get_mut(&address) else { return };
        let is_new = !unit.map.commands.contains_key(&command);
        let learned = unit.map.commands.entry(command).or_default();
        let before = *learned;
        change(learned);
        let is_else = |before: &Learned, now: &Learned| {
            (before.is_absent, before.is_refused) != (now.is_absent, now.is_refused)
                || before.silent_tries != now.silent_tries
        };
        unit.has_news |= is_new || is_else(&before, learned);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::sync::Mutex;

    const UNIT: u8 = 0x80;
    const MILLISECOND: Duration = Duration::from_millis(1);

    fn book() -> CapabilityBook {
        let mut book = CapabilityBook::default();
        book.introduce(UNIT, "MCP266 v1");
        book
    }

    #[test]
    fn three_silent_tries_on_a_line_that_loses_nothing_are_enough() {
        let mut book = book();
        (0..20).for_each(|command| book.answered(UNIT, command, MILLISECOND, 0));
        assert!(book.silent(UNIT, 90, 3) && book.lacks(UNIT, 90));
        assert!(!book.lacks(UNIT, 1) && !book.lacks(0x81, 90));
    }

    #[test]
    fn a_line_that_loses_every_third_reply_needs_more_silence() {
        let mut book = book();
        (0..20).for_each(|command| book.answered(UNIT, command, MILLISECOND, u32::from(command % 2 == 0)));
        assert!(!book.silent(UNIT, 90, 3), "0.34 to the third is 4 %");
        assert!(book.silent(UNIT, 90, 4), "to the seventh it is 0.05 %");
    }

    #[test]
    fn what_was_silent_at_first_is_judged_when_the_line_has_shown_more() {
        let mut book = book();
        assert!(!book.silent(UNIT, 90, 3), "nothing is known of the line yet");
        (0..20).for_each(|command| book.answered(UNIT, command, MILLISECOND, 0));
        book.take_news();
        assert!(book.lacks(UNIT, 90));
    }

    #[test]
    fn a_command_that_was_answered_once_is_never_called_absent() {
        let mut book = book();
        (0..20).for_each(|command| book.answered(UNIT, command, MILLISECOND, 0));
        assert!(!book.silent(UNIT, 5, 100));
        assert_eq!(book.units[&UNIT].map.entries().filter(|(.., learned)| learned.is_absent).count(), 0);
    }

    #[test]
    fn what_takes_far_longer_than_the_rest_is_slow_and_a_late_line_makes_nothing_slow() {
        let mut book = book();
        for (command, ms) in [(1, 150), (2, 155), (3, 160), (4, 170)] {
            book.answered(UNIT, command, Duration::from_millis(ms), 0);
        }
        book.answered(UNIT, 5, Duration::from_millis(600), 0);
        let slow = book.units[&UNIT].map.entries().filter(|(_, presence, _)| *presence == Presence::Slow);
        assert_eq!(slow.map(|(command, ..)| command).collect::<Vec<_>>(), [5]);
    }

    #[test]
    fn what_was_forgotten_is_forgotten_where_it_is_kept_too_and_learned_again() {
        let shelf = Arc::new(Shelf::default());
        let mut book = CapabilityBook::new(Some(Arc::clone(&shelf) as _));
        book.introduce(UNIT, "v1");
        (0..20).for_each(|command| book.answered(UNIT, command, MILLISECOND, 0));
        assert!(book.silent(UNIT, 90, 3));
        book.take_news();
        book.forget(UNIT);
        assert!(!book.lacks(UNIT, 90) && book.of(UNIT).is_empty());
        assert_eq!(book.take_news(), [(UNIT, CapabilityMap::default())]);
        assert!(shelf.load("v1").is_empty());
        book.answered(UNIT, 90, MILLISECOND, 0);
        assert_eq!(book.of(UNIT).entries().map(|(command, ..)| command).collect::<Vec<_>>(), [90]);
    }

    #[derive(Debug, Default)]
    struct Shelf(Mutex<BTreeMap<String, CapabilityMap>>);

    impl KeepsCapabilities for Shelf {
        fn load(&self, firmware: &str) -> CapabilityMap {
            self.0.lock().unwrap().get(firmware).cloned().unwrap_or_default()
        }

        fn keep(&self, firmware: &str, map: &CapabilityMap) {
            self.0.lock().unwrap().insert(firmware.to_owned(), map.clone());
        }
    }

    #[test]
    fn silence_on_a_bad_line_is_not_judged_by_the_good_line_of_the_next_session() {
        let shelf = Arc::new(Shelf::default());
        let mut bad = CapabilityBook::new(Some(Arc::clone(&shelf) as _));
        bad.introduce(UNIT, "v1");
        (0..20).for_each(|command| bad.answered(UNIT, command, MILLISECOND, 1));
        assert!(!bad.silent(UNIT, 90, 3), "every second reply is lost here");
        bad.take_news();
        let mut good = CapabilityBook::new(Some(shelf as _));
        good.introduce(UNIT, "v1");
        (0..20).for_each(|command| good.answered(UNIT, command, MILLISECOND, 0));
        good.take_news();
        assert!(!good.lacks(UNIT, 90));
    }

    #[test]
    fn the_next_session_knows_what_the_last_has_learned_of_that_firmware_alone() {
        let shelf = Arc::new(Shelf::default());
        let mut first = CapabilityBook::new(Some(Arc::clone(&shelf) as _));
        first.introduce(UNIT, "v1");
        (0..20).for_each(|command| first.answered(UNIT, command, MILLISECOND, 0));
        first.silent(UNIT, 90, 3);
        assert_eq!(first.take_news().len(), 1);
        assert_eq!(first.take_news(), [], "told once");
        let mut next = CapabilityBook::new(Some(shelf as _));
        next.introduce(0x83, "v1");
        next.introduce(0x84, "v2");
        assert!(next.lacks(0x83, 90) && !next.lacks(0x84, 90));
        let kept = next.take_news();
        assert_eq!(kept[0].1.absent().collect::<Vec<_>>(), [90]);
    }
}
