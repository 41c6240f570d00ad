//! Adaptive marching points, \[singh2010\].
//!
//! S(p(t)) is sampled along the ray from `t_s` to `t_e` until a step holds a root by the [root
//! test](RootTest); ten bisections then narrow it (Algorithm 1). Eq. 2 adapts the step: halved near
//! the surface, halved again near a silhouette, doubled far away. Nothing is proved: a pole that changes
//! sign counts as a root. By the sign test close pairs of roots and double roots are missed; by the
//! Taylor test some are found where there are none. With the knob `certify` a hit is proven where it
//! can be. What the paper leaves open follows the rule in `docs/deviations.md`.

mod march;
mod rule;

use zeroset_expr::Parameters;
use zeroset_ia::{Isa, Rounding, dispatch};
use zeroset_raycast::{
    Certificate, Certification, Certifier, Error, Hit, Hits, Intersector, Knob, KnobError, Method,
    Progress, Ray, Rays, Report, Request, Scene, Unsupported, Work, knob,
};

use crate::implicit::Implicit;
use crate::normals::{self, Normals};
use crate::{isa, tiles};
pub use march::Segment;
use march::{March, Sign, Taylor};
pub use rule::Settings;

/// Decides whether a step holds a root.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum RootTest {
    /// `S(p(t_i)) S(p(t_i+1)) < 0`: no false roots but at poles; an even number of roots is missed.
    #[default]
    Sign,
    /// Eq. 3: 0 lies between the least and the greatest of both values and of both tangents in the
    /// middle of the step. Multiple roots are found; a step without a root may pass.
    Taylor,
}

/// Does a measure change the step?
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Adaptation {
    /// As Eq. 2 has it.
    #[default]
    On,
    /// No.
    Off,
}

/// Singh and Narayanan's adaptive marching points: the methods `amp-sign` and `amp-taylor`.
///
/// `None` stands for `auto`, the value that follows from the scene by the rule in
/// `docs/deviations.md`. Lengths are in units of space, however long a ray's direction is.
#[derive(Clone, Debug, PartialEq)]
pub struct Amp {
    /// Decides whether a step holds a root.
    pub test: RootTest,
    /// b, the base step.
    pub step: Option<f64>,
    /// The value of S that counts as 1 in the thresholds and in `epsilon`.
    pub scale: Option<f64>,
    /// `tau_1`: the surface is near where |S| is at most this.
    pub tau1: Option<f64>,
    /// `tau_2`: the surface is far where |S| is more than this.
    pub tau2: Option<f64>,
    /// `tau_3`: a silhouette is near where |S| is at most `tau_1` and |grad S . D| at most this, D
    /// being the unit vector along the ray.
    pub tau3: Option<f64>,
    /// How often the isolated interval is halved. Default: 10, the paper's.
    pub bisections: u32,
    /// The surface is S = epsilon. Default: 0.
    pub epsilon: f64,
    /// The proximity measure |S|. Default: on. With both adaptations off these are the marching
    /// points of Fig. 2.
    pub distance_adaptation: Adaptation,
    /// The horizon measure |grad S . D|. Default: on.
    pub silhouette_adaptation: Adaptation,
    /// The instruction set; `None` is the widest there is. Answers do not depend on it.
    pub isa: Option<Isa>,
    /// Are hits proven where they can be? Default: off, as in the paper.
    pub certify: Certification,
}

impl Default for Amp {
    fn default() -> Self {
        Self {
            test: RootTest::Sign,
            step: None,
            scale: None,
            tau1: None,
            tau2: None,
            tau3: None,
            bisections: 10,
            epsilon: 0.0,
            distance_adaptation: Adaptation::On,
            silhouette_adaptation: Adaptation::On,
            isa: None,
            certify: Certification::Off,
        }
    }
}

impl Amp {
    /// b in a scene: as set, as published, or from the pixel footprint.
    ///
    /// # Errors
    /// If single precision does not hold the domain and the step, or a ray needs too many samples.
    pub fn step(&self, scene: &Scene) -> Result<f64, Unsupported> {
        self.supported_step(&scene.domain, scene.published_step)
    }

    /// `amp-taylor`, with the same knobs as the default, `amp-sign`.
    pub fn taylor() -> Self {
        Self { test: RootTest::Taylor, ..Self::default() }
    }
}

/// More bisections than single precision resolves.
const MAX_BISECTIONS: u32 = 64;
const ADAPTATIONS: [(&str, Adaptation); 2] = [("on", Adaptation::On), ("off", Adaptation::Off)];

impl Method for Amp {
    fn id(&self) -> &'static str {
        match self.test {
            RootTest::Sign => "amp-sign",
            RootTest::Taylor => "amp-taylor",
        }
    }

    fn summary(&self) -> &'static str {
        match self.test {
            RootTest::Sign => "adaptive marching points with the sign test [singh2010]",
            RootTest::Taylor => "adaptive marching points with the Taylor test [singh2010]",
        }
    }

    fn supports(&self, scene: &Scene) -> Result<(), Unsupported> {
        Implicit::function(self.id(), scene)?;
        self.step(scene).map(|_| ())
    }

    fn prepare(&self, scene: &Scene) -> Result<Box<dyn Intersector>, Error> {
        let implicit = Implicit::new(self.id(), scene)?;
        let published_step = scene.published_step;
        let settings = Settings::new(self, &implicit, published_step)?;
        Ok(Box::new(Prepared { method: self.clone(), implicit, published_step, settings }))
    }

    fn knobs(&self) -> Vec<Knob> {
        let auto = |x: Option<f64>| x.map_or_else(|| "auto".into(), knob::text);
        let knob = |name, value, doc| Knob { name, value, doc };
        let name = |adaptation| knob::name(&ADAPTATIONS, &adaptation);
        vec![
            knob(
                "step",
                auto(self.step),
                "b, the base step in units of space; auto (the default): the published step, or 2.5 pixels of a view of 512 rows",
            ),
            knob(
                "scale",
                auto(self.scale),
                "the value of S that counts as 1 in tau1, tau2, tau3 and epsilon; auto: the lower quartile of |S| over the domain",
            ),
            knob("tau1", auto(self.tau1), "steps are halved where |S| is at most this; auto: 1"),
            knob(
                "tau2",
                auto(self.tau2),
                "steps are doubled where |S| is more than this; auto: twice tau1",
            ),
            knob(
                "tau3",
                auto(self.tau3),
                "steps within tau1 are halved again where |grad S . D| is at most this, per unit of space; auto: half of tau1, per half the domain's longest side",
            ),
            knob(
                "bisections",
                self.bisections.to_string(),
                "halvings of the isolated interval, 0 to 64 (default 10)",
            ),
            knob("epsilon", knob::text(self.epsilon), "the surface is S = epsilon (default 0)"),
            knob(
                "distance_adaptation",
                name(self.distance_adaptation),
                "on, or off: |S| does not change the step (default on)",
            ),
            knob(
                "silhouette_adaptation",
                name(self.silhouette_adaptation),
                "on, or off: |grad S . D| does not change the step (default on)",
            ),
            isa::knob(self.isa),
            self.certify.knob(),
        ]
    }

    fn set(&mut self, knob: &str, value: &str) -> Result<(), KnobError> {
        match knob {
            "step" => self.step = positive(knob, value)?,
            "scale" => self.scale = positive(knob, value)?,
            "tau1" => self.tau1 = positive(knob, value)?,
            "tau2" => self.tau2 = positive(knob, value)?,
            "tau3" => self.tau3 = positive(knob, value)?,
            "bisections" => self.bisections = knob::whole(knob, value, [0, MAX_BISECTIONS])?,
            "epsilon" => self.epsilon = knob::number(knob, value, [-1e30, 1e30])?,
            "distance_adaptation" => {
                self.distance_adaptation = knob::choice(knob, value, &ADAPTATIONS)?;
            }
            "silhouette_adaptation" => {
                self.silhouette_adaptation = knob::choice(knob, value, &ADAPTATIONS)?;
            }
            "isa" => self.isa = isa::read(value)?,
            "certify" => self.certify = Certification::read(value)?,
            _ => return Err(knob::unknown(self.id(), knob, &self.knobs())),
        }
        Ok(())
    }

    /// Sets the bisections, never the base step: from the longest step 2b to `width`, for directions
    /// of unit length, as far as single precision resolves.
    fn for_precision(&mut self, width: f64, scene: &Scene) {
        self.bisections = self.bisections_for(width, &scene.domain, scene.published_step);
    }

    fn boxed(&self) -> Box<dyn Method> {
        Box::new(self.clone())
    }
}

/// `auto`, or a positive number.
fn positive(knob: &str, value: &str) -> Result<Option<f64>, KnobError> {
    if value.trim() == "auto" {
        return Ok(None);
    }
    match value.trim().parse::<f64>() {
        Ok(x) if x > 0.0 && x.is_finite() => Ok(Some(x)),
        _ => Err(KnobError::Value {
            knob: knob.into(),
            value: value.into(),
            expected: "auto or a number above 0".into(),
        }),
    }
}

struct Prepared {
    method: Amp,
    implicit: Implicit,
    published_step: Option<f64>,
    settings: Settings,
}

impl Intersector for Prepared {
    fn set_parameters(&mut self, values: &Parameters) -> Result<(), Error> {
        let mut implicit = self.implicit.clone();
        implicit.set_parameters(values)?;
        self.settings = Settings::new(&self.method, &implicit, self.published_step)?;
        self.implicit = implicit;
        Ok(())
    }

    fn intersect(
        &self,
        rays: Rays<'_>,
        hits: &mut Hits,
        progress: &Progress,
    ) -> Result<Report, Error> {
        let mut settings = self.settings;
        if hits.request == Request::Any && self.method.test == RootTest::Sign {
            // Whether there is a root is known once a step holds one (Section 4.2). The Taylor test
            // knows only when bisection has not refuted the step.
            settings.bisections = 0;
        }
        let cast = |tile: &[Ray]| self.cast(tile, rays.range(), &settings);
        let mut report = tiles::cast(rays, hits, progress, cast)?;
        report.work += normals::fill(&self.implicit.tape, Normals::Gradient, rays, hits);
        Ok(report)
    }
}

impl Prepared {
    /// Answers the rays of a tile.
    fn cast(&self, rays: &[Ray], range: [f64; 2], settings: &Settings) -> Vec<Hit> {
        let mut hits = vec![Hit::miss(Certificate::MISS, Work::default()); rays.len()];
        let mut segments = Vec::with_capacity(rays.len());
        for (index, ray) in rays.iter().enumerate() {
            let Some(clip) = self.implicit.domain.clip(*ray, range) else { continue };
            let segment = Segment::new(*ray, clip.outer);
            if segment.is_resolved(settings) {
                segments.push((index, segment));
            } else {
                hits[index].work.nonfinite += 1;
            }
        }
        let (tape, segments) = (&self.implicit.tape, &segments[..]);
        let isa = self.method.isa.unwrap_or_else(Isa::best);
        let found = match self.method.test {
            RootTest::Sign => {
                dispatch(isa, Rounding::Nearest, March { test: Sign, tape, settings, segments })
            }
            RootTest::Taylor => {
                dispatch(isa, Rounding::Nearest, March { test: Taylor, tape, settings, segments })
            }
        };
        for (index, hit) in found {
            hits[index] = hit;
        }
        if self.method.certify == Certification::On {
            self.certify(rays, range, &mut hits);
        }
        hits
    }

    /// Proves what can be proved of the hits: about f = 0, whatever `epsilon` is.
    fn certify(&self, rays: &[Ray], range: [f64; 2], hits: &mut [Hit]) {
        let mut certifier = Certifier::new(&self.implicit.tape);
        for (ray, hit) in rays.iter().zip(hits).filter(|(_, hit)| hit.certificate.is_hit()) {
            let clip = self.implicit.domain.clip(*ray, range).expect("a hit is in the domain");
            let slack = self.settings.slack / ray.direction.as_dvec3().length();
            certifier.certify(*ray, clip, slack, hit);
        }
    }
}
