//! The suite passes a true method and finds every fault.

mod ball;

use ball::{Ball, Fault, Sphere};
use zeroset_bench::conformance::check_with;
use zeroset_raycast::{Error, Intersector, Knob, KnobError, Method, Scene, Unsupported};

fn failures(method: &dyn Method) -> Vec<String> {
    let scene = ball::scene();
    let failures = check_with(&Sphere::of(&scene), method, &scene);
    failures.iter().map(ToString::to_string).collect()
}

#[test]
fn a_true_method_passes() {
    assert_eq!(failures(&Ball::with(Fault::Nothing)), [""; 0]);
    // Missing roots and being off are no breach of the contract: nothing was claimed.
    assert_eq!(failures(&Ball::with(Fault::MissesSome)), [""; 0]);
}

#[test]
fn every_fault_is_found() {
    let table = [
        (Fault::FindsNothing, "most crossings are found"),
        (Fault::ProvesShifted, "certificates are true"),
        (Fault::ProvesLateHits, "certificates are true"),
        (Fault::ProvesMisses, "certificates are true"),
        (Fault::ProvesHits, "certificates are true"),
        (Fault::ReversesBrackets, "brackets are ordered and finite, misses have none"),
        (Fault::KeepsBrackets, "brackets are ordered and finite, misses have none"),
        (Fault::LeavesTheRange, "brackets are in the domain and the range"),
        (Fault::IgnoresRange, "brackets are in the domain and the range"),
        (Fault::TrustsBadRays, "what is no ray is counted and missed"),
        (Fault::LongNormals, "normals are unit vectors, or zero"),
        (Fault::NormalsInwards, "normals are along the gradient"),
        (Fault::OnIndex, "an answer depends on its ray alone"),
        (Fault::OnCount, "an answer depends on its ray alone"),
        (Fault::OnThreads, "answers do not depend on threads"),
        (Fault::OnRequest, "normals change no answer"),
        (Fault::AnyProvesMisses, "any root agrees with the first where proven"),
        (Fault::ReportsNoWork, "the report holds the work of all answers"),
        (Fault::CountsByRay, "answers do not depend on whether work is kept by ray"),
        (Fault::WorksForNothing, "the report holds the work of all answers"),
        (Fault::NeverStops, "work that is asked to stop does"),
        (Fault::TakesAnyKnob, "unknown knobs are errors"),
        (Fault::TakesAnyValue, "bad values are errors that change nothing"),
        (Fault::PrintsKnobsBadly, "a knob's value sets it again"),
        (Fault::TakesAnyParameter, "unknown parameters are errors"),
        (Fault::ParametersStick, "a refused parameter changes nothing"),
        (Fault::PreparesUnsupported, "supports and prepare agree"),
        (Fault::Shouts, "ids are in kebab-case"),
    ];
    for (fault, rule) in table {
        let failures = failures(&Ball::with(fault));
        assert!(failures.iter().any(|f| f.starts_with(rule)), "{fault:?}: {failures:#?}");
    }
}

/// A method for no scene.
#[derive(Clone, Debug)]
struct Nothing;

impl Method for Nothing {
    fn id(&self) -> &'static str {
        "nothing"
    }
    fn summary(&self) -> &'static str {
        "supports no scene"
    }
    fn supports(&self, _: &Scene) -> Result<(), Unsupported> {
        Err(Unsupported("no scene is supported".into()))
    }
    fn prepare(&self, scene: &Scene) -> Result<Box<dyn Intersector>, Error> {
        self.supports(scene)?;
        unreachable!("no scene is supported")
    }
    fn knobs(&self) -> Vec<Knob> {
        Vec::new()
    }
    fn set(&mut self, knob: &str, _: &str) -> Result<(), KnobError> {
        Err(zeroset_raycast::knob::unknown("nothing", knob, &[]))
    }
    fn for_precision(&mut self, _: f64, _: &Scene) {}
    fn boxed(&self) -> Box<dyn Method> {
        Box::new(self.clone())
    }
}

#[test]
fn unsupported_scenes_are_no_failure() {
    assert_eq!(failures(&Nothing), [""; 0]);
}
