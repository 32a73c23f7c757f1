//! A profile made for one controller, fitted to another: other model, other firmware generation, other numbers
//! of pins, streams and outputs. Every change is told in a sentence.

use std::collections::BTreeSet;

use super::super::family::{Conversion, FamilySettings, Fit};
use super::super::image::SettingsImage;
use super::super::kind::Kind;
use super::super::row::{Access, Group, Row};
use super::super::subject::Subject;
use super::super::table::SettingsTable;
use super::super::value::SettingValue;
use super::changes::{generation_misfit, model_misfit};
use super::content::Profile;
use crate::messages::ProfileMessage;
use brushwork_values::Message;

/// A profile fitted to another controller.
#[derive(Clone, Debug, PartialEq)]
pub struct Fitted {
    /// The profile as it is for that controller.
    pub profile: Profile,
    /// What was changed or left out, a sentence each; empty when it fitted as it was.
    pub changes: Vec<Message>,
}

impl Profile {
    /// Fits the profile to the controller of `table`. Inputs go by their printed name and encoders by their
    /// channel, not by their place in the list; what does not exist there is left out; what is out of range
    /// there is moved into range. Nothing is changed where the profile was made for that model and generation.
    pub fn fitted_to(&self, table: &SettingsTable) -> Fitted {
        let mut fitter = Fitter::new(self, table);
        fitter.tell_kind();
        fitter.settings();
        fitter.tell_left_out();
        fitter.tell_besides();
        let profile = Profile { subject: *table.subject(), settings: fitter.image, ..self.clone() };
        Fitted { profile, changes: fitter.changes }
    }
}

struct Fitter<'f> {
    profile: &'f Profile,
    from: SettingsTable,
    to: &'f SettingsTable,
    image: SettingsImage,
    changes: Vec<Message>,
    /// What the settings of one thing (a pin, a group) have nowhere to go to: its name, and what was lost there.
    left_out: Vec<LeftOut>,
    /// The keys over there for which the profile's controller has a setting.
    reached: BTreeSet<String>,
}

struct LeftOut {
    thing: String,
    count: usize,
    /// Those not at their default, as "deadband 3.0 %".
    worth_naming: Vec<String>,
    /// What changes in the motion without those.
    follows: Vec<Message>,
}

impl<'f> Fitter<'f> {
    fn new(profile: &'f Profile, to: &'f SettingsTable) -> Self {
        Self {
            profile,
            from: profile.table(),
            to,
            image: SettingsImage::default(),
            changes: Vec::new(),
            left_out: Vec::new(),
            reached: BTreeSet::new(),
        }
    }

    fn subjects(&self) -> (&Subject, &Subject) {
        (&self.profile.subject, self.to.subject())
    }

    fn tell_kind(&mut self) {
        let (from, to) = (self.profile.subject, *self.to.subject());
        if from.model != to.model {
            self.changes.push(model_misfit(from.model, to.model));
        }
        if from.generation != to.generation {
            self.changes.push(generation_misfit(from.generation, to.generation));
        }
    }

    fn settings(&mut self) {
        let rows = self.from.rows().to_vec();
        let mut moved_pins = Vec::new();
        let conversions = self.family().conversions(&self.fit());
        let is_converted = |key: &str| {
            conversions.iter().any(|conversion| conversion.from == key || conversion.absorbed == Some(key))
        };
        for row in &rows {
            let key = self.family().key_there(&self.fit(), row);
            self.reached.extend(key.clone());
            let Some(value) = self.profile.settings.get(&row.key) else { continue };
            match key.and_then(|key| self.to.row(&key).cloned()) {
                Some(there) => {
                    self.note_moved_pin(row, &there, &mut moved_pins);
                    self.take(row, &there, value);
                }
                None if is_converted(&row.key) => {}
                None => self.leave_out(row, value),
            }
        }
        conversions.into_iter().for_each(|conversion| self.convert(conversion));
    }

    fn convert(&mut self, conversion: Conversion) {
        let (row, there) = (self.from.row(conversion.from).cloned(), self.to.row(conversion.to).cloned());
        let (Some(row), Some(there)) = (row, there) else { return };
        let Some(value) = self.profile.settings.get(&row.key) else { return };
        self.reached.insert(there.key.clone());
        self.take(&row, &there, value);
        if !conversion.told.is_empty() {
            self.changes.push(conversion.told);
        }
    }

    fn family(&self) -> &'static dyn FamilySettings {
        self.to.subject().family().settings()
    }

    fn fit(&self) -> Fit<'_> {
        Fit { profile: self.profile, from: &self.from, to: self.to }
    }

    fn note_moved_pin(&mut self, row: &Row, there: &Row, moved: &mut Vec<usize>) {
        let (Some(old), Some(new)) = (&row.instance, &there.instance) else { return };
        if row.group == Group::PINS && old.name != new.name && !moved.contains(&old.number) {
            moved.push(old.number);
            let (from, to) = (old.name.clone(), new.name.clone());
            self.changes.push(ProfileMessage::InputMoved { from, to }.into());
        }
    }

    /// Takes a value over to a row of the other controller, changed as far as it must be.
    fn take(&mut self, row: &Row, there: &Row, value: SettingValue) {
        let Some(value) = self.translated(row, there, value) else {
            return self.leave_out(row, value);
        };
        if let Some((instead, why)) = self.family().impossible_there(&self.fit(), there, value) {
            self.changes.push(why);
            self.image.set(&there.key, instead);
            return;
        }
        let (from, to) = self.subjects();
        if (from.model, from.generation) == (to.model, to.generation) {
            // The same registers: whatever one unit held, the next one can.
            self.image.set(&there.key, value);
            return;
        }
        let (fitted, why) = there.repair(value);
        if is_lacking(there, value) {
            let (title, value, instead) = (there.title(), row.format(value), there.format(fitted));
            self.changes.push(ProfileMessage::NoSuchChoice { title, value, instead }.into());
        } else if let Some(why) = why {
            self.changes.push(why);
        } else if !is_same_number(value, fitted) {
            let (title, value, step) = (there.title(), row.format(value), there.format(fitted));
            self.changes.push(ProfileMessage::NearestStep { title, value, step }.into());
        }
        self.image.set(&there.key, fitted);
    }

    /// The value in the words of the other row; `None` when it means nothing there.
    fn translated(&self, row: &Row, there: &Row, value: SettingValue) -> Option<SettingValue> {
        match (there.kind, self.family().value_there(&self.fit(), row, value)?) {
            (Kind::Int, SettingValue::Number(number)) if number.fract() == 0.0 => {
                Some(SettingValue::Int(number as i64))
            }
            (Kind::Fixed { .. }, SettingValue::Int(number)) => Some(SettingValue::Number(number as f64)),
            (_, value) => Some(value),
        }
    }

    fn leave_out(&mut self, row: &Row, value: SettingValue) {
        let thing = row.instance.as_ref().map_or_else(|| row.title(), |instance| instance.name.clone());
        let position = self.left_out.iter().position(|left| left.thing == thing).unwrap_or_else(|| {
            self.left_out.push(LeftOut { thing, count: 0, worth_naming: Vec::new(), follows: Vec::new() });
            self.left_out.len() - 1
        });
        let follows = self.family().without(row);
        let left = &mut self.left_out[position];
        left.count += 1;
        if value != row.default {
            left.worth_naming.push(format!("{} {}", lower(row.label), row.format(value)));
            left.follows.extend(follows.filter(|what| !left.follows.contains(what)));
        }
    }

    /// One sentence for each thing whose settings went nowhere; those not at their default by name, with what follows from that.
    fn tell_left_out(&mut self) {
        let (model, generation) = (self.to.subject().model.name, self.to.subject().generation);
        for LeftOut { thing, count, worth_naming, follows } in std::mem::take(&mut self.left_out) {
            let named = worth_naming.join(", ");
            let follows =
                follows.into_iter().map(|what| ProfileMessage::Follows { thing: thing.clone(), what });
            let follows: Vec<Message> = follows.map(Message::from).collect();
            let told = match (count, worth_naming.is_empty()) {
                (1, true) => ProfileMessage::DefaultLeftOut { model, generation, thing },
                (1, false) => ProfileMessage::OneLeftOut { model, generation, thing, named },
                (_, true) => ProfileMessage::DefaultsLeftOut { model, generation, thing, count },
                (_, false) => ProfileMessage::SomeLeftOut { model, generation, thing, count, named },
            };
            self.changes.push(told.into());
            self.changes.extend(follows);
        }
    }

    /// What the other controller has besides, by group, thing or label, whatever says it shortest.
    fn tell_besides(&mut self) {
        let (from, to) = self.subjects();
        if (from.model, from.generation) == (to.model, to.generation) {
            return;
        }
        let is_besides = |row: &Row| !self.reached.contains(&row.key);
        let settable = || self.to.rows().iter().filter(|row| !matches!(row.access, Access::ReadOnly { .. }));
        let mut names: Vec<&str> = Vec::new();
        for row in settable().filter(|row| is_besides(row)) {
            let of_group = || settable().filter(|other| other.group == row.group);
            let of_thing = || of_group().filter(|other| other.instance == row.instance);
            let name = match &row.instance {
                _ if of_group().all(is_besides) => row.group.label(),
                Some(instance) if of_thing().all(is_besides) => &instance.name,
                Some(_) | None => row.label,
            };
            if !names.contains(&name) {
                names.push(name);
            }
        }
        if !names.is_empty() {
            let named = names.join(", ");
            let besides = ProfileMessage::Besides { model: to.model.name, generation: to.generation, named };
            self.changes.push(besides.into());
        }
    }
}

/// Whether the other row has no such choice.
fn is_lacking(there: &Row, value: SettingValue) -> bool {
    match (there.kind, value) {
        (Kind::Choice(codes), SettingValue::Choice(key)) => codes.iter().all(|code| code.key != key),
        _ => false,
    }
}

fn is_same_number(value: SettingValue, fitted: SettingValue) -> bool {
    match (value.number(), fitted.number()) {
        (Some(old), Some(new)) => (old - new).abs() <= 1e-9 * old.abs().max(new.abs()),
        _ => value == fitted,
    }
}

fn lower(label: &str) -> String {
    let mut letters = label.chars();
    match letters.next() {
        Some(first) if letters.clone().next().is_some_and(char::is_lowercase) => {
            first.to_lowercase().chain(letters).collect()
        }
        _ => label.to_owned(),
    }
}
