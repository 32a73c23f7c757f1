//! What this crate says to people, in its words: one table for each theme.

use crate::device::ArmScope;
use crate::unit::{FirmwareGeneration, UnitAddress};
use brushwork_values::{Listed, Message, messages};

messages! {
    /// Why a value is none for a setting, and what becomes of it.
    pub enum ValueMessage {
        OfRow { title: String, why: Message } "{title}: {why}",
        NoChoice { text: String } "'{text}' is not a choice.",
        NoneOf { text: String, keys: String } "'{text}' is none of {keys}.",
        NoneOfNorNumber { text: String, keys: String } "'{text}' is none of {keys}, and no number.",
        NoWholeNumber { text: String } "'{text}' is not a whole number.",
        NoWholeNumberOf { text: String, unit: &'static str } "'{text}' is not a whole number of {unit}.",
        NoNumber { text: String } "'{text}' is not a number.",
        NoNumberOf { text: String, unit: &'static str } "'{text}' is not a number of {unit}.",
        NeitherYesNorNo { text: String } "'{text}' is neither yes nor no.",
        OtherKind { title: String, value: String, kind: &'static str } "{title}: {value} is not a {kind}.",
        UnknownCode { title: String, raw: i64 } "{title}: {raw} is none of the values known for it, so it is not written.",
        UnknownCodeAsRead { title: String, raw: i64 } "{title}: {raw} is none of the values known for it. It is written as it was read.",
        AboveModel { title: String, value: String, model: &'static str, bound: String } "{title} {value} is above the {model}'s {bound}.",
        BelowModel { title: String, value: String, model: &'static str, bound: String } "{title} {value} is below the {model}'s {bound}.",
        AboveHighest { title: String, value: String, bound: String } "{title} {value} is above the highest value, {bound}.",
        BelowLowest { title: String, value: String, bound: String } "{title} {value} is below the lowest value, {bound}.",
        AsRead { why: Message } "{why} It is written as it was read.",
        Repaired { why: Message, value: String } "{why} {value} is used instead.",
    }
}

messages! {
    /// Why changes are not planned, and what to know of a plan.
    pub enum PlanMessage {
        NoCommandFor { title: String, reason: &'static str } "{title} cannot be written raw either: no known command carries it. {reason}",
        NoSuchSetting { model: &'static str, generation: FirmwareGeneration, key: String } "The {model} with firmware {generation} has no setting {key}.",
        Locked { title: String, reason: &'static str } "{title} is not written. {reason}",
        NoRoom { titles: String, why: Message } "{titles} cannot be written: {why}.",
        TooManyBits { raw: i64, width: u8 } "{raw} takes more than {width} bits",
        UnknownNeighbour { wanted: String, neighbour: String } "{wanted} cannot be written, since {neighbour} shares its command and its value is not known.",
        WrongOrder { low: String, low_value: String, high: String, high_value: String } "{low} {low_value} would be above {high} {high_value}.",
        BothAsRead { why: Message } "{why} Both are written as they were read.",
        NewAddress "The controller answers to its new address from then on; save it, or a power cycle brings the old one back.",
        OwnInput { title: String } "{title} stays: each motor has an input of its own.",
        NotCopied { title: String, why: Message } "{title} is not copied. {why}",
        CannotBeCopied { title: String, reason: &'static str } "{title} is not copied. {reason}",
    }
}

messages! {
    /// What became of a write.
    pub enum WriteMessage {
        Taken { title: String, wanted: String } "{title} is {wanted}.",
        NotTaken { title: String, wanted: String, found: String } "{title} was to be {wanted} and is {found}: the controller acknowledged it and did not take it.",
        NotTakenFor { title: String, wanted: String, found: String, why: Message } "{title} was to be {wanted} and is {found}. {why}",
        NotSent { title: String, wanted: String, why: Message } "{title} was to be {wanted} and was not sent. {why}",
        Unverified { title: String, wanted: String, why: Message } "{title} was set to {wanted} and not read back. {why}",
        Disturbed { title: String, before: String, now: String } "{title} changed from {before} to {now}, which was not asked for.",
        DisturbedByRestart { difference: String } "{difference}, which was not asked for. The controller seems to have restarted meanwhile.",
        LostAgain "It had been taken and was lost again: the controller seems to have restarted meanwhile.",
        Moved { address: UnitAddress } "The controller is at {address} now; connect to it there.",
        AnswersNowhere "The controller answers neither to its old nor to its new address.",
        NoHiddenSettings "This controller does not let its hidden settings be set.",
        HiddenRefused { sentence: String } "{sentence}",
    }
}

messages! {
    /// What is to be known of who stops the motors when this program dies.
    pub enum GuardMessage {
        Missing { detail: String } "No second process watches over this line ({detail}): if this program dies, nothing but the controller's own time-out stops the motors.",
        InPage { timeout_ms: u128 } "A closed tab cannot stop a motor. The page writes the stop when it is hidden or closed; where that does not get out, the controller stops the motors itself, {timeout_ms} ms after it last heard from here.",
    }
}

messages! {
    /// What became of a save to EEPROM.
    pub enum SaveMessage {
        Verified "The settings are saved; they were read back from EEPROM.",
        Acknowledged "The controller acknowledged the save. It did not answer when asked to load its EEPROM, so the save is not proven; that happens after good saves too.",
        Stored "The settings are saved: each register was acknowledged as stored and read back. EEPROM itself is read at a new start alone: load the settings from EEPROM to prove it.",
        ReadOtherwise { settings: Message } "The save did not take: {settings} read otherwise afterwards. Save again.",
        CameBackOtherwise { settings: Message, now: Message } "The save did not take: {settings} came back from EEPROM otherwise. {now}",
        Differs { difference: String } "{difference} (wanted, then what EEPROM holds).",
        PutBack "The controller works on with the settings that were to be saved.",
        NotPutBack "Not all of them could be written to the controller again.",
        AsInEeprom "The controller works on with what EEPROM held.",
        Unknown "It is not known whether the settings are saved. Save again to be sure.",
        UnknownFor { failure: Message } "It is not known whether the settings are saved. {failure} Save again to be sure.",
    }
}

messages! {
    /// What is wrong with a profile, and what becomes of it on another controller.
    pub enum ProfileMessage {
        NotJson { what: String } "Not JSON: {what}.",
        NoObject "The file holds no JSON object, so it is no settings profile.",
        NoProfile { format: &'static str } "This is no settings profile: it does not say \"format\": \"{format}\".",
        NewerSchema { schema: i64, known: u64 } "The profile has schema {schema}, this program reads up to {known}. A newer program wrote it.",
        UnitUnsaid "Schema 1 did not say which unit the settings came from; that stays open.",
        NoteUnsaid "Schema 1 did not say why they were kept; that stays open.",
        NoSuchMember "A profile has no such member.",
        MemberTwice "The member stands twice.",
        SettingTwice "The setting stands twice.",
        ValueChanged { said: String, raw: i64, held: String } "It says {said}, and its \"raw\" {raw} is {held}: {said} counts.",
        Expected { wanted: &'static str, got: &'static str } "Expected {wanted}, got {got}.",
        ExpectedAny { wanted: &'static str } "Expected {wanted}, and there is nothing.",
        UnknownModel { model: String, known: String } "{model} is no known model; known are {known}.",
        BadGeneration { number: i64, why: &'static str } "{number} {why}.",
        NoAddress { text: String, addresses: &'static str } "{text} is no address; there are {addresses}.",
        CountOutOfRange { number: i64, most: i64 } "{number} is not from 0 to {most}.",
        NoSuchSetting { model: &'static str, generation: FirmwareGeneration } "The {model} with firmware {generation} has no such setting.",
        NoSuchSettingConnected "The connected controller has no such setting.",
        NoSuchSettingMember { name: String } "A setting has no member {name}.",
        NoUnit { wanted: String } "The unit is missing; it has to be {wanted}.",
        UnitTooMany { unit: String } "The unit is {unit}; there has to be none.",
        OtherUnit { unit: String, wanted: String } "The unit is {unit}; it has to be {wanted}.",
        NoneOf { text: String, keys: String } "{text} is none of {keys}.",
        Locked { title: String, value: String, reason: &'static str } "{title}: {value} is not written. {reason}",
        OtherModel { made_for: &'static str, its_rating: &'static str, connected: &'static str, rating: &'static str } "The profile was made for the {made_for} ({its_rating}), the connected controller is the {connected} ({rating}).",
        OtherGeneration { made_for: FirmwareGeneration, connected: FirmwareGeneration } "The profile was made for firmware {made_for}, the connected controller has {connected}.",
        InputMoved { from: String, to: String } "The settings of input {from} go to {to}.",
        NearestStep { title: String, value: String, step: String } "{title}: {value} becomes {step}, the nearest step there.",
        DefaultLeftOut { model: &'static str, generation: FirmwareGeneration, thing: String } "The {model} with firmware {generation} has no place for {thing}: its setting is left out (at the default).",
        OneLeftOut { model: &'static str, generation: FirmwareGeneration, thing: String, named: String } "The {model} with firmware {generation} has no place for {thing}: its setting is left out (not at the default: {named}).",
        DefaultsLeftOut { model: &'static str, generation: FirmwareGeneration, thing: String, count: usize } "The {model} with firmware {generation} has no place for {thing}: its {count} settings are left out (at the default).",
        SomeLeftOut { model: &'static str, generation: FirmwareGeneration, thing: String, count: usize, named: String } "The {model} with firmware {generation} has no place for {thing}: its {count} settings are left out (not at the default: {named}).",
        NoSuchChoice { title: String, value: String, instead: String } "{title}: {value} does not exist there. {instead} is used instead, so that nothing does what {value} did.",
        Follows { thing: String, what: Message } "{thing}: {what}",
        Besides { model: &'static str, generation: FirmwareGeneration, named: String } "The {model} with firmware {generation} has settings that the profile does not know. They stay as they are: {named}.",
        OneSided { groups: String } "Not compared, since one side alone has them: some of {groups}.",
    }
}

messages! {
    /// What became of an act on settings that was cut short.
    pub enum AftermathMessage {
        Headline { cut: Message, state: Message } "{cut} {state}",
        WriteCut { begun: String } "A write of settings begun {begun} was cut short.",
        SaveCut { begun: String } "A save to EEPROM begun {begun} was cut short.",
        DefaultsCut { begun: String } "Restoring the defaults, begun {begun}, was cut short.",
        ReloadCut { begun: String } "Loading the settings from EEPROM, begun {begun}, was cut short.",
        FirmwareCut { begun: String } "A firmware change begun {begun} was cut short.",
        TrialCut { begun: String } "A tuning run or a calibration begun {begun} was cut short.",
        AllAsBefore "Every setting is as it was before.",
        NotAsBefore { settings: Message } "Not as before: {settings}.",
        NoneToChange "No setting had to change.",
        WorksWithThem { count: usize } "The controller works with the values that were to be saved ({count} new). Whether its EEPROM has them is not known if it kept its power since: save again to be sure.",
        AllNew { settings: Message } "All {settings} hold the new value.",
        AllOld { settings: Message } "All {settings} hold the old value.",
        TheOneNew "The one setting holds the new value.",
        TheOneOld "The one setting holds the old value.",
        Mixed { counts: Listed } "The controller holds a mix: {counts}.",
        New { count: usize } "{count} new",
        Old { count: usize } "{count} old",
        Neither { count: usize } "{count} neither old nor new",
        Changed { count: usize } "{count} changed though they were to stay",
        NotRead { count: usize } "{count} not read",
        Unread { title: String, new: String } "{title} could not be read; it was to become {new}.",
        WasToStay { title: String, old: String, now: String } "{title} was {old} and is {now}; it was to stay as it was.",
        HoldsNew { title: String, old: String, now: String } "{title} holds the new value {now}; it was {old} before.",
        HoldsOld { title: String, new: String, now: String } "{title} holds the old value {now}; it was to become {new}.",
        HoldsNeither { title: String, old: String, new: String, now: String } "{title} is {now}: neither the old value {old} nor the new one {new}.",
    }
}

messages! {
    /// How many there are of something.
    pub enum CountMessage {
        OneSetting "1 setting",
        Settings { count: usize } "{count} settings",
    }
}

/// "1 setting", "12 settings".
pub fn settings(count: usize) -> Message {
    if count == 1 { CountMessage::OneSetting } else { CountMessage::Settings { count } }.into()
}

messages! {
    /// What is tried, as a bare verb phrase, in failures and as the name of a job.
    pub enum ActMessage {
        LearnAnew "learn again what its firmware answers",
        FindController "find a controller",
        ListPorts "list the serial ports",
        Read { phrase: String } "{phrase}",
        ReadSettings "read the settings",
        ReadSettingsFirst "read the settings first",
        ReadSettingsBack "read the settings back",
        ReadItem { name: &'static str } "read: {name}",
        Write { what: String } "write {what}",
        KeepBackupOfCommand "keep a backup before the command",
        KeepBackup { act: &'static str } "keep a backup before the {act}",
        Select { place: String } "select the unit {place}",
        Arm { scope: ArmScope } "arm {scope}",
        Move "move the motors",
        Stop "stop the motors",
        StartScript "start the script",
        StopScript "stop the script",
        StartProgram "start the program in its memory",
        SetEncoder "set the encoder",
        ZeroEncoders "zero the encoders",
        ResetEStop "reset the E-stop",
        SendCommand { command: u8 } "send command {command}",
        SendTyped "send what was typed",
        EnterLoader "enter the firmware loader",
        GoOnTalking "go on talking to the controller",
        GoOn "go on",
    }
}

messages! {
    /// What came back of what was tried, as a clause.
    pub enum CauseMessage {
        NotAgreedTo "more would have to be agreed to before this is asked",
        NoWayIntoLoader "there is no way into its firmware loader from here",
        BytesNotTaken "bytes are not taken as they are here; put the command together by its number",
        NoEncoder "it has no encoder whose count could be set",
        NoEStop "it has no emergency stop that software could reset",
        NoProgram "it has no program that is started from here",
        NoScripts "it has no script that this program could start or stop",
        EncodersUntold "this controller does not tell a job its encoders",
        PowerUntold "this controller does not tell a job what a motor draws",
        SpeedUntold "this controller does not tell a job its speed",
        BatteryUntold "this controller does not tell a job its battery",
        MotorsArmed "the motors are armed",
        NotExamined "this family of controllers is not examined",
        ArmedMeanwhile "the motors are armed; a firmware is examined while they are not",
        NoFamily "this program has no family of controllers",
        ListUnreadable "the system's list cannot be read",
        NoSuchUnit "no unit answered there when the link was opened",
        Addresses { listed: String } "the addresses {listed}",
        NoAnswer "no answer",
        NoAnswerAfterwards { seconds: u64 } "no answer for {seconds} s afterwards",
        ReplyTooShort "the reply does not hold everything that this generation returns",
        DiskIsLate "the disk did not answer in time",
        NoResult "it ended without a result",
        Stopped "Stop was pressed after it",
        StoppedSince "Stop was pressed after it was asked for",
        TooOld "it waited for longer than a motion may live",
        NotArmed "the motors are not armed",
        ArmedNoLonger { why: String } "the motors are armed no longer: {why}",
        NotStopped "the motors could not be stopped first",
        NoTimeoutForPage "it has no time-out of its own, and a page whose tab is closed or whose browser is gone cannot stop a motor",
        NotStanding "the motors did not confirm that they stand",
        StopUnconfirmed { seconds: u64 } "it did not confirm within {seconds} s",
        LineIsShared "other controllers share this line",
        NoScript { answer: u8 } "it answered {answer:02X} instead of FF: it holds no script that it can run",
        ThreadFailed "the device thread failed; stop was sent",
        ThreadFailedMoving "the device thread failed, and stop could not be sent",
    }
}

messages! {
    /// What to do, as a sentence without its full stop.
    pub enum RemedyMessage {
        DisarmFirst "Disarm first, then try again",
        CheckWiring "Check the controller's power, the wiring, the baud rate and the address",
        CheckLine "Check the baud rate, the wiring and ground, and that no two units share an address",
        LookAtMotor "Look where the motor stands before you send it again",
        TryWhenReady "Try again when you are ready",
        ArmFirst "Arm the motors on this screen first",
        TrySimulated "Try it on a simulated controller",
        DoWithout "Do without it, or check the firmware's version",
        WriteToKnow "Write it, and it is known while this program is connected",
        CheckValue "Check the value and the state of the controller",
        AskOtherwise "Ask for something else",
        StayInRange "Use a value in range",
        CheckCable "Check the cable and connect again",
        TypePath "Type the path of the port instead",
        TryAgain "Try again",
        CheckDisk "Check the disk and try again",
        CheckFirmware "Check which firmware the controller has",
        CheckPowerAndAddress "Check its power; if it was given another address and that was not saved, look for it at the old one",
        StartWhenReady "Start it again when you are ready",
        SendWhenReady "Send it again when you are ready",
        AskWhenReady "Ask again when you are ready",
        ArmWhenReady "Arm again when you are ready",
        DriveByProgram "Drive it from Brushwork installed on this computer, where a second process stops the motors when the program dies",
        PressStop "Press Stop, then try again",
        CutPower "Cut its motor power now: its motors may still be running",
        CutPowerFirst "Cut the motor power, then try again",
        ConnectAlone "Connect the controller alone, over its USB port",
        ConnectAnew "Disconnect and connect again to look for it",
        DownloadFirst "Download the script first; a simulated controller runs what this program compiles, a real one what the maker's tool compiles",
        SeeThatTheyStand "Make sure that the motors stand still; then check power and cable, and connect again",
        CheckPowerAndCable "Check the controller's power and the cable, then connect again",
        ReportBug "Make sure that the motors stand still, connect again, and report this as a bug",
        LeftOut { seconds: u64 } "It is left out for {seconds} s, then tried again",
        OrElsewhere { remedy: Message, other: &'static str } "{remedy}. {other}",
    }
}

messages! {
    /// What to do about a port that may not be opened.
    pub enum PortMessage {
        JoinGroup { group: String } "The port belongs to the group {group}: run `sudo usermod -aG {group} $USER`, then log out and in again.",
        GiveRight "Give your user the right to open serial ports, then try again.",
    }
}
