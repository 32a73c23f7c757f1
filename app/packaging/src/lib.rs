//! What packages hold beside the program: its manual pages and the completions of its command line, made from the same tree of commands that the
//! program itself reads its arguments by. A crate of its own, so that the program carries none of it.

#![cfg_attr(not(test), warn(clippy::wildcard_enum_match_arm))]

pub mod pages;
