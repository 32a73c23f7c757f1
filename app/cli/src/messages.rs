//! What the command line says beside what its data says, in its words.

use brushwork_values::messages;

messages! {
    /// What to know before settings are written.
    pub enum CliSettingsMessage {
        StreamUnknown "It is not known which of the controller's streams this port is wired to; if it is one that changes, the link may be lost. A target such as /dev/ttyUSB0,stream=ttl1 says it.",
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
