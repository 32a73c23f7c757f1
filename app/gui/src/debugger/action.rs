//! What a person can ask of the debugger.

use brushwork_plant::server::Pace;
use brushwork_script::debug::StepKind;

/// One action.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum DebugAction {
    /// Goes on; starts the script if none runs.
    Run,
    Pause,
    Step(StepKind),
    RunToCursor,
    /// Sets or takes away a breakpoint where the caret is.
    ToggleBreakpoint,
    ClearBreakpoints,
    /// Takes away the breakpoint of a line, from 1.
    RemoveBreakpoint(u32),
    /// Whether a script stops before its first line.
    StopAtEntry(bool),
    /// Whether the simulated world stands still while the script is paused.
    FreezeWorld(bool),
    /// How fast the simulated controller's time goes.
    Pace(Pace),
    /// Puts the caret on a line, from 1.
    ShowLine(u32),
    ShowCounts(bool),
    ClearCounts,
    /// Gives what is typed in the terminal to the script.
    Send,
    /// Sets the place that is typed to the value that is typed.
    SetValue,
}
