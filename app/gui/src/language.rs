//! The language of the window: English stands in the tables and where it is drawn, each other one in a file of `assets/languages`.
//!
//! A theme of messages is one entry of such a file, its members are the entry's attributes. What has no translation is English, and so is
//! all that is kept or sent: only what is drawn asks [`said`] and [`word`].

use std::cell::{Cell, LazyCell};
use std::fmt::Display;

use brushwork_values::{Message, Words};
use fluent_bundle::{FluentArgs, FluentBundle, FluentResource, FluentValue};
use serde::{Deserialize, Serialize};

#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Language {
    #[default]
    English,
    German,
}

/// The words in German, in the syntax of Fluent.
pub const GERMAN: &str = include_str!("../../../assets/languages/de.ftl");

thread_local! {
    static CURRENT: Cell<Language> = const { Cell::new(Language::English) };
    static IN_GERMAN: LazyCell<FluentBundle<FluentResource>> = LazyCell::new(|| bundle("de", GERMAN));
}

/// What is right of a file stands, whatever is wrong beside it.
fn bundle(language: &str, text: &str) -> FluentBundle<FluentResource> {
    let mut bundle = FluentBundle::new(language.parse().into_iter().collect());
    bundle.set_use_isolating(false);
    let resource = FluentResource::try_new(text.to_owned()).unwrap_or_else(|(resource, _)| resource);
    bundle.add_resource_overriding(resource);
    bundle
}

impl Language {
    /// From here on this thread draws in it.
    pub fn begin(self) {
        CURRENT.set(self);
    }
}

/// A message in the language of the window.
pub fn said(words: &impl Words) -> String {
    translated(&words.key(), || words.values()).unwrap_or_else(|| words.to_string())
}

/// What the message line shows, in the language of the window.
pub fn said_message(message: &Message) -> String {
    translated(&message.key(), || message.values()).unwrap_or_else(|| message.to_string())
}

/// Whether a message has words in the language of the window; else it is English, and so is what stands beside it in its line.
pub fn is_translated(message: &Message) -> bool {
    translated(&message.key(), || message.values()).is_some()
}

/// A title or label in the language of the window: its key is its theme and its English words.
pub fn word(theme: &str, english: &str) -> String {
    match CURRENT.get() {
        Language::English => english.to_owned(),
        Language::German => translated(&key(theme, english), Vec::new).unwrap_or_else(|| english.to_owned()),
    }
}

/// "start.open-a-file" of "Open a file…"; of a sentence its beginning.
pub fn key(theme: &str, english: &str) -> String {
    let lower = english.to_lowercase();
    let parts = lower.split(|letter: char| !letter.is_ascii_alphanumeric()).filter(|part| !part.is_empty());
    let parts: Vec<&str> = parts.take(12).collect();
    // An attribute begins with a letter.
    let first = if lower.starts_with(|letter: char| letter.is_ascii_digit()) { "n-" } else { "" };
    format!("{theme}.{first}{}", parts.join("-"))
}

fn translated<'a>(
    key: &str,
    values: impl FnOnce() -> Vec<(&'static str, &'a dyn Display)>,
) -> Option<String> {
    let in_language = match CURRENT.get() {
        Language::English => return None,
        Language::German => &IN_GERMAN,
    };
    in_language.with(|bundle| {
        let (theme, member) = key.split_once('.')?;
        let pattern = bundle.get_message(theme)?.get_attribute(member)?;
        let mut given = FluentArgs::new();
        for (name, value) in values() {
            given.set(name, value_of(in_words(value.to_string())));
        }
        let mut errors = Vec::new();
        let text = bundle.format_pattern(pattern.value(), Some(&given), &mut errors).into_owned();
        errors.is_empty().then_some(text)
    })
}

/// A value that begins with a word of ours: "address 0x80".
fn in_words(text: String) -> String {
    let Some((first, rest)) = text.split_once(' ') else { return text };
    let first = match first {
        "address" => word("value", "address"),
        "generation" => word("value", "generation"),
        "node" => word("value", "node"),
        _ => return text,
    };
    format!("{first} {rest}")
}

/// More digits behind the point than a sentence of ours ever has: a measured value as it was measured.
const MEASURED_DECIMALS: usize = 4;

/// A count as a number, by which a plural is chosen; a measured value with one digit behind the comma; all else as it reads.
fn value_of(text: String) -> FluentValue<'static> {
    if let Ok(count) = text.parse::<u32>()
        && count.to_string() == text
    {
        return count.into();
    }
    let decimals = text.split_once('.').map_or(0, |(_, decimals)| decimals.len());
    match text.parse::<f64>() {
        Ok(figure) if decimals >= MEASURED_DECIMALS => format!("{figure:.1}").replace('.', ",").into(),
        _ => text.into(),
    }
}
