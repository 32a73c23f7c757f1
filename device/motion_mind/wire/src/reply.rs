//! What a Motion Mind 3 says back.

use super::bits::function;

/// What came back, in either protocol.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Reply {
    /// Taken.
    Acknowledged,
    /// Not a command. Only the protocol in text says so; the binary one is silent.
    NotUnderstood,
    /// Taken, and what the return bits of FUNCTION add.
    Returned(Returned),
    /// Registers by their numbers.
    Registers(Vec<(u8, i64)>),
    /// The bits of STATUS or FUNCTION that were listed, lowest first.
    Bits(Vec<bool>),
}

/// What the return bits of FUNCTION put in the place of the acknowledge; `None` where the bit is clear.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Returned {
    /// POSITION.
    pub position: Option<i32>,
    /// VELOCITY.
    pub velocity: Option<i16>,
    /// TIME, in 5 ms.
    pub time: Option<u32>,
}

/// The return bits of FUNCTION.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Returns {
    /// RETPOS.
    pub position: bool,
    /// RETVEL.
    pub velocity: bool,
    /// RETTIME.
    pub time: bool,
}

/// How far a reply has come.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Progress {
    /// More bytes are needed.
    Incomplete,
    /// A whole reply.
    Done {
        /// What it says.
        reply: Reply,
        /// Bytes it took.
        used: usize,
    },
    /// Not a reply to that command.
    Bad(BadReply),
}

/// Why bytes are no reply to a command.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum BadReply {
    /// A binary reply that is neither an acknowledge nor starts with the unit's address.
    #[error("the reply starts with 0x{got:02X}, not with 0x{expected:02X}")]
    Start {
        /// What it should start with.
        expected: u8,
        /// What it starts with.
        got: u8,
    },
    /// The checksum of a binary reply is wrong.
    #[error("the checksum is 0x{got:02X}, not 0x{expected:02X}")]
    Checksum {
        /// The sum over the bytes that came.
        expected: u8,
        /// The sum that came.
        got: u8,
    },
    /// A line that is no reply.
    #[error("the line \"{0}\" is no answer to this command")]
    Line(String),
    /// The manual has no register of that number, so the width of the reply is not known.
    #[error("register {0} is not known, so the length of its reply is not known either")]
    UnknownRegister(u8),
    /// The command is never answered.
    #[error("a command to all units is not answered")]
    Broadcast,
}

impl Returns {
    /// What a FUNCTION register asks to be returned.
    pub fn of_function(value: u16) -> Self {
        Self {
            position: value & function::RETPOS != 0,
            velocity: value & function::RETVEL != 0,
            time: value & function::RETTIME != 0,
        }
    }

    /// Whether a plain acknowledge is sent.
    pub fn is_none(self) -> bool {
        self == Self::default()
    }
}

impl Returned {
    /// What is returned of a controller's state.
    pub fn of(returns: Returns, position: i32, velocity: i16, time: u32) -> Self {
        Self {
            position: returns.position.then_some(position),
            velocity: returns.velocity.then_some(velocity),
            time: returns.time.then_some(time),
        }
    }
}
