//! All pairs of operators against a second evaluator, which has its own table of the order (MCP manual 3.2.5) and its own arithmetic.

use crate::support::output;
use proptest::prelude::*;

/// MCP manual 3.2.5, from the second line on; the first are the operators of one operand.
const ORDER: [&[&str]; 8] = [
    &["DIG"],
    &["MAX", "MIN"],
    &["*", "**", "*/", "/", "//"],
    &["+", "-"],
    &["<<", ">>"],
    &["<", "<=", "=", ">=", ">", "<>"],
    &["&", "|", "^", "&/", "|/", "^/"],
    &["AND", "OR", "XOR"],
];

/// The first line, those for whole numbers.
const BEFORE: [&str; 9] = ["NOT", "ABS", "SIN", "COS", "-", "SQR", "RANDOM", "BIN2BCD", "~"];

/// A value and whether it is signed.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Number {
    bits: u32,
    signed: bool,
}

impl Number {
    fn wide(self) -> i128 {
        if self.signed { i128::from(self.bits as i32) } else { i128::from(self.bits) }
    }
}

fn level(operator: &str) -> usize {
    ORDER.iter().position(|line| line.contains(&operator)).expect("the table has it")
}

/// Arithmetic in 128 bits, cut to 32 at the end. `None` for a division by zero.
fn two(operator: &str, a: Number, b: Number) -> Option<Number> {
    let signed = a.signed || b.signed;
    let as_kind = |number: Number| Number { signed, ..number }.wide();
    let (x, y) = (as_kind(a), as_kind(b));
    let whole = |value: i128| Number { bits: value as u32, signed };
    let truth = |value: bool| Number { bits: u32::from(value), signed: false };
    let shift = |left: bool| match (b.bits, left) {
        (32.., _) => 0,
        (count, true) => a.bits << count,
        (count, false) => a.bits >> count,
    };
    Some(match operator {
        "DIG" => {
            let digits: Vec<u32> =
                x.unsigned_abs().to_string().chars().rev().filter_map(|d| d.to_digit(10)).collect();
            let place = (b.bits as usize).checked_sub(1);
            Number { bits: place.and_then(|place| digits.get(place).copied()).unwrap_or(0), signed: false }
        }
        "MAX" => whole(x.min(y)),
        "MIN" => whole(x.max(y)),
        "*" => whole(x * y),
        "**" => whole((x * y).div_euclid(1 << 32)),
        "*/" => whole(x * y / 65_536),
        "/" if y == 0 => return None,
        "//" if y == 0 => return None,
        "/" => whole(x / y),
        "//" => whole(x % y),
        "+" => whole(x + y),
        "-" => whole(x - y),
        "<<" => whole(shift(true).into()),
        ">>" => whole(shift(false).into()),
        "<" => truth(x < y),
        "<=" => truth(x <= y),
        "=" => truth(a.bits == b.bits),
        ">=" => truth(x >= y),
        ">" => truth(x > y),
        "<>" => truth(a.bits != b.bits),
        "&" => whole((a.bits & b.bits).into()),
        "|" => whole((a.bits | b.bits).into()),
        "^" => whole((a.bits ^ b.bits).into()),
        "&/" => whole((!(a.bits & b.bits)).into()),
        "|/" => whole((!(a.bits | b.bits)).into()),
        "^/" => whole((!(a.bits ^ b.bits)).into()),
        "AND" => truth(a.bits != 0 && b.bits != 0),
        "OR" => truth(a.bits != 0 || b.bits != 0),
        "XOR" => truth((a.bits != 0) != (b.bits != 0)),
        other => panic!("{other}"),
    })
}

fn one(operator: &str, a: Number) -> Number {
    let number = |bits: u32, signed: bool| Number { bits, signed };
    let sine = |angle: u32| {
        let turns = f64::from(angle % 256) / 256.0;
        number(((turns * std::f64::consts::TAU).sin() * 128.0).trunc().max(-127.0) as i32 as u32, true)
    };
    match operator {
        "NOT" => number(u32::from(a.bits == 0), false),
        "ABS" => number(a.wide().unsigned_abs() as u32, false),
        "SIN" => sine(a.bits),
        "COS" => sine(a.bits.wrapping_add(64)),
        "-" => number(0u32.wrapping_sub(a.bits), true),
        "SQR" => number(if a.wide() < 0 { 0 } else { (a.wide() as f64).sqrt() as u32 }, false),
        "RANDOM" => number((u64::from(a.bits) * 1_664_525 + 1_013_904_223) as u32, false),
        "BIN2BCD" => {
            let text = (a.bits % 100_000_000).to_string();
            number(u32::from_str_radix(&text, 16).expect("digits"), false)
        }
        "~" => number(a.bits ^ u32::MAX, a.signed),
        other => panic!("{other}"),
    }
}

/// `a first b second c`, by the table.
fn both(first: &str, second: &str, [a, b, c]: [Number; 3]) -> Option<Number> {
    if level(first) <= level(second) {
        two(second, two(first, a, b)?, c)
    } else {
        two(first, a, two(second, b, c)?)
    }
}

fn operators() -> impl Iterator<Item = &'static str> {
    ORDER.into_iter().flatten().copied()
}

/// Values of each kind of variable, and as numbers in the text.
fn sets() -> [([Number; 3], [&'static str; 3]); 5] {
    let long = |bits: u32| Number { bits, signed: false };
    let slong = |value: i32| Number { bits: value as u32, signed: true };
    [
        ([long(17_458), long(4), long(3)], ["a", "b", "c"]),
        ([long(6), long(5), long(4)], ["a", "b", "c"]),
        ([slong(-90), slong(7), slong(2)], ["d", "e", "f"]),
        ([long(3_000_000_000), slong(-3), long(2)], ["a", "e", "c"]),
        ([long(29), long(3), long(2)], ["29", "3", "2"]),
    ]
}

fn definitions([a, b, c]: [Number; 3]) -> String {
    let mut text =
        String::from("a var long\nb var long\nc var long\nd var slong\ne var slong\nf var slong\n");
    for (names, value) in [("ad", a), ("be", b), ("cf", c)] {
        for name in names.chars() {
            text += &format!("{name} = {}\n", value.bits);
        }
    }
    text
}

#[test]
fn every_pair_of_operators_binds_as_the_manuals_table_says() {
    let mut compared = 0;
    for (values, names) in sets() {
        let mut text = definitions(values);
        let mut expected = String::new();
        for first in operators() {
            for second in operators() {
                let Some(value) = both(first, second, values) else { continue };
                let [a, b, c] = names;
                text += &format!("puts 0,[\"{first} {second} \",sdec {a} {first} {b} {second} {c},10]\n");
                expected += &format!("{first} {second} {}\n", value.bits as i32);
                compared += 1;
            }
        }
        assert_eq!(output(&(text + "end\n")), expected);
    }
    assert!(compared > 3_500, "{compared}");
}

#[test]
fn operators_of_one_operand_come_before_every_other() {
    for (values, [a, b, _]) in sets() {
        let mut text = definitions(values);
        let mut expected = String::new();
        for before in BEFORE {
            for operator in operators() {
                let left = two(operator, one(before, values[0]), values[1]);
                let right = two(operator, values[0], one(before, values[1]));
                let (Some(left), Some(right)) = (left, right) else { continue };
                text += &format!(
                    "puts 0,[sdec {before} {a} {operator} {b},\" \",sdec {a} {operator} {before} {b},10]\n"
                );
                expected += &format!("{} {}\n", left.bits as i32, right.bits as i32);
            }
        }
        assert_eq!(output(&(text + "end\n")), expected);
    }
}

proptest! {
    #![proptest_config(ProptestConfig { rng_seed: proptest::test_runner::RngSeed::Fixed(0x5EED), failure_persistence: None, ..ProptestConfig::with_cases(48) })]
    #[test]
    fn arithmetic_is_that_of_plain_integers(a: u32, b: u32, small in 0u32..40, signs in 0u8..4) {
        let values = [Number { bits: a, signed: signs & 1 != 0 }, Number { bits: b, signed: signs & 2 != 0 }];
        let names = [["a", "d"][usize::from(signs & 1)], ["b", "e"][usize::from(signs >> 1)]];
        let mut text = definitions([values[0], values[1], Number { bits: small, signed: false }]);
        let mut expected = String::new();
        for operator in operators() {
            if let Some(value) = two(operator, values[0], values[1]) {
                text += &format!("puts 0,[sdec {} {operator} {},10]\n", names[0], names[1]);
                expected += &format!("{}\n", value.bits as i32);
            }
            let value = two(operator, values[0], Number { bits: small, signed: false });
            if let Some(value) = value {
                text += &format!("puts 0,[sdec {} {operator} c,10]\n", names[0]);
                expected += &format!("{}\n", value.bits as i32);
            }
        }
        prop_assert_eq!(output(&(text + "end\n")), expected);
    }
}
