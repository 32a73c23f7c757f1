//! The bytes that wait to be sent: edited settings that were not written yet, and what the sliders stand for.

use brushwork_link::Message;
use brushwork_link::device::Drive;

use crate::messages::PacketMessage;
use crate::model::{Connection, Screen};

/// One packet that waits.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Pending {
    pub title: String,
    pub bytes: Vec<u8>,
    /// In words.
    pub text: String,
}

/// All packets that wait, in the order in which they would be sent; or why the settings cannot be written as they are.
pub fn pending(connection: &Connection, screen: Screen) -> (Vec<Pending>, Vec<Message>) {
    let Some(identity) = connection.link.identity() else { return (Vec::new(), Vec::new()) };
    let (address, generation) = (identity.unit_address(), identity.generation);
    let packet = |title: String, bytes: Vec<u8>| {
        let text = identity.describe_sent(&bytes).text;
        Pending { title, bytes, text }
    };
    let mut packets = Vec::new();
    let mut refusals = Vec::new();
    match connection
        .settings
        .unit()
        .filter(|unit| !unit.edits().is_empty())
        .map(|unit| unit.plan(connection.link.stream))
    {
        Some(Ok(plan)) => {
            let steps = plan.steps.iter().filter_map(|step| {
                Some(packet(
                    PacketMessage::Write { step: step.title().to_string() }.to_string(),
                    step.bytes(address, generation).ok()?,
                ))
            });
            packets.extend(steps);
        }
        Some(Err(reasons)) => refusals.extend(reasons.into_iter().map(|refusal| refusal.sentence)),
        None => {}
    }
    if let Some(drive) = drive_of(connection, screen) {
        let bytes = identity.preview(&drive);
        packets.extend(
            bytes.into_iter().map(|bytes| packet("Drive: what the sliders stand for".to_owned(), bytes)),
        );
    }
    (packets, refusals)
}

/// What the sliders of a screen would send if both were moved.
fn drive_of(connection: &Connection, screen: Screen) -> Option<Drive> {
    let scope = screen.arm_scope()?;
    let mut sliders = connection.sliders();
    for setpoints in
        [&mut sliders.pwm.setpoints, &mut sliders.velocity.setpoints, &mut sliders.position.setpoints]
    {
        setpoints.touch();
    }
    connection.family().to_send(scope, sliders)
}
