//! What the maker's pages do not say of the language, and what was taken for it. The reference prints it.

/// Each with its reason.
pub const ASSUMED: &[&str] = &[
    "Values are Words, and every operator gives a Word: 3 - 5 is 65534. So differences of GetClock() are right across 65535, as the manual's \
     WaitClock needs them.",
    "The lowest byte of a Word comes first in memory. The first global lies at byte 0; behind the last there are zeros.",
    "What is declared between Begin Program and End Program is a global. What a function or a handler declares is its own, and begins again \
     at each call; a function may call itself.",
    "A function gives what Return says, or what its name was set to; without either 0.",
    "While ends with End While. Mod stands between its values. And, Or and Not take 0 for false and give 0 or 1.",
    "Events are kept out until Enable Events. Of each event one is remembered while it waits; of several the lowest number runs first; a \
     handler is not interrupted by another; an event that comes before SetEvent gave it a handler is lost.",
    "Wait and SetTimer count ticks of the main clock: they end with a tick, so the first one counted may be shorter than 1/128 s.",
    "Transmit, Receive and ReadData move the pointer on by what they sent, stored or read.",
    "At End Program everything stays as it is, and no handler runs any more.",
    "A Select compares with each Case from above, and leaves after the first that fits; Case Else is taken where none did.",
    "A pointer that leads out of the variables ends the program with Unknown Instruction, and so does a division by zero.",
];
