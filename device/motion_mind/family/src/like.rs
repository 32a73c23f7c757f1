//! A simulated unit that behaves as an examination says.

use crate::sim_spec::MotionMindSpec;
use brushwork_family::examine::Examination;
use brushwork_motion_mind_wire::{Mode, Protocol};
use serde_json::Value;

impl MotionMindSpec {
    /// A unit like the one that was examined, and what of it cannot be imitated, a sentence each.
    ///
    /// # Errors
    /// A clause: the examination does not say what the simulator has to know.
    pub fn like(examination: &Examination) -> Result<(Self, Vec<String>), String> {
        let switches = examination.value("switches");
        let told = switches.and_then(|switches| {
            let mode = Mode::from_number(u8::try_from(switches["mode"].as_u64()?).ok()?)?;
            Some((mode, Protocol::from_key(switches["protocol"].as_str()?)?))
        });
        let Some((mode, protocol)) = told else {
            return Err("the examination does not say how the switches of the unit stand".to_owned());
        };
        let revision = examination.unit.firmware.parse();
        let revision =
            revision.map_err(|_| "the examination does not say the revision of the firmware".to_owned())?;
        let lacking = examination.value("lacking").and_then(Value::as_array);
        let numbers = lacking.into_iter().flatten().filter_map(Value::as_u64);
        let lacks = numbers.fold(0, |mask, number| {
            mask | u32::try_from(number).ok().and_then(|number| 1_u32.checked_shl(number)).unwrap_or(0)
        });
        let unlike = [
            ("back_to_back", true, "It takes commands only behind a pause."),
            ("small_letters", true, "It does not take small letters."),
            ("line_feed", true, "It does not take a line feed alone."),
            ("tick", true, "Its TIME counts other steps than 5 ms."),
        ];
        let unlike = unlike.into_iter().filter(|(key, usual, _)| {
            examination.value(key).and_then(Value::as_bool).is_some_and(|found| found != *usual)
        });
        let mut unlike: Vec<String> =
            unlike.map(|(.., what)| format!("{what} A simulated unit does otherwise.")).collect();
        let read_only = examination.value("read_only");
        if read_only.is_some_and(|found| found["acknowledged"] != true || found["changes"] != false) {
            unlike.push(
                "It takes writes to registers that only it changes otherwise than a simulated unit."
                    .to_owned(),
            );
        }
        Ok((Self { mode, protocol, revision, lacks, ..Self::default() }, unlike))
    }
}
