//! The time as files write it.

use brushwork_link::clock;

/// Now, as files write it: "2026-01-05T10:00:00Z".
pub fn today() -> String {
    humantime::format_rfc3339_seconds(clock::today()).to_string()
}
