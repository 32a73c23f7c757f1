//! A MotorVator in the window, by role and label, against a simulated board in virtual time: what it shows, its motors, its stepper, its
//! terminal.

use crate::support::alone::{LIMIT, alone};
use crate::support::line::Line;
use crate::support::one::One;
use brushwork_family::Simulator as _;
use brushwork_gui::model::general::Section;
use brushwork_gui::motorvator::Motorvator;
use brushwork_gui::parts::SimulatedWorld;
use brushwork_link::Failure;
use brushwork_link::settings::SettingValue;
use brushwork_motorvator::MotorvatorSimulator;
use brushwork_motorvator::sim_spec::{MotorvatorSpec, library};
use brushwork_motorvator_client::{MotorvatorDriver, STEPPER_KEYS};
use brushwork_motorvator_sim::DrivenMotorvator;
use brushwork_plant::machine::Machine as _;
use brushwork_plant::server::Pace;
use brushwork_plant::world::{PinSignal, WorldAction, WorldView};
use brushwork_script::debug::{Request, View, Wanted};
use brushwork_script::language::Language;
use brushwork_script::program::Program;
use egui_kittest::kittest::Queryable as _;
use std::sync::{Arc, Mutex};

type Bench = One<DrivenMotorvator>;

/// A window on a board that runs the host library.
fn connected(folder: &tempfile::TempDir) -> Bench {
    let spec = MotorvatorSpec::parse("motorvator-3,seed=0").expect("it is a board");
    let board = spec.board(library()).expect("the preset is sound");
    let mut bench = Bench::new(folder, (&MotorvatorDriver, &Motorvator), board, "sim:motorvator-3");
    bench.app().open("sim:motorvator-3");
    bench.pass_ms(3000);
    assert!(bench.app().model.front.is_connected());
    bench
}

/// The world around a board, as the program itself reaches it.
struct BoardWorld {
    line: Line<DrivenMotorvator>,
    script: Mutex<Option<View>>,
}

impl SimulatedWorld for BoardWorld {
    fn apply(&self, unit: usize, action: WorldAction) -> Result<(), Failure> {
        self.line.with(|machine| machine.apply(unit, &action));
        Ok(())
    }

    fn views(&self) -> Option<Arc<Vec<WorldView>>> {
        Some(Arc::new(self.line.with(|machine| machine.views())))
    }

    fn unit_at(&self, address: u8) -> Option<usize> {
        usize::from(address).checked_sub(1)
    }

    fn debug(&self, unit: usize, requests: Vec<Request>, wanted: Wanted) -> Result<(), Failure> {
        let view = self.line.with(|machine| MotorvatorSimulator.debug(machine, unit, requests, &wanted));
        *self.script.lock().expect("no test panics with it") = view;
        Ok(())
    }

    fn script(&self) -> Option<View> {
        self.script.lock().expect("no test panics with it").take()
    }

    fn runs(&self, language: Language) -> bool {
        MotorvatorSimulator.runs(language)
    }

    fn run_program(&self, unit: usize, program: Arc<Program>) -> Result<(), Failure> {
        self.line.with(|machine| MotorvatorSimulator.run_program(machine, unit, program));
        Ok(())
    }

    fn pace(&self) -> Option<Pace> {
        None
    }

    fn set_pace(&self, _: Pace) {}
}

/// A window on such a board whose world it reaches.
fn with_world(folder: &tempfile::TempDir) -> Bench {
    let spec = MotorvatorSpec::parse("motorvator-3,seed=0").expect("it is a board");
    let board = spec.board(library()).expect("the preset is sound");
    let world =
        |line| Some(Arc::new(BoardWorld { line, script: Mutex::default() }) as Arc<dyn SimulatedWorld>);
    let family = (&MotorvatorDriver as _, &Motorvator as _);
    let mut bench = Bench::with_world(folder, family, board, "sim:motorvator-3", world);
    bench.app().open("sim:motorvator-3");
    bench.pass_ms(3000);
    bench
}

const COUNTING: &str = "Declare Word rounds
Begin Program
SetMotor 1, \"F\", 60
Loop
rounds = rounds + 1
Wait 64
End Loop
End Program
";

#[test]
fn a_program_runs_on_the_simulated_board_and_stands_where_it_is_looked_into() {
    alone(
        "motorvator::a_program_runs_on_the_simulated_board_and_stands_where_it_is_looked_into",
        LIMIT,
        || {
            let folder = tempfile::tempdir().expect("a temporary folder can be made");
            let mut bench = with_world(&folder);
            bench.press("Program");
            bench.app().model.mcl.open_named("counting.mecc", COUNTING);
            bench.press("Debugger");
            bench.press("Run Program");
            bench.pass_ms(1000);
            assert_eq!(told(&bench), [60, 0, 0, 0], "it drives motor A");
            assert!(bench.sees("counting.mecc runs on the simulated board."));
            assert!(bench.sees("A script runs, line"));

            // A breakpoint holds it, a name shows its value, a step runs one line, and the motor goes on meanwhile.
            bench.app().model.mcl.front_mut().breakpoints.toggle(4);
            bench.pass_ms(1500);
            assert!(bench.app().model.front.debug.is_paused());
            let view = bench.app().model.front.debug.view.clone().expect("it is looked at");
            assert_eq!(view.line, 5);
            let rounds = |bench: &mut Bench| {
                let text = bench.app().model.front.debug.value_of("rounds").expect("its text is in front");
                text.rsplit(' ').next().and_then(|number| number.parse::<u32>().ok()).expect("a number")
            };
            let before = rounds(&mut bench);
            assert!(before >= 1 && bench.sees("rounds"));
            bench.press("Step over");
            bench.pass_ms(200);
            assert_eq!(rounds(&mut bench), before + 1);
            assert_eq!(told(&bench), [60, 0, 0, 0]);
            assert!(!bench.sees("Registers"), "those are of MCL");
            assert!(bench.app().model.front.debug.set_answer.is_none());

            // The host library takes its place again, and the window drives the board.
            bench.press("Run Host Library");
            bench.pass_ms(3000);
            assert!(bench.sees("The host library runs on the simulated board again."));
            assert_eq!(told(&bench), [0; 4]);
            // Wrong programs run nowhere.
            bench.app().model.mcl.open_named("wrong.mecc", "Begin Program\nBeep nobody\nEnd Program\n");
            bench.press("Run Program");
            bench.pass_ms(500);
            assert_eq!(told(&bench), [0; 4]);
            assert!(bench.sees("wrong.mecc has"));
        },
    );
}

/// What motors A, B, C and D get, in percent.
fn told(bench: &Bench) -> [i32; 4] {
    bench.line.with(|machine| machine.board().motors())
}

fn type_in(bench: &mut Bench, label: &str, text: &str) {
    let field = bench.harness.get_by_label(label);
    field.focus();
    field.type_text(text);
    bench.harness.step();
    bench.harness.key_press(egui::Key::Enter);
    bench.pass_ms(500);
}

#[test]
fn the_display_the_motors_and_every_way_out_of_driving() {
    alone("motorvator::the_display_the_motors_and_every_way_out_of_driving", LIMIT, || {
        let folder = tempfile::tempdir().expect("a temporary folder can be made");
        let mut bench = connected(&folder);
        assert!(bench.sees("Display H2"), "the display of the library");
        assert!(bench.sees("HOST: OK"), "an indicator");
        bench.press("Motors");
        bench.app().model.front.pwm.set_duty(brushwork_values::Motor::M1, 40.0);
        bench.pass_ms(500);
        assert_eq!(told(&bench), [0; 4], "a disarmed slider moves nothing");
        for way in ["Stop All", "Arm", "Device Status"] {
            bench.press("Motors");
            bench.press("Arm");
            bench.pass_ms(300);
            bench.app().model.front.pwm.set_duty(brushwork_values::Motor::M1, 40.0);
            bench.app().model.front.pwm.set_duty(brushwork_values::Motor::M2, -25.4);
            bench.pass_ms(500);
            assert_eq!(told(&bench), [40, -25, 0, 0], "before {way}");
            bench.press(way);
            bench.pass_ms(500);
            assert_eq!(told(&bench), [0; 4], "{way}");
        }
    });
}

#[test]
fn the_search_finds_the_smallest_waits_that_lose_no_steps() {
    alone("motorvator::the_search_finds_the_smallest_waits_that_lose_no_steps", LIMIT, || {
        let folder = tempfile::tempdir().expect("a temporary folder can be made");
        let mut bench = connected(&folder);
        bench.press("Stepper");
        bench.press("Arm");
        bench.pass_ms(300);
        // A rotor without current does not hold what it was moved.
        bench.app().model.front.motorvator_mut().stepper.hold_percent = 50.0;
        bench.press("Find the smallest waits");
        let lost = |bench: &Bench| bench.line.with(|machine| machine.lost_steps()[0]);
        let mut before = lost(&bench);
        let mut trials = 0;
        while !bench.sees("Found, with a fifth more") {
            assert!(trials < 25, "it does not end");
            for _ in 0..100 {
                if bench.sees("The mark came back") {
                    break;
                }
                bench.pass_ms(500);
            }
            let now = lost(&bench);
            bench.press(if now == before { "The mark came back" } else { "The stepper lost steps" });
            (before, trials) = (now, trials + 1);
        }
        bench.pass_ms(500);
        let found = bench.app().model.front.motorvator().stepper.config();
        println!("{trials} trials: {}", found.statement(1));
        assert!(found.least <= found.most && found.most < 20, "{found:?}");
        // What was found loses nothing, and much less does.
        bench.press("Move forward");
        bench.pass_ms(8000);
        assert_eq!(lost(&bench), before);
        assert_eq!(bench.line.with(|machine| machine.board().steps()[0]), 200);
        assert!(bench.sees(&found.statement(1)), "the line for a program");
        // The settings have what was found once nothing is armed any more.
        bench.press("Arm");
        bench.pass_ms(6000);
        let unit = bench.app().model.front.settings.unit().expect("its settings are there");
        let settings = STEPPER_KEYS.map(|key| unit.confirmed(key));
        let expected =
            [found.least, found.most, found.hold_percent].map(|value| Some(SettingValue::Int(value.into())));
        assert_eq!(settings, expected);
    });
}

#[test]
fn settings_open_at_the_first_part_that_the_board_has() {
    alone("motorvator::settings_open_at_the_first_part_that_the_board_has", LIMIT, || {
        let folder = tempfile::tempdir().expect("a temporary folder can be made");
        let mut bench = connected(&folder);
        bench.press("Stepper Settings");
        bench.pass_ms(1500);
        assert!(!bench.sees("No setting of this controller fits."), "its settings stand under Stepper");
        let section = bench.app().model.front.general.section;
        let table = bench.app().model.front.settings.unit().map(|unit| unit.table().rows().to_vec());
        let first = table.and_then(|rows| rows.first().map(Section::of));
        assert_eq!(Some(section), first);
    });
}

#[test]
fn the_terminal_makes_triplets_and_tells_what_came_back() {
    alone("motorvator::the_terminal_makes_triplets_and_tells_what_came_back", LIMIT, || {
        let folder = tempfile::tempdir().expect("a temporary folder can be made");
        let mut bench = connected(&folder);
        bench.press("Terminal");
        type_in(&mut bench, "Line", "80 7");
        assert!(bench.sees("> I080007") && bench.sees("host library, version 2, answer 7"));
        type_in(&mut bench, "Line", "H");
        assert!(bench.sees("MotorVator AWOS 2.32"));
        type_in(&mut bench, "Line", "77 1 1 70 60");
        assert!(bench.sees("not armed"));
        // G starts what is in the memory, here the library anew, when its risk was accepted.
        type_in(&mut bench, "Line", "G");
        assert!(bench.sees("It may move motors at once"), "Enter starts nothing");
        bench.press("I have the switch of the motors' power at hand");
        bench.press("Start the program");
        bench.pass_ms(4000);
        assert!(!bench.sees("It may move motors at once"));
        type_in(&mut bench, "Line", "80 9");
        assert!(bench.sees("host library, version 2, answer 9"));
        assert_eq!(told(&bench), [0; 4]);
        assert_eq!(bench.line.with(|machine| machine.units()), 2);
    });
}

#[test]
fn inputs_are_switched_on_the_simulated_board_and_analog_ones_read_and_servos_turn_when_armed() {
    alone(
        "motorvator::inputs_are_switched_on_the_simulated_board_and_analog_ones_read_and_servos_turn_when_armed",
        LIMIT,
        || {
            let folder = tempfile::tempdir().expect("a temporary folder can be made");
            let mut bench = with_world(&folder);
            bench.press("Inputs");
            bench.pass_ms(3000);
            assert!(bench.sees("On/off input 3: off"));
            bench.press("Switch input 3 on");
            bench.pass_ms(3000);
            assert!(bench.sees("On/off input 3: on") && bench.sees("Switch input 3 off"));
            assert!(bench.sees("IN3: active") || bench.sees("changed"), "the library has heard of it");
            // 2.5 V of 5 is 127.5 of 255.
            let signal = PinSignal::Volts { volts: 2.5 };
            bench.line.with(|machine| machine.apply(0, &WorldAction::SetPin { pin: 8, signal }));
            bench.pass_ms(3000);
            assert!(bench.sees("Analog input 5: 128") && bench.sees("Analog input 1: 0"));

            bench.press("Motors");
            bench.app().model.front.motorvator_mut().servos.wanted = [30.0, -45.0];
            bench.pass_ms(300);
            let servos = |bench: &Bench| bench.line.with(|machine| machine.board().servos());
            bench.press("Turn servo 1");
            bench.pass_ms(500);
            assert_eq!(servos(&bench), [0, 0], "a disarmed button turns nothing");
            bench.press("Arm");
            bench.pass_ms(500);
            bench.press("Turn servo 1");
            bench.press("Turn servo 2");
            bench.pass_ms(1000);
            assert_eq!(servos(&bench), [30, -45]);
            assert!(bench.sees("Servo 2 was told -45°"));
        },
    );
}

#[test]
fn the_editor_speaks_of_the_language_that_is_open_and_run_and_stop_act_on_the_simulated_board() {
    alone(
        "motorvator::the_editor_speaks_of_the_language_that_is_open_and_run_and_stop_act_on_the_simulated_board",
        LIMIT,
        || {
            let folder = tempfile::tempdir().expect("a temporary folder can be made");
            let mut bench = with_world(&folder);
            bench.press("Program");
            bench.app().model.mcl.open_named("counting.mecc", COUNTING);
            bench.pass_ms(500);
            assert!(!bench.sees("Toolbar Download"), "nothing is downloaded to a board");
            bench.press("Toolbar Start Script");
            bench.pass_ms(1500);
            assert_eq!(told(&bench), [60, 0, 0, 0], "it drives motor A");
            bench.press("Toolbar Stop Script");
            bench.pass_ms(3000);
            assert_eq!(told(&bench), [0; 4], "the host library has its place");
            bench.press("File");
            bench.pass_ms(300);
            assert!(bench.sees("Save MeccCode Program As…") && !bench.sees("Save MCL Program As…"));
            bench.press("New MeccCode Program");
            bench.pass_ms(300);
            let title = bench.app().model.mcl.front().title();
            assert!(title.ends_with(".mecc"), "{title}");
        },
    );
}

#[test]
fn the_start_page_offers_a_board_that_runs_the_program_that_is_open() {
    alone("motorvator::the_start_page_offers_a_board_that_runs_the_program_that_is_open", LIMIT, || {
        let folder = tempfile::tempdir().expect("a temporary folder can be made");
        let path = folder.path().join("counting.mecc");
        std::fs::write(&path, COUNTING).expect("the folder is the test's");
        let spec = MotorvatorSpec::parse("motorvator-3,seed=0").expect("it is a board");
        let board = spec.board(library()).expect("the preset is sound");
        let target: &str = format!("sim:motorvator-3,program={}", path.display()).leak();
        let mut bench = Bench::new(&folder, (&MotorvatorDriver, &Motorvator), board, target);
        bench.pass_ms(300);
        assert!(bench.sees("A program of yours that is open here"), "what can be done is told");
        bench.app().model.mcl.open_path(path.clone());
        for _ in 0..50 {
            bench.pass_ms(100);
            std::thread::sleep(std::time::Duration::from_millis(20));
            if bench.sees("Run counting.mecc") {
                break;
            }
        }
        bench.press("Run counting.mecc");
        bench.pass_ms(3000);
        assert_eq!(bench.app().model.front.target.as_deref(), Some(target));
    });
}

/// A program of somebody's own, which sends two frames a second by a timer and counts them.
const SENDS_BY_ITSELF: &str = "Declare DataTable box\n\"TX\"\nEnd DataTable\nDeclare Byte count = 0\nDeclare Byte rest1\nDeclare Word rest2\nDeclare Word rest3\n\
    Declare DataPointer pointer\nDeclare EventHandler Again()\nIncrement count\npointer = SetPointer(box)\nTransmit pointer\nSetTimer 1, 64\nEnd EventHandler\n\
    Begin Program\nrest1 = 0\nrest2 = 0\nrest3 = 0\nSetEvent UserTimer1Event, Again\nEnable Events\nSetTimer 1, 1\nLoop\nEnd Loop\nEnd Program\n";

#[test]
fn frames_that_a_program_sends_by_itself_are_streamed_into_the_terminal() {
    alone("motorvator::frames_that_a_program_sends_by_itself_are_streamed_into_the_terminal", LIMIT, || {
        let folder = tempfile::tempdir().expect("a temporary folder can be made");
        let compiled = brushwork_script::mecc::compile(SENDS_BY_ITSELF);
        let program = compiled.program.unwrap_or_else(|| panic!("{:?}", compiled.diagnostics));
        let spec = MotorvatorSpec::parse("motorvator-3,seed=0").expect("it is a board");
        let board = spec.board(program).expect("the preset is sound");
        let mut bench = Bench::new(&folder, (&MotorvatorDriver, &Motorvator), board, "sim:motorvator-3");
        bench.app().open("sim:motorvator-3");
        bench.pass_ms(6000);
        let past: Vec<String> = bench.app().model.messages.past().map(|said| said.text.to_string()).collect();
        assert!(bench.app().model.front.is_connected(), "{past:?}");
        bench.press("Terminal");
        bench.pass_ms(6000);
        let counts = |bench: &mut Bench| -> Vec<u32> {
            let lines = &bench.app().model.front.motorvator().terminal.lines;
            let received = lines.entries.iter().filter_map(|entry| entry.answer.as_ref()?.as_ref().ok());
            received
                .filter(|(frame, _)| frame.starts_with("073084088"))
                .map(|(frame, _)| frame[9..12].parse().expect("a triplet"))
                .collect()
        };
        let seen = counts(&mut bench);
        assert!(seen.len() >= 8, "about two a second: {seen:?}");
        assert!(seen.windows(2).all(|pair| pair[0] < pair[1]), "each once, as they came: {seen:?}");
        assert!(bench.sees("< 073084088") && bench.sees("frame "));
        // Elsewhere nothing is listened to for it.
        bench.press("Device Status");
        // What is under way ends first.
        bench.pass_ms(3000);
        let before = counts(&mut bench).len();
        bench.pass_ms(3000);
        assert_eq!(counts(&mut bench).len(), before);
    });
}
