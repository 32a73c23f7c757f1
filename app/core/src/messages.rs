//! What window and command line say alike, in its words: one table for each theme.

use brushwork_canopen::NodeId;
use brushwork_link::Message;
use brushwork_link::device::DisarmReason;
use brushwork_values::{Motor, messages};

messages! {
    /// What is tried, as a bare verb phrase, in failures and as the name of a job.
    pub enum CoreActMessage {
        ReadSome { settings: Message } "read {settings}",
        WriteSome { settings: Message } "write {settings}",
        LoadFromEeprom "load the settings from EEPROM",
        SaveToEeprom "save the settings to EEPROM",
        RestoreDefaults "restore the default settings",
        KeepBackup "keep a backup",
        MeasureQpps "measure QPPS",
        PlayProfile "play the profile",
        TestClamp "test the voltage clamp",
        GetReady "get ready to tune",
        Tune "tune the motor",
        TryGains "try the gains",
        PutBack "put back what the tuning changed",
        StartNode { node: NodeId } "start {node}",
        OpenLoader "open the line to the firmware loader",
    }
}

messages! {
    /// What came back of what was tried, as a clause.
    pub enum CoreCauseMessage {
        WriterIsGone "the thread that writes files is busy or gone",
        TorqueControl { motor: Motor } "L and R of {motor} are both set, so that its duty is a current",
        BatteryTooHigh { volts: f64, limit: f64 } "the main battery stands at {volts:.1} V, not below the limit of {limit:.1} V",
        CountsDown { motor: Motor, percent: f64 } "{motor} counts down at {percent:.0} % forward duty",
        NoCurrent { motor: Motor, percent: f64 } "{motor} counted nothing up to {percent:.0} % duty and drew no current",
        Blocked { motor: Motor, percent: f64, amps: f64 } "{motor} counted nothing up to {percent:.0} % duty and drew {amps:.2} A, as a motor does that is blocked",
        EncoderUnseen { motor: Motor, percent: f64, amps: f64 } "{motor} counted nothing up to {percent:.0} % duty and drew {amps:.2} A, as a motor does that turns: its encoder is not seen",
        TravelUsed { counts: f64, best: f64 } "the travel limit of {counts:.0} counts was reached and its speed had not settled; the highest so far was {best:.0} counts/s",
        TimeUsed { seconds: f64, best: f64 } "the time limit of {seconds:.0} s was reached and its speed had not settled; the highest so far was {best:.0} counts/s",
        Caught { motor: Motor, best: f64, now: f64, amps: f64 } "{motor} ran at {best:.0} counts/s and then counted {now:.0} counts/s, drawing {amps:.2} A",
        HeldBack { percent: f64 } "the controller gives only {percent:.0} % of the duty that was asked for",
        NotAtRest { setpoint: String, seconds: u64 } "a motor does not come to rest at {setpoint} within {seconds} s",
        NotReached { motor: Motor, counts: f64, seconds: u64 } "{motor} did not reach {counts:.0} counts within {seconds} s",
        GoesAway { motor: Motor, counts: f64 } "{motor} goes away from {counts:.0} counts",
        SlowReading { rate: String, took_ms: u128, longest_ms: u128 } "this line{rate} is too slow or too late for a run: one reading of the motor takes {took_ms} ms, and a run needs one every {longest_ms} ms",
        LateForRun { rate: String, timeout_ms: u128, needed_ms: u128 } "this line{rate} is too slow or too late for a run: a run has the controller stop the motor after {timeout_ms} ms of silence, and a lost reply means {needed_ms} ms on this line",
        NoLoader "no USB device calls itself a loader (…ULDR)",
        TwoLoaders { first: String, second: String } "two loaders are there, {first} and {second}; unplug the one that is not meant",
    }
}

messages! {
    /// What to do, as a sentence without its full stop.
    pub enum CoreRemedyMessage {
        StartAgain "Start the program again",
        ThenTryAgain "Then try again",
        ClearWindingForTest "Set L or R to 0 for the test",
        ClearWinding "Set L or R to 0 for the measurement",
        RaiseLimit "Set a limit above the supply",
        ChangeLeads "Change round the two motor leads, or the encoder's A and B, not both, and measure again",
        CheckLeads "Check the motor's leads, its fuse and its power",
        FreeShaft "Free the shaft. If it did turn, check the encoder's plug, supply and pins",
        CheckEncoder "Check the encoder's plug, its supply, and which pins it is assigned to in General Settings",
        AllowTravel "Allow more travel if there is room, or enter an estimated QPPS by hand",
        AllowTime "Allow more time, or take load off the motor",
        LookAtShaft "Look whether the shaft is blocked or the encoder has lost its plug",
        CheckAdapter "Check the adapter's cable",
        SeeLimits "A limit of current, voltage or temperature holds it back: see the indicators and General Settings",
        TuneLoop "Tune the position loop, or widen its deadzone",
        GoFaster "Go faster, or choose points that are nearer",
        QuickerLine "Connect by USB or at 115200 bit/s, with no radio and no network on the way, or set the gains by hand",
        TurnEncoder "Its encoder counts the wrong way: change round the two motor leads, or the encoder's A and B",
    }
}

messages! {
    /// What is said after a tuning run.
    pub enum TuneMessage {
        LeftOff "The controller's loop did not hold the motor still with the old gains, so its output is left switched off (DISABLEPID in FUNCTION, in RAM): the motor stands, but nothing holds it. The next Arm or `drive` switches the loop on again, and so does a reset of the unit.",
    }
}

messages! {
    /// What is said of what happens on a link.
    pub enum CoreStatusMessage {
        Stopping { reason: DisarmReason } "{reason}. The motors are being stopped.",
    }
}
