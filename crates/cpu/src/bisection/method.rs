//! The settings of bisection.

use zeroset_ia::Rounding;
use zeroset_ia::{Isa, Register};
use zeroset_raycast::{Error, Intersector, Knob, KnobError, Method, Scene, Unsupported, knob};

use super::march::MAX_DEPTH;
use super::prepared::Prepared;
use crate::implicit::Implicit;
use crate::isa;
use crate::normals::{self, Normals};

/// Where rays are cut, and what ends the bisection.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Algorithm {
    /// `kmarch`, \[knoll2007\] Section 5.3: slabs along the packet's common dominant axis.
    Kmarch,
    /// `tbisect`, \[knoll2007\] Section 6.5: each ray's own range of t.
    Tbisect,
    /// `mitchell`, \[mitchell1990\] as in \[knoll2007\] Section 6.5: as `tbisect`, until the slope's
    /// enclosure excludes 0; then without intervals.
    Mitchell,
}

/// What ends the bisection of a ray's pieces.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Stop {
    /// d_stop: pieces of 2^-d of the domain along K, or of the ray's range of t.
    Depth(u32),
    /// Pieces at most this wide in t (Eq. 6, by ray).
    Width(f64),
}

/// What happens to a piece that is bisected no further.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Finishing {
    /// It is a hit, as in the paper: it may hold no root.
    Accept,
    /// The march goes [`levels`](Bisection::levels) deeper, then the finish proves a root by certified
    /// opposite signs of a continuous F, or proves the piece empty and the march goes on.
    Certify,
}

/// What happens to the last pieces on which F is unbounded (Section 5.4).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Poles {
    /// They are dropped, which costs the FIRST bit.
    Hidden,
    /// They count as hit: asymptotes are rendered.
    Shown,
}

/// How many rays are traversed together. Answers do not depend on it, except where 16 or 32 round
/// outward in hardware and 4 or 8 by steps: those are wider.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Packets {
    /// One register of the instruction set that has registers of that size, whatever `isa` says: 4 (2x2
    /// pixels, the paper's) of SSE2, 8 (4x2) of AVX2, 16 (4x4) of AVX-512. Where F is unbounded or
    /// undefined, set-based intervals take 16 all the same.
    One(Register),
    /// 32 (8x4): two vectors of 16; one with set-based intervals.
    Two,
}

/// The arithmetic of the march.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Arithmetic {
    /// Single precision, unless something in the domain is too large for it.
    Auto,
    /// Double precision, one ray at a time.
    Double,
}

/// Interval bisection: the methods `kmarch`, `tbisect` and `mitchell`.
#[derive(Clone, Debug, PartialEq)]
pub struct Bisection {
    /// Which of them.
    pub algorithm: Algorithm,
    /// d_stop or epsilon. Default: depth 10, the paper's.
    pub stop: Stop,
    /// Range tolerance: a piece where F is narrower than this is bisected no further. Default: 0, off.
    pub delta: f64,
    /// Default: outward; the paper rounds to nearest.
    pub rounding: Rounding,
    /// Default: certify; the paper accepts.
    pub finish: Finishing,
    /// Depths beyond the stop that the certifying finish searches. Default: 4.
    pub levels: u32,
    /// Default: hidden.
    pub poles: Poles,
    /// By how many depths [`Request::Any`](zeroset_raycast::Request::Any), of shadow rays, is coarser.
    /// Default: 2, the paper's.
    pub shadow: u32,
    /// How normals are computed. Default: by the gradient.
    pub normals: Normals,
    /// Default: 32.
    pub packets: Packets,
    /// Default: auto.
    pub arithmetic: Arithmetic,
    /// The instruction set; `None` is the widest there is.
    pub isa: Option<Isa>,
}

impl Bisection {
    /// An algorithm with the default settings.
    pub fn new(algorithm: Algorithm) -> Self {
        Self {
            algorithm,
            stop: Stop::Depth(10),
            delta: 0.0,
            rounding: Rounding::Outward,
            finish: Finishing::Certify,
            levels: 4,
            poles: Poles::Hidden,
            shadow: 2,
            normals: Normals::Gradient,
            packets: Packets::Two,
            arithmetic: Arithmetic::Auto,
            isa: None,
        }
    }

    /// Knoll's coherent K-marching.
    pub fn kmarch() -> Self {
        Self::new(Algorithm::Kmarch)
    }

    /// Bisection along each ray.
    pub fn tbisect() -> Self {
        Self::new(Algorithm::Tbisect)
    }

    /// Mitchell's algorithm.
    pub fn mitchell() -> Self {
        Self::new(Algorithm::Mitchell)
    }
}

const ROUNDINGS: [(&str, Rounding); 3] =
    [("outward", Rounding::Outward), ("nudged", Rounding::Nudged), ("nearest", Rounding::Nearest)];
const FINISHES: [(&str, Finishing); 2] =
    [("accept", Finishing::Accept), ("certify", Finishing::Certify)];
const POLES: [(&str, Poles); 2] = [("hidden", Poles::Hidden), ("shown", Poles::Shown)];
const PACKETS: [(&str, Packets); 4] = [
    ("4", Packets::One(Register::Four)),
    ("8", Packets::One(Register::Eight)),
    ("16", Packets::One(Register::Sixteen)),
    ("32", Packets::Two),
];
const ARITHMETICS: [(&str, Arithmetic); 2] =
    [("auto", Arithmetic::Auto), ("double", Arithmetic::Double)];

impl Packets {
    /// Those for which this machine has registers, with their names.
    fn available() -> Vec<(&'static str, Self)> {
        let registers = Register::available();
        let has = |packets| match packets {
            Self::One(register) => registers.contains(&register),
            Self::Two => true,
        };
        PACKETS.into_iter().filter(|(_, packets)| has(*packets)).collect()
    }
}

impl Method for Bisection {
    fn id(&self) -> &'static str {
        match self.algorithm {
            Algorithm::Kmarch => "kmarch",
            Algorithm::Tbisect => "tbisect",
            Algorithm::Mitchell => "mitchell",
        }
    }

    fn summary(&self) -> &'static str {
        match self.algorithm {
            Algorithm::Kmarch => "coherent K-marching with interval arithmetic [knoll2007]",
            Algorithm::Tbisect => "bisection of t with interval arithmetic [knoll2007]",
            Algorithm::Mitchell => {
                "bisection with interval slopes, then without intervals [mitchell1990]"
            }
        }
    }

    fn supports(&self, scene: &Scene) -> Result<(), Unsupported> {
        Implicit::function(self.id(), scene).map(|_| ())
    }

    fn prepare(&self, scene: &Scene) -> Result<Box<dyn Intersector>, Error> {
        Ok(Box::new(Prepared::new(self, scene)?))
    }

    fn knobs(&self) -> Vec<Knob> {
        let (depth, width) = match self.stop {
            Stop::Depth(depth) => (depth.to_string(), "off".to_string()),
            Stop::Width(width) => ("off".to_string(), knob::text(width)),
        };
        vec![
            Knob {
                name: "depth",
                value: depth,
                doc: "d_stop, bisections along K (kmarch) or of the ray's range of t; 0 to 40 (default 10)",
            },
            Knob {
                name: "width",
                value: width,
                doc: "epsilon: width of the last pieces in t, instead of depth (default off)",
            },
            Knob {
                name: "delta",
                value: knob::text(self.delta),
                doc: "range tolerance: pieces where F is narrower are bisected no further (default 0, off)",
            },
            Knob {
                name: "rounding",
                value: knob::name(&ROUNDINGS, &self.rounding),
                doc: "outward, nudged (the same on every instruction set) or nearest (the paper's, without proofs); default outward",
            },
            Knob {
                name: "finish",
                value: knob::name(&FINISHES, &self.finish),
                doc: "certify, or accept every last piece as the paper does (default certify)",
            },
            Knob {
                name: "levels",
                value: self.levels.to_string(),
                doc: "depths beyond the stop that the certifying finish searches (default 4)",
            },
            Knob {
                name: "poles",
                value: knob::name(&POLES, &self.poles),
                doc: "hidden (last pieces where F is unbounded are dropped) or shown (default hidden)",
            },
            Knob {
                name: "shadow",
                value: self.shadow.to_string(),
                doc: "by how many depths shadow rays stop earlier; 0 to 40 (default 2)",
            },
            normals::knob(self.normals),
            Knob {
                name: "packet",
                value: knob::name(&PACKETS, &self.packets),
                doc: "rays traversed together: 4 (one register of SSE2), 8 (AVX2), 16 (AVX-512) or 32 (two vectors of isa); default 32",
            },
            Knob {
                name: "arithmetic",
                value: knob::name(&ARITHMETICS, &self.arithmetic),
                doc: "auto (single precision where it suffices) or double, one ray at a time (default auto)",
            },
            isa::knob(self.isa),
        ]
    }

    fn set(&mut self, knob: &str, value: &str) -> Result<(), KnobError> {
        match knob {
            // The other of the two says what stops; so that all knobs can be set from a record.
            "depth" | "width" if value.trim() == "off" => {}
            "depth" => self.stop = Stop::Depth(knob::whole(knob, value, [0, MAX_DEPTH])?),
            "width" => {
                self.stop = Stop::Width(knob::number(knob, value, [f64::MIN_POSITIVE, f64::MAX])?);
            }
            "delta" => self.delta = knob::number(knob, value, [0.0, f64::MAX])?,
            "rounding" => self.rounding = knob::choice(knob, value, &ROUNDINGS)?,
            "finish" => self.finish = knob::choice(knob, value, &FINISHES)?,
            "levels" => self.levels = knob::whole(knob, value, [0, MAX_DEPTH])?,
            "poles" => self.poles = knob::choice(knob, value, &POLES)?,
            "shadow" => self.shadow = knob::whole(knob, value, [0, MAX_DEPTH])?,
            "normals" => self.normals = normals::read(value)?,
            "packet" => self.packets = knob::choice(knob, value, &Packets::available())?,
            "arithmetic" => self.arithmetic = knob::choice(knob, value, &ARITHMETICS)?,
            "isa" => self.isa = isa::read(value)?,
            _ => return Err(knob::unknown(self.id(), knob, &self.knobs())),
        }
        Ok(())
    }

    fn for_precision(&mut self, width: f64, _: &Scene) {
        self.stop = Stop::Width(width);
    }

    fn boxed(&self) -> Box<dyn Method> {
        Box::new(self.clone())
    }
}
