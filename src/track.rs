//! What changes from frame to frame.

/// The most frames of an animation.
const MOST_FRAMES: usize = 100_000;

/// A quantity that moves evenly from one value to another: `NAME=FROM:TO:FRAMES`.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Track {
    /// A parameter of the equation, or `azimuth`.
    pub(crate) name: String,
    /// The value in the first frame, a constant expression.
    pub(crate) from: String,
    /// The value in the last frame, a constant expression.
    pub(crate) to: String,
    /// How many frames, at least one.
    pub(crate) frames: usize,
}

impl Track {
    /// The exact value in a frame, from + (to - from) frame/(frames - 1), as an expression.
    pub(crate) fn value(&self, frame: usize) -> String {
        let Self { from, to, frames, .. } = self;
        match frame {
            0 => from.clone(),
            _ if frame + 1 == *frames => to.clone(),
            _ => {
                let [from, to] = [from, to].map(|end| factor(end));
                format!("{from} + ({to} - {from})*{frame}/{}", frames - 1)
            }
        }
    }
}

/// A constant expression that can stand beside any operator.
fn factor(text: &str) -> String {
    let is_plain = text.chars().all(|c| c.is_ascii_digit() || c == '.');
    if is_plain { text.into() } else { format!("({text})") }
}

/// Reads `NAME=FROM:TO:FRAMES`.
pub(crate) fn track(text: &str) -> Result<Track, String> {
    const EXPECTED: &str = "give NAME=FROM:TO:FRAMES, such as w=0:1:60";
    let (name, values) = text.split_once('=').ok_or(EXPECTED)?;
    let parts: Vec<&str> = values.split(':').map(str::trim).collect();
    let &[from, to, frames] = &parts[..] else { return Err(EXPECTED.into()) };
    let name = name.trim();
    if [name, from, to].contains(&"") {
        return Err(EXPECTED.into());
    }
    match frames.parse() {
        Ok(frames @ 1..=MOST_FRAMES) => {
            Ok(Track { name: name.into(), from: from.into(), to: to.into(), frames })
        }
        _ => Err(format!("{frames:?} is no number of frames from 1 to {MOST_FRAMES}")),
    }
}

impl std::fmt::Display for Track {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let Self { name, from, to, frames } = self;
        write!(f, "{name}={from}:{to}:{frames}")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn frames_are_even_and_end_exactly() {
        let track = track(" w = -1 : 2*pi : 5 ").unwrap();
        let values: Vec<_> = (0..5).map(|i| track.value(i)).collect();
        let expected = [
            "-1",
            "(-1) + ((2*pi) - (-1))*1/4",
            "(-1) + ((2*pi) - (-1))*2/4",
            "(-1) + ((2*pi) - (-1))*3/4",
            "2*pi",
        ];
        assert_eq!(values, expected);
        assert_eq!(track.to_string(), "w=-1:2*pi:5");
        assert_eq!(super::track("a=.5:1:3").unwrap().value(1), ".5 + (1 - .5)*1/2");
        assert_eq!(super::track("a=1:2:1").unwrap().value(0), "1");
    }

    #[test]
    fn nonsense_is_refused() {
        for (text, says) in [
            ("", "NAME=FROM:TO:FRAMES"),
            ("w", "NAME=FROM:TO:FRAMES"),
            ("w=0:1", "NAME=FROM:TO:FRAMES"),
            ("w=0:1:2:3", "NAME=FROM:TO:FRAMES"),
            ("=0:1:2", "NAME=FROM:TO:FRAMES"),
            ("w=:1:2", "NAME=FROM:TO:FRAMES"),
            ("w=0:1:0", "from 1 to 100000"),
            ("w=0:1:-3", "from 1 to 100000"),
            ("w=0:1:2.5", "from 1 to 100000"),
            ("w=0:1:nan", "from 1 to 100000"),
            ("w=0:1:1000000", "from 1 to 100000"),
            ("w=0:1:", "from 1 to 100000"),
        ] {
            let error = track(text).unwrap_err();
            assert!(error.contains(says), "{text}: {error}");
        }
    }
}
