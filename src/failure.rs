//! Why a command did not do what it was asked, and the exit status for it.

use std::fmt;
use std::process::ExitCode;

use zeroset::raycast;

/// Why a command ends early.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) enum Failure {
    /// The command line is wrong: status 2.
    Usage(String),
    /// The work cannot be done: status 1.
    Work(String),
    /// The user pressed Ctrl-C: status 130.
    Interrupted,
}

impl Failure {
    /// The command line is wrong.
    pub(crate) fn usage(why: impl fmt::Display) -> Self {
        Self::Usage(why.to_string())
    }

    /// The work cannot be done.
    pub(crate) fn work(why: impl fmt::Display) -> Self {
        Self::Work(why.to_string())
    }

    /// The exit status.
    pub(crate) fn status(&self) -> ExitCode {
        ExitCode::from(match self {
            Self::Work(_) => 1,
            Self::Usage(_) => 2,
            Self::Interrupted => 130,
        })
    }
}

impl fmt::Display for Failure {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Usage(why) | Self::Work(why) => f.write_str(why),
            Self::Interrupted => f.write_str("interrupted"),
        }
    }
}

impl From<raycast::Error> for Failure {
    fn from(error: raycast::Error) -> Self {
        match error {
            raycast::Error::Interrupted => Self::Interrupted,
            raycast::Error::Parameter(_) | raycast::Error::Domain(_) => Self::usage(error),
            _ => Self::work(error),
        }
    }
}
