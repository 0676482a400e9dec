//! The day of a Unix time.

use std::time::{SystemTime, UNIX_EPOCH};

/// Seconds since 1970, UTC.
pub fn now() -> u64 {
    let since = SystemTime::now().duration_since(UNIX_EPOCH);
    since.map_or(0, |since| since.as_secs())
}

/// Year, month and day, UTC (Richards, "Mapping Time", 1998, the Gregorian algorithm).
pub fn date(unix_time: u64) -> String {
    let julian_day = unix_time / 86_400 + 2_440_588;
    let f = julian_day + 1401 + (4 * julian_day + 274_277) / 146_097 * 3 / 4 - 38;
    let e = 4 * f + 3;
    let h = 5 * (e % 1461 / 4) + 2;
    let day = h % 153 / 5 + 1;
    let month = (h / 153 + 2) % 12 + 1;
    let year = e / 1461 + (14 - month) / 12 - 4716;
    format!("{year}-{month:02}-{day:02}")
}
