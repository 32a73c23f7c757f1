//! The panel for a simulated controller's world: what its fields hold.

use brushwork_plant::world::WorldView;

/// The panel's own state. What is so in the world is read from its view; the numbers that are typed or dragged are kept
/// here too, since a view that is a moment old would fight with the hand.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct WorldPanel {
    pub open: bool,
    /// Whether the fields below were taken from the world that runs now.
    synced: bool,
    pub load_newton_metres: [f64; 2],
    pub encoder_noise_counts: [f64; 2],
    pub battery_volts: f64,
    pub battery_ohms: f64,
    pub logic_volts: f64,
    /// Temperature the board is held at, while it is held.
    pub held_celsius: Option<f64>,
}

impl WorldPanel {
    /// Takes the fields from a world that was not looked at before.
    pub fn sync(&mut self, view: &WorldView) {
        if self.synced {
            return;
        }
        *self = Self {
            open: self.open,
            synced: true,
            load_newton_metres: view.axes.map(|axis| axis.truth.load_newton_metres),
            encoder_noise_counts: view.axes.map(|axis| axis.truth.encoder_noise_counts),
            battery_volts: view.battery_volts,
            battery_ohms: view.battery_ohms,
            logic_volts: view.logic_volts,
            held_celsius: None,
        };
    }

    /// Another world, or another unit, is looked at from now on.
    pub fn forget(&mut self) {
        self.synced = false;
    }
}
