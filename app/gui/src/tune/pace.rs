//! The trapezoid that a tuned motor follows, and the one that both motors of a drive do.

use brushwork_tuning::trajectory::Trajectory;
use brushwork_values::Motor;
use egui::{Label, RichText, Ui};

use super::Loop;
use crate::model::connection::Connection;
use crate::model::{Model, Screen};
use crate::tune::messages::RunMessage;

const HINT: &str = "From the model of the run: 15 % of the duty is left to the loop, three quarters of the rest go into speed and one into \
                    acceleration. A motor that is told to be quicker runs out of duty and overshoots.";

pub fn pace_ui(ui: &mut Ui, model: &mut Model, which: Loop) {
    let motor = model.front.tune.motor(which);
    let Some(own) = of(&model.front, which, motor) else { return };
    let others = model.front.motors().iter().filter(|other| **other != motor);
    let both =
        others.filter_map(|other| of(&model.front, which, *other)).next().map(|other| own.of_both(other));
    let said =
        |Trajectory { speed_counts_per_s: speed, accel_counts_per_s2: accel }: Trajectory| (speed, accel);
    let (speed, accel) = said(own);
    text_ui(ui, &RunMessage::Trajectory { speed, accel });
    if let Some(both) = both {
        let (speed, accel) = said(both);
        text_ui(ui, &RunMessage::TrajectoryOfBoth { speed, accel });
    }
    let hint = "Sets the speed of moves and the acceleration of the Velocity and Position screens, which both motors share; nothing is sent";
    let has_sliders = matches!(model.screen, Screen::Velocity | Screen::Position);
    if has_sliders && ui.small_button("Use for the sliders").on_hover_text(hint).clicked() {
        let trajectory = both.unwrap_or(own);
        model.front.velocity.follow(&trajectory);
        model.front.position.follow(&trajectory);
    }
}

/// What the last run of a motor told.
fn of(front: &Connection, which: Loop, motor: Motor) -> Option<Trajectory> {
    front.tune.panel(which, motor).run()?.report.trajectory()
}

fn text_ui(ui: &mut Ui, said: &RunMessage) {
    ui.add(Label::new(RichText::new(said.to_string()).small()).wrap()).on_hover_text(HINT);
}
