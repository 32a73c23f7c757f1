//! What to do next: the steps from a controller that was just connected to an axis that is tuned, saved and backed up. Each leads to the
//! screen where it is done, and can be left and taken up again.

use egui::{Button, Frame, Label, Margin, RichText, Role, Stroke, Ui, WidgetInfo, vec2};

use crate::command::{Command, Commands};
use crate::family::path::Place;
use crate::focus::{Region, region_ui};
use crate::messages::ButtonMessage;
use crate::model::path::{Judged, Standing};
use crate::model::{Connection, Model, Screen, Section, Sheet};
use crate::screens::messages::StatusMessage;
use crate::theme::Palette;

const MARK: f32 = 14.0;

/// Nothing where the family has no steps.
pub fn path_ui(ui: &mut Ui, model: &mut Model, commands: &mut Commands) {
    let steps = model.front.path_steps();
    if steps.is_empty() {
        return region_ui(ui, Region::Controls);
    }
    let next = steps.iter().find(|judged| judged.standing == Standing::Wrong);
    let next = next.or_else(|| steps.iter().find(|judged| judged.standing.is_open()));
    let chosen = steps.iter().find(|judged| Some(judged.step.step) == model.front.path.chosen);
    let shown = chosen.or(next);
    let palette = Palette::of(ui);
    let frame = Frame::new().stroke(Stroke::new(1.0, palette.line)).corner_radius(4.0);
    frame.inner_margin(Margin::symmetric(10, 6)).show(ui, |ui| {
        ui.set_width(ui.available_width());
        ui.spacing_mut().item_spacing.y = 4.0;
        ui.horizontal(|ui| {
            ui.label(RichText::new("What to do next").strong());
            ui.weak(progress_text(&steps));
        });
        ui.horizontal_wrapped(|ui| {
            ui.spacing_mut().item_spacing.x = 4.0;
            for judged in &steps {
                let is_shown = shown.is_some_and(|shown| shown.step == judged.step);
                if chip_ui(ui, judged, is_shown) {
                    model.front.path.chosen = Some(judged.step.step);
                }
            }
        });
        // The next step is where the keyboard comes to; what leads to the others stands before it.
        region_ui(ui, Region::Controls);
        match shown {
            Some(judged) => shown_ui(ui, &mut model.front, judged, commands),
            None => {
                ui.label("Nothing is left: this controller is set up, saved and backed up.");
            }
        }
    });
    ui.add_space(6.0);
}

fn progress_text(steps: &[Judged]) -> String {
    let needed = steps.iter().filter(|judged| judged.standing != Standing::NotNeeded).count();
    let done = steps.iter().filter(|judged| judged.standing == Standing::Done).count();
    if steps.iter().any(|judged| judged.standing == Standing::NotKnown) {
        return "The settings are being read …".to_owned();
    }
    StatusMessage::StepsDone { done, needed }.to_string()
}

/// A step by its mark and its title; true where it was pressed.
fn chip_ui(ui: &mut Ui, judged: &Judged, is_shown: bool) -> bool {
    let (title, word) = (judged.step.step.title(), judged.standing.word());
    // The mark is drawn into the room before the words.
    let response = ui.add(Button::selectable(is_shown, format!("     {title}")));
    judged.standing.mark().paint(ui, response.rect.left_center() + vec2(13.0, 0.0), MARK * 0.36);
    response.widget_info(|| {
        WidgetInfo::selected(
            Role::Button,
            true,
            is_shown,
            StatusMessage::Step { title, standing: word }.to_string(),
        )
    });
    response.on_hover_text(format!("{title}: {word}. {}", judged.note)).clicked()
}

/// The step that is looked at: why, how it stands, and the way to it.
fn shown_ui(ui: &mut Ui, front: &mut Connection, judged: &Judged, commands: &mut Commands) {
    let step = judged.step.step;
    let (standing, palette) = (judged.standing, Palette::of(ui));
    ui.add(Label::new(step.why()).wrap());
    ui.horizontal(|ui| {
        let go = Button::new(RichText::new(place_text(front, judged.step.place)).strong());
        let go = ui.add(go);
        if std::mem::take(&mut front.path.wants_focus) {
            go.request_focus();
        }
        if go.clicked() {
            commands.push(place_command(front, judged.step.place));
        }
        let is_left_out = front.path.is_left_out(step);
        if is_left_out && ui.button("Take it up again").clicked() {
            front.path.leave_out(step, false);
            front.path.wants_focus = true;
        }
        let hint = "Takes it off the list until the window is closed; the controller is not touched";
        if !is_left_out
            && standing == Standing::ToDo
            && ui.button("Leave it out").on_hover_text(hint).clicked()
        {
            front.path.leave_out(step, true);
            front.path.wants_focus = true;
        }
        standing.mark().ui(ui, vec2(MARK + 4.0, MARK + 4.0), MARK * 0.4);
        let spoken = format!("{}: {}. {}", step.title(), standing.word(), judged.note);
        let text = RichText::new(format!("{}: {}", standing.word(), judged.note)).color(palette.weak_text);
        let response = ui.add(Label::new(text).truncate());
        response.widget_info(|| WidgetInfo::labeled(Role::Label, true, &spoken));
    });
}

/// What stands on a button that leads somewhere.
pub(crate) fn place_text(front: &Connection, place: Place) -> String {
    let family = front.family();
    match place {
        Place::Settings(groups) => match front.first_row_of(groups) {
            Some(row) => ButtonMessage::GoTo { place: row.group.label().to_string() },
            None => ButtonMessage::GoToSettings,
        }
        .to_string(),
        Place::Screen(screen) => ButtonMessage::GoTo { place: family.title(screen).to_string() }.to_string(),
        Place::Drawer(screen, tab) => StatusMessage::GoToTab {
            screen: family.title(screen).to_string(),
            tab: tab.title(screen).to_string(),
        }
        .to_string(),
        Place::Recipe(job) => StatusMessage::GoToRecipe { job: job.title() }.to_string(),
        Place::Save => "Save…".to_owned(),
        Place::BackUp => "Back up now".to_owned(),
    }
}

pub(crate) fn place_command(front: &Connection, place: Place) -> Command {
    match place {
        Place::Settings(groups) => match front.first_row_of(groups) {
            Some(row) => Command::ShowSettings(Section::of(row)),
            None => Command::Show(Screen::GeneralSettings),
        },
        Place::Screen(screen) => Command::Show(screen),
        Place::Drawer(screen, tab) => Command::OpenDrawer(screen, tab),
        Place::Recipe(job) => Command::ShowRecipe(job),
        Place::Save => Command::OpenSheet(Sheet::Save),
        Place::BackUp => Command::BackUp,
    }
}
