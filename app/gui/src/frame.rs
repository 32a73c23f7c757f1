//! How often the window draws by itself. Apart from `app`, which draws the screens that ask for it.

use std::time::Duration;

/// Time between two frames while nobody touches anything: ten a second show what ten samples a second bring.
pub const FRAME_INTERVAL: Duration = Duration::from_millis(100);
