//! What is known of rays and pixels: the side on which a judge looks answers up.

use std::collections::HashMap;
use std::sync::{Mutex, PoisonError};

use zeroset_cpu::{PreparedReference, Reference};
use zeroset_quadric::{PreparedQuadricReference, QuadricReference};
use zeroset_raycast::{
    Error, Geometry, Progress, RayBatch, Rays, Sampling, Scene, Unsupported, Work,
};

pub use zeroset_cpu::{Class, Truth};

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

impl Oracle for PreparedReference {
    fn classify(
        &self,
        rays: Rays<'_>,
        indices: &[usize],
        progress: &Progress,
    ) -> Result<Vec<Truth>, Error> {
        self.classify(rays, indices, progress)
    }
}

impl Oracle for PreparedQuadricReference {
    fn classify(
        &self,
        rays: Rays<'_>,
        indices: &[usize],
        progress: &Progress,
    ) -> Result<Vec<Truth>, Error> {
        self.classify(rays, indices, progress)
    }
}

impl<O: Oracle + ?Sized> Oracle for Box<O> {
    fn classify(
        &self,
        rays: Rays<'_>,
        indices: &[usize],
        progress: &Progress,
    ) -> Result<Vec<Truth>, Error> {
        self.as_ref().classify(rays, indices, progress)
    }
}

/// What is known of whole pixels, from 16 rays of each: 4 by 4 places, corners included.
///
/// The truth of a pixel is that of its first root on any of the rays: its bracket starts where the first
/// root, or what is undecided, may be, and ends where a root is known to be. So an answer that holds for
/// the pixel is judged as one that holds for a ray: a `proven-miss` lies if one of the rays has a root,
/// FIRST if a root lies before the bracket, and ROOT, which claims a root on every ray, if one of them has
/// none so early as the bracket's end. Of a view only.
pub struct Footprints<'a>(pub &'a dyn Oracle);

/// Where the rays of a pixel are, in each axis.
const PLACES: [f64; 4] = [0.0, 1.0 / 3.0, 2.0 / 3.0, 1.0];

impl Oracle for Footprints<'_> {
    fn classify(
        &self,
        rays: Rays<'_>,
        indices: &[usize],
        progress: &Progress,
    ) -> Result<Vec<Truth>, Error> {
        let Rays::View(view) = rays else {
            return Err(Error::Unsupported(Unsupported("a batch has no pixels".into())));
        };
        let places = PLACES.map(|v| PLACES.map(|u| [u, v]));
        let places = places.as_flattened();
        let of = |&i: &usize| {
            let (column, row) = ((i % view.width) as f64, (i / view.width) as f64);
            places.iter().map(move |[u, v]| view.ray_at(column + u, row + v))
        };
        let batch = RayBatch { rays: indices.iter().flat_map(of).collect(), range: rays.range() };
        let all: Vec<usize> = (0..batch.rays.len()).collect();
        let truths = self.0.classify(Rays::Batch(&batch), &all, progress)?;
        Ok(truths.chunks(places.len()).map(first).collect())
    }
}

/// The truth of the first root on any of some rays.
fn first(rays: &[Truth]) -> Truth {
    let mut work = Work::default();
    rays.iter().for_each(|truth| work += truth.work);
    let brackets = |classes: &[Class]| -> Vec<[f64; 2]> {
        rays.iter().filter(|t| classes.contains(&t.class)).map(|t| t.bracket).collect()
    };
    let crossed = brackets(&[Class::Transversal]);
    let rooted = brackets(&[Class::Transversal, Class::Tangential]);
    let open = brackets(&[Class::Undecidable]);
    let class = match (crossed.is_empty(), rooted.is_empty(), open.is_empty()) {
        (false, ..) => Class::Transversal,
        (true, false, _) => Class::Tangential,
        (true, true, false) => Class::Undecidable,
        (true, true, true) => Class::None,
    };
    let least = |ends: &[[f64; 2]], end: usize| {
        ends.iter().map(|ends| ends[end]).fold(f64::INFINITY, f64::min)
    };
    let from = least(&rooted, 0).min(least(&open, 0));
    let to = if rooted.is_empty() { least(&open, 1) } else { least(&rooted, 1) };
    let latest = rays.iter().map(|truth| truth.latest).fold(f64::NEG_INFINITY, f64::max);
    Truth { class, bracket: [from, to], latest, work }
}

/// The truth on what a ray stands for.
///
/// # Errors
/// If the work was asked to stop, or for the footprints of a batch.
pub fn classify(
    oracle: &dyn Oracle,
    sampling: Sampling,
    rays: Rays<'_>,
    indices: &[usize],
    progress: &Progress,
) -> Result<Vec<Truth>, Error> {
    match sampling {
        Sampling::Ray => oracle.classify(rays, indices, progress),
        Sampling::Footprint => Footprints(oracle).classify(rays, indices, progress),
    }
}

/// An oracle that answers again what it was asked before without another look: for several methods that
/// are checked on the same rays.
pub struct Remembering<O> {
    oracle: O,
    known: Mutex<HashMap<RayBits, Truth>>,
}

/// The bits of a ray and of its range.
type RayBits = ([u32; 6], [u64; 2]);

impl<O: Oracle> Remembering<O> {
    /// Nothing is known yet.
    pub fn new(oracle: O) -> Self {
        Self { oracle, known: Mutex::default() }
    }
}

impl<O: Oracle> Oracle for Remembering<O> {
    fn classify(
        &self,
        rays: Rays<'_>,
        indices: &[usize],
        progress: &Progress,
    ) -> Result<Vec<Truth>, Error> {
        let key = |i: usize| {
            let (o, d) = (rays.get(i).origin, rays.get(i).direction);
            let bits = [o.x, o.y, o.z, d.x, d.y, d.z].map(f32::to_bits);
            (bits, rays.range().map(f64::to_bits))
        };
        let known = || self.known.lock().unwrap_or_else(PoisonError::into_inner);
        let unknown: Vec<usize> = {
            let known = known();
            indices.iter().copied().filter(|&i| !known.contains_key(&key(i))).collect()
        };
        let truths = self.oracle.classify(rays, &unknown, progress)?;
        let mut known = known();
        known.extend(unknown.iter().map(|&i| key(i)).zip(truths));
        Ok(indices.iter().map(|&i| known[&key(i)]).collect())
    }
}

/// The reference for a scene, with its default knobs.
///
/// # Errors
/// If the reference cannot handle the scene.
pub fn reference(scene: &Scene) -> Result<Box<dyn Oracle>, Error> {
    Ok(match scene.geometry {
        Geometry::Patches(_) => Box::new(QuadricReference.prepare_reference(scene)?),
        _ => Box::new(Reference::default().prepare_reference(scene)?),
    })
}

/// Which rays of a request are judged.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Sample {
    /// Their indices, increasing.
    pub indices: Vec<usize>,
    /// Every how many-th: in both axes of a view, or along a batch. 1 is all.
    pub step: usize,
    /// Where the grid starts: at the first ray for 0, else at one that depends on the number.
    pub seed: u64,
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
    /// Every `step`-th ray from the first, along both axes of a view.
    ///
    /// # Panics
    /// If `step` is 0.
    pub fn every(step: usize, rays: Rays<'_>) -> Self {
        Self::grid(step, 0, rays)
    }

    /// Every `step`-th ray from one that the seed chooses. Where one step divides another, the grid of
    /// the one holds that of the other.
    fn grid(step: usize, seed: u64, rays: Rays<'_>) -> Self {
        let bits = scattered(seed);
        let from = |bits: u64| (bits % step as u64) as usize;
        let indices = match rays {
            Rays::View(view) => (from(bits & 0xffff_ffff)..view.height)
                .step_by(step)
                .flat_map(|row| {
                    let columns = (from(bits >> 32)..view.width).step_by(step);
                    columns.map(move |column| row * view.width + column)
                })
                .collect(),
            Rays::Batch(batch) => (from(bits)..batch.rays.len()).step_by(step).collect(),
        };
        Self { indices, step, seed, rays: rays.len() }
    }

    /// The sample with the greatest step, a power of two, that has at least `least` rays; all rays
    /// if there are fewer.
    pub fn coarsest(least: usize, seed: u64, rays: Rays<'_>) -> Self {
        let mut sample = Self::grid(1, seed, rays);
        loop {
            let coarser = Self::grid(2 * sample.step, seed, rays);
            if coarser.indices.len() < least.max(2) {
                return sample;
            }
            sample = coarser;
        }
    }

    /// The sample of half the step, which holds this one; `None` for all rays.
    pub fn finer(&self, rays: Rays<'_>) -> Option<Self> {
        (self.step > 1).then(|| Self::grid(self.step / 2, self.seed, rays))
    }

    /// Are all rays in it?
    pub fn is_all(&self) -> bool {
        self.indices.len() == self.rays
    }
}

/// A number's bits spread over all 64, the same each time; 0 for 0. Steps are powers of two, so that
/// the lowest bits must vary.
fn scattered(seed: u64) -> u64 {
    let x = seed.wrapping_mul(0x9e37_79b9_7f4a_7c15);
    let x = (x ^ (x >> 32)).wrapping_mul(0xd6e8_feb8_6659_fd93);
    x ^ (x >> 32)
}

impl Truths {
    /// How many rays of each class, in the order of [`Class::ALL`].
    pub fn classes(&self) -> [usize; 4] {
        Class::ALL.map(|class| self.truths.iter().filter(|t| t.class == class).count())
    }

    /// Of a view, the pixels that are clear misses: no root there, nor in any of the eight
    /// neighbours. Border pixels are not: what lies beyond is not known. `None` for batches, and
    /// where only a sample was classified.
    pub fn clear_misses(&self, rays: Rays<'_>) -> Option<Vec<usize>> {
        let Rays::View(view) = rays else { return None };
        if !self.sample.is_all() {
            return None;
        }
        let (width, height) = (view.width, view.height);
        let is_none =
            |column: usize, row: usize| self.truths[row * width + column].class == Class::None;
        let mut clear = Vec::new();
        for row in 1..height.saturating_sub(1) {
            for column in 1..width.saturating_sub(1) {
                let mut block = (row - 1..=row + 1)
                    .flat_map(|r| (column - 1..=column + 1).map(move |c| (c, r)));
                if block.all(|(c, r)| is_none(c, r)) {
                    clear.push(row * width + column);
                }
            }
        }
        Some(clear)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DVec3;
    use zeroset_raycast::{Camera, Domain, RayBatch, View, Work};

    fn view(width: usize, height: usize) -> View {
        let domain = Domain::new(DVec3::splat(-1.0), DVec3::splat(1.0)).unwrap();
        View::new(Camera::facing(&domain), width, height)
    }

    /// Says of a ray where it is in the request, and counts what it is asked.
    #[derive(Default)]
    struct Index(Mutex<usize>);

    impl Oracle for Index {
        fn classify(
            &self,
            _: Rays<'_>,
            indices: &[usize],
            _: &Progress,
        ) -> Result<Vec<Truth>, Error> {
            *self.0.lock().unwrap() += indices.len();
            let truth = |&i: &usize| Truth::new(Class::None, [i as f64; 2], Work::default());
            Ok(indices.iter().map(truth).collect())
        }
    }

    #[test]
    fn what_is_remembered_is_asked_once() {
        let oracle = Remembering::new(Index::default());
        let view = view(4, 3);
        let ask = |rays: Rays<'_>, indices: &[usize]| {
            let truths = oracle.classify(rays, indices, &Progress::new()).unwrap();
            truths.iter().map(|t| t.bracket[0] as usize).collect::<Vec<_>>()
        };
        let asked = || *oracle.oracle.0.lock().unwrap();
        assert_eq!(ask(Rays::View(&view), &[2, 5]), [2, 5]);
        assert_eq!(ask(Rays::View(&view), &[7, 5, 2, 0]), [7, 5, 2, 0]);
        assert_eq!(asked(), 4);
        // The same ray elsewhere is the same; in another range it is not.
        let rays = vec![view.ray(1, 1), view.ray(3, 2)];
        let batch = RayBatch { rays, range: Rays::View(&view).range() };
        assert_eq!(ask(Rays::Batch(&batch), &[0, 1]), [5, 1]);
        assert_eq!(asked(), 5);
        let nearer = RayBatch { range: [0.0, 1.0], ..batch };
        assert_eq!(ask(Rays::Batch(&nearer), &[0, 1]), [0, 1]);
        assert_eq!(asked(), 7);
    }

    #[test]
    fn a_pixel_has_the_first_root_of_its_rays() {
        let truth = |class, bracket| Truth::new(class, bracket, Work::default());
        let none = truth(Class::None, [f64::INFINITY; 2]);
        let of = |rays: &[Truth]| {
            let all: Vec<_> = [none].iter().chain(rays).copied().collect();
            let first = first(&all);
            assert_eq!(first.latest, f64::INFINITY, "one ray has none");
            (first.class, first.bracket)
        };
        assert_eq!(of(&[]), (Class::None, [f64::INFINITY; 2]));
        let near = truth(Class::Tangential, [1.0, 1.25]);
        let far = truth(Class::Transversal, [2.0, 2.5]);
        let open = truth(Class::Undecidable, [0.5, 3.0]);
        assert_eq!(of(&[far]), (Class::Transversal, [2.0, 2.5]));
        assert_eq!(of(&[near]), (Class::Tangential, [1.0, 1.25]));
        assert_eq!(of(&[far, near]), (Class::Transversal, [1.0, 1.25]));
        assert_eq!(of(&[open]), (Class::Undecidable, [0.5, 3.0]));
        // A root may lie where it is not decided, and surely lies where it is known.
        assert_eq!(of(&[open, far]), (Class::Transversal, [0.5, 2.5]));
        assert_eq!(of(&[open, far, near]), (Class::Transversal, [0.5, 1.25]));
        // None of the three has a root before 0.5, one has none before 2.
        assert_eq!(first(&[open, far, near]).latest, 2.0);
    }

    #[test]
    fn footprints_ask_for_sixteen_rays_a_pixel() {
        struct Right;
        impl Oracle for Right {
            /// Rays to the right of the image's middle have a root at their distance from it.
            fn classify(
                &self,
                rays: Rays<'_>,
                indices: &[usize],
                _: &Progress,
            ) -> Result<Vec<Truth>, Error> {
                let [right, _, _] = view(4, 3).camera().frame();
                let of = |&i: &usize| {
                    let t = rays.get(i).direction.as_dvec3().dot(right);
                    let class = if t > 0.01 { Class::Transversal } else { Class::None };
                    Truth::new(class, [t; 2], Work::default())
                };
                Ok(indices.iter().map(of).collect())
            }
        }
        let view = view(4, 3);
        let classify = |rays, indices: &[usize]| {
            let truths = Footprints(&Right).classify(rays, indices, &Progress::new());
            truths.map(|truths| truths.iter().map(|t| t.class).collect::<Vec<_>>())
        };
        let row = classify(Rays::View(&view), &[4, 5, 6, 7]).unwrap();
        assert_eq!(row, [Class::None, Class::None, Class::Transversal, Class::Transversal]);
        let batch = RayBatch::new(vec![view.ray(0, 0)]);
        assert!(matches!(classify(Rays::Batch(&batch), &[0]), Err(Error::Unsupported(_))));
    }

    #[test]
    fn samples_are_even_and_nested() {
        let view = view(7, 5);
        let rays = Rays::View(&view);
        assert!(Sample::every(1, rays).is_all());
        assert_eq!(Sample::every(3, rays).indices, [0, 3, 6, 21, 24, 27]);
        assert_eq!(Sample::every(1000, rays).indices, [0]);
        let coarsest = Sample::coarsest(3, 0, rays);
        assert_eq!((coarsest.step, &coarsest.indices[..]), (4, &[0, 4, 28, 32][..]));
        let finer = coarsest.finer(rays).unwrap();
        assert_eq!(finer.step, 2);
        assert!(coarsest.indices.iter().all(|i| finer.indices.contains(i)));
        assert!(finer.finer(rays).unwrap().is_all());
        assert_eq!(Sample::coarsest(1000, 0, rays).finer(rays), None);
        let batch = RayBatch::new(Vec::new());
        assert!(Sample::coarsest(64, 0, Rays::Batch(&batch)).is_all());
    }

    #[test]
    fn seeds_choose_where_samples_start() {
        let view = view(64, 48);
        let rays = Rays::View(&view);
        let mut starts = std::collections::HashSet::new();
        for seed in 0..64 {
            let mut sample = Sample::coarsest(12, seed, rays);
            assert_eq!((sample.step, sample.indices.len()), (16, 12));
            starts.insert(sample.indices[0]);
            while let Some(finer) = sample.finer(rays) {
                assert!(sample.indices.iter().all(|i| finer.indices.contains(i)), "{seed}");
                sample = finer;
            }
            assert!(sample.is_all());
        }
        assert!(starts.len() > 32 && starts.contains(&0), "{starts:?}");
        assert_eq!(Sample::coarsest(12, 0, rays), Sample::every(16, rays));
    }

    #[test]
    fn a_clear_miss_has_eight_neighbours_without_roots() {
        let view = view(6, 5);
        let rays = Rays::View(&view);
        let none = Truth::new(Class::None, [f64::INFINITY; 2], Work::default());
        let mut truths = Truths { sample: Sample::every(1, rays), truths: vec![none; 30] };
        assert_eq!(truths.clear_misses(rays).unwrap().len(), 4 * 3);
        // A root at column 1, row 1 spoils its neighbours; what is not decided spoils too.
        truths.truths[7] = Truth { class: Class::Tangential, ..none };
        truths.truths[29] = Truth { class: Class::Undecidable, ..none };
        assert_eq!(truths.clear_misses(rays).unwrap(), [9, 10, 15, 16, 19, 20, 21]);
        assert_eq!(truths.classes(), [0, 1, 28, 1]);
        truths.sample = Sample::every(2, rays);
        assert_eq!(truths.clear_misses(rays), None);
    }
}
