//! Every method of the registry agrees with the reference, on every surface of the catalogue.
//!
//! On a small view and on rays that find faults: no certificate contradicts the reference; methods that
//! search whole rays miss no transversal hit; and an answer depends on its ray alone. Methods that can
//! certify their hits are asked a second time, to do so: most hits of the view are then proven. Methods that
//! answer for pixels are judged by 16 rays of each.

mod rays;

use zeroset_bench::{Class, Footprints, Oracle, Registry, Sample, Tolerance, Truths, judge, truth};
use zeroset_expr::Parameters;
use zeroset_raycast::catalogue::{Catalogue, Surface};
use zeroset_raycast::{
    Camera, Certificate, Geometry, Hit, Hits, Intersector, Progress, RayBatch, Rays, Request,
    Sampling, View,
};

/// Pixels along a side of the view.
const SIZE: usize = 16;

/// The methods that look at every part of a ray.
const SEARCHERS: [&str; 7] =
    ["kmarch", "tbisect", "mitchell", "tbisect-gpu", "beam-uniform", "beam-adaptive", "reference"];

fn ask(intersector: &dyn Intersector, rays: Rays<'_>) -> Hits {
    let mut hits = Hits::new(Request::First, rays.len());
    intersector.intersect(rays, &mut hits, &Progress::new()).expect("every ray is answered");
    hits
}

fn truths(oracle: &dyn Oracle, rays: Rays<'_>) -> Truths {
    let sample = Sample::every(1, rays);
    let truths = oracle.classify(rays, &sample.indices, &Progress::new()).expect("truths");
    Truths { sample, truths }
}

/// What a method did on some rays.
#[derive(Default)]
struct Tally {
    faults: Vec<String>,
    rays: usize,
    decided: usize,
    crossings: usize,
    /// Hits of methods that certify, and those of them that are proven.
    certified: [usize; 2],
}

impl Tally {
    fn fault(&mut self, place: &str, what: impl std::fmt::Display) {
        self.faults.push(format!("{place}: {what}"));
    }

    /// The claims of the answers, and what they miss.
    fn judge(&mut self, place: &str, rays: Rays<'_>, hits: &Hits, truths: &Truths, finds: bool) {
        for (i, lie) in judge(rays, hits, truths, Tolerance::Distance(f64::INFINITY)).lies {
            let (ray, hit, truth) = (rays.get(i), hits.get(i), truths.truths[i]);
            self.fault(place, format!("{lie}: {ray:?} {hit:?} {truth:?}"));
        }
        for (i, truth) in truths.truths.iter().enumerate() {
            let is_crossed = truth.class == Class::Transversal;
            if finds && is_crossed && !hits.certificate[i].is_hit() {
                let (ray, hit) = (rays.get(i), hits.get(i));
                self.fault(place, format!("missed: {ray:?} {hit:?} {truth:?}"));
            }
            self.rays += 1;
            self.crossings += usize::from(is_crossed);
            self.decided += usize::from(truth.class != Class::Undecidable);
        }
    }

    /// The same answers in another order, and one by one.
    fn regroup(&mut self, place: &str, intersector: &dyn Intersector, rays: Rays<'_>, hits: &Hits) {
        let answer = |hit: Hit| (hit.bracket.map(f64::to_bits), hit.certificate);
        // Indices without pattern.
        let mut order: Vec<usize> = (0..rays.len()).collect();
        order.sort_by_key(|&i| (i as u64).wrapping_mul(0x9e37_79b9_7f4a_7c15) >> 20);
        let singles = order.iter().step_by(17).map(|&i| vec![i]);
        for group in singles.chain([order.clone()]) {
            let some = group.iter().map(|&i| rays.get(i)).collect();
            let batch = RayBatch { rays: some, range: rays.range() };
            let again = ask(intersector, Rays::Batch(&batch));
            for (k, &i) in group.iter().enumerate() {
                let (a, b) = (hits.get(i), again.get(k));
                if answer(a) != answer(b) {
                    let of = group.len();
                    self.fault(place, format!("{:?}: {a:?}, in {of}: {b:?}", rays.get(i)));
                }
            }
        }
    }
}

fn check(surface: &Surface, registry: &Registry) -> Tally {
    let scene = surface.scene().expect("the catalogue is well formed");
    let Geometry::Implicit(function) = &scene.geometry else { panic!("{}: no function", scene.id) };
    let tape = function.tape(&Parameters::default(), 128).expect("defaults are values");
    let oracle = truth::reference(&scene).expect("every surface is a function");
    // The reference takes 10 ms a ray for this one.
    let (size, most) = if scene.id == "chmutov-50" { (4, 64) } else { (SIZE, usize::MAX) };
    let view = View::new(Camera::facing(&scene.domain), size, size);
    let seen = truths(&oracle, Rays::View(&view));
    let mut hard = rays::adversaries(surface, &scene, &tape, Rays::View(&view), &seen);
    let step = hard.len().div_ceil(most).max(1);
    hard = hard.into_iter().step_by(step).collect();
    let batch = RayBatch::new(hard);
    let known = truths(&oracle, Rays::Batch(&batch));
    // Sixteen rays a pixel.
    let coarse = View::new(view.camera(), size / 2, size / 2);
    let pixels = truths(&Footprints(&oracle), Rays::View(&coarse));

    let mut tally = Tally::default();
    let mut of_pixels: Vec<(&str, Hits)> = Vec::new();
    let certified = registry.certified();
    let all = registry.iter().chain(certified.iter().map(AsRef::as_ref));
    for (k, method) in all.enumerate().filter(|(_, method)| method.supports(&scene).is_ok()) {
        let intersector = method.prepare(&scene).expect("what is supported can be prepared");
        let finds = SEARCHERS.contains(&method.id());
        let certifies = k >= registry.iter().count();
        if method.sampling() == Sampling::Footprint {
            let place = format!("{} on {}", method.id(), scene.id);
            let hits = ask(intersector.as_ref(), Rays::View(&coarse));
            tally.judge(&place, Rays::View(&coarse), &hits, &pixels, finds);
            of_pixels.push((method.id(), hits));
            continue;
        }
        for (rays, truths) in [(Rays::View(&view), &seen), (Rays::Batch(&batch), &known)] {
            let place = format!("{} on {}", method.id(), scene.id);
            let hits = ask(intersector.as_ref(), rays);
            tally.judge(&place, rays, &hits, truths, finds);
            tally.regroup(&place, intersector.as_ref(), rays, &hits);
            for certificate in hits.certificate.iter().filter(|c| certifies && c.is_hit()) {
                tally.certified[0] += 1;
                tally.certified[1] += usize::from(certificate.contains(Certificate::ROOT));
            }
        }
    }
    // Whether a pixel is hit may differ only where none of its rays is known to hit.
    for (i, truth) in pixels.truths.iter().enumerate() {
        let is_rooted = [Class::Transversal, Class::Tangential].contains(&truth.class);
        let found = of_pixels.iter().filter(|(_, hits)| hits.certificate[i].is_hit()).count();
        if is_rooted && found != 0 && found != of_pixels.len() {
            let ids: Vec<_> = of_pixels.iter().map(|(id, hits)| (id, hits.get(i))).collect();
            tally.fault(&scene.id, format!("pixel {i}, {truth:?}: {ids:?}"));
        }
    }
    tally
}

#[test]
fn methods_agree_with_the_reference() {
    let registry = Registry::standard();
    assert!(SEARCHERS.iter().all(|id| registry.ids().contains(id)));
    let mut total = Tally::default();
    for surface in Catalogue::builtin().functions() {
        let tally = check(surface, &registry);
        total.rays += tally.rays;
        total.decided += tally.decided;
        total.crossings += tally.crossings;
        total.certified = [0, 1].map(|i| total.certified[i] + tally.certified[i]);
        total.faults.extend(tally.faults);
    }
    let Tally { faults, rays, decided, crossings, certified: [hits, proven] } = total;
    assert!(
        faults.is_empty(),
        "{} faults:\n{}",
        faults.len(),
        faults[..faults.len().min(40)].join("\n")
    );
    println!(
        "{rays} answers, {decided} decided, {crossings} crossings; {proven} of {hits} certified"
    );
    assert!(100 * decided > 95 * rays, "{decided} of {rays} answers could be judged");
    assert!(4 * crossings > rays, "{crossings} of {rays} rays cross a surface");
    assert!(4 * proven > 3 * hits, "{proven} of {hits} hits could be certified");
}
