//! What the debugger shows, in words.

use brushwork_values::messages;

messages! {
    /// What the debugger shows of a script.
    pub enum DebuggerMessage {
        AtLine { line: u32 } "line {line}",
        In { name: String, line: u32 } "{name}: line {line}",
        RemoveBreakpoint { line: u32 } "Remove breakpoint at line {line}",
        Moved { line: u32, hits: u64 } "at line {line}, {hits} ×",
        FirstHit { line: u32 } "First hit of breakpoint at line {line}",
        Condition { line: u32 } "Condition of breakpoint at line {line}",
        Output { received: String } "Script output: {received}",
        Stream { stream: u32 } "stream {stream}",
        BytesWait { waiting: usize } "{waiting} bytes wait for GETS.",
        MoreElements { more: u32 } "{more} more: watch an element by its index.",
        ClickToSet { hint: String } "{hint}. Click to set it to something else",
        RemoveWatch { watch: String } "Remove watch {watch}",
        FormOfWatch { watch: String } "Form of watch {watch}",
        Is { place: String, value: String, state: &'static str } "{place} is {value}{state}",
    }
}
