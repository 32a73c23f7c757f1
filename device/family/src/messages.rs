//! What is said of loops that are tuned, in its words.

use brushwork_values::messages;

messages! {
    /// What is tried on the loops of a unit, as a bare verb phrase.
    pub enum LoopActMessage {
        Read "read the loops",
        ReadBack "read the loops back",
        WriteBack "write the loops back",
        PutBack "put the loops back",
        WriteRegistersBack "write the registers back",
        PutCurrentLimitBack "put the current limit back",
        PutWindingBack "put inductance and resistance back",
        SetTimeout "set the time-out of the port",
        SetTimeoutBack "set the time-out of the port back",
    }
}

messages! {
    /// What to do, as a sentence without its full stop.
    pub enum LoopRemedyMessage {
        CheckLink "Check the link and try again; `brushwork settings read` shows the loops",
    }
}
