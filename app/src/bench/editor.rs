//! A key stroke in the MCL editor with a long program: from the key to the triangles of the frame that shows it, and to the frame that
//! knows what the compiler says about it.

use std::time::{Duration, Instant};

use egui::{Event, Key, Modifiers};

use super::Effort;
use super::figure::{Figure, Target};
use super::headless::Headless;
use super::spread::{median, percentile};
use brushwork_gui::App;
use brushwork_gui::mcl::caret::Caret;
use brushwork_gui::model::screen::Screen;
use brushwork_gui::opener::real_parts;

/// Lines of the program.
const LINES: usize = 20_000;
const REQUIRED_MS: f64 = 8.0;
const REQUIRED_DIAGNOSTICS_MS: f64 = 100.0;
/// Frames before the first that counts.
const WARM_UP: usize = 5;
/// A check that takes longer than this never comes.
const CHECK_LIMIT: Duration = Duration::from_secs(20);

/// Typing in the middle of a long program, while it is checked on its thread.
pub fn measure(effort: Effort) -> Result<Vec<Figure>, String> {
    let headless = Headless::new();
    let mut app = App::new(&headless.ctx, real_parts(&headless.ctx));
    app.model.screen = Screen::MclEditor;
    app.model.mcl.open_named("bench.mcl", &program());
    let middle = app.model.mcl.front().text.line_start(LINES / 2);
    app.model.mcl.front_mut().go_to(Caret::at(middle));
    let mut times_ms = Vec::new();
    for turn in 0..WARM_UP + effort.frames {
        let events = if turn % 10 == 9 { vec![enter()] } else { vec![letter()] };
        let took = headless.frame(events, |ui| app.contents(ui));
        if turn >= WARM_UP {
            times_ms.push(took.as_secs_f64() * 1e3);
        }
    }
    let checks: Result<Vec<f64>, String> =
        (0..effort.frames / 4).map(|_| time_to_diagnostics_ms(&headless, &mut app)).collect();
    // What was typed here is not to be offered to anybody.
    app.model.mcl.end();
    let note =
        format!("whole window, 1280x800, tessellation included; p99 {:.2} ms", percentile(&times_ms, 0.99));
    let name = format!("editor key stroke, {LINES} lines");
    let key = Figure::new("window", name, median(&times_ms), "ms", 2);
    let checks = checks?;
    let waits = format!(
        "real time from the key to the frame that shows them; p99 {:.0} ms",
        percentile(&checks, 0.99)
    );
    let diagnostics =
        Figure::new("window", format!("editor diagnostics, {LINES} lines"), median(&checks), "ms", 0);
    Ok(vec![
        key.target(Target::Below(REQUIRED_MS)).note(note),
        diagnostics.target(Target::Below(REQUIRED_DIAGNOSTICS_MS)).note(waits),
    ])
}

/// How long it takes from a key to the frame that knows what the compiler says about it.
fn time_to_diagnostics_ms(headless: &Headless, app: &mut App) -> Result<f64, String> {
    let began = Instant::now();
    headless.frame(vec![letter()], |ui| app.contents(ui));
    loop {
        let document = app.model.mcl.front();
        if document.findings.fresh(document.text.revision()).is_some() {
            return Ok(began.elapsed().as_secs_f64() * 1e3);
        }
        if began.elapsed() > CHECK_LIMIT {
            return Err("the editor's check did not come".to_owned());
        }
        std::thread::sleep(Duration::from_millis(1));
        headless.shapes(Vec::new(), |ui| app.contents(ui));
    }
}

fn letter() -> Event {
    Event::Text("x".to_owned())
}

fn enter() -> Event {
    let (key, modifiers) = (Key::Enter, Modifiers::NONE);
    Event::Key { key, physical_key: None, pressed: true, repeat: false, modifiers }
}

/// A program with names, blocks and comments.
pub fn program() -> String {
    let part = |number: usize| {
        format!(
            "part{number}\n    value{number} VAR Long ; counts of motor 1\n    value{number} = MOTORENCPOS(0)\n    \
             if value{number} > {number} then\n        puts 0, [\"part \", dec value{number}, 13, 10]\n    endif\n    \
             while value{number} > 100\n        value{number} = value{number} / 2\n    wend\n    pause 10\n"
        )
    };
    let text: String = (0..LINES / 10).map(part).collect();
    text + "end\n"
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_program_is_long_and_sound() {
        let text = program();
        assert_eq!(text.lines().count(), LINES + 1);
        let errors = brushwork_script::mcl::index::check(&text[..text.find("part9\n").unwrap()]);
        assert!(errors.iter().all(|problem| problem.code.starts_with('W')), "{errors:?}");
    }
}
