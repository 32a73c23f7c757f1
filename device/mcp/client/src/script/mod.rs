//! Compiled scripts on their way into a controller (public clients, 2015-2020: commands 249 to 251), and autorun (246, 247).
//!
//! The byte code of real controllers is not public, so this project's own compiler makes images for simulated controllers alone. A
//! real one takes an image that the maker's tool compiled: what goes over the wire is the same. Starting and stopping are requests to the
//! device thread ([`Request::StartScript`](brushwork_link::device::Request::StartScript)), since they need arming.

mod autorun;
mod download;
mod image;

pub use autorun::{Autorun, MIN_AUTORUN, autorun_job, read_autorun, set_autorun};
pub use download::{CHECKSUM_KEY, Downloaded, Verified, download, download_job};
pub use image::{ImageError, Origin, ScriptImage};
