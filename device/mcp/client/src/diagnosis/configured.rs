//! Settings that keep the motors from running.

use crate::diagnosis::evidence::{Evidence, Script};
use crate::diagnosis::finding::Hindrance::{BlocksAll, BlocksSome, Limits};
use crate::diagnosis::finding::{Finding, finding};
use crate::messages::{CureMessage, FindingMessage};
use brushwork_link::Message;
use brushwork_link::settings::{SettingValue, SettingsImage, SettingsTable};
use brushwork_link::transport::Stream;

/// A script runs at power-up from this delay on (public clients, 2025: smaller ones are refused).
const AUTORUN_FROM_MS: i64 = 100;

/// The settings that a diagnosis looks at, so that it can be made without reading all of them.
#[must_use]
pub fn keys(table: &SettingsTable) -> Vec<String> {
    const LAST_PARTS: [&str; 7] =
        ["type", "digital", "target", "min_action", "max_action", "timeout", "serial_timeout"];
    const STARTS: [&str; 5] = ["priority.", "limits.", "script.", "unit.estop_reset", "unit.bridge_channels"];
    const LOOPS: [&str; 6] =
        ["velocity.qpps", "position.min", "position.max", "position.p", "position.i", "position.d"];
    let wanted = |key: &str| {
        STARTS.iter().any(|start| key.starts_with(start))
            || LAST_PARTS.iter().any(|part| key.ends_with(&format!(".{part}")))
            || LOOPS.iter().any(|part| key.ends_with(&format!(".{part}")))
    };
    table.rows().iter().filter(|row| wanted(&row.key)).map(|row| row.key.clone()).collect()
}

/// What the settings keep the motors from.
pub fn findings(evidence: &Evidence<'_>) -> Vec<Finding> {
    let Some(settings) = evidence.settings else {
        return started_script(evidence).into_iter().collect();
    };
    let reasons = [
        priorities(settings),
        time_out(settings, evidence.stream),
        script(settings, evidence),
        qpps(settings),
        position_limits(settings),
        position_gains(settings),
        bridged(settings),
    ];
    reasons.into_iter().flatten().collect()
}

/// Without Serial in any level no command of this program is listened to (MCP manual 1.2.10, command 139).
fn priorities(settings: &SettingsImage) -> Option<Finding> {
    let levels: Vec<SettingValue> =
        (1..=3).filter_map(|level| settings.get(&format!("priority.{level}"))).collect();
    let has_serial = levels.contains(&SettingValue::Choice("serial"));
    (levels.len() == 3 && !has_serial)
        .then(|| finding(BlocksAll, FindingMessage::SerialNowhere, CureMessage::SetSerialLevel))
}

/// Without a time-out of the controller's own the motors would run on after this program, so nothing arms.
fn time_out(settings: &SettingsImage, stream: Option<Stream>) -> Option<Finding> {
    let blocked = |what: FindingMessage| finding(BlocksAll, what, CureMessage::SetTimeout);
    if settings.get("unit.serial_timeout") == Some(SettingValue::Number(0.0)) {
        return Some(blocked(FindingMessage::NoSerialTimeout));
    }
    let candidates = Stream::ALL.into_iter().filter(|candidate| match stream {
        Some(stream) => *candidate == stream,
        None => {
            let kind = settings.get(&format!("stream.{}.type", candidate.key()));
            kind == Some(SettingValue::Choice("packet_serial"))
        }
    });
    let zero = |stream: &Stream| {
        settings.get(&format!("stream.{}.timeout", stream.key())) == Some(SettingValue::Int(0))
    };
    candidates.into_iter().find(zero).map(|stream| blocked(FindingMessage::NoTimeout { stream }))
}

fn script(settings: &SettingsImage, evidence: &Evidence<'_>) -> Option<Finding> {
    let started = started_script(evidence);
    if started.is_some() || evidence.script == Script::Stopped {
        return started;
    }
    let delay_ms = settings.get("script.autorun_delay")?.int()?;
    (delay_ms >= AUTORUN_FROM_MS)
        .then(|| finding(BlocksSome, FindingMessage::AutorunScript { delay_ms }, CureMessage::EndAutorun))
}

fn started_script(evidence: &Evidence<'_>) -> Option<Finding> {
    (evidence.script == Script::Started)
        .then(|| finding(BlocksSome, FindingMessage::Script, CureMessage::EndScript))
}

/// QPPS scales every speed (MCP manual 2.4.5).
fn qpps(settings: &SettingsImage) -> Option<Finding> {
    let motors = motors_with(|motor| whole(settings, motor, "velocity.qpps") == Some(0));
    let motors = named(&motors)?;
    Some(finding(BlocksSome, FindingMessage::NoQpps { motors }, CureMessage::MeasureQpps))
}

/// Equal limits leave no room to move (MCP manual 2.4.7).
fn position_limits(settings: &SettingsImage) -> Option<Finding> {
    let limits =
        |motor| Some((whole(settings, motor, "position.min")?, whole(settings, motor, "position.max")?));
    let motors = motors_with(|motor| limits(motor).is_some_and(|(min, max)| min >= max));
    let (min, max) = limits(*motors.first()?)?;
    let motors = named(&motors)?;
    Some(finding(BlocksSome, FindingMessage::NoTravel { motors, min, max }, CureMessage::SetTravel))
}

fn position_gains(settings: &SettingsImage) -> Option<Finding> {
    let is_zero = |motor: u8, gain: &str| {
        let key = format!("motor{motor}.position.{gain}");
        matches!(settings.get(&key), Some(SettingValue::Number(value)) if value == 0.0)
    };
    let motors = motors_with(|motor| ["p", "i", "d"].iter().all(|gain| is_zero(motor, gain)));
    let motors = named(&motors)?;
    Some(finding(BlocksSome, FindingMessage::NoGains { motors }, CureMessage::TunePosition))
}

/// One motor on both bridges (MCP manual 1.8).
fn bridged(settings: &SettingsImage) -> Option<Finding> {
    (settings.get("unit.bridge_channels") == Some(SettingValue::Bool(true)))
        .then(|| finding(Limits, FindingMessage::Bridged, CureMessage::CommandMotor1))
}

fn motors_with(is_so: impl Fn(u8) -> bool) -> Vec<u8> {
    [1, 2].into_iter().filter(|motor| is_so(*motor)).collect()
}

/// "motor 2", "both motors"; none for none.
fn named(motors: &[u8]) -> Option<Message> {
    Some(match motors {
        [] => return None,
        [one] => FindingMessage::OneMotor { motor: usize::from(*one) }.into(),
        _ => FindingMessage::BothMotors.into(),
    })
}

fn whole(settings: &SettingsImage, motor: u8, what: &str) -> Option<i64> {
    settings.get(&format!("motor{motor}.{what}"))?.int()
}
