//! What the window knows, in words.

use brushwork_values::{Motor, messages};

messages! {
    /// How the script of the controller stands.
    pub enum ScriptStateMessage {
        Held { line: u32 } "The debugger holds a script in line {line}. ",
        Runs { line: u32 } "A script runs, line {line}. ",
        Ended { line: u32 } "The script ended in line {line}. ",
        BrokeOff { line: u32, what: String } "The script broke off in line {line}: {what}. ",
        LinePaused { line: u32 } "Script paused, line {line}",
        LineRunning { line: u32 } "Script running, line {line}",
    }
}

messages! {
    /// What the history keeps of what happened.
    pub enum HistoryMessage {
        Connected { unit: String, port: String } "Connected to {unit} at {port}",
        Stopped { latency_ms: f64 } "Stop on the wire after {latency_ms:.1} ms, ",
    }
}

messages! {
    /// What was measured, and how long it takes.
    pub enum MeasuredMessage {
        Takes { seconds: f64 } "takes {seconds:.1} s",
        TakesAtLeast { seconds: f64 } "takes at least {seconds:.1} s",
        Qpps { motor: Motor, qpps: f64, forward: f64, reverse: f64, spread_percent: f64 } "{motor}: QPPS {qpps:.0} counts/s · forward {forward:.0}, reverse {reverse:.0} · spread {spread_percent:.2} %",
        Power { volts: f64, rest_volts: f64, amps: f64, forward: f64, reverse: f64 } "Battery {volts:.1} V under load, {rest_volts:.1} V at rest · up to {amps:.2} A · went {forward:.0} and {reverse:.0} counts",
        Asymmetry { percent: f64 } "The directions differ by {percent:.0} %: something drags or pulls. The mean is offered.",
    }
}

messages! {
    /// What became of a line that was typed for a controller, where no answer says it.
    pub enum RawLineMessage {
        Silence "nothing came back",
        NotSent "Not sent: the link is busy. Send it again in a moment.",
        LinkEnded "The link ended before an answer came.",
    }
}
