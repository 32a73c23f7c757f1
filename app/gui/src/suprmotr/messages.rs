//! What is shown of a SuprMotr, in words.

use brushwork_values::messages;

messages! {
    /// How the line of a SuprMotr is set.
    pub enum LineMessage {
        Set { echo: &'static str, numbers: &'static str } "{echo}, numbers {numbers}",
    }
}
