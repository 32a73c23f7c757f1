//! Motion through real command bytes: a simulated controller with its machine in virtual time.
//!
//! The frames are put together here from the manual's layouts and not with the codec of the client.

mod bench;
mod distance;
mod duty;
mod encoders;
mod limits;
mod position;
mod relay;
mod speed;
