//! The settings of Motion Minds: the rows, and what is particular in writing and keeping them.

pub(super) mod memory;
pub(super) mod rows;
pub(super) mod steps;
