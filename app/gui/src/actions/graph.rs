//! The Graph menu: everything that can be done with the graph of a screen that drives. Its keys work while the graph has the focus.

use super::{Action, Keys, Ready, only};
use crate::command::Command;
use crate::graph::{GraphAction, TriggerMode};
use crate::model::Model;

macro_rules! action {
    ($group:literal $id:literal, $action:ident $(($mode:path))?, $help:literal) => {
        entry!(Graph $group $id, GraphAction::$action $(($mode))?.title(), $help,
            Keys::None, on_a_graph, |_| Command::Graph(GraphAction::$action $(($mode))?))
    };
}

pub(super) const ACTIONS: &[Action] = &[
    action!(0 "graph.toggle-pause", TogglePause, "Holds the picture while recording goes on, or follows the newest sample again."),
    action!(0 "graph.back-to-live", BackToLive, "Follows the newest sample, and closes a recording that is shown."),
    action!(0 "graph.earlier", Earlier, "Moves the view back in time by a tenth of its width."),
    action!(0 "graph.later", Later, "Moves the view on in time by a tenth of its width."),
    action!(0 "graph.oldest", Oldest, "Goes to the oldest sample that is kept."),
    action!(0 "graph.show-all", ShowAll, "Shows everything that is kept at once."),
    action!(1 "graph.zoom-in", ZoomIn, "Shows a shorter time."),
    action!(1 "graph.zoom-out", ZoomOut, "Shows a longer time."),
    action!(2 "graph.fit-all", FitAll, "Gives each channel that is shown the scale of what is in view."),
    action!(2 "graph.fit-selected", FitSelected, "Gives the selected channel the scale of what is in view."),
    action!(2 "graph.scale-closer", ScaleCloser, "Draws the selected channel larger."),
    action!(2 "graph.scale-wider", ScaleWider, "Draws the selected channel smaller."),
    action!(2 "graph.zero-up", ZeroUp, "Moves the zero mark of the selected channel up."),
    action!(2 "graph.zero-down", ZeroDown, "Moves the zero mark of the selected channel down."),
    action!(2 "graph.clear-all", ClearAll, "Takes all lines out of the picture; nothing that was recorded is lost."),
    action!(2 "graph.restore-cleared", RestoreCleared, "Brings back the lines that were cleared."),
    action!(3 "graph.toggle-cursors", ToggleCursors, "Shows or hides two cursors with values, differences and statistics between them."),
    action!(3 "graph.other-cursor", OtherCursor, "Lets the keys move the other cursor."),
    action!(3 "graph.cursor-left", CursorLeft, "Moves the cursor to earlier samples."),
    action!(3 "graph.cursor-right", CursorRight, "Moves the cursor to later samples."),
    action!(4 "graph.trigger-off", Trigger(TriggerMode::Off), "Follows without waiting for anything."),
    action!(4 "graph.trigger-auto", Trigger(TriggerMode::Auto), "Stands at each trigger, and follows while there is none."),
    action!(4 "graph.trigger-normal", Trigger(TriggerMode::Normal), "Stands at the newest trigger."),
    action!(4 "graph.trigger-single", Trigger(TriggerMode::Single), "Waits for one trigger and stands there."),
    action!(4 "graph.rearm-trigger", RearmTrigger, "Waits for the next single trigger."),
    action!(4 "graph.next-trigger", NextTrigger, "Goes to the next trigger in what is recorded."),
    action!(5 "graph.add-note", AddNote, "Leaves a mark at the newest sample."),
    action!(5 "graph.keep-run", KeepRun, "Lays what is in view beneath later samples, to compare."),
    action!(5 "graph.forget-runs", ForgetRuns, "Takes the runs that were kept away."),
    action!(6 "graph.toggle-large", ToggleLarge, "Gives the graph the whole screen, or its share again."),
    action!(6 "graph.toggle-detached", ToggleDetached, "Puts the graph into a window of its own, which stays whatever the screen, or puts it back."),
    action!(6 "graph.toggle-list", ToggleList, "Folds the list of channels away, with a legend in the plot instead, or shows it again."),
    action!(7 "graph.record-csv", RecordCsv, "Records every sample from now on into a CSV file, with host times."),
    action!(7 "graph.record-compact", RecordCompact, "Records every sample from now on into a compact file."),
    action!(7 "graph.stop-recording", StopRecording, "Ends the recording and closes its file."),
    action!(8 "graph.save-history", SaveHistory, "Writes the last hour of all channels, with its events, into a CSV file that can be opened again; after a disconnect too."),
    action!(8 "graph.export-csv", ExportCsv, "Writes the samples in view into a CSV file."),
    action!(8 "graph.export-png", ExportPng, "Writes the picture in view into a PNG file."),
    action!(8 "graph.export-svg", ExportSvg, "Writes the picture in view into an SVG file."),
    action!(8 "graph.copy-picture", CopyPicture, "Puts the picture in view on the clipboard, with its head and legend."),
];

fn on_a_graph(model: &Model) -> Ready {
    let is_shown = model.screen.has_graph() || model.front.graph.detached;
    only(is_shown, "The graph is on the Device Status, PWM, Velocity and Position screens.")
}
