//! The registers of a Motion Mind in a report: what is there, what is proposed.

use brushwork_core::tune::law::Report;
use brushwork_motion_mind_wire::FUNCTION_BITS;

/// Rows of name, current and proposed value, and what is on the wire; none for another family or without gains.
pub fn rows(report: &Report) -> Vec<Vec<String>> {
    let Some(old) = report.before.and_then(|before| before.held.mind.motion_mind) else { return Vec::new() };
    let (old, Some(new)) = (old.registers, report.proposed.mind.motion_mind) else { return Vec::new() };
    let pairs = [
        ("PTERM", u32::from(old.pterm), u32::from(new.pterm)),
        ("ITERM", u32::from(old.iterm), u32::from(new.iterm)),
        ("DTERM", u32::from(old.dterm), u32::from(new.dterm)),
        ("PIDSCALAR", u32::from(old.pidscalar), u32::from(new.pidscalar)),
        ("VELOCITYFF", u32::from(old.velocity_ff), u32::from(new.velocity_ff)),
        ("DEADBAND", u32::from(old.deadband), u32::from(new.deadband)),
        ("FUNCTION", u32::from(old.function), u32::from(new.function)),
        ("FUNCTION2", u32::from(old.function2), u32::from(new.function2)),
    ];
    let mut rows: Vec<Vec<String>> = pairs
        .into_iter()
        .map(|(name, old, new)| vec![name.to_owned(), old.to_string(), new.to_string(), new.to_string()])
        .collect();
    for bit in FUNCTION_BITS.iter().filter(|bit| (old.function ^ new.function) & bit.mask() != 0) {
        let word = |function: u16| if function & bit.mask() == 0 { "clear" } else { "set" }.to_owned();
        rows.push(vec![format!("  {}", bit.name), word(old.function), word(new.function), String::new()]);
    }
    rows
}

/// How much of a speed's duty the feed-forward gives: its register is too small for all of it on most motors.
pub fn feed_forward(report: &Report) -> Option<String> {
    let covered = report.proposed.mind.motion_mind?.covered(report.qpps?);
    Some(format!("{:.0} % of a speed's duty", 100.0 * covered.min(1.0)))
}
