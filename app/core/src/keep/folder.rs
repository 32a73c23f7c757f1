//! Where the program may keep files: the folders of the system, or the one that an environment variable names.

use std::path::PathBuf;

use directories::ProjectDirs;

/// Names a folder that is used for everything instead of the system's, as tests and portable installations do.
pub const VARIABLE: &str = "BRUSHWORK_DATA_DIR";

/// What a web page writes there is downloaded, and what is opened in it stands there.
pub const DOWNLOADS: &str = "/files";

/// Where a web page keeps everything.
pub const KEPT: &str = "/kept";

/// The folder for what the user would miss: backups, journals. `None` where the user has no home.
pub fn data() -> Option<PathBuf> {
    named().or_else(page).or_else(|| Some(dirs()?.data_local_dir().to_owned()))
}

/// The folder for what the user has chosen: window, theme, recent ports. `None` where the user has no home.
pub fn config() -> Option<PathBuf> {
    named().or_else(page).or_else(|| Some(dirs()?.config_dir().to_owned()))
}

fn named() -> Option<PathBuf> {
    std::env::var_os(VARIABLE).filter(|value| !value.is_empty()).map(PathBuf::from)
}

/// A web page has a disk of its own, in which nothing else is.
fn page() -> Option<PathBuf> {
    cfg!(target_family = "wasm").then(|| PathBuf::from(KEPT))
}

fn dirs() -> Option<ProjectDirs> {
    ProjectDirs::from("", "", "brushwork")
}
