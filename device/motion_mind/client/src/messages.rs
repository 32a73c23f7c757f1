//! What this family says to people, in its words: one table for each theme.

use brushwork_link::unit::UnitAddress;
use brushwork_values::messages;

messages! {
    /// What to know of settings before they are written, and why some cannot be.
    pub enum MotionMindSettingsMessage {
        BaudRate "The baud rate changes at the next power-up, and only if it is saved: connect again at the new rate then.",
        NoAddress { address: UnitAddress } "{address} is no Motion Mind's",
        ValuesDoNotFit "the values do not fit the command",
    }
}

messages! {
    /// What drives a motor besides this program, and what arming and stopping did to a loop.
    pub enum MotionMindDriverMessage {
        NoTimeout "A Motion Mind has no serial time-out: if this program or the cable dies, the motor goes on with what it was last told. Have a switch for the motor power at hand.",
        LoopSwitchedOn "The output of its loop was switched off (DISABLEPID in FUNCTION). It was switched on again, in RAM: the loop holds the motor where it stands.",
        LongRamp { seconds: f64 } "Its ramp takes {seconds:.1} s from full drive to 0 (VELOCITYLIMIT, TIMER). Stop takes the ramp away for as long as it needs.",
        LoopLeftOff "Its loop did not hold the motor still, so its output was left switched off (DISABLEPID in FUNCTION, in RAM): the motor stands, but nothing holds it. The next Arm or `drive` switches the loop on again, and so does a reset of the unit. A loop that shakes its motor needs other gains: lower PTERM and ITERM, or tune it.",
        LoopCalmed "Its loop did not bring the motor to a stand, so its output was switched off until the motor stood (DISABLEPID in FUNCTION). It is on again.",
        RadioInput "The R/C input drives the motor (mode 0).",
        AnalogInput "The analog input drives the motor (mode 1).",
        Buttons "The buttons drive the motor (mode 2).",
        AnalogSetpoint "The analog input moves the motor (mode 5, ADSERIAL is off).",
        LoopHolds "Its loop holds the motor where it stands, and turns it back if it is pushed.",
    }
}

messages! {
    /// What is odd about a unit that was found.
    pub enum MotionMindIdentityMessage {
        UnknownMode { number: i64 } "It says that its mode is {number}, which the manual does not have.",
        LoopIsOff "The output of its loop is switched off (DISABLEPID in FUNCTION); a stop or a run that was cut short may have left it so. Arming, or `drive`, switches it on again: the motor is then held where it stands.",
        Loose "It answers the read of all registers and no other: a simulator, whose values are shown as they come.",
    }
}
