//! What the graph shows, in words.

use brushwork_values::messages;

messages! {
    /// What the graph shows, and how it says so.
    pub enum PlotMessage {
        Title { of: String, span: String } "Brushwork · {of} · {span} per division",
        Opened { name: String } "RECORDING  {name}",
        OpenedInPart { name: String, rows: u64 } "RECORDING  {name} · its oldest {rows} rows are left out",
        OfRecording { name: String, span: String, shown: String } "Graph of the recording {name}, {span}: {shown}",
        Paused { span: String, shown: String } "Graph, paused, of {span}: {shown}",
        AtTrigger { span: String, shown: String } "Graph of {span} at the trigger: {shown}",
        Live { span: String, shown: String } "Live graph of the last {span}: {shown}",
        RunLine { number: usize, name: String, label: String } "{number} {name}: {label}",
        Beneath { runs: String } ". Earlier runs: {runs}",
        LastMark { mark: String } ". Last mark: {mark}",
        Cursor { name: &'static str } ". Cursor {name} is moved by the arrow keys",
    }
}

messages! {
    /// What happened at a mark of the graph.
    pub enum MarkMessage {
        Pace { pace: String } "time {pace}",
        ScriptPaused { line: u32 } "script paused at line {line}",
        ScriptFailed { line: u32 } "script failed at line {line}",
        Note { number: usize } "Note {number}",
        Duty { percent: f64 } "duty {percent:.1} %",
        Speed { speed: i32 } "speed {speed} counts/s",
        Distance { distance: u32, speed: i32 } "distance {distance} counts at {speed} counts/s",
        Position { position: i32 } "position {position} counts",
    }
}

messages! {
    /// What the bars of the graph say.
    pub enum GraphBarMessage {
        Recording { name: String, samples: u64, size: String } "{name}: {samples} samples, {size}",
        Lost { lost: u64 } ", {lost} lost: the disk is too slow",
        Reading { name: String, rows: u64 } "Reading {name}: {rows} rows",
        Bytes { bytes: u64 } "{bytes} bytes",
        Colour { number: usize } "Colour {number}",
        KeptRun { number: usize } "Kept run {number}",
        Readings { count: u64 } "{count} readings between the cursors",
        RecordingTo { what: String } "Recording {what}",
        Asked { hz: f64 } "{hz:.0} asked",
        Rate { reached: String, asked: String } "{reached} samples/s, {asked}",
        TriggerMode { mode: &'static str } "Trigger: {mode}",
        Use { channel: String } "Use {channel}",
        TriggerField { field: String } "Trigger {field}",
        LookingAt { name: String } "Looking at {name}",
        Shift { number: usize } "Shift of run {number}",
        Every { milliseconds: u128 } "every {milliseconds} ms",
        Scale { label: String, low: String, high: String, unit: String } "{label} {low} to {high} {unit}",
        OneReading "1 reading between the cursors",
    }
}
