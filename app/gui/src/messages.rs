//! What the window says of its own acts, in its words: one table for each theme.

use brushwork_canopen::NodeId;
use brushwork_core::messages::EndedMessage;
use brushwork_link::device::DisarmReason;
use brushwork_link::{Interruption, Message};
use brushwork_values::{Motor, Sentences, messages};

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
        ReachPort "reach a serial port",
        ChoosePort "choose a serial port",
        ChangeWorld "change the simulated world",
        RunProgram "run the program on the simulated board",
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
        NoFile "it is no file, but a folder, a device or a pipe",
        BrowserHasNoPorts "this browser gives a page none, or cannot wait for a reply in the middle of a call; simulated controllers need neither",
        DiskIsBusy "the disk is busy",
        NoThread "the system gave no thread for it",
        OtherUnit "another unit was chosen meanwhile",
        MoreUrgent "something more urgent came first",
        Said { text: String } "{text}",
    }
}

messages! {
    /// What to do, as a sentence without its full stop.
    pub enum WindowRemedyMessage {
        TypeTarget "Type a path such as /dev/ttyUSB0 or COM3, or tcp:host:port",
        UseChromium "For a controller of your own open the page in Chrome, Edge or another Chromium of version 137 or newer on a computer, or install Brushwork",
        ChooseAgain "Press the button again; if the browser still refuses, look at what its settings allow this page",
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
    /// How an examination ended, and what became of its report.
    pub enum ExaminationMessage {
        Done "The examination is done.",
        CutShort { cause: EndedMessage } "The examination was ended before its end: {cause}.",
        Panicked { word: String } "Brushwork had a bug in the examination. Its last word: {word}",
        LinkLost "The link was lost in the examination. What it had changed can be put back when the controller is connected again.",
        NotBegun "The settings of this controller are not known yet. Wait until they are read.",
        NoPath "Type where the report is to go: a path that ends in .json, or in anything else for text.",
        NotSaved { path: String, error: String } "The report could not be written to {path}: {error}. Choose another name.",
    }
}

messages! {
    /// What is said while boards are given their addresses.
    pub enum AddressingMessage {
        NoLine "Connect to the line first: to the port that the boards will share.",
        NoList { why: String } "These are no addresses: {why}.",
        NamedTwice "An address is named twice: each board gets its own.",
        OfTwoFamilies "No family of controllers has all of these addresses: a line has controllers of one family.",
        Busy "The controller in front is busy. Wait for it or cancel it.",
        UnitAt { unit: String, place: String } "{unit} at {place}",
        Searches "Looking who is on the line",
        Meets "Looking for the board at its new address",
        ShowsAll "Looking for all that have got one",
        Listens "Listening whether one board alone answers",
        Reads "Reading its settings",
        Writes "Writing the address and reading it back",
        Saves "Saving to EEPROM and proving it",
        UnknownModel { unit: String } "The board at {unit} is no model that this program knows: it was not given an address.",
        SeveralWait { units: String, place: String } "Several boards on {place} wait for an address, at {units}. Say which is meant, or unplug all of them but one and find it again.",
        TheOne { address: String } "The one at {address}",
        HasOneAlready { unit: String, address: String } "This {unit} has {address} already. Plug in the next one.",
        NotTaken { why: Sentences } "The address did not take. {why}",
        NotMet { address: String } "The address was written and saved, but no unit answers at {address}. Switch the board off and on, then find it again.",
        Has { unit: String, address: String } "The {unit} answers at {address}.",
        OneHas "The board has its address.",
        AllHave { boards: usize } "All {boards} boards have their addresses.",
        Give { address: String } "Give it {address}",
        WillGive { unit: String, address: String } "{unit} gets the address {address}: it is written, read back, and saved to EEPROM with all its settings. A backup is made first.",
        WillStay { unit: String, address: String } "{unit} stays at {address}: all its settings are saved to EEPROM. A backup is made first.",
        PlugIn { address: String } "Plug in the board that is to have {address}. No other may be on the line that still waits for its address; those that have theirs may stay.",
    }
}

messages! {
    /// What is said of one profile for several units.
    pub enum ToAllMessage {
        Unit { unit: String, place: String, port: String } "{unit} at {place} on {port}",
        NoProfile "No profile is open. Open one in General Settings.",
        OpenOneFirst "Open the profile first; then press Write to all units.",
        GoesOn "It goes on already.",
        NobodyChosen "No unit is ticked.",
        OneCannot "Not all that are ticked can take the profile, so that nothing is written to any. Untick those that cannot.",
        NotCompared "Not all that are ticked are compared yet.",
        NothingDiffers "All that are ticked hold these values already.",
        Compared "All are compared. Nothing was written yet.",
        NotComparedToEnd "The comparison was cancelled. Nothing was written.",
        Busy { unit: String } "{unit} is busy. Wait for it or cancel it.",
        Differs "1 setting differs",
        Differ { count: usize } "{count} settings differ",
        Same "It holds these values already",
        WriteToOne "Write to 1 unit",
        WriteTo { count: usize } "Write to {count} units",
        Gone "Its link is gone.",
        HeldAlready "It held these values already.",
        Written { settings: String } "{settings} written and read back.",
        WrittenAndSaved { settings: String } "{settings} written, read back, and all settings saved to EEPROM.",
        NotTaken { why: Sentences } "Not all of it took. {why}",
        OneHasIt "The unit has the profile.",
        AllHaveIt { of: usize } "All {of} units have the profile.",
        SomeHaveIt { done: usize, of: usize } "{done} of {of} units have the profile. Each row says what became of it.",
    }
}

messages! {
    /// What is said on the page for raw numbers.
    pub enum RawPageMessage {
        Armed "Disarm first: nothing is written raw while anything is armed.",
        Busy "The controller is busy with something else. Wait for it or cancel it.",
        NotConnected "Connect to a controller to write to it.",
        NotReadYet "The settings are not read yet. Wait until they are.",
        NoNumber { text: String } "\"{text}\" is no whole number: use for example 2 or 0x02.",
        NothingToUndo "Nothing was written raw to this controller that could be undone.",
        HeldAlready { key: String, raw: i64 } "The register of {key} holds {raw} already.",
        CannotBe { why: Sentences } "The number is not written. {why}",
        Holds { key: String, raw: i64 } "The register of {key} holds {raw}, as reading it back has shown. It is in RAM: save it only when it does what you want.",
        HoldsOther { key: String, raw: i64 } "The number did not take: the register of {key} holds {raw}.",
        NotReadBack { why: Sentences } "The number may be written and could not be read back. {why}",
        Command { command: u8, field: String } "Command {command}, field {field}",
        CommandOf { command: u8, field: String, index: u8 } "Command {command}, field {field}, of number {index}",
        HoldsNow { raw: i64 } "The register holds {raw} now.",
        Undo { key: String, raw: i64 } "Undo: {raw} for {key}",
        Was { date: String, key: String, wanted: i64, before: String, found: String } "{date}  {key}: {wanted} in place of {before}, read back {found}",
        WasCutOff { date: String, key: String, wanted: i64, before: String } "{date}  {key}: {wanted} in place of {before}, cut off before it was read back",
    }
}

messages! {
    /// What keeps what is typed from being sent.
    pub enum WindowTypedMessage {
        NoCommand "Choose a command.",
        NotBytes { field: &'static str, text: String, bytes: usize } "{field}: \"{text}\" is not {bytes} bytes. Write each as two hexadecimal digits.",
        NoList { field: &'static str } "{field}: lists cannot be typed here.",
        NoNumber { field: &'static str, text: String } "{field}: \"{text}\" is no number.",
        NotInRange { field: &'static str, number: i64, least: i64, most: i64 } "{field}: {number} does not fit. It takes {least} to {most}.",
        NotEncoded { clause: String } "It cannot be sent: {clause}.",
        NoScriptBytes { text: String } "`{text}` is not bytes in hex: write them as 48 65 6c 6c 6f.",
        SelfTest "The self-test is not sent: the unit would need a power cycle after it.",
        NoAddress "A command is a letter and two digits of address, as in R01 04. The unit would not answer.",
        BadCommand "The unit would answer BAD COMMAND.",
        NoLine "Type a command, as R01 04 or W01 04 6000.",
        NoPairs "These are not pairs of hexadecimal digits.",
        NoBytes "Type the bytes of a command, as 1D 01 04 22.",
        MoreBytes { bytes: usize } "More follows a whole command: {bytes} in bytes. Send one command at a time.",
        NoChecksum { checksum: u8 } "The checksum is missing: it is {checksum:02X}.",
        OtherChecksum { checksum: u8 } "No command: the unit would be silent. If the last byte is the checksum, it should be {checksum:02X}.",
        NotYet "No command yet: the unit would be silent.",
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
        WentAhead { seconds: u64 } "The simulated time has gone {seconds} s ahead: this browser cannot draw the window in the middle of a run.",
        StoppedWhileHidden "The motors were stopped when the page was hidden: a browser lets a hidden page work too seldom to drive one. Arm again when you are ready.",
        NoLinkThread "Could not open the link: the system gave no thread. Try again.",
        Of { target: String, text: Message } "{target}: {text}",
        PasteTooLong { bytes: usize, most: usize } "Nothing was pasted: the clipboard holds {bytes} bytes of text, and this place takes at most {most}.",
        NodeStartSent { node: NodeId } "The start was sent to {node}: its heartbeat tells what comes of it.",
        ConnectAgain { sentence: Message } "{sentence} Connect to the bus again.",
        NodeNotStarted "Could not start the node: the system gave no thread. Try again.",
        AssistantWorks "Something is read from or written to the units of this link. Wait for it or cancel it.",
        DownloadRuns "A download runs already. Wait for it or cancel it.",
        WaitsForRun "That waits for the end of the tuning run, so that the previous time-out and gains are written, not those of the run.",
        ReportIsIn { path: String } "The report is in {path}.",
        ReportShown { motor: Motor, screen: &'static str } "The report of {motor} is shown on {screen}.",
        Replaced { count: usize } "Replaced {count} places.",
        NoNameAtCaret "Put the caret on a name of the program first.",
        NotPrinted { title: String, why: String } "Could not print {title}: {why}.",
        NoLineNumber { text: String } "“{text}” is no line number.",
        Renamed { count: usize } "Renamed in {count} places.",
        FileIs { what: &'static str, path: String } "{what}: {path}.",
        Armed { scope: String } "Armed for {scope}. Esc stops.",
        Disconnected "Disconnected.",
        Copied { count: usize } "Copied {count} transactions.",
        NotTuned { motor: Motor, why: Message } "{motor} was not tuned: {why}",
        NotTunedAndStopped { motor: Motor, why: Message } "{motor} was not tuned: {why} The motors were stopped and the old gains are in force.",
        AsPredicted { motor: Motor } "{motor} behaves as predicted with these gains.",
        LinkEnded "The link ended without a reason. Connect again.",
        ArmEditorFirst "A script can move motors: arm the MCL Editor first, then press Run again.",
        RunsOnBoardsAlone "A MeccCode program runs on a simulated board alone, since the byte code of the real one is not public. Connect to a simulated board that runs it and press Run again, or use brushwork mecc run FILE.",
        RunsOnBoard { title: String } "{title} runs on the simulated board. Nothing else drives its motors now: Run Host Library gives them back to the window.",
        LibraryRunsAgain "The host library runs on the simulated board again.",
        CodeIsNotPublic "Could not download the program: the byte code of real controllers is not public, so only their maker can compile for them. Choose an image file that the maker's program has compiled: it is sent as it is, and can be started, stopped and set to autorun from here.",
        RunHoldsSettings "A tuning run is under way, and this command changes settings. Send it when the run has ended.",
        GainsBack { motor: Motor } "The previous gains of {motor} are back.",
        NotTunedFor { motor: Motor, why: Message } "{motor} was not tuned: {why}.",
        TunedWithWarning { motor: Motor, cause: String } "{motor} is tuned, with something to know: {cause}",
        TunedNotApplied { motor: Motor } "{motor} is tuned. The old gains are in force until you apply the proposed ones.",
        NotRecorded { error: String } "Could not record: {error}. Close other programs and try again.",
        NotExported { error: String } "Could not export: {error}. Close other programs and try again.",
        Tuned { motor: Motor, cause: String } "{motor}: {cause}",
    }
}

messages! {
    /// What the message line says of an open link.
    pub enum LinkStatusMessage {
        Connected { unit: String, port: String, place: String, firmware: String, generation: String } "Connected to {unit} at {port}, {place}, firmware {firmware} ({generation}).",
        ConnectedBare { unit: String, port: String, place: String, generation: String } "Connected to {unit} at {port}, {place} ({generation}).",
        ConnectedOf { unit: String, port: String, place: String, generation: String } "Connected to {unit} at {port}, {place}, {generation}.",
        Lacks { unit: String, commands: String } "The firmware of {unit} does not have: {commands}.",
        LostArmed { what: Message, seconds: f64 } "{what} The screen was armed: the controller stops its motors by itself after {seconds:.1} s of silence.",
        LostArmedForever { what: Message } "{what} The screen was armed: make sure that the motors stand still.",
        LostWaiting { what: Message, waiting: Message } "{what} {waiting}",
        Stopped { milliseconds: f64 } "Stopped. The stop was on the wire after {milliseconds:.1} ms; duty 0 is confirmed.",
        StoppedFromOutside { reason: DisarmReason, milliseconds: f64 } "{reason}. The stop was on the wire after {milliseconds:.1} ms; duty 0 is confirmed.",
    }
}

messages! {
    /// How a job of the window ended.
    pub enum JobMessage {
        Panicked { act: Message, word: String } "Could not {act}: Brushwork had a bug. Its last word: {word}",
        CutShort { act: Message, cause: EndedMessage } "Did not {act} to the end: {cause}. The motors were stopped.",
        LinkLost "The link was lost before it was done.",
        Played "The profile was played to its end. The motors were stopped.",
        QppsMeasured "QPPS was measured. The motors were stopped.",
        Downloaded { title: String, how: String } "Downloaded {title}: {how}",
    }
}

messages! {
    /// What came of the test of the voltage clamp.
    pub enum ClampMessage {
        Over { percent: f64, volts: f64, limit: f64 } "Stopped at {percent:.0} %: the main battery reached {volts:.1} V, the limit is {limit:.1} V. Use a resistor of fewer ohms, or add capacitance across B+ and B-. MCP manual 1.7.5.",
        Braked { percent: f64, milliseconds: f64, volts: f64 } "Stopped at {percent:.0} %: the main battery was above the controller's maximum for {milliseconds:.0} ms, {volts:.1} V at most, so that the controller braked the motor by itself. The clamp does not take the energy: check its wiring and its output, or use a resistor of fewer ohms. MCP manual 1.7.5.",
        Stayed { limit: f64, highest: f64 } "The main battery stayed below {limit:.1} V from every speed: {highest:.1} V at most.",
        NoResult "The test ended without a result. Try again.",
        CutShort { cause: Interruption } "The test did not run to its end: {cause}. The motors were stopped.",
        Panicked { word: String } "The test did not run: the program has a fault ({word}).",
    }
}

messages! {
    /// What came of work with the settings.
    pub enum OutcomeMessage {
        Applied { settings: String } "Applied and read back: {settings} in the controller's RAM. Until they are saved to EEPROM they last until it is switched off.",
        Wrong { sentences: Sentences } "{sentences}",
        NotDone { act: Message, cause: Interruption } "Did not {act}: {cause}. The screen still shows the previous values.",
        Panicked { act: Message, word: String } "Could not {act}: the program has a fault ({word}). Read the settings to see what they are.",
        NoResult { act: Message } "Could not {act}: no result came.",
        Read { settings: String, rest: Message } "{settings} read.{rest}",
        Loaded { settings: String, rest: Message } "{settings} loaded from EEPROM and read.{rest}",
        Absent { settings: String } " This firmware does not have {settings}.",
        Unread { settings: String } " {settings} could not be read; each row says why.",
        Written { settings: String } "{settings} written and read back as wanted. Save to EEPROM to keep what is written over a power cycle.",
        NotTaken { failed: usize, settings: String } "{failed} of {settings} did not take; their rows keep the change.",
        SomeCannotBe "Nothing was written: some of the changes cannot be.",
        NothingWritten { failure: Message } "Nothing was written. {failure}",
        Defaults "The controller works with its default settings. Save to EEPROM to keep them.",
        OwnDefaults { settings: String } "The controller works with its default settings. Save to EEPROM to keep them. {settings} came back with another value than listed here.",
        Unfinished { what: Message } "{what} General Settings says which settings are old and which are new.",
        ProfileSaved { settings: String, path: String } "{settings} are in {path}.",
    }
}

messages! {
    /// What is said of the two sides of a comparison.
    pub enum CompareMessage {
        BackupGone "The backup is not there any more.",
        BackupNotOpened "The backup was not opened.",
        UnitGone "The other unit is not connected any more.",
        NoOtherUnit "No other unit of this family is connected whose settings were read. Open its link, or look at it once, and try again.",
        NoUnit "No controller is looked at.",
        NotRead "The settings have not been read.",
        NoProfile "No profile is open.",
    }
}

messages! {
    /// What is said while an input is calibrated.
    pub enum CalibrationMessage {
        Open { pin: String } "{pin} commands nothing while it is calibrated.",
        NotOpened { pin: String } "{pin} could not be opened for calibration. It is put back as it was.",
        PutBack { pin: String } "{pin} is as it was before the calibration.",
        Runs { pin: String, min: f64, center: f64, max: f64 } "{pin} runs from {min} over {center} to {max}. Write to give it to the controller.",
        RunsWithNoise { pin: String, min: f64, center: f64, max: f64, noise: f64 } "{pin} runs from {min} over {center} to {max}. At rest it differs by up to {noise}: a deadband of twice that keeps it still. Write to give it to the controller.",
        LeftOpen { pin: String } "{pin} could not be put back as it was: it commands nothing now. Its old settings stand here as changes; write them.",
        NoReadings "No readings have come yet. Wait until the input is read.",
        ShortTravel { travel: f64 } "The input moved over {travel} only. Move it to both ends and hold it there a moment.",
        EndsFirst "Take the ends first.",
        FewReadings "Too few readings have come yet. Leave the input at rest a moment.",
        NotAtRest { noise: f64, center: f64 } "The input does not rest: its readings differ by {noise} from {center}. Let go of it and wait.",
        RestsAtEnd { center: f64, min: f64, max: f64 } "The input rests at {center}, which is one of its ends, {min} and {max}. Let go of it, or move it to the middle.",
    }
}

messages! {
    /// Why something of the tuning screens is not done, and what became of a run.
    pub enum TuningMessage {
        NothingToTry "There are no gains to try. Tune first.",
        RunGoesOn "A run goes on already. Wait for it or stop it.",
        NoTravel "The travel has no room: its high end must be at least 40 counts above its low end.",
        Panicked { word: String } "Brushwork had a bug. Its last word: {word}",
        NothingCame "nothing came of it",
        Owed "The run was cut off from the controller, whose own time-out stops the motors. The previous gains are put back when it answers again: connect again. Switching it off and on brings back those of its EEPROM.",
        WindingUnread "L and R have not been read. Read the settings again first.",
        NothingToApply "There are no gains to apply. Tune first.",
        RegistersUnread "The registers are being read, so that they can be put back. Apply in a moment.",
        AtItsEnd "That changes nothing: the value is at its end already.",
        NothingToUndo "Nothing was applied that could be undone.",
        NotConnected "No controller is connected.",
        HeldAlready "The controller holds these values already.",
        SettingsBusy "The settings are being read or written. Try again in a moment.",
    }
}

messages! {
    /// What the editor says of a program.
    pub enum EditorMessage {
        LoadedAgain { title: String } "{title} was changed by another program and was loaded again. Undo brings the old text back.",
        ChangedElsewhere { title: String } "{title} was changed by another program and was not saved. Choose above the text which one counts.",
        NotEncoded { title: String, error: Message } "Could not save {title}: {error}. Choose UTF-8 below the text and save again.",
        OneWarning "1 warning",
        Warnings { count: usize } "{count} warnings",
        OneError "1 error",
        Errors { count: usize } "{count} errors",
        Free { title: String } "{title} is free of errors.",
        Warned { title: String, warned: Message } "{title} has no errors and {warned}.",
        Found { title: String, found: Message, warned: Message } "{title} has {found} and {warned}.",
        Printed { title: String } "{title} is with the printer.",
        NoName "There is no name at the caret. Put it on a variable, a constant or a label.",
        OfTheLanguage { word: String, language: &'static str } "{word} is a word of {language} and not defined in the program.",
        NotDefined { word: String } "{word} is not defined in this program.",
        NoBlock "Put the caret on a word such as IF, ELSE, WHILE or NEXT first.",
        NotRenamed { why: Message } "The name stays as it is: {why}.",
    }
}

messages! {
    /// What is said of the files of the graph.
    pub enum GraphMessage {
        Wrote { path: String } "Wrote {path}.",
        NotWritten { path: String, error: String } "Could not write {path}: {error}. Choose another folder.",
        RecordedInPart { samples: u64, path: String, lost: u64 } "Recorded {samples} samples to {path}, but {lost} were lost: the disk was too slow.",
        Recorded { samples: u64, path: String, size: String } "Recorded {samples} samples to {path} ({size}).",
        RecordedUntilLost { samples: u64, path: String, size: String } "The recording ended with the link. Recorded {samples} samples to {path} ({size}).",
        RecordedUntilOther { samples: u64, path: String, size: String } "The recording ended: the controller has other channels. Recorded {samples} samples to {path} ({size}).",
        NoThread "Could not open the recording: the system gave no thread.",
        CopiedPicture "The picture is on the clipboard.",
        NothingKept "Nothing was sampled yet: there is no history to save.",
        NoSample { path: String } "Could not open the recording {path}: there is no sample in it. Choose another file.",
        LeftOut { path: String, rows: u64 } "{path}: the oldest {rows} rows are left out; the rest fits in memory.",
        Notes { notes: Sentences } "{notes}",
    }
}

messages! {
    /// How an input pin stands, and what an action of it will do.
    pub enum PinMessage {
        Unread { pin: String } "{pin} measures nothing that is read yet: write its type first.",
        AtGround { pin: String } "{pin} is at its low end now, as a contact is that is closed to ground.",
        AtSupply { pin: String } "{pin} is at its high end now, as a contact is that is closed to 5 V.",
        Reads { pin: String, reading: f64 } "{pin} reads {reading:.0} now.",
        Pulses { pin: String, microseconds: f64 } "{pin} sees pulses of {microseconds:.0} µs now.",
        LowEnd "low end",
        HighEnd "high end",
        AtOnce { pin: String, end: Message, what: Message } "{pin} stands at its {end} now: as soon as this is written, {what}.",
        Later { pin: String, end: Message, what: Message } "Once {pin} is at its {end}, {what}.",
        Unseen { pin: String, end: Message, what: Message } "Where {pin} will stand is not known before its type is written. If that is at its {end}, {what} at once.",
        Stops { which: Message } "{which} stops and stays at rest while it is there",
        Coasts { which: Message } "{which} runs free while it is there",
        TurnsRound { which: Message } "the direction of {which} is turned round",
        NotForward { which: Message } "nothing drives {which} forward",
        NotBackward { which: Message } "nothing drives {which} backward",
        BecomesHome { which: Message, counts: f64 } "the position of {which} becomes {counts:.0}",
        ScriptStarts "the script starts",
        ScriptStops "the script stops",
        ScriptRestarts "the script restarts",
        EStops "an emergency stop holds all motors",
    }
}

messages! {
    /// Why a file has no place in the window.
    pub enum OpenFileMessage {
        TooMany { count: usize, most: usize } "{count} files at once; the first {most} of them were opened.",
        NoDialog "This desktop shows no file dialog. Type the path into the field beside the button, or drop the file on the window.",
        NoSuchLoop { screen: &'static str } "The report is not opened: it belongs on {screen}, which the controller in front does not have as it is set. Disconnect to look at it.",
        NoFirmware { why: &'static str } "The firmware image is not opened. {why}",
    }
}

messages! {
    /// What is said of the traffic's file.
    pub enum TrafficMessage {
        SavedOne { path: String } "Saved 1 transaction to {path}.",
        Saved { count: usize, path: String } "Saved {count} transactions to {path}.",
        NotSaved { path: String, error: String } "Could not save the traffic to {path}: {error}. Choose another folder or name.",
        Shown { shown: usize, all: usize } "{shown} of {all} transactions",
        Dropped { dropped: u64 } ", {dropped} older ones dropped",
        Missed { missed: u64 } ", {missed} packets not recorded while paused",
        NotWritten { refusal: Message } "Cannot be written: {refusal}",
        OneDropped ", 1 older one dropped",
        OneMissed ", 1 packet not recorded while paused",
    }
}

messages! {
    /// What the calibration of an R/C stick waits for.
    pub enum RadioMessage {
        NoPulse "No R/C pulse has been read yet.",
        OffMiddle { milliseconds: f64 } "The middle is {milliseconds:+.3} ms off 1.500 ms. Trim the transmitter until it is there, then go on.",
        NotShorter "The pulse has not become shorter. Pull the stick fully back.",
        NotLonger "The pulse has not become longer. Push the stick fully forward; if it gets shorter, reverse the channel at the transmitter.",
    }
}

messages! {
    /// Why firmware is not sent.
    pub enum FirmwareMessage {
        NotSent { why: Message } "The file is not sent: {why}.",
        ForSimulated "The file is not sent: it was made for simulated controllers.",
        ModelUnknown "The controller's model is not known.",
        ChooseModel "Choose the model that waits in its loader.",
        NotRead "The settings were not read.",
        NoThread { error: String } "Could not start the thread that keeps the backup: {error}.",
        ConnectFirst "Connect the controller first.",
        HoldsWindow "The window stays open: a firmware update runs, and ending it now would leave the controller without firmware.",
        LinkLost "the link was lost.",
        Busy "the controller is busy.",
        NotBegun { why: Message } "The update did not begin: {why} Nothing was erased.",
        NotFromPage "A web page cannot send firmware: the controller would be left in its loader. Do it with Brushwork installed on this computer.",
        CannotSend { why: Message } "{why}: switch the controller off and on.",
        NotFound { path: String, error: String } "Could not read {path}: {error}.",
        PortWaits { product: String } "{product}: waits for firmware, see Device > Firmware",
    }
}

messages! {
    /// How the steps of the guided path stand, and what that is seen by.
    pub enum PathMessage {
        Unread "The settings have not been read yet.",
        Factory "All of it is as the factory has it.",
        Set { motors: String } "Set for {motors}.",
        IfWanted "As the factory has it. Not every axis needs it.",
        HasSwitch "An input pin can stop a motor or tell where it is.",
        NoSwitch "No input pin is a switch. An axis that turns freely needs none.",
        Saved "EEPROM holds what the controller works with.",
        OneDiffers "1 setting in RAM is not in EEPROM.",
        Differs { count: usize } "{count} settings in RAM are not in EEPROM.",
        NothingWritten "Nothing was changed from here since the connection.",
        OneWritten "1 setting was written to RAM and not saved.",
        Written { written: usize } "{written} settings were written to RAM and not saved.",
        BackedUp "The newest backup holds what the controller works with.",
        BackupDiffers "The newest backup holds other settings.",
        NoBackup "There is no backup of this controller on this computer.",
        Along { motors: String } "Motor and encoder turn the same way: seen on {motors}.",
        Against { motors: String } "The encoder counts against its motor: seen on {motors}.",
        LoopIsSet "A loop is set, which works with nothing else.",
        NotTurned "No motor was seen to turn under power yet.",
        Counts { motors: String } "The count follows the shaft: seen on {motors}.",
        NoCount "No count has changed since the connection.",
        BackupMade "The settings are backed up on this computer.",
        BackupNotRead "The settings have not been read, so there is nothing to back up yet.",
    }
}

messages! {
    /// What
    pub enum NameMessage {
        Profile { name: String } "Profile {name}",
        Backup { title: String } "Backup {title}",
        Line { line: u32 } "Line {line}",
        ArmedFor { scope: String } "Armed for {scope}",
        Screen { title: &'static str } "the {title} screen",
        RunLine { number: usize } "run {number}",
        Program { version: &'static str } "Brushwork {version}",
        System { licence: &'static str, system: &'static str, processor: &'static str } "Licence: {licence}. System: {system} on {processor}.",
        Unit { address: String } "unit {address}",
        Run { number: usize } "Run {number}",
        Motor { number: usize } "Motor {number}",
        MotorHead { number: usize } "Motor {number}:",
        Pin { number: usize } "Pin {number}",
        Found { count: usize } "{count} found",
        Of { number: usize, all: usize } "{number} of {all}",
        To { from: String, to: String } "{from} to {to}",
    }
}

messages! {
    /// What
    pub enum ButtonMessage {
        Show { what: String } "Show {what}",
        Exact { name: String } "{name} exact",
        ToZero { name: String } "{name} to zero",
        StopAll { keys: String } "STOP ALL  ({keys})",
        Start { what: String } "Start {what}",
        Copies { text: String } "Copies {text}",
        Revert { title: String } "Revert {title}",
        Measure { motor: Motor } "Measure {motor}",
        SetQpps { motor: Motor } "Set QPPS of {motor}",
        ConnectTo { target: String } "Connect to {target}",
        Open { name: String } "Open {name}",
        Run { program: String } "Run {program}",
        Close { title: String } "Close {title}",
        GoTo { place: String } "Go to {place}",
        GoToSettings "Go to Settings",
    }
}

messages! {
    /// What
    pub enum SpokenMessage {
        Sketch { caption: &'static str } "Sketch: {caption}",
        NoValue { name: String } "{name}: no value",
        Progress { what: String, text: String } "Progress: {what}, {text}",
        TimeLeft { text: String, seconds: f64 } "{text} · {seconds:.0} s left",
        MomentLeft { text: String } "{text} · a moment left",
        Wiring { part: &'static str, wires: String } "Wiring: {part}, {wires}",
    }
}

messages! {
    /// How the link is getting on.
    pub enum LinkMessage {
        Traffic { kbit_per_s: f64, requests_per_s: f64 } "{kbit_per_s:.1} kbit/s, {requests_per_s:.0} requests/s",
        RoundTrip { median: f64, most: f64 } "{median:.2} ms median, {most:.2} ms for 99 %",
        Errors { timeouts: u64, bad_crc: u64, retries: u64 } "{timeouts} time-outs, {bad_crc} bad CRC, {retries} retries",
        Rates { kbit_per_s: f64, requests_per_s: f64 } "{kbit_per_s:7.1} kbit/s {requests_per_s:6.0} req/s",
        InFull { kbit_per_s: f64, requests_per_s: f64, median: f64, most: f64, timeouts: u64, crc_errors: u64, retries: u64, stray: u64, dropped: u64 } "{kbit_per_s:.1} kbit/s, {requests_per_s:.0} requests per second\nRound trip: median {median:.2} ms, 99 % within {most:.2} ms\nTime-outs {timeouts}, CRC errors {crc_errors}, retries {retries}, stray bytes {stray}, samples dropped {dropped}",
    }
}

messages! {
    /// What a field or a figure of one motor is called.
    pub enum MotorFieldMessage {
        Duty { motor: Motor } "{motor} duty",
        Encoder { motor: Motor } "{motor} encoder",
        JogBackward { motor: Motor } "{motor} jog backward",
        JogForward { motor: Motor } "{motor} jog forward",
        JogOnlyBackward "Motor jog backward",
        JogOnlyForward "Motor jog forward",
        Position { motor: Motor } "{motor} position",
        Speed { motor: Motor } "{motor} speed",
    }
}

messages! {
    /// What is said of a packet that is sent by hand, and of its answer.
    pub enum PacketMessage {
        WillSend { text: String } "Will send: {text}",
        Bytes { bytes: String } "Bytes: {bytes}",
        NotSent { why: String } "Not sent: {why}.",
        Answer { answer: String } "Answer: {answer}",
        Write { step: String } "Write: {step}",
        Means { meaning: String } "Means: {meaning}",
    }
}
