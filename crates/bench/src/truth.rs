//! What is known of rays: the side on which a judge looks answers up.

use zeroset_raycast::{Error, Progress, Rays, Scene};

/// What kind of first root a ray has.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Class {
    /// The function changes sign at the first root.
    Transversal,
    /// It touches zero without a change of sign.
    Tangential,
    /// There is no root.
    None,
    /// Not decided.
    Undecidable,
}

/// What is known of a ray.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Truth {
    /// The kind of the first root.
    pub class: Class,
    /// Holds the first root, and no root is before it; `[inf, inf]` for [`Class::None`]. For
    /// [`Class::Undecidable`] nothing before `bracket[0]` is a root, and no more is known.
    pub bracket: [f64; 2],
}

/// Where truths come from: the reference, or a closed form.
pub trait Oracle: Send + Sync {
    /// The truth for the rays at these indices, in their order.
    ///
    /// # Errors
    /// If the work was asked to stop.
    fn classify(
        &self,
        rays: Rays<'_>,
        indices: &[usize],
        progress: &Progress,
    ) -> Result<Vec<Truth>, Error>;
}

/// The reference for a scene.
///
/// # Errors
/// If the reference cannot handle the scene.
pub fn reference(scene: &Scene) -> Result<Box<dyn Oracle>, Error> {
    todo!("{scene:?}")
}

/// Which rays of a request are judged.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Sample {
    /// Their indices, increasing.
    pub indices: Vec<usize>,
    /// Every how many-th: in both axes of a view, or along a batch. 1 is all.
    pub step: usize,
    /// How many rays there are.
    pub rays: usize,
}

/// The truth for a sample of the rays.
#[derive(Clone, Debug, PartialEq)]
pub struct Truths {
    /// Which rays.
    pub sample: Sample,
    /// The truth for each of `sample.indices`.
    pub truths: Vec<Truth>,
}

impl Sample {
    /// Every `step`-th ray, along both axes of a view.
    ///
    /// # Panics
    /// If `step` is 0.
    pub fn every(step: usize, rays: Rays<'_>) -> Self {
        let indices = match rays {
            Rays::View(view) => (0..view.height)
                .step_by(step)
                .flat_map(|row| (0..view.width).step_by(step).map(move |c| row * view.width + c))
                .collect(),
            Rays::Batch(batch) => (0..batch.rays.len()).step_by(step).collect(),
        };
        Self { indices, step, rays: rays.len() }
    }

    /// Are all rays in it?
    pub fn is_all(&self) -> bool {
        self.indices.len() == self.rays
    }
}

impl Truths {
    /// How many rays of each class, in the order of [`Class::ALL`].
    pub fn classes(&self) -> [usize; 4] {
        Class::ALL.map(|class| self.truths.iter().filter(|t| t.class == class).count())
    }

    /// Of a view, how many pixels are clear misses: no root there nor in any of the eight
    /// neighbours. `None` for batches, and where only a sample was classified.
    pub fn clear_misses(&self, rays: Rays<'_>) -> Option<Vec<usize>> {
        todo!("{rays:?}")
    }
}

impl Class {
    /// All classes.
    pub const ALL: [Self; 4] = [Self::Transversal, Self::Tangential, Self::None, Self::Undecidable];

    /// The name, as printed.
    pub fn name(self) -> &'static str {
        match self {
            Self::Transversal => "transversal",
            Self::Tangential => "tangential",
            Self::None => "none",
            Self::Undecidable => "undecidable",
        }
    }
}
