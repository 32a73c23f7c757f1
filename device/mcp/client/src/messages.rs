//! What this family says to people, in its words: one table for each theme.

use brushwork_link::Message;
use brushwork_link::transport::Stream;
use brushwork_link::unit::UnitAddress;
use brushwork_values::{Motor, messages};

messages! {
    /// What to know of settings before they are written, and why some cannot be.
    pub enum McpSettingsMessage {
        NoPin "none, assumed",
        PinInList { pin: String } "counted from 0 in the pin list: {pin}, assumed",
        NoCommand { command: u8 } "This firmware has no command {command}.",
        NoAddress { address: UnitAddress } "{address} is no address of packet serial",
        AddressWithMixing { address: String } "Mixing is written together with the address, which this firmware does not report: {address} is written, the address this link speaks to. Over USB a unit answers to every address, so check it first.",
        ConfigurationWord "The configuration word takes effect at once and can move the controller to another address, baud rate or control mode: the link may be lost.",
        OwnPortChanges { stream: Stream, to: String } "This program is connected through {stream}, which becomes \"{to}\": the link is lost then.",
        OwnPortRate { stream: Stream, to: String } "This program is connected through {stream}, which changes to {to}: connect again at that rate.",
        OwnPortTimeout { stream: Stream } "{stream} has no time-out then: the motors would go on if this program died, so it cannot be armed.",
        Autorun { delay_ms: i64 } "A stored script starts {delay_ms} ms after each power up and can move the motors.",
        Bridged "Bridged channels drive one motor with both outputs: wire that motor to them only after this is written and saved to EEPROM, and exactly as in MCP manual 1.8.2. Wired before, or wired otherwise, the controller is damaged.",
        Separated "The channels are separate again: take the single motor off both of them before this is written, or the controller is damaged. MCP manual 1.8.",
        SerialNowhere "Serial is at no priority level then, so this program cannot be armed to move motors.",
        TorqueControl { motor: usize } "Motor {motor} has both L and R then: duty commands set its current instead of its voltage, and duty 0 lets it coast.",
        InputCommands { pin: String, target: String, kind: &'static str, level: usize } "{pin} commands {target} as soon as this is written, since {kind} inputs are at priority level {level}: the motor can start.",
        NoSuchInput { pin: &'static str, kind: String, model: &'static str } "{pin} cannot be {kind} on the {model}; it measures nothing instead.",
    }
}

messages! {
    /// What can drive a motor besides this program, and what arming cannot see.
    pub enum McpDriverMessage {
        Coasts { motor: Motor } "{motor} is in torque control: Stop lets it coast instead of braking it.",
        StatusUnseen "This controller does not tell its status: a fault, a limit or an E-stop is not seen here.",
        InputDrives { kind: &'static str, pin: String, motors: String } "The {kind} input {pin} can drive {motors}.",
        InputStartsScript { pin: String } "The input {pin} can start the script.",
        ScriptMayRun "A script may still run: the controller did not confirm its end.",
        ScriptUnknown "A script may still run: which model this is is not known, so no script was ended.",
    }
}

messages! {
    /// What is odd about a unit that was found.
    pub enum McpIdentityMessage {
        OtherGeneration { command: u8 } "Command {command} answers as another generation does.",
        NothingTells "Nothing tells the firmware's generation; it is taken for generation 1.",
        Unanswered { names: String } "It does not answer for: {names}.",
        Heartbeat { state: String } "Its heartbeat says: {state}.",
        CanOpenIdentity { parts: String } "CANopen identity: {parts}.",
    }
}

messages! {
    /// Settings that contradict each other.
    pub enum ConflictMessage {
        NoSuchRate { bus: &'static str, rate: i64, listed: String } "{bus} has no rate of {rate} bit/s. It has {listed}.",
        TwoFunctions { pin: String, mode: String } "{pin} is set as a digital input and as {mode} at once. Choose one mode for it.",
        NoSuchFunction { pin: String, mode: String } "{pin} is set to {mode}, which this pin cannot measure. Choose one of the modes in its name.",
        PortHoldsPin { pin: String, mode: String, port: &'static str } "{pin} is set to {mode}, but {port} is in use and holds the pin. Disable {port}, or set the pin to None.",
        HalfAnEncoder { pin: String, encoder: u8, other: String } "{pin} is one line of encoder {encoder}, but {other} is not set to encoder. Set both or none: the lines of an encoder count in pairs.",
        MinimumNeverActs { pin: String, why: Message } "The minimum action of {pin} never acts: {why}",
        MaximumNeverActs { pin: String, why: Message } "The maximum action of {pin} never acts: {why}",
        MeasuresNothing "the pin measures nothing. Choose its mode.",
        Held { port: &'static str } "{port} is in use and holds the pin. Disable {port}.",
        NeverDown { to: String } "the input never goes down to {to}. Raise the minimum.",
        NeverUp { to: String } "the input never goes up to {to}. Lower the maximum.",
        NoEncoder { motor: usize } "motor {motor} has no encoder whose count it could set.",
        NoSecondMotor "the channels are bridged, so there is no motor 2.",
        NoCommand { pin: String, why: Message } "{pin} gives no usable command: {why}.",
        MinimumNotBelow { min: f64, max: f64 } "its minimum {min} is not below its maximum {max}",
        CenterOutside { center: f64, min: f64, max: f64 } "its center {center} is not between {min} and {max}",
        DeadbandCoversAll { deadband: f64 } "its deadband {deadband} covers the whole range",
        NeverCommands { pin: String, kind: &'static str } "{pin} is set to control a motor, but {kind} inputs are at no priority level, so it never does. Put {kind} at a level, or set the pin to control none.",
        EncoderMeasuresNothing { motor: usize, pin: String } "Motor {motor} takes its encoder from {pin}, which measures nothing. Set that pin's mode, or choose another input.",
        EncoderIsDigital { motor: usize, pin: String } "Motor {motor} takes its encoder from {pin}, which is a digital input. Set that pin's mode, or choose another input.",
        EncoderHeld { motor: usize, pin: String, port: &'static str } "Motor {motor} takes its encoder from {pin}, which {port} holds. Disable {port}, or choose another input.",
        TwoCommanders { first: String, last: String, motor: usize, kind: &'static str } "{first} and {last} both control motor {motor} as {kind} inputs, and only one of them can. Let the other control none.",
    }
}

messages! {
    /// What is tried, as a bare verb phrase.
    pub enum McpActMessage {
        Arm "arm the motors",
        EmptyBuffers "empty the motion buffers",
        Save "save the settings (94)",
        Restore "restore the defaults (80)",
        Reload "load the settings from EEPROM (95)",
        SendFirmware "send the firmware",
        DownloadScript "download the script",
        SetAutorun "set the script's autorun",
        ReadAutorun "read the script's autorun",
    }
}

messages! {
    /// What came back of what was tried, as a clause.
    pub enum McpCauseMessage {
        NothingAnswered { asked: Message } "nothing answered at {asked}",
        OneByteCame { asked: Message } "one byte came, but no packet serial, from {asked}",
        BytesCame { count: u64, asked: Message } "{count} bytes came, but no packet serial, from {asked}",
        AllAddresses "addresses 0x80 to 0x87",
        Address { address: u8 } "address 0x{address:02X}",
        NoNodeAnswered "no node of the bus answered",
        NodeSilent { id: u8 } "node {id} did not answer",
        NodesSilent { listed: String } "none of the nodes {listed} answered",
        AdapterSilent { asked: Message } "{asked}, and the adapter said nothing",
        AdapterWorks { asked: Message } "{asked}, though the adapter works",
        OtherNodes { listed: String } "{listed}",
        NoAcknowledgement { tries: usize } "no acknowledgement in {tries} tries",
        Reports { fault: &'static str } "the controller reports {fault}",
        NoTimeoutOverCan "over CANopen the controller has no time-out (MCP manual 1.9.4), so the motors would run on if this program died",
        HeartbeatUnwatched "the node does not watch this program's heartbeat, so the motors would run on if this program died",
        NoSerialTimeout "the serial time-out is 0, so the motors would run on if this program died",
        NotPacketSerial { stream: Stream } "{stream} is not set to packet serial, so this port cannot be {stream}",
        LineIsLate { latest_ms: u128, timeout_ms: u128 } "replies on this line take up to {latest_ms} ms, so a serial time-out of {timeout_ms} ms would stop the motors at each reply that is lost",
        NoTimeout { stream: Stream } "the time-out of {stream} is 0, so the motors would run on if this program died",
        UnknownPort { stream: Stream } "nobody said which connector of the controller this port is, and {stream} has no time-out",
        TimeoutUntold "the controller does not tell its serial time-out, so nobody knows whether the motors would stop if this program died",
        SerialNowhere "Serial is in none of the three priority levels, so the controller does not take its motion from this port",
        NotPublic "the byte code of real controllers is not public, so what this program compiles runs on simulated ones alone",
        BrokeErasing { cause: Message } "it broke at erasing: {cause}",
        BrokeWriting { address: u32, cause: Message } "it broke at writing the block at 0x{address:06X}: {cause}",
        EraseStatus { status: i64 } "the erase was answered with status {status:02X}: it does not fit into the script memory",
        BlockStatus { address: u32, status: i64 } "the block at 0x{address:06X} was answered with status {status:02X}: it does not fit into the script memory",
        HoldsSomethingElse "the script memory holds something else than was sent",
        DifferentStatuses "its blocks were answered with different status bytes, whose meaning is not public",
        AutorunKept { wanted_ms: i64, kept_ms: u128 } "it was told {wanted_ms} ms and says {kept_ms} ms",
    }
}

messages! {
    /// What to do, as a sentence without its full stop.
    pub enum McpRemedyMessage {
        CutPower "Cut the motor power now: the motors may still be running",
        CheckPowerAndPort "Check that the controller has motor power, that the cable and the port are right, and the baud rate",
        CheckBaudRate "Check the baud rate, and that the device on this port is a motor controller set to packet serial",
        CheckAdapter "Check the adapter's port and baud rate, its form (form=ascii or form=binary), the bus rate and the 120 Ω at both ends",
        CheckNode "Check the node id, that the controller's CAN pins are set to CANopen, and that its rate is the bus's",
        GiveNode "Give the node of the motor controller: node=3",
        ReadSettings "Read the settings to see what the controller works with",
        ResetFirst "Remove the cause and reset the error first",
        NotOverCan "Drive it over USB or a serial port; settings and readings work over CANopen too",
        DriveOverSerial "Drive it over USB or a serial port",
        SetSerialTimeout "Set the serial time-out in General Settings, to 1 s for example",
        ChooseWired "Choose the connector that this port is really wired to",
        LengthenTimeout { enough_ms: u128 } "Set the time-out to {enough_ms} ms or more in General Settings",
        SetTimeout { stream: Stream } "Set the priority time-out of {stream} in General Settings, to 1000 ms for example",
        ChooseConnector "Choose the connector, or give it with the port: \",stream=usb\"",
        DriveOtherwise "Drive this controller with another program that you can watch",
        SetPriority "Set priority level 1 to Serial in General Settings",
        UseIonStudio "Compile the script with the maker's Ion Studio and download that file: it is sent as it is, and can be started, stopped and set to autorun from here. Or run the script on a simulated controller",
        DownloadAgain "The script memory now holds a part of the image. Download again before the script is started or the controller is switched on",
        DownloadAgainAutorun { delay_ms: u128 } "The script memory now holds a part of the image. Download again before the script is started or the controller is switched on. Autorun is on: the controller would run it {delay_ms} ms after power-up",
        Untouched "Nothing was erased: switch the controller off and on, and it runs its old firmware again",
        PerhapsErasing "It may be erasing its memory: leave its power on for a minute. Then switch it off and on, and resume the update",
        WithoutFirmware "The controller has no firmware now and waits for it in its loader: switch it off and on, and resume the update with the same file",
        Complete "The whole image is there: switch the controller off and on, then connect",
    }
}
