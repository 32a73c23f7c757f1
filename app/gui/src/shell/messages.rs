//! What the bars around the screens show, in words.

use brushwork_values::{Motor, messages};

messages! {
    /// What the bars around the screens say.
    pub enum ShellMessage {
        NewestEvent { text: String } "Newest event: {text}",
        Link { first: String, second: String } "Link: {first}, {second}",
        Simulated { name: String } "Simulated {name}",
        WhichAddresses { all: &'static str, cost: &'static str } "Which addresses to ask when connecting: all from {all}, {cost}or one",
        Searching { text: String } "Searching: {text}",
        UnitOn { unit: String, port: String } "{unit} on {port}",
        TheFiles { count: usize } "the {count} files",
        DropToOpen { what: String } "Drop to open {what}",
        BringToFront { target: String } "Device: Bring {target} to the Front",
        ConnectTo { target: String } "Device: Connect to {target}",
        ZeroEncoder { motor: Motor } "Zero {motor} encoder",
        SetsToZero { number: usize } "Sets the count of encoder {number} to zero",
        Version { version: String, generation: u8 } "{version} (gen {generation})",
        Searched { what: String, done: usize, of: usize } "{what} ({done} of {of})",
    }
}

messages! {
    /// A row of the device list.
    pub enum DeviceRowMessage {
        Row { title: String, detail: String, state: String } "{title}: {detail}, {state}",
        InFront { row: String } "{row}, in front",
        Hint { title: String, detail: String, state: String } "{title}\n{detail}\n{state}",
        DisconnectFrom { title: String } "Disconnect from {title}",
        Forget { title: String } "Forget {title}",
    }
}

messages! {
    /// How a device of the list stands.
    pub enum DeviceStateMessage {
        Available "available",
        Closed "closed",
        Gone "gone",
        LinkLost "link lost",
        NotOpened "could not be opened",
        Connecting "connecting",
        Disconnecting "disconnecting",
        Looking "looking for controllers",
        Connected "connected",
        WithError "connected, error",
        WithWarning "connected, warning",
        Armed "connected, armed",
    }
}

messages! {
    /// How the settings stand, in the bar at the bottom.
    pub enum BarMarkMessage {
        Settings { first: String, second: String } "Settings: {first}, {second}",
        NoController "no controller",
        Reading "reading the settings …",
        NotRead "settings not read yet",
        Saved "RAM is saved in EEPROM",
        NotInEeprom { count: usize } "RAM: {count} not saved in EEPROM",
        Written { written: usize } "RAM: {written} written, not saved",
        Edits { edits: usize } "{edits} edits not written",
        AsSaved "RAM is as saved last",
        NotKnown "EEPROM not known",
        NotAsSaved { count: usize } "RAM: {count} not as saved last",
        NoProfile "no profile open",
        ProfileAsRam "profile: as in RAM",
        ProfileNotCompared "profile: not compared",
        ProfileDiffers { count: usize } "profile: {count} differ from RAM",
        OneEdit "1 edit not written",
        OneProfileDiffers "profile: 1 differs from RAM",
    }
}
