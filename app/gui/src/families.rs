//! Names the families of controllers that the window has, to every part of it that keeps a list of them.

use brushwork_script::language::Language;

use super::screens::face::Window;
use super::{actions, family, screens};

/// Names the families that the window has, the one that is shown before anything was connected at the head. Only the first list counts as
/// the program's, so that tests of one process can all name theirs.
pub fn install(windows: &[&'static dyn Window]) {
    Language::bring(windows.iter().filter_map(|window| window.grammar()).collect());
    family::install(windows.iter().map(|window| *window as _).collect());
    screens::face::install(windows);
    actions::install(windows.iter().flat_map(|window| window.actions()).collect());
}
