//! The script machine: lines compiled per second, instructions run per second, and the same integer loops in PUC Lua 5.4.
//!
//! Lua is a program of its own (`lua5.4`, or `lua` of that version): Brushwork does not need it, and without it those rows say that it is
//! not installed. Both are timed by the processor time of the loop alone, in turns; the best round of each counts. What MCL works out in 32
//! bits and Lua in 64 has to agree in its low 32 bits.

use std::process::Command;
use std::sync::Arc;
use std::time::Duration;

use brushwork_script::mcl::index::{Index, check};
use brushwork_script::mcl::registers::RegisterId;
use brushwork_script::mcl::{self, ast::Motion};
use brushwork_script::program::Program;
use brushwork_script::vm::{Host, Machine, State};

use super::Effort;
use super::editor;
use super::figure::{Figure, Target};
use super::spread::median;
use super::window::processor_time;

/// Times the speed of Lua.
const REQUIRED: f64 = 1.0;
/// Names under which PUC Lua 5.4 is installed.
const LUA: [&str; 3] = ["lua5.4", "lua-5.4", "lua"];
/// Instructions that the machine runs at a time: no one looks at it in between.
const SLICE: u32 = 1_000_000;

/// A loop in both languages. Its result is in `r`.
#[derive(Clone, Copy)]
struct Loop {
    name: &'static str,
    mcl: &'static str,
    lua: &'static str,
    /// Whether it is held to [`REQUIRED`].
    is_held: bool,
}

const LOOPS: [Loop; 6] = [
    Loop {
        name: "WHILE",
        mcl: "i var long\nr var long\nwhile i < 20000000\nr = r + i\ni = i + 1\nwend\n",
        lua: "local i = 0 while i < 20000000 do r = r + i i = i + 1 end",
        is_held: true,
    },
    Loop {
        name: "FOR",
        mcl: "i var long\nr var long\nfor i = 1 to 20000000\nr = r + i\nnext\n",
        lua: "for i = 1, 20000000 do r = r + i end",
        is_held: true,
    },
    Loop {
        name: "IF in a loop",
        mcl: "i var long\na var long\nr var long\nwhile i < 10000000\nif (i & 3) = 1 then\na = a + i\nelse\n\
              r = r ^ (i << 1)\nendif\ni = i + 1\nwend\nr = r + a\n",
        lua: "local i, a = 0, 0 while i < 10000000 do if i & 3 == 1 then a = a + i else r = r ~ (i << 1) end i = i + 1 end r = r + a",
        is_held: true,
    },
    Loop {
        name: "multiply, divide",
        mcl: "i var long\nr var long\nfor i = 1 to 10000000\nr = (r * 31 + i // 7) / 3\nnext\n",
        lua: "for i = 1, 10000000 do r = ((r * 31 + i % 7) & 0xffffffff) // 3 end",
        is_held: true,
    },
    Loop {
        name: "array",
        mcl: "l var long(1000)\ni var long\nn var long\nr var long\nfor n = 1 to 10000\nfor i = 1 to 999\n\
              l(i) = l(i - 1) + i\nnext\nl(0) = l(0) + 1\nnext\nr = l(999)\n",
        lua: "local l = {} for i = 0, 999 do l[i] = 0 end for n = 1, 10000 do for i = 1, 999 do l[i] = l[i - 1] + i end \
              l[0] = l[0] + 1 end r = l[999]",
        is_held: true,
    },
    Loop {
        name: "GOSUB",
        mcl: "i var long\nr var long\nx var long\nfor i = 1 to 2000000\ngosub sum[i],r\nnext\nend\nsum [x]\nreturn r + x\n",
        lua: "local function sum(x) return r + x end for i = 1, 2000000 do r = sum(i) end",
        is_held: false,
    },
];

/// All figures.
pub fn measure(effort: Effort) -> Result<Vec<Figure>, String> {
    let mut figures = compiler(effort);
    let lua = installed_lua();
    for both in &LOOPS {
        figures.extend(of_loop(both, lua, effort.mcl_rounds)?);
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

fn of_loop(both: &Loop, lua: Option<&'static str>, rounds: usize) -> Result<Vec<Figure>, String> {
    let name = both.name;
    let program =
        mcl::compile(both.mcl).program.ok_or_else(|| format!("the loop {name} does not compile"))?;
    let program = Arc::new(program);
    let mut ours = Fastest::default();
    let mut theirs = Fastest::default();
    let mut executed = 0;
    for _ in 0..rounds {
        let mut machine = Machine::new(program.clone());
        ours.took(processor_time_s(|| while matches!(machine.run(&mut Nowhere, SLICE), State::Ready) {}));
        let result = result_of(&machine).ok_or_else(|| format!("the loop {name} did not come to its end"))?;
        executed = machine.executed();
        if let Some(lua) = lua {
            let (lua_result, took_s) = run_lua(lua, both.lua)?;
            if lua_result != result {
                return Err(format!("the loop {name} gives {result} here and {lua_result} in Lua"));
            }
            theirs.took(took_s);
        }
    }
    let speed = executed as f64 / ours.0 / 1e6;
    let speed = Figure::new("mcl", format!("{name}: speed"), speed, "million instructions/s", 0)
        .note(format!("{executed} instructions in {:.0} ms, best of {rounds} rounds", ours.0 * 1e3));
    let ratio_name = format!("{name}: times PUC Lua 5.4");
    let ratio = match lua {
        None => Figure::missing("mcl", ratio_name, "not installed").note("needs lua5.4 on the path"),
        Some(lua) => Figure::new("mcl", ratio_name, theirs.0 / ours.0, "", 2)
            .note(format!("{lua}: the same loop in {:.0} ms, best of {rounds} in turns", theirs.0 * 1e3)),
    };
    Ok(vec![speed, if both.is_held { ratio.target(Target::AtLeast(REQUIRED)) } else { ratio }])
}

/// The shortest of some times, in seconds.
struct Fastest(f64);

impl Default for Fastest {
    fn default() -> Self {
        Self(f64::INFINITY)
    }
}

impl Fastest {
    fn took(&mut self, time_s: f64) {
        self.0 = self.0.min(time_s);
    }
}

/// What the loop worked out, if it ran to its end.
fn result_of(machine: &Machine) -> Option<u32> {
    if *machine.state() != State::Ended {
        return None;
    }
    let program: &Program = machine.program();
    let result = program.variables.iter().find(|variable| variable.name.eq_ignore_ascii_case("r"))?;
    Some(machine.memory().load(result.memory.first))
}

/// The name of an installed Lua 5.4.
fn installed_lua() -> Option<&'static str> {
    LUA.into_iter().find(|name| {
        #[expect(clippy::disallowed_methods, reason = "it says its version and ends")]
        let output = Command::new(name).arg("-v").output();
        output.is_ok_and(|output| {
            let said = [output.stdout, output.stderr].concat();
            String::from_utf8_lossy(&said).starts_with("Lua 5.4")
        })
    })
}

/// Runs a loop in Lua: the low 32 bits of its result, and the processor time of the loop in seconds.
fn run_lua(lua: &str, text: &str) -> Result<(u32, f64), String> {
    let text = format!("local began, r = os.clock(), 0 {text} print(r & 0xffffffff, os.clock() - began)");
    #[expect(clippy::disallowed_methods, reason = "a loop of ours, which ends")]
    let output = Command::new(lua).arg("-e").arg(text).output();
    let output = output.map_err(|error| format!("{lua}: {error}"))?;
    let said = String::from_utf8_lossy(&output.stdout);
    let mut words = said.split_whitespace();
    let mut next = || words.next().and_then(|word| word.parse::<f64>().ok());
    match (next(), next()) {
        (Some(result), Some(took_s)) if output.status.success() => Ok((result as u32, took_s)),
        _ => Err(format!("{lua} said {}", String::from_utf8_lossy(&output.stderr).trim())),
    }
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
        let lua = installed_lua();
        for (both, expected) in LOOPS.iter().zip(expected) {
            let mut machine = Machine::new(Arc::new(mcl::compile(&shorter(both.mcl)).program.unwrap()));
            while matches!(machine.run(&mut Nowhere, SLICE), State::Ready) {}
            assert_eq!(result_of(&machine), Some(expected), "{}", both.name);
            if let Some(lua) = lua {
                assert_eq!(run_lua(lua, &shorter(both.lua)).unwrap().0, expected, "{} in Lua", both.name);
            }
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

    #[test]
    fn without_lua_the_rows_say_so() {
        let figures = of_loop(&Loop { mcl: "r var long\nr = 7\n", ..LOOPS[5] }, None, 1).unwrap();
        assert_eq!(figures[1].cells()[2], "not installed");
        assert_eq!(figures[1].is_met(), None);
    }
}
