//! The events of the board, by the number that the machine has for each: of several the one with the lowest runs first.

use serde::Serialize;

/// An event.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub struct Event {
    /// Its name.
    pub name: &'static str,
    /// When it comes.
    pub help: &'static str,
}

macro_rules! events {
    ($($name:literal $help:literal;)*) => { [$(Event { name: $name, help: $help }),*] };
}

/// All of them; an event's place is its number.
pub const EVENTS: [Event; 16] = events! {
    "UserTimer1Event" "The time of SetTimer 1 is over.";
    "UserTimer2Event" "The time of SetTimer 2 is over.";
    "UserTimer3Event" "The time of SetTimer 3 is over.";
    "UserTimer4Event" "The time of SetTimer 4 is over.";
    "UserTimer5Event" "The time of SetTimer 5 is over.";
    "UserTimer6Event" "The time of SetTimer 6 is over.";
    "UserTimer7Event" "The time of SetTimer 7 is over.";
    "UserTimer8Event" "The time of SetTimer 8 is over.";
    "OnOff1Event" "On/off input 1 has changed.";
    "OnOff2Event" "On/off input 2 has changed.";
    "OnOff3Event" "On/off input 3 has changed.";
    "OnOff4Event" "On/off input 4 has changed.";
    "Stepper1Event" "Stepper 1 has made the steps of SetStepper.";
    "Stepper2Event" "Stepper 2 has made the steps of SetStepper.";
    "ReceiveEvent" "Bytes have come, for Receive.";
    "TransmitEvent" "What Transmit sent is out.";
};

/// The number of the event of timer 1; those of the others follow.
pub const TIMER: u32 = 0;
/// How many timers there are.
pub const TIMERS: u32 = 8;
/// The number of the event of on/off input 1; those of the others follow.
pub const ON_OFF: u32 = 8;
/// The number of the event of stepper 1; that of the other follows.
pub const STEPPER: u32 = 12;
/// The number of the event that bytes have come.
pub const RECEIVE: u32 = 14;
/// The number of the event that bytes are out.
pub const TRANSMIT: u32 = 15;

/// The number of the event of this name, in any case.
#[must_use]
pub fn lookup(name: &str) -> Option<u32> {
    let at = EVENTS.iter().position(|event| event.name.eq_ignore_ascii_case(name));
    at.and_then(|at| u32::try_from(at).ok())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_numbers_are_the_places_in_the_table() {
        for (name, number) in [
            ("UserTimer1Event", TIMER),
            ("usertimer8event", TIMER + TIMERS - 1),
            ("OnOff1Event", ON_OFF),
            ("Stepper1Event", STEPPER),
            ("ReceiveEvent", RECEIVE),
            ("TRANSMITEVENT", TRANSMIT),
        ] {
            assert_eq!(lookup(name), Some(number), "{name}");
        }
        assert_eq!(lookup("UserTimer9Event"), None);
        assert!(u32::try_from(EVENTS.len()).unwrap() <= crate::program::limits::EVENTS);
    }
}
