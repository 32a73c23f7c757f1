//! The machine runs a budget of instructions at a time. Nothing can be told from outside about where the budgets end: results, faults,
//! lines and counts are the same.
//!
//! `BRUSHWORK_MCL_SAME=n` compares n damaged programs, `BRUSHWORK_SEED=n` others.

use crate::support::mutation::{damaged, number, seeds};
use crate::support::{TestHost, same_host};
use brushwork_script::mcl::compile;
use brushwork_script::program::Program;
use brushwork_script::vm::{Machine, State};
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::{Rng, SeedableRng};
use std::sync::Arc;

/// Loops of every kind over variables of every kind.
const LOOPS: [&str; 11] = [
    "a var long\nb var slong\nc var byte\nwhile a < 50\na = a + 1\nb = b - (a // 7) * 3\nc = c + a\nwend\nputs 0,[dec a,sdec b,dec c]\nend\n",
    "l var long(9)\ni var long\nfor i = 0 to 8\nl(i) = i * i\nnext\nfor i = 8 to 0\nputs 0,[dec l(i)]\nnext\nl(i) = 1\nend\n",
    "a var slong\nf var float\ndo\na = a - 3\nf = f + 0.5\nwhile a > -40 and f < 6.0\nrepeat\na = a + 1\nuntil a >= 5\nputs 0,[sdec a,real f]\nend\n",
    "a var long\nb var nib\nmain\na = a + 1\nb = a >> 1 & 7 max 5\nif a = 30 then out\nif b <> 3 then main\na = a + (b << 2)\ngoto main\nout\nputs 0,[dec a,dec b]\nend\n",
    "d var long\na var slong\na = 100\nd = 5\nmain\nd = d - 1\na = a / (d - 2) ** 3\ngoto main\n",
    "a var slong\nb var long\nwhile a < 900\nb = b * 3 + a\na = a + 1\nwend\nfor a = -5 to 300 step 7\nb = b ^ a\nnext\nputs 0,[dec b]\nend\n",
    "l var long(20)\ni var long\nr var byte\nfor r = 1 to 255\nfor i = 1 to 19\nl(i) = l(i - 1) + i << 1\nnext\nl(0) = l(19) - r\nnext\nend\n",
    "l var slong(7)\ni var slong\ns var slong\nrepeat\ni = i + 1\ns = s - l(i - 1) * 2\nl(i + 1) = s ^ i\nuntil i > 100\nend\n",
    "w var word(50)\nf var float\ni var sword\nfor f = 4.5 to 0.25 step -0.25\nfor i = 49 to 0\nw(i) = w(i) + i * 3 | 1\nnext\nnext\nputs 0,[dec w(3)]\nend\n",
    "a var long\nb var long\nc var long\nmain\na = a + 1\nb = b + a\nc = c ^ b\nif a & 1 = 1 then\nc = c << 1\nelseif a & 2 = 2 then\nc = c >> 3\nelse\na = a + 2\nb = a\nendif\nif a < 1500 then main\nputs 0,[dec c]\nend\n",
    "t WordTable 1,20,300\ni var long\ns var long\nmain\ns = s + t(i) ^ 3\ni = i + 1\nif not (s > 1000) then main\nend\n",
];

fn run(program: &Arc<Program>, most: u64, mut budget: impl FnMut() -> u32) -> (Machine, TestHost) {
    let mut machine = Machine::new(program.clone());
    let mut host = TestHost::default();
    host.waiting.insert(0, (0..=255).collect());
    while machine.executed() < most {
        let left = u32::try_from(most - machine.executed()).unwrap_or(u32::MAX);
        match machine.run(&mut host, budget().min(left)) {
            State::Pausing { until } => host.now = *until,
            State::Ready => {}
            _ => break,
        }
    }
    (machine, host)
}

fn compare(text: &str, rng: &mut ChaCha8Rng) -> bool {
    let Some(program) = compile(text).program.map(Arc::new) else { return false };
    let most = u64::from(rng.next_u32() % 4_000);
    let (stepped, stepped_host) = run(&program, most, || 1);
    let (whole, whole_host) = run(&program, most, || 4_000);
    let (cut, cut_host) = run(&program, most, || 1 + rng.next_u32() % 1_500);
    for (other, host) in [(&whole, &whole_host), (&cut, &cut_host)] {
        assert_eq!(stepped.state(), other.state(), "{text}");
        assert_eq!((stepped.at(), stepped.executed()), (other.at(), other.executed()), "{text}");
        assert_eq!(stepped.memory(), other.memory(), "{text}");
        assert!(same_host(&stepped_host, host), "{text}");
    }
    true
}

#[test]
fn loops_give_the_same_however_their_budget_is_cut() {
    let mut rng = ChaCha8Rng::seed_from_u64(3);
    for text in LOOPS {
        for _ in 0..200 {
            assert!(compare(text, &mut rng), "{text}");
        }
    }
}

#[test]
fn damaged_programs_give_the_same_however_their_budget_is_cut() {
    let (seed, runs) = (number("BRUSHWORK_SEED", 9), number("BRUSHWORK_MCL_SAME", 2_000));
    println!("seed {seed}, {runs} programs");
    let mut rng = ChaCha8Rng::seed_from_u64(seed);
    let mut texts = seeds();
    texts.extend(LOOPS.map(str::to_owned));
    let compared = (0..runs).filter(|_| compare(&damaged(&mut rng, &texts), &mut rng)).count();
    assert!(compared > 100, "only {compared} of {runs} compiled");
}
