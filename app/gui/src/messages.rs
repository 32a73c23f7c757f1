//! What the window says of its own acts, in its words: one table for each theme.

use brushwork_canopen::NodeId;
use brushwork_values::{Motor, messages};

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

messages! {
    /// What the message line says of what happened.
    pub enum WindowStatusMessage {
        NotNow { act: String, why: String } "{act}: {why}",
        ClosesWhenPutBack "The motors are stopped. The window closes as soon as what the tuning run changed is put back; close it again to close it at once.",
        FollowsWhenPutBack { what: &'static str } "The motors are stopped. {what} as soon as what the run changed is put back.",
        WindingPutBack "L and R are put back as they were before the run.",
        WindingNotPutBack "L and R could not be put back as they were before the run. Set them under Velocity loop, or switch the controller off and on: its EEPROM still has them.",
        GaveUp "Gave up connecting.",
        NodeStartSent { node: NodeId } "The start was sent to {node}: its heartbeat tells what comes of it.",
        ConnectAgain { sentence: String } "{sentence} Connect to the bus again.",
        NodeNotStarted "Could not start the node: the system gave no thread. Try again.",
        DownloadRuns "A download runs already. Wait for it or cancel it.",
        WaitsForRun "That waits for the end of the tuning run, so that the time-out and the gains of before are written, not those of the run.",
        ReportIsIn { path: String } "The report is in {path}.",
        ReportShown { motor: Motor, screen: &'static str } "The report of {motor} is shown on {screen}.",
        Replaced { count: usize } "Replaced {count} places.",
        NoNameAtCaret "Put the caret on a name of the program first.",
        NotPrinted { title: String, why: String } "Could not print {title}: {why}.",
        NoLineNumber { text: String } "“{text}” is no line number.",
        Renamed { count: usize } "Renamed in {count} places.",
        FileIs { what: &'static str, path: String } "{what}: {path}.",
        Armed { scope: String } "Armed for {scope}. Space or Esc stops.",
        Disconnected "Disconnected.",
        Copied { count: usize } "Copied {count} transactions.",
        NotTuned { motor: Motor, why: String, back: String } "{motor} was not tuned: {why}{back}",
        AsPredicted { motor: Motor } "{motor} behaves as predicted with these gains.",
        LinkEnded "The link ended without a reason. Connect again.",
        ArmEditorFirst "A script can move motors: arm the MCL Editor first, then press Run again.",
        CodeIsNotPublic "Could not download the program: the byte code of real controllers is not public, so nobody but their maker can compile for them. Choose an image file that the maker's program has compiled: it is sent as it is, and can be started, stopped and set to autorun from here.",
        RunHoldsSettings "A tuning run is at work, and this command changes settings. Send it when the run has ended.",
        GainsBack { motor: Motor } "The gains of {motor} from before the run are back.",
        NotTunedFor { motor: Motor, why: String } "{motor} was not tuned: {why}.",
        TunedWithWarning { motor: Motor, cause: String } "{motor} is tuned, with something to know: {cause}",
        TunedNotApplied { motor: Motor } "{motor} is tuned. The old gains are in force until you apply the proposed ones.",
        NotRecorded { error: String } "Could not record: {error}. Close other programs and try again.",
        NotExported { error: String } "Could not export: {error}. Close other programs and try again.",
        Tuned { motor: Motor, cause: String } "{motor}: {cause}",
    }
}
