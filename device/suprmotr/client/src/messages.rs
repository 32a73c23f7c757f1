//! What this family says to people, in its words: one table for each theme.

use brushwork_link::Message;
use brushwork_link::unit::UnitAddress;
use brushwork_values::messages;

messages! {
    /// What to know of settings before they are written, and why some cannot be.
    pub enum SuprMotrSettingsMessage {
        NoAddress { address: UnitAddress } "{address} is no SuprMotr's",
        ValuesDoNotFit "the command does not take the values",
        LimitsOff "The limit switches will not stop the motor any more: nothing ends a move but its target.",
        LimitLevel "If the switches are wired the other way, they count as on at once, and stop the motor in one direction or both.",
        FollowingError "No command tells this limit: what was last set here is shown, and nothing else is known of it.",
    }
}

messages! {
    /// What drives a motor besides this program, and what arming and stopping did to the loop.
    pub enum SuprMotrDriverMessage {
        NoTimeout "A SuprMotr has no serial time-out: if the cable or this computer dies, it ends the move or the macro that it was told. Have a switch for the motor power at hand.",
        Fence "What ends a move besides its target: the limit switches, and a lag of more counts than SM allows, which no command tells (factory: 10,000).",
        NoLimits "Its limit switches are switched off (LF): nothing but SM ends a move before its target.",
        AtNegativeLimit "The negative limit switch is on: moves in that direction do nothing.",
        AtPositiveLimit "The positive limit switch is on: moves in that direction do nothing.",
        Lags { counts: i32 } "Its position is {counts} counts from where it should be.",
        MotorSwitchedOn "Its motor was off. It was switched on again where it stands (AB, MN): the loop holds it.",
        MacroRuns "A macro or a repeated line runs on it and may move the motor.",
        LoopHolds "Its loop keeps the motor at its target, and turns it back if it is pushed.",
        LoopLeftOff "Its loop did not hold the motor still, so the motor was switched off (MF): nothing holds it. The next Arm or `drive` switches it on again. A loop that shakes its motor needs other gains: lower DP and DI.",
    }
}

messages! {
    /// What is odd about a unit that was found.
    pub enum SuprMotrIdentityMessage {
        MacroRuns "A macro or a wait was in process when it was found. Polling leaves it alone; a line, as for reading the settings, would end it.",
        MotorOff "Its motor is off (MF). Arming, or `drive`, switches it on again where it stands.",
        OtherRate { baud: u32 } "It answers at {baud} baud.",
    }
}

messages! {
    /// What is tried, as a bare verb phrase.
    pub enum SuprMotrActMessage {
        Arm "arm the axis",
        Stop "stop the axis",
        Save "store the settings in EEPROM (UD)",
        Reload "load the settings from EEPROM (RT)",
        Restore "write the factory values",
    }
}

messages! {
    /// What came back of what was tried, as a clause.
    pub enum SuprMotrCauseMessage {
        NothingAnswered { asked: Message } "no position came from {asked}",
        BytesCame { count: u64, asked: Message } "{count} bytes came, but no SuprMotr, from {asked}",
        AllAddresses "addresses 0 to F",
        Address { address: char } "the address {address}",
        SmUntold "a SuprMotr takes it with SM and reports it by no command",
        OneMotor "it has one axis, motor 1",
        SecondMotor "a SuprMotr has one motor",
        NoCommand { command: u8, count: usize } "a SuprMotr has no command {command} with {count} values that fit",
        MovesAlone "a SuprMotr takes moves and nothing else: a position or a distance",
        TooFar { counts: i64 } "the target would be {counts} counts from 0; a SuprMotr moves within 1,073,741,823 on both sides",
        ZeroAlone "the position of a SuprMotr can be set to 0 and to nothing else (DH)",
        MacroRuns { name: &'static str } "a macro or a wait is in process, which {name} would end; stop it first",
        Unsettled "the move was not finished, or the motor does not stand still",
        OneLine "one whole line goes out at a time, with its carriage return",
        NeverRepeat "a carriage return alone repeats the last line, which may move the motor again: type the line",
        OtherUnit "a selection of other units is not sent: choose the unit by its address",
        JumpsToTarget { counts: i32 } "its motor is off, and {counts} counts from its target: switched on (MN) it would jump there",
        Lagged "the position lagged further behind than SM allows",
        NoAnswerAfterwards "no answer afterwards",
        MacroZero "macro 0 is defined, and a restart (RT) would run it, which may move the motor",
        OtherAnswered { address: char } "unit {address} answered instead",
        Disagrees { error: u8, text: &'static str } "error {error:02X}: {text}",
        NotListed { error: u8 } "error {error:02X}, which the manual does not have",
    }
}

messages! {
    /// What to do, as a sentence without its full stop.
    pub enum SuprMotrRemedyMessage {
        CutPower "Cut the motor power now: the axis may still be moving",
        CheckPowerAndPort "Check that the controller has power, that the cable and the port are right, and the baud rate: 9600, 19200 or 38400",
        CheckBaudRate "Check the baud rate: 9600, 19200 or 38400",
        CheckPower "See that it has power, and connect again",
        StopFirst "Stop it first: Stop ends macros and repeated lines",
        SetTarget "Define the target again by hand, for example with DH, or turn the motor back",
        FreeTheAxis "See what holds the axis, and arm again",
        EraseMacro "Erase it (RZ), or switch the power off and on yourself",
    }
}
