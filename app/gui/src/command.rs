//! What a person can ask of the window. Screens send commands; [`super::app::App`] applies them in one place.

use brushwork_canopen::NodeId;
use std::path::PathBuf;
use std::rc::Rc;

use brushwork_link::{ArmScope, PollRate, SettingsImage, Stream};
use brushwork_plant::world::WorldAction;
use brushwork_values::{Motor, Value};
use egui::ThemePreference;

use super::debugger::DebugAction;
use super::family::recipe::Goal;
use super::family_action::FamilyAction;
use super::graph::GraphAction;
use super::mcl::MclAction;
use super::model::ConnectionId;
use super::model::addressing::AddressingAction;
use super::model::examination::ExaminationAction;
pub use super::model::guided::GuidedAction;
use super::model::raw::RawAction;
use super::model::to_all::ToAllAction;
pub use super::tune::TuneAction;
use crate::language::Language;
use crate::model::{Column, HelpPage, Screen, Section, SettingsAction, Sheet, Tab};

/// One action.
#[derive(Clone, Debug)]
pub enum Command {
    /// Opens a link to what is chosen in the device list.
    Connect,
    /// Lets a port be chosen that a browser then lets its page reach.
    ChoosePort,
    /// Opens a link to what a person would have typed, or brings it to the front if it is open.
    ConnectTo(String),
    /// Closes a link, or gives up opening it.
    Disconnect(ConnectionId),
    /// Puts another open link in front.
    Front(ConnectionId),
    /// Closes a link and forgets all that is known of it.
    Forget(ConnectionId),
    /// Takes a target off the list of recent connections.
    ForgetRecent(String),
    Show(Screen),
    /// Stops all motors of every open link.
    Stop,
    Arm(ArmScope),
    Disarm,
    SelectUnit(u8),
    /// Which of the controller's ports this one is wired to.
    SetStream(Stream),
    ZeroEncoder(Motor),
    ResetEmergencyStop,
    /// Forgets what was learned of the unit's firmware, and learns it anew.
    LearnAnew,
    Poll(PollRate),
    /// Turns a direction round in the controller's RAM.
    Reverse(SettingsImage),
    /// Keeps a copy of the settings on this computer.
    BackUp,
    /// Reads the settings of the control loops again.
    ReadLoops,
    /// Writes the edits of these settings of the control loops to the controller's RAM.
    ApplyLoops(&'static [Column]),
    /// Something done to the world of the simulated unit that is looked at.
    World(WorldAction),
    /// Something to be done with the settings of the unit that is looked at.
    Settings(SettingsAction),
    /// Lets the simulated board in front run again what the window drives it through.
    RunLibrary,
    /// Sends one raw command; the answer comes with `id`.
    Transact {
        id: u64,
        command: u8,
        values: Vec<Value>,
    },
    /// Sends bytes as they are.
    Raw {
        id: u64,
        bytes: Vec<u8>,
    },
    /// Shows General Settings with a sheet in place of the list.
    OpenSheet(Sheet),
    /// Sets the settings of another unit beside those of this one, to be taken over.
    CopyUnit,
    /// Shows a recipe.
    ShowRecipe(Goal),
    /// Shows a part of General Settings.
    ShowSettings(Section),
    /// Shows General Settings and puts the keyboard into its search field.
    FindSetting,
    /// Drops the edits of settings that were not written.
    RevertSettings,
    /// Takes the last step of the edits of settings back, or does it again.
    StepSettings {
        again: bool,
    },
    Theme(ThemePreference),
    Language(Language),
    PlainEdges(bool),
    /// Size of everything in the window, percent.
    Scale(u16),
    /// Opens a file as what it is.
    OpenFile(PathBuf),
    /// Asks for a file to open.
    ChooseFile,
    /// Lists the backups of every controller, without one.
    ListBackups,
    /// Shows the start page in the place of what is left of a connection.
    ShowStart,
    /// Opens the window for firmware updates.
    OpenFirmware,
    /// Opens the window that examines the controller.
    OpenExamination,
    Examination(ExaminationAction),
    /// Opens the assistant that gives boards their addresses.
    OpenAddressing,
    Addressing(AddressingAction),
    /// Opens the window that gives one profile to every unit.
    OpenToAll,
    ToAll(ToAllAction),
    /// Opens the page for numbers that are written raw.
    OpenRaw,
    WriteRaw(RawAction),
    /// Opens the window for connecting to a CANopen bus.
    OpenCanOpen,
    /// Starts a node of the CAN bus in front.
    StartNode(NodeId),
    ToggleWorld,
    /// Shows a screen that drives, with this tab of its drawer open.
    OpenDrawer(Screen, Tab),
    /// Something to be done with the graph.
    Graph(GraphAction),
    ToggleTraffic,
    PauseTraffic(bool),
    /// Empties the list of events.
    ClearHistory,
    OpenPalette,
    /// Puts the keyboard into the next region of the window, or the one before.
    NextRegion {
        forward: bool,
    },
    OpenHelp(HelpPage),
    /// Stops all motors and closes the window.
    Exit,
    /// A profile to be played or QPPS to be measured.
    Guided(GuidedAction),
    /// Something to be done in guided tuning.
    Tune(TuneAction),
    /// The voltage clamp test.
    ClampTest,
    DismissMessage,
    /// Something that a family's own screens ask for.
    Own(Rc<dyn FamilyAction>),
    /// Something to be done by the MCL debugger.
    Debug(DebugAction),
    /// Something to be done in the MCL editor.
    Mcl(MclAction),
    /// Compiles the MCL program in front and downloads it.
    DownloadMcl,
    /// Gives up the download that runs.
    CancelDownload,
    StartScript,
    StopScript,
}

/// The actions of one frame, in order.
pub type Commands = Vec<Command>;

impl Command {
    /// Something that a family's own screens ask for.
    pub fn own(action: impl FamilyAction + 'static) -> Self {
        Self::Own(Rc::new(action))
    }
}
