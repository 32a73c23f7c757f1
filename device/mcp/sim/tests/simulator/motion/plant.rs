//! Channels on the real plant: ready-made axes under the default law and factory gains.

use brushwork_mcp_sim::motion::{
    Buffering, Channel, Conditions, ControlLaw, DistanceMove, EncoderInput, Measured, MotionCommand,
    MotionSettings,
};
use brushwork_plant::bridge::BridgeOutput;
use brushwork_plant::presets;
use brushwork_plant::presets::Preset;
use brushwork_plant::world::{World, WorldAction};
use brushwork_values::Motor;

struct Axis {
    world: World,
    channel: Channel,
    settings: MotionSettings,
    conditions: Conditions,
    peak_amps: f64,
    was_limited: bool,
}

impl Axis {
    /// A preset with factory gains, its QPPS set and a current limit in amperes.
    fn new(preset: &Preset, max_amps: f64) -> Self {
        let [low, high] = preset.stated.counts_per_second;
        let settings = MotionSettings {
            qpps: ((low + high) / 2.0) as u32,
            max_current_raw: (max_amps * 100.0) as u32,
            ..MotionSettings::default()
        };
        let world = World::new(&presets::world_of(preset, preset, 0), 1).expect("presets are valid");
        Axis {
            world,
            channel: Channel::new(&ControlLaw::default()),
            settings,
            conditions: Conditions::default(),
            peak_amps: 0.0,
            was_limited: false,
        }
    }

    fn command(&mut self, command: MotionCommand) {
        let _ = self.channel.command(command, &self.settings);
    }

    fn tick(&mut self) {
        let measured = Measured {
            encoder: EncoderInput::Quadrature(self.world.encoder(Motor::M1).counts),
            current_amps: self.world.measured_amps(Motor::M1),
            bus_volts: self.world.bus_volts(),
        };
        let decided = self.channel.tick(&measured, &self.conditions, &self.settings);
        let (channel, peak_amps) = (&mut self.channel, &mut self.peak_amps);
        let mut is_first = true;
        self.world.advance_with(ControlLaw::default().tick_s(), |motor, sense| match motor {
            Motor::M1 => {
                *peak_amps = peak_amps.max(sense.amps.abs());
                if std::mem::take(&mut is_first) {
                    decided
                } else {
                    channel.refine(sense.amps, sense.bus_volts, sense.step_s)
                }
            }
            Motor::M2 => BridgeOutput::Coast,
        });
        self.was_limited |= self.channel.is_current_limited();
    }

    fn run_s(&mut self, seconds: f64) {
        for _ in 0..(seconds * 300.0) as usize {
            self.tick();
        }
    }
}

/// Axes that turn freely and whose encoders give several counts a tick, as factory gains need.
fn free_axes() -> impl Iterator<Item = &'static Preset> {
    ["small-gearmotor", "large-gearmotor", "direct-drive", "coarse-encoder", "arm-joint"]
        .into_iter()
        .map(|key| presets::lookup(key).expect("a preset of that name"))
}

fn full_duty() -> MotionCommand {
    MotionCommand::Duty { duty_raw: 32_767, acceleration_raw: Some(655_359) }
}

#[test]
fn factory_gains_hold_a_speed_once_qpps_is_set() {
    for preset in free_axes() {
        let mut axis = Axis::new(preset, 60.0);
        for share in [0.4, -0.7] {
            let qpps = f64::from(axis.settings.qpps);
            let target = (share * qpps) as i32;
            axis.command(MotionCommand::Speed {
                speed_counts_per_s: target,
                acceleration: Some(qpps as u32),
            });
            axis.run_s(4.0);
            let average = axis.channel.speeds().average;
            let error = f64::from(average - target) / qpps;
            assert!(error.abs() < 0.002, "{} at {target}: {average}", preset.key);
        }
    }
}

#[test]
fn distance_moves_end_within_a_thousandth() {
    for preset in free_axes() {
        let mut axis = Axis::new(preset, 60.0);
        let qpps = axis.settings.qpps;
        let distance = DistanceMove {
            speed_counts_per_s: -((qpps * 3 / 10) as i32),
            acceleration: Some(qpps * 6 / 10),
            distance_counts: qpps / 2,
        };
        axis.run_s(0.1);
        let start = axis.channel.encoder().position();
        axis.command(MotionCommand::Distance(distance, Buffering::Queue));
        axis.run_s(4.0);
        assert_eq!(axis.channel.buffer_length(), 0x80, "{}", preset.key);
        let moved = start - axis.channel.encoder().position();
        let error = moved - (qpps / 2) as i32;
        assert!(error.unsigned_abs() <= 3 + qpps / 2000, "{}: {error} of {}", preset.key, qpps / 2);
    }
}

#[test]
fn the_current_limit_holds_while_a_motor_starts_at_full_duty() {
    for preset in free_axes() {
        let limit = preset.stated.stall_amps[0] * 0.3;
        let mut axis = Axis::new(preset, limit);
        axis.command(full_duty());
        axis.run_s(4.0);
        assert!(axis.was_limited, "{}", preset.key);
        assert!(axis.peak_amps < 1.15 * limit, "{}: {} of {limit} A", preset.key, axis.peak_amps);
        let speed = f64::from(axis.channel.speeds().average);
        assert!(speed > 0.9 * preset.stated.counts_per_second[0], "{}: {speed}", preset.key);
    }
}

/// A large gearmotor in torque mode, full duty 60 A.
fn torque_axis() -> Axis {
    let preset = presets::lookup("large-gearmotor").expect("a preset of that name");
    let mut axis = Axis::new(preset, 60.0);
    axis.settings.resistance_raw = (preset.axis.motor.armature_ohms * 16_777_216.0) as u32;
    axis.settings.inductance_raw = (preset.axis.motor.armature_henries * 16_777_216.0) as u32;
    axis
}

/// A quarter of the maximum current.
fn quarter_torque() -> MotionCommand {
    MotionCommand::Duty { duty_raw: 8_192, acceleration_raw: Some(655_359) }
}

#[test]
fn torque_mode_puts_the_asked_current_through_a_locked_motor_and_a_turning_one() {
    let mut axis = torque_axis();
    axis.world.apply(&WorldAction::LockShaft { motor: Motor::M1, on: true });
    axis.command(quarter_torque());
    axis.run_s(0.5);
    let amps = axis.world.truth(Motor::M1).amps;
    assert!((amps - 15.0).abs() < 0.3, "locked: {amps} A");
    axis.world.apply(&WorldAction::LockShaft { motor: Motor::M1, on: false });
    axis.run_s(0.05);
    let amps = axis.world.truth(Motor::M1).amps;
    assert!(axis.channel.speeds().raw > 3_000, "it turns");
    assert!((amps - 15.0).abs() < 0.8, "turning: {amps} A");
}

#[test]
fn in_torque_mode_a_duty_of_zero_coasts_and_a_stop_or_a_limit_brakes() {
    let speed_after = |end: fn(&mut Axis)| {
        let mut axis = torque_axis();
        axis.command(quarter_torque());
        axis.run_s(0.5);
        let before = axis.channel.speeds().raw;
        assert!(before > 20_000, "{before}");
        end(&mut axis);
        axis.run_s(0.4);
        f64::from(axis.channel.speeds().raw) / f64::from(before)
    };
    let coasted = speed_after(|axis| {
        axis.command(MotionCommand::Duty { duty_raw: 0, acceleration_raw: Some(655_359) });
    });
    let stopped = speed_after(|axis| axis.command(MotionCommand::SafeStop));
    let limited = speed_after(|axis| axis.conditions.forward_limit = true);
    assert!(coasted > 0.5, "{coasted}");
    assert!(stopped < 0.1, "{stopped}");
    assert!(limited < 0.1, "{limited}");
}
