//! The end of the program by a signal (Ctrl-C, SIGTERM, SIGHUP): every motor is stopped at once, then the window closes.
//!
//! The motors do not wait for the window: the signal's own thread stops every link. A window that then does not
//! close, because it hangs or is not drawn, is ended.
//!
//! An X server that dies ends the program too, from within the X library once the window is drawn again; the motors do not wait for that either.

use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, PoisonError};
#[cfg(not(target_family = "wasm"))]
use std::time::Duration;

use brushwork_link::device::Stopper;
use egui::Context;

/// How long the window may take to close. Each link takes up to two seconds to stop its motors and end.
#[cfg(not(target_family = "wasm"))]
const PATIENCE: Duration = Duration::from_secs(15);

/// Whether the program was asked to end, and what has to be stopped then. Clones are the same.
#[derive(Clone, Default)]
pub struct EndBySignal(Arc<Inner>);

#[derive(Default)]
struct Inner {
    asked: AtomicBool,
    stoppers: Mutex<Vec<Stopper>>,
    window: Mutex<Option<Context>>,
}

impl EndBySignal {
    /// Takes over the signals for the rest of the program's life. Where the system refuses, they end the program as they
    /// always do, and the controllers' own time-outs stop the motors. A web page has no signals.
    #[cfg(not(target_family = "wasm"))]
    pub fn install() -> Self {
        let end = Self::default();
        let of_handler = end.clone();
        let handler = move || {
            of_handler.ask();
            std::thread::sleep(PATIENCE);
            // The window hangs. Its links were stopped by `ask`.
            std::process::exit(1);
        };
        // A second handler is refused: then somebody else sees to the signals.
        let _ = ctrlc::set_handler(handler);
        end
    }

    /// Stops every link as soon as the X server is gone that draws the window: a connection of its own, over which nothing is asked, ends then.
    #[cfg(all(unix, not(target_os = "macos")))]
    pub fn ask_without_x_server(&self) {
        use x11rb::connection::Connection as _;

        let end = self.clone();
        let watch = move || {
            let Ok((connection, _)) = x11rb::connect(None) else { return };
            while connection.wait_for_event().is_ok() {}
            end.ask();
        };
        // Without the thread the window tells it, in its next frame.
        let _ = std::thread::Builder::new().name("x server".to_owned()).spawn(watch);
    }

    /// Stops every link and wakes the window, which closes in its next frame.
    pub fn ask(&self) {
        self.0.asked.store(true, Ordering::SeqCst);
        self.stop_all();
        let window = self.0.window.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(ctx) = window.as_ref() {
            ctx.request_repaint();
        }
    }

    pub fn is_asked(&self) -> bool {
        self.0.asked.load(Ordering::SeqCst)
    }

    /// The links that are open now.
    pub fn watch(&self, stoppers: Vec<Stopper>) {
        *self.0.stoppers.lock().unwrap_or_else(PoisonError::into_inner) = stoppers;
        // A signal that came just before has not seen these.
        if self.is_asked() {
            self.stop_all();
        }
    }

    /// The window to wake.
    pub fn set_window(&self, ctx: Context) {
        *self.0.window.lock().unwrap_or_else(PoisonError::into_inner) = Some(ctx);
    }

    fn stop_all(&self) {
        let stoppers = self.0.stoppers.lock().unwrap_or_else(PoisonError::into_inner);
        stoppers.iter().for_each(Stopper::stop_all);
    }
}
