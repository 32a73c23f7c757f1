//! The serial ports of the browser, as its page's script `serial.js` has them.

use std::sync::Arc;
use std::time::Duration;

use brushwork_core::session::browser::{BrowserPort, PortState};
use brushwork_link::{Clock as _, SystemClock};
use js_sys::{Array, Uint8Array};
use wasm_bindgen::prelude::*;

use super::ports::{Browser, Granted};

/// Numbers of a port in the script's list: its own, USB vendor and product.
const NUMBERS: usize = 3;

#[wasm_bindgen]
extern "C" {
    /// Lets the browser work for so long, or until something has come from a port. As [`super::runner`]'s pause.
    fn brushwork_wait(milliseconds: f64);

    #[wasm_bindgen(js_namespace = brushworkSerial, js_name = reaches)]
    fn reaches() -> bool;
    #[wasm_bindgen(js_namespace = brushworkSerial, js_name = granted)]
    fn granted() -> Option<Vec<u32>>;
    #[wasm_bindgen(js_namespace = brushworkSerial, js_name = choose)]
    fn choose();
    #[wasm_bindgen(js_namespace = brushworkSerial, js_name = takeRefusal)]
    fn take_refusal() -> Option<String>;
    #[wasm_bindgen(js_namespace = brushworkSerial, js_name = open)]
    fn open(port: u32, baud: u32);
    #[wasm_bindgen(js_namespace = brushworkSerial, js_name = isOpen)]
    fn is_open(port: u32) -> bool;
    #[wasm_bindgen(js_namespace = brushworkSerial, js_name = gone)]
    fn gone(port: u32) -> Option<String>;
    #[wasm_bindgen(js_namespace = brushworkSerial, js_name = take)]
    fn take(port: u32) -> Vec<u8>;
    #[wasm_bindgen(js_namespace = brushworkSerial, js_name = write)]
    fn write(port: u32, bytes: Uint8Array);
    #[wasm_bindgen(js_namespace = brushworkSerial, js_name = unwritten)]
    fn unwritten(port: u32) -> u32;
    #[wasm_bindgen(js_namespace = brushworkSerial, js_name = hold)]
    fn hold(port: u32, writes: Array, gap_ms: f64);
    #[wasm_bindgen(js_namespace = brushworkSerial, js_name = moving)]
    fn moving(port: u32, is_moving: bool);
    #[wasm_bindgen(js_namespace = brushworkSerial, js_name = lives)]
    fn lives(port: u32);
    #[wasm_bindgen(js_namespace = brushworkSerial, js_name = stop)]
    fn stop(port: u32);
    #[wasm_bindgen(js_namespace = brushworkSerial, js_name = close)]
    fn close(port: u32);
}

/// The browser around this page.
pub struct ThisBrowser {
    /// One for all links, so that the graph's time runs on from one to the next.
    clock: SystemClock,
}

impl ThisBrowser {
    pub fn new() -> Self {
        Self { clock: SystemClock::new() }
    }
}

impl Browser for ThisBrowser {
    fn reaches_ports(&self) -> bool {
        reaches()
    }

    fn granted(&self) -> Option<Vec<Granted>> {
        let numbers = granted()?;
        let ports = numbers.chunks_exact(NUMBERS).map(|port| {
            let id = |number: u32| u16::try_from(number).ok().filter(|id| *id != 0);
            Granted {
                number: port[0],
                usb_id: id(port[1]).map(|maker| (maker, id(port[2]).unwrap_or_default())),
            }
        });
        Some(ports.collect())
    }

    fn choose(&self) {
        choose();
    }

    fn take_refusal(&self) -> Option<String> {
        take_refusal()
    }

    fn open(&self, number: u32, baud: u32) -> Arc<dyn BrowserPort> {
        open(number, baud);
        Arc::new(Port { number, clock: self.clock })
    }
}

#[derive(Debug)]
struct Port {
    number: u32,
    clock: SystemClock,
}

impl BrowserPort for Port {
    fn state(&self) -> PortState {
        match gone(self.number) {
            Some(why) => PortState::Gone(why),
            None if is_open(self.number) => PortState::Open,
            None => PortState::Opening,
        }
    }

    fn now(&self) -> Duration {
        self.clock.now()
    }

    fn wait(&self, time: Duration) {
        brushwork_wait(time.as_secs_f64() * 1e3);
    }

    fn take(&self) -> Vec<u8> {
        take(self.number)
    }

    fn write(&self, bytes: &[u8]) {
        write(self.number, Uint8Array::from(bytes));
    }

    fn unwritten(&self) -> usize {
        unwritten(self.number) as usize
    }

    fn hold(&self, writes: &[Vec<u8>], gap: Duration) {
        let writes: Array = writes.iter().map(|bytes| Uint8Array::from(bytes.as_slice())).collect();
        hold(self.number, writes, gap.as_secs_f64() * 1e3);
    }

    fn moving(&self, is_moving: bool) {
        moving(self.number, is_moving);
    }

    fn lives(&self) {
        lives(self.number);
    }

    fn stop(&self) {
        stop(self.number);
    }

    fn close(&self) {
        close(self.number);
    }
}
