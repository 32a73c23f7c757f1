//! The table of all commands (SuprMotr manual, "Command Reference" and "Command Short Form").

use brushwork_values::Unit;
use serde::Serialize;

/// One command: how it is written, what it takes, what it reports and what it does.
#[derive(Debug, Clone, Copy)]
pub struct CommandRow {
    /// Which one it is.
    pub mnemonic: Mnemonic,
    /// Its two letters.
    pub name: &'static str,
    /// What the letters stand for.
    pub title: &'static str,
    /// The number behind the letters; `None` if it takes none.
    pub takes: Option<Parameter>,
    /// What it reports.
    pub reports: Reports,
    /// What it does to the axis or to the controller.
    pub effect: Effect,
    /// Where the manual has it.
    pub source: Source,
    /// What it does, in words.
    pub help: &'static str,
}

/// The number behind the letters of a command.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Parameter {
    /// What it is.
    pub name: &'static str,
    /// Its unit; the number on the wire is in it.
    pub unit: Unit,
    /// The least that is taken.
    pub low: i32,
    /// The most.
    pub high: i32,
    /// The only values that are taken; empty if all of the range are.
    pub only: &'static [i32],
    /// What counts when no number is given.
    pub absent: Absent,
}

/// What a command means that is written without its number.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Absent {
    /// Nothing: error 05. Assumed, where the manual is silent.
    Refused,
    /// The same as this number.
    Means(i32),
    /// All of them: it is a form of its own.
    All,
}

/// What a command reports.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Reports {
    /// Nothing.
    Nothing,
    /// One number with its sign and all its digits.
    Number {
        /// Its letter.
        id: u8,
        /// Another letter that the manual gives it in one place, or that controllers of this kind are known to send.
        also: Option<u8>,
    },
    /// One number as it is, without sign or zeros (letter O).
    Plain,
    /// The analog inputs (letter A).
    Analog,
    /// The digital channels (letter H).
    Channels,
    /// The six bytes of the status (letter S).
    Status,
    /// What these commands report, a line each.
    Each(&'static [Mnemonic]),
    /// Lines of text.
    Text,
    /// Macros, a line each.
    Macros,
}

/// What a command does.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Effect {
    /// It reports and changes nothing.
    Report,
    /// It changes a parameter in RAM.
    Setting,
    /// It changes what lasts: EEPROM, macros, the rate of the line.
    Lasting,
    /// It moves the axis to a place; sent twice it does the same.
    Motion,
    /// It moves the axis by a distance; sent twice it moves twice.
    RelativeMotion,
    /// It runs a macro, which may move the axis.
    Run,
    /// It ends a motion, or takes the drive off the motor.
    Stop,
    /// It changes what positions mean.
    Origin,
    /// It switches outputs.
    Output,
    /// It holds up, repeats or cuts short the line it stands in.
    Flow,
    /// The manual does not say what it does.
    Unknown,
}

/// Where the manual describes a command.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Source {
    /// It has a section in the command reference.
    Section,
    /// It stands in the short form alone.
    ShortForm,
}

impl Effect {
    /// Whether the axis may move because of it, so that it needs to be armed.
    pub const fn may_move(self) -> bool {
        match self {
            Self::Motion | Self::RelativeMotion | Self::Run | Self::Unknown => true,
            Self::Report
            | Self::Setting
            | Self::Lasting
            | Self::Stop
            | Self::Origin
            | Self::Output
            | Self::Flow => false,
        }
    }
}

impl Parameter {
    /// Whether the controller takes that number.
    pub fn allows(&self, value: i32) -> bool {
        (self.low..=self.high).contains(&value) && (self.only.is_empty() || self.only.contains(&value))
    }
}

/// The furthest position on both sides of 0: 2^30 - 1. The manual prints 1 073 741 843.
pub const FURTHEST_COUNTS: i32 = 1_073_741_823;
/// The highest number of a macro.
pub const LAST_MACRO: u8 = 14;
/// Commands of a line and of a macro.
pub const MOST_COMMANDS: usize = 15;
/// Digital channels.
pub const CHANNELS: u8 = 16;
/// The most that a gain and the integral limit can be.
pub const MOST_GAIN: i32 = 255;

const fn needs(name: &'static str, unit: Unit, low: i32, high: i32) -> Option<Parameter> {
    Some(Parameter { name, unit, low, high, only: &[], absent: Absent::Refused })
}

const fn takes(name: &'static str, unit: Unit, low: i32, high: i32, absent: Absent) -> Option<Parameter> {
    Some(Parameter { name, unit, low, high, only: &[], absent })
}

const fn one_of(name: &'static str, only: &'static [i32], low: i32, high: i32) -> Option<Parameter> {
    Some(Parameter { name, unit: Unit::None, low, high, only, absent: Absent::Refused })
}

const fn gain() -> Option<Parameter> {
    needs("gain", Unit::Gain, 0, MOST_GAIN)
}

const fn velocity() -> Option<Parameter> {
    needs("velocity", Unit::CountsPerSecond, 0, 1_000_000)
}

const fn acceleration() -> Option<Parameter> {
    needs("acceleration", Unit::CountsPerSecondSquared, 0, 10_000_000)
}

const fn macro_number(absent: Absent) -> Option<Parameter> {
    takes("macro", Unit::None, 0, LAST_MACRO as i32, absent)
}

const fn one_channel() -> Option<Parameter> {
    needs("channel", Unit::None, 1, CHANNELS as i32)
}

const fn channels() -> Option<Parameter> {
    takes("channel", Unit::None, 0, CHANNELS as i32, Absent::Means(0))
}

const NOTHING: Option<Parameter> = None;

const fn number(id: u8) -> Reports {
    Reports::Number { id, also: None }
}

const fn number_or(id: u8, also: u8) -> Reports {
    Reports::Number { id, also: Some(also) }
}

macro_rules! commands {
    ($($name:ident $title:literal, $takes:expr, $reports:expr, $effect:ident, $source:ident, $help:literal;)*) => {
        /// The two letters of a command.
        #[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
        #[repr(u8)]
        pub enum Mnemonic {
            $(#[doc = $title] $name,)*
        }

        /// Every command, in the order of the manual: those with a section first.
        pub static COMMANDS: &[CommandRow] = &[$(CommandRow {
            mnemonic: Mnemonic::$name, name: stringify!($name), title: $title, takes: $takes, reports: $reports,
            effect: Effect::$effect, source: Source::$source, help: $help,
        }),*];
    };
}

commands! {
    TP "Tell Position", NOTHING, number(b'P'), Report, Section, "position, counts";
    TT "Tell Target", NOTHING, number(b'T'), Report, Section, "where the loop drives the motor while it is on, counts";
    TS "Tell Status", NOTHING, Reports::Status, Report, Section, "six bytes: operation, motion, limits, inputs, mode, error; takes the error away";
    UD "Update", NOTHING, Reports::Nothing, Lasting, Section, "stores velocity, acceleration, gains and limits, to be active at power-up";
    DV "Define Velocity", velocity(), Reports::Nothing, Setting, Section, "velocity of the moves to come";
    GV "Get Velocity", NOTHING, number(b'Y'), Report, Section, "velocity as set";
    DA "Define Acceleration", acceleration(), Reports::Nothing, Setting, Section, "acceleration of the moves to come";
    GA "Get Acceleration", NOTHING, number_or(b'A', b'L'), Report, Section, "acceleration as set";
    DP "Define P-Term", gain(), Reports::Nothing, Setting, Section, "proportional gain";
    GP "Get P-Term", NOTHING, number(b'G'), Report, Section, "proportional gain as set";
    DI "Define I-Term", gain(), Reports::Nothing, Setting, Section, "integral gain; without effect while the integral limit is 0";
    GI "Get I-Term", NOTHING, number(b'I'), Report, Section, "integral gain as set";
    DL "Define Integral Limit", needs("limit", Unit::None, 0, MOST_GAIN), Reports::Nothing, Setting, Section, "limit of the integral; 0 switches it off";
    GL "Get Integral Limit", NOTHING, number_or(b'L', b'M'), Report, Section, "limit of the integral as set";
    SM "Set Maximum Following Error", needs("distance", Unit::Counts, 0, 32_767), Reports::Nothing, Setting, Section, "most that the position may lag behind; nothing tells it";
    BR "Define Baud Rate", needs("rate", Unit::None, 0, 2), Reports::Nothing, Lasting, Section, "0: 9600, 1: 19200, 2: 38400";
    RT "Reset Controller", NOTHING, Reports::Nothing, Run, Section, "restarts as at power-up: stored values, no address selected; macro 0 runs";
    EF "Echo Off", NOTHING, Reports::Nothing, Setting, Section, "received characters no longer come back";
    EN "Echo On", NOTHING, Reports::Nothing, Setting, Section, "every received character comes back";
    MN "Motor On", NOTHING, Reports::Nothing, Motion, Section, "the loop holds the motor, at the target it had when it was switched off: it may jump there";
    MF "Motor Off", NOTHING, Reports::Nothing, Stop, Section, "the motor is free; its position is still counted";
    AB "Abort Motion", takes("way", Unit::None, 0, 1, Absent::Means(0)), Reports::Nothing, Stop, Section, "0: stops at once, 1: with the acceleration; the target becomes the position";
    MR "Move Relative", needs("distance", Unit::Counts, -FURTHEST_COUNTS, FURTHEST_COUNTS), Reports::Nothing, RelativeMotion, Section, "moves by a distance";
    MA "Move Absolute", takes("position", Unit::Counts, -FURTHEST_COUNTS, FURTHEST_COUNTS, Absent::Means(0)), Reports::Nothing, Motion, Section, "moves to a position";
    RP "Repeat", takes("times", Unit::None, 0, 65_535, Absent::Means(65_535)), Reports::Nothing, Flow, Section, "the line once more, so many times; two of them repeat for ever";
    FE "Find Edge", one_of("edge", &[0, 1, 4], 0, 4), Reports::Nothing, Motion, Section, "0: forward until the positive limit is on, 1: back until the negative limit is on, 4: forward until the negative limit is off";
    DH "Define Home", NOTHING, Reports::Nothing, Origin, Section, "the position here is 0";
    GH "Go Home", NOTHING, Reports::Nothing, Motion, Section, "moves to position 0";
    WS "Wait for Stop", takes("time", Unit::Milliseconds, 0, 65_535, Absent::Means(1000)), Reports::Nothing, Flow, Section, "waits for the end of the trajectory and then this long";
    MD "Macro Definition", macro_number(Absent::Refused), Reports::Nothing, Lasting, Section, "the rest of the line becomes this macro; macro 0 runs at power-up";
    MC "Macro Call", macro_number(Absent::Refused), Reports::Nothing, Run, Section, "runs a macro; nothing if there is none of that number";
    TM "Tell Macro", macro_number(Absent::Means(0)), Reports::Macros, Report, Section, "lists a macro; 0: all of them";
    RM "Reset Macro", macro_number(Absent::All), Reports::Nothing, Lasting, Section, "erases a macro, or all of them";
    SO "Set Analog Output", needs("output", Unit::None, 0, 255), Reports::Nothing, Output, Section, "analog output, 5 V at 255";
    IO "Increment Analog Output", needs("step", Unit::None, -255, 255), Reports::Nothing, Output, Section, "adds to the analog output";
    TO "Tell Analog Output", NOTHING, Reports::Plain, Report, Section, "analog output, 5 V at 255";
    TA "Tell Analog Input", takes("input", Unit::None, 0, 2, Absent::Means(0)), Reports::Analog, Report, Section, "analog input 1 or 2, or both with 0; 5 V at 255";
    TC "Tell Channel", channels(), Reports::Channels, Report, Section, "0: outputs and inputs of all channels, else one input";
    CF "Channel Off", channels(), Reports::Nothing, Output, Section, "switches an output off, or all with 0";
    CN "Channel On", channels(), Reports::Nothing, Output, Section, "switches an output on, or all with 0";
    WN "Wait On", one_channel(), Reports::Nothing, Flow, Section, "waits until an input is on";
    WF "Wait Off", one_channel(), Reports::Nothing, Flow, Section, "waits until an input is off";
    XN "Execute if On", one_channel(), Reports::Nothing, Flow, Section, "the rest of the line only if an input is on";
    XF "Execute if Off", one_channel(), Reports::Nothing, Flow, Section, "the rest of the line only if an input is off";
    TQ "Tell Torque", NOTHING, number(b'Q'), Report, ShortForm, "torque; its scale is not known";
    SQ "Set Torque", needs("torque", Unit::None, 0, 255), Reports::Nothing, Unknown, ShortForm, "sets the torque; what it is of is not known, and its range is assumed";
    HE "Help", NOTHING, Reports::Text, Report, ShortForm, "lists the commands";
    TE "Tell Error", NOTHING, number(b'E'), Report, ShortForm, "distance from the target, counts";
    TF "Tell Following Error", NOTHING, number(b'F'), Report, ShortForm, "distance from position to dynamic target, counts";
    TD "Tell Dynamic Target", NOTHING, number(b'N'), Report, ShortForm, "where the trajectory is, counts";
    TV "Tell Velocity", NOTHING, number(b'V'), Report, ShortForm, "velocity as measured, counts/s";
    TY "Tell Programmed Velocity", NOTHING, number(b'Y'), Report, ShortForm, "velocity as set: GV";
    SV "Set Velocity", velocity(), Reports::Nothing, Setting, ShortForm, "velocity of the moves to come: DV";
    TL "Tell Acceleration", NOTHING, number_or(b'A', b'L'), Report, ShortForm, "acceleration as set: GA";
    SA "Set Acceleration", acceleration(), Reports::Nothing, Setting, ShortForm, "acceleration of the moves to come: DA";
    GD "Get D-Term", NOTHING, number(b'D'), Report, ShortForm, "derivative gain as set";
    DD "Define D-Term", gain(), Reports::Nothing, Setting, ShortForm, "derivative gain";
    VE "Version", NOTHING, Reports::Text, Report, ShortForm, "version of the firmware";
    TI "Tell Iteration", NOTHING, number(b'X'), Report, ShortForm, "how often the line is still to be repeated";
    TB "Tell Board Address", NOTHING, number(b'B'), Report, ShortForm, "address of the controller";
    DB "Define Board Address", needs("address", Unit::None, 0, 15), Reports::Nothing, Lasting, ShortForm, "every selected controller takes this address, in EEPROM";
    CS "Checksum", NOTHING, number(b'C'), Report, ShortForm, "checksum of the self-test";
    TJ "Tell Jog", NOTHING, number(b'J'), Report, ShortForm, "jog as set";
    SJ "Set Jog", needs("jog", Unit::None, -FURTHEST_COUNTS, FURTHEST_COUNTS), Reports::Nothing, Unknown, ShortForm, "sets the jog; what that is is not known, and its range is assumed";
    LN "Limits On", NOTHING, Reports::Nothing, Setting, ShortForm, "the limit switches stop the motor";
    LF "Limits Off", NOTHING, Reports::Nothing, Setting, ShortForm, "the limit switches do not stop the motor";
    LL "Limits Low", NOTHING, Reports::Nothing, Setting, ShortForm, "a limit switch is on while its input is low";
    LH "Limits High", NOTHING, Reports::Nothing, Setting, ShortForm, "a limit switch is on while its input is high";
    TG "Tell Gains", NOTHING, Reports::Each(&[Mnemonic::GP, Mnemonic::GI, Mnemonic::GD, Mnemonic::GL]), Report, ShortForm, "GP, GI, GD and GL";
    DM "Decimal Mode", NOTHING, Reports::Nothing, Setting, ShortForm, "numbers are decimal from now on, both ways";
    HM "Hexadecimal Mode", NOTHING, Reports::Nothing, Setting, ShortForm, "numbers are hexadecimal from now on, both ways";
    DU "Dump", NOTHING, Reports::Each(&[Mnemonic::TT, Mnemonic::TP, Mnemonic::TD, Mnemonic::TS]), Report, ShortForm, "TT, TP, TD and TS";
    WA "Wait", needs("time", Unit::Milliseconds, 0, 65_535), Reports::Nothing, Flow, ShortForm, "waits this long";
    CI "Channel Input", one_channel(), Reports::Nothing, Output, ShortForm, "the channel is an input";
    CT "Channel Output", one_channel(), Reports::Nothing, Output, ShortForm, "the channel is an output";
    CP "Channel Pattern", needs("pattern", Unit::Bits, 0, 65_535), Reports::Nothing, Output, ShortForm, "all outputs at once, channel 1 in bit 0; its form is assumed";
    EM "Execute Macro", macro_number(Absent::Refused), Reports::Nothing, Run, ShortForm, "runs a macro: MC";
    TZ "Tell Macro Zero", NOTHING, Reports::Macros, Report, ShortForm, "lists macro 0";
    RZ "Reset Macro Zero", NOTHING, Reports::Nothing, Lasting, ShortForm, "erases macro 0";
    PH "Encoder Phase", takes("phase", Unit::None, 0, 1, Absent::All), Reports::Nothing, Unknown, ShortForm, "direction in which the encoder counts: a wrong one makes the loop run away; its form is assumed";
    ST "Stop", NOTHING, Reports::Nothing, Stop, ShortForm, "stops with the acceleration";
}

impl Mnemonic {
    /// Its row.
    pub fn row(self) -> &'static CommandRow {
        &COMMANDS[self as usize]
    }

    /// Its two letters.
    pub fn name(self) -> &'static str {
        self.row().name
    }

    /// The command of two letters, in either case.
    pub fn from_letters(letters: [u8; 2]) -> Option<Self> {
        let named = |row: &&CommandRow| row.name.as_bytes().eq_ignore_ascii_case(&letters);
        COMMANDS.iter().find(named).map(|row| row.mnemonic)
    }

    /// The command of that number, by which shared code names it: its place in [`COMMANDS`].
    pub fn from_number(number: u8) -> Option<Self> {
        COMMANDS.get(usize::from(number)).map(|row| row.mnemonic)
    }

    /// Its place in [`COMMANDS`].
    pub fn number(self) -> u8 {
        self as u8
    }
}
