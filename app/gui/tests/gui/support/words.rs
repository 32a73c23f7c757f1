//! What is on the screen as a person has it read: the names of what can be used.

use brushwork_gui::App;
use egui::accesskit::Role;
use egui_kittest::Harness;
use egui_kittest::kittest::NodeT as _;

pub type Window = Harness<'static, Option<App>>;

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
