//! What is said to people, as values: which message it is, what stands in it, and its words, which stand in one table for each theme.
//!
//! A catalogue of another language needs a message's key and its values; where something is only shown, it is a text like any other.

use serde::{Serialize, Serializer};
use std::any::Any;
use std::borrow::Cow;
use std::error::Error;
use std::fmt;
use std::sync::Arc;

/// One message of a theme's table; [`messages!`](crate::messages) makes them.
pub trait Words: Any + fmt::Debug + fmt::Display + Send + Sync {
    /// Which message it is: no other of the program has the same.
    fn key(&self) -> Cow<'static, str>;

    /// What stands in its words, by name, in the order of their definition.
    fn values(&self) -> Vec<(&'static str, &dyn fmt::Display)> {
        Vec::new()
    }
}

/// A message to people, whatever its theme. A text alone is none: it has no key. The default says nothing.
#[derive(Clone, Default)]
pub struct Message(Option<Arc<dyn Words>>);

impl Message {
    /// An error as a message: its words stand with its type.
    pub fn error(error: impl Error + Send + Sync + 'static) -> Self {
        OfError(error).into()
    }

    /// Which message it is; empty where it says nothing.
    #[must_use]
    pub fn key(&self) -> Cow<'static, str> {
        self.0.as_ref().map_or(Cow::Borrowed(""), |words| words.key())
    }

    /// What stands in its words, by name.
    #[must_use]
    pub fn values(&self) -> Vec<(&'static str, &dyn fmt::Display)> {
        self.0.as_ref().map_or_else(Vec::new, |words| words.values())
    }

    /// The message as one of a theme; `None` where it is of another.
    #[must_use]
    pub fn get<W: Words>(&self) -> Option<&W> {
        (self.0.as_deref()? as &dyn Any).downcast_ref()
    }

    /// Whether it says nothing.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.0.is_none()
    }
}

impl<W: Words> From<W> for Message {
    fn from(words: W) -> Self {
        Self(Some(Arc::new(words)))
    }
}

impl fmt::Display for Message {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.0.as_ref().map_or(Ok(()), |words| words.fmt(f))
    }
}

impl fmt::Debug for Message {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{:?}", self.to_string())
    }
}

impl PartialEq for Message {
    fn eq(&self, other: &Self) -> bool {
        self.key() == other.key() && self.to_string() == other.to_string()
    }
}

impl Eq for Message {}

impl PartialEq<str> for Message {
    fn eq(&self, other: &str) -> bool {
        let said = self.to_string();
        said == other
    }
}

impl PartialEq<&str> for Message {
    fn eq(&self, other: &&str) -> bool {
        self == *other
    }
}

/// Several messages as one value of another.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Listed(pub Vec<Message>);

impl fmt::Display for Listed {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (index, message) in self.0.iter().enumerate() {
            write!(f, "{}{message}", if index == 0 { "" } else { ", " })?;
        }
        Ok(())
    }
}

/// Several sentences as one value of another message, or as one message.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Sentences(pub Vec<Message>);

impl fmt::Display for Sentences {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (index, message) in self.0.iter().enumerate() {
            write!(f, "{}{message}", if index == 0 { "" } else { " " })?;
        }
        Ok(())
    }
}

/// As its text.
impl Serialize for Message {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_str(self)
    }
}

#[derive(Debug)]
struct OfError<E>(E);

impl<E: fmt::Display> fmt::Display for OfError<E> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.0.fmt(f)
    }
}

impl<E: Error + Send + Sync + 'static> Words for OfError<E> {
    fn key(&self) -> Cow<'static, str> {
        error_key(&self.0).into()
    }
}

/// An error's key: its type and, of an enum, the member. The member is the first word that a derived `Debug` writes.
pub fn error_key<E: fmt::Debug>(error: &E) -> String {
    let kind = std::any::type_name::<E>();
    let debug = format!("{error:?}");
    let end = debug.find(|letter: char| !letter.is_alphanumeric()).unwrap_or(debug.len());
    match &debug[..end] {
        "" => kind.to_owned(),
        name if kind.ends_with(name) => kind.to_owned(),
        member => format!("{kind}.{member}"),
    }
}

/// Defines the messages of one theme: an enum whose members have their words behind them, in which their values stand in braces.
///
/// ```
/// brushwork_values::messages! {
///     /// What is said of pins.
///     pub enum PinMessage {
///         Held { pin: u8, port: &'static str } "Pin {pin} is held by {port}.",
///         NoneFree "No pin is free.",
///     }
/// }
/// let message = brushwork_values::Message::from(PinMessage::Held { pin: 3, port: "UART1" });
/// assert_eq!(message, "Pin 3 is held by UART1.");
/// assert_eq!(message.key(), "PinMessage.Held");
/// ```
#[macro_export]
macro_rules! messages {
    ($(#[$of:meta])* $visible:vis enum $name:ident {
        $($member:ident $({ $($value:ident: $kind:ty),* $(,)? })? $words:literal,)*
    }) => {
        $(#[$of])*
        #[derive(Clone, Debug, PartialEq)]
        #[allow(missing_docs, reason = "the values stand in the words, and those behind each member")]
        $visible enum $name {
            $(#[doc = $words] $member $({ $($value: $kind),* })?,)*
        }

        impl ::std::fmt::Display for $name {
            fn fmt(&self, f: &mut ::std::fmt::Formatter<'_>) -> ::std::fmt::Result {
                match self {
                    $(Self::$member $({ $($value),* })? => ::std::write!(f, $words),)*
                }
            }
        }

        impl $crate::Words for $name {
            fn key(&self) -> ::std::borrow::Cow<'static, str> {
                match self {
                    $(Self::$member { .. } => ::std::concat!(::std::stringify!($name), ".", ::std::stringify!($member)).into(),)*
                }
            }

            fn values(&self) -> ::std::vec::Vec<(&'static str, &dyn ::std::fmt::Display)> {
                match self {
                    $(Self::$member $({ $($value),* })? => {
                        ::std::vec![$($((::std::stringify!($value), $value as &dyn ::std::fmt::Display)),*)?]
                    })*
                }
            }
        }
    };
}

#[cfg(test)]
mod tests {
    use super::*;

    messages! {
        /// What the tests say.
        enum TestMessage {
            Outside { title: String, volts: f64, limit: f64 } "{title} is {volts:.1} V, above {limit:.1} V.",
            Because { why: Message } "It is not written. {why}",
            Nothing "Nothing is said.",
        }
    }

    fn outside() -> Message {
        TestMessage::Outside { title: "Maximum".to_owned(), volts: 34.25, limit: 30.0 }.into()
    }

    #[test]
    fn a_message_is_its_words_with_its_values_and_is_known_by_its_key() {
        let why = Message::from(TestMessage::Because { why: outside() });
        assert_eq!(why, "It is not written. Maximum is 34.2 V, above 30.0 V.");
        assert_eq!((&*why.key(), &*outside().key()), ("TestMessage.Because", "TestMessage.Outside"));
        assert_ne!(why, outside());
        assert!(matches!(outside().get(), Some(TestMessage::Outside { volts: 34.25, .. })));
        assert!(Message::default().is_empty() && Message::default().to_string().is_empty());
        let error = Message::error(fmt::Error);
        assert_eq!((error.to_string(), &*error.key()), (fmt::Error.to_string(), "core::fmt::Error"));
    }

    #[test]
    fn the_members_of_an_error_have_a_key_each() {
        #[derive(Debug)]
        #[expect(dead_code, reason = "only its form is looked at")]
        enum Lacks {
            Port,
            Rate { baud: u32 },
        }
        impl fmt::Display for Lacks {
            fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                write!(f, "It has no {self:?}.")
            }
        }
        impl Error for Lacks {}
        let keys =
            [Lacks::Port, Lacks::Rate { baud: 9600 }].map(|error| Message::error(error).key().into_owned());
        let kind = std::any::type_name::<Lacks>();
        assert_eq!(keys, [format!("{kind}.Port"), format!("{kind}.Rate")]);
    }

    /// What a catalogue does: other words for the key, with the same values put in.
    #[test]
    fn another_language_needs_the_key_and_the_values_alone() {
        fn german(message: &Message) -> String {
            let words = match &*message.key() {
                "TestMessage.Outside" => "{title}: {volts} V, erlaubt sind {limit} V.",
                _ => return message.to_string(),
            };
            let put_in = |text: String, (name, value): (&str, &dyn fmt::Display)| {
                text.replace(&format!("{{{name}}}"), &value.to_string())
            };
            message.values().into_iter().fold(words.to_owned(), put_in)
        }
        assert_eq!(german(&outside()), "Maximum: 34.25 V, erlaubt sind 30 V.");
        assert_eq!(german(&TestMessage::Nothing.into()), "Nothing is said.");
    }
}
