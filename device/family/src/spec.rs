//! The text behind `sim:` of a family with one model: its name, then options, `KEY=VALUE` each.
//!
//! `,`, `?` and `&` stand between them. A part without `=` is one more value of the option before it, where that takes several:
//! `motion-mind-3?mode=4&address=1,2`.

use brushwork_plant::presets;
use std::fmt::Display;

const SEPARATORS: [char; 3] = [',', '?', '&'];

/// Whether the text asks for units of this model.
#[must_use]
pub fn asks_for(text: &str, model: &str) -> bool {
    text.split(SEPARATORS).next().is_some_and(|name| name.trim().eq_ignore_ascii_case(model))
}

/// The options behind the model's name, in their order.
///
/// # Errors
/// The part that is no option and no further value of one of the keys `lists`.
pub fn options<'a>(text: &'a str, lists: &[&str]) -> Result<Vec<(&'a str, &'a str)>, &'a str> {
    let mut options: Vec<(&str, &str)> = Vec::new();
    for part in text.split(SEPARATORS).map(str::trim).skip(1).filter(|part| !part.is_empty()) {
        let list = options.last().map(|(key, _)| *key).filter(|key| lists.contains(key));
        let option = part.split_once('=').map(|(key, value)| (key.trim(), value.trim()));
        options.push(option.or(list.map(|key| (key, part))).ok_or(part)?);
    }
    Ok(options)
}

/// The name of a motor preset, if there is one of that name.
///
/// # Errors
/// A clause with all names.
pub fn preset(name: &str) -> Result<String, String> {
    let preset = presets::lookup(name).map(|preset| preset.key.clone());
    preset.ok_or_else(|| format!("\"{name}\" is no motor preset. There are {}", presets::keys().join(", ")))
}

/// The seed of noise and faults.
///
/// # Errors
/// A clause with what a seed is.
pub fn seed(text: &str) -> Result<u64, String> {
    text.parse().map_err(|_| format!("\"{text}\" is no seed. Use a whole number"))
}

/// A unit more, at an address that none of the line has yet.
///
/// # Errors
/// A clause: another unit has it.
pub fn add<A: PartialEq>(units: &mut Vec<A>, address: A, name: impl Display) -> Result<(), String> {
    if units.contains(&address) {
        return Err(format!(
            "two simulated controllers are given the address {name}; units on one line need different ones"
        ));
    }
    units.push(address);
    Ok(())
}
