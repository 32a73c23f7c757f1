//! One request and its reply over a transport: deadlines, the 10 ms recovery, retries, statistics.
//!
//! This layer knows neither commands nor motors: a request is bytes, and whoever sends it judges the reply.

mod between;
pub mod error;
mod given_up;
mod link;
mod permit;
mod request;
pub mod statistics;
pub mod trace;
mod turnaround;
pub mod watch;

pub use between::{Bracketed, transact_between};
pub use error::{ExchangeError, Tries};
pub use link::{Exchange, RECOVERY};
pub use permit::{Permit, Reply};
pub use request::{Fault, Judgement, Outgoing, PACKET_GAP, RETRIES, Span};
pub use statistics::{Counters, LinkStatistics};
pub use trace::Traffic;
pub use turnaround::Lateness;
pub use watch::{Interruption, Unwatched, Watch};
