//! What the screens show, in words.

use brushwork_link::UnitAddress;
use brushwork_values::{Message, Motor, messages};

messages! {
    /// What the screens say of the controller and its link.
    pub enum ScreenMessage {
        Stops { risk: &'static str, keys: &'static str, what: &'static str } "{risk} {keys} stops {what}.",
        FallsSilent { seconds: f64 } "If this program falls silent, the controller stops the motors by itself after {seconds:.1} s. Leaving this screen disarms.",
        StepOf { number: usize, of: usize, title: &'static str } "Step {number} of {of}: {title}",
        LateStep { motor: Motor, text: String, milliseconds: f64 } "{motor} to {text}: nothing was read for {milliseconds:.0} ms of this step, since this computer or the line was late; its figures are the less sure.",
        ArmToRun { duration: String } "{duration}. Arm this screen to run it.",
        GraphOf { target: String } "Brushwork graph: {target}",
        BecomesTorque { number: usize } "Motor {number}: with L and R both other than 0 the controller switches from duty to current (torque) control.",
        Connecting { target: String } "Connecting to {target} …",
        Looking { target: String } "Looking for controllers at {target} …",
        Disconnecting { target: String } "Disconnecting from {target} …",
        LinkLost { ago: String, why: Message } "Link lost {ago}. {why}",
        ConnectAgain { target: String } "Connect to {target} again",
        SecondsAgo { seconds: f64 } "{seconds:.0} s ago",
        MinutesAgo { minutes: f64 } "{minutes:.0} min ago",
        HoursAgo { hours: f64 } "{hours:.0} h ago",
        GraphHeight { percent: f32 } "Height of the graph: {percent:.0} %",
    }
}

messages! {
    /// What is said of the settings where they are listed and changed.
    pub enum SettingMessage {
        OfMotor { what: String, motor: Motor } "{what} of {motor}",
        WrittenAtOnce { help: String } "{help} Written to RAM at once and read back; save it to keep it.",
        Differ { count: usize } "{count} settings differ.",
        TakeOverGroup { group: &'static str } "Take over group {group}",
        TakeOver { title: String } "Take over {title}",
        NotWritten { count: usize } "{count} not written",
        NotSaved { count: usize } "{count} not saved",
        WrittenNotSaved { written: usize } "{written} written, not saved",
        Write { edits: usize } "Write {edits}…",
        Undo "Undo edit of settings",
        UndoLast "Undo the last edit of the settings",
        Redo "Redo edit of settings",
        RedoLast "Redo the last edit of the settings",
        Range { range: String } "Range {range}. ",
        Default { value: String, assumed: &'static str } "Default {value}{assumed}.",
        Number { note: Message } " The number is {note}.",
        Key { key: String } " Name in files and on the command line: {key}.",
        KeptIn { folder: String } "Kept in {folder}",
        ActOfBackup { act: &'static str, backup: String } "{act} backup {backup}",
        Old { value: String } "old {value}",
        New { value: String } "new {value}",
        Section { name: String } "Section {name}",
        Changed { edits: usize } "{edits} changed",
        WithEdits { edits: usize } "Include what is changed here and not written ({edits})",
        Readings { readings: String } "Now {readings}",
        IndicatorNow { title: &'static str, state: &'static str } "{title} now: {state}",
        BoardNow { title: &'static str, value: String } "{title} now: {value}",
        OnController { title: String, value: String } "{title} on the controller: {value}",
        DefaultIs { title: String, value: String } "{title} default: {value}",
        IsChanged { title: String } "{title} is changed",
        IsLocked { title: String, reason: String } "{title} is locked: {reason}",
        Refused { refusal: String } "{refusal} It is not written.",
        Hidden { count: usize } "{count} without a wire form go past the wire of the simulated controller.",
        SavedSince { date: String } "These are saved (in EEPROM, as known since {date} -> works with now):",
        NotApplied { settings: String } "{settings} changed and not applied yet.",
        ShownOf { shown: usize, all: usize, many: &'static str } "{shown} of {all} {many}",
        OneHidden "1 without a wire form goes past the wire of the simulated controller.",
    }
}

messages! {
    /// What is said of a file of settings that is looked at.
    pub enum SettingsFileMessage {
        ProfileRead { name: String, date: String } "Profile {name}, read {date}.",
        Upgrade { name: String } "Upgrade profile {name}",
        At { unit: String } " at {unit}",
        Of { model: &'static str, place: String, address: UnitAddress, firmware: String, generation: String, read: String, note: String } "Of {model}{place}, address {address}, firmware {firmware} ({generation}), read {read}{note}.",
        OnlyDiffering { count: usize } "Only what differs from the factory ({count})",
        Shown { shown: usize, all: usize } "{shown} of {all} settings. To write them, connect a controller and open the file again.",
        FactoryHas { value: String } ", the factory has {value}",
        Open { title: String } "Open backup {title}",
    }
}

messages! {
    /// What the status screen says.
    pub enum StatusMessage {
        ConnectedFor { time: String } "connected for {time}",
        NoLongerListed { count: u64 } "{count} older events are no longer listed",
        Since { time: String } "since {time}",
        StepsDone { done: usize, needed: usize } "{done} of {needed} steps done, as the controller's own values and what was seen of its motors tell",
        Step { title: &'static str, standing: &'static str } "Step {title}: {standing}",
        GoToTab { screen: String, tab: String } "Go to {screen}: {tab}",
        GoToRecipe { job: &'static str } "Go to Recipes: {job}",
        AlsoAnswers { addresses: String } ", also answers {addresses}",
        Lacking { what: String } "This firmware does not have: {what}.",
        OneNoLongerListed "1 older event is no longer listed",
    }
}
