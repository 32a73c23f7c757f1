//! Simulator speed: simulated seconds per second on one core, both motors in closed velocity loop.

use std::time::Duration;

use brushwork_mcp_sim::controller::{Bus, Controller, ControllerConfig};
use brushwork_mcp_wire::packet_serial::{Address, Generation, Request, number};
use brushwork_plant::machine::{Machine as _, StreamIndex};
use brushwork_plant::presets::{self, Preset};
use brushwork_plant::server::measure_speed;
use brushwork_script::{image, mcl};
use brushwork_values::Motor;

use crate::bench::Effort;
use crate::bench::figure::{Figure, Target};
use crate::bench::spread::median;

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
    let scripted = scripted_speed(effort.sim_rounds)?;
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
        figure("default preset, with a script".to_owned(), scripted).note(
            "the script never pauses: it counts, reads registers, drives both motors and says something ten times a second",
        ),
    ])
}

/// What a script that never pauses takes of it.
const SCRIPT: &str = "count var long\nsum var long\nnext_at var long\nspeed2 4000,8000,-4000,8000\nmain\n\
    count = count+1\nsum = sum+(count*3 & 0xFF)\nif MOTORENCPOS(0) > 1000000000 then main\nif SYSTICK < next_at then main\n\
    next_at = SYSTICK+100\nspeed2 4000,8000,-4000,8000\nputs 3,[dec count,13]\ngoto main\n";

/// Simulated seconds per second with a script that runs all the time.
fn scripted_speed(rounds: usize) -> Result<f64, String> {
    let preset = presets::lookup(presets::DEFAULT).ok_or("the default preset is missing")?;
    let mut bus = bus_of(preset)?;
    let program = mcl::compile(SCRIPT).program.ok_or("the script of the benchmark does not compile")?;
    bus.controllers_mut()[0].install_script(&image::encode(&program));
    let start = Request::new(Address::DEFAULT, number::START_SCRIPT, &[]);
    let start = start.encode(Generation::Gen1).map_err(|error| error.to_string())?;
    if bus.exchange(&start, Duration::from_millis(10)) != [0xff] {
        return Err("the simulated controller did not start the script".to_owned());
    }
    let speeds: Vec<f64> = (0..rounds).map(|_| times_real_time(&mut bus, ROUND)).collect::<Result<_, _>>()?;
    let unit = bus.controllers()[0].unit().ok_or("the unit lost its power")?;
    if !unit.script_is_running() || !Motor::BOTH.into_iter().all(|motor| is_turning(&bus, motor)) {
        return Err("the script did not drive the motors to the end".to_owned());
    }
    Ok(median(&speeds))
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
    let speeds: Vec<f64> = (0..rounds).map(|_| times_real_time(&mut bus, round)).collect::<Result<_, _>>()?;
    if preset.key == presets::DEFAULT && !Motor::BOTH.into_iter().all(|motor| is_turning(&bus, motor)) {
        return Err(format!("{}: the motors did not turn", preset.key));
    }
    Ok(median(&speeds))
}

/// One round, polled as by a program.
fn times_real_time(bus: &mut Bus, round: Duration) -> Result<f64, String> {
    let asked = Request::new(Address::DEFAULT, number::READ_ENCODERS, &[]);
    let asked = asked.encode(Generation::Gen1).map_err(|error| error.to_string())?;
    let speed = measure_speed(bus, round, POLL_INTERVAL, |bus: &mut Bus| {
        for stream in StreamIndex::ALL {
            while bus.take_output(stream).is_some() {}
        }
        bus.receive(StreamIndex::Usb, &asked);
    });
    Ok(speed.times_real_time())
}

/// A controller with the preset on both channels and its speed loops set to the preset's full speed.
fn bus_of(preset: &Preset) -> Result<Bus, String> {
    let unit = |config| Controller::new(config).map_err(|error| format!("{}: {error}", preset.key));
    let config = ControllerConfig::default();
    let pins = config.model.wired_pins();
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
