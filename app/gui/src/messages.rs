//! What the window says of its own acts, in its words: one table for each theme.

use brushwork_values::messages;

messages! {
    /// What is tried, as a bare verb phrase, in failures and as the name of a job.
    pub enum WindowActMessage {
        Connect "connect",
        ReadFile "read",
        Download "download",
        OpenFile "open",
        SaveFile "save",
        UseDisk "use the disk",
        KeepUnsaved "keep unsaved text against a crash",
        Print { title: String } "print {title}",
        WatchPorts "watch the serial ports",
        ChangeWorld "change the simulated world",
        DebugScript "debug the script of the simulated controller",
        ReadState "read the window's state",
        KeepState "keep the window's state",
        CompareWithBackup "compare the settings with the backup",
        BackUp "back the settings up",
        OpenInput "open the input",
        PutInputBack "put the input back",
    }
}

messages! {
    /// What came back of what was tried, as a clause.
    pub enum WindowCauseMessage {
        TooLong "it is longer than 16 MB and can be no MCL program",
        NoFile "it is no file, but a folder, a device or a pipe",
        DiskIsBusy "the disk is busy",
        NoThread "the system gave no thread for it",
        MoreUrgent "something more urgent came first",
        Said { text: String } "{text}",
    }
}

messages! {
    /// What to do, as a sentence without its full stop.
    pub enum WindowRemedyMessage {
        TypeTarget "Type a path such as /dev/ttyUSB0 or COM3, or tcp:host:port",
        CheckPath "Check the path and your rights",
        ChooseAnother "Choose another file",
        SaveElsewhere "Check the free space and your rights, or save it elsewhere",
        SaveNowAndThen "Save it to a file now and then",
        SetUpPrinter "See that a printer is set up, or print to a PDF file",
        ConnectAgain "Disconnect and connect again",
        StartsAsAtFirst "Brushwork starts as it is at first",
        OldFileIsAside { path: String } "Brushwork starts as it is at first. The old file is {path}",
        CheckFolder "The next start will be as the last one was. Look at the folder's permissions",
    }
}
