//! What a save does besides saving.

use super::{Asked, address, hear, if_answered};
use brushwork_family::examine::Examination;
use brushwork_link::device::{JobContext, Leave};
use brushwork_mcp_wire::packet_serial::name::{ENCODER_M1, ENCODER_M2};
use brushwork_mcp_wire::packet_serial::{commands, number};
use serde_json::json;
use std::time::Duration;

/// How long a unit may be deaf after a save: one that restarts was given 3 s by a public client.
const LONGEST: Duration = Duration::from_secs(8);
/// How often it is asked whether it is back.
const LOOK: Duration = Duration::from_millis(20);
/// A unit that is deaf for longer has done more than write.
const RESTART: Duration = Duration::from_millis(500);

/// Asks.
pub fn ask(context: &mut JobContext<'_>, found: &mut Examination) -> Asked {
    context.set_quiet(true);
    let asked = save(context, found);
    context.set_quiet(false);
    asked
}

fn save(context: &mut JobContext<'_>, found: &mut Examination) -> Asked {
    let before = counts(context)?;
    let is_acknowledged = if_answered(context.transact(number::SAVE_SETTINGS, &[]))?.is_some();
    let from = context.now();
    let version = [address(context).get(), number::READ_VERSION];
    let mut deaf_for = None;
    while deaf_for.is_none() && context.now() < from + LONGEST {
        let asked_at = context.now();
        if hear(context, &version, Leave::Read)?.took.is_some() {
            deaf_for = Some(asked_at.saturating_sub(from));
        } else {
            context.sleep(LOOK)?;
        }
    }
    let Some(deaf_for) = deaf_for else {
        found.unclear("save_restarts", "It did not answer again within 8 s.");
        return Ok(());
    };
    let after = counts(context)?;
    let lost = before.zip(after).map(|(before, after)| before != [0, 0] && after == [0, 0]);
    let is_restart = match (lost, before) {
        (Some(true), _) => Some(true),
        (Some(false), Some(before)) if before != [0, 0] => Some(false),
        // The counts tell nothing.
        _ if deaf_for < RESTART => Some(false),
        _ => None,
    };
    let ack = if is_acknowledged { "acknowledged" } else { "not acknowledged" };
    let value = json!({ "restarts": is_restart, "acknowledged": is_acknowledged });
    match is_restart {
        Some(true) => found.answered("save_restarts", value, format!("Yes: the counts are lost. 94 was {ack}.")),
        Some(false) => found.answered("save_restarts", value, format!("No. 94 was {ack}.")),
        None => found.unclear(
            "save_restarts",
            "It was deaf for long, as a unit that restarts is; with both encoder counts at 0 nothing tells for sure. Turn a shaft and ask again.",
        ),
    }
    found.measured("save_restarts", json!({ "deaf_ms": deaf_for.as_secs_f64() * 1e3 }));
    Ok(())
}

/// Both encoder counts, which a restart loses.
fn counts(context: &mut JobContext<'_>) -> Asked<Option<[i64; 2]>> {
    let reply = if_answered(context.transact(number::READ_ENCODERS, &[]))?;
    let values = reply.and_then(|values| commands::READ_ENCODERS.reply(values));
    Ok(values.map(|values| [values.int(ENCODER_M1), values.int(ENCODER_M2)]))
}
