//! Why bytes are no program of this version of the format.

/// The version of the format.
pub const VERSION: u16 = 1;

/// Why bytes are no program.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum ImageError {
    /// The first bytes are not those of an image.
    #[error("this is no MCL image of Brushwork: the header is missing")]
    NotAnImage,
    /// The header names another version.
    #[error("the image has format version {0}, this program reads version {VERSION}")]
    OtherVersion(u16),
    /// There are fewer bytes than the header says.
    #[error("the image is cut off: {has} of {wants} bytes are there")]
    Cut {
        /// Bytes that are there.
        has: usize,
        /// Bytes that the header promises.
        wants: usize,
    },
    /// The checksum is wrong.
    #[error("the image is damaged: its checksum does not fit")]
    Damaged,
    /// The checksum is right and the content makes no program.
    #[error("the image makes no program: {0}")]
    Malformed(&'static str),
}
