//! Older schemas: a chain of pure steps, each from one schema to the next, with a sentence for what it changed.
//!
//! A step sees the file's members as they stand, before any setting is judged against a table. For each older
//! schema there is a file of that time among the test fixtures.

use super::content::SCHEMA;
use super::json::Node;
use crate::messages::ProfileMessage;
use brushwork_values::Message;

/// The members of a profile's file, in their order.
pub(super) type Members = Vec<(String, Node)>;

/// From one schema to the next.
struct Step {
    from: u64,
    /// Changes the members; gives a sentence for each change.
    apply: fn(&mut Members) -> Vec<Message>,
}

/// One step for each older schema, in order.
static STEPS: &[Step] =
    &[Step { from: 1, apply: name_unit_and_note }, Step { from: 2, apply: name_raw_numbers }];

/// Brings members of schema `from` to the newest one, and says what that changed.
pub(super) fn upgrade(mut members: Members, from: u64) -> (Members, Vec<Message>) {
    let mut sentences = Vec::new();
    for step in STEPS.iter().filter(|step| step.from >= from) {
        sentences.extend((step.apply)(&mut members));
    }
    if from < SCHEMA {
        set(&mut members, "schema", Node::Int(i64::try_from(SCHEMA).unwrap_or(i64::MAX)));
    }
    (members, sentences)
}

/// Schema 2 says which unit the settings came from and why they were kept.
fn name_unit_and_note(members: &mut Members) -> Vec<Message> {
    let mut sentences = Vec::new();
    for (name, told) in [("unit", ProfileMessage::UnitUnsaid), ("note", ProfileMessage::NoteUnsaid)] {
        if !members.iter().any(|(member, _)| member == name) {
            members.push((name.to_owned(), Node::Text(String::new())));
            sentences.push(told.into());
        }
    }
    sentences
}

/// Schema 3 keeps the register of every setting beside its meaning. What schema 2 called a code is one.
fn name_raw_numbers(members: &mut Members) -> Vec<Message> {
    let settings = members.iter_mut().filter(|(member, _)| member == "settings");
    for (_, settings) in settings {
        let Node::Object(settings) = settings else { continue };
        for (_, setting) in settings {
            let Node::Object(setting) = setting else { continue };
            for (name, _) in setting.iter_mut().filter(|(name, _)| name == "code") {
                "raw".clone_into(name);
            }
        }
    }
    // Every value is what it was: there is nothing to tell.
    Vec::new()
}

fn set(members: &mut Members, name: &str, value: Node) {
    match members.iter_mut().find(|(member, _)| member == name) {
        Some((_, old)) => *old = value,
        None => members.push((name.to_owned(), value)),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn there_is_a_step_from_every_older_schema() {
        let from: Vec<u64> = STEPS.iter().map(|step| step.from).collect();
        assert_eq!(from, (1..SCHEMA).collect::<Vec<_>>());
    }
}
