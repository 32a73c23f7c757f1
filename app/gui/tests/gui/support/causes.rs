//! Every cause of standing motors, as a state of the simulated controller: what is done to it and what must be said.

use brushwork_mcp_sim::controller::{Controller, ControllerConfig};
use brushwork_mcp_sim::settings::Settings;
use brushwork_mcp_wire::models;
use brushwork_mcp_wire::packet_serial::Generation;
use brushwork_plant::world::{PinSignal, UnitFault, WorldAction};

/// One cause.
pub struct Cause {
    pub name: &'static str,
    model: &'static str,
    generation: Generation,
    change: fn(&mut Settings),
    /// What is done to the machine before anybody connects.
    pub actions: Vec<WorldAction>,
    /// What the finding says, and what to do about it.
    pub says: [&'static str; 2],
}

impl Cause {
    /// The controller of this cause, with a machine that has not been touched yet.
    pub fn controller(&self) -> Controller {
        let model = models::lookup(self.model).expect("the model is in the list");
        let config = ControllerConfig { generation: self.generation, ..ControllerConfig::of(model) };
        let factory = Controller::new(config.clone()).expect("the factory controller is sound");
        let mut settings = factory.settings();
        // Nothing else is wrong with it.
        for motor in &mut settings.motors {
            motor.motion.position_p_raw = 1024;
            (motor.motion.position_min_counts, motor.motion.position_max_counts) = (-10_000, 10_000);
        }
        settings.unit.serial_timeout_tenths = 10;
        (self.change)(&mut settings);
        let config = ControllerConfig { settings: Some(settings), ..config };
        Controller::new(config).expect("only settings were changed")
    }
}

fn of_machine(name: &'static str, actions: Vec<WorldAction>, says: [&'static str; 2]) -> Cause {
    Cause { name, model: "mcp266", generation: Generation::Gen1, change: |_| {}, actions, says }
}

fn of_settings(name: &'static str, change: fn(&mut Settings), says: [&'static str; 2]) -> Cause {
    Cause { change, ..of_machine(name, Vec::new(), says) }
}

fn of_roboclaw(
    name: &'static str,
    generation: Generation,
    fault: UnitFault,
    says: [&'static str; 2],
) -> Cause {
    let actions = vec![WorldAction::SetUnitFault { fault, on: true }];
    Cause { model: "roboclaw-2x30a", generation, ..of_machine(name, actions, says) }
}

/// All causes.
pub fn all() -> Vec<Cause> {
    let mut causes = of_the_machine();
    causes.extend(of_the_electronics());
    causes.extend(of_the_settings());
    causes.extend(of_the_inputs());
    causes
}

fn of_the_machine() -> Vec<Cause> {
    let volts = |volts| WorldAction::SetBatteryVolts { volts };
    let hot = |celsius| vec![WorldAction::SetBoardCelsius { celsius: Some(celsius) }];
    vec![
        of_machine(
            "emergency stop",
            vec![WorldAction::EStop { pressed: true }],
            ["the emergency stop is active", "Release it, then restart the controller"],
        ),
        of_machine(
            "main battery low",
            vec![volts(9.0)],
            ["the main battery is at 9.0 V, below its minimum of 10.0 V", "Charge the main battery"],
        ),
        of_machine(
            "main battery high",
            vec![volts(61.0)],
            ["the main battery is at 61.0 V, above its maximum of 60.0 V", "Lower the main battery voltage"],
        ),
        of_machine(
            "logic battery high",
            vec![WorldAction::SetLogicVolts { volts: 20.0 }],
            ["the logic battery is at 20.0 V, above its maximum of 15.0 V", "restart the controller"],
        ),
        of_machine("too hot", hot(101.0), ["the board is at 101.0 °C", "Let the board cool below 100 °C"]),
        of_machine("hot", hot(90.0), ["its current limit is reduced", "Let the board cool below 85 °C"]),
    ]
}

fn of_the_electronics() -> Vec<Cause> {
    use Generation::{Gen2, Gen3, Gen4};
    vec![
        of_roboclaw("driver fault", Gen2, UnitFault::M2Driver, ["M2 driver fault", "short circuit"]),
        of_roboclaw(
            "short circuit",
            Gen3,
            UnitFault::M1Current,
            ["M1 current error", "Look for a blocked shaft"],
        ),
        of_roboclaw("CAN fault", Gen4, UnitFault::Can, ["CAN warning", "Check the CAN bus"]),
    ]
}

fn of_the_settings() -> Vec<Cause> {
    vec![
        of_settings(
            "position limits",
            |settings| {
                let motion = &mut settings.motors[1].motion;
                (motion.position_min_counts, motion.position_max_counts) = (0, 0);
            },
            ["the position limits of motor 2 (0 to 0)", "Set the lowest and the highest position"],
        ),
        of_settings(
            "position gains",
            |settings| settings.motors[0].motion.position_p_raw = 0,
            ["the position gains P, I and D of motor 1 are all 0", "Tune the position loop"],
        ),
        of_settings(
            "QPPS",
            |settings| settings.motors.iter_mut().for_each(|motor| motor.motion.qpps = 0),
            ["the QPPS of both motors is 0", "Measure the speed at full duty"],
        ),
        of_settings(
            "serial in no level",
            |settings| settings.priority = [2, 3, 0],
            ["serial is in none of the three priority levels", "Set a priority level to Serial"],
        ),
        of_settings(
            "no time-out",
            |settings| settings.streams.iter_mut().for_each(|stream| stream.timeout_ms = 0),
            ["the time-out of USB is 0", "Set it in General Settings"],
        ),
        of_settings(
            "a script",
            |settings| settings.unit.script_autorun_ms = 500,
            ["a script that starts 500 ms after power-up", "Press Stop All"],
        ),
    ]
}

/// Raw codes of the signals: analog and pulse, both motors, M1 safe stop (MCP manual 2.3.1 and 3.1).
const ANALOG: u8 = 1;
const PULSE: u8 = 2;
const BOTH: u8 = 3;
const SAFE_STOP_M1: u16 = 1;
/// A stream that is switched off (command 145).
const DISABLED: u8 = 2;

fn of_the_inputs() -> Vec<Cause> {
    let low = vec![WorldAction::SetPin { pin: 0, signal: PinSignal::Volts { volts: 0.0 } }];
    vec![
        of_settings(
            "an analog input above serial",
            |settings| {
                settings.priority = [3, 1, 0];
                (settings.signals[0].kind, settings.signals[0].target) = (ANALOG, BOTH);
            },
            ["the analog input pin DIN1", "Put Serial on a level above analog"],
        ),
        of_settings(
            "a pulse input above serial",
            |settings| {
                settings.priority = [2, 1, 0];
                (settings.signals[0].kind, settings.signals[0].target) = (PULSE, BOTH);
            },
            ["for as long as pulses come", "Put Serial on a level above pulse"],
        ),
        Cause {
            actions: low,
            // What generation 1 calls its actions on the wire is not public.
            generation: Generation::Gen2,
            ..of_settings(
                "an input at its end",
                |settings| {
                    // UART3 would hold the pin (MCP manual 1.9.7).
                    settings.streams[4].kind = DISABLED;
                    (settings.signals[0].kind, settings.signals[0].min_action) = (ANALOG, SAFE_STOP_M1);
                },
                ["is at its minimum, whose action stops motor 1", "change its minimum action"],
            )
        },
    ]
}

/// A controller whose motors may draw 1 A, so that a blocked shaft brings them to their limit.
pub fn limited_to_one_amp() -> Controller {
    let change = |settings: &mut Settings| {
        settings.motors.iter_mut().for_each(|motor| motor.motion.max_current_raw = 100);
    };
    of_settings("1 A", change, [""; 2]).controller()
}
