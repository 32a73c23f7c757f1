//! Where in the page things with a label stand, as egui tells screen readers elsewhere: for whoever tests the page from outside. Nothing is
//! gathered before it is asked for.

use std::cell::RefCell;

use egui::{Context, FullOutput, Plugin};
use serde_json::{Value, json};

thread_local! {
    static FOUND: RefCell<Vec<Value>> = const { RefCell::new(Vec::new()) };
}

/// Takes the labels out of each frame.
pub struct Labels;

impl Plugin for Labels {
    fn debug_name(&self) -> &'static str {
        "labels"
    }

    fn output_hook(&mut self, _ctx: &Context, output: &mut FullOutput) {
        let Some(update) = output.platform_output.accesskit_update.take() else { return };
        let found = update.nodes.iter().filter_map(|(_, node)| {
            let (label, bounds) = (node.label().or(node.value())?, node.bounds()?);
            Some(json!({
                "label": label,
                "role": format!("{:?}", node.role()),
                "enabled": !node.is_disabled(),
                "x": f64::midpoint(bounds.x0, bounds.x1),
                "y": f64::midpoint(bounds.y0, bounds.y1),
            }))
        });
        FOUND.with(|list| list.replace(found.collect()));
    }
}

/// What the last frame had, in JSON; it is gathered from now on.
pub fn found(ctx: &Context) -> String {
    ctx.enable_accesskit();
    ctx.request_repaint();
    FOUND.with(|list| Value::Array(list.borrow().clone()).to_string())
}
