//! Everything a person can ask for by name: ONE table behind the menus, the command palette, the shortcuts and the list
//! of shortcuts in Help.
//!
//! To add an action, add a row to the file of its menu. Nothing else has to know: the row says where it stands, which
//! keys call it, when it can be done and why not, and which [`Command`] it is.

use crate::actions::messages::ActionMessage;
use crate::language::word;
use crate::messages::WindowStatusMessage;
use std::borrow::Cow;
use std::sync::OnceLock;

use brushwork_script::language::Language;
use egui::{Context, Key, KeyboardShortcut, Modifiers};

use super::command::{Command, Commands};
use super::keys::{as_written, said_stop_words};
use super::mcl::has_keyboard;
use super::model::Model;
use super::model::screen::Screen;

/// An action: menu and group, name, title and help; its keys, when it can be done, its command; when it is on, if it can be on or off.
macro_rules! entry {
    ($menu:ident $group:literal $id:literal, $title:expr, $help:literal,
        $keys:expr, $ready:expr, $command:expr $(, on $is_on:expr)?) => {
        $crate::actions::Action {
            id: $id,
            title: $title,
            place: $crate::actions::Place { menu: $crate::actions::Menu::$menu, group: $group },
            keys: $keys,
            help: $help,
            ready: $ready,
            is_on: entry!(@ $($is_on)?),
            command: $command,
        }
    };
    (@) => { None };
    (@ $is_on:expr) => { Some($is_on) };
}

/// A row of the Help menu that opens a page.
macro_rules! page {
    ($id:literal: $title:expr, $keys:expr, $page:expr, $help:literal) => {
        $crate::actions::Action {
            id: $id,
            title: $title,
            place: $crate::actions::Place { menu: $crate::actions::Menu::Help, group: $page.group },
            keys: $keys,
            help: $help,
            ready: |_| Ok(()),
            is_on: None,
            command: |_| $crate::command::Command::OpenHelp($page),
        }
    };
}
pub(crate) use page;

mod debug;
mod device;
mod edit;
mod file;
mod graph;
mod help;
pub mod messages;
mod program;
mod view;
mod work;

/// One thing that can be asked for.
#[derive(Debug)]
pub struct Action {
    /// A stable name: `device.read-settings`.
    pub id: &'static str,
    /// As it stands in its menu; dots at the end where it asks something first.
    pub title: &'static str,
    pub place: Place,
    pub keys: Keys,
    /// One sentence: what it does.
    pub help: &'static str,
    /// Whether it can be done now, else why not.
    pub ready: fn(&Model) -> Ready,
    /// For what can be on or off.
    pub is_on: Option<fn(&Model) -> bool>,
    /// What is done. Asked only when it is ready.
    pub command: fn(&Model) -> Command,
}

/// Where an action stands.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Place {
    pub menu: Menu,
    /// A line is drawn between two groups.
    pub group: u8,
}

/// The menus, in order (MCP manual 1.2.6 to 1.2.9, and what is new).
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Menu {
    File,
    Edit,
    Device,
    Debug,
    View,
    Graph,
    Help,
}

impl Menu {
    pub const ALL: [Self; 7] =
        [Self::File, Self::Edit, Self::Device, Self::Debug, Self::View, Self::Graph, Self::Help];

    pub const fn title(self) -> &'static str {
        match self {
            Self::File => "File",
            Self::Edit => "Edit",
            Self::Device => "Device",
            Self::Debug => "Debug",
            Self::View => "View",
            Self::Graph => "Graph",
            Self::Help => "Help",
        }
    }
}

/// How the keyboard calls an action.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Keys {
    None,
    /// Calls it from anywhere.
    Shortcut(KeyboardShortcut),
    /// Calls it while the MCL screen is shown, and goes before what the keys call elsewhere.
    OnMcl(KeyboardShortcut),
    /// Calls it while a program's text has the keyboard: fields for words use the same keys.
    InText(KeyboardShortcut),
    /// Calls it from beside the MCL screen while no field for text has the keyboard: such fields use the same keys.
    Beside(KeyboardShortcut),
    /// Is taken elsewhere, by a text field, and only listed here.
    Elsewhere(&'static str),
    /// The keys that stop, which are taken before anything else and only listed here.
    Stop,
}

/// How the names of actions begin that are about the program in front, whatever language that is in.
const ABOUT_PROGRAMS: [&str; 4] = ["file.", "edit.", "view.", "device.check-mcl"];

/// `Err` says in a sentence why an action cannot be done now.
pub type Ready = Result<(), Refused>;

/// Why an action cannot be done now, in a sentence.
type Refused = Cow<'static, str>;

static OWN: OnceLock<Vec<&'static Action>> = OnceLock::new();

/// Sets the actions that families have of their own, once. They stand in the Help menu.
pub(crate) fn install(own: Vec<&'static Action>) {
    // A second list is that of another test.
    let _ = OWN.set(own);
}

/// Every action, menu by menu, as the menus show them.
pub fn all() -> impl Iterator<Item = &'static Action> {
    let own = OWN.get().into_iter().flatten().copied();
    let mut help: Vec<&Action> = help::ACTIONS.iter().chain(own).collect();
    help.sort_by_key(|action| action.place.group);
    [
        program::FILE,
        file::ACTIONS,
        program::EDIT,
        edit::ACTIONS,
        device::ACTIONS,
        work::ACTIONS,
        debug::ACTIONS,
        view::ACTIONS,
        program::VIEW,
        graph::ACTIONS,
    ]
    .into_iter()
    .flatten()
    .chain(help)
}

/// The actions of a menu.
pub fn of_menu(menu: Menu) -> impl Iterator<Item = &'static Action> {
    all().filter(move |action| action.place.menu == menu)
}

impl Action {
    /// Its title in the language of the window. What is done to the program in front names that program's language in place of MCL.
    pub fn said(&self, model: &Model) -> String {
        self.about(model, word("action", self.title))
    }

    /// What it does, about the program in front.
    pub fn help(&self, model: &Model) -> String {
        self.about(model, self.help.to_owned())
    }

    fn about(&self, model: &Model, text: String) -> String {
        match model.mcl.front().language() {
            Language::Mcl => text,
            language if ABOUT_PROGRAMS.iter().any(|ids| self.id.starts_with(ids)) => {
                // The English article is that of the letters M-C-L.
                text.replace("an MCL", "a MCL").replace("An MCL", "A MCL").replace("MCL", language.name())
            }
            Language::Mecc | Language::Brought(_) => text,
        }
    }

    /// Its keys as text: "Ctrl+Shift+P". Empty when it has none.
    pub fn keys_text(&self, ctx: &Context) -> String {
        match self.keys {
            Keys::None => String::new(),
            Keys::Shortcut(shortcut)
            | Keys::OnMcl(shortcut)
            | Keys::InText(shortcut)
            // A bracket is looked for on the keyboard by its sign.
            | Keys::Beside(shortcut) => ctx.format_shortcut(&shortcut).replace(Key::OpenBracket.name(), "["),
            Keys::Elsewhere(text) => as_written(ctx, text),
            Keys::Stop => said_stop_words(ctx),
        }
    }
}

/// The commands of the shortcuts that were pressed. What cannot be done now says why.
pub fn shortcuts(ctx: &Context, model: &mut Model) -> Commands {
    let mut pressed: Vec<&Action> = Vec::new();
    let on_mcl = model.screen == Screen::MclEditor && model.palette.is_none();
    let in_text = on_mcl && has_keyboard(ctx, &model.mcl);
    let beside = !on_mcl && !ctx.text_edit_focused();
    // Ctrl+Shift+S would also pass for Ctrl+S: more modifiers go first.
    for count in (0..=3).rev() {
        // What is for the program that is edited goes before what is for the whole window.
        for general in [false, true] {
            for action in all() {
                let shortcut = match action.keys {
                    Keys::Shortcut(shortcut) if general => shortcut,
                    Keys::OnMcl(shortcut) if !general && on_mcl => shortcut,
                    Keys::InText(shortcut) if !general && in_text => shortcut,
                    Keys::Beside(shortcut) if general && beside => shortcut,
                    Keys::None
                    | Keys::Shortcut(_)
                    | Keys::OnMcl(_)
                    | Keys::InText(_)
                    | Keys::Beside(_)
                    | Keys::Elsewhere(_)
                    | Keys::Stop => continue,
                };
                if modifiers(shortcut) == count && ctx.input_mut(|input| input.consume_shortcut(&shortcut)) {
                    pressed.push(action);
                }
            }
        }
    }
    let mut commands = Commands::new();
    for action in pressed {
        match (action.ready)(model) {
            Ok(()) => commands.push((action.command)(model)),
            Err(why) => model.messages.warn(WindowStatusMessage::NotNow {
                act: action.about(model, action.title.trim_end_matches('…').to_owned()),
                why: why.to_string(),
            }),
        }
    }
    commands
}

fn modifiers(shortcut: KeyboardShortcut) -> usize {
    let Modifiers { alt, ctrl, shift, command, .. } = shortcut.modifiers;
    [alt, shift, ctrl || command].into_iter().filter(|held| *held).count()
}

const fn key(key: Key) -> Keys {
    Keys::Shortcut(KeyboardShortcut::new(Modifiers::NONE, key))
}

const fn shift(key: Key) -> Keys {
    Keys::Shortcut(KeyboardShortcut::new(Modifiers::SHIFT, key))
}

const fn ctrl(key: Key) -> Keys {
    Keys::Shortcut(KeyboardShortcut::new(Modifiers::COMMAND, key))
}

const fn ctrl_shift(key: Key) -> Keys {
    Keys::Shortcut(KeyboardShortcut::new(Modifiers::COMMAND.plus(Modifiers::SHIFT), key))
}

// ---- when something can be done ----

fn always(_: &Model) -> Ready {
    Ok(())
}

/// Ready where something holds, else with the reason why not.
fn only(holds: bool, why: impl Into<Cow<'static, str>>) -> Ready {
    holds.then_some(()).ok_or_else(|| why.into())
}

fn connected(model: &Model) -> Ready {
    only(model.is_connected(), "No controller is connected.")
}

/// A controller is connected and no other work with its settings runs.
fn settings_idle(model: &Model) -> Ready {
    connected(model)?;
    match model.front.settings.running() {
        Some(running) => Err(ActionMessage::Busy { job: running.name().to_string() }.to_string().into()),
        None if model.front.general.holds_settings() => {
            Err("A calibration or a test uses the settings. End it first.".into())
        }
        None => Ok(()),
    }
}

/// The MCL screen is shown.
fn on_mcl(model: &Model) -> Ready {
    let elsewhere = "This is for MCL programs. Go to the MCL Editor first.";
    only(model.screen == Screen::MclEditor, elsewhere)
}

const fn on_mcl_key(modifiers: Modifiers, key: Key) -> Keys {
    Keys::OnMcl(KeyboardShortcut::new(modifiers, key))
}

const fn in_text_key(modifiers: Modifiers, key: Key) -> Keys {
    Keys::InText(KeyboardShortcut::new(modifiers, key))
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeSet;

    use super::*;

    /// Every action, with those of the families.
    fn all() -> impl Iterator<Item = &'static Action> {
        crate::install(&[&crate::mcp::Mcp, &crate::motion_mind::MotionMind]);
        super::all()
    }

    #[test]
    fn no_two_actions_share_a_name_a_title_or_keys() {
        let (mut ids, mut titles, mut keys) = (BTreeSet::new(), BTreeSet::new(), BTreeSet::new());
        let ctx = Context::default();
        for action in all() {
            assert!(ids.insert(action.id), "{} twice", action.id);
            assert!(titles.insert(action.title), "{} twice", action.title);
            let text = action.keys_text(&ctx);
            let for_programs = matches!(action.keys, Keys::OnMcl(_) | Keys::InText(_));
            let is_new = text.is_empty() || keys.insert((for_programs, text.clone()));
            assert!(is_new, "{text} twice: {}", action.id);
        }
    }

    #[test]
    fn each_action_tells_what_it_does_and_stands_in_the_menu_its_name_says() {
        for action in all() {
            let menu = action.place.menu.title().to_lowercase();
            assert!(action.id.starts_with(&format!("{menu}.")), "{}", action.id);
            assert!(action.help.ends_with('.') && action.help.len() > 10, "{}: {}", action.id, action.help);
        }
    }

    #[test]
    fn groups_stand_together_in_their_menu() {
        for menu in Menu::ALL {
            let groups: Vec<u8> = of_menu(menu).map(|action| action.place.group).collect();
            assert!(groups.is_sorted(), "{menu:?}: {groups:?}");
            assert!(!groups.is_empty(), "{menu:?} is empty");
        }
    }

    #[test]
    fn nothing_takes_a_stop_key() {
        for action in all() {
            if let Keys::Shortcut(shortcut)
            | Keys::OnMcl(shortcut)
            | Keys::InText(shortcut)
            | Keys::Beside(shortcut) = action.keys
            {
                assert!(!matches!(shortcut.logical_key, Key::Space | Key::Escape), "{}", action.id);
            }
        }
    }

    #[test]
    fn what_cannot_be_done_says_why_in_a_sentence() {
        let model = Model::default();
        for action in all() {
            if let Err(why) = (action.ready)(&model) {
                assert!(why.ends_with('.') && why.len() > 10, "{}: {why}", action.id);
            }
        }
    }
}
