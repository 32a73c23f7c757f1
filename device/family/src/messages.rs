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

messages! {
    /// What an examination tries, as a bare verb phrase.
    pub enum ExamineActMessage {
        TakeStep { title: String } "{title}",
        Keep "keep what is there",
        PutSettingsBack "put the settings back",
        CloseJournal "close the journal",
    }
}

messages! {
    /// What came back of that, as a clause.
    pub enum ExamineCauseMessage {
        ReadOtherwise "some of them read otherwise than before",
        NotWritten { why: String } "{why}",
    }
}

messages! {
    /// What to do about it, as a sentence without its full stop.
    pub enum ExamineRemedyMessage {
        SeeUnfinished "`brushwork settings unfinished` shows what they were, and puts them back",
    }
}
