//! Blocks and what ends them.

/// A block that is open.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Block {
    /// A function, a handler or the program.
    Routine,
    Loop,
    Do,
    While,
    If,
    Else,
    /// The head of a Select, or one of its cases.
    Select,
}

/// What ends blocks.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Closer {
    EndOf(Block),
    Until,
    Else,
    Case,
    /// Another routine begins.
    Routine,
}

/// The word behind `End` for each block.
pub const ENDS: [(&str, Block); 7] = [
    ("loop", Block::Loop),
    ("while", Block::While),
    ("if", Block::If),
    ("select", Block::Select),
    ("function", Block::Routine),
    ("eventhandler", Block::Routine),
    ("program", Block::Routine),
];

impl Block {
    pub fn takes(self, closer: Closer) -> bool {
        match self {
            Self::Routine => matches!(closer, Closer::EndOf(Self::Routine) | Closer::Routine),
            Self::Loop => closer == Closer::EndOf(Self::Loop),
            Self::Do => closer == Closer::Until,
            Self::While => closer == Closer::EndOf(Self::While),
            Self::If => matches!(closer, Closer::Else | Closer::EndOf(Self::If)),
            Self::Else => closer == Closer::EndOf(Self::If),
            Self::Select => matches!(closer, Closer::Case | Closer::EndOf(Self::Select)),
        }
    }

    pub const fn words(self) -> (&'static str, &'static str) {
        match self {
            Self::Routine => ("This", "End Program, End Function or End EventHandler"),
            Self::Loop => ("Loop", "End Loop"),
            Self::Do => ("Do", "Until condition"),
            Self::While => ("While", "End While"),
            Self::If | Self::Else => ("If", "End If"),
            Self::Select => ("Select", "End Select"),
        }
    }
}
