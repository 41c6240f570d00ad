//! The settings of beam casting.

use zeroset_cpu::{Implicit, Normals, isa, normals};
use zeroset_ia::{Isa, Rounding};
use zeroset_raycast::{
    Error, Intersector, Knob, KnobError, Method, Sampling, Scene, Unsupported, knob,
};

use crate::gpu;
use crate::prepared::PreparedBeams;

/// Which beams are cast.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Refinement {
    /// One a pixel: *Uniform* in Section III-C.
    Uniform,
    /// Those of a quadtree's cells, breadth first: *Adaptive*.
    Adaptive,
}

/// What ends the bisection of a beam's pieces.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Stop {
    /// They are thin: the tolerance.
    Thin,
    /// They are thin, or all rays of the beam are proven to meet the surface there: F is continuous, has one
    /// sign on the whole face in which the piece starts, and the other on that in which it ends.
    Seen,
}

/// The size of the first cells of the quadtree, in pixels.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Start {
    /// The largest of which the image has [`FILLING`] at least.
    Auto,
    /// A power of two.
    Size(u32),
}

/// The cells that keep a device busy. From larger ones there is next to nothing to gain, and each level costs
/// a device some tens of microseconds.
pub const FILLING: usize = 16_384;

/// The arithmetic of beams.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Arithmetic {
    /// Single precision on lanes, unless something in the domain is too large for it.
    Auto,
    /// Double precision, one beam at a time.
    Double,
    /// What a device computes, bit for bit, one beam at a time: to check it. Rounded to nearest, devices
    /// may differ.
    Device,
}

/// What encloses the function over a piece.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Enclosure {
    /// Intervals, the paper's: pieces become boxes along the axes.
    Interval,
    /// Affine forms over (u, v, t), the paper's future work, cut with intervals: a piece stays oblique.
    /// Functions with poles or partial domains, or too large for single precision, take intervals.
    Affine,
}

/// Beam casting: the methods `beam-uniform` and `beam-adaptive`.
#[derive(Clone, Debug, PartialEq)]
pub struct Beam {
    /// Which of them.
    pub refinement: Refinement,
    /// The width in t of a pixel's last pieces; twice that for cells of twice the size. Default: none, which
    /// is the width of a pixel at the centre of the domain; the paper does not say.
    pub tolerance: Option<f64>,
    /// Default: thin.
    pub stop: Stop,
    /// Default: auto.
    pub start: Start,
    /// Default: interval, the paper's.
    pub enclosure: Enclosure,
    /// Default: outward; the paper rounds to nearest.
    pub rounding: Rounding,
    /// How normals are computed. Default: by the gradient, the paper's.
    pub normals: Normals,
    /// Default: auto.
    pub arithmetic: Arithmetic,
    /// The instruction set; `None` is the widest there is.
    pub isa: Option<Isa>,
}

impl Beam {
    /// The default settings.
    pub fn new(refinement: Refinement) -> Self {
        Self {
            refinement,
            tolerance: None,
            stop: Stop::Thin,
            start: Start::Auto,
            enclosure: Enclosure::Interval,
            rounding: Rounding::Outward,
            normals: Normals::Gradient,
            arithmetic: Arithmetic::Auto,
            isa: None,
        }
    }

    /// One beam a pixel.
    pub fn uniform() -> Self {
        Self::new(Refinement::Uniform)
    }

    /// The quadtree.
    pub fn adaptive() -> Self {
        Self::new(Refinement::Adaptive)
    }

    /// Compiles itself for a scene, for those who want to know more than the answers.
    ///
    /// # Errors
    /// If the scene is unsupported, or its domain or parameters are invalid.
    pub fn prepare_beams(&self, scene: &Scene) -> Result<PreparedBeams, Error> {
        PreparedBeams::new(self, scene)
    }
}

const STOPS: [(&str, Stop); 2] = [("thin", Stop::Thin), ("seen", Stop::Seen)];
const ENCLOSURES: [(&str, Enclosure); 2] =
    [("interval", Enclosure::Interval), ("affine", Enclosure::Affine)];
const ROUNDINGS: [(&str, Rounding); 3] =
    [("outward", Rounding::Outward), ("nudged", Rounding::Nudged), ("nearest", Rounding::Nearest)];
const ARITHMETICS: [(&str, Arithmetic); 3] =
    [("auto", Arithmetic::Auto), ("double", Arithmetic::Double), ("device", Arithmetic::Device)];

impl Method for Beam {
    fn id(&self) -> &'static str {
        match self.refinement {
            Refinement::Uniform => "beam-uniform",
            Refinement::Adaptive => "beam-adaptive",
        }
    }

    fn summary(&self) -> &'static str {
        match self.refinement {
            Refinement::Uniform => "one beam a pixel, with interval arithmetic [ganacim2011]",
            Refinement::Adaptive => "beams of a quadtree, with interval arithmetic [ganacim2011]",
        }
    }

    fn supports(&self, scene: &Scene) -> Result<(), Unsupported> {
        Implicit::function(self.id(), scene)?;
        if self.arithmetic == Arithmetic::Device
            && let Ok(implicit) = Implicit::new(self.id(), scene)
        {
            gpu::check(self, &implicit)?;
        }
        Ok(())
    }

    fn prepare(&self, scene: &Scene) -> Result<Box<dyn Intersector>, Error> {
        Ok(Box::new(self.prepare_beams(scene)?))
    }

    fn knobs(&self) -> Vec<Knob> {
        let mut knobs = vec![
            Knob {
                name: "tolerance",
                value: self.tolerance.map_or("auto".into(), knob::text),
                doc: "width in t of a pixel's last pieces; auto: the width of a pixel at the domain's centre (default auto)",
            },
            Knob {
                name: "stop",
                value: knob::name(&STOPS, &self.stop),
                doc: "thin: pieces are bisected to the tolerance; seen: or until all rays of the beam are proven to hit (default thin)",
            },
            Knob {
                name: "enclosure",
                value: knob::name(&ENCLOSURES, &self.enclosure),
                doc: "interval (the paper's), or affine: forms over u, v and t, where the function is bounded (default interval)",
            },
            Knob {
                name: "rounding",
                value: knob::name(&ROUNDINGS, &self.rounding),
                doc: "outward, nudged (the same on every instruction set) or nearest (the paper's, without proofs); default outward",
            },
            normals::knob(self.normals),
            Knob {
                name: "arithmetic",
                value: knob::name(&ARITHMETICS, &self.arithmetic),
                doc: "auto (single precision where it suffices), double, or device (what a device computes), the last two one beam at a time (default auto)",
            },
            isa::knob(self.isa),
        ];
        if self.refinement == Refinement::Adaptive {
            let value = match self.start {
                Start::Auto => "auto".into(),
                Start::Size(size) => size.to_string(),
            };
            let doc = "side of the quadtree's first cells in pixels, a power of two up to 65536; auto: the largest that fill a device (default auto)";
            knobs.insert(2, Knob { name: "start", value, doc });
        }
        knobs
    }

    fn set(&mut self, name: &str, value: &str) -> Result<(), KnobError> {
        let is_auto = value.trim() == "auto";
        match name {
            "tolerance" if is_auto => self.tolerance = None,
            "tolerance" => {
                self.tolerance = Some(knob::number(name, value, [f64::MIN_POSITIVE, f64::MAX])?);
            }
            "stop" => self.stop = knob::choice(name, value, &STOPS)?,
            "start" if self.refinement == Refinement::Adaptive => {
                self.start = if is_auto { Start::Auto } else { Start::Size(read_size(value)?) };
            }
            "enclosure" => self.enclosure = knob::choice(name, value, &ENCLOSURES)?,
            "rounding" => self.rounding = knob::choice(name, value, &ROUNDINGS)?,
            "normals" => self.normals = normals::read(value)?,
            "arithmetic" => self.arithmetic = knob::choice(name, value, &ARITHMETICS)?,
            "isa" => self.isa = isa::read(value)?,
            _ => return Err(knob::unknown(self.id(), name, &self.knobs())),
        }
        Ok(())
    }

    fn for_precision(&mut self, width: f64, _: &Scene) {
        self.tolerance = Some(width);
    }

    fn sampling(&self) -> Sampling {
        Sampling::Footprint
    }

    fn boxed(&self) -> Box<dyn Method> {
        Box::new(self.clone())
    }
}

/// Reads a power of two.
fn read_size(value: &str) -> Result<u32, KnobError> {
    let size = knob::whole("start", value, [1, 1 << 16])?;
    if size.is_power_of_two() {
        return Ok(size);
    }
    Err(KnobError::Value {
        knob: "start".into(),
        value: value.into(),
        expected: "auto, or a power of two up to 65536".into(),
    })
}
