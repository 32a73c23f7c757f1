//! What the values of some registers mean (the pages behind MCP manual 3.1.15).

use super::table::RegisterId;

/// A value, or a bit of it, and what it means.
pub type Value = (u32, &'static str);

/// The named values of a register; empty for plain numbers.
#[must_use]
pub fn values(id: RegisterId) -> &'static [Value] {
    match id.row().name {
        "SYSSTATUS" => &SYSSTATUS,
        "DOUTACTION" => &DOUTACTION,
        "PRIORITYACTIVE" => &[(1, "serial"), (2, "pulse"), (4, "analog")],
        "MOTORFLAGS" => &MOTORFLAGS,
        "MOTORBUFFER" => {
            &[(0x7F, "mask of the commands that wait"), (0x80, "nothing waits and nothing runs")]
        }
        "STREAMTYPE" => &[(0, "script"), (1, "packet serial")],
        "SIGNALTYPE" => &[(0, "none"), (1, "analog"), (2, "RC pulse or PWM"), (3, "quadrature encoder")],
        "SIGNALTARGET" => &[(0, "motor 1"), (1, "motor 2")],
        "SIGNALMINACTION" | "SIGNALMAXACTION" => &SIGNAL_ACTIONS,
        "SIGNALMODE" => &[(0, "position"), (1, "percent"), (2, "mean speed"), (3, "speed")],
        _ => &[],
    }
}

/// What pages of the manual disagree about when a program compares a register with this value, masks it so or sets it so.
#[must_use]
pub fn dispute(id: RegisterId, value: i64) -> Option<&'static str> {
    match (id.row().name, value) {
        ("SYSSTATUS", 1..) => Some("The bits of SYSSTATUS are those of its page; command 90 has others."),
        ("SIGNALMODE", 2 | 3) => Some(
            "SIGNALMODE's page has 2 mean speed and 3 speed; that of SIGNALCOMMAND and command 143 swap them.",
        ),
        ("SIGNALTARGET", 2..) => Some("SIGNALTARGET's page has targets 0 and 1; command 143 has 0 to 3."),
        ("SIGNALPERCENT", ..0 | 32_768..) => {
            Some("SIGNALPERCENT is a WORD in the manual's table; here it goes from -32767 to 32767.")
        }
        ("SIGNALMINACTION" | "SIGNALMAXACTION", 256..) => Some(
            "The manual's table gives actions a BYTE, their page values up to 0x8000; here they are words.",
        ),
        _ => None,
    }
}

const SYSSTATUS: [Value; 11] = [
    (0x0001, "motor 1 over current"),
    (0x0002, "motor 2 over current"),
    (0x0004, "emergency stop"),
    (0x0010, "temperature 2 error"),
    (0x0020, "main battery high error"),
    (0x0040, "main battery low error"),
    (0x0080, "logic battery high error"),
    (0x0100, "logic battery low error"),
    (0x0800, "main battery high warning"),
    (0x4000, "temperature warning"),
    (0x8000, "temperature error"),
];

const DOUTACTION: [Value; 11] = [
    (0x01, "motor 1 is active"),
    (0x02, "motor 2 is active"),
    (0x03, "either motor is active"),
    (0x04, "motor 1 is reversed"),
    (0x05, "motor 2 is reversed"),
    (0x06, "either motor is reversed"),
    (0x07, "overvoltage"),
    (0x08, "over temperature"),
    (0x09, "as the LED STAT1"),
    (0x0A, "as the LED STAT2"),
    (0x0B, "as the LED ERR"),
];

const MOTORFLAGS: [Value; 11] = [
    (0x0001, "stop triggered"),
    (0x0002, "reverse triggered"),
    (0x0004, "forward stop triggered"),
    (0x0008, "backward stop triggered"),
    (0x0010, "load home triggered"),
    (0x0020, "emergency stop triggered"),
    (0x0040, "the motor is active"),
    (0x0080, "velocity control is on"),
    (0x0100, "position control is on"),
    (0x0200, "no command waits"),
    (0x0400, "a distance command runs"),
];

const SIGNAL_ACTIONS: [Value; 16] = [
    (0x0001, "motor 1 safe stop"),
    (0x0002, "motor 1 off"),
    (0x0004, "motor 1 reverse"),
    (0x0008, "motor 1 forward limit"),
    (0x0010, "motor 1 reverse limit"),
    (0x0020, "motor 1 loads its home value"),
    (0x0040, "run the script"),
    (0x0080, "reset the script"),
    (0x0100, "motor 2 safe stop"),
    (0x0200, "motor 2 off"),
    (0x0400, "motor 2 reverse"),
    (0x0800, "motor 2 forward limit"),
    (0x1000, "motor 2 reverse limit"),
    (0x2000, "motor 2 loads its home value"),
    (0x4000, "stop the script"),
    (0x8000, "emergency stop"),
];
