//! Commands of the program that need no other program beside it.

#[path = "../../gui/tests/gui/support/causes.rs"]
#[allow(dead_code, reason = "each suite uses its own part of this")]
mod causes;
mod cli;
mod cli_as_read;
mod cli_backups;
mod cli_bench;
mod cli_can;
mod cli_drive;
mod cli_ends;
mod cli_files;
mod cli_firmware;
mod cli_mecc;
mod cli_profiles;
mod cli_settings;
mod cli_several;
mod diagnosis;
mod motorvator;
mod motorvator_sim;
mod suprmotr;
mod suprmotr_macros;
mod suprmotr_sim;
#[path = "../../gui/tests/gui/support/wait.rs"]
#[allow(dead_code, reason = "each suite uses its own part of this")]
mod wait;
