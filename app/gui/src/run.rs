//! Opens the real window, or says in one sentence why it cannot.
//!
//! What a desktop lacks (a display, a library) shows up as an error of the window system or, in places, as a panic
//! inside it. Both become a [`WindowError`] that names the command line, which works without a window.

use std::any::Any;
use std::panic::{self, AssertUnwindSafe};
use std::sync::{Arc, Mutex, PoisonError};

use egui::{Ui, Vec2, ViewportBuilder, vec2};

use super::App;
use super::ending::EndBySignal;
use super::opener::real_parts;
use super::remember::{Memory, Remembered};

/// A commutator between its two brushes.
const ICON: &[u8] = include_bytes!("../../../assets/icon/brushwork.png");

/// Why there is no window. The text is one sentence with what to do.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error(
    "Brushwork cannot open its window ({reason}); the command line works without one: see `brushwork --help`."
)]
pub struct WindowError {
    reason: String,
}

/// How the window opens.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct WindowOptions {
    /// What to connect to at once, as a person would type it.
    pub open: Option<String>,
    /// Draw without smoothing.
    pub plain: bool,
}

/// Opens the window and returns when it is closed.
///
/// # Errors
/// There is no display, or a library that the window needs is missing.
pub fn run(window: WindowOptions) -> Result<(), WindowError> {
    if let Some(reason) = no_display() {
        return Err(WindowError { reason });
    }
    let opened = Arc::new(Mutex::new(false));
    let (memory, trouble) = Memory::open();
    let options = native_options(&memory.current);
    let result = quietly_until(&opened, || {
        let opened = opened.clone();
        eframe::run_native(
            "Brushwork",
            options,
            Box::new(move |creation| {
                *opened.lock().unwrap_or_else(PoisonError::into_inner) = true;
                let mut app = App::new(&creation.egui_ctx, real_parts(&creation.egui_ctx));
                app.remember(memory);
                app.end_by(end_of_program(), &creation.egui_ctx);
                app.model.appearance.plain |= window.plain;
                if let Some(failure) = trouble {
                    app.model.messages.warn(failure.message());
                }
                if let Some(target) = &window.open {
                    app.open(target);
                }
                Ok(Box::new(Window(app)))
            }),
        )
    });
    match result {
        Ok(Ok(())) => Ok(()),
        Ok(Err(error)) => Err(WindowError { reason: one_line(&error.to_string()) }),
        Err(panicked) => Err(WindowError { reason: one_line(&text_of(panicked.as_ref())) }),
    }
}

/// The window as eframe knows it.
struct Window(App);

impl eframe::App for Window {
    fn ui(&mut self, ui: &mut Ui, _frame: &mut eframe::Frame) {
        self.0.contents(ui);
    }
}

/// On a display of 1024 by 700 pixels at 150 % and of 1920 by 1080 at 200 % the window still fits; what it shows is then as small as it has to be.
const LEAST_WINDOW: Vec2 = vec2(640.0, 420.0);

fn native_options(remembered: &Remembered) -> eframe::NativeOptions {
    let window = remembered.window;
    let size = window.map_or(vec2(1280.0, 800.0), |window| window.size.into());
    let viewport = ViewportBuilder::default()
        .with_title("Brushwork")
        .with_app_id("brushwork")
        .with_inner_size(size.max(LEAST_WINDOW))
        .with_min_inner_size(LEAST_WINDOW)
        .with_maximized(window.is_some_and(|window| window.maximized));
    let viewport = match window.and_then(|window| window.at) {
        Some(at) => viewport.with_position(at),
        None => viewport,
    };
    // Without a picture of our own the window has the toolkit's.
    let viewport = match eframe::icon_data::from_png_bytes(ICON) {
        Ok(icon) => viewport.with_icon(icon),
        Err(_) => viewport,
    };
    eframe::NativeOptions { viewport, dithering: false, ..Default::default() }
}

/// What ends the program from outside: signals and, where it draws the window, the death of the X server.
fn end_of_program() -> EndBySignal {
    let end = EndBySignal::install();
    #[cfg(all(unix, not(target_os = "macos")))]
    if !is_set("WAYLAND_DISPLAY") && !is_set("WAYLAND_SOCKET") {
        end.ask_without_x_server();
    }
    end
}

fn is_set(name: &str) -> bool {
    std::env::var_os(name).is_some_and(|value| !value.is_empty())
}

/// On Unix without a display there is no need to ask the window system.
fn no_display() -> Option<String> {
    let needs_one = cfg!(all(unix, not(target_os = "macos")));
    let has_one = is_set("DISPLAY") || is_set("WAYLAND_DISPLAY") || is_set("WAYLAND_SOCKET");
    (needs_one && !has_one)
        .then(|| "there is no display: neither DISPLAY nor WAYLAND_DISPLAY is set".to_owned())
}

/// Runs `open`, keeping panics to itself as long as the window has not opened: a missing library is a panic inside
/// the window system. Once it has, a panic is a bug and is reported as one.
fn quietly_until<T>(opened: &Arc<Mutex<bool>>, open: impl FnOnce() -> T) -> Result<T, Box<dyn Any + Send>> {
    let report = Arc::new(panic::take_hook());
    let (is_open, report_later) = (opened.clone(), report.clone());
    panic::set_hook(Box::new(move |panicked| {
        if *is_open.lock().unwrap_or_else(PoisonError::into_inner) {
            report_later(panicked);
        }
    }));
    let result = panic::catch_unwind(AssertUnwindSafe(open));
    let was_open = *opened.lock().unwrap_or_else(PoisonError::into_inner);
    match result {
        Err(panicked) if was_open => panic::resume_unwind(panicked),
        other => other,
    }
}

fn text_of(panicked: &(dyn Any + Send)) -> String {
    let text = panicked.downcast_ref::<String>().map(String::as_str);
    text.or_else(|| panicked.downcast_ref::<&str>().copied()).unwrap_or("a library is missing").to_owned()
}

/// A reason in one line, without the window system's source paths and without the full stop of a sentence of its own.
/// A library that is missing is named with the packages that bring it.
fn one_line(text: &str) -> String {
    let line = text.split_whitespace().collect::<Vec<_>>().join(" ");
    let reason = line.rsplit(": ").next().unwrap_or(&line).trim_end_matches('.');
    if reason.to_lowercase().contains("librar") { format!("{reason}: {PACKAGES}") } else { reason.to_owned() }
}

/// What a window needs on a bare Debian; other systems have packages of similar names.
const PACKAGES: &str =
    "on Debian or Ubuntu install libx11-6 libx11-xcb1 libxcursor1 libxi6 libxkbcommon-x11-0 libgl1";

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_icon_can_be_read() {
        assert!(eframe::icon_data::from_png_bytes(ICON).is_ok());
    }

    #[test]
    fn a_panic_before_the_window_opens_becomes_a_reason() {
        let opened = Arc::new(Mutex::new(false));
        let result =
            quietly_until(&opened, || -> () { panic!("libxkbcommon-x11.so could not be loaded.\n") });
        let _ = panic::take_hook();
        let reason = one_line(&text_of(result.unwrap_err().as_ref()));
        assert_eq!(reason, "libxkbcommon-x11.so could not be loaded");
        let reason = one_line("os error at /a/b.rs:788: Failed to load one of xlib's shared libraries");
        assert!(reason.starts_with("Failed to load one") && reason.contains("libxcursor1"), "{reason}");
        let reported = WindowError { reason }.to_string();
        assert!(reported.contains("brushwork --help") && reported.lines().count() == 1, "{reported}");
    }
}
