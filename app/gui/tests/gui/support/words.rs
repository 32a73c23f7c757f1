//! What is on the screen as a person reads it or has it read: names, states, and texts that are cut.

use brushwork_gui::App;
use egui::accesskit::Role;
use egui::epaint::TextShape;
use egui::{Rect, Shape};
use egui_kittest::Harness;
use egui_kittest::kittest::NodeT as _;

pub type Window = Harness<'static, Option<App>>;

/// How far a letter may stand over an edge before it is cut.
const SLACK: f32 = 2.0;

const fn acts(role: Role) -> bool {
    matches!(
        role,
        Role::Button
            | Role::CheckBox
            | Role::RadioButton
            | Role::Slider
            | Role::SpinButton
            | Role::TextInput
            | Role::MultilineTextInput
            | Role::ComboBox
            | Role::MenuItem
            | Role::MenuItemCheckBox
            | Role::ListBoxOption
            | Role::Switch
    )
}

/// Whatever can be pressed, typed into or dragged and has no name, by its role and place; and every picture without one.
pub fn without_a_name(window: &Window) -> Vec<String> {
    let nodes = window.root().children_recursive();
    let nameless = nodes.filter(|node| {
        let node = node.accesskit_node();
        let label = node.label().unwrap_or_default();
        // A picture's name is "Sketch: what it is of".
        let is_empty = label.trim().is_empty() || (node.role() == Role::Image && label.trim().ends_with(':'));
        (acts(node.role()) || node.role() == Role::Image) && !node.is_hidden() && is_empty
    });
    nameless.map(|node| format!("{:?} at {:?}", node.accesskit_node().role(), node.rect())).collect()
}

/// Whatever has a state that is not told: whether it is on, what it holds.
pub fn without_a_state(window: &Window) -> Vec<String> {
    let nodes = window.root().children_recursive();
    let silent = nodes.filter(|node| {
        let node = node.accesskit_node();
        let role = node.role();
        let is_switch =
            matches!(role, Role::CheckBox | Role::RadioButton | Role::Switch | Role::MenuItemCheckBox);
        let is_number = matches!(role, Role::Slider | Role::SpinButton);
        let is_text = matches!(role, Role::TextInput | Role::MultilineTextInput | Role::ComboBox);
        (is_switch && node.toggled().is_none())
            || (is_number && node.numeric_value().is_none())
            || (is_text && node.value().is_none())
    });
    silent
        .map(|node| format!("{:?} {:?}", node.accesskit_node().role(), node.accesskit_node().label()))
        .collect()
}

/// Texts that an edge cuts at their right or left, without an ellipsis, by what can be read of them.
pub fn cut(window: &Window) -> Vec<String> {
    let scrolling: Vec<Rect> = {
        let nodes = window.root().children_recursive();
        // What is typed into scrolls with its caret.
        let fields = nodes.filter(|node| {
            matches!(node.accesskit_node().role(), Role::TextInput | Role::MultilineTextInput)
        });
        fields.map(|node| node.rect().expand(SLACK)).collect()
    };
    let mut found = Vec::new();
    for clipped in &window.output().shapes {
        each_text(&clipped.shape, &mut |text| {
            let (seen, clip) = (text.visual_bounding_rect(), clipped.clip_rect);
            let is_in_view = clip.width() > 1.0
                && seen.width() > 0.0
                && seen.left() < clip.right() - SLACK
                && seen.right() > clip.left() + SLACK
                && seen.center().y > clip.top()
                && seen.center().y < clip.bottom();
            let is_cut = seen.right() > clip.right() + SLACK || seen.left() < clip.left() - SLACK;
            let scrolls = scrolling
                .iter()
                .any(|field| field.intersects(seen) && field.expand(SLACK).contains_rect(clip));
            if is_in_view && is_cut && !scrolls {
                let words: String = text.galley.text().chars().take(60).collect();
                found.push(format!("{words:?} at {seen:.0?} in {clip:.0?}"));
            }
        });
    }
    found
}

fn each_text(shape: &Shape, act: &mut impl FnMut(&TextShape)) {
    if let Shape::Text(text) = shape {
        act(text);
    } else if let Shape::Vec(shapes) = shape {
        shapes.iter().for_each(|shape| each_text(shape, act));
    }
}

/// What has to be in view whatever the screen and is not, of these labels.
pub fn outside(window: &Window, labels: &[&str]) -> Vec<String> {
    let view = window.ctx.content_rect().expand(0.5);
    let is_there = |label: &&&str| {
        let nodes = window.root().children_recursive();
        let mut of =
            nodes.filter(|node| node.accesskit_node().label().is_some_and(|name| name.starts_with(**label)));
        of.any(|node| view.contains_rect(node.rect()))
    };
    labels.iter().filter(|label| !is_there(label)).map(|label| format!("{label} is not in view")).collect()
}
