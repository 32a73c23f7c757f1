//! The script machine: lines compiled per second, and instructions run per second beside those of a controller.

use std::sync::Arc;
use std::time::Duration;

use brushwork_mcp_sim::controller::INSTRUCTION_TIME;
use brushwork_script::mcl::index::{Index, check};
use brushwork_script::mcl::registers::RegisterId;
use brushwork_script::mcl::{self, ast::Motion};
use brushwork_script::vm::{Host, Machine, State};

use crate::bench::Effort;
use crate::bench::editor;
use crate::bench::figure::{Figure, Target};
use crate::bench::spread::median;
use crate::bench::window::processor_time;

/// Times the speed of a controller's script: as the simulator that runs it is held to, see `sim`.
const REQUIRED: f64 = 500.0;
/// Instructions that the machine runs at a time: no one looks at it in between.
const SLICE: u32 = 1_000_000;

/// Loops by name. The result of each is in `r`.
const LOOPS: [(&str, &str); 6] = [
    ("WHILE", "i var long\nr var long\nwhile i < 20000000\nr = r + i\ni = i + 1\nwend\n"),
    ("FOR", "i var long\nr var long\nfor i = 1 to 20000000\nr = r + i\nnext\n"),
    (
        "IF in a loop",
        "i var long\na var long\nr var long\nwhile i < 10000000\nif (i & 3) = 1 then\na = a + i\nelse\n\
         r = r ^ (i << 1)\nendif\ni = i + 1\nwend\nr = r + a\n",
    ),
    ("multiply, divide", "i var long\nr var long\nfor i = 1 to 10000000\nr = (r * 31 + i // 7) / 3\nnext\n"),
    (
        "array",
        "l var long(1000)\ni var long\nn var long\nr var long\nfor n = 1 to 10000\nfor i = 1 to 999\n\
         l(i) = l(i - 1) + i\nnext\nl(0) = l(0) + 1\nnext\nr = l(999)\n",
    ),
    (
        "GOSUB",
        "i var long\nr var long\nx var long\nfor i = 1 to 2000000\ngosub sum[i],r\nnext\nend\nsum [x]\nreturn r + x\n",
    ),
];

/// All figures.
pub fn measure(effort: Effort) -> Result<Vec<Figure>, String> {
    let mut figures = compiler(effort);
    for (name, text) in LOOPS {
        figures.push(of_loop(name, text, effort.mcl_rounds)?);
    }
    Ok(figures)
}

/// The compiler, and with it all that the editor asks for at each key stroke.
fn compiler(effort: Effort) -> Vec<Figure> {
    let text = editor::program();
    let lines = text.lines().count() as f64;
    let per_second = |name: &str, mut work: Box<dyn FnMut() + '_>| {
        let times: Vec<f64> = (0..effort.mcl_rounds).map(|_| processor_time_s(&mut work)).collect();
        let took_ms = median(&times) * 1e3;
        Figure::new("mcl", name, lines / median(&times), "lines/s", 0).note(format!(
            "a program of {lines} lines, {took_ms:.1} ms; median of {} rounds",
            effort.mcl_rounds
        ))
    };
    vec![
        per_second("compile to byte code", Box::new(|| drop(check(&text)))),
        per_second("index for the editor", Box::new(|| drop(Index::of(&text)))),
    ]
}

fn processor_time_s(mut work: impl FnMut()) -> f64 {
    let began = processor_time();
    work();
    (processor_time() - began).as_secs_f64()
}

fn of_loop(name: &str, text: &str, rounds: usize) -> Result<Figure, String> {
    let program = mcl::compile(text).program.ok_or_else(|| format!("the loop {name} does not compile"))?;
    let program = Arc::new(program);
    let (mut best_s, mut executed) = (f64::INFINITY, 0);
    for _ in 0..rounds {
        let mut machine = Machine::new(program.clone());
        best_s = best_s.min(processor_time_s(|| run(&mut machine)));
        if *machine.state() != State::Ended {
            return Err(format!("the loop {name} did not come to its end"));
        }
        executed = machine.executed();
    }
    let per_second = executed as f64 / best_s;
    let times = per_second * INSTRUCTION_TIME.as_secs_f64();
    Ok(Figure::new("mcl", name, times, "x a controller's speed", 0).target(Target::AtLeast(REQUIRED)).note(
        format!(
            "{:.0} million instructions/s; {executed} in {:.0} ms, best of {rounds} rounds",
            per_second / 1e6,
            best_s * 1e3
        ),
    ))
}

fn run(machine: &mut Machine) {
    while matches!(machine.run(&mut Nowhere, SLICE), State::Ready) {}
}

/// Surroundings in which there is nothing.
struct Nowhere;

impl Host for Nowhere {
    fn now(&self) -> Duration {
        Duration::ZERO
    }
    fn register(&mut self, _: RegisterId, _: u8) -> u32 {
        0
    }
    fn set_register(&mut self, _: RegisterId, _: u8, _: u32) {}
    fn put(&mut self, _: u32, _: u8) {}
    fn get(&mut self, _: u32) -> Option<u8> {
        None
    }
    fn motion(&mut self, _: Motion, _: &[i32]) {}
    fn read_eeprom(&mut self, _: u32) -> u8 {
        0
    }
    fn write_eeprom(&mut self, _: u32, _: u8) {}
    fn i2c_write(&mut self, _: &[u8], _: bool, _: Option<Duration>) -> bool {
        false
    }
    fn i2c_read(&mut self, _: usize, _: Option<Duration>) -> Option<Vec<u8>> {
        None
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The loops with a thousandth of their rounds, worked out by Rust.
    #[test]
    fn the_loops_work_out_what_they_say() {
        let expected: [u32; 6] = [
            (0..20_000u32).fold(0, u32::wrapping_add),
            (1..=20_000u32).fold(0, u32::wrapping_add),
            {
                let a = (0..10_000u32).filter(|i| i & 3 == 1).fold(0, u32::wrapping_add);
                (0..10_000u32).filter(|i| i & 3 != 1).fold(0, |r, i| r ^ (i << 1)).wrapping_add(a)
            },
            (1..=10_000u32).fold(0u32, |r, i| r.wrapping_mul(31).wrapping_add(i % 7) / 3),
            9 + (1..=999).sum::<u32>(),
            (1..=2_000u32).fold(0, u32::wrapping_add),
        ];
        for ((name, text), expected) in LOOPS.into_iter().zip(expected) {
            let program = Arc::new(mcl::compile(&shorter(text)).program.unwrap());
            let mut machine = Machine::new(program.clone());
            run(&mut machine);
            assert_eq!(*machine.state(), State::Ended, "{name}");
            let r =
                program.variables.iter().find(|variable| variable.name.eq_ignore_ascii_case("r")).unwrap();
            assert_eq!(machine.memory().load(r.memory.first), expected, "{name}");
        }
    }

    /// Of counts in the millions a thousandth, and of the 10000 rounds over the array.
    fn shorter(text: &str) -> String {
        ["0000000", "000000"]
            .into_iter()
            .fold(text.replace("10000\n", "10\n").replace(" 10000 ", " 10 "), |text, many| {
                text.replace(many, &many[3..])
            })
    }
}
