//! The message line: what happened last, until it is dismissed or something else happens.

/// How grave a message is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Gravity {
    Note,
    Warning,
    Error,
}

/// One message, a whole sentence.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Message {
    pub gravity: Gravity,
    pub text: brushwork_link::Message,
}

/// The newest message and how many came before it.
#[derive(Clone, Debug, Default)]
pub struct Messages {
    pub shown: Option<Message>,
    /// Newest last.
    past: Vec<Message>,
}

/// Messages kept for looking back.
const KEPT: usize = 200;

impl Messages {
    pub fn say(&mut self, gravity: Gravity, text: impl Into<brushwork_link::Message>) {
        let message = Message { gravity, text: text.into() };
        if self.past.len() == KEPT {
            self.past.remove(0);
        }
        self.past.push(message.clone());
        // A note does not wipe away an error that nobody has read.
        let unread_error = self.shown.as_ref().is_some_and(|shown| shown.gravity == Gravity::Error);
        if !(unread_error && gravity == Gravity::Note) {
            self.shown = Some(message);
        }
    }

    pub fn note(&mut self, text: impl Into<brushwork_link::Message>) {
        self.say(Gravity::Note, text);
    }

    pub fn warn(&mut self, text: impl Into<brushwork_link::Message>) {
        self.say(Gravity::Warning, text);
    }

    pub fn fail(&mut self, text: impl Into<brushwork_link::Message>) {
        self.say(Gravity::Error, text);
    }

    pub fn dismiss(&mut self) {
        self.shown = None;
    }

    /// All that were said, newest first.
    pub fn past(&self) -> impl Iterator<Item = &Message> {
        self.past.iter().rev()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::messages::WindowStatusMessage;

    #[test]
    fn a_note_does_not_wipe_away_an_unread_error() {
        let mut messages = Messages::default();
        messages.fail(WindowStatusMessage::LinkEnded);
        messages.note(WindowStatusMessage::Disconnected);
        assert_eq!(messages.shown.as_ref().unwrap().gravity, Gravity::Error);
        messages.dismiss();
        messages.note(WindowStatusMessage::Disconnected);
        assert_eq!(messages.shown.as_ref().unwrap().text, "Disconnected.");
        assert_eq!(messages.past().count(), 3);
    }

    #[test]
    fn messages_do_not_pile_up_without_end() {
        let mut messages = Messages::default();
        for number in 0..1000 {
            messages.note(WindowStatusMessage::Copied { count: number });
        }
        assert_eq!(messages.past().count(), KEPT);
        assert_eq!(messages.past().next().unwrap().text, "Copied 999 transactions.");
    }
}
