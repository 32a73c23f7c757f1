//! What tests say where the program needs a message.

use brushwork_values::messages;

messages! {
    /// Names of jobs, and what tests try.
    pub enum Said {
        Work "work",
        Settings "settings",
        Write "write",
        Store "store",
        Save "save",
        Test "test",
        TryMotor "try the motor",
        Wander "wander",
        Look "look",
    }
}
