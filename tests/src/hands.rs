//! Keys and the mouse on an X server, through its XTEST extension.

use std::collections::HashMap;
use std::thread;
use std::time::{Duration, Instant};

use brushwork_plant::machine::Machine;
use x11rb::connection::Connection as _;
use x11rb::protocol::xproto::{
    BUTTON_PRESS_EVENT, BUTTON_RELEASE_EVENT, ConnectionExt as _, InputFocus, KEY_PRESS_EVENT,
    KEY_RELEASE_EVENT, MOTION_NOTIFY_EVENT, Window,
};
use x11rb::protocol::xtest::ConnectionExt as _;
use x11rb::rust_connection::RustConnection;

use crate::program::Program;
use crate::screen::{Screen, on_display};
use crate::served::{Served, guardians_of};
use crate::wait;

/// Between two strokes, so that each is a frame of its own.
const STROKE: Duration = Duration::from_millis(60);

/// Strokes until a slider is found.
const WIDGETS: usize = 200;

/// Keys beside letters and digits, by their X names.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Key {
    /// A letter or digit.
    Char(char),
    /// To the next widget.
    Tab,
    /// Return.
    Enter,
    /// The space bar.
    Space,
    /// Stop.
    Escape,
    /// A page up.
    PageUp,
    /// The left control key.
    Control,
    /// The left shift key.
    Shift,
}

impl Key {
    fn symbol(self) -> u32 {
        match self {
            Self::Char(letter) => u32::from(letter),
            Self::Tab => 0xFF09,
            Self::Enter => 0xFF0D,
            Self::Space => 0x20,
            Self::Escape => 0xFF1B,
            Self::PageUp => 0xFF55,
            Self::Control => 0xFFE3,
            Self::Shift => 0xFFE1,
        }
    }
}

/// A window has opened on a controller when so much is green.
const GREEN_OF_INDICATORS: usize = 100;
/// How long a screen may take to be armed on a crowded machine.
const ARMING: Duration = Duration::from_secs(10);

/// A window of the program on a display of its own, with somebody at its keyboard.
pub struct OpenWindow {
    /// The window.
    pub program: Program,
    /// Its display.
    pub screen: Screen,
    hands: Hands,
}

impl OpenWindow {
    /// That of `program`, opened on a controller, with the screen that drives motors in front.
    ///
    /// # Panics
    /// When it does not connect.
    #[must_use]
    pub fn on<M: Machine + 'static>(program: &str, served: &Served<M>) -> Self {
        let screen = Screen::start();
        let mut command = on_display(program, screen.display());
        command.arg("--open").arg(&served.target);
        let program = Program::spawn(command);
        if screen.wait_for(|picture| picture.green() >= GREEN_OF_INDICATORS).is_none() {
            panic!("no indicator is green: {:?}", program.finish(Duration::ZERO));
        }
        let hands = Hands::at(screen.display());
        hands.click(640, 700);
        hands.focus();
        hands.press(&[Key::Control, Key::Char('3')]);
        Self { program, screen, hands }
    }

    /// Drives the motor by a slider. A window that draws too seldom on a crowded machine stops it again soon.
    ///
    /// # Panics
    /// When it cannot be driven.
    pub fn drive<M: Machine + 'static>(&self, served: &Served<M>) {
        let is_armed = || !guardians_of(self.program.id()).is_empty();
        let becomes = |armed: bool| {
            let until = Instant::now() + ARMING;
            while is_armed() != armed && Instant::now() < until {
                thread::sleep(STROKE);
            }
            is_armed() == armed
        };
        // Nothing is armed while a stop still waits for its confirmation.
        let drive = || {
            self.hands.press(&[Key::Escape]);
            becomes(false)
                && {
                    self.hands.arm();
                    becomes(true)
                }
                && self.hands.slide(|| served.look().0)
        };
        wait::until("a slider that moves its motor", drive, || "it stands".to_owned());
    }
}

/// Somebody at the keyboard of a display.
pub struct Hands {
    connection: RustConnection,
    root: Window,
    codes: HashMap<u32, u8>,
}

impl Hands {
    /// Sits down at a display, such as ":99".
    ///
    /// # Panics
    /// When the display cannot be reached or has no XTEST extension.
    #[must_use]
    pub fn at(display: &str) -> Self {
        let (connection, screen) = RustConnection::connect(Some(display)).expect("the display is there");
        let setup = connection.setup();
        let root = setup.roots[screen].root;
        let (first, last) = (setup.min_keycode, setup.max_keycode);
        let mapping = connection.get_keyboard_mapping(first, last - first + 1).expect("it is asked");
        let mapping = mapping.reply().expect("the display has a keyboard");
        let width = usize::from(mapping.keysyms_per_keycode);
        let rows = mapping.keysyms.chunks(width).zip(first..=last);
        let codes = rows.filter_map(|(symbols, code)| symbols.first().map(|symbol| (*symbol, code)));
        let codes = codes.collect();
        Self { connection, root, codes }
    }

    /// Gives the keyboard to the window that is there; without a window manager nobody else does.
    ///
    /// # Panics
    /// When there is no window.
    pub fn focus(&self) {
        let tree = self.connection.query_tree(self.root).expect("it is asked").reply().expect("it answers");
        let viewable = |window: &&Window| {
            let attributes =
                self.connection.get_window_attributes(**window).ok().and_then(|cookie| cookie.reply().ok());
            attributes.is_some_and(|attributes| u8::from(attributes.map_state) == 2)
        };
        let window = tree.children.iter().rev().find(viewable).expect("a window is open");
        self.connection
            .set_input_focus(InputFocus::PARENT, *window, x11rb::CURRENT_TIME)
            .expect("it is asked");
        self.flush();
    }

    /// Presses keys together, such as Ctrl and 3, and lets them go.
    pub fn press(&self, keys: &[Key]) {
        for key in keys {
            self.fake(KEY_PRESS_EVENT, self.code(*key));
        }
        for key in keys.iter().rev() {
            self.fake(KEY_RELEASE_EVENT, self.code(*key));
        }
        self.flush();
    }

    /// Arms the screen that is shown.
    pub fn arm(&self) {
        self.press(&[Key::Control, Key::Shift, Key::Char('a')]);
    }

    /// Presses Page Up on one widget of an armed screen after the other until something is driven: on anything but a slider it changes
    /// nothing that moves. Says whether it was. A window goes on by one widget a frame, so that a slow one makes fewer steps than there
    /// are strokes.
    pub fn slide(&self, is_driven: impl Fn() -> bool) -> bool {
        (0..WIDGETS).any(|_| {
            self.press(&[Key::Tab]);
            self.press(&[Key::PageUp]);
            is_driven()
        })
    }

    /// Moves the mouse to a point and clicks.
    ///
    /// # Panics
    /// When the display is gone.
    pub fn click(&self, x: i16, y: i16) {
        let moved = self.connection.xtest_fake_input(MOTION_NOTIFY_EVENT, 0, 0, self.root, x, y, 0);
        moved.expect("it is asked");
        self.flush();
        self.fake(BUTTON_PRESS_EVENT, 1);
        self.flush();
        self.fake(BUTTON_RELEASE_EVENT, 1);
        self.flush();
    }

    fn code(&self, key: Key) -> u8 {
        *self.codes.get(&key.symbol()).unwrap_or_else(|| panic!("the keyboard has no {key:?}"))
    }

    fn fake(&self, kind: u8, detail: u8) {
        let faked = self.connection.xtest_fake_input(kind, detail, 0, x11rb::NONE, 0, 0, 0);
        faked.expect("the display takes it");
    }

    fn flush(&self) {
        self.connection.flush().expect("the display is there");
        thread::sleep(STROKE);
    }
}
