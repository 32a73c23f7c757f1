//! The page itself: eframe's runner on the canvas, and the functions by which the page's script hands out the time.

use std::cell::RefCell;
use std::time::Duration;

use brushwork_core::keep::{Keeping, Store};
use brushwork_link::Channel;
use brushwork_link::clock::Instant;
use brushwork_link::files;
use eframe::{WebOptions, WebRunner};
use egui::{Context, Ui};
use wasm_bindgen::prelude::*;
use web_sys::HtmlCanvasElement;

use super::browser::{self, BrowserShelf};
use super::labels::{self, Labels};
use super::serial::ThisBrowser;
use super::{Links, PageOpener, Ports};
use crate::app::App;
use crate::messages::WindowStatusMessage;
use crate::parts::{Parts, SimulatedWorld};
use crate::remember::Memory;

/// The id of the canvas in the page.
const CANVAS: &str = "brushwork";
/// No more time passes at once, so that a page which was hidden goes on where it was.
const LONGEST: Duration = Duration::from_millis(100);
/// A job that goes so far beyond the page's time is told.
const TOLD_AHEAD: Duration = Duration::from_secs(1);

thread_local! {
    static LINKS: RefCell<Option<Links>> = const { RefCell::new(None) };
    static LAST: RefCell<Option<Instant>> = const { RefCell::new(None) };
    static RUNNER: RefCell<Option<WebRunner>> = const { RefCell::new(None) };
}

#[wasm_bindgen]
extern "C" {
    /// Lets the browser work until its next moment. The page's script puts it in place of one that does nothing where the browser can hold a
    /// call in its middle.
    fn brushwork_pause();
}

/// The time since it was last asked for, as far as it passes at once.
fn passed() -> Duration {
    let now = Instant::now();
    let last = LAST.with(|last| last.replace(Some(now)));
    last.map_or(Duration::ZERO, |last| now.saturating_duration_since(last)).min(LONGEST)
}

fn pause() -> Duration {
    brushwork_pause();
    passed()
}

/// Starts the window on the page's canvas.
pub fn run() {
    spawn(async {
        if let Err(error) = start().await {
            web_sys::console::error_1(&error);
        }
    });
}

fn spawn(work: impl Future<Output = ()> + 'static) {
    wasm_bindgen_futures::spawn_local(work);
}

async fn start() -> Result<(), JsValue> {
    let document = web_sys::window().and_then(|window| window.document()).ok_or(JsValue::UNDEFINED)?;
    let canvas = document.get_element_by_id(CANVAS).ok_or(JsValue::UNDEFINED)?;
    let canvas = canvas.dyn_into::<HtmlCanvasElement>()?;
    files::page().begin(Box::new(BrowserShelf), browser::kept());
    let can_pause = js_sys::Reflect::get(&js_sys::global(), &"brushworkPauses".into())?.is_truthy();
    let links = Links::with_pause(can_pause.then_some(pause));
    LINKS.with(|slot| slot.replace(Some(links.clone())));
    let runner = WebRunner::new();
    RUNNER.with(|slot| slot.replace(Some(runner.clone())));
    let options = WebOptions { dithering: false, ..WebOptions::default() };
    let create = move |creation: &eframe::CreationContext<'_>| {
        let ctx = &creation.egui_ctx;
        browser::set_window(ctx);
        ctx.add_plugin(Labels);
        let ports = Ports::new(Box::new(ThisBrowser::new()));
        let parts = Parts {
            ports: Box::new(ports.clone()),
            opener: Box::new(PageOpener { links: links.clone(), ports }),
            keeping: Keeping::new(Store::of_user()),
        };
        let (memory, trouble) = Memory::open();
        let mut app = App::new(ctx, parts);
        app.remember(memory);
        if let Some(failure) = trouble {
            app.model.messages.warn(failure.message());
        }
        if let Some(target) = browser::target() {
            app.open(&target);
        }
        let ctx = ctx.clone();
        Ok(Box::new(Page { app, links, ctx }) as Box<dyn eframe::App>)
    };
    runner.start(canvas, options, Box::new(create)).await
}

/// The window as eframe knows it.
struct Page {
    app: App,
    links: Links,
    ctx: Context,
}

impl eframe::App for Page {
    fn ui(&mut self, ui: &mut Ui, _frame: &mut eframe::Frame) {
        let ahead = self.links.take_ahead();
        if ahead >= TOLD_AHEAD {
            self.app.model.messages.note(WindowStatusMessage::WentAhead { seconds: ahead.as_secs() });
        }
        if self.links.take_hidden() {
            self.app.model.messages.warn(WindowStatusMessage::StoppedWhileHidden);
        }
        self.app.contents(ui);
    }

    fn as_any_mut(&mut self) -> Option<&mut dyn std::any::Any> {
        Some(self)
    }
}

/// Lets the time that has passed go by for every link. The page's script calls it over and over.
#[wasm_bindgen]
pub fn brushwork_turn() {
    let links = LINKS.with(|links| links.borrow().clone());
    if let Some(links) = links {
        links.turn(passed());
    }
}

/// The page is hidden, and its script has written the stop that was held. The page's script calls it.
#[wasm_bindgen]
pub fn brushwork_hidden() {
    let links = LINKS.with(|links| links.borrow().clone());
    if let Some(links) = links {
        links.hidden();
    }
}

/// The browser has other ports than before. The page's script calls it.
#[wasm_bindgen]
pub fn brushwork_ports_changed() {
    browser::wake_window();
}

/// What is connected and what the window has said, in JSON, for whoever tests the page from outside.
#[wasm_bindgen]
#[must_use]
pub fn brushwork_seen() -> String {
    let runner = RUNNER.with(|runner| runner.borrow().clone());
    let Some(page) = runner.as_ref().and_then(WebRunner::app_mut::<Page>) else { return String::new() };
    let front = &page.app.model.front;
    let worlds = page.app.world().and_then(SimulatedWorld::views);
    let axes: Vec<_> = worlds.iter().flat_map(|views| views.iter()).flat_map(|view| &view.axes).collect();
    let said: Vec<String> = page.app.model.messages.past().map(|message| message.text.to_string()).collect();
    serde_json::json!({
        "connected": front.is_connected(),
        "arming": format!("{:?}", front.link.arming),
        "battery_volts": front.link.readings.get(Channel::MAIN_BATTERY),
        "screen": page.app.model.screen.title(),
        "tuning": front.tune.is_running(),
        "outputs": axes.iter().map(|axis| format!("{:?}", axis.output)).collect::<Vec<_>>(),
        "counts": axes.iter().map(|axis| axis.encoder_counts).collect::<Vec<_>>(),
        "said": said,
    })
    .to_string()
}

/// Where things with a label stand in the page, in JSON, for whoever tests it from outside.
#[wasm_bindgen]
#[must_use]
pub fn brushwork_labels() -> String {
    let runner = RUNNER.with(|runner| runner.borrow().clone());
    runner
        .as_ref()
        .and_then(WebRunner::app_mut::<Page>)
        .map_or_else(String::new, |page| labels::found(&page.ctx))
}
