//! What this family says to people, in its words: one table for each theme.

use brushwork_link::Message;
use brushwork_link::unit::UnitAddress;
use brushwork_motion_mind_wire::Mode;
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
        NoTimeout "A Motion Mind has no serial time-out: if the cable or this computer dies, the motor goes on with what it was last told. Have a switch for the motor power at hand.",
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

messages! {
    /// What is tried, as a bare verb phrase.
    pub enum MotionMindActMessage {
        Arm "arm the motor",
        Stop "stop the motor",
        Store { register: &'static str } "store {register} in EEPROM",
        Reload "load the settings from EEPROM (RESET)",
        Restore "restore the factory values (RESTORE)",
    }
}

messages! {
    /// What came back of what was tried, as a clause.
    pub enum MotionMindCauseMessage {
        NothingAnswered { asked: Message } "nothing answered at {asked}, in binary or in ASCII",
        BytesCame { count: u64, asked: Message } "{count} bytes came, but no Motion Mind, from {asked}",
        AllAddresses "addresses 1 to 98",
        OneMotor "it has one motor, motor 1",
        SecondMotor "a Motion Mind has one motor",
        NoCommand { command: u8, count: usize } "a Motion Mind has no command {command:#04X} with {count} values that fit",
        DutyOutside "a duty is from -100 % to 100 %",
        SpeedOutside "the speed is more than 32,767 counts per PID loop",
        DistanceOutside "the distance is more than 2,147,483,647 counts",
        UnknownRegister { register: u8 } "register {register} is not known, nor is how long its reply would be",
        RegisterMissing { register: u8 } "the reply does not hold register {register}",
        OneCommand "one command goes out at a time",
        OneLine "one whole line goes out at a time, with its line end",
        NeverZ "Z is never sent: the self-test leaves the unit dead until its power is switched off and on",
        NeverSelfTest "the self-test is never sent",
        Address { address: u8 } "address {address}",
        NotAtRest "its drive is not 0",
        NoAnswerAfterwards "no answer afterwards, neither at its address nor at 1",
        LoopMoves "its loop is switched off (DISABLEPID in FUNCTION), and the motor does not stand still when it is switched on",
        OtherMode { now: i64, found: Mode } "it is in mode {now} now and was in {found} when it was found",
        AnalogSetpoint "in mode 5 its setpoint is the analog input",
        Takes { mode: Mode, taken: &'static str } "in {mode} it takes {taken}",
        Braked "its brake input is at ground",
        TooHot "it is too hot; its bridge is off",
    }
}

messages! {
    /// What to do, as a sentence without its full stop.
    pub enum MotionMindRemedyMessage {
        CutPower "Cut the motor power now: the motor may still be running",
        CheckPowerAndPort "Check that the controller has power, that the cable and the port are right, and the baud rate: 9600 or 19200 by switch 5, or what FUNCTION2 was set to",
        CheckBaudRate "Check the baud rate: 9600 or 19200 by switch 5, or what FUNCTION2 was set to",
        CheckPower "Check its power and connect again",
        LowerGains "See that nothing turns the motor, and lower PTERM and ITERM",
        ConnectAgain "Connect again",
        SetAdserial "Set ADSERIAL in FUNCTION, so that the setpoint comes over the serial line",
        SetSwitches "Set switches 2 to 4 for mode 3 or 4, and switch the power off and on",
        ReleaseBrake "Release the brake input, J4 pin 12",
        CoolDown "Let it cool down below 80 °C",
    }
}
