//! Small programs whose frames were worked out by hand.

use crate::What;
use crate::tests::bench::{Bench, assert_times};

/// Declared in front of each program: the frame is `=`, a, b, c, the two bytes of w, d and e.
const HEAD: &str = "\
Declare DataTable out
\"=\"
End DataTable
Declare Byte a
Declare Byte b
Declare Byte c
Declare Word w
Declare Byte d
Declare Byte e
Declare DataPointer p
Declare Byte n
";

/// Name, declarations, program, and the bytes a, b, c, w, d, e of the frame that it sends at its end.
type Row = (&'static str, &'static str, &'static str, [u8; 7]);

const PROGRAMS: [Row; 44] = [
    (
        "what is set is sent, the low byte of a Word first",
        "",
        "a = 1\nb = 2\nc = 3\nw = 258\nd = 4\ne = 5",
        [1, 2, 3, 2, 1, 4, 5],
    ),
    ("bytes go round", "", "a = 255\nIncrement a\nb = 0 - 1\nw = 0 - 1", [0, 255, 0, 255, 255, 0, 0]),
    ("words go round", "", "w = 65535\nIncrement w\na = 7 * 3", [21, 0, 0, 0, 0, 0, 0]),
    (
        "multiplying comes first",
        "",
        "a = 2 + 3 * 4\nb = (2 + 3) * 4\nc = 20 - 3 - 2\nd = 100 / 7\ne = 100 Mod 7",
        [14, 20, 15, 0, 0, 14, 2],
    ),
    // 300 * 300 is 90000, 24464 beyond 65536: 5F90H.
    ("a product loses what a Word does not hold", "", "w = 300 * 300", [0, 0, 0, 144, 95, 0, 0]),
    ("each step is a Word", "", "w = 40000 + 40000 / 2\na = 60000 + 10000 > 5000", [0, 0, 0, 96, 234, 0, 0]),
    (
        "six comparisons",
        "",
        "a = 3 > 2\nb = 3 < 2\nc = 3 = 3\nw = 3 <> 3\nd = 3 <= 3\ne = 2 >= 3",
        [1, 0, 1, 0, 0, 1, 0],
    ),
    ("comparisons have no sign", "", "w = 0 - 1\na = w > 1\nb = 0 - 1 < 1", [1, 0, 0, 255, 255, 0, 0]),
    (
        "and, or, not",
        "",
        "a = 1 And 0\nb = 1 Or 0\nc = Not 5\nd = Not 0\ne = 1 > 0 and 2 > 1",
        [0, 1, 0, 0, 0, 1, 1],
    ),
    ("not stands before a comparison", "", "a = Not 1 > 2\nb = Not 2 > 1 Or 1", [1, 1, 0, 0, 0, 0, 0]),
    (
        "hexadecimal numbers and characters",
        "",
        "a = 30H\nb = 0xFF\nc = \"A\"\nw = 0ABCDH",
        [48, 255, 65, 205, 171, 0, 0],
    ),
    ("minus before a value", "", "w = -1\na = -1 + 2\nb = 10 - -2", [1, 12, 0, 255, 255, 0, 0]),
    ("a do runs to its condition", "", "Do\nIncrement a\nUntil a = 5", [5, 0, 0, 0, 0, 0, 0]),
    ("a do runs once at least", "", "Do\nIncrement a\nUntil 1", [1, 0, 0, 0, 0, 0, 0]),
    ("a while", "", "a = 10\nWhile a > 2\na = a - 3\nIncrement b\nEnd While", [1, 3, 0, 0, 0, 0, 0]),
    ("a while that never holds", "", "While a > 2\nIncrement b\nEnd While", [0, 0, 0, 0, 0, 0, 0]),
    (
        "loops in loops",
        "",
        "Do\nc = 0\nDo\nIncrement a\nIncrement c\nUntil c = 4\nIncrement b\nUntil b = 3",
        [12, 3, 4, 0, 0, 0, 0],
    ),
    (
        "if and else",
        "",
        "a = 5\nIf a = 5 Then\nb = 1\nElse\nb = 2\nEnd If\nIf a <> 5 Then\nc = 1\nElse\nc = 2\nEnd If",
        [5, 1, 2, 0, 0, 0, 0],
    ),
    (
        "if in if",
        "",
        "If 1 Then\nIf 0 Then\na = 1\nElse\na = 2\nEnd If\nb = 3\nEnd If",
        [2, 3, 0, 0, 0, 0, 0],
    ),
    ("if in a line", "", "If 1 Then a = 9\nIf 0 Then b = 1 Else b = 2", [9, 2, 0, 0, 0, 0, 0]),
    (
        "select takes the case of its value",
        "",
        "a = 2\nSelect a\nCase 1\nb = 10\nCase 2\nb = 20\nCase 3\nb = 30\nEnd Select",
        [2, 20, 0, 0, 0, 0, 0],
    ),
    (
        "select as the maker's page has it",
        "",
        "a = 92\nSelect\ncase a\n\nCase 91            b = 1\n\nCase 92            b = 2\nend Select",
        [92, 2, 0, 0, 0, 0, 0],
    ),
    ("select case in one line", "", "Select Case 7\nCase 7\na = 1\nEnd Select", [1, 0, 0, 0, 0, 0, 0]),
    (
        "cases with several values, and the others",
        "",
        "a = 5\nSelect a\nCase 1, 5, 9\nb = 1\nCase Else\nb = 2\nEnd Select\nSelect a\nCase 1\nc = 1\nCase Else\nc = 2\nEnd Select",
        [5, 1, 2, 0, 0, 0, 0],
    ),
    (
        "a case may be a variable",
        "",
        "a = 5\nb = 5\nSelect a\nCase b\nc = 1\nEnd Select\nSelect a\nCase 6\nc = 2\nEnd Select",
        [5, 5, 1, 0, 0, 0, 0],
    ),
    (
        "a function gives a value",
        "Declare Function f(x As Word) Returns Word\nReturn x * 2\nEnd Function\n",
        "a = f(21)\nw = f(1000)",
        [42, 0, 0, 208, 7, 0, 0],
    ),
    (
        "a function gives what its name was set to",
        "Declare Function f(x As Word, y As Byte) Returns Word\nf = x - y\nIf f > 100 Then f = 100\nEnd Function\n",
        "a = f(21, 1)\nb = f(1000, 7)",
        [20, 100, 0, 0, 0, 0, 0],
    ),
    (
        "a function may call itself",
        "Declare Function fact(x As Word) Returns Word\nIf x < 2 Then Return 1\nReturn x * fact(x - 1)\nEnd Function\n",
        "a = fact(5)\nw = fact(8)",
        [120, 0, 0, 128, 157, 0, 0],
    ),
    (
        "twice in one expression too",
        "Declare Function fib(x As Byte) Returns Word\nDeclare Word r\nIf x < 2 Then Return x\nr = fib(x - 1)\nReturn r + fib(x - 2)\nEnd Function\n",
        "a = fib(10)",
        [55, 0, 0, 0, 0, 0, 0],
    ),
    (
        "what a function declares begins anew",
        "Declare Function f() Returns Byte\nDeclare Byte x\nDeclare Byte y = 4\nIncrement x\nIncrement y\nReturn x + y\nEnd Function\n",
        "a = f()\nb = f()",
        [6, 6, 0, 0, 0, 0, 0],
    ),
    (
        "a parameter of a byte holds a byte",
        "Declare Function f(x As Byte) Returns Word\nReturn x\nEnd Function\n",
        "w = 258\na = f(w)",
        [2, 0, 0, 2, 1, 0, 0],
    ),
    (
        "a function without a value is called",
        "Declare Function f(x As Byte)\nb = b + x\nEnd Function\n",
        "Call f(3)\nCall f(4)",
        [0, 7, 0, 0, 0, 0, 0],
    ),
    (
        "a function without parameters needs no parentheses",
        "Declare Function f()\nIncrement a\nReturn\na = 99\nEnd Function\n",
        "Call f\nCall f()",
        [2, 0, 0, 0, 0, 0, 0],
    ),
    (
        "a name of its own hides a global",
        "Declare Function f()\nDeclare Byte a\na = 77\nEnd Function\n",
        "a = 1\nCall f()",
        [1, 0, 0, 0, 0, 0, 0],
    ),
    (
        "first values",
        "Declare Byte x = 17\nDeclare Word y = 2 * 256 + 3\nDeclare Byte z = \"F\"\n",
        "a = x\nw = y\nd = z",
        [17, 0, 0, 3, 2, 70, 0],
    ),
    ("names in any case", "", "A = 3\nB = a + A\nINCREMENT b", [3, 7, 0, 0, 0, 0, 0]),
    (
        "what the program declares is known to functions",
        "Declare Function f() Returns Byte\nReturn own + 1\nEnd Function\n",
        "Declare Byte own = 4\na = f()",
        [5, 0, 0, 0, 0, 0, 0],
    ),
    (
        "data is read across tables and variables",
        "Declare DataTable t\n\"AB\", 7\nEnd DataTable\nDeclare Byte x = 9\nDeclare DataPointer q\n",
        "q = SetPointer(t)\na = ReadData(q)\nb = ReadData(q)\nc = ReadData(q)\nd = ReadData(q)",
        [65, 66, 7, 0, 0, 9, 0],
    ),
    (
        "of two events the lower number comes first",
        "Declare EventHandler h1()\nn = n * 10 + 1\nEnd EventHandler\nDeclare EventHandler h2()\nn = n * 10 + 2\nEnd EventHandler\n",
        "SetEvent UserTimer2Event, h2\nSetEvent UserTimer1Event, h1\nSetTimer 2, 1\nSetTimer 1, 1\nWait 2\nEnable Events\na = n",
        [12, 0, 0, 0, 0, 0, 0],
    ),
    (
        "an event in a wait comes when that is over",
        "Declare EventHandler h1()\nn = 7\nEnd EventHandler\n",
        "SetEvent UserTimer1Event, h1\nEnable Events\nSetTimer 1, 2\nb = n\nWait 10\na = n",
        [7, 0, 0, 0, 0, 0, 0],
    ),
    (
        "events are kept while they are disabled",
        "Declare EventHandler h1()\nn = n + 7\nEnd EventHandler\n",
        "SetEvent UserTimer1Event, h1\nEnable Events\nDisable Events\nSetTimer 1, 1\nWait 5\na = n\nSetTimer 1, 1\nWait 5\nEnable Events\nb = n",
        [0, 7, 0, 0, 0, 0, 0],
    ),
    (
        "handlers wait for one another",
        "Declare EventHandler h1()\nn = n * 10 + 1\nSetTimer 2, 1\nWait 5\nn = n * 10 + 3\nEnd EventHandler\nDeclare EventHandler h2()\nn = n * 10 + 2\nEnd EventHandler\n",
        "SetEvent UserTimer1Event, h1\nSetEvent UserTimer2Event, h2\nEnable Events\nSetTimer 1, 1\nDo\nUntil n > 100\na = n",
        [132, 0, 0, 0, 0, 0, 0],
    ),
    (
        "the clock counts 1024 in a second",
        "Declare Word from\n",
        "from = GetClock()\nWait 128\nw = GetClock() - from\na = GetProgramNumber",
        [99, 0, 0, 0, 4, 0, 0],
    ),
    (
        "the clock goes on from 65535 at 0",
        "Declare Word from\n",
        "Wait 8191\nfrom = GetClock()\nWait 2\nw = GetClock() - from\na = GetClock()\nb = ReadAnalogue(1) + 5",
        [8, 5, 0, 16, 0, 0, 0],
    ),
];

#[test]
fn small_programs_send_the_frames_that_were_worked_out_by_hand() {
    for (name, declarations, body, bytes) in PROGRAMS {
        let text = format!(
            "{HEAD}{declarations}Begin Program\n{body}\np = SetPointer(out)\nTransmit p\nEnd Program\n"
        );
        let mut bench = Bench::new(&text);
        bench.run(65.0);
        let expected: String = [61].iter().chain(&bytes).map(|byte: &u8| format!("{byte:03}")).collect();
        assert_eq!(bench.sent(), [format!("073{expected}")], "{name}\n{text}\n{}", bench.words);
    }
}

#[test]
fn transmit_moves_its_pointer_on() {
    let text = "Declare DataTable t\n\"ABCDEFGHIJ\"\nEnd DataTable\nDeclare DataPointer p\nBegin Program\np = SetPointer(t)\nTransmit p\nWait 8\nTransmit p\nEnd Program\n";
    let mut bench = Bench::new(text);
    // I and J, the pointer, which stands at 8, and zeros.
    assert_eq!(bench.run(1.0).sent(), ["073065066067068069070071072", "073073074008000000000000000"]);
}

#[test]
fn receive_stores_across_what_follows_a_short_table() {
    let text = "Declare DataTable t\nReserve 2\nEnd DataTable\nDeclare Byte x\nDeclare Word y\nDeclare DataPointer p\nDeclare EventHandler h()\np = SetPointer(t)\nReceive p\nDisplayHex x\nEnd EventHandler\nBegin Program\nSetEvent ReceiveEvent, h\nEnable Events\nLoop\nEnd Loop\nEnd Program\n";
    let mut bench = Bench::new(text);
    bench.run(0.5).send("I001002171").run(1.0);
    assert_eq!(bench.board.display(), *b"AB");
}

#[test]
fn steppers_make_their_steps_and_raise_their_events() {
    let text = "Declare EventHandler done()\nDisplayChars \"D\", \"1\"\nEnd EventHandler\nBegin Program\nSetEvent Stepper1Event, done\nEnable Events\nConfigStepper 1, 8, 10, 50\nConfigStepper 2, 4, 4, 0\nSetStepper 1, \"F\", 6\nSetStepper 2, \"B\", 100\nLoop\nEnd Loop\nEnd Program\n";
    let mut bench = Bench::new(text);
    bench.run(1.0);
    // Waits of 10, 9, 8, 8, 9 and 10 parts of 1/1024 s; 100 of 4.
    let done = bench.times(|what| matches!(what, What::Stepper { state: "done", .. }));
    assert_times(&done, &[54.0 / 1024.0, 400.0 / 1024.0]);
    assert_times(&[bench.shown()[0].0], &[54.0 / 1024.0]);
    assert_eq!(bench.board.steps(), [6, -100]);
}

#[test]
fn a_division_by_zero_ends_the_program() {
    let mut bench = Bench::new("Declare Byte a\nBegin Program\na = 5 / a\nDisplayHex a\nEnd Program\n");
    bench.run(1.0);
    assert_eq!(bench.board.fault().map(ToString::to_string), Some("line 3: a division by zero".to_owned()));
}

#[test]
fn endless_calls_end_the_program() {
    let mut bench = Bench::new(
        "Declare Function f(x as Word)\nCall f(x)\nEnd Function\nBegin Program\nCall f(1)\nEnd Program\n",
    );
    bench.run(1.0);
    assert!(bench.board.fault().is_some());
}

#[test]
fn what_the_board_does_not_have_is_passed_by() {
    let text = "Declare Byte m = 5\nBegin Program\nSetMotor m, \"F\", 50\nm = 1\nSetMotor m, m, 50\nSetMotor m, \"B\", 200\nStopMotor 4\nEnd Program\n";
    let mut bench = Bench::new(text);
    bench.run(1.0);
    assert_eq!(bench.board.motors(), [-100, 0, 0, 0]);
}
