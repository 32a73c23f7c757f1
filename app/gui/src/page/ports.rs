//! The serial ports that a browser lets its page reach: those that its user has chosen for it, now or earlier.

use std::cell::{Cell, RefCell};
use std::rc::Rc;
use std::sync::Arc;

use brushwork_core::session::browser::BrowserPort;
use brushwork_link::transport::PortInfo;
use brushwork_link::{Failure, Message};

use crate::messages::{WindowActMessage, WindowCauseMessage, WindowRemedyMessage};
use crate::parts::PortSource;

/// A port that may be opened.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Granted {
    /// The browser's side counts them.
    pub number: u32,
    /// USB vendor and product number.
    pub usb_id: Option<(u16, u16)>,
}

/// What a page asks of its browser. Nothing here waits.
pub trait Browser {
    /// Whether it has serial ports and can hold a call in its middle, without which a page cannot wait for a reply.
    fn reaches_ports(&self) -> bool;

    /// The ports that may be opened, if that has changed since it was last asked for.
    fn granted(&self) -> Option<Vec<Granted>>;

    /// Lets its user choose a port for the page.
    fn choose(&self);

    /// Why none was chosen, once.
    fn take_refusal(&self) -> Option<String>;

    /// Begins to open a port.
    fn open(&self, number: u32, baud: u32) -> Arc<dyn BrowserPort>;
}

/// A browser, and the names that its ports have in this page. Clones are the same.
#[derive(Clone)]
pub struct Ports(Rc<State>);

struct State {
    browser: Box<dyn Browser>,
    named: RefCell<Vec<(Granted, PortInfo)>>,
    /// Whether the list has changed since it was last taken.
    is_new: Cell<bool>,
    is_told: Cell<bool>,
}

impl Ports {
    #[must_use]
    pub fn new(browser: Box<dyn Browser>) -> Self {
        Self(Rc::new(State {
            browser,
            named: RefCell::default(),
            is_new: Cell::default(),
            is_told: Cell::new(false),
        }))
    }

    /// Begins to open the port of that name; with it the USB number of its device's maker. `None` where no port has the name.
    pub fn open(&self, name: &str, baud: u32) -> Option<(Arc<dyn BrowserPort>, Option<u16>)> {
        self.look();
        let named = self.0.named.borrow();
        let (granted, _) = named.iter().find(|(_, info)| info.name == name)?;
        Some((self.0.browser.open(granted.number, baud), granted.usb_id.map(|(maker, _)| maker)))
    }

    /// Takes over the browser's list, where it has changed.
    fn look(&self) {
        let Some(granted) = self.0.browser.granted() else { return };
        self.0.is_new.set(true);
        let mut named = self.0.named.borrow_mut();
        named.retain(|(known, _)| granted.contains(known));
        for port in granted {
            if !named.iter().any(|(known, _)| *known == port) {
                let info = info_of(port, &named);
                named.push((port, info));
            }
        }
    }

    fn listed(&self) -> Option<Vec<PortInfo>> {
        self.look();
        let named = self.0.named.borrow();
        self.0.is_new.take().then(|| named.iter().map(|(_, info)| info.clone()).collect())
    }
}

/// Browsers give ports no names. One is named by its device, so that it has the same name the next time; of several alike the later ones are
/// counted.
fn info_of(port: Granted, named: &[(Granted, PortInfo)]) -> PortInfo {
    let stem = port
        .usb_id
        .map_or_else(|| "serial".to_owned(), |(maker, product)| format!("usb-{maker:04x}-{product:04x}"));
    let counted = (2..).map(|count| format!("{stem}-{count}"));
    let is_free = |name: &String| !named.iter().any(|(_, info)| info.name == *name);
    let name = std::iter::once(stem.clone()).chain(counted).find(is_free).unwrap_or(stem);
    PortInfo { name, is_usb: port.usb_id.is_some(), usb_id: port.usb_id, ..PortInfo::default() }
}

impl PortSource for Ports {
    fn newest(&mut self) -> Option<Result<Vec<PortInfo>, Failure>> {
        if self.can_choose() {
            return self.listed().map(Ok);
        }
        let (act, cause) = (WindowActMessage::ReachPort, WindowCauseMessage::BrowserHasNoPorts);
        (!self.0.is_told.replace(true))
            .then(|| Err(Failure::new(act, "", cause, WindowRemedyMessage::UseChromium)))
    }

    fn can_choose(&self) -> bool {
        self.0.browser.reaches_ports()
    }

    fn choose(&mut self) {
        self.0.browser.choose();
    }

    fn take_refusal(&mut self) -> Option<Message> {
        let why = self.0.browser.take_refusal()?;
        let (act, cause) = (WindowActMessage::ChoosePort, WindowCauseMessage::Said { text: why });
        Some(Failure::new(act, "", cause, WindowRemedyMessage::ChooseAgain).message())
    }
}
