//! What programs do, with results worked out by hand.

use crate::support::{TestHost, machine, output, run, run_on, value};
use brushwork_script::vm::{Fault, FaultKind, State};

#[test]
fn operators_bind_in_the_manuals_order_not_in_that_of_c() {
    for (expression, expected) in [
        ("2+2*5/10", "3"),
        ("((2+2)*5)/10", "2"),
        // MAX and MIN before *, + and shifts: 10 max 3 is 3, times 2.
        ("2*10 max 3", "6"),
        ("1 + 2 min 5", "6"),
        // DIG before MAX: 17458 dig 4 is 7.
        ("9 max 17458 dig 4", "7"),
        // + before <<: 1 << 5.
        ("1 << 2 + 3", "32"),
        // Comparison before &: 6 & (4 = 4).
        ("6 & 4 = 4", "0"),
        ("7 & 4 = 4", "1"),
        // & | ^ share a level, left to right: (1 | 2) & 4.
        ("1 | 2 & 4", "0"),
        ("1 or 0 and 0", "0"),
        ("not 5", "0"),
        ("-2*-3", "6"),
        ("100-10-5", "85"),
        ("2**3", "0"),
        ("0xF0 &/ 0xFF", "-241"),
    ] {
        assert_eq!(value(expression), expected, "{expression}");
    }
}

#[test]
fn a_store_keeps_the_low_bits_and_parts_are_bits_of_the_whole() {
    let text = "\
l var long
b var byte
s var sbyte
n var nib
t var bit
w var sword
l = 0x123456F0
b = l
s = l
n = 0x1F
t = 3
w = 0x18000
puts 0,[dec b,\" \",sdec s,\" \",dec n,\" \",dec t,\" \",sdec w,\" \",hex l.highword,\" \",hex l.byte1,\" \",hex l.nib2]
l.byte3 = 0xAB
l.lowbit = 1
puts 0,[\" \",hex l]
end
";
    assert_eq!(output(text), "240 -16 15 1 -32768 1234 56 6 ab3456f1");
}

#[test]
fn arrays_aliases_and_tables() {
    let text = "\
temp var word(3)
high var temp(1).highbyte
i var byte
names ByteTable \"Hello\",33
big SWordTable -2,70000
for i = 0 to 2
temp(i) = 0x100 * (i + 1) + i
next
high = 7
puts 0,[hex temp(0),\" \",hex temp(1),\" \",hex temp(i-1),\" \",hex temp(1).byte0]
puts 0,[\" \",names(0),names(5),str names\\3,\" \",sdec big(0),\" \",sdec big(1)]
end
";
    assert_eq!(output(text), "100 701 302 1 H!Hel -2 4464");
}

#[test]
fn bits_and_nibbles_are_arrays_too() {
    let text = "\
flags var bit(10)
nibs var nib(3)
i var byte
flags(9) = 1
flags(3) = 1
nibs(0) = 1
nibs(1) = 2
nibs(2) = 3
for i = 0 to 9
puts 0,[dec flags(i)]
next
puts 0,[\" \",dec nibs(0),dec nibs(1),dec nibs(2)]
end
";
    assert_eq!(output(text), "0001000001 123");
}

#[test]
fn loops_count_as_the_manual_says() {
    let count = |head: &str, kind: &str| {
        output(&format!(
            "v var {kind}\nfor v = {head}\nputs 0,[sdec v,\" \"]\nnext\nputs 0,[\"| \",sdec v]\nend\n"
        ))
    };
    assert_eq!(count("0 to 3", "long"), "0 1 2 3 | 4");
    assert_eq!(count("3 to 0", "long"), "3 2 1 0 | -1");
    assert_eq!(count("0 to 20 step 5", "byte"), "0 5 10 15 20 | 25");
    assert_eq!(count("2 to -2 step -2", "slong"), "2 0 -2 | -4");
    assert_eq!(count("253 to 255", "byte"), "253 254 255 | 0");
    assert_eq!(count("5 to 5", "byte"), "5 | 6");
    // The step leads away from the finish: once through, then the count is no longer between the two.
    assert_eq!(count("0 to 3 step -1", "slong"), "0 | -1");
}

#[test]
fn loops_of_the_other_kinds() {
    let text = "\
i var slong
while i < 3
i = i + 1
puts 0,[dec i]
wend
do
i = i - 1
puts 0,[dec i]
while (i>1)
repeat
i = i + 5
puts 0,[\" \",dec i]
until i > 10
end
";
    assert_eq!(output(text), "12321 6 11");
}

#[test]
fn conditions_take_the_first_branch_that_holds() {
    let text = "\
v var byte
again
if v = 0 then
puts 0,[\"a\"]
elseif v = 1
puts 0,[\"b\"]
elseif v = 2 then
puts 0,[\"c\"]
else
puts 0,[\"d\"]
endif
v = v + 1
if v < 5 then again
if v = 5 then gosub five
if v = 5 then goto done
puts 0,[\"never\"]
five
puts 0,[\"5\"]
return
done
end
";
    assert_eq!(output(text), "abcdd5");
}

#[test]
fn subroutines_take_arguments_and_give_a_result_converted_where_types_differ() {
    let text = "\
r var long
f var float
main
gosub myadd[10,100],r
gosub half[7],f
gosub myadd[1,2]
puts 0,[dec r,\" \",real f]
end
a var long
b var long
x var float
myadd [a,b]
return a+b
half [x]
return x/2.0
";
    assert_eq!(output(text), "110 3.5");
}

#[test]
fn branch_counts_its_labels_from_zero_and_goes_on_past_the_last() {
    let text = "\
i var byte
for i = 0 to 3
gosub one
next
end
one
branch i,[a,b]
puts 0,[\"-\"]
return
a
puts 0,[\"a\"]
return
b
puts 0,[\"b\"]
return
";
    assert_eq!(output(text), "ab--");
}

#[test]
fn floats_are_32_bits_and_functions_take_radians() {
    let text = "\
f var float
n var slong
half con 1
f = 10.0
f = f * 123.123
n = TOINT f
puts 0,[sdec n,\" \",real FSIN (3.14159265/2.0)\\3,\" \",real FSQRT 2.0\\4,\" \",real FLN 2.0\\5]
f = TOFLOAT n / 100.0
puts 0,[\" \",real f,\" \",dec f > 12.0]
end
";
    assert_eq!(output(text), "1231 1.0 1.4142 0.69315 12.31 1");
}

#[test]
fn modifiers_write_into_arrays() {
    let text = "\
string var byte(20)
copy var byte(20)
string = \"Hello World\",0
puts 0,[str string\\20\\0,\"|\"]
string = dec 1234567
puts 0,[str string\\7,\"|\"]
copy = str string\\3,\"-\",ihex 0x3456,0
puts 0,[str copy\\20\\0,\"|\",REP \"A\" 3,rep 66\\2]
end
";
    assert_eq!(output(text), "Hello World|1234567|123-$3456|AAABB");
}

#[test]
fn input_waits_and_reads_numbers_out_of_text() {
    let text = "\
v var long
s var slong
t var byte(8)
gets 0,[v.byte1,v.byte0]
puts 0,[hex v]
gets 0,[dec v,sdec s,hex2 v.byte3,str t\\8\\13]
puts 0,[\" \",hex v,\" \",sdec s,\" \",str t\\8\\0]
end
";
    let mut machine = machine(text);
    let mut host = TestHost::default();
    host.waiting.insert(0, [0x12, 0x34].into());
    assert_eq!(run_on(&mut machine, &mut host, 10_000), State::Listening { stream: 0 });
    assert_eq!(host.sent[&0], b"1234");
    for byte in b"x 77 -5,a1abc\r" {
        host.waiting.entry(0).or_default().push_back(*byte);
        run_on(&mut machine, &mut host, 10_000);
    }
    assert_eq!(machine.state(), &State::Ended);
    assert_eq!(host.sent[&0], b"1234 a100004d -5 abc");
}

#[test]
fn faults_name_their_line() {
    let fault = |text: &str| match run(text).1 {
        State::Faulted(fault) => fault,
        state => panic!("{state:?}"),
    };
    let index = fault("a var byte(3)\ni var sbyte\ni = 3\na(i) = 1\nend\n");
    assert_eq!(index, Fault { line: 4, kind: FaultKind::IndexOutside { index: 3, length: 3 } });
    assert_eq!(fault("d var byte\nputs 0,[dec 1/d]\nend\n").kind, FaultKind::DivisionByZero);
    assert_eq!(fault("main\nreturn\n").kind, FaultKind::NoCall);
    assert_eq!(fault("main\ngosub main\nend\n"), Fault { line: 2, kind: FaultKind::CallsTooDeep });
    assert_eq!(fault("x var byte\nsub [x]\nend\n").kind, FaultKind::StackEmpty);
}

#[test]
fn directives_choose_what_is_compiled() {
    let text = "\
kind con 2
#IF kind=1
this is no program (
#ELSEIF kind=2
#IFDEF kind
puts 0,[\"two\"]
#ENDIF
#IFNDEF nothing
puts 0,[\" none\"]
#ENDIF
#ELSE
puts 0,[\"else\"]
#ENDIF
#IFDEF nothing
#IF 1
goto nowhere
#ENDIF
#ELSEIFDEF SYSTICK
puts 0,[\" tick\"]
#ELSE
#ENDIF
end
";
    assert_eq!(output(text), "two none tick");
}

#[test]
fn what_is_left_out_may_be_anything() {
    let text = "\
#IF 0
it's \"half a text, $ @ \u{2192} 12ab (
do
#ELSE
puts 0,[\"kept\"]
#ENDIF
x var byte
while x < 3
x = x + 1
wend
puts 0,[dec x]
end
";
    assert_eq!(output(text), "kept3");
    let kept = brushwork_script::mcl::compile("#IF 1\nputs 0,[\"half]\n#ENDIF\nend\n");
    assert!(kept.diagnostics.iter().any(|reported| reported.code == "E104"), "{:?}", kept.diagnostics);
}

#[test]
fn registers_and_memory_outside_the_program() {
    let text = "\
i var byte
SYSMINMBAT = 120
i = 1
MOTORVELKI(i) = TOINT(0.5*65536.0)
puts 0,[dec SYSMINMBAT,\" \",dec MOTORVELKI(1),\" \",dec MOTORVELKI(0)]
write 3,\"e\"
read 3,i
puts 0,[\" \",i]
clear
puts 0,[\" \",dec i]
end
";
    assert_eq!(output(text), "120 32768 0 e 0");
}

/// A stream that never ends and never has a digit.
#[test]
fn a_stream_without_a_number_does_not_hold_the_machine_in_one_step() {
    let mut machine = machine("n var long\nf var float\ngets 0,[dec n,real f]\nend\n");
    let mut host = TestHost::default();
    host.waiting.insert(0, vec![b'x'; 100_000].into());
    machine.run(&mut host, 10);
    let left = host.waiting[&0].len();
    assert!(left > 95_000 && left < 100_000, "{left}");
    assert_eq!(machine.state(), &State::Ready);
    host.waiting.get_mut(&0).unwrap().extend(b"42 -1.5 ");
    assert_eq!(run_on(&mut machine, &mut host, 100_000), State::Ended);
    assert_eq!(machine.memory().load(machine.program().variables[0].memory.first), 42);
}
