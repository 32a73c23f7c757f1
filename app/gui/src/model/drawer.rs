//! The drawer of the screens that drive: settings, generator and measurement share one place above the graph.

use super::screen::Screen;

/// What the drawer shows.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Tab {
    /// The settings that the screen is named after.
    Settings,
    /// The speed loop below the position loop.
    VelocityLoop,
    /// Which way motor and encoder turn.
    Direction,
    Generator,
    Qpps,
    /// Steps with the gains turned between them (Motion Mind manual 3.14).
    Steps,
    /// Calibration by hand, step by step.
    ByHand,
    /// The gains of the loop that a family draws itself.
    Gains,
    /// To a place that is known from a switch, step by step.
    Home,
    /// Guided tuning; it takes the room of the sliders and the graph.
    Tune,
}

impl Tab {
    pub const fn title(self, screen: Screen) -> &'static str {
        match (self, screen) {
            (Self::Settings, Screen::Pwm) => "L, R and QPPS",
            (Self::Settings, Screen::Position) => "Position loop",
            (Self::Settings | Self::VelocityLoop, _) => "Velocity loop",
            (Self::Direction, _) => "Direction",
            (Self::Generator, _) => "Generator",
            (Self::Qpps, _) => "Measure QPPS",
            (Self::Steps, _) => "Step response",
            (Self::ByHand, _) => "By hand",
            (Self::Gains, _) => "Gains",
            (Self::Home, _) => "Home",
            (Self::Tune, _) => "Tune",
        }
    }
}

/// Which tab is open on each screen; none leaves all the room to the graph.
#[derive(Clone, Debug)]
pub struct Drawers {
    /// What was pressed, if anything was.
    chosen: [Option<Option<Tab>>; Screen::ALL.len()],
    /// Whether there is room for a drawer and a graph. Without it the drawer is closed at first.
    pub has_room: bool,
}

impl Default for Drawers {
    fn default() -> Self {
        Self { chosen: [None; Screen::ALL.len()], has_room: true }
    }
}

impl Drawers {
    pub fn open(&self, screen: Screen) -> Option<Tab> {
        self.chosen[screen as usize].unwrap_or(self.has_room.then_some(Tab::Settings))
    }

    /// Opens a tab, or closes the drawer if it is open already.
    pub fn press(&mut self, screen: Screen, tab: Tab) {
        let open = self.open(screen);
        self.chosen[screen as usize] = Some((open != Some(tab)).then_some(tab));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn in_a_small_window_the_drawer_is_closed_until_a_tab_is_pressed() {
        let mut drawers = Drawers { has_room: false, ..Drawers::default() };
        assert_eq!(drawers.open(Screen::Velocity), None);
        drawers.press(Screen::Velocity, Tab::Settings);
        assert_eq!(drawers.open(Screen::Velocity), Some(Tab::Settings));
    }

    #[test]
    fn pressing_the_open_tab_closes_the_drawer_of_that_screen_alone() {
        let mut drawers = Drawers::default();
        drawers.press(Screen::Pwm, Tab::Qpps);
        assert_eq!(drawers.open(Screen::Pwm), Some(Tab::Qpps));
        drawers.press(Screen::Pwm, Tab::Qpps);
        assert_eq!(drawers.open(Screen::Pwm), None);
        assert_eq!(drawers.open(Screen::Position), Some(Tab::Settings));
    }
}
