//! Service data objects: reading (upload) and writing (download) a node's objects, expedited and in segments (CiA 301).
//!
//! [`Request`] and [`Response`] are the eight bytes of a frame in either direction; [`Transfer`] is the client's side of one
//! access, [`Server`] the node's. All numbers are little-endian. Block transfer is answered with an abort.

mod abort;
mod client;
mod message;
mod server;
mod size;

pub use abort::Abort;
pub use client::{Progress, Transfer};
pub use message::{Request, Response};
pub use server::{Dictionary, Server};
pub use size::{EXPEDITED_BYTES, SEGMENT_BYTES};
