//! Simulator speed: simulated seconds per second on one core, both motors in closed velocity loop.

use std::time::Duration;

use brushwork_protocol::packet_serial::{Address, Generation, Motor, Request, number};
use brushwork_sim::controller::{Bus, Controller, ControllerConfig};
use brushwork_sim::machine::{Machine as _, StreamIndex};
use brushwork_sim::presets::{self, Preset};
use brushwork_sim::server::measure_speed;

use super::Effort;
use super::figure::{Figure, Target};
use super::spread::median;

/// Times real time.
const REQUIRED: f64 = 500.0;
/// Simulated time of a round.
const ROUND: Duration = Duration::from_secs(5);
/// The simulator is asked for its encoders this often, as a program that polls would.
const POLL_INTERVAL: Duration = Duration::from_millis(10);

/// The default preset and the slowest of all.
pub fn measure(effort: Effort) -> Result<Vec<Figure>, String> {
    let mut default = None;
    let mut worst: Option<(&str, f64)> = None;
    for preset in presets::presets() {
        let times = speed_of(preset, ROUND, effort.sim_rounds)?;
        if preset.key == presets::DEFAULT {
            default = Some(times);
        }
        if worst.is_none_or(|(_, slowest)| times < slowest) {
            worst = Some((&preset.key, times));
        }
    }
    let (slowest, worst) = worst.ok_or("there is no preset")?;
    let simulated = ROUND.as_secs();
    let figure = |name: String, times: f64| {
        Figure::new("sim", name, times, "x real time", 0).target(Target::AtLeast(REQUIRED))
    };
    let note = format!(
        "median of {} rounds of {simulated} s, two motors at half speed, polled at 100 Hz, one core",
        effort.sim_rounds
    );
    Ok(vec![
        figure(format!("default preset ({})", presets::DEFAULT), default.unwrap_or(f64::NAN)).note(note),
        figure(format!("slowest preset ({slowest})"), worst)
            .note(format!("the slowest of {}", presets::presets().len())),
    ])
}

/// The median of some rounds, so that a moment in which the machine did something else does not count.
fn speed_of(preset: &Preset, round: Duration, rounds: usize) -> Result<f64, String> {
    let mut bus = bus_of(preset)?;
    let half_speed = full_speed(preset) / 2;
    let request = Request::new(Address::DEFAULT, number::SPEED_BOTH, &[half_speed, -half_speed]);
    let bytes = request.encode(Generation::Gen1).map_err(|error| error.to_string())?;
    let reply = bus.exchange(&bytes, Duration::from_millis(10));
    if reply != [0xff] {
        return Err(format!("{}: the simulated controller refused its speeds", preset.key));
    }
    let asked = Request::new(Address::DEFAULT, number::READ_ENCODERS, &[]);
    let asked = asked.encode(Generation::Gen1).map_err(|error| error.to_string())?;
    let one_round = |_| {
        let speed = measure_speed(&mut bus, round, POLL_INTERVAL, |bus: &mut Bus| {
            while bus.take_output(StreamIndex::Usb).is_some() {}
            bus.receive(StreamIndex::Usb, &asked);
        });
        speed.times_real_time()
    };
    let speeds: Vec<f64> = (0..rounds).map(one_round).collect();
    if preset.key == presets::DEFAULT && !Motor::BOTH.into_iter().all(|motor| is_turning(&bus, motor)) {
        return Err(format!("{}: the motors did not turn", preset.key));
    }
    Ok(median(&speeds))
}

/// A controller with the preset on both channels and its speed loops set to the preset's full speed.
fn bus_of(preset: &Preset) -> Result<Bus, String> {
    let unit = |config| Controller::new(config).map_err(|error| format!("{}: {error}", preset.key));
    let config = ControllerConfig::default();
    let pins = config.model.pins.len();
    let config = ControllerConfig { world: presets::world_of(preset, preset, pins), ..config };
    let mut settings = unit(config.clone())?.settings();
    for motor in &mut settings.motors {
        motor.motion.qpps = u32::try_from(full_speed(preset)).unwrap_or(u32::MAX);
    }
    let unit = unit(ControllerConfig { settings: Some(settings), ..config })?;
    Ok(Bus::single(unit, StreamIndex::Usb))
}

/// Encoder counts per second at full duty.
fn full_speed(preset: &Preset) -> i64 {
    let [low, high] = preset.stated.counts_per_second;
    f64::midpoint(low, high) as i64
}

fn is_turning(bus: &Bus, motor: Motor) -> bool {
    let unit = bus.controllers()[0].unit();
    unit.is_some_and(|unit| unit.channel(motor).speeds().filtered.abs() > 100)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_preset_takes_its_speeds_and_the_default_turns() {
        for preset in presets::presets() {
            let times = speed_of(preset, Duration::from_millis(300), 1).unwrap();
            assert!(times > 0.0, "{}", preset.key);
        }
    }
}
