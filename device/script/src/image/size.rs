//! What a program takes of a controller: as an image, and in memory.

use super::{code_bytes, encode};
use crate::program::{Program, Size};

impl Program {
    /// What it takes of a controller.
    #[must_use]
    pub fn size(&self) -> Size {
        Size {
            instructions: self.ops.len(),
            code_bytes: code_bytes(self),
            data_bytes: self.data.len(),
            ram_bytes: self.ram_bytes,
            image_bytes: encode(self).len(),
        }
    }
}
