//! What is connected to the input pins: voltages, pulses, encoders, limit switches and the E-stop button.

use crate::{EncoderKind, EncoderReading};
use brushwork_values::Motor;
use serde::{Deserialize, Serialize};

/// Voltage of a pin whose switch is open: switches close to ground against a pull-up (MCP manual 1.5.5).
pub const SWITCH_OPEN_VOLTS: f64 = 5.0;

/// What is connected to an input pin.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
pub enum PinSignal {
    /// Nothing, or the switch that is wired to the pin.
    #[default]
    Open,
    /// A voltage. For a digital input, 0 is low and 5 is high.
    Volts {
        /// The voltage.
        volts: f64,
    },
    /// Pulses of this width, as from a radio receiver.
    Pulse {
        /// Their width.
        microseconds: f64,
    },
    /// The encoder of an axis.
    Encoder {
        /// Whose encoder.
        motor: Motor,
    },
}

/// What the controller finds on an input pin.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum PinState {
    /// Nothing is connected, or the pulses have stopped.
    Open,
    /// A voltage.
    Volts(f64),
    /// Pulses of this width.
    Pulse {
        /// Their width.
        microseconds: f64,
    },
    /// Quadrature counts, without bound.
    Counts(i64),
}

/// What is wired to which pin.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Wiring {
    /// Pin of the E-stop button, counted from 0; none means that the button acts on the unit without a pin.
    pub estop_pin: Option<usize>,
    /// Limit and home switches.
    pub switches: Vec<SwitchWiring>,
}

/// One limit or home switch.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SwitchWiring {
    /// Whose switch.
    pub motor: Motor,
    /// Which switch.
    pub switch: SwitchKind,
    /// Its pin, counted from 0.
    pub pin: usize,
    /// Where the output shaft closes it: a forward switch at and above this, the others at and below. Without it, only a person
    /// closes the switch.
    #[serde(default)]
    pub trips_at_radians: Option<f64>,
}

/// Which switch of an axis.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum SwitchKind {
    /// End of the forward travel.
    Forward,
    /// End of the backward travel.
    Backward,
    /// Home position.
    Home,
}

/// The pins of one controller.
#[derive(Clone, Debug)]
pub(super) struct Pins {
    wiring: Wiring,
    signals: Vec<PinSignal>,
    held: Vec<(Motor, SwitchKind)>,
}

impl PinState {
    /// What an encoder puts on a pin.
    pub(super) fn of_encoder(reading: EncoderReading) -> Self {
        match reading.kind {
            _ if !reading.present => Self::Open,
            EncoderKind::Quadrature => Self::Counts(reading.counts),
            EncoderKind::Analog => Self::Volts(reading.volts()),
            EncoderKind::Pulse => Self::Pulse { microseconds: reading.counts as f64 },
        }
    }
}

impl SwitchKind {
    /// All three.
    pub const ALL: [Self; 3] = [Self::Forward, Self::Backward, Self::Home];
}

impl Wiring {
    /// How a switch is wired, where it is.
    pub fn switch(&self, motor: Motor, switch: SwitchKind) -> Option<&SwitchWiring> {
        self.switches.iter().find(|wired| wired.motor == motor && wired.switch == switch)
    }
}

impl Pins {
    pub fn new(count: usize, wiring: Wiring) -> Self {
        Self { wiring, signals: vec![PinSignal::Open; count], held: Vec::new() }
    }

    pub fn signals(&self) -> &[PinSignal] {
        &self.signals
    }

    pub fn set(&mut self, pin: usize, signal: PinSignal) {
        if let Some(place) = self.signals.get_mut(pin) {
            *place = signal;
        }
    }

    pub fn wiring(&self) -> &Wiring {
        &self.wiring
    }

    pub fn wire(
        &mut self,
        motor: Motor,
        switch: SwitchKind,
        pin: Option<usize>,
        trips_at_radians: Option<f64>,
    ) {
        self.wiring.switches.retain(|wired| (wired.motor, wired.switch) != (motor, switch));
        if let Some(pin) = pin {
            self.wiring.switches.push(SwitchWiring { motor, switch, pin, trips_at_radians });
        }
    }

    pub fn hold(&mut self, motor: Motor, switch: SwitchKind, closed: bool) {
        self.held.retain(|held| *held != (motor, switch));
        if closed {
            self.held.push((motor, switch));
        }
    }

    /// What is on a pin: what a person connected to it, else the switch or button wired to it.
    pub fn signal(&self, pin: usize, load_radians: [f64; 2], estop_pressed: bool) -> PinSignal {
        match self.signals.get(pin) {
            Some(PinSignal::Open) => {}
            Some(&signal) => return signal,
            None => return PinSignal::Open,
        }
        let mut wired = self.wiring.switches.iter().filter(|wired| wired.pin == pin).peekable();
        let button = self.wiring.estop_pin == Some(pin);
        if wired.peek().is_none() && !button {
            return PinSignal::Open;
        }
        let pressed = button && estop_pressed;
        let closed = pressed
            || wired.any(|wired| {
                self.switch_closed(wired.motor, wired.switch, load_radians[wired.motor.index()])
            });
        PinSignal::Volts { volts: if closed { 0.0 } else { SWITCH_OPEN_VOLTS } }
    }

    pub fn switch_closed(&self, motor: Motor, switch: SwitchKind, load_radians: f64) -> bool {
        let tripped = |wired: &SwitchWiring| {
            wired.trips_at_radians.is_some_and(|at| match switch {
                SwitchKind::Forward => load_radians >= at,
                SwitchKind::Backward | SwitchKind::Home => load_radians <= at,
            })
        };
        self.held.contains(&(motor, switch)) || self.wiring.switch(motor, switch).is_some_and(tripped)
    }
}
