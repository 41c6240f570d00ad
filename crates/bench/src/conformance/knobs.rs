//! Names, knobs and parameters.

use zeroset_expr::Parameters;
use zeroset_raycast::{Intersector, KnobError, Rays, Request};

use super::suite::Suite;

const NO_KNOB: &str = "no-such-knob";
const NO_PARAMETER: &str = "no_such_parameter";

impl Suite<'_> {
    pub(super) fn check_names(&mut self) {
        let is_kebab = |name: &str| {
            name.split('-').all(|word| {
                let is_plain = |b: u8| b.is_ascii_lowercase() || b.is_ascii_digit();
                !word.is_empty() && word.bytes().all(is_plain)
            })
        };
        let id = self.method.id();
        if !is_kebab(id) {
            self.fail("ids are in kebab-case", format!("{id:?}"));
        }
        let summary = self.method.summary();
        if summary.trim().is_empty() || summary.contains('\n') {
            self.fail("a summary is one line", format!("{summary:?}"));
        }
        if self.method.boxed().id() != id {
            self.fail("a copy is the same method", self.method.boxed().id());
        }
    }

    pub(super) fn check_knobs(&mut self) {
        let mut copy = self.method.boxed();
        let knobs = self.method.knobs();
        if copy.knobs() != knobs {
            self.fail("a copy has the same knobs", format!("{:?}", copy.knobs()));
        }
        match copy.set(NO_KNOB, "1") {
            Err(KnobError::Unknown { .. }) => {}
            other => self.fail("unknown knobs are errors", format!("{NO_KNOB}: {other:?}")),
        }
        for knob in &knobs {
            let place = format!("{}={}", knob.name, knob.value);
            if knob.doc.trim().is_empty() {
                self.fail("knobs are documented", knob.name);
            }
            if let Err(error) = copy.set(knob.name, &knob.value) {
                self.fail("a knob's value sets it again", format!("{place}: {error}"));
            }
            if copy.knobs() != knobs {
                self.fail("a knob's value sets it again", format!("{place}: {:?}", copy.knobs()));
                copy = self.method.boxed();
            }
            match copy.set(knob.name, "\u{1}no value") {
                Err(KnobError::Value { .. }) if copy.knobs() == knobs => {}
                other => {
                    let detail = format!("{place}: {other:?}, then {:?}", copy.knobs());
                    self.fail("bad values are errors that change nothing", detail);
                    copy = self.method.boxed();
                }
            }
        }
    }

    /// Unknown parameters are errors, after which the old values stay.
    pub(super) fn check_parameters(&mut self, intersector: &mut dyn Intersector) {
        let view = self.view();
        let rays = Rays::View(&view);
        let Some(before) = self.ask(intersector, rays, Request::First) else { return };
        let mut wrong = self.scene.parameters.clone();
        wrong.set(NO_PARAMETER, "1");
        if intersector.set_parameters(&wrong).is_ok() {
            self.fail("unknown parameters are errors", NO_PARAMETER);
        }
        self.expect_same("a refused parameter changes nothing", intersector, &before);
        let same: Parameters = self.scene.parameters.clone();
        if let Err(error) = intersector.set_parameters(&same) {
            self.fail("the scene's parameters can be set again", error.to_string());
        }
        self.expect_same("equal parameters give equal answers", intersector, &before);
    }
}
