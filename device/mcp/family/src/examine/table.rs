//! The questions of the family, the steps in which they are asked, and what is assumed and not asked.
//!
//! Each file of the wire, the client, the axis and the simulator that assumes something stands in [`ASSUMED`]; a test of the house compares. The
//! questions that the sources leave open are those of the public clients of 2015 to 2025, which contradict each other there.

use brushwork_family::examine::{Assumed, Need, NotAskable, Question, Step, not_asked};

/// Keys of the steps.
pub const FIRMWARE: &str = "firmware";
/// Reads by guess.
pub const GUESSES: &str = "guesses";
/// Writes in other layouts.
pub const LAYOUT: &str = "layout";
/// The loops of a motor.
pub const MOTOR: &str = "motor";
/// A save.
pub const SAVING: &str = "saving";

const fn q(key: &'static str, question: &'static str, how: &'static str) -> Question {
    Question { key, question, how }
}

/// The steps, in the order in which they are taken.
pub static STEPS: &[Step] = &[
    Step {
        key: FIRMWARE,
        title: "read what the firmware answers",
        need: Need::Read,
        does: "Every documented read is sent; nothing is written.",
        touches: &[],
        questions: &[
            q(
                "generation",
                "Which generation is the firmware of this version?",
                "Reads whose replies have other widths in other generations; the width at which the CRC fits counts.",
            ),
            q(
                "commands",
                "Which reads does it have, beside what its generation is known for?",
                "Each read three times or more; silence counts when the version is answered right after it.",
            ),
            q(
                "appended_crc",
                "Is a read that carries a CRC taken?",
                "Command 21 with its CRC behind it, between two without.",
            ),
            q(
                "idle_buffer",
                "What does an empty buffer read (command 47: 128, or 0 as clients of 2025 say)?",
                "Command 47 while nothing moves.",
            ),
            q(
                "tick",
                "In which unit does command 73 count the running time (assumed: milliseconds)?",
                "Command 73 twice, a second apart.",
            ),
        ],
    },
    Step {
        key: GUESSES,
        title: "read by commands whose layout is a guess",
        need: Need::Guess,
        does: "Commands 88, 89, 180 and 191 are sent, one at a time. Libraries contradict each other about them; they are taken for reads, but \
               what this firmware makes of them is not known.",
        touches: &[],
        questions: &[
            q(
                "guessed_reads",
                "How wide are the replies to 88 and 89, which no library of generation 4 sends?",
                "Each once; the width at which the CRC fits counts.",
            ),
            q(
                "can_errors",
                "Does command 180 return an error register or a number of messages?",
                "Once; six bytes are the one, three the other.",
            ),
            q(
                "can_dictionary",
                "Does command 191 take a CRC, and does the CRC of its reply begin again?",
                "The device type of the unit's own node, without a CRC and with one.",
            ),
        ],
    },
    Step {
        key: LAYOUT,
        title: "write registers in other layouts",
        need: Need::Write,
        does: "The gains of motor 1's velocity loop are written as they are, also with a byte more, with one less and with the address twice; \
               command 0 stops motor 1 once. All of it stays in RAM, and what changed is put back.",
        touches: &["motor1.velocity."],
        questions: &[
            q(
                "acknowledgement",
                "What comes back to a write?",
                "Command 28 with the gains that are set; everything that comes is kept.",
            ),
            q(
                "longer_payload",
                "Is a write taken whose payload is a byte too long?",
                "Command 28 with a zero or a small number behind its values, and a CRC over all of it; the registers are read afterwards.",
            ),
            q(
                "shorter_payload",
                "Is a write taken whose payload is a byte too short?",
                "Command 28 without the last byte of its values, and a CRC over the rest; the registers are read afterwards.",
            ),
            q(
                "doubled_address",
                "Is a write taken whose address comes twice (assumed: yes)?",
                "Command 28 with one address more in front, which its CRC does not count.",
            ),
            q(
                "legacy_acknowledgement",
                "Are commands 0 to 13 acknowledged (firmware from 4.3.6 on was seen to drive and say nothing)?",
                "Command 0 with power 0.",
            ),
        ],
    },
    Step {
        key: MOTOR,
        title: "look at the loops of a motor",
        need: Need::Move,
        does: "The motor turns: a duty that grows until it moves, half a second of creeping forward and as much back, short commands \
               below the duty that moves it, and two or three moves of less than half a second. It must be free to turn a little both ways. Gains are written meanwhile and put back.",
        touches: &[],
        questions: &[
            q(
                "feed_forward",
                "Is the setpoint's share of QPPS added to the duty (assumed: yes)?",
                "A speed with all gains at 0; the duty that comes of it is read (command 48).",
            ),
            q("proportional", "Is a P register of 65536 a gain of 1?", "The same with P alone."),
            q(
                "loop_rate",
                "How often does the loop run, and does I sum over ticks or seconds (assumed: 300 Hz, over ticks)?",
                "The same with I alone; how quickly the duty grows tells it.",
            ),
            q(
                "position_scale",
                "Is a position gain of 1 the wire value 1024 or 2048?",
                "A position 60 counts away with P alone, velocity gains at 0; the duty that comes of it.",
            ),
            q(
                "derivative",
                "Does a position D multiply the change in a tick or in a second (assumed: as I sums)?",
                "A position far away with a small P, without D and with it; what D takes from the duty of the creeping motor.",
            ),
            q(
                "speed_step",
                "Over which time is the unfiltered speed counted (assumed: 1/300 s)?",
                "Commands 30 and 31 while the motor creeps; the readings are multiples of one count in that time.",
            ),
        ],
    },
    Step {
        key: SAVING,
        title: "save the settings to EEPROM",
        need: Need::Save,
        does: "The settings are saved as they are in RAM: what was changed and not saved becomes lasting, and the EEPROM is written once more.",
        touches: &[],
        questions: &[q(
            "save_restarts",
            "Does command 94 restart the unit?",
            "Command 94; a restart loses the encoder counts, and the unit is deaf meanwhile. Turn a shaft a little beforehand if both counts are 0.",
        )],
    },
];

/// Questions of the sources that are not asked, beside what files assume.
const OPEN: [NotAskable; 5] = [
    NotAskable {
        what: "What the second status byte of 250 and 251 says.",
        why: "Both overwrite the stored script, which cannot be read back (254) and so not be put back.",
    },
    NotAskable {
        what: "The layout of 190, which writes a CANopen dictionary.",
        why: "It writes an object whose earlier value is only known if 191 is understood; nothing could be put back for sure.",
    },
    NotAskable {
        what: "The layout of 254, which reads the script memory.",
        why: "Nothing but the number is public, so no request could be made for it.",
    },
    NotAskable {
        what: "The byte code and the file format of compiled scripts.",
        why: "No command tells them: the memory can be written and not read.",
    },
    NotAskable {
        what: "Whether 80 and 94 are taken without their key.",
        why: "Where they are, the settings are lost or the EEPROM is written, which is more than the answer is worth.",
    },
];

const OURS: &str = "It is a choice of this program and no property of the unit.";
const PINS: &str = "It takes known signals at the inputs.";
const MACHINE: &str = "It takes a machine under load, or one that is disturbed on purpose.";
const BUS: &str = "It takes other nodes on a CAN bus that one may disturb.";
const SCRIPT: &str = "It takes a script that a real unit runs, and their byte code is not public.";
const LOOKING: &str = "Nothing on the wire tells it: it has to be looked at or measured.";
const FIRMWARE_UPDATE: &str = "The loader erases the firmware.";
const LONG_MOVES: &str =
    "It takes moves over a longer distance than an examination makes; a tuning run shows what comes of it.";
const EEPROM: &str = "It takes power cuts or many writes of the EEPROM.";

/// What is assumed, file by file.
pub static ASSUMED: &[Assumed] = &[
    Assumed::asked(
        "axis/src/registers.rs",
        &["feed_forward", "proportional", "loop_rate", "position_scale", "derivative"],
    ),
    Assumed::not("client/src/can/master.rs", "That node id 127 is free.", BUS),
    Assumed::not(
        "client/src/controller/arming.rs",
        "That a stream's time-out stops the motors; that a duty is a current in torque control.",
        MACHINE,
    ),
    Assumed::not(
        "client/src/controller/stopping.rs",
        "That a duty command ends a move and may leave those that wait.",
        LONG_MOVES,
    ),
    Assumed::not(
        "client/src/diagnosis/pin_end.rs",
        "That percent reaches full scale exactly at the ends.",
        PINS,
    ),
    Assumed::not("client/src/firmware/send.rs", "How long a page may take to be confirmed.", FIRMWARE_UPDATE),
    Assumed::asked("client/src/packet.rs", &["save_restarts"]),
    Assumed::not(
        "client/src/settings/pins/mode.rs",
        "Which priority signal an input counts as, and how pulses and encoders read.",
        PINS,
    ),
    Assumed::not("client/src/settings/pins/shape.rs", "The curve between an input and its command.", PINS),
    Assumed::not(
        "sim/src/controller/answer.rs",
        "What 248 answers without a script.",
        "With a script it would start it.",
    ),
    Assumed::not(
        "sim/src/controller/bus.rs",
        "That two units of one address answer one after the other.",
        "It takes two units.",
    ),
    Assumed::asked("sim/src/controller/can.rs", &["can_errors", "can_dictionary"]),
    Assumed::not(
        "sim/src/controller/canbus/dictionary.rs",
        "Heartbeat, vendor and product of a node.",
        "It is read on a CAN bus, which an examination of packets does not see.",
    ),
    Assumed::not("sim/src/controller/canbus/mod.rs", "How a node beats and watches a master.", BUS),
    Assumed::not("sim/src/controller/canbus/node.rs", "That a reset of a node leaves the controller.", BUS),
    Assumed::asked("sim/src/controller/commands/can.rs", &["can_dictionary"]),
    Assumed::not(
        "sim/src/controller/commands/drive.rs",
        "How a bridged unit takes commands for motor 2.",
        "Bridging is a matter of wiring; a wrong answer damages the unit.",
    ),
    Assumed::not(
        "sim/src/controller/commands/pins.rs",
        "That an index beyond the model's is refused.",
        "A unit that takes one may write where nothing can be put back.",
    ),
    Assumed::asked("sim/src/controller/commands/report.rs", &["tick"]),
    Assumed::not(
        "sim/src/controller/commands/unit.rs",
        "That a wrong address and a restore leave the address.",
        "The unit may be lost from the line.",
    ),
    Assumed::not(
        "sim/src/controller/control/mod.rs",
        "What the control pins, homing, the R/C and analog inputs and the battery cut-off of a RoboClaw do in detail.",
        PINS,
    ),
    Assumed::not(
        "sim/src/controller/control/word.rs",
        "That an MCP's configuration word tells its TTL UART1.",
        "An MCP has other commands for what stands in it, and a write may end the connection.",
    ),
    Assumed::not(
        "sim/src/controller/firmware.rs",
        "That a board of one channel acknowledges commands for motor 2.",
        "A command for a motor is no question.",
    ),
    Assumed::not("sim/src/controller/inputs.rs", "How voltages and open pins read.", PINS),
    Assumed::not(
        "sim/src/controller/loader.rs",
        "What the loader does, and how long it takes.",
        FIRMWARE_UPDATE,
    ),
    Assumed::not(
        "sim/src/controller/port.rs",
        "How long a unit waits before it answers.",
        "The line is later than the unit; its share is in the latency of the report.",
    ),
    Assumed::not("sim/src/controller/script/i2c.rs", "What I2CERROR says.", SCRIPT),
    Assumed::not(
        "sim/src/controller/script/memory.rs",
        "Times and size of the script memory, and its status byte.",
        "It overwrites the stored script.",
    ),
    Assumed::not("sim/src/controller/script/motion.rs", "That scripts act at all priority levels.", SCRIPT),
    Assumed::not("sim/src/controller/script/registers/motor.rs", "That MOTOR registers are raw.", SCRIPT),
    Assumed::not(
        "sim/src/controller/script/registers/stream.rs",
        "That a stream's time-out of 0 never runs out.",
        SCRIPT,
    ),
    Assumed::not(
        "sim/src/controller/script/registers/system.rs",
        "Which priority level counts without an input.",
        SCRIPT,
    ),
    Assumed::not("sim/src/controller/script/run.rs", "How fast scripts run.", SCRIPT),
    Assumed::not("sim/src/controller/script/sending.rs", "How much a port holds back.", SCRIPT),
    Assumed::not(
        "sim/src/controller/script/state.rs",
        "What starting a running script does, and stopping one.",
        SCRIPT,
    ),
    Assumed::not("sim/src/controller/script/streams.rs", "Which UART the TTL stream is.", SCRIPT),
    Assumed::not(
        "sim/src/controller/unit.rs",
        "At which voltage the logic gives up.",
        "It takes a supply that is lowered.",
    ),
    Assumed::not("sim/src/controller/watch.rs", "How outputs and error limits let go.", MACHINE),
    Assumed::not("sim/src/motion/channel/advance.rs", "When a move counts as ended.", LONG_MOVES),
    Assumed::not("sim/src/motion/channel/mod.rs", "When a speed error is looked at.", MACHINE),
    Assumed::not("sim/src/motion/channel/mode.rs", "That distances are measured in counts.", LONG_MOVES),
    Assumed::not(
        "sim/src/motion/command.rs",
        "What buffer bytes, relay amplitudes and reverse actions mean.",
        LONG_MOVES,
    ),
    Assumed::asked("sim/src/motion/law.rs", &["feed_forward", "loop_rate", "position_scale", "speed_step"]),
    Assumed::not(
        "sim/src/motion/law.rs",
        "Filters, derivative, wind-up, delay and the forms of moves.",
        LONG_MOVES,
    ),
    Assumed::not("sim/src/motion/mixing.rs", "Which motor is the left one.", LOOKING),
    Assumed::not("sim/src/motion/mod.rs", "What a command does beyond its words.", LONG_MOVES),
    Assumed::not("sim/src/motion/output.rs", "How the current is limited.", MACHINE),
    Assumed::not("sim/src/motion/pid.rs", "What the dead zone does.", LONG_MOVES),
    Assumed::not(
        "sim/src/motion/relay.rs",
        "How the relay tests 84 to 87 go.",
        "They can hang where the wiring is wrong (MCP manual 2.4.5).",
    ),
    Assumed::not(
        "sim/src/motion/settings.rs",
        "The bound of the position integral, defaults of ramps and of the idle bridge.",
        LONG_MOVES,
    ),
    Assumed::not("sim/src/priority.rs", "How priority levels give way.", PINS),
    Assumed::not(
        "sim/src/settings/defaults.rs",
        "Which encoder pin a unit leaves the factory with.",
        "A used unit no longer tells.",
    ),
    Assumed::not("sim/src/settings/eeprom.rs", "Size and time of the EEPROM's rows.", EEPROM),
    Assumed::not("sim/src/signals/mod.rs", "How often inputs are read, and their time-outs.", PINS),
    Assumed::not("sim/src/signals/shape.rs", "The curve between an input and its command.", PINS),
    Assumed::not(
        "sim/src/supervision/battery.rs",
        "The voltages of a cell, and what limits detection sets.",
        "It takes batteries of several kinds.",
    ),
    Assumed::not("sim/src/supervision/leds.rs", "How long the LEDs light.", LOOKING),
    Assumed::not(
        "sim/src/supervision/limits.rs",
        "Which limits warn and which are errors.",
        "It takes voltages and temperatures beyond them.",
    ),
    Assumed::not("wire/src/canopen/eds.rs", "Which vendor, product and revision a node calls itself.", BUS),
    Assumed::not("wire/src/canopen/objects.rs", "How commands lie in objects.", BUS),
    Assumed::not("wire/src/codes.rs", "How actions and encoder pins are numbered.", PINS),
    Assumed::not(
        "wire/src/models.rs",
        "Ratings that no manual lists, and which UART stops an encoder.",
        "Ratings cannot be tried, and the UARTs take wiring.",
    ),
    Assumed::asked(
        "wire/src/packet_serial/framer.rs",
        &["doubled_address", "appended_crc", "longer_payload", "shorter_payload"],
    ),
    Assumed::not("wire/src/packet_serial/led.rs", "How the LEDs flash.", LOOKING),
    Assumed::asked("wire/src/packet_serial/scale.rs", &["position_scale"]),
    Assumed::asked("wire/src/packet_serial/table/autotune.rs", &["guessed_reads"]),
    Assumed::asked("wire/src/packet_serial/table/can.rs", &["can_errors", "can_dictionary"]),
    Assumed::not(
        "wire/src/packet_serial/table/config.rs",
        "What 100 and 101 do in generation 1 (\"factory QPPS test\").",
        "They may run the motors at full speed.",
    ),
    Assumed::asked("wire/src/packet_serial/table/legacy.rs", &["legacy_acknowledgement"]),
    Assumed::not(
        "wire/src/roboclaw.rs",
        "That D1 and D2 are the outputs CTRL1 and CTRL2, and that bit 3 inverts an input.",
        PINS,
    ),
    Assumed::not("wire/src/script_image.rs", "What fills the last block of a script.", OURS),
];

/// What is not asked, and why.
#[must_use]
pub fn not_askable() -> Vec<NotAskable> {
    OPEN.into_iter().chain(not_asked(ASSUMED)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use brushwork_family::examine::Standing;

    #[test]
    fn what_is_said_to_be_asked_is_a_question_and_every_question_and_step_has_its_own_key() {
        let keys: Vec<&str> =
            STEPS.iter().flat_map(|step| step.questions).map(|question| question.key).collect();
        for (index, key) in keys.iter().enumerate() {
            assert!(!keys[..index].contains(key), "{key}");
        }
        for row in ASSUMED {
            if let Standing::Asked(asked) = row.standing {
                asked.iter().for_each(|key| assert!(keys.contains(key), "{}: {key}", row.file));
            }
        }
        assert_eq!(STEPS[0].need, Need::Read, "what comes first needs no agreement");
        assert!(STEPS[1..].iter().all(|step| step.need > Need::Read));
        assert!(STEPS[1..].windows(2).all(|pair| pair[0].need < pair[1].need), "the lighter steps first");
    }

    #[test]
    fn every_line_is_a_sentence() {
        for row in not_askable() {
            assert!(row.what.ends_with('.') && row.why.ends_with('.'), "{row:?}");
        }
    }
}
