//! Why an action is not to be had, in words.

use brushwork_values::messages;

messages! {
    /// Why an action is not to be had now.
    pub enum ActionMessage {
        Busy { job: String } "Wait until Brushwork is done ({job}).",
        NoSuchScreen { name: &'static str } "A controller like the {name} has no such screen as it is set.",
    }
}
