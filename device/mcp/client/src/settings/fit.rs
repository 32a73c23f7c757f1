//! A profile's inputs and encoders on another model: inputs go by their printed name, encoders by their channel.

use crate::messages::McpSettingsMessage;
use crate::model_of;
use brushwork_link::Message;
use brushwork_link::settings::{Fit, Row, SettingValue};
use brushwork_mcp_wire::codes::ENCODER_PIN_NONE;
use brushwork_mcp_wire::models::{Model, Pin};

/// The profile's model and the other one.
fn models(fit: &Fit<'_>) -> Option<(&'static Model, &'static Model)> {
    let (from, to) = fit.subjects();
    Some((model_of(from)?, model_of(to)?))
}

/// The pin over there, from 0, that stands for a pin of the profile: the one of the same encoder channel for
/// what serves as an encoder, the one of the same name for everything else.
pub fn pin_place(fit: &Fit<'_>, pin: usize) -> Option<usize> {
    let (from, to) = models(fit)?;
    if from.key == to.key {
        return (pin < fit.to.subject().pins).then_some(pin);
    }
    let wanted = from.pins.get(pin)?;
    let there = if serves_encoder(fit, pin) {
        to.pins.iter().position(|other| {
            other.encoder_channel().is_some() && other.encoder_channel() == wanted.encoder_channel()
        })
    } else {
        let named = to.pins.iter().position(|other| other.name() == wanted.name());
        // That one is taken by an encoder of the profile.
        named.filter(|named| !is_encoder_place(fit, *named))
    };
    there.filter(|there| *there < fit.to.subject().pins)
}

fn serves_encoder(fit: &Fit<'_>, pin: usize) -> bool {
    let kind = fit.profile.settings.get(&format!("pin.{}.type", pin + 1));
    kind == Some(SettingValue::Choice("encoder"))
        && models(fit)
            .and_then(|(from, _)| from.pins.get(pin))
            .is_some_and(|pin| pin.encoder_channel().is_some())
}

fn is_encoder_place(fit: &Fit<'_>, there: usize) -> bool {
    let Some((from, to)) = models(fit) else { return false };
    let Some(wanted) = to.pins.get(there).and_then(|pin| pin.encoder_channel()) else { return false };
    (0..from.pins.len())
        .any(|pin| serves_encoder(fit, pin) && from.pins[pin].encoder_channel() == Some(wanted))
}

/// Encoder inputs are numbers in the pin list, which is another one there.
pub fn encoder_pin(fit: &Fit<'_>, value: SettingValue) -> Option<SettingValue> {
    let (from, to) = models(fit)?;
    let SettingValue::Int(number) = value else { return Some(value) };
    if from.key == to.key || number == ENCODER_PIN_NONE {
        return Some(value);
    }
    let wanted = from.pins.get(usize::try_from(number).ok()?)?;
    let by_channel =
        |pin: &Pin| wanted.encoder_channel().is_some() && pin.encoder_channel() == wanted.encoder_channel();
    let by_name = |pin: &Pin| wanted.encoder_channel().is_none() && pin.name() == wanted.name();
    let there = to.pins.iter().position(|pin| by_channel(pin) || by_name(pin))?;
    i64::try_from(there).ok().map(SettingValue::Int)
}

/// Why an input cannot have the type that the profile wants of it.
pub fn impossible_type(fit: &Fit<'_>, there: &Row, value: SettingValue) -> Option<Message> {
    if there.pattern != "pin.{n}.type" || fit.profile.subject.model == fit.to.subject().model {
        return None;
    }
    let pin = models(fit)?.1.pins.get(there.instance.as_ref()?.number - 1)?;
    let is_possible = match value.choice()? {
        "analog" => pin.is_analog(),
        "pulse" => pin.is_pulse(),
        "encoder" => pin.encoder_channel().is_some(),
        _ => true,
    };
    (!is_possible).then(|| {
        let kind = there.format_bare(value).to_lowercase();
        let model = fit.to.subject().model.name;
        McpSettingsMessage::NoSuchInput { pin: pin.label, kind, model }.into()
    })
}
