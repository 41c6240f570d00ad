//! What ran it.

use std::fs;
use std::time::{SystemTime, UNIX_EPOCH};

use zeroset_ia::Isa;

/// The machine and its settings.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Machine {
    /// The processor's name.
    pub cpu: String,
    /// The widest instruction set for lanes; a method may have a knob for another.
    pub isa: String,
    /// The operating system, its release if known, and the architecture.
    pub os: String,
    /// Worker threads.
    pub threads: usize,
}

impl Machine {
    /// This machine, with the threads of the current pool.
    pub fn this() -> Self {
        Self {
            cpu: processor().unwrap_or_else(|| "unknown".into()),
            isa: Isa::best().name().into(),
            os: system(),
            threads: rayon::current_num_threads(),
        }
    }
}

/// The processor's name, where the system has a file or a variable that says it.
fn processor() -> Option<String> {
    let listed = fs::read_to_string("/proc/cpuinfo").ok().and_then(|text| {
        let value = |line: &str| line.split_once(':').map(|(_, value)| value.trim().to_string());
        text.lines().find(|line| line.starts_with("model name")).and_then(value)
    });
    listed.or_else(|| std::env::var("PROCESSOR_IDENTIFIER").ok())
}

fn system() -> String {
    let release = fs::read_to_string("/proc/sys/kernel/osrelease").unwrap_or_default();
    let (os, arch) = (std::env::consts::OS, std::env::consts::ARCH);
    [os, release.trim(), arch].into_iter().filter(|s| !s.is_empty()).collect::<Vec<_>>().join(" ")
}

/// The time in UTC, as `2026-01-31T12:34:56Z`.
pub(crate) fn now() -> String {
    let seconds = SystemTime::now().duration_since(UNIX_EPOCH).map_or(0, |d| d.as_secs());
    date(seconds)
}

/// The date of a number of seconds since 1970, in the Gregorian calendar.
fn date(seconds: u64) -> String {
    let is_leap = |y: u64| y.is_multiple_of(4) && (!y.is_multiple_of(100) || y.is_multiple_of(400));
    let (mut days, time) = (seconds / 86400, seconds % 86400);
    let mut year = 1970;
    while days >= 365 + u64::from(is_leap(year)) {
        days -= 365 + u64::from(is_leap(year));
        year += 1;
    }
    let february = 28 + u64::from(is_leap(year));
    let mut month = 1;
    for length in [31, february, 31, 30, 31, 30, 31, 31, 30, 31, 30, 31] {
        if days < length {
            break;
        }
        days -= length;
        month += 1;
    }
    let (hour, minute, second) = (time / 3600, time / 60 % 60, time % 60);
    format!("{year}-{month:02}-{:02}T{hour:02}:{minute:02}:{second:02}Z", days + 1)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn dates_are_gregorian() {
        assert_eq!(date(0), "1970-01-01T00:00:00Z");
        assert_eq!(date(951_782_400), "2000-02-29T00:00:00Z");
        assert_eq!(date(1_000_000_000), "2001-09-09T01:46:40Z");
        assert_eq!(date(1_735_689_599), "2024-12-31T23:59:59Z");
        assert_eq!(date(4_107_542_400), "2100-03-01T00:00:00Z");
    }

    #[test]
    fn this_machine_has_threads_and_names() {
        let machine = Machine::this();
        assert!(machine.threads >= 1);
        assert!(!machine.cpu.is_empty() && !machine.isa.is_empty());
        assert!(machine.os.contains(std::env::consts::ARCH));
    }
}
