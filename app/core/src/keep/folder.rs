//! Where the program may keep files: the folders of the system, or the one that an environment variable names.

use std::path::PathBuf;

use directories::ProjectDirs;

/// Names a folder that is used for everything instead of the system's, as tests and portable installations do.
pub const VARIABLE: &str = "BRUSHWORK_DATA_DIR";

/// The folder for what the user would miss: backups, journals. `None` where the user has no home.
pub fn data() -> Option<PathBuf> {
    named().or_else(|| Some(dirs()?.data_local_dir().to_owned()))
}

/// The folder for what the user has chosen: window, theme, recent ports. `None` where the user has no home.
pub fn config() -> Option<PathBuf> {
    named().or_else(|| Some(dirs()?.config_dir().to_owned()))
}

fn named() -> Option<PathBuf> {
    std::env::var_os(VARIABLE).filter(|value| !value.is_empty()).map(PathBuf::from)
}

fn dirs() -> Option<ProjectDirs> {
    ProjectDirs::from("", "", "brushwork")
}
