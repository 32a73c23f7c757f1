//! How acts on the registers of a Motion Mind are told, and what to do about a refused tuning run.

use brushwork_tuning::cause::Cause;

use crate::family::SettingsWords;

/// Motion Mind 3 (Motion Mind manual 5.8, 5.11 and 5.12).
pub(super) static WORDS: SettingsWords = SettingsWords {
    title: "Registers",
    many: "rows",
    save: "Save to EEPROM…",
    save_now: "Save",
    save_text: "Saves what the unit works with now, register by register, only those that differ or whose EEPROM is not known, \
                then makes the unit load its EEPROM and compares. The EEPROM lasts about a million writes: do not save in a loop.",
    save_warning: Some("The motor stops while the EEPROM is written, up to 40 ms for each register."),
    defaults: "Restore…",
    defaults_now: "Restore factory values",
    defaults_text: "Brings back the factory's values, in RAM and in EEPROM at once, then reads them. The unit answers to address 1 \
                    afterwards.",
    defaults_warning: Some(
        "The motor stops, and what the EEPROM held is lost. A backup of the registers is made first.",
    ),
    reload_text: "Load from EEPROM resets the unit, which loads its EEPROM as at power-up, then reads that. The motor stops. \
                  What the unit works with now and was not saved is lost.",
};

/// What to do about a refused tuning run, where it is another thing, or in another place, than with an MCP.
#[allow(clippy::wildcard_enum_match_arm, reason = "one answer for all the rest, new members too")]
pub(super) fn remedies(cause: Cause) -> Option<&'static [&'static str]> {
    Some(match cause {
        Cause::EncoderReversed => &[
            "Swap the two motor leads at the controller, or the encoder's A and B. Not both.",
            "In mode 3, on the Duty screen, a little positive duty must make the position count up.",
        ],
        Cause::EncoderDead | Cause::EncoderLost => &[
            "Look at the encoder's plug at both ends, and at its 5 V supply.",
            "Turn the shaft by hand: the position at the top must change.",
        ],
        Cause::OutsideTravel => &[
            "Move the axis by hand, or on this screen, until its counts lie within the travel.",
            "Or give a travel around where it stands.",
        ],
        Cause::LimitNotTaken => &[
            "Leave the highest current at 0: then AMPSLIMIT counts.",
            "Or set AMPSLIMIT on the Registers screen before the run.",
        ],
        Cause::CurrentLimited => &[
            "Raise AMPSLIMIT on the Registers screen, if the motor may have it.",
            "Take load off the motor.",
        ],
        Cause::LinkLost => &[
            "Check the cable to the controller and connect again.",
            "A Motion Mind has no time-out for serial: the virtual limits of the run have stopped the motor. The old registers are put \
             back when it answers again.",
        ],
        Cause::ControllerFault => &[
            "See the indicators at the bottom: a limit input, the brake input or the temperature keeps the bridge off.",
            "Free the input or let the board cool down, then try again.",
        ],
        Cause::BatteryLow => {
            &["Use a stronger supply, or lower the highest duty: a weak supply sags less then."]
        }
        Cause::WrongMode => &[
            "Switch the power off, set SW1 to mode 4 (MODE2 off, MODE1 on, MODE0 on), and switch it on again.",
            "Clear PULSEFB in FUNCTION2 on the Registers screen.",
        ],
        Cause::LoopOff => {
            &["When it is put right, arm and try again: arming switches the loop on where the motor stands."]
        }
        Cause::OtherLoop => &["Clear NEWVELMODE, FASTPID, PULSEFB and DISABLEPID on the Registers screen."],
        Cause::UnknownLaw => {
            &["Use the step response assistant, which needs to know nothing of the loop's law."]
        }
        _ => return None,
    })
}
