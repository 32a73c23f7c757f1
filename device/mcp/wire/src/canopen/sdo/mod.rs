//! Service data objects: reading (upload) and writing (download) a node's objects, expedited and in segments (CiA 301).
//!
//! [`Request`] and [`Response`] are the eight bytes of a frame in either direction; [`Transfer`] is the client's side of one
//! access, [`Server`] the node's. All numbers are little-endian. Block transfer is answered with an abort.

mod abort;
mod client;
mod message;
mod server;

pub use abort::Abort;
pub use client::{Progress, Transfer};
pub use message::{Request, Response};
pub use server::{Dictionary, Server};

/// Bytes that fit into one frame without segments.
pub const EXPEDITED_BYTES: usize = 4;
/// Bytes of a segment.
pub const SEGMENT_BYTES: usize = 7;
