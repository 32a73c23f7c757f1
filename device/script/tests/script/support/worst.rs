//! The worst programs we can think of, of any length: deep, long, wide, wrong, and random.

use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::{Rng, SeedableRng};

/// A program and what is bad about it.
pub struct Worst {
    pub name: String,
    pub text: String,
}

/// Defined in front of programs that are to be right.
const HEAD: &str = "a var long\nf var float\nt var long(9)\nl\n";

/// A start, a piece as often as there is room, an end.
const REPEATED: [(&str, &str, &str); 96] = [
    // Expressions that grow to the right.
    ("a = ", "(", ""),
    ("a = ", "((((1))))+", "1"),
    ("a = ", "- ", "1"),
    ("a = ", "-", "1"),
    ("a = ", "~", "1"),
    ("a = ", "not ", "1"),
    ("a = ", "abs(", "1"),
    ("a = ", "t(", "1"),
    ("a = ", "a.byte0(", "1"),
    ("a = f", "+f*f-f/f", ""),
    ("a = a", " dig a", ""),
    ("a = a", " max a", ""),
    ("a = a", "*a", ""),
    ("a = a", "//0", ""),
    ("a = a", "+a", ""),
    ("a = 1", "+1", "+a"),
    ("a = 1", "+1", "+1"),
    ("a = 1", "/0", ""),
    ("a = \"ab\"", "+\"ab\"", ""),
    ("f = 1", "+1.0+a", ""),
    ("a = a", "<<a", ""),
    ("a = a", "<a", ""),
    ("a = a", "&a", ""),
    ("a = a", "&a<a", ""),
    ("a = a", "<1&SYSSTATUS", ""),
    ("a = a", " and a", ""),
    ("a = a", "+a*a", ""),
    ("a = a", " or a & a < a << a + a * a max a dig a", ""),
    ("a = a", " dig a max a * a + a << a < a & a or a", ""),
    ("a = a", "+t(a)", ""),
    ("a = a", "+t(1+1)", ""),
    ("a = a", "+nothing", ""),
    ("a = a", "+a.nothing", ""),
    ("c con 1", "+1", ""),
    ("a var byte(1", "+1", ")"),
    ("#if 1", "+1", "\nend\n#endif"),
    // Lists.
    ("puts 0,[", "1,", "1]"),
    ("puts 0,[", "dec a\\2,", "1]"),
    ("puts 0,[", "\"abc\",", "1]"),
    ("gets 0,[", "a,", "a]"),
    ("b bytetable ", "1,", "1"),
    ("b bytetable ", "\"abcdefgh\",", "1"),
    ("b longtable ", "1,", "1"),
    ("b bytetable ", "a,", "1"),
    ("gosub l[", "1,", "1]"),
    ("branch a,[", "l,", "l]"),
    ("i2cout [", "1,", "1]"),
    ("move ", "1,", "1"),
    ("t = ", "1,", "1"),
    ("a = ", "1\\", "1"),
    ("x[", "a,", "a]"),
    ("x[", "t(1),", "a]"),
    // Blocks that nobody closes.
    ("", "if 1 then\n", ""),
    ("", "if 1 then ", ""),
    ("", "if ", ""),
    ("", "for a = 1 to 2\n", ""),
    ("", "while 1\n", ""),
    ("", "do\n", ""),
    ("", "do\nwhile 1\n", ""),
    ("", "do while ", ""),
    ("", "do\nwhile 1\nwend\n", ""),
    ("", "repeat\n", ""),
    ("", "repeat\nuntil 1\n", ""),
    ("if 1 then\n", "elseif 1\n", "endif"),
    ("", "else\n", ""),
    ("", "wend\n", ""),
    ("", "#if 1\n", ""),
    ("", "#if 0\n", ""),
    ("#if 0\n", "#else\n", "#endif"),
    ("", "#if 0\n?\n#endif\n", ""),
    ("", "#ifdef a\nend\n#endif\n", ""),
    ("", "#elsif\n", ""),
    ("", "#a", ""),
    // Statements without end.
    ("", "l\n", ""),
    ("", "l:", ""),
    ("", "end:", ""),
    ("", "a=a\n", ""),
    ("", "a=a:", ""),
    ("", "goto l\n", ""),
    ("", "goto nowhere\n", ""),
    ("", "gosub l[1]\n", ""),
    ("", "gotto l\n", ""),
    ("", "pust 0,[1]\n", ""),
    ("", "puts 0,[deq a]\n", ""),
    ("", "if a then l\n", ""),
    ("", "if a then\nend\nendif\n", ""),
    ("", "for a = 1 to 2\nnext\n", ""),
    // Texts, numbers, names, characters.
    ("", "\"", ""),
    ("puts 0,[\"", "a", "\"]"),
    ("puts 0,[\"", "€", "\"]"),
    ("puts 0,[", "\"é\"", "]"),
    ("", "\"\n", ""),
    ("a = ", "9", ""),
    ("a = 0x", "f", ""),
    ("a = 1.", "1", ""),
    ("", "\u{1F600}", ""),
];

/// All of them that are wanted by their names, of about so many bytes each. `seed` is that of the random ones.
pub fn worst(bytes: usize, seed: u64, wanted: impl Fn(&str) -> bool) -> Vec<Worst> {
    let mut all = Vec::new();
    let mut add = |name: String, text: &dyn Fn() -> String| {
        if wanted(&name) {
            all.push(Worst { name, text: text() });
        }
    };
    let often = |piece: &str| piece.repeat((bytes / piece.len()).max(1));
    for (start, piece, end) in REPEATED {
        add(format!("{start}{piece}...{end}"), &|| format!("{HEAD}{start}{}{end}\n", often(piece)));
    }
    for letter in (0..128u8).map(char::from) {
        add(format!("only {letter:?}"), &|| letter.to_string().repeat(bytes));
    }
    // As deep as it may be, on every line.
    let orders = "1 or a & 1 < a << 1 + a * 1 max a dig (";
    for (name, open, close, depth) in [
        ("every order in parentheses", orders, ")", 99),
        ("indices in indices", "t(a+", ")", 99),
        ("constants in parentheses", "1+1+(", ")", 99),
        ("operators before a value", "-(~ ", ")", 49),
    ] {
        let line = || format!("a = {}a{}\n", open.repeat(depth), close.repeat(depth));
        add(format!("deep lines: {name}"), &|| HEAD.to_owned() + &often(&line()));
    }
    for (open, close) in [
        ("if a then\n", "endif\n"),
        ("for a = 1 to 2\n", "next\n"),
        ("while a\n", "wend\n"),
        ("repeat\n", "until a\n"),
        ("do\n", "while a\n"),
    ] {
        let around = |inside: &str| format!("{}{inside}{}", open.repeat(99), close.repeat(99));
        add(format!("deep blocks: {open}"), &|| HEAD.to_owned() + &often(&around("")));
        add(format!("inside of 99: {open}"), &|| HEAD.to_owned() + &around(&often("a=a\n")));
    }
    for (name, line) in numbered() {
        add(format!("numbered: {name}"), &|| {
            let mut text = HEAD.to_owned();
            for number in 0..bytes {
                if text.len() >= bytes {
                    break;
                }
                text += &line(number);
            }
            text
        });
    }
    add("one name".to_owned(), &|| format!("a = {}\n", "n".repeat(bytes)));
    add("two names".to_owned(), &|| {
        let (one, other) = ("n".repeat(bytes / 2), "m".repeat(bytes / 2));
        format!("{one} var byte\n{other} = 1\n")
    });
    for power in 0..3 {
        add(format!("soup {power}, seed {seed}"), &|| soup(bytes, seed, power));
    }
    all
}

type Line = Box<dyn Fn(usize) -> String>;

/// Lines with a number in them.
fn numbered() -> Vec<(&'static str, Line)> {
    vec![
        ("variables", Box::new(|n| format!("v{n} var bit\n"))),
        ("large variables", Box::new(|n| format!("v{n} var byte(32768)\nv{n}(5) = 1\n"))),
        ("labels", Box::new(|n| format!("l{n}\n"))),
        ("aliases", Box::new(|n| format!("v{n} var a.byte0\n"))),
        ("constants", Box::new(|n| format!("c{n} con {n}\n"))),
        ("names that are nowhere", Box::new(|n| format!("a = name{n}\n"))),
        ("names that are near", Box::new(|n| format!("name{n} var byte\nnaem{n} = 1\n"))),
        ("labels that are nowhere", Box::new(|n| format!("label{n}\ngoto lebal{n}\n"))),
        ("calls further down", Box::new(|n| format!("l{n}\ngosub l{}\n", n + 1))),
        ("calls further up", Box::new(|n| format!("l{n}\ngosub l{}\n", n.saturating_sub(1)))),
        ("calls of itself", Box::new(|n| format!("l{n}\ngosub l{n}\nreturn\n"))),
        ("calls of all before", Box::new(|n| format!("l{n}\ngosub l{}\n", n / 2))),
        ("jumps further down", Box::new(|n| format!("l{n}\nif a then l{}\n", n + 2))),
    ]
}

const WORDS: [&str; 48] = [
    "if",
    "then",
    "else",
    "elseif",
    "endif",
    "for",
    "to",
    "step",
    "next",
    "while",
    "wend",
    "do",
    "repeat",
    "until",
    "goto",
    "gosub",
    "return",
    "branch",
    "puts",
    "gets",
    "let",
    "var",
    "con",
    "byte",
    "long",
    "float",
    "bytetable",
    "dec",
    "rep",
    "str",
    "not",
    "abs",
    "max",
    "and",
    "a",
    "b",
    "t",
    "l",
    "SYSTICK",
    "MOTORENCPOS",
    "1",
    "2.5",
    "\"x\"",
    "#if",
    "#else",
    "#endif",
    "\0",
    "é",
];

const SIGNS: [&str; 16] = ["(", ")", "[", "]", ",", "\\", ".", ":", "=", "+", "-", "*", "<", "&", ";", "\""];

/// Words and signs at random, in lines of about so many as the power of ten says.
fn soup(bytes: usize, seed: u64, power: u64) -> String {
    let mut rng = ChaCha8Rng::seed_from_u64(seed);
    let mut pick = |below: usize| rng.next_u32() as usize % below;
    let line = 10usize.pow(u32::try_from(power).unwrap_or(0) * 2 + 1);
    let mut text = String::with_capacity(bytes + 16);
    while text.len() < bytes {
        match pick(line.max(2) * 2) {
            0 => text.push('\n'),
            n if n % 3 == 0 => text += SIGNS[pick(SIGNS.len())],
            _ => {
                text += WORDS[pick(WORDS.len())];
                text.push(' ');
            }
        }
    }
    text
}
