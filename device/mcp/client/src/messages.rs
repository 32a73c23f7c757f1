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
        ConfigurationWord "The configuration word moves the controller to another address at once, and to another baud rate or control mode with the next power-up: the link may be lost then.",
        OwnPortChanges { stream: Stream, to: String } "This program is connected through {stream}, which becomes \"{to}\": the link is lost then.",
        OwnPortRate { stream: Stream, to: String } "This program is connected through {stream}, which changes to {to}: connect again at that rate.",
        OwnPortTimeout { stream: Stream } "{stream} has no time-out then: the motors would go on if this program died, so it cannot be armed.",
        Autorun { delay_ms: i64 } "A stored script starts {delay_ms} ms after each power-up and can move the motors.",
        Bridged "Bridged channels drive one motor with both outputs: wire that motor to them only after this is written and saved to EEPROM, and exactly as in MCP manual 1.8.2. Wired before, or wired otherwise, the controller is damaged.",
        Separated "The channels are separate again: take the single motor off both of them before this is written, or the controller is damaged. MCP manual 1.8.",
        SerialNowhere "Serial is at no priority level then, so this program cannot be armed to move motors.",
        TorqueControl { motor: usize } "Motor {motor} has both L and R then: duty commands set its current instead of its voltage, and duty 0 lets it coast.",
        InputCommands { pin: String, target: String, kind: &'static str, level: usize } "{pin} commands {target} as soon as this is written, since {kind} inputs are at priority level {level}: the motor can start.",
        NoSuchInput { pin: &'static str, kind: String, model: &'static str } "{pin} cannot be {kind} on the {model}; it measures nothing instead.",
        Divided { title: String, value: String, one: String } "{title} becomes {value}, since \"{one}\" counted for it before.",
        Joined { title: String, lost: String, kept: String, one: String, effect: Message } "{title} {lost} has no setting of its own there: {kept} counts for it too, as \"{one}\". {effect}",
        NoAutomaticReset "This firmware has no automatic E-Stop reset. Hardware is used instead: an emergency stop lasts until the hardware is reset, and does not end by itself.",
    }
}

messages! {
    /// What changes in the motion where the other controller lacks a setting.
    pub enum WithoutMessage {
        OneAcceleration "The motor brakes as fast as it accelerates.",
        OnePwmMode "The bridge switches, and brakes between pulses, as that of the other motor.",
        OneDeadband "This input leaves its center at another place.",
        FixedMaximum "The main battery maximum does not follow the voltage at power-up: the fixed maximum counts.",
        UncorrectedVolts "Voltages are read without the correction, so the voltage limits act that much earlier or later.",
        NoDefaultSpeed "Position commands without a speed of their own use the whole top speed.",
        NoIdle "What the bridge does after a stop is up to the firmware.",
        NoErrorLimit "The controller does not stop a motor that falls behind.",
        NoHomingDuty "The duty with which the motor looks for its home switch is no setting there.",
        NoHomingTimeout "The time for which the motor looks for its home switch is no setting there.",
        NoTimeout "This time-out does not stop the motors when the computer falls silent.",
        NotMixed "The inputs are not mixed.",
        NotBridged "Each channel drives a motor of its own: do not wire one motor to both.",
        OtherCommander "What commands the motors is set otherwise there.",
        NoScript "No script starts by itself.",
        CommandsNothing "This input commands no motor.",
        StopsNothing "This input is no limit switch, home switch or E-Stop.",
        SwitchesNothing "This output switches nothing: no brake, no voltage clamp.",
        PinDoesNothing "This pin is no E-Stop, voltage clamp, brake, limit or home switch.",
        NoCells "The number of cells sets no limit: the voltage limits count.",
        EncodersNotSwapped "The encoder inputs stay with their own motors.",
        NoDeadband "The input has no deadband, so that a stick that is not quite at its center can move a motor.",
        OtherInputRange "The input reaches its ends at other places.",
        OtherEncoder "Which encoder the motor has, and which way it counts, is set otherwise there: try it before a loop is closed.",
    }
}

messages! {
    /// What is odd about a RoboClaw's settings together, and what they let happen.
    pub enum RoboClawMessage {
        OwnLimitsOverruled { how: String } "The battery cut-off is {how}, so the main battery minimum and maximum have no effect. Choose user limits to set them yourself.",
        NeverHomes { motor: usize, missing: &'static str } "Motor {motor} is to look for its home switch at power-up and never does: its {missing}. Set it.",
        NoInputRange { input: String, min: i64, center: i64, max: i64 } "{input} gives no usable command: its center {center} is not between its minimum {min} and its maximum {max}.",
        BytesCommand "From the next power-up single bytes on S1 command the motors, and packet serial goes on over USB alone.",
        InputsCommand { signal: &'static str, options: String, switches: String } "From the next power-up {signal} on S1 and S2 command the motors, packet serial goes on over USB alone, and baud rate and address are read as R/C options and switches: {options}; {switches}.",
        RunsOn "With MCU and without the R/C time-out the motors go on with the last pulse when the pulses stop.",
        Homes { motor: usize, timeout_s: f64 } "Motor {motor} moves by itself at each power-up: forward off its home switch for at most 3 s, then backward until it meets it, for at most {timeout_s:.1} s.",
        TurnedRound { what: Message } "{what}: if they do not go the same way then, a closed loop runs away. Try it with little current.",
        BothTurned { motor: usize } "Motor {motor} and its encoder are both turned round",
        MotorTurned { motor: usize } "Motor {motor} is turned round and its encoder is not",
        EncoderTurned { motor: usize } "The encoder of motor {motor} is turned round and the motor is not",
        NoneTurned { motor: usize } "Motor {motor} and its encoder go the way they are wired",
        OneMotor { model: &'static str } "a {model} has one motor, motor 1",
        EncodersSwapped "The motors change their encoders: with loops closed and wires as they are, both run away.",
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
        NodeTakesNoPackets "a node of a CAN bus takes no packets",
        NoCommand "these bytes are no command of packet serial",
        OnePacket "one packet goes out at a time",
        DoesTooMuch "this command can do more than an examination may",
        NothingAnswered { asked: Message } "nothing answered at {asked}",
        OneByteCame { asked: Message } "one byte came, but no packet serial, from {asked}",
        BytesCame { count: u64, asked: Message } "{count} bytes came, but no packet serial, from {asked}",
        AllAddresses "addresses 0x80 to 0x87",
        OtherValues { command: u8 } "the values that came are not those of command {command}",
        LoaderByUpdate "the firmware loader is entered by an update alone, after its risk was accepted",
        NoLoaderOverCan "the firmware loader cannot be entered over the CAN bus; connect over USB",
        HeartbeatNotKept "the node did not keep whose heartbeat it should watch",
        NothingToRead { id: u16, name: &'static str } "nothing can be read under the number {id} ({name})",
        EStopIsSet "the E-stop is still set: it is pressed, or its reset is locked to the hardware",
        NoScripts { family: &'static str } "a {family} runs no scripts",
        DutyOutside { duty: f64 } "a duty of {duty} is not between -1 and 1",
        DutyChangeOutside { accel_duty_per_s: f64, highest: f64 } "a duty change of {accel_duty_per_s}/s is not between 0 and {highest:.1}/s",
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
        UnknownPort { stream: Stream } "it was not said which connector of the controller this port is, and {stream} has no time-out",
        TimeoutUntold "the controller does not tell its serial time-out, so it is not known whether the motors would stop if this program died",
        SerialNowhere "Serial is in none of the three priority levels, so the controller does not take its motion from this port",
        InputsInCharge { signal: &'static str } "the control mode is {signal}, so the inputs S1 and S2 command the motors and nothing sent over a serial port moves them",
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
        StartNode { id: u8 } "Start it with \"brushwork nodes --start {id}\" or in the window under Device, CANopen bus; then connect again",
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
        ChoosePacketSerial "Set the control mode to packet serial in General Settings (roboclaw.config.mode=packet_serial), save the settings, and switch the controller off and on",
        UseIonStudio "Compile the script with the maker's Ion Studio and download that file: it is sent as it is, and can be started, stopped and set to autorun from here. Or run the script on a simulated controller",
        DownloadAgain "The script memory now holds a part of the image. Download again before the script is started or the controller is switched on",
        DownloadAgainAutorun { delay_ms: u128 } "The script memory now holds a part of the image. Download again before the script is started or the controller is switched on. Autorun is on: the controller would run it {delay_ms} ms after power-up",
        Untouched "Nothing was erased: switch the controller off and on, and it runs its old firmware again",
        PerhapsErasing "It may be erasing its memory: leave its power on for a minute. Then switch it off and on, and resume the update",
        WithoutFirmware "The controller has no firmware now and waits for it in its loader: switch it off and on, and resume the update with the same file",
        Complete "The whole image is there: switch the controller off and on, then connect",
    }
}

messages! {
    /// Why the motors do not run, as a whole.
    pub enum DiagnosisMessage {
        NothingFound "Nothing that can be read keeps the motors from running: arm a screen and drive them.",
        Because { effect: Message, what: Message, more: Message, cure: Message } "{effect}: {what}{more}. {cure}.",
        NoneRun "The motors do not run",
        SomeDoNotMove "Some commands do not move the motors",
        Limited "The motors run with limits",
        OneMore " (and 1 more reason)",
        SomeMore { others: usize } " (and {others} more reasons)",
    }
}

messages! {
    /// One reason, as a clause.
    pub enum FindingMessage {
        OneMotor { motor: usize } "motor {motor}",
        BothMotors "both motors",
        Minimum "minimum",
        Maximum "maximum",
        Reported { title: &'static str } "the controller reports: {title}",
        ReportedVolts { title: &'static str, volts: f64 } "the controller reports: {title} (now {volts:.1} V)",
        EmergencyStop "the emergency stop is active (E-Stop)",
        BoardIsAt { celsius: f64, title: &'static str } "the board is at {celsius:.1} °C ({title})",
        LessCurrent { what: Message } "{what}, so its current limit is reduced",
        BatteryAbove { name: &'static str, volts: f64, limit: f64, title: &'static str } "the {name} battery is at {volts:.1} V, above its maximum of {limit:.1} V ({title})",
        BatteryBelow { name: &'static str, volts: f64, limit: f64, title: &'static str } "the {name} battery is at {volts:.1} V, below its minimum of {limit:.1} V ({title})",
        CurrentLimit { motor: u8 } "motor {motor} is at its current limit",
        CurrentLimitNow { motor: u8, amps: f64 } "motor {motor} is at its current limit ({amps:.1} A now)",
        AtSwitch { motor: u8 } "motor {motor} is at its home or limit switch",
        SerialNowhere "serial is in none of the three priority levels, so the inputs alone command the motors",
        NoSerialTimeout "the serial time-out is 0, so the motors would run on without this program and are not armed",
        NoTimeout { stream: Stream } "the time-out of {stream} is 0, so the motors would run on without this program and are not armed",
        AutorunScript { delay_ms: i64 } "a script that starts {delay_ms} ms after power-up may be running and command the motors itself",
        Script "a script is running and commands the motors itself",
        NoQpps { motors: Message } "the QPPS of {motors} is 0, and speed and position commands are scaled by it",
        NoTravel { motors: Message, min: i64, max: i64 } "the position limits of {motors} ({min} to {max}) leave no room for position commands",
        NoGains { motors: Message } "the position gains P, I and D of {motors} are all 0",
        Bridged "both channels are bridged for one motor, so commands to motor 2 do nothing",
        PinStops { pin: String, end: Message, motors: Message } "{pin} is at its {end}, whose action stops {motors}",
        PinLetsCoast { pin: String, end: Message, motors: Message } "{pin} is at its {end}, whose action lets {motors} coast",
        ForwardLimit { pin: String, end: Message, motors: Message } "{pin} is at its {end}, a forward limit of {motors}",
        BackwardLimit { pin: String, end: Message, motors: Message } "{pin} is at its {end}, a backward limit of {motors}",
        PinEStops { pin: String, end: Message } "{pin} is at its {end}, whose action is an emergency stop",
        AnalogCommands { names: String, level: usize, serial: usize } "the analog input {names} commands them alone (priority level {level}, Serial level {serial})",
        PulsesForGood { names: String, level: usize, serial: usize } "the pulse input {names} commands them alone once pulses have come, with a time-out of 0, for good (priority level {level}, Serial level {serial})",
        PulsesMeanwhile { names: String, level: usize, serial: usize } "the pulse input {names} commands them alone for as long as pulses come (priority level {level}, Serial level {serial})",
    }
}

messages! {
    /// What to do about a reason, as a sentence without its full stop.
    pub enum CureMessage {
        CheckBridge "Check the motor and its leads for a short circuit, then restart the controller; if it stays, the bridge is damaged",
        CheckErrorLimits "Check encoder, wiring and the error limits; the motor's next command clears the fault",
        LookForBlock "Look for a blocked shaft or a short circuit, then restart the controller",
        RaiseSpeedLimit "Look for a load that is too heavy, or raise the speed error limit",
        RaisePositionLimit "Look for a load that is too heavy, or raise the position error limit",
        CheckCanBus "Check the CAN bus: its wiring, terminators and rate",
        CompareSettings "Read the settings and compare them with a backup: something was wrong at start-up",
        BrakeGently "Decelerate more gently, or raise the minimum current",
        RestartAfterEStop "Release it, then restart the controller: its reset is set to hardware",
        ResetAfterEStop "Release it, then reset it on the Device Status screen",
        ReleaseEStop "Release it: the reset is automatic",
        ResetOrRestart "Release it, then reset it or restart the controller",
        CoolBelow100 "Let the board cool below 100 °C",
        CoolBelow85 "Let the board cool below 85 °C",
        BringBetween { name: &'static str } "Bring the {name} battery between its limits and restart the controller",
        LowerVoltage "Lower the main battery voltage or raise its maximum",
        Charge "Charge the main battery or lower its minimum",
        FreeShaft "Free the shaft or take load off, or raise the motor's current limit",
        LeaveSwitch "Drive away from the switch, or open it",
        SetSerialLevel "Set a priority level to Serial in General Settings",
        SetTimeout "Set it in General Settings, to 1 s for example",
        EndAutorun "Press Stop All, which ends it, or set the script autorun delay to 0",
        EndScript "Press Stop All, which ends it",
        MeasureQpps "Measure the speed at full duty and set QPPS to it",
        SetTravel "Set the lowest and the highest position",
        TunePosition "Tune the position loop, or set P",
        CommandMotor1 "Command motor 1, or switch bridging off before two motors are wired",
        LeaveEnd { end: Message } "Take the input away from its {end}, or change its {end} action",
        DriveBackwards "Drive backwards",
        DriveForwards "Drive forwards",
        RaiseSerial { kind: String, pin: String } "Put Serial on a level above {kind}, or take the motor away from {pin}",
    }
}
