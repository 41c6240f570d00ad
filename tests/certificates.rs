//! A certificate is never wrong, and says something wherever it can.
//!
//! K-marching at 1e-4 of the domain's longest side, on every surface of the catalogue: no certificate
//! contradicts the reference; on at least 16 surfaces with mostly simple roots, 95 % of the
//! transversal hits are `proven-hit` and 95 % of the clear misses `proven-miss`; and no bracket is
//! wider than asked, or than a few units in the last place of its point's coordinates.

use zeroset_bench::{Class, Sample, Tolerance, Truths, judge, truth};
use zeroset_cpu::Bisection;
use zeroset_raycast::catalogue::Catalogue;
use zeroset_raycast::{Camera, Certificate, Hits, Method, Progress, Rays, Request, Scene, View};

/// Pixels along a side where brackets are far narrower than single precision resolves.
const FINE_SIZE: usize = 16;

/// Pixels along a side: few, for 73 surfaces in debug builds; `compare` judges whole images.
const SIZE: usize = 48;

/// What K-marching proved on a surface.
struct Proofs {
    id: String,
    lies: usize,
    /// Proven hits and transversal hits.
    hits: [usize; 2],
    /// Proven misses and clear misses.
    misses: [usize; 2],
    too_wide: usize,
}

impl Proofs {
    fn of(scene: &Scene) -> Self {
        let view = View::new(Camera::facing(&scene.domain), SIZE, SIZE);
        let rays = Rays::View(&view);
        let progress = Progress::new();
        let width = 1e-4 * scene.domain.longest_side();
        let mut method = Bisection::kmarch();
        method.for_precision(width, scene);
        let intersector = method.prepare(scene).expect("every surface is a function");
        let mut hits = Hits::new(Request::First, rays.len());
        intersector.intersect(rays, &mut hits, &progress).expect("answers");
        // The reference takes 10 ms a ray for this one; only lies are looked for then.
        let sample = Sample::every(if scene.id == "chmutov-50" { 8 } else { 1 }, rays);
        let oracle = truth::reference(scene).expect("every surface is a function");
        let truths = oracle.classify(rays, &sample.indices, &progress).expect("truths");
        let truths = Truths { sample, truths };
        let judgement = judge(rays, &hits, &truths, Tolerance::Footprint);
        let is = |i: usize, certificate| hits.certificate[i] == certificate;
        let classes = truths.sample.indices.iter().copied().zip(&truths.truths);
        let transversal: Vec<usize> = classes
            .filter(|(_, truth)| truth.class == Class::Transversal)
            .map(|(i, _)| i)
            .collect();
        let clear = truths.clear_misses(rays).unwrap_or_default();
        Self {
            id: scene.id.clone(),
            lies: judgement.lies.len(),
            hits: [
                transversal.iter().filter(|i| is(**i, Certificate::PROVEN_HIT)).count(),
                transversal.len(),
            ],
            misses: [
                clear.iter().filter(|i| is(**i, Certificate::PROVEN_MISS)).count(),
                clear.len(),
            ],
            too_wide: (0..rays.len()).filter(|&i| is_too_wide(&hits, rays, i, width)).count(),
        }
    }

    fn is_useful(&self) -> bool {
        let most = |[part, all]: [usize; 2]| 100 * part >= 95 * all;
        most(self.hits) && most(self.misses)
    }
}

/// Is a bracket wider than asked, and than eight units in the last place of its coordinates?
fn is_too_wide(hits: &Hits, rays: Rays<'_>, index: usize, width: f64) -> bool {
    let [lo, hi] = hits.bracket[index];
    if !hits.certificate[index].contains(Certificate::PROVEN_HIT) {
        return false;
    }
    let ray = rays.get(index);
    let coordinate = ray.at(hi).abs().max_element().max(ray.origin.abs().max_element().into());
    let resolution = 8.0 * f64::from(f32::EPSILON) * coordinate;
    hi - lo > width.max(resolution)
}

#[test]
fn certificates_are_true_and_useful() {
    let mut useful = Vec::new();
    for surface in Catalogue::builtin().functions() {
        let proofs = Proofs::of(&surface.scene().expect("the catalogue is well formed"));
        assert_eq!(proofs.lies, 0, "{}: certificates contradict the reference", proofs.id);
        assert_eq!(proofs.too_wide, 0, "{}: brackets wider than asked", proofs.id);
        println!("{:24} hits {:?} misses {:?}", proofs.id, proofs.hits, proofs.misses);
        if surface.simple_roots_only && proofs.is_useful() {
            useful.push(proofs.id);
        }
    }
    assert!(useful.len() >= 16, "only {} surfaces are mostly proven: {useful:?}", useful.len());
}

/// Brackets of 1e-12 of the side: there a march leaves nearly all to its finish.
#[test]
fn fine_certificates_are_true() {
    for surface in Catalogue::builtin().functions() {
        let scene = surface.scene().expect("the catalogue is well formed");
        let view = View::new(Camera::facing(&scene.domain), FINE_SIZE, FINE_SIZE);
        let rays = Rays::View(&view);
        let progress = Progress::new();
        let sample = Sample::every(if scene.id == "chmutov-50" { 8 } else { 1 }, rays);
        let oracle = truth::reference(&scene).expect("every surface is a function");
        let truths = oracle.classify(rays, &sample.indices, &progress).expect("truths");
        let truths = Truths { sample, truths };
        for mut method in [Bisection::kmarch(), Bisection::tbisect(), Bisection::mitchell()] {
            method.for_precision(1e-12 * scene.domain.longest_side(), &scene);
            let intersector = method.prepare(&scene).expect("every surface is a function");
            let mut hits = Hits::new(Request::First, rays.len());
            intersector.intersect(rays, &mut hits, &progress).expect("answers");
            let judgement = judge(rays, &hits, &truths, Tolerance::Footprint);
            assert!(
                judgement.lies.is_empty(),
                "{} {}: {:?}",
                scene.id,
                method.id(),
                judgement.lies
            );
        }
    }
}
