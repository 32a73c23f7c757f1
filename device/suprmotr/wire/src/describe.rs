//! Commands and reports in words, for the traffic view.

use crate::line::{Command, Line};
use crate::report::{Report, ReportLine};
use crate::single::Single;
use crate::status::{ErrorCode, INPUT_BITS, LIMIT_BITS, MOTION_BITS, OPERATION_BITS, Status};

/// A command in words: "Move Relative 500 counts".
pub fn describe_command(command: &Command) -> String {
    let row = command.row();
    let number = command.number.map_or_else(String::new, |number| {
        let unit = row.takes.map_or("", |takes| takes.unit.symbol());
        format!(" {number}{}{unit}", if unit.is_empty() { "" } else { " " })
    });
    format!("{}{number}", row.title)
}

/// A line in words.
pub fn describe_line(line: &Line) -> String {
    let commands: Vec<_> = line.commands.iter().map(describe_command).collect();
    let commands = commands.join(", ");
    line.defines.map_or_else(|| commands.clone(), |number| format!("define macro {number}: {commands}"))
}

/// A command of one character in words.
pub fn describe_single(single: Single) -> String {
    match single {
        Single::Abort => "stop all units".to_owned(),
        Single::EndMacro => "end the running macro".to_owned(),
        Single::Position | Single::FollowingError | Single::Iteration | Single::Status | Single::Channels => {
            single.mnemonic().map_or_else(String::new, |mnemonic| mnemonic.row().title.to_owned())
        }
    }
}

/// A report in words: "Tell Position 20002".
pub fn describe_report(report: &Report) -> String {
    let lines: Vec<_> = report.lines.iter().map(describe_report_line).collect();
    let text = if lines.is_empty() { "nothing".to_owned() } else { lines.join("; ") };
    report.address.map_or_else(|| text.clone(), |address| format!("{address}: {text}"))
}

fn describe_report_line(line: &ReportLine) -> String {
    match line {
        ReportLine::Number { of, value } => format!("{} {value}", of.row().title),
        ReportLine::Status(status) => describe_status(*status),
        ReportLine::Analog { channel: 0, values } => format!("analog inputs {values:?}"),
        ReportLine::Analog { channel, values } => {
            format!("analog input {channel} {}", values.first().copied().unwrap_or_default())
        }
        ReportLine::Channels { outputs, inputs } => format!("outputs {outputs:04X}, inputs {inputs:04X}"),
        ReportLine::Channel { channel, is_on } => {
            format!("input {channel} {}", if *is_on { "on" } else { "off" })
        }
        ReportLine::Macro(line) => describe_line(line),
        ReportLine::Text(text) => text.clone(),
    }
}

/// The bits that are set, by name, and the error.
pub fn describe_status(status: Status) -> String {
    let bytes = [status.operation, status.motion, status.limits, status.inputs];
    let tables = [OPERATION_BITS, MOTION_BITS, LIMIT_BITS, INPUT_BITS];
    let set = bytes.into_iter().zip(tables).flat_map(|(byte, bits)| {
        bits.iter().filter(move |bit| byte & bit.mask() != 0).map(|bit| bit.name.to_owned())
    });
    let error = (status.error != 0).then(|| {
        let text = ErrorCode::from_number(status.error).map_or("not in the manual", ErrorCode::text);
        format!("error {:02X} ({text})", status.error)
    });
    let words: Vec<_> = set.chain(error).collect();
    if words.is_empty() { "status: no bit set".to_owned() } else { format!("status: {}", words.join(", ")) }
}
