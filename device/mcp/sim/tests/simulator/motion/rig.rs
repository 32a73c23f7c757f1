//! A channel wired to a motor of one equation.

use brushwork_mcp_sim::motion::{
    Channel, Conditions, ControlLaw, EncoderInput, Measured, MotionCommand, MotionSettings, Outcome,
};
use brushwork_plant::bridge::BridgeOutput;

/// Speed follows duty with one time constant; an encoder counts the travel.
#[derive(Clone, Copy, Debug)]
pub struct Motor {
    /// Speed at full duty, counts/s.
    full_speed: f64,
    /// 0 = ideal: the speed is there at once.
    tau_s: f64,
    /// Duty that friction eats.
    friction_duty: f64,
    /// 1, or -1 for an encoder wired the wrong way round.
    encoder_sign: f64,
    speed: f64,
    counts: f64,
}

impl Motor {
    pub fn ideal(full_speed: f64) -> Self {
        Motor { full_speed, tau_s: 0.0, friction_duty: 0.0, encoder_sign: 1.0, speed: 0.0, counts: 0.0 }
    }

    pub fn lag(full_speed: f64, tau_s: f64) -> Self {
        Motor { tau_s, ..Motor::ideal(full_speed) }
    }

    /// A motor that no duty moves.
    pub fn held() -> Self {
        Motor::ideal(10_000.0).with_friction(1.0)
    }

    pub fn with_friction(self, friction_duty: f64) -> Self {
        Motor { friction_duty, ..self }
    }

    pub fn with_reversed_encoder(self) -> Self {
        Motor { encoder_sign: -1.0, ..self }
    }

    pub fn speed(&self) -> f64 {
        self.speed
    }

    fn advance(&mut self, output: BridgeOutput, dt_s: f64) {
        let duty = output.duty();
        let steady = self.full_speed * (duty.abs() - self.friction_duty).max(0.0) * duty.signum();
        let decay = if self.tau_s > 0.0 { (-dt_s / self.tau_s).exp() } else { 0.0 };
        let before = self.speed;
        self.speed = steady + (before - steady) * decay;
        self.counts += steady * dt_s + (before - steady) * (1.0 - decay) * self.tau_s;
    }
}

/// Channel, settings, conditions and motor.
pub struct Rig {
    pub channel: Channel,
    pub settings: MotionSettings,
    pub conditions: Conditions,
    pub motor: Motor,
    pub ticks: u64,
}

impl Rig {
    pub fn new(law: &ControlLaw, settings: MotionSettings, motor: Motor) -> Self {
        let mut rig =
            Rig { channel: Channel::new(law), settings, conditions: Conditions::default(), motor, ticks: 0 };
        rig.tick();
        rig.ticks = 0;
        rig
    }

    pub fn command(&mut self, command: MotionCommand) -> Outcome {
        self.channel.command(command, &self.settings)
    }

    /// One tick of the channel, then one of the motor.
    pub fn tick(&mut self) -> BridgeOutput {
        let measured = Measured {
            encoder: EncoderInput::Quadrature((self.motor.counts * self.motor.encoder_sign).round() as i64),
            current_amps: 0.0,
            bus_volts: 24.0,
        };
        let output = self.channel.tick(&measured, &self.conditions, &self.settings);
        self.motor.advance(output, self.channel.law().tick_s());
        self.ticks += 1;
        output
    }

    pub fn run_ticks(&mut self, ticks: u64) {
        for _ in 0..ticks {
            self.tick();
        }
    }

    pub fn run_s(&mut self, seconds: f64) {
        self.run_ticks((seconds * f64::from(self.channel.law().rate_hz)).round() as u64);
    }

    /// Ticks until `done`, at most a minute's worth.
    pub fn ticks_until(&mut self, mut done: impl FnMut(&Rig) -> bool) -> u64 {
        for ticks in 0..60 * u64::from(self.channel.law().rate_hz) {
            if done(self) {
                return ticks;
            }
            self.tick();
        }
        panic!("not done within a minute: {:?}", self.channel.state());
    }

    pub fn setpoint(&self) -> i32 {
        self.channel.state().speed_setpoint_counts_per_s
    }

    pub fn position(&self) -> i32 {
        self.channel.encoder().position()
    }
}

/// Velocity gains as they are, QPPS 10000, position gains 0 and a wide position range.
pub fn settings(p: f64, i: f64, d: f64) -> MotionSettings {
    MotionSettings {
        velocity_p_raw: (p * 65_536.0) as u32,
        velocity_i_raw: (i * 65_536.0) as u32,
        velocity_d_raw: (d * 65_536.0) as u32,
        qpps: 10_000,
        position_min_counts: -1_000_000,
        position_max_counts: 1_000_000,
        ..MotionSettings::default()
    }
}
