//! The questions of the family, the steps in which they are asked, and what is assumed and not asked.
//!
//! Each file of the wire, the client, the axis and the simulator that assumes something stands in [`ASSUMED`]; a test of the house compares.

use brushwork_family::examine::{Assumed, Need, Question, Step};

/// Keys of the steps.
pub const REGISTERS: &str = "registers";
/// A write to RAM that the manual gives no effect.
pub const WRITING: &str = "writing";
/// A write to EEPROM.
pub const STORING: &str = "storing";

const fn q(key: &'static str, question: &'static str, how: &'static str) -> Question {
    Question { key, question, how }
}

/// The steps, in the order in which they are taken.
pub static STEPS: &[Step] = &[
    Step {
        key: REGISTERS,
        title: "read the registers",
        need: Need::Read,
        does: "Every register is read, alone and with others; nothing is written.",
        touches: &[],
        questions: &[
            q(
                "switches",
                "How do switches 2 to 4 (mode) and 6 (protocol) stand?",
                "MODE, and the protocol in which it answers.",
            ),
            q(
                "lacking",
                "Which of the manual's 32 registers does it not answer?",
                "Each read alone; silence counts when REVISION is answered right after it.",
            ),
            q(
                "turnaround",
                "How soon does an answer come (assumed: it leaves after 2 ms, in text after 6 ms)?",
                "The quickest of twenty reads of REVISION, its bytes and the line included.",
            ),
            q(
                "back_to_back",
                "Are commands taken one by one that come without a pause (the manual says that 5 ms of silence end a frame)?",
                "Two reads in one write; two answers, or none.",
            ),
            q("small_letters", "In text: are small letters taken?", "A read in small letters."),
            q(
                "line_feed",
                "In text: does a line feed alone end a line?",
                "A read without a carriage return.",
            ),
            q("tick", "Does TIME count steps of 5 ms?", "TIME twice, two seconds apart."),
        ],
    },
    Step {
        key: WRITING,
        title: "write to a register that only the unit changes",
        need: Need::Write,
        does: "INDEXPOS, which the next index pulse sets again, is written in RAM with a number one higher, and put back if it takes it.",
        touches: &[],
        questions: &[q(
            "read_only",
            "What does a write to a register do that cannot be written (assumed: it is acknowledged and does nothing)?",
            "WRITE to INDEXPOS, which is read before and after.",
        )],
    },
    Step {
        key: STORING,
        title: "store one register in EEPROM",
        need: Need::Save,
        does: "TIMER is stored as it is, which stops the motor and writes one register of the EEPROM once more.",
        touches: &[],
        questions: &[q(
            "store_time",
            "How long is the unit deaf while it stores a register (assumed: 40 ms, the most that the manual allows)?",
            "WRITE STORE of TIMER, until it is acknowledged.",
        )],
    },
];

const POWER: &str = "It takes a power cycle, and a look at the unit.";
const LOAD: &str = "It takes a machine under load.";
const WHOLE: &str = "It would overwrite all settings of the unit.";
const RECEIVER: &str = "It takes a receiver or a known signal at the inputs.";
const SWITCHES: &str = "It takes other positions of the switches, which the wire cannot change.";

/// What is assumed, file by file.
pub static ASSUMED: &[Assumed] = &[
    Assumed::not("client/src/controller/speaker.rs", "How long RESTORE takes.", WHOLE),
    Assumed::asked("sim/src/assumed.rs", &["turnaround", "store_time"]),
    Assumed::not("sim/src/assumed.rs", "How long it takes to be ready after power-up.", POWER),
    Assumed::not("sim/src/assumed.rs", "How often an R/C receiver sends a pulse.", RECEIVER),
    Assumed::not("sim/src/drive.rs", "How quickly the current limit takes the drive back.", LOAD),
    Assumed::not("sim/src/inputs.rs", "That inputs are not debounced at power-up.", POWER),
    Assumed::not("sim/src/loops.rs", "What holds a motor that stands beyond a virtual limit.", LOAD),
    Assumed::asked("sim/src/unit.rs", &["read_only"]),
    Assumed::not("sim/src/unit.rs", "That the loop holds the position that it finds at power-up.", POWER),
    Assumed::not("sim/src/unit.rs", "That a command is taken that the mode has no use for.", SWITCHES),
    Assumed::asked("wire/src/frame_reader.rs", &["back_to_back"]),
    Assumed::not(
        "wire/src/line.rs",
        "That several return bits of FUNCTION give a line each.",
        "Nothing here writes FUNCTION, whose other bits drive the motor.",
    ),
    Assumed::asked("wire/src/line_reader.rs", &["small_letters", "line_feed"]),
    Assumed::not(
        "wire/src/register.rs",
        "The four letters in front of an answer in text, but for four of them.",
        "Nothing of this program depends on them.",
    ),
];
