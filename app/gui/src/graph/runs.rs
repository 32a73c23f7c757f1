//! Earlier runs drawn under the present one, for comparing: kept from the live graph or opened from a file.

use std::cell::{Cell, RefCell};

use super::memo::Memo;
use super::trigger::{TriggerSettings, first_crossing_s};
use super::{MarkKind, Sheet, Track, TriggerSource};

/// What of a run and of the present picture lies at the same place.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Align {
    /// Where the run begins, and the left edge.
    #[default]
    Start,
    /// Where the trigger's level is passed first, and the present trigger.
    Trigger,
    /// The first command that moves a motor, and the newest such command in view.
    Command,
    /// The first mark that a person has left, and the first one in view.
    Mark,
}

impl Align {
    pub const ALL: [Self; 4] = [Self::Start, Self::Trigger, Self::Command, Self::Mark];

    pub const fn word(self) -> &'static str {
        match self {
            Self::Start => "Start",
            Self::Trigger => "Trigger",
            Self::Command => "Command",
            Self::Mark => "Mark",
        }
    }
}

/// An earlier run.
#[derive(Debug)]
pub struct Run {
    pub name: String,
    pub track: Track,
    pub shown: bool,
    /// Moved by hand, to the right.
    pub shift_s: f64,
    pub memos: RefCell<Vec<Memo>>,
    found: Cell<Option<(TriggerSettings, Option<f64>)>>,
}

impl Run {
    pub fn new(name: String, track: Track) -> Self {
        let memos = RefCell::new(vec![Memo::default(); track.channels.len()]);
        Self { name, track, shown: true, shift_s: 0.0, memos, found: Cell::new(None) }
    }

    /// Where what it is aligned by stands in the picture of `sheet`.
    pub fn stands_at_s(&self, sheet: &Sheet, align: Align) -> f64 {
        anchor_of(sheet, align) + self.shift_s
    }

    /// What has to be added to the run's times to draw it into `sheet`.
    pub fn offset_s(&self, sheet: &Sheet, align: Align) -> f64 {
        let own_s = self.anchor_s(sheet.trigger.settings(), align, sheet);
        anchor_of(sheet, align) - own_s + self.shift_s
    }

    fn anchor_s(&self, trigger: &TriggerSettings, align: Align, sheet: &Sheet) -> f64 {
        let start_s = self.track.began_s.unwrap_or(0.0);
        match align {
            Align::Start => start_s,
            Align::Command => first_s(&self.track, MarkKind::Drive).unwrap_or(start_s),
            Align::Mark => first_s(&self.track, MarkKind::Note).unwrap_or(start_s),
            Align::Trigger => self.crossing_s(trigger, sheet).unwrap_or(start_s),
        }
    }

    fn crossing_s(&self, trigger: &TriggerSettings, sheet: &Sheet) -> Option<f64> {
        if let Some((settings, found)) = self.found.get()
            && settings == *trigger
        {
            return found;
        }
        let found = match trigger.source {
            TriggerSource::Command => first_s(&self.track, MarkKind::Drive),
            TriggerSource::Channel(channel) => {
                let key = sheet.track.channels.get(channel).map(|info| info.key.as_str());
                let own = key.and_then(|key| self.track.channel_of_key(key));
                own.and_then(|own| first_crossing_s(&self.track, own, trigger, f64::NEG_INFINITY))
            }
        };
        self.found.set(Some((*trigger, found)));
        found
    }
}

fn first_s(track: &Track, kind: MarkKind) -> Option<f64> {
    track.marks.iter().find(|mark| mark.kind == kind).map(|mark| mark.at_s)
}

/// What of the present picture the runs are laid on. In a recording that is the same wherever it is looked at.
fn anchor_of(sheet: &Sheet, align: Align) -> f64 {
    if let Some(from_s) = sheet.whole_from_s {
        let found = match align {
            Align::Start => None,
            Align::Trigger => match sheet.trigger.settings().source {
                TriggerSource::Command => first_s(&sheet.track, MarkKind::Drive),
                TriggerSource::Channel(channel) => {
                    first_crossing_s(&sheet.track, channel, sheet.trigger.settings(), f64::NEG_INFINITY)
                }
            },
            Align::Command => first_s(&sheet.track, MarkKind::Drive),
            Align::Mark => first_s(&sheet.track, MarkKind::Note),
        };
        return found.unwrap_or(from_s);
    }
    let (start_s, end_s) = sheet.window();
    let is = |kind: MarkKind| move |mark: &&super::Mark| mark.kind == kind;
    let mut marks = sheet.track.marks.between(start_s, end_s);
    let found = match align {
        Align::Start => None,
        Align::Trigger => sheet.shot_s(),
        Align::Command => marks.rev().find(is(MarkKind::Drive)).map(|mark| mark.at_s),
        Align::Mark => marks.find(is(MarkKind::Note)).map(|mark| mark.at_s),
    };
    found.unwrap_or(start_s)
}
