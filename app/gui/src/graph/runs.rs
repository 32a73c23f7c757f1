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
}

impl Align {
    pub const ALL: [Self; 3] = [Self::Start, Self::Trigger, Self::Command];

    pub const fn word(self) -> &'static str {
        match self {
            Self::Start => "Start",
            Self::Trigger => "Trigger",
            Self::Command => "Command",
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

    /// What has to be added to the run's times to draw it into `sheet`.
    pub fn offset_s(&self, sheet: &Sheet, align: Align) -> f64 {
        let own_s = self.anchor_s(sheet.trigger.settings(), align, sheet);
        anchor_of(sheet, align) - own_s + self.shift_s
    }

    fn anchor_s(&self, trigger: &TriggerSettings, align: Align, sheet: &Sheet) -> f64 {
        let start_s = self.track.began_s.unwrap_or(0.0);
        match align {
            Align::Start => start_s,
            Align::Command => first_command_s(&self.track).unwrap_or(start_s),
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
            TriggerSource::Command => first_command_s(&self.track),
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

fn first_command_s(track: &Track) -> Option<f64> {
    track.marks.iter().find(|mark| mark.kind == MarkKind::Drive).map(|mark| mark.at_s)
}

/// What of the present picture the runs are laid on.
fn anchor_of(sheet: &Sheet, align: Align) -> f64 {
    let (start_s, end_s) = sheet.window();
    let found = match align {
        Align::Start => None,
        Align::Trigger => sheet.shot_s(),
        Align::Command => {
            let mut marks = sheet.track.marks.between(start_s, end_s).rev();
            marks.find(|mark| mark.kind == MarkKind::Drive).map(|mark| mark.at_s)
        }
    };
    found.unwrap_or(start_s)
}
