//! What window and command line say alike, in its words: one table for each theme.

use brushwork_canopen::NodeId;
use brushwork_link::Message;
use brushwork_link::device::DisarmReason;
use brushwork_values::{Motor, messages};

messages! {
    /// What is tried, as a bare verb phrase, in failures and as the name of a job.
    pub enum CoreActMessage {
        ReadSome { settings: Message } "read {settings}",
        WriteSome { settings: Message } "write {settings}",
        LoadFromEeprom "load the settings from EEPROM",
        SaveToEeprom "save the settings to EEPROM",
        RestoreDefaults "restore the default settings",
        KeepBackup "keep a backup",
        NoteLoan "note what a stop may change for a while",
        MeasureQpps "measure QPPS",
        PlayProfile "play the profile",
        TestClamp "test the voltage clamp",
        GetReady "get ready to tune",
        Tune "tune the motor",
        TryGains "try the gains",
        PutBack "put back what the tuning changed",
        StartNode { node: NodeId } "start {node}",
        OpenLoader "open the line to the firmware loader",
    }
}

messages! {
    /// What came back of what was tried, as a clause.
    pub enum CoreCauseMessage {
        WriterIsGone "the thread that writes files is busy or gone",
        TorqueControl { motor: Motor } "L and R of {motor} are both set, so that its duty is a current",
        BatteryTooHigh { volts: f64, limit: f64 } "the main battery stands at {volts:.1} V, not below the limit of {limit:.1} V",
        CountsDown { motor: Motor, percent: f64 } "{motor} counts down at {percent:.0} % forward duty",
        NoCurrent { motor: Motor, percent: f64 } "{motor} counted nothing up to {percent:.0} % duty and drew no current",
        Blocked { motor: Motor, percent: f64, amps: f64 } "{motor} counted nothing up to {percent:.0} % duty and drew {amps:.2} A, as a motor does that is blocked",
        EncoderUnseen { motor: Motor, percent: f64, amps: f64 } "{motor} counted nothing up to {percent:.0} % duty and drew {amps:.2} A, as a motor does that turns: its encoder is not seen",
        TravelUsed { counts: f64, best: f64 } "the travel limit of {counts:.0} counts was reached and its speed had not settled; the highest so far was {best:.0} counts/s",
        TimeUsed { seconds: f64, best: f64 } "the time limit of {seconds:.0} s was reached and its speed had not settled; the highest so far was {best:.0} counts/s",
        Caught { motor: Motor, best: f64, now: f64, amps: f64 } "{motor} ran at {best:.0} counts/s and then counted {now:.0} counts/s, drawing {amps:.2} A",
        HeldBack { percent: f64 } "the controller gives only {percent:.0} % of the duty that was asked for",
        NotAtRest { setpoint: String, seconds: u64 } "a motor does not come to rest at {setpoint} within {seconds} s",
        NotReached { motor: Motor, counts: f64, seconds: u64 } "{motor} did not reach {counts:.0} counts within {seconds} s",
        GoesAway { motor: Motor, counts: f64 } "{motor} goes away from {counts:.0} counts",
        SlowReading { rate: String, took_ms: u128, longest_ms: u128 } "this line{rate} is too slow or too late for a run: one reading of the motor takes {took_ms} ms, and a run needs one every {longest_ms} ms",
        LateForRun { rate: String, timeout_ms: u128, needed_ms: u128 } "this line{rate} is too slow or too late for a run: a run has the controller stop the motor after {timeout_ms} ms of silence, and a lost reply means {needed_ms} ms on this line",
        NoLoader "no USB device calls itself a loader (…ULDR)",
        TwoLoaders { first: String, second: String } "two loaders are there, {first} and {second}; unplug the one that is not meant",
    }
}

messages! {
    /// What to do, as a sentence without its full stop.
    pub enum CoreRemedyMessage {
        StartAgain "Start the program again",
        ThenTryAgain "Then try again",
        ClearWindingForTest "Set L or R to 0 for the test",
        ClearWinding "Set L or R to 0 for the measurement",
        RaiseLimit "Set a limit above the supply",
        ChangeLeads "Change round the two motor leads, or the encoder's A and B, not both, and measure again",
        CheckLeads "Check the motor's leads, its fuse and its power",
        FreeShaft "Free the shaft. If it did turn, check the encoder's plug, supply and pins",
        CheckEncoder "Check the encoder's plug, its supply, and which pins it is assigned to in General Settings",
        AllowTravel "Allow more travel if there is room, or enter an estimated QPPS by hand",
        AllowTime "Allow more time, or take load off the motor",
        LookAtShaft "Look whether the shaft is blocked or the encoder has lost its plug",
        CheckAdapter "Check the adapter's cable",
        SeeLimits "A limit of current, voltage or temperature holds it back: see the indicators and General Settings",
        TuneLoop "Tune the position loop, or widen its deadzone",
        GoFaster "Go faster, or choose points that are nearer",
        QuickerLine "Connect by USB or at 115200 bit/s, with no radio and no network on the way, or set the gains by hand",
        TurnEncoder "Its encoder counts the wrong way: change round the two motor leads, or the encoder's A and B",
    }
}

messages! {
    /// What is said after a tuning run.
    pub enum TuneMessage {
        LeftOff "The controller's loop did not hold the motor still with the old gains, so its output is left switched off (DISABLEPID in FUNCTION, in RAM): the motor stands, but nothing holds it. The next Arm or `drive` switches the loop on again, and so does a reset of the unit.",
    }
}

messages! {
    /// What is said of what happens on a link.
    pub enum CoreStatusMessage {
        Because { why: Message } "{why}.",
        Stopping { reason: DisarmReason } "{reason}. The motors are being stopped.",
        Stopped { reason: DisarmReason } "{reason}.",
    }
}

messages! {
    /// What became of a recording's file.
    pub enum RecordingMessage {
        NotRecorded { path: String, error: String, remedy: Message } "Could not record to {path}: {error}. What was written before that is kept. {remedy}.",
        MakeRoom "Make room on the disk, or choose another folder",
        NotPermitted "Choose a folder that you may write to",
        Elsewhere "Choose another folder",
        InPart { damage: DamageMessage, seconds: f64 } "The file {damage} after {seconds:.3} s; what stands before that is shown.",
    }
}

messages! {
    /// What is wrong with a recording, as a predicate.
    pub enum DamageMessage {
        Senseless "holds a record that makes no sense",
        CutOff "ends in the middle of a block",
        CutOffInLine "ends in the middle of a line",
        Damaged "is damaged",
    }
}

messages! {
    /// What of a stop is not plain.
    pub enum StopMessage {
        NotConfirmed { unit: String } "{unit} did not confirm the stop. Cut the motor power.",
        Of { unit: String, text: Message } "{unit}: {text}",
    }
}

messages! {
    /// How often an EEPROM was written.
    pub enum WearMessage {
        None "No save to this EEPROM was counted yet.",
        One { since: String } "1 save to this EEPROM was counted, {since}.",
        Saves { saves: u64, since: String } "{saves} saves to this EEPROM were counted since {since}.",
        Half { count: Message, endurance: u64 } "{count} It is half worn if it is flash that stands in for EEPROM; save only what is to last (assumed: {endurance} writes).",
        EarlierLost { count: Message } "{count} What was counted before is lost: its file was damaged and is put aside. Take it for more than that.",
        Worn { count: Message, endurance: u64 } "{count} It may be worn out; check after each save that it took, and save only what is to last (assumed: {endurance} writes).",
    }
}

messages! {
    /// What becomes of an update of the firmware.
    pub enum UpdateMessage {
        Begun { unit: String, place: String, file: String, model: String, backup: String } "An update of the {unit} at {place} was begun and did not end. It may wait in its firmware loader, where it answers nothing else (STAT1 and STAT2 light in turns). Switch it off and on; if it still does not answer, resume the update: brushwork firmware update {file} --connect {place} --resume --model {model}. Its settings are in the backup {backup}. Should a controller of another family be there now, name it: family=KEY.",
        NotKept { error: Message, unread: Message } "{error} {unread}",
        Updated { from: String, to: String } "The firmware is updated: {from} before, {to} now.",
        Runs { version: String } "The controller runs {version}.",
        NotChanged { version: String } "The version did not change: the controller still calls itself {version}. That all pages were confirmed does not mean that the file was firmware for it. Check the file, then update again.",
        Unexpected { announced: String, found: String } "The firmware is not the one that was sent: the image is version {announced}, and the controller calls itself {found}. Check the file, then update again.",
        NotCompared { why: Message } "The settings could not be compared with the backup: {why}",
        AsInBackup "The settings are as they are in the backup.",
        OneDiffers "1 setting differs from the backup:",
        Differ { count: usize } "{count} settings differ from the backup:",
        NotWaited "it was not waited for.",
        NobodyAnswered "No unit answered.",
        NoThread { error: String } "Could not start the thread that sends the firmware: {error}. Nothing was erased",
    }
}

messages! {
    /// What is said of the nodes of a bus.
    pub enum BusMessage {
        Operational { node: NodeId } "The start was sent, and {node} says that it is operational.",
        Still { node: NodeId, state: String } "The start was sent, and {node} still says that it is {state}. Look into its own tool why it does not start.",
        NotTold { node: NodeId } "The start was sent. {node} sends no heartbeat that would tell what came of it.",
        NotListed { seconds: u64 } "Could not list the nodes: the search did not end within {seconds} s.",
        NoAdapter { target: String } "{target} is no CAN adapter. Write can: in front of an adapter's port.",
    }
}

messages! {
    /// Why a side of a comparison has no settings.
    pub enum SideMessage {
        EepromUnknown "What the EEPROM holds is not known: it is known after a save or a reload that was proven on this computer.",
    }
}

messages! {
    /// Why a unit is not given an address.
    pub enum AddressMessage {
        NobodyWaits { place: String } "No unit was found on {place} that waits for an address. Connect it, see that it has power, and try again.",
        Taken { address: String, place: String } "{address} was not given to another unit: one answers there on {place} already. Give that one another address first.",
        Garbled { unit: String } "Nothing was written: the replies of {unit} are garbled, as those of two units at one address are. Connect one alone; if they are garbled then too, look at the wiring, the ground and the baud rate.",
        CannotHave { unit: String, address: String } "Nothing was written: {unit} cannot be given the address {address} over this line. In an R/C or analog mode it may have switches in its place.",
    }
}

messages! {
    /// What of a profile is not for all of several controllers.
    pub enum ForAllMessage {
        AddressKept { title: String } "Left out of the profile, since each of several controllers keeps its own: {title}.",
    }
}

messages! {
    /// What is said of numbers that are written raw.
    pub enum RawMessage {
        Warning "What this number means is not public: the controller may take it for anything, and a motor may move when something commands it. Take the load off, keep a hand on the power, and save it to EEPROM only when it does what you want.",
        CutOffTaken { key: String, date: String, command: u8, wanted: i64, before: String } "The raw number {wanted} was written to {key} on {date}, by command {command} in place of {before}, and cut off before it was read back. The register holds it.",
        CutOffNotTaken { key: String, date: String, command: u8, wanted: i64, before: String } "The raw number {wanted} was to be written to {key} on {date}, by command {command}, and that was cut off. The register holds {before} as before.",
        CutOffOther { key: String, date: String, command: u8, wanted: i64, before: String, now: String } "The raw number {wanted} was written to {key} on {date}, by command {command} in place of {before}, and cut off before it was read back. The register holds {now} now.",
    }
}

messages! {
    /// Why a unit is not examined.
    pub enum ExamineMessage {
        NoQuestions { unit: String } "There are no questions for a {unit} yet.",
    }
}

messages! {
    /// Why a motion profile is not played.
    pub enum ProfilePlanMessage {
        TooLong { seconds: f64, longest: u64 } "This would take {seconds:.0} s, more than the {longest} s allowed. Choose a lower count or a shorter dwell.",
        Bounds "Dwell is 0.1 to 60 s, count 1 to 1000.",
        NoTravel "From and To are the same, so nothing would move. Choose two different values.",
        OutOfReach { low: f64, high: f64, unit: &'static str } "The setpoints of the chosen motors go from {low:.0} to {high:.0} {unit}. Choose values in between.",
        NoSpeed "The speed between the two points is 0. Choose how fast to go.",
        NoAcceleration "A trapezoid needs an acceleration other than 0. Set it beside the sliders.",
        NoQpps "QPPS is 0, so no position can be reached. Set QPPS first.",
        NoMotor "No motor is chosen. Tick at least one.",
        NoReach { motor: Motor } "{motor} has no range of setpoints yet. Set and apply its settings first.",
        Plays "A profile is playing already.",
        JobRuns "A job runs already. Wait for it or cancel it.",
    }
}

messages! {
    /// What was commanded, as a noun.
    pub enum CommandedMessage {
        Duty { percent: f64 } "a duty of {percent:.1} %",
        Speed { speed_counts_per_s: i32 } "a speed of {speed_counts_per_s} counts/s",
        Distance { distance_counts: u32 } "a move by {distance_counts} counts",
        Position { position_counts: i32 } "a move to {position_counts}",
    }
}

messages! {
    /// That a motor does not do what it was told.
    pub enum MotionMessage {
        NoOutput { motor: Motor, commanded: Message, why: Message } "{motor} gets no output, though {commanded} was commanded and confirmed. {why}",
        Friction { motor: Motor, output: Message } "{motor} {output}: so little may not break it loose from its friction. Give more, or see that it is free.",
        NoCounts { motor: Motor, output: Message } "{motor} {output}, and no counts came since the connection: it does not move, or has no encoder that this controller reads.",
        OpenLead { motor: Motor, output: Message } "{motor} {output}: hardly any current flows, so look for an open motor lead.",
        Blocked { motor: Motor, output: Message } "{motor} {output}: it is blocked, at an end stop, carries more than this output moves, or its encoder has ceased to count. Free the shaft, or check the encoder.",
        BlockedAtLimit { motor: Motor, output: Message } "{motor} {output}, at its current limit: it is blocked, at an end stop, carries more than this output moves, or its encoder has ceased to count. Free the shaft, or check the encoder.",
        LimitCycle { motor: Motor, low: f64, high: f64, reversals: usize, seconds: f64, commanded: Message } "{motor} swings to and fro in a limit cycle: its loop gives {low:.0} % and {high:.0} % in turn ({reversals} reversals in {seconds:.1} s), though {commanded} was commanded. Its gains are too high for this machine, or its encoder counts the wrong way: lower them, or tune the loop.",
    }
}

messages! {
    /// How a motor stands that should turn, as a predicate.
    pub enum StandsMessage {
        AtOutput { percent: f64 } "stands still at an output of {percent:.1} %",
        Untold { commanded: Message } "stands still; {commanded} was commanded, and this firmware does not tell its output",
        WithCurrent { output: Message, amps: f64 } "{output} and {amps:.2} A",
    }
}

messages! {
    /// Why a motor may get no output.
    pub enum NoOutputMessage {
        StartedAnew "The controller has restarted, as its counts show, which begin at 0 again: its power was lost for a moment. Check the supply and its leads. What was not saved is forgotten.",
        Left "a fault of the bridge that it does not report (a driver fault, a short circuit), a loss of power for a moment, or an input or script that holds the motor. Check the motor and its leads, look at `brushwork status`, and switch the controller off and on before the next try.",
        LeftOfLoop "a fault of the bridge that it does not report (a driver fault, a short circuit), a loss of power for a moment, gains or a full speed (QPPS) of 0, or an input or script that holds the motor. Check the motor and its leads, look at `brushwork status`, and switch the controller off and on before the next try.",
        Untold { left: Message } "This firmware does not tell its status, so the reason is not known; it may be {left}",
        NotNamed { left: Message } "Its status names no reason. What is left is {left}",
        Named { titles: String, left: Message } "It reports: {titles}. If that is not the reason, it is {left}",
    }
}

messages! {
    /// What is wrong with the file of a tuning report.
    pub enum ReportFileMessage {
        NotWritten { path: String, error: Message } "Could not write the report to {path}: {error}. Choose another place.",
        NotRead { path: String, why: Message } "Could not read a report from {path}: {why}",
        NoFile { error: String } "{error}. Choose a file that a tuning run wrote.",
        Newer { format: u32, known: u32 } "it is a report of form {format}, written by a newer Brushwork; this one knows form {known}. Update Brushwork.",
        Lacks { missing: &'static str } "it holds no {missing}, so it is no tuning report. Choose a file that a tuning run wrote.",
        WrongField { line: usize, column: usize, field: String, what: String } "line {line}, column {column}, field {field}: {what}. It was changed, or written by another version.",
        WrongValue { line: usize, column: usize, what: String } "line {line}, column {column}: {what}. It was changed, or written by another version.",
        Empty "it is empty. Choose a file that a tuning run wrote.",
        CutShort { line: usize, column: usize } "it is cut short: it ends at line {line}, column {column}. Save the report again.",
        NoReport { line: usize, column: usize, what: String } "line {line}, column {column}: {what}. It is no tuning report, or was changed.",
        NoJson { line: usize, column: usize, what: String } "line {line}, column {column} is no JSON: {what}. Choose a file that a tuning run wrote.",
    }
}

messages! {
    /// What broke into work before its end, as a clause.
    pub enum EndedMessage {
        Stopped "it was stopped",
        StopPressed "Stop was pressed",
        ScreenLeft "the screen was left or disarmed",
        Cancelled "it was cancelled",
        LinkCloses "the link is being closed",
        OtherUnit "another unit was chosen",
        WindowCloses "the window is being closed",
        LinkLost "the link was lost",
        DeadMan "this computer answered late: the window did not renew the motion within 250 ms",
        Disarmed "it was disarmed",
        LinkClosed "the link was closed",
        TookLong "it took too long",
        NotArmed "it could not be armed again with the time-out of a run, 200 ms of silence; where that is too short for the line, connect by USB or at 115200 bit/s, with no radio and no network on the way",
    }
}

messages! {
    /// Why a file is not opened.
    pub enum KnownFileMessage {
        NoFile { path: String } "{path} is not opened: it is a folder, a device or a pipe, and no file.",
        NotRead { path: String, error: String } "{path} is not opened: {error}. Check the path and your rights.",
        TooLong { path: String, mebibytes: u64 } "{path} is not opened: it has more than {mebibytes} MiB, and no profile, report, script or firmware image is as long.",
        OtherJson { path: String } "{path} is not opened: it holds neither the settings of a controller nor a tuning report.",
        Unknown { path: String } "{path} is not opened: it is no profile, backup or tuning report (.json), no recording (.bwr, .csv), no script (.mcl, .mecc) and no firmware image (.bin).",
    }
}
