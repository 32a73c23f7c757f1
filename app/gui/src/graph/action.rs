//! What a person can do with the graph, one word for each: keys, buttons, menus and the palette all end here.

use super::files::Stopping;
use super::{LiveGraph, MarkKind, TriggerMode};
use crate::graph::messages::MarkMessage;

/// One thing to do.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum GraphAction {
    /// Holds the picture, or follows the newest sample again.
    TogglePause,
    /// Back to what comes in; closes a recording.
    BackToLive,
    Earlier,
    Later,
    Oldest,
    ShowAll,
    ZoomIn,
    ZoomOut,
    FitAll,
    FitSelected,
    ScaleCloser,
    ScaleWider,
    ZeroUp,
    ZeroDown,
    ClearAll,
    RestoreCleared,
    ToggleCursors,
    OtherCursor,
    CursorLeft,
    CursorRight,
    Trigger(TriggerMode),
    RearmTrigger,
    NextTrigger,
    AddNote,
    KeepRun,
    ForgetRuns,
    /// The graph takes the whole screen, or its share of it.
    ToggleLarge,
    /// The graph goes into a window of its own, or back.
    ToggleDetached,
    /// Folds the list of channels away, or unfolds it; a legend in the plot stands for it.
    ToggleList,
    /// Begins to record into a CSV file.
    RecordCsv,
    /// Begins to record into a compact file.
    RecordCompact,
    StopRecording,
    /// Writes everything that is kept: all channels, marks and gaps.
    SaveHistory,
    ExportCsv,
    ExportPng,
    ExportSvg,
    CopyPicture,
}

impl GraphAction {
    /// In a menu.
    pub const fn title(self) -> &'static str {
        match self {
            Self::TogglePause => "Pause or follow the graph",
            Self::BackToLive => "Back to live",
            Self::Earlier => "Scroll the graph back",
            Self::Later => "Scroll the graph on",
            Self::Oldest => "Scroll to the oldest sample",
            Self::ShowAll => "Show the whole history",
            Self::ZoomIn => "Zoom the graph in",
            Self::ZoomOut => "Zoom the graph out",
            Self::FitAll => "Fit all scales",
            Self::FitSelected => "Fit the selected channel's scale",
            Self::ScaleCloser => "Fewer units per division",
            Self::ScaleWider => "More units per division",
            Self::ZeroUp => "Move the channel's zero up",
            Self::ZeroDown => "Move the channel's zero down",
            Self::ClearAll => "Clear all lines",
            Self::RestoreCleared => "Show cleared lines again",
            Self::ToggleCursors => "Cursors",
            Self::OtherCursor => "Take the other cursor",
            Self::CursorLeft => "Move the cursor left",
            Self::CursorRight => "Move the cursor right",
            Self::Trigger(TriggerMode::Off) => "Trigger off",
            Self::Trigger(TriggerMode::Auto) => "Trigger auto",
            Self::Trigger(TriggerMode::Normal) => "Trigger normal",
            Self::Trigger(TriggerMode::Single) => "Trigger single",
            Self::RearmTrigger => "Arm the trigger again",
            Self::NextTrigger => "Find the next trigger",
            Self::AddNote => "Leave a mark now",
            Self::KeepRun => "Keep what is in view as a run",
            Self::ForgetRuns => "Remove all runs",
            Self::ToggleLarge => "Large graph",
            Self::ToggleDetached => "Graph in its own window",
            Self::ToggleList => "List of channels",
            Self::RecordCsv => "Record to CSV",
            Self::RecordCompact => "Record to a compact file",
            Self::StopRecording => "Stop recording",
            Self::SaveHistory => "Save the whole history",
            Self::ExportCsv => "Export what is in view as CSV",
            Self::ExportPng => "Export the picture as PNG",
            Self::ExportSvg => "Export the picture as SVG",
            Self::CopyPicture => "Copy the picture",
        }
    }
}

/// Part of the width that a step scrolls.
const STEP: f64 = 0.1;

/// Part of the width that a step of a cursor takes.
const CURSOR_STEP: f64 = 1.0 / 200.0;

/// Part of the height that a step of a zero mark takes.
const ZERO_STEP: f64 = 1.0 / 16.0;

impl LiveGraph {
    /// Does one thing.
    #[allow(clippy::wildcard_enum_match_arm, reason = "one answer for all the rest, new members too")]
    pub fn act(&mut self, action: GraphAction) {
        match action {
            GraphAction::BackToLive => {
                self.close_recording();
                self.live.follow();
            }
            GraphAction::AddNote => {
                let number =
                    self.live.track.marks.iter().filter(|mark| mark.kind == MarkKind::Note).count() + 1;
                let at_s = self.live.newest_s();
                self.mark(at_s, MarkKind::Note, MarkMessage::Note { number }.to_string());
            }
            GraphAction::KeepRun => self.keep_run(),
            GraphAction::ForgetRuns => self.runs.clear(),
            GraphAction::ToggleLarge => self.large = !self.large,
            GraphAction::ToggleDetached => self.detached = !self.detached,
            GraphAction::ToggleList => {
                self.legend = match self.legend {
                    Some(_) => None,
                    None => {
                        let mut listed = self.sheet().shown();
                        listed.sort_unstable();
                        Some(listed)
                    }
                };
            }
            GraphAction::RecordCsv => self.record(brushwork_core::recording::Form::Csv),
            GraphAction::RecordCompact => self.record(brushwork_core::recording::Form::Compact),
            GraphAction::StopRecording => self.end_recording(Stopping::Asked),
            GraphAction::SaveHistory => self.save_history(),
            GraphAction::ExportCsv => self.export(super::files::Export::Csv),
            GraphAction::ExportPng => self.export(super::files::Export::Png),
            GraphAction::ExportSvg => self.export(super::files::Export::Svg),
            GraphAction::CopyPicture => self.copy_picture(),
            other => self.look(other),
        }
    }

    /// What only changes how things are looked at.
    #[allow(clippy::wildcard_enum_match_arm, reason = "one answer for all the rest, new members too")]
    fn look(&mut self, action: GraphAction) {
        let sheet = self.sheet_mut();
        let (span_s, selected) = (sheet.span_s(), sheet.selected);
        match action {
            GraphAction::TogglePause if sheet.is_held() => sheet.follow(),
            GraphAction::TogglePause => sheet.hold(),
            GraphAction::Earlier => sheet.pan(-STEP * span_s),
            GraphAction::Later => sheet.pan(STEP * span_s),
            GraphAction::Oldest => sheet.look_at_oldest(),
            GraphAction::ShowAll => sheet.look_at_all(),
            GraphAction::ZoomIn => sheet.zoom_step(true),
            GraphAction::ZoomOut => sheet.zoom_step(false),
            GraphAction::FitAll => sheet.fit_shown(),
            GraphAction::FitSelected => sheet.fit(selected),
            GraphAction::ClearAll => sheet.clear_all(),
            GraphAction::RestoreCleared => sheet.restore_cleared(),
            GraphAction::ToggleCursors => sheet.show_cursors(!sheet.cursors.on),
            GraphAction::OtherCursor => sheet.cursors.active = 1 - sheet.cursors.active,
            GraphAction::CursorLeft => sheet.step_cursor(-CURSOR_STEP),
            GraphAction::CursorRight => sheet.step_cursor(CURSOR_STEP),
            GraphAction::Trigger(mode) => sheet.trigger.set_mode(mode),
            GraphAction::RearmTrigger => sheet.trigger.rearm(),
            GraphAction::NextTrigger => {
                sheet.look_for_trigger();
            }
            _ => self.rescale(action, selected),
        }
    }

    #[allow(clippy::wildcard_enum_match_arm, reason = "one answer for all the rest, new members too")]
    fn rescale(&mut self, action: GraphAction, selected: usize) {
        let sheet = self.sheet_mut();
        let Some(scale) = sheet.channels.get(selected).map(|channel| channel.scale) else { return };
        let scale = match action {
            GraphAction::ScaleCloser => scale.stepped(true),
            GraphAction::ScaleWider => scale.stepped(false),
            GraphAction::ZeroUp => scale.shifted(0.0, ZERO_STEP),
            GraphAction::ZeroDown => scale.shifted(0.0, -ZERO_STEP),
            _ => return,
        };
        sheet.set_scale(selected, scale);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const ALL: [GraphAction; 40] = [
        GraphAction::TogglePause,
        GraphAction::BackToLive,
        GraphAction::Earlier,
        GraphAction::Later,
        GraphAction::Oldest,
        GraphAction::ShowAll,
        GraphAction::ZoomIn,
        GraphAction::ZoomOut,
        GraphAction::FitAll,
        GraphAction::FitSelected,
        GraphAction::ScaleCloser,
        GraphAction::ScaleWider,
        GraphAction::ZeroUp,
        GraphAction::ZeroDown,
        GraphAction::ClearAll,
        GraphAction::RestoreCleared,
        GraphAction::ToggleCursors,
        GraphAction::OtherCursor,
        GraphAction::CursorLeft,
        GraphAction::CursorRight,
        GraphAction::Trigger(TriggerMode::Off),
        GraphAction::Trigger(TriggerMode::Auto),
        GraphAction::Trigger(TriggerMode::Normal),
        GraphAction::Trigger(TriggerMode::Single),
        GraphAction::RearmTrigger,
        GraphAction::NextTrigger,
        GraphAction::AddNote,
        GraphAction::KeepRun,
        GraphAction::ForgetRuns,
        GraphAction::ToggleLarge,
        GraphAction::ToggleDetached,
        GraphAction::ToggleList,
        GraphAction::RecordCsv,
        GraphAction::RecordCompact,
        GraphAction::StopRecording,
        GraphAction::SaveHistory,
        GraphAction::ExportCsv,
        GraphAction::ExportPng,
        GraphAction::ExportSvg,
        GraphAction::CopyPicture,
    ];

    #[test]
    fn every_action_has_a_title_of_its_own() {
        let mut titles: Vec<_> = ALL.iter().map(|action| action.title()).collect();
        titles.sort_unstable();
        titles.dedup();
        assert_eq!(titles.len(), ALL.len());
    }
}
