//! The time as files write it.

/// Now, as files write it: "2026-01-05T10:00:00Z".
pub fn today() -> String {
    humantime::format_rfc3339_seconds(std::time::SystemTime::now()).to_string()
}
