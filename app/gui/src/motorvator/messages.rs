//! What the screens of the MotorVator show, in words.

use brushwork_values::messages;

messages! {
    /// What the screens of a MotorVator say.
    pub enum BoardMessage {
        Version { version: String } "version {version}",
        Motors { letters: &'static str } "motors {letters}",
        TooLong { bytes: usize, most: usize } "These are {bytes} bytes; a frame has {most}.",
        NoByte { word: String } "\"{word}\" is no byte: use 0 to 255, or a text in quotes.",
        Display { text: String } "Display {text}",
        Input { number: u8 } "Input {number}",
        Found { config: String } "Found, with a fifth more: {config}. Put this line into your program.",
        TrialOver { trial: usize, config: String } "Trial {trial} with {config} is over. Does the mark stand where it stood?",
        Trial { trial: usize, config: String } "Trial {trial} with {config} …",
    }
}
