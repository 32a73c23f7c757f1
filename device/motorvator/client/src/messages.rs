//! What this family says to people, in its words: one table for each theme.

use brushwork_link::unit::UnitAddress;
use brushwork_values::messages;

messages! {
    /// What to know of settings before they are written, and why some cannot be.
    pub enum MotorvatorSettingsMessage {
        NoAddress { address: UnitAddress } "{address} is no MotorVator's",
        ValuesDoNotFit "the order does not take the values",
        Volatile "The host library keeps them until it restarts; for a program of your own, put the ConfigStepper line into it.",
        HoldHeats { percent: i64 } "A stepper that stands takes {percent} % of full power all the time, and gets warm.",
    }
}

messages! {
    /// What drives a motor besides this program, and what to know when motors are armed.
    pub enum MotorvatorDriverMessage {
        NoEncoder "The board does not tell how fast a motor turns or where it stands: what is shown is what it was told.",
        Coasts "A motor that is stopped runs out by itself; nothing brakes it.",
        NotTheLibrary "Another program may run on the board, which nothing on this line can end: its own motors are its own affair.",
    }
}

messages! {
    /// What is odd about a board that was found.
    pub enum MotorvatorIdentityMessage {
        NoLibrary "Its command line answers, and the host library does not. Only a program that answers can be driven.",
        OtherLibrary { version: u8 } "A host library of version {version} runs on it, which this program does not know.",
    }
}

messages! {
    /// What is tried, as a bare verb phrase.
    pub enum MotorvatorActMessage {
        Arm "arm the board",
        Save "keep the settings over a restart",
        Reload "load settings that were kept",
        Restore "write the values that the host library begins with",
    }
}

messages! {
    /// What came back of what was tried, as a clause.
    pub enum MotorvatorCauseMessage {
        NothingAnswered "neither a frame of the host library nor the command line's answer to H came",
        BytesCame { count: u64 } "{count} bytes came, but no MotorVator's",
        NoLibrary "the host library does not answer",
        StillMoves "a stepper has not ended its move",
        StillDriven "a motor is driven still",
        UnknownOrder { order: char } "the host library does not know the order {order}",
        NoOrder { command: u8, count: usize } "the host library has no order {command} with {count} values that fit",
        DutiesAlone "a MotorVator takes duties and nothing else",
        DutyOutside { percent: f64 } "{percent:.1} % is not a duty; use -100 to 100 %",
        NoRamp "a MotorVator changes a motor's duty at once",
        OneLine "a line goes out whole and alone, its carriage return at its end",
        AnyProgram "the program that runs may do anything with it",
        NoMemory "nothing on the board is kept over a restart but its program",
    }
}

messages! {
    /// What to do, as a sentence without its full stop.
    pub enum MotorvatorRemedyMessage {
        CutPower "Cut the power of the motors now: what was told to stop may go on",
        CheckPowerAndPort "Check that the board has power, that the cable and the port are right, and the baud rate, which the manual does not tell",
        CheckBaudRate "Check the baud rate, which the manual does not tell",
        RunLibrary "Put the host library on the board with the maker's compiler (assets/mecc/host.mecc), and start it with G",
        WriteIntoProgram "Put the ConfigStepper line into your program",
        StartAnew "Restart the host library with G",
    }
}
