//! The built program, its device thread and its tuner from outside: pseudo-terminals, foreign clients, other controllers.

mod can_bus;
mod command_line;
mod command_line_data;
mod device_adversary;
mod device_safety;
mod device_thread;
mod firmware;
mod foreign_clients;
mod killed_clients;
mod mcl;
mod monitor_command;
mod motion_mind;
mod motion_mind_drivers;
mod motion_mind_foreign;
mod motion_mind_link;
mod script_command;
mod scripts;
mod settings;
mod settings_as_read;
mod settings_cut;
mod tune_command;
mod tuning;
mod tuning_mind;
mod tuning_other;
mod tuning_replay;
mod window;
