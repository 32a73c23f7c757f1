//! The MCL compiler, its machine and its debugger, by programs and by what is said about them.

mod bounds;
mod debug;
mod debug_same;
mod events;
mod formatting;
mod images;
mod language;
mod manual;
mod mecc;
mod messages;
mod mutations;
mod precedence;
mod programs;
mod slices;
mod support;
