//! What the command line says beside what its data says, in its words.

use brushwork_link::transport::TargetError;
use brushwork_link::{Failure, FirmwareGeneration, Message};
use brushwork_values::messages;

messages! {
    /// What is said of settings, their copies and their backups.
    pub enum CliSettingsMessage {
        StreamUnknown "It is not known which of the controller's streams this port is wired to; if it is one that changes, the link may be lost. A target such as /dev/ttyUSB0,stream=ttl1 says it.",
        NobodyToAsk { question: String } "{question} There is no terminal to ask at: give --yes to do it. Nothing was written.",
        StoppedAsking "\nNothing was written.",
        NotWritten "Nothing was written.",
        NoBackupOfThis "There is no backup of this controller yet. `brushwork settings backups` lists those of others.",
        NoBackup "There is no backup of this controller yet.",
        BackupIs { name: String, unit: String } "Backup {name} ({unit}).",
        NoSuchBackup { name: String } "There is no backup {name}. `brushwork settings backups` lists them.",
        SeveralBackups { name: String } "More than one backup begins with {name}. `brushwork settings backups` lists them.",
        ComparedAs { right: String, left: String } "{right} is compared as it would be on the controller of {left}:",
        UnknownModel { unit: String, port: String, version: String } "The unit at {unit} on {port} calls itself \"{version}\", which is no model that this program knows: its settings are not known.",
        NotRead { keys: String, failure: Failure } "Not read: {keys}. {failure}",
        Listed { sentence: String } "  {sentence}",
        AndMore { count: usize } "  ... and {count} more.",
        SeeUnfinished "`brushwork settings unfinished` shows all of it and settles it with --finish, --undo or --forget.",
        DidNotEnd { act: &'static str, begun: String, port: String } "A {act} that was begun on this controller on {begun} did not end: `brushwork settings unfinished --connect {port}` tells which of its settings are old and which are new.",
        NotGivenBack { begun: String, port: String } "What a run that was begun on this controller on {begun} had changed for its own time was not given back: `brushwork settings unfinished --connect {port}` tells what is left, and with --undo gives it back.",
        OneOrTwo "One or two profiles can be compared.",
        OnOneSide { keys: String } "Not compared, since only one side has them: {keys}",
        OtherKind { left: String, one: String, right: String, other: String } "Note: {left} is of {one}, {right} of {other}.",
        NotSaved { failure: Failure } "Nothing was saved. {failure}",
        WearLost { fault: String } "Note: {fault}",
        EepromLost "What EEPROM holds is not known. What was written and not saved is lost.",
        Note { note: String } "Note: {note}",
        Wear { wear: Message, limits: &'static str } "Note: {wear} {limits}",
        RawUndo { before: i64 } "`brushwork settings raw --undo` writes the previous {before}.",
        RawNotReadBack { key: String, date: String, wanted: i64, port: String } "The raw number {wanted} was written to {key} of this controller on {date} and not read back: `brushwork settings read --connect {port}` tells what the register holds.",
        NoRawNumber "No raw number was written to this controller from this computer.",
        NotInProfile "What could not be read is not in the profile.",
        Warning { conflict: String } "Warning: {conflict}",
        Fitted "The profile has to be changed to fit this controller:",
        NotFitting { unit: String, error: String } "The profile does not fit {unit}, nothing was changed:\n{error}",
        OneAddress "An address is given to one controller at a time: `brushwork address` does it.",
        NothingWritten "Nothing was written:",
        NotSavedEither "The settings were not saved to EEPROM, since not all of them took.",
        EndedEarly { failure: String } "Writing ended early. {failure}",
    }
}

messages! {
    /// What is tried, as a bare verb phrase.
    pub enum CliActMessage {
        WriteSettings "write the settings",
        SaveSettings "save the settings",
        RestoreDefaults "restore the defaults",
    }
}

messages! {
    /// What is said of the link and of moving motors.
    pub enum CliLinkMessage {
        OneFamily { addresses: String } "Could not understand --address: a line has controllers of one family: {addresses}.",
        OneAtATime "This goes to one controller at a time: give one --connect, and one --address or none.",
        NotStoppedAt { place: String } "{place} was not found to be stopped.",
        NoTarget { target: String, error: TargetError } "Could not understand --connect {target}: {error}.",
        NoneIdentified { seconds: u64 } "Could not connect: no controller identified itself within {seconds} s.",
        LooksElsewhere "No unit answers at the address of a new controller: asking at all others.",
        FoundElsewhere { unit: String, place: String } "{unit} answers at {place}.",
        SeveralElsewhere { places: String } "Could not choose a controller: several answer, at {places}. Say which with --address.",
        Closed "The link was closed.",
        NoThread { error: String } "The system gave no thread to wait on: {error}. Close other programs and try again.",
        NotAsked { refused: String } "Could not ask the controller: {refused}",
        NoAnswerWithin { seconds: u64 } "The controller did not answer within {seconds} s.",
        NotMoved { unit: String, port: String, clause: String } "Could not move the motor of {unit} on {port}: {clause}.",
        NoAnswer "The link gave no answer.",
        NotConfirmedByAll "The stop was written to all of them, but none confirmed it. If a motor runs, cut its power.",
        NotConfirmed { seconds: u64 } "Stop was sent, but the controller did not confirm it within {seconds} s. Cut the motor power.",
        By { holder: String } "The line is held by {holder}, which was asked to stop it.",
        HolderHalted { holder: String, process: u32 } "The line is held by {holder}, which was halted by a signal and does not answer. Had it been driving a motor, its guardian would have ended it and stopped the motor; where it has none, which arming had said, the controller's own time-out does. End it (kill -9 {process}) and stop again. If a motor runs, cut its power.",
        HolderSilent { holder: String, process: u32 } "The line is held by {holder}, which does not answer: it stands still. Had it been driving a motor, its guardian would have ended it and stopped the motor; where it has none, which arming had said, the controller's own time-out does. End process {process} and stop again. If a motor runs, cut its power.",
        NoCtrlC { error: String } "Could not take over Ctrl-C, without which motors could not be stopped: {error}.",
        GuardianByHand "`brushwork guardian` is started by the program itself, for a line that it arms.",
        NoQpps "The motor's QPPS is 0, so a position move would not move. Give --speed-limit or set QPPS first.",
        NoTerminal { title: String } "{title} takes no typed commands; they are put together in the window's Traffic screen.",
        TerminalOf { title: String, unit: String, port: String, set_up: String } "{title} {unit} on {port}: {set_up}.",
        TerminalStops "Note: the motor is stopped for this, and what it changes in EEPROM stays.",
    }
}

messages! {
    /// What is said where a command goes to several controllers.
    pub enum CliUnitsMessage {
        Begins { unit: String } "{unit}:",
        NoneAt { place: String } "No controller was found on {place}.",
        NotAllThere { addresses: String, place: String } "Nothing was moved: no unit answers at {addresses} on {place}. All that are named have to be there to move together.",
        Of { unit: String, sentence: String } "{unit}: {sentence}",
        Silent { addresses: String, place: String } "No unit answers at {addresses} on {place}.",
        NotBegun { units: String } "Not begun on {units}, since it failed before.",
        NotTillTheEnd { units: String, of: usize } "Not done to the end on {units}, of {of} asked for.",
        NoneWritten "Nothing was written to any of them, since this was not to be had from all. Leave out who cannot take it, by --address.",
        WriteToAll { count: usize } "Write these changes, each to its own of the {count} controllers?",
        WriteToAllAndSave { count: usize } "Write these changes, each to its own of the {count} controllers, and save all settings of each to EEPROM?",
    }
}

messages! {
    /// What is said where controllers are given addresses.
    pub enum CliAddressMessage {
        NobodyConnects "There is no terminal to ask for one unit after the other at: give one address at a time.",
        Connect { address: String } "Connect the unit that is to answer at {address}; no other may be on the line that still waits for its address. Then press Enter.",
        SeveralMeant { units: String, place: String } "Several units answer on {place}, at {units}. Say which is meant with --address, or connect it alone.",
        NotGiven { address: String } "The address {address} was not given, or not saved.",
        NotThereYet { address: String, old: String } "The address {address} was written, but no unit answers there. Switch the unit off and on, and look at {address} and {old} with `brushwork status`.",
    }
}

messages! {
    /// What became of work on the controller.
    pub enum CliJobMessage {
        NoStep { named: String, steps: String } "There is no step \"{named}\" to agree to. The steps are {steps}.",
        StepPutBack "What the step had changed is as it was before, as reading it has shown.",
        NotToTheEnd { act: Message, cause: String } "Could not {act} to the end: {cause}.",
        Internal { act: Message, word: String } "Could not {act}: an internal error ({word}). Please report it.",
        NotInTime { act: Message } "Could not {act}: it did not end in its time.",
        NotBegun { act: Message, refused: String } "Could not {act}: {refused}",
    }
}

messages! {
    /// What is said of models and of firmware.
    pub enum CliFirmwareMessage {
        NoModel { name: String } "\"{name}\" is no model. `brushwork sim --list` names them.",
        NoCanPort { model: &'static str } "A {model} has no CAN port, so that there is no data sheet of it as a node.",
        NoImage { error: String } "Could not make the image: {error}.",
        NotSentFor { why: String } "{why} Nothing was sent.",
        FileNotSent { file: String, why: String } "{file} is not sent: {why}.",
        ReadThis "Before you update, read this:",
        Risk { risk: String } "  - {risk}",
        AcceptRisk "There is no terminal to ask at: give --accept-risk to update all the same. Nothing was sent.",
        NotSent "Nothing was sent.",
        NotEntered { refused: String } "Could not enter the firmware loader: {refused}",
        LoaderLate "Could not enter the firmware loader: the controller did not get there in time. Nothing was erased.",
        GoesOn "\nThe update cannot be stopped now: the controller would be left without firmware. It goes on.",
        Failed { failure: Failure } "\n{failure}",
        InternalError "Could not send the firmware: an internal error. Please report it.",
        Waiting "Waiting for the controller to come back.",
        NotBack { why: String } "The controller did not come back, so it is not known whether the update is good: {why}",
    }
}

messages! {
    /// What is said of scripts.
    pub enum CliScriptMessage {
        OneOutput "--output names one image, but several scripts are given. Leave it out, or build one at a time.",
        NoName "A script on standard input has no name: say with --output where the image goes.",
        NotRead { file: String, error: String } "Could not read {file}: {error}.",
        Faulted { file: String, line: u32, what: String } "{file}:{line}: the script was stopped by a fault: {what}.",
        Ran { how: String, seconds: f64, instructions: u64 } "{how}; {seconds:.3} s of controller time, {instructions} instructions",
        NotUsed { file: String, error: String } "Could not use {file}: {error}.",
        Stopping { reason: String } "{reason}. The script and both motors are being stopped.",
        AutorunInRam "It is in the controller's RAM; `brushwork settings save` saves it with the other settings.",
    }
}

messages! {
    /// What is said of MeccCode programs, and where that of a board is started.
    pub enum CliMeccMessage {
        NoBoard { unit: String, port: String } "Nothing was started: {unit} on {port} is no MotorVator, which alone starts a program by G.",
        Start { port: String } "Start the program in the memory of the board on {port}? It may move motors at once, and unless it is the host library nothing on this line stops it: keep the switch of the motors' power at hand.",
        LibraryRuns { version: u8, port: String } "The host library {version} runs on the board on {port}, which can be driven now.",
        OtherRuns { port: String } "The line was sent to the board on {port}. The host library does not answer: whatever runs there now is not driven from here.",
        Lost { count: u64 } "{count} transmissions were lost, each since the one before it was still under way: send from the handler of TransmitEvent.",
        BoardSays { words: String } "The board's command line says: {words}",
        TraceFull { bytes: usize } "The trace ends early: it has {bytes} MB.",
    }
}

messages! {
    /// What is said of simulated controllers.
    pub enum CliSimMessage {
        EepromNotKept { file: String, error: String } "Could not keep the EEPROMs in {file}: {error}.",
        UsbHasNoBaud "A USB port has no baud rate: give --baud with --port rs232, ttl1, ttl2 or ttl3.",
        NotStarted { why: String } "Could not start the simulated controller: {why}.",
        NotDone { line: String, error: String } "Could not do \"{line}\": {error}.",
        NoAddress { address: String } "\"{address}\" is no address to listen on. Use for example --tcp 127.0.0.1:7000.",
        NoFault { text: String, error: String, syntax: &'static str } "Could not read --fault {text}: {error}.\n\n{syntax}",
        CtrlCEnds "Ctrl-C ends it.",
        Ended "The simulated controller has ended by itself.",
    }
}

messages! {
    /// What is said of traffic that is watched.
    pub enum CliMonitorMessage {
        NotDecoded { name: String, sentence: String } "Could not decode {name}: {sentence}.",
        Watches { title: String, unit: String, port: String, generation: FirmwareGeneration } "{title} at {unit} on {port} ({generation})",
        Between { place: String, name: String } "Between {place} and {name}: let the other program open {place}. Ctrl-C ends it.",
        LinkLost { name: String, lost: String } "Lost the link to {name}: {lost}. Check the cable and start the monitor again.",
        NotBetween { what: String } "Could not stand between another program and the controller: {what}.",
        LeftOut { count: u64 } "{count} lines were left out: they came too fast.",
        ClientLeft "The other program closed the port.",
    }
}

messages! {
    /// What is said of tuning.
    pub enum CliTuneMessage {
        ReportNotWritten { why: String } "Could not write the report: {why}.",
        Ended { cause: String } "The run was ended: {cause}. The motors were stopped.",
        BegunAgain "This computer answered late: the program did not renew the motion within 250 ms, and the motors were stopped. The run begins again.",
        Internal { word: String } "Internal error while tuning: {word}. The motors were stopped.",
        NotTuned { why: String } "The motor was not tuned: {why}.",
        NotForPiv "The controller's own test gives gains of a PD or PID loop, not of PIV: give --method pd or --method pid with --identify controller.",
        TwoIdentifications "A motor is identified by a step or by a relay, not by both: --method and --identify name one each. Give --method pd, pid or piv with --identify.",
        NoTravel "A position loop is not tuned without saying how far the axis may go: give --travel LOW..HIGH in counts, or --turns-freely where it has no end stops and may be driven at full duty both ways. The whole range of an absolute encoder is --encoder absolute.",
        NotPutBack "What the tuning changed could not be put back: `brushwork settings unfinished` tells what is left.",
        PutBack "The old gains and settings are in force again, as reading them back has shown.",
        NotInTime "The run did not end in its time.",
        OtherRecord { file: String, entry: usize, of: usize } "The record in {file} does not belong to this version of the tuner, or was changed: at its entry {entry} of {of} the tuner asks for another step. Tune again.",
        SameResult "The replay gives the same result to the last bit.",
        OtherResult { file: String, parts: String } "The replay gives another result than {file} holds: it differs in {parts}. The report was changed, or was made by another version of the tuner or on another kind of computer.",
    }
}

messages! {
    /// What of a stop was not reached.
    pub enum CliStopMessage {
        NotHeard { addresses: String } "No unit answered at {addresses}: the stop was written there too, and whether it was heard is not known. If a motor runs there, cut its power.",
        OtherNodes "Nodes that do not answer as a controller that this program knows were told nothing.",
        Broadcast "Units that do not answer were told to stop by a broadcast, which no unit confirms.",
        Silent { addresses: String } "No unit answered at {addresses}; the stop was written to these addresses too.",
        NotLookedFor { addresses: String } "The stop was written to {addresses} too, where that program may not have looked for units.",
    }
}

messages! {
    /// What is said of macro files.
    pub enum CliMacroMessage {
        NotRead { name: String, error: String } "Could not read {name}: {error}.",
        NotWritten { name: String, error: String } "Could not write {name}: {error}.",
        NotRun { name: String, error: String } "Could not run {name}: {error}.",
        NoMacros { name: String } "{name} has no macros.",
        NoMacro { name: String, wanted: String, names: String } "{name} has no macro {wanted}. It has {names}.",
        NoPreset { clause: String } "{clause}.",
        Ended { took_s: String, counts: i64 } "Ended after {took_s} s at {counts} counts.",
        Refused { took_s: String, error: String } "The controller refused a command after {took_s} s: {error}.",
        LetGo { took_s: String, counts: i64 } "The controller let the motor go after {took_s} s at {counts} counts: its position lagged further behind than SM allows.",
        TimeIsUp { took_s: String, counts: i64 } "Still running after {took_s} s at {counts} counts. --for lets it run longer.",
        KeepsNone { title: String } "{title} keeps no macros of this kind.",
        MacroRuns "A macro is running or waiting, and a line would end it: nothing was sent. `brushwork stop` ends it.",
        NotStored { name: String, number: u8 } "{name} was sent as macro {number} and does not read back as it was sent: the controller did not store it.",
        NoReportOfLine "No answer that makes sense came from the controller. Check the line and try again.",
        NoReport { command: String } "No answer that makes sense came to {command}. Check the line and try again.",
        TooManySteps { took_s: String, steps: usize } "Still running after {took_s} s and {steps} commands, of which no more are printed.",
    }
}
