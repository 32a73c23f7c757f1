//! The Graph menu: everything that can be done with the graph of a screen that drives. Its keys work while the graph has the focus.

use super::{Action, Keys, Ready};
use crate::command::Command;
use crate::graph::GraphAction;
use crate::graph::trigger::TriggerMode;
use crate::model::Model;

macro_rules! action {
    ($id:literal, $action:ident $(($mode:path))?, $group:literal, $help:literal) => {
        entry!(Graph $group $id, GraphAction::$action $(($mode))?.title(), $help,
            Keys::None, on_a_graph, |_| Command::Graph(GraphAction::$action $(($mode))?))
    };
}

pub(super) const ACTIONS: &[Action] = &[
    action!(
        "graph.toggle-pause",
        TogglePause,
        0,
        "Holds the picture while recording goes on, or follows the newest sample again."
    ),
    action!(
        "graph.back-to-live",
        BackToLive,
        0,
        "Follows the newest sample, and closes a recording that is shown."
    ),
    action!("graph.earlier", Earlier, 0, "Moves the view back in time by a tenth of its width."),
    action!("graph.later", Later, 0, "Moves the view on in time by a tenth of its width."),
    action!("graph.oldest", Oldest, 0, "Goes to the oldest sample that is kept."),
    action!("graph.show-all", ShowAll, 0, "Shows everything that is kept at once."),
    action!("graph.zoom-in", ZoomIn, 1, "Shows a shorter time."),
    action!("graph.zoom-out", ZoomOut, 1, "Shows a longer time."),
    action!("graph.fit-all", FitAll, 2, "Gives each channel that is shown the scale of what is in view."),
    action!("graph.fit-selected", FitSelected, 2, "Gives the selected channel the scale of what is in view."),
    action!("graph.scale-closer", ScaleCloser, 2, "Draws the selected channel larger."),
    action!("graph.scale-wider", ScaleWider, 2, "Draws the selected channel smaller."),
    action!("graph.zero-up", ZeroUp, 2, "Moves the zero mark of the selected channel up."),
    action!("graph.zero-down", ZeroDown, 2, "Moves the zero mark of the selected channel down."),
    action!(
        "graph.clear-all",
        ClearAll,
        2,
        "Takes all lines out of the picture; nothing that was recorded is lost."
    ),
    action!("graph.restore-cleared", RestoreCleared, 2, "Brings back the lines that were cleared."),
    action!(
        "graph.toggle-cursors",
        ToggleCursors,
        3,
        "Shows or hides two cursors with values, differences and statistics between them."
    ),
    action!("graph.other-cursor", OtherCursor, 3, "Lets the keys move the other cursor."),
    action!("graph.cursor-left", CursorLeft, 3, "Moves the cursor to earlier samples."),
    action!("graph.cursor-right", CursorRight, 3, "Moves the cursor to later samples."),
    action!("graph.trigger-off", Trigger(TriggerMode::Off), 4, "Follows without waiting for anything."),
    action!(
        "graph.trigger-auto",
        Trigger(TriggerMode::Auto),
        4,
        "Stands at each trigger, and follows while there is none."
    ),
    action!("graph.trigger-normal", Trigger(TriggerMode::Normal), 4, "Stands at the newest trigger."),
    action!(
        "graph.trigger-single",
        Trigger(TriggerMode::Single),
        4,
        "Waits for one trigger and stands there."
    ),
    action!("graph.rearm-trigger", RearmTrigger, 4, "Waits for the next single trigger."),
    action!("graph.next-trigger", NextTrigger, 4, "Goes to the next trigger in what is recorded."),
    action!("graph.add-note", AddNote, 5, "Leaves a mark at the newest sample."),
    action!("graph.keep-run", KeepRun, 5, "Lays what is in view beneath later samples, to compare."),
    action!("graph.forget-runs", ForgetRuns, 5, "Takes the runs that were kept away."),
    action!("graph.toggle-large", ToggleLarge, 6, "Gives the graph the whole screen, or its share again."),
    action!(
        "graph.record-csv",
        RecordCsv,
        7,
        "Records every sample from now on into a CSV file, with host times."
    ),
    action!(
        "graph.record-compact",
        RecordCompact,
        7,
        "Records every sample from now on into a compact file."
    ),
    action!("graph.stop-recording", StopRecording, 7, "Ends the recording and closes its file."),
    action!("graph.export-csv", ExportCsv, 8, "Writes the samples in view into a CSV file."),
    action!("graph.export-png", ExportPng, 8, "Writes the picture in view into a PNG file."),
    action!("graph.export-svg", ExportSvg, 8, "Writes the picture in view into an SVG file."),
];

fn on_a_graph(model: &Model) -> Ready {
    match model.screen.arm_scope() {
        Some(_) => Ok(()),
        None => Err("The graph is on the PWM, Velocity and Position screens.".into()),
    }
}
