//! The tuner against plants whose truth is known, small enough for every run of the tests.

mod absolute;
mod board_late;
mod board_table;
mod busy_host;
mod late_host;
mod laws;
mod load_change;
mod loads;
mod methods;
mod mind_guard;
mod mind_table;
mod mind_trial;
mod noisy_current;
mod other_make;
mod own_test;
mod small_faults;
mod small_table;
mod trajectory;
mod ways_out;
