//! Searches in the order of their cost; one that is too coarse asks those above.

use zeroset_raycast::{Clip, Ray, Work};

/// What a search found in a range of t.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Found {
    /// There is no root that counts.
    Nothing,
    /// The first root lies here alone, and F' does not vanish there.
    Simple([f64; 2]),
    /// The first root lies here, and may be multiple, or more than one.
    Multiple([f64; 2]),
    /// The first root does not lie before this; nothing else is known.
    Stuck([f64; 2]),
}

/// Where roots count, and how narrow their enclosures shall be.
#[derive(Clone, Copy, Debug)]
pub(super) struct Goal {
    pub(super) clip: Clip,
    /// Of the pieces that the ray is cut into, at least.
    pub(super) resolution: f64,
    /// Of the bracket of a root, at most.
    pub(super) width: f64,
}

/// Where a root in a bracket lies.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Place {
    Inside,
    Outside,
    Edge,
}

impl Goal {
    pub(super) fn place(&self, [lo, hi]: [f64; 2]) -> Place {
        let Clip { outer, inner } = self.clip;
        if hi < outer[0] || outer[1] < lo {
            Place::Outside
        } else if inner.is_some_and(|inner| inner[0] <= lo && hi <= inner[1]) {
            Place::Inside
        } else {
            Place::Edge
        }
    }

    /// Is the bracket narrow enough?
    pub(super) fn is_met(&self, bracket: [f64; 2]) -> bool {
        is_within(bracket, self.width)
    }

    /// Is the piece too narrow to be cut?
    pub(super) fn is_resolved(&self, piece: [f64; 2]) -> bool {
        is_within(piece, self.resolution)
    }
}

/// Is it at most so wide, or four units in the last place?
pub(super) fn is_within([lo, hi]: [f64; 2], width: f64) -> bool {
    hi - lo <= width.max(4.0 * spacing(lo, hi))
}

/// The distance between the doubles near the larger of two.
pub(super) fn spacing(a: f64, b: f64) -> f64 {
    let t = a.abs().max(b.abs());
    t.next_up() - t
}

/// The only root in a closed piece, on which F is continuous and F' has one sign.
#[derive(Clone, Copy, Debug)]
pub(super) struct Isolated {
    pub(super) bracket: [f64; 2],
    /// Encloses F' on the bracket; does not contain 0.
    pub(super) slope: [f64; 2],
}

impl Isolated {
    /// What is found if the bracket is as it should be.
    pub(super) fn found(&self, goal: &Goal) -> Option<Found> {
        match goal.place(self.bracket) {
            Place::Outside => Some(Found::Nothing),
            Place::Inside if goal.is_met(self.bracket) => Some(Found::Simple(self.bracket)),
            _ => None,
        }
    }
}

/// A search in some arithmetic; where that is too coarse, it asks the rungs above.
pub(super) trait Rung {
    /// Turns to another ray.
    fn aim(&mut self, ray: Ray);
    /// The first root in the range. There is none before it that counts.
    fn search(&mut self, range: [f64; 2], goal: &Goal, higher: &mut Ladder<'_>) -> Found;
    /// The root with a narrower bracket.
    fn narrow(&mut self, root: Isolated, goal: &Goal, higher: &mut Ladder<'_>) -> Found;
    /// What the ray has cost.
    fn work(&self) -> Work;
}

/// Rungs in the order of their cost.
pub(super) type Ladder<'a> = [Box<dyn Rung + 'a>];

/// Asks the lowest rung, if there is one.
pub(super) fn climb(ladder: &mut Ladder<'_>, range: [f64; 2], goal: &Goal) -> Option<Found> {
    let (rung, higher) = ladder.split_first_mut()?;
    Some(rung.search(range, goal, higher))
}

/// Asks the lowest rung for a narrower bracket, if there is one.
pub(super) fn climb_with(ladder: &mut Ladder<'_>, root: Isolated, goal: &Goal) -> Found {
    match ladder.split_first_mut() {
        Some((rung, higher)) => rung.narrow(root, goal, higher),
        None => Found::Stuck(root.bracket),
    }
}
