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
        ServoTold { servo: usize, degrees: i32 } "Servo {servo} was told {degrees}°",
        ServoUnknown { servo: usize } "Servo {servo}: nothing told from here",
        Servo { servo: usize } "Servo {servo}",
        TurnServo { servo: usize } "Turn servo {servo}",
        OnOff { number: u8, state: &'static str } "On/off input {number}: {state}",
        SwitchInput { number: u8, state: &'static str } "Switch input {number} {state}",
        AnalogInput { number: usize, value: String } "Analog input {number}: {value}",
        AnalogName { number: usize } "Analog {number}",
        Input { number: u8 } "Input {number}",
        Found { config: String } "Found, with a fifth more: {config}. Put this line into your program.",
        TrialOver { trial: usize, config: String } "Trial {trial} with {config} is over. Does the mark stand where it stood?",
        Trial { trial: usize, config: String } "Trial {trial} with {config} …",
    }
}
