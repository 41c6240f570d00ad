//! Comparing methods tells the true from the wrong and the lying, and counts right.

mod ball;

use std::time::Duration;

use ball::{Ball, Fault, Sphere};
use zeroset_bench::compare::compare_with;
use zeroset_bench::{
    Class, Comparison, Context, Lie, Machine, Options, Outcome, Record, Stage, Tally, Tolerance,
    Verdict, record,
};
use zeroset_raycast::{Camera, Certificate, Method, Progress, RayBatch, Rays, Request, View};

const SIZE: usize = 48;

fn view() -> View {
    View::new(Camera::facing(&ball::scene().domain), SIZE, SIZE)
}

fn compare_all(methods: &[Box<dyn Method>], options: &Options) -> Comparison {
    let scene = ball::scene();
    let oracle = Sphere::of(&scene);
    let view = view();
    let progress = Progress::new();
    compare_with(&oracle, &scene, Rays::View(&view), methods, options, &progress, &mut |_, _| {})
}

fn outcome(fault: Fault) -> Outcome {
    let mut comparison = compare_all(&[Ball::boxed_with(fault)], &Options::default());
    comparison.runs.pop().unwrap().outcome.unwrap()
}

fn tally(outcome: &Outcome) -> &Tally {
    &outcome.judgement.as_ref().unwrap().tally
}

#[test]
fn a_true_method_is_right_everywhere() {
    let outcome = outcome(Fault::Nothing);
    let tally = tally(&outcome);
    assert_eq!(tally.judged, SIZE * SIZE);
    let hits = tally.count(Verdict::CorrectHit);
    // The silhouette's radius is 8.75 pixels.
    assert!((225..260).contains(&hits), "{hits}");
    assert_eq!(hits, tally.class(Class::Transversal));
    assert_eq!(hits, outcome.certificates[0]);
    assert_eq!(tally.count(Verdict::CorrectMiss), tally.class(Class::None));
    assert_eq!(hits + tally.class(Class::None), SIZE * SIZE);
    assert_eq!((tally.lies, tally.clear_false_hits), (0, Some(0)));
    let clear = tally.clear_misses.unwrap();
    assert!(clear > 200 && clear < tally.class(Class::None), "{clear}");
    assert_eq!((tally.median_dt, tally.worst_dt), (Some(0.0), Some(0.0)));
    assert_eq!(outcome.work.points as usize, SIZE * SIZE);
    let times = outcome.times.unwrap();
    assert_eq!(times.runs, 5);
    assert!(times.min <= times.median && times.median <= times.max);
    assert!(times.mrays_per_second(SIZE * SIZE) > 0.0);
}

#[test]
fn missed_pixels_are_false_misses_and_no_lies() {
    let outcome = outcome(Fault::MissesSome);
    let tally = tally(&outcome);
    let missed = tally.count(Verdict::FalseMiss);
    assert!(missed > 50, "{missed}");
    assert_eq!(missed, tally.count_in(Class::Transversal, Verdict::FalseMiss));
    assert_eq!(missed + tally.count(Verdict::CorrectHit), tally.class(Class::Transversal));
    assert_eq!(tally.lies, 0);
}

#[test]
fn shifts_are_measured_and_judged_by_the_footprint() {
    // The footprint at the sphere, 6.6 to 7.6 away, is about 0.1.
    let near = outcome(Fault::Shifts(0.01));
    let hits = tally(&near).class(Class::Transversal);
    assert_eq!(tally(&near).count(Verdict::CorrectHit), hits);
    let far = outcome(Fault::Shifts(0.2));
    assert_eq!(tally(&far).count(Verdict::WrongSheet), hits);
    for (outcome, shift) in [(&near, 0.01), (&far, 0.2)] {
        // Directions are unit vectors to seven digits.
        for dt in [tally(outcome).median_dt, tally(outcome).worst_dt] {
            assert!((dt.unwrap() - shift).abs() < 1e-6 * shift, "{dt:?}");
        }
        assert_eq!(tally(outcome).lies, 0);
    }
    let options = Options { tolerance: Some(Tolerance::Distance(0.3)), ..Options::default() };
    let comparison = compare_all(&[Ball::boxed_with(Fault::Shifts(0.2))], &options);
    let outcome = comparison.runs[0].outcome.as_ref().unwrap();
    assert_eq!(tally(outcome).count(Verdict::CorrectHit), hits);
}

#[test]
fn lies_are_told_apart() {
    for (fault, kind) in [
        (Fault::ProvesMisses, Lie::RootMissed),
        (Fault::ProvesLateHits, Lie::RootBefore),
        (Fault::ProvesShifted, Lie::NoRoot),
        (Fault::ProvesHits, Lie::NoRoot),
    ] {
        let outcome = outcome(fault);
        let judgement = outcome.judgement.unwrap();
        assert!(judgement.lies.len() > 50, "{fault:?}");
        assert!(judgement.lies.iter().all(|(_, lie)| *lie == kind), "{fault:?}");
        assert_eq!(judgement.tally.lies, judgement.lies.len());
        for (index, _) in judgement.lies {
            assert!(outcome.hits.certificate[index] != Certificate::HIT);
        }
    }
}

#[test]
fn hits_in_clear_misses_are_counted() {
    let outcome = outcome(Fault::ProvesHits);
    let tally = tally(&outcome);
    assert_eq!(tally.count(Verdict::FalseHit), tally.lies);
    let clear = tally.clear_false_hits.unwrap();
    assert!(clear > 0 && clear < tally.lies && clear <= tally.clear_misses.unwrap());
}

#[test]
fn a_slow_oracle_judges_an_even_sample() {
    let scene = ball::scene();
    let view = view();
    let oracle = Sphere { pause: Duration::from_micros(200), ..Sphere::of(&scene) };
    let judging = Duration::from_millis(60);
    let options = Options { judging, seed: 5, runs: 1, ..Options::default() };
    let methods = [Ball::boxed_with(Fault::Nothing)];
    let progress = Progress::new();
    let rays = Rays::View(&view);
    let comparison =
        compare_with(&oracle, &scene, rays, &methods, &options, &progress, &mut |_, _| {});
    let sample = &comparison.truths.as_ref().unwrap().sample;
    // A sixteenth of 2304 rays takes 29 ms, a quarter would take 115.
    assert_eq!((sample.step, sample.seed), (4, 5));
    let tally = tally(comparison.runs[0].outcome.as_ref().unwrap());
    assert_eq!((tally.judged, sample.indices.len()), (144, 144));
    assert_eq!((tally.clear_misses, tally.lies), (None, 0));
    let verdicts =
        &comparison.runs[0].outcome.as_ref().unwrap().judgement.as_ref().unwrap().verdict;
    let unsampled = verdicts.iter().filter(|v| **v == Verdict::NotSampled).count();
    assert_eq!(unsampled, SIZE * SIZE - tally.judged);
}

#[test]
fn interruption_keeps_what_is_finished() {
    let scene = ball::scene();
    let view = view();
    let oracle = Sphere::of(&scene);
    let methods = [Fault::Nothing, Fault::MissesSome, Fault::Nothing].map(Ball::boxed_with);
    let progress = Progress::new();
    let mut prepared = 0;
    let mut stages = Vec::new();
    let mut watch = |stage, fraction: f64| {
        assert!((0.0..=1.0).contains(&fraction));
        stages.push(stage);
        if let Stage::Prepare(_) = stage {
            prepared += 1;
            if prepared == 2 {
                progress.stop();
            }
        }
    };
    let rays = Rays::View(&view);
    let options = Options::default();
    let comparison = compare_with(&oracle, &scene, rays, &methods, &options, &progress, &mut watch);
    assert!(comparison.interrupted);
    assert_eq!(comparison.runs.len(), 1);
    assert_eq!(comparison.runs[0].outcome.as_ref().unwrap().times.unwrap().runs, 5);
    let first = [Stage::Classify, Stage::Prepare("ball"), Stage::Answer("ball")];
    stages.dedup();
    assert_eq!(stages[..3], first);
    assert_eq!(stages[3], Stage::Time("ball"));
}

#[test]
fn an_interrupted_oracle_leaves_no_truths() {
    let scene = ball::scene();
    let view = view();
    let progress = Progress::new();
    progress.stop();
    let oracle = Sphere::of(&scene);
    let methods = [Ball::boxed_with(Fault::Nothing)];
    let options = Options::default();
    let rays = Rays::View(&view);
    let comparison =
        compare_with(&oracle, &scene, rays, &methods, &options, &progress, &mut |_, _| {});
    assert!(comparison.interrupted && comparison.truths.is_none());
    assert!(comparison.runs.is_empty());
}

#[test]
fn any_root_is_timed_and_not_judged() {
    let options = Options { request: Request::Any, runs: 2, ..Options::default() };
    let comparison = compare_all(&[Ball::boxed_with(Fault::Nothing)], &options);
    let outcome = comparison.runs[0].outcome.as_ref().unwrap();
    assert!(comparison.truths.is_none() && outcome.judgement.is_none());
    assert_eq!(outcome.times.unwrap().runs, 2);
    assert!(outcome.hit_count() > 225);
}

#[test]
fn batches_are_judged_by_the_domain() {
    let scene = ball::scene();
    // Half the speed: t counts half units.
    let rays = ball::rays().map(|r| zeroset_raycast::Ray::new(r.origin, 0.5 * r.direction));
    let batch = RayBatch::new(rays.to_vec());
    let oracle = Sphere::of(&scene);
    let methods = [0.0, 0.004, 0.008].map(|shift| Ball::boxed_with(Fault::Shifts(shift)));
    let options = Options { runs: 0, ..Options::default() };
    let progress = Progress::new();
    let rays = Rays::Batch(&batch);
    let comparison =
        compare_with(&oracle, &scene, rays, &methods, &options, &progress, &mut |_, _| {});
    // The tolerance is 0.003: the box is 3 wide.
    let verdicts: Vec<_> = comparison
        .runs
        .iter()
        .map(|run| run.outcome.as_ref().unwrap().judgement.as_ref().unwrap().verdict.clone())
        .collect();
    let right = vec![Verdict::CorrectHit, Verdict::CorrectMiss];
    let wrong = vec![Verdict::WrongSheet, Verdict::CorrectMiss];
    assert_eq!(verdicts, [right.clone(), right, wrong]);
    assert!(comparison.runs[0].outcome.as_ref().unwrap().times.is_none());
}

#[test]
fn a_comparison_becomes_records_that_read_back() {
    let scene = ball::scene();
    let view = view();
    let methods = [Fault::Nothing, Fault::ProvesMisses].map(Ball::boxed_with);
    let comparison = compare_all(&methods, &Options::default());
    let context = Context {
        equation: "x^2 + y^2 + z^2 - 1".into(),
        precision: Some(1e-3),
        revision: "abc".into(),
    };
    let rays = Rays::View(&view);
    let records = Record::of(&comparison, &scene, rays, &Machine::this(), &context);
    assert_eq!(records.len(), 2);
    let [first, second] = &records[..] else { unreachable!() };
    assert_eq!((first.method.as_str(), first.knobs.as_str()), ("ball", "depth=10"));
    assert_eq!(first.outcome, "ok");
    assert_eq!((first.lies, first.false_misses_transversal), (0, 0));
    assert_eq!(first.correct_hits, first.proven_hit);
    assert_eq!(first.judged, SIZE * SIZE);
    assert_eq!(first.transversal + first.rootless, SIZE * SIZE);
    assert_eq!(second.lies, second.false_misses_transversal);
    assert!(second.lies > 0);
    assert_eq!(first.view(), Some(view));
    assert_eq!(first.domain(), Some(scene.domain));
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("runs.csv");
    record::append(&path, &records).unwrap();
    assert_eq!(record::read(&path).unwrap(), records);
}

#[test]
fn failed_methods_are_records_too() {
    let method = Ball::boxed_with(Fault::Nothing);
    let mut comparison = compare_all(&[method], &Options::default());
    let why = zeroset_raycast::Unsupported("no scene is supported".into());
    comparison.runs[0].outcome = Err(why.into());
    let scene = ball::scene();
    let view = view();
    let rays = Rays::View(&view);
    let records = Record::of(&comparison, &scene, rays, &Machine::this(), &Context::default());
    assert_eq!(records[0].outcome, "no scene is supported");
    assert_eq!((records[0].judged, records[0].judged_step, records[0].median_ms), (0, 0, None));
}
