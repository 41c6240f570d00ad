//! The pictures by name.

use std::fmt;

use zeroset_raycast::{Hits, View};

use crate::{
    Agreement, Environment, Picture, ShadeError, agreement, certificate, depth, normals, shaded,
    steps,
};

/// What a picture shows of the hits.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum ViewKind {
    /// Unit normals.
    Normal,
    /// The surface in the light.
    #[default]
    Shaded,
    /// The distance along the ray.
    Depth,
    /// Evaluations a ray.
    Steps,
    /// What was proved.
    Certificate,
    /// Agreement with the reference.
    Error,
}

impl ViewKind {
    /// All kinds.
    pub const ALL: [Self; 6] =
        [Self::Normal, Self::Shaded, Self::Depth, Self::Steps, Self::Certificate, Self::Error];

    /// The name on the command line and in file names.
    pub fn name(self) -> &'static str {
        match self {
            Self::Normal => "normal",
            Self::Shaded => "shaded",
            Self::Depth => "depth",
            Self::Steps => "steps",
            Self::Certificate => "certificate",
            Self::Error => "error",
        }
    }

    /// The kind of that name.
    ///
    /// # Errors
    /// [`ShadeError::UnknownKind`] lists the names.
    pub fn from_name(name: &str) -> Result<Self, ShadeError> {
        Self::ALL.into_iter().find(|kind| kind.name() == name).ok_or_else(|| {
            ShadeError::UnknownKind {
                name: name.into(),
                known: Self::ALL.map(Self::name).join(", "),
            }
        })
    }

    /// Must the hits have normals?
    pub fn needs_normals(self) -> bool {
        matches!(self, Self::Normal | Self::Shaded)
    }

    /// Must there be a comparison with the reference?
    pub fn needs_reference(self) -> bool {
        self == Self::Error
    }
}

impl fmt::Display for ViewKind {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(self.name())
    }
}

/// The picture of a kind, in its default colours; `agreement` is there for [`ViewKind::Error`].
///
/// # Errors
/// If the view has no pixels, the hits are not those of the view, or the kind needs what is not
/// there: normals, or a comparison.
pub fn picture(
    kind: ViewKind,
    view: &View,
    hits: &Hits,
    agreement: Option<&[Agreement]>,
) -> Result<Picture, ShadeError> {
    match kind {
        ViewKind::Normal => normals::picture(view, hits),
        ViewKind::Shaded => shaded::picture(view, hits, &shaded::lights(view), Environment::Plain),
        ViewKind::Depth => depth::picture(view, hits),
        ViewKind::Steps => steps::picture(view, hits),
        ViewKind::Certificate => certificate::picture(view, hits),
        ViewKind::Error => agreement::picture(view, agreement.ok_or(ShadeError::NoReference)?),
    }
}

/// The pictures of a kind of several answers to one view, with the same scale for all, so that they
/// compare.
///
/// # Errors
/// As for [`picture`].
pub fn pictures(
    kind: ViewKind,
    view: &View,
    answers: &[(&Hits, Option<&[Agreement]>)],
) -> Result<Vec<Picture>, ShadeError> {
    let depths = answers.iter().filter_map(|(hits, _)| depth::range(hits)).reduce(union);
    let counts = answers.iter().map(|(hits, _)| steps::range(hits)).reduce(union);
    answers
        .iter()
        .map(|(hits, agreement)| match kind {
            ViewKind::Depth => depth::picture_within(view, hits, depths),
            ViewKind::Steps => steps::picture_within(view, hits, counts.unwrap_or_default()),
            // The other scales are fixed.
            _ => picture(kind, view, hits, *agreement),
        })
        .collect()
}

/// The least range that holds two.
fn union<T: PartialOrd>([a, b]: [T; 2], [c, d]: [T; 2]) -> [T; 2] {
    [if a < c { a } else { c }, if b > d { b } else { d }]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_lead_back_to_kinds() {
        for kind in ViewKind::ALL {
            assert_eq!(ViewKind::from_name(kind.name()).unwrap(), kind);
        }
        let message = ViewKind::from_name("shadow").unwrap_err().to_string();
        assert_eq!(
            message,
            "there is no picture \"shadow\"; there are normal, shaded, depth, steps, certificate, \
             error"
        );
    }
}
