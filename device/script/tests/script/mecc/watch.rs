//! Names and expressions of a program for its debugger.

use super::Bare;
use brushwork_script::debug::{Show, code_id};
use brushwork_script::mecc::Names;
use brushwork_script::vm::Machine;

const TEXT: &str = "Declare Byte speed = 40
Declare Word far = 1000
Declare DataTable steps
3, 5, 8
End DataTable
Declare Function Half(of as Word) Returns Word
Declare Word kept
kept = of / 2
Return kept
End Function
Begin Program
far = far + 24
speed = Half(speed)
End Program
";

fn ended() -> (Names, Machine) {
    let names = Names::of(TEXT).expect("it compiles");
    let mut machine = Machine::new(names.program().clone());
    machine.run(&mut Bare::default(), 1000);
    (names, machine)
}

fn text_of(names: &Names, machine: &mut Machine, watched: &str) -> Result<String, String> {
    Ok(names.watch(watched)?.value(machine, &mut Bare::default())?.text(Show::Decimal))
}

#[test]
fn globals_locals_tables_and_expressions_are_worked_out_beside_the_program() {
    let (names, mut machine) = ended();
    let before = code_id(names.program());
    for (watched, value) in [
        ("far", "1024"),
        ("FAR + 1", "1025"),
        ("far * 64", "0"),
        ("speed < 21", "1"),
        ("Half.kept", "0"),
        ("steps(2)", "8"),
        ("GetClock() + 6", "13"),
    ] {
        assert_eq!(text_of(&names, &mut machine, watched).as_deref(), Ok(value), "{watched}");
    }
    assert!(
        text_of(&names, &mut machine, "steps").is_ok_and(|text| text.contains('3') && text.contains('8'))
    );
    assert_eq!(code_id(names.program()), before, "the program is what it was");
}

#[test]
fn what_is_no_expression_or_would_do_something_is_refused_with_a_sentence() {
    let (names, mut machine) = ended();
    for (watched, clause) in [
        ("", "nothing here yet"),
        ("nobody", "is not declared"),
        ("far +", "."),
        ("Half(3)", "would do something"),
        ("1\nBeep 1, 2", "more than an expression"),
        ("steps(3)", "the bytes 0 to 2"),
        ("1 / 0", "division by zero"),
    ] {
        let why = text_of(&names, &mut machine, watched).expect_err(watched);
        assert!(why.contains(clause), "{watched}: {why}");
    }
}

#[test]
fn a_variable_or_a_byte_of_a_table_is_set_if_the_value_fits() {
    let (names, mut machine) = ended();
    let mut set =
        |place: &str, value: &str| names.setting(place, value)?.set(&mut machine, &mut Bare::default());
    assert!(set("far", "far - 24").is_ok() && set("steps(1)", "7").is_ok());
    assert!(set("speed", "300").is_err_and(|why| why.contains("does not fit")));
    assert!(set("steps", "1").is_err_and(|why| why.contains("steps(0)")));
    assert!(set("Half", "1").is_err_and(|why| why.contains("nothing that can be set")));
    assert_eq!(text_of(&names, &mut machine, "far").as_deref(), Ok("1000"));
    assert_eq!(text_of(&names, &mut machine, "steps(1)").as_deref(), Ok("7"));
}
