//! The row of buttons above the text: the functions of Ion Studio's toolbar, in its order (MCP manual 1.2.14).

use brushwork_script::language::Language;
use egui::{Button, RichText, Role, Ui, WidgetInfo};

use crate::actions;
use crate::command::Commands;
use crate::keys::as_written;
use crate::language::said;
use crate::mcl::messages::PanelMessage;
use crate::model::Model;

/// The buttons: an action of the table, and what its button reads. A line stands between groups.
const GROUPS: [&[(&str, &str)]; 8] = [
    &[("file.new", "New"), ("file.open", "Open"), ("file.save", "Save"), ("file.print", "Print")],
    &[("edit.cut", "Cut"), ("edit.copy", "Copy"), ("edit.paste", "Paste")],
    &[("view.hidden", "Hidden"), ("view.current-line", "Line"), ("view.folding", "Folds")],
    &[("edit.undo", "Undo"), ("edit.redo", "Redo")],
    &[("edit.bookmark", "Mark"), ("edit.previous-bookmark", "‹"), ("edit.next-bookmark", "›")],
    &[("device.check-mcl", "Check"), ("device.download-mcl", "Download")],
    &[("device.start-script", "Run"), ("device.stop-script", "Stop"), ("view.terminal", "Terminal")],
    &[("view.zoom-out", "A−"), ("view.zoom-normal", "100 %"), ("view.zoom-in", "A+"), ("edit.find", "Find")],
];

pub fn toolbar_ui(ui: &mut Ui, model: &Model, commands: &mut Commands) {
    ui.horizontal_wrapped(|ui| {
        ui.spacing_mut().item_spacing = egui::vec2(1.0, 2.0);
        ui.spacing_mut().button_padding = egui::vec2(5.0, 2.0);
        for (index, group) in GROUPS.iter().enumerate() {
            if index > 0 {
                ui.separator();
            }
            for (id, reads) in *group {
                if is_left_out(id, model) {
                    continue;
                }
                let zoom = format!("{} %", model.mcl.options.zoom_percent);
                let reads = if *id == "view.zoom-normal" { &zoom } else { *reads };
                button_ui(ui, id, reads, model, commands);
            }
        }
    });
}

/// What a board runs is put into its memory by Run; nothing is downloaded to it.
fn is_left_out(id: &str, model: &Model) -> bool {
    id == "device.download-mcl" && model.mcl.front().language() != Language::Mcl
}

fn button_ui(ui: &mut Ui, id: &str, reads: &str, model: &Model, commands: &mut Commands) {
    let Some(action) = actions::all().find(|action| action.id == id) else { return };
    let ready = (action.ready)(model);
    let on = action.is_on.map(|is_on| is_on(model));
    let response = ui
        .add_enabled(ready.is_ok(), Button::selectable(on.unwrap_or(false), RichText::new(reads).size(12.5)));
    let title = action.said(model);
    let name = said(&PanelMessage::Toolbar { action: title.trim_end_matches('…').to_owned() });
    response.widget_info(|| match on {
        Some(on) => WidgetInfo::selected(Role::Button, ready.is_ok(), on, &name),
        None => WidgetInfo::labeled(Role::Button, ready.is_ok(), &name),
    });
    let keys = action.keys_text(ui.ctx());
    let keys = if keys.is_empty() { keys } else { format!(" ({keys})") };
    let reported = match &ready {
        Ok(()) => format!("{title}{keys}\n{}", as_written(ui.ctx(), &action.help(model))),
        Err(why) => format!("{title}{keys}\n{why}"),
    };
    if response.clicked() {
        commands.push((action.command)(model));
    }
    response.on_hover_text(&reported).on_disabled_hover_text(reported);
}
