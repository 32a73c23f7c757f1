//! The page of help on tuning: how the tuner works, what it refuses, and how to go on from what it proposes.

use egui::Ui;

const HOW: [(&str, &str); 7] = [
    (
        "What stays as it is",
        "A run writes gains into the controller's RAM only while it tries them, and puts the old ones back at its end, whatever ends it: \
         Space, Esc, Stop All, leaving the screen, a fault, a cable pulled out (then as soon as the controller answers again). Nothing \
         stays until you press Apply, and nothing is in EEPROM until you save it.",
    ),
    (
        "Wiring check",
        "The duty goes up from 4 % in small steps until the motor moves, at most to 40 %. Counts that go down, a motor that draws no \
         current, a shaft that stands, an encoder that is silent: each ends the run here, before the motor is fast.",
    ),
    (
        "Experiment",
        "On an axis that turns freely: full speed one way, a few steps up and down, full speed the other way. Within a travel: oscillations \
         about the place where the axis stands, never at full speed. The counts with their times are fitted by a model of a motor with \
         friction, which gives QPPS, the time constant and how sure they are.",
    ),
    (
        "Lag",
        "What limits the gains is a delay of a few milliseconds inside the controller, which polling cannot see. It is measured with a \
         careful loop on the machine, by how the duty answers.",
    ),
    (
        "Design",
        "Gains are searched on the model so that a step and a load are answered quickly, while the maximum sensitivity Ms stays below \
         what the level allows: 1.2 at level 0, 1.6 at 50, 2.0 at 100. Less is tamer and forgives more load, more backlash and a warmer motor; \
         more is quicker.",
    ),
    (
        "Trial",
        "The gains are tried on the machine. If it is rougher than the model predicts, they are lowered, at most three times; then the run \
         gives up and says so.",
    ),
    (
        "What if",
        "After a run the level and every gain can be changed on the model: step, load step, figures and the loop over frequency are drawn \
         again at once, and nothing is sent. Earlier runs are drawn beneath as dots.",
    ),
];

const FIGURES: [(&str, &str); 6] = [
    ("Overshoot", "How far a step goes beyond its setpoint, as a share of the step."),
    ("Settling", "When a step stays near its setpoint: within 5 % of a speed step, 2 % of a position step."),
    ("Load dip", "How far a load of 15 % of the stall torque drives the motor off, as a share of the step."),
    (
        "Ms",
        "The peak of the sensitivity. In the Nyquist plot the curve keeps out of a circle of radius 1/Ms about -1. Above 2 the loop is close to oscillating.",
    ),
    (
        "Duty noise",
        "What the rounding of encoder counts alone does to the duty. Coarse encoders allow less gain.",
    ),
    (
        "Other loads",
        "The identified model with another inertia, other friction or a steady load, under the same gains: between which multiples of the inertia the \
         loop stays stable and Ms stays up to 2, and the largest load that full duty still carries at the top speed of the trajectory.",
    ),
];

const REFUSED: [(&str, &str); 9] = [
    (
        "Counts down",
        "Motor leads or encoder wires are swapped. Closing a loop on that would run away, so none is closed.",
    ),
    (
        "No counts",
        "With current flowing: the encoder or its cable. With the current of a standing motor: the shaft is held.",
    ),
    ("No current", "A motor lead is open."),
    ("Stopped in mid-run", "An end stop, a jam, a lost encoder or an open lead, told apart by the current."),
    ("Travel", "The axis came near an end of its travel. It is braked before it is there."),
    ("Battery and current", "A sagging supply, or a current above what was allowed."),
    (
        "L and R both set",
        "They turn the duty into a current, so that nothing could be measured. The run can clear them and put them back, if you say so.",
    ),
    (
        "Does not fit",
        "The motion is not that of a motor with friction: slipping parts, backlash, a load that changes.",
    ),
    ("Link or controller", "No answer, a fault, a command that is not taken."),
];

pub fn tuning_ui(ui: &mut Ui) {
    ui.heading("How the tuner works");
    for (title, text) in HOW {
        ui.add_space(6.0);
        ui.strong(title);
        ui.label(text);
    }
    list_ui(ui, "What the figures mean", &FIGURES);
    list_ui(ui, "What it refuses", &REFUSED);
    ui.add_space(10.0);
    ui.heading("By hand");
    ui.label(
        "By hand, beside Tune, goes through the manual's procedures (MCP manual 2.4.6 and 2.4.7) with you: it offers each change as a \
         button, watches the motor for vibration, overshoot and hunting, and says what speaks for the next change.",
    );
}

fn list_ui(ui: &mut Ui, title: &str, rows: &[(&str, &str)]) {
    ui.add_space(10.0);
    ui.heading(title);
    for (name, text) in rows {
        ui.add_space(4.0);
        ui.strong(*name);
        ui.label(*text);
    }
}
