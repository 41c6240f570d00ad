//! BeamCast, \[ganacim2011\] Section III-B: interval bisection along beams, a packet of them at a time.
//!
//! The recursion's state is two integers: piece `index` of 2^depth equal pieces of a beam. Each lane has
//! its own, as threads of a GPU do; lanes that are done wait for the others.

use zeroset_expr::{Evaluator, Tape};
use zeroset_ia::{Interval, Kernel, Packet, Pair, Raw, Scalar, Set};
use zeroset_raycast::Domain;

use crate::form::{AffineBeam, Form, Symbol};
use crate::method::Stop;
use crate::optics::{Optics, Varying};
use crate::quadtree::Cell;
use crate::region::Region;

/// What a beam sees.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Sight {
    /// The range of t of the first piece that could not be excluded, if there is one.
    pub piece: Option<[f64; 2]>,
    /// Is each ray of the beam proven to meet the surface there?
    pub is_proven: bool,
    /// Evaluations.
    pub intervals: u32,
}

impl Sight {
    /// Nothing.
    pub(crate) const NOTHING: Self = Self { piece: None, is_proven: false, intervals: 0 };
}

/// Casts the beams of cells, and gives what each sees.
#[derive(Clone, Copy)]
pub(crate) struct Cast<'a> {
    pub tape: &'a Tape,
    pub optics: &'a Optics,
    pub domain: &'a Domain,
    pub stop: Stop,
    /// The side of the cells, and those of the image, in pixels.
    pub size: u32,
    pub image: [usize; 2],
    /// The width in t of the last pieces; not below [`LEAST`].
    pub tolerance: f64,
    pub cells: &'a [Cell],
}

/// 2^-120: pieces are not narrower, so that their widths are exact.
pub(crate) const LEAST: f64 = f64::from_bits((1023 - 120) << 52);

/// Bounded functions: raw intervals, two packets of vectors at a time.
pub(crate) struct RawPairs<'a>(pub Cast<'a>);

impl Kernel for RawPairs<'_> {
    type Output = Vec<Sight>;
    #[inline(always)]
    fn run<R: Packet>(self, zero: R) -> Vec<Sight> {
        self.0.run::<Pair<R>, Interval<Pair<R>, Raw>>(Pair(zero, zero))
    }
}

/// Bounded functions: affine forms, one vector at a time.
pub(crate) struct AffineVectors<'a>(pub Cast<'a>);

impl Kernel for AffineVectors<'_> {
    type Output = Vec<Sight>;
    #[inline(always)]
    fn run<R: Packet>(self, zero: R) -> Vec<Sight> {
        self.0.run::<R, AffineBeam<R>>(zero)
    }
}

/// Functions with poles or partial domains: set-based intervals.
pub(crate) struct SetVectors<'a>(pub Cast<'a>);

impl Kernel for SetVectors<'_> {
    type Output = Vec<Sight>;
    #[inline(always)]
    fn run<R: Packet>(self, zero: R) -> Vec<Sight> {
        self.0.run::<R, Interval<R, Set>>(zero)
    }
}

impl Cast<'_> {
    /// Casts all cells, a packet at a time.
    #[inline(always)]
    pub(crate) fn run<R: Packet, N: Form<R>>(self, zero: R) -> Vec<Sight> {
        let context = N::point(zero);
        let mut caster = Caster {
            function: self.tape.evaluator(&context),
            lenses: self.optics.tapes.each_ref().map(|tape| tape.evaluator(&context)),
            region: Region::new(self.domain),
            far: R::Scalar::from_f64(self.optics.range[1].into()),
            tolerance: R::Scalar::from_f64(self.tolerance),
            // A piece's index is exact.
            deepest: if size_of::<R::Scalar>() == 4 { DEEPEST } else { DEEPEST_DOUBLE },
            sees: self.stop == Stop::Seen && self.tape.is_continuous(),
            sights: Vec::with_capacity(self.cells.len()),
            zero,
        };
        for cells in self.cells.chunks(R::LANES) {
            let beams = caster.beams(&self, cells);
            caster.cast(&beams, cells.len());
        }
        caster.sights
    }
}

/// The deepest pieces in single precision.
pub(crate) const DEEPEST: u32 = 23;
/// The same in double precision.
const DEEPEST_DOUBLE: u32 = 40;

/// The beams of a packet, one a lane: their origins and directions, and where they start.
#[derive(Clone)]
struct Beams<R, N> {
    origin: [N; 3],
    direction: [N; 3],
    start: R,
}

impl<R: Packet, N: Form<R>> Beams<R, N> {
    /// The points over ranges of t, which are not negative.
    #[inline(always)]
    fn points(&self, [lo, hi]: [R; 2]) -> [N; 3] {
        let t = N::variable(Interval::new(lo, hi), Symbol::T);
        let mut points = self.origin.clone();
        for (point, direction) in points.iter_mut().zip(&self.direction) {
            *point = point.clone().along(direction.clone(), t.clone());
        }
        points
    }
}

/// What casts packets.
struct Caster<'a, R: Packet, N> {
    function: Evaluator<'a, N>,
    lenses: [Evaluator<'a, N>; 3],
    region: Region<R::Scalar>,
    far: R::Scalar,
    tolerance: R::Scalar,
    deepest: u32,
    /// Does a change of sign end the bisection?
    sees: bool,
    sights: Vec<Sight>,
    zero: R,
}

impl<R: Packet, N: Form<R>> Caster<'_, R, N> {
    /// The beams of at most as many cells as there are lanes; other lanes repeat the last.
    #[inline(always)]
    fn beams(&mut self, cast: &Cast<'_>, cells: &[Cell]) -> Beams<R, N> {
        let Cast { optics, size, image, .. } = *cast;
        let [mut u, mut v] = [[[0.0_f64; MOST_LANES]; 2]; 2];
        let mut start = [0.0_f64; MOST_LANES];
        for i in 0..R::LANES {
            let cell = cells[i.min(cells.len() - 1)];
            for (ends, place, side) in
                [(&mut u, cell.column, image[0]), (&mut v, cell.row, image[1])]
            {
                ends[0][i] = f64::from(place) * f64::from(size);
                ends[1][i] = (f64::from(place + 1) * f64::from(size)).min(side as f64);
            }
            start[i] = cell.start;
        }
        let mut varying = [N::point(self.zero), N::point(self.zero), N::point(self.zero)];
        let slack = self.zero.splat(R::Scalar::from_f64(optics.slack.into()));
        let [u, v] = [self.lanes(&u), self.lanes(&v)];
        for (component, lens) in varying.iter_mut().zip(&mut self.lenses) {
            lens.bind(0, N::variable(Interval::new(u[0], u[1]), Symbol::U));
            lens.bind(1, N::variable(Interval::new(v[0], v[1]), Symbol::V));
            *component = evaluate(lens, self.zero);
            if R::OUTWARD {
                *component = component.clone().widened(slack);
            }
        }
        let mut other = varying.clone();
        for (component, x) in other.iter_mut().zip(optics.fixed.to_array()) {
            *component = N::point(self.zero.splat(R::Scalar::from_f64(x.into())));
        }
        let (origin, direction) = match optics.varying {
            Varying::Direction => (other, varying),
            Varying::Origin => (varying, other),
        };
        let start = self.lanes(&[start, start])[0];
        Beams { origin, direction, start }
    }

    /// Numbers that single precision has, in lanes.
    #[inline(always)]
    fn lanes(&self, ends: &[[f64; MOST_LANES]; 2]) -> [R; 2] {
        let [lo, hi] = ends;
        [
            self.zero.from_fn(
                #[inline(always)]
                |i| R::Scalar::from_f64(lo[i]),
            ),
            self.zero.from_fn(
                #[inline(always)]
                |i| R::Scalar::from_f64(hi[i]),
            ),
        ]
    }

    /// The points cut with the domain; the lanes where something is left, and those where nothing was cut
    /// away.
    #[inline(always)]
    fn cut(&self, points: [N; 3]) -> ([N; 3], u64, u64) {
        let mut boxes = [[self.zero; 2]; 3];
        for (ends, point) in boxes.iter_mut().zip(&points) {
            *ends = point.range();
        }
        let (boxes, meets, inside) = self.region.cut(boxes);
        let mut points = points;
        for (point, [lo, hi]) in points.iter_mut().zip(boxes) {
            *point = point.clone().cut(lo, hi);
        }
        (points, meets, inside)
    }

    /// The range of F over points.
    #[inline(always)]
    fn value(&mut self, points: [N; 3]) -> [R; 2] {
        for (axis, point) in points.into_iter().enumerate() {
            self.function.bind(axis, point);
        }
        evaluate(&mut self.function, self.zero).range()
    }

    /// Casts the beams of the first lanes.
    #[inline(always)]
    fn cast(&mut self, beams: &Beams<R, N>, count: usize) {
        let zero = self.zero;
        let one = zero.splat(R::Scalar::from_f64(1.0));
        let tolerance = zero.splat(self.tolerance);
        let length = zero.splat(self.far).sub_up(beams.start);
        let (mut index, mut depth) = ([0_u64; MOST_LANES], [0_u32; MOST_LANES]);
        // The width of a piece to that of the beam.
        let mut share = [R::Scalar::from_f64(1.0); MOST_LANES];
        let mut sights = [Sight::NOTHING; MOST_LANES];
        let mut alive = u64::MAX >> (64 - count);
        // The sign of F at the start of the piece, on all rays of the beam.
        let (mut positive, mut negative) = (0_u64, 0_u64);
        while alive != 0 {
            let first = zero.from_fn(
                #[inline(always)]
                |i| R::Scalar::from_f64(index[i] as f64),
            );
            let part = length
                * zero.from_fn(
                    #[inline(always)]
                    |i| share[i],
                );
            // Exact.
            let next = first + one;
            let ends =
                [beams.start.add_down(first.mul_down(part)), beams.start.add_up(next.mul_up(part))];
            let (points, meets, inside) = self.cut(beams.points(ends));
            let (mut excluded, mut above, mut below) = (alive & !meets, 0, 0);
            if alive & meets != 0 {
                let [lo, hi] = self.value(points);
                let mut empty = 0;
                if N::CAN_BE_EMPTY {
                    // The function is undefined in the whole piece.
                    empty = meets & !lo.le(lo);
                }
                above = alive & meets & !empty & zero.lt(lo);
                below = alive & meets & !empty & hi.lt(zero);
                excluded |= above | below | alive & empty;
                let mut evaluated = alive & meets;
                while evaluated != 0 {
                    sights[evaluated.trailing_zeros() as usize].intervals += 1;
                    evaluated &= evaluated - 1;
                }
            }
            let thin = part.le(tolerance);
            let mut proven = 0;
            let asked = alive & !excluded & inside & (positive | negative);
            if self.sees && asked != 0 {
                // The face in which the piece ends.
                let face = [beams.start.add_down(next.mul_down(part)), ends[1]];
                let (points, _, inside) = self.cut(beams.points(face));
                let [lo, hi] = self.value(points);
                let change = positive & hi.lt(zero) | negative & zero.lt(lo);
                proven = asked & inside & change;
                for (i, sight) in sights.iter_mut().enumerate().take(count) {
                    sight.intervals += (asked >> i & 1) as u32;
                }
            }
            let mut rest = alive;
            while rest != 0 {
                let i = rest.trailing_zeros() as usize;
                let bit = rest & rest.wrapping_neg();
                rest &= rest - 1;
                if excluded & bit != 0 {
                    index[i] += 1;
                    let up = index[i].trailing_zeros().min(depth[i]);
                    index[i] >>= up;
                    depth[i] -= up;
                    if depth[i] == 0 {
                        alive &= !bit;
                    }
                    // A range that ends before it begins has no sign.
                    positive = positive & !bit | above & !below & bit;
                    negative = negative & !bit | below & !above & bit;
                } else if (thin | proven) & bit != 0 || depth[i] == self.deepest {
                    let piece = ends.map(|t| t.lane(i).to_f64());
                    sights[i].piece = Some(piece);
                    sights[i].is_proven = proven & bit != 0;
                    alive &= !bit;
                    continue;
                } else {
                    index[i] *= 2;
                    depth[i] += 1;
                }
                share[i] = R::Scalar::from_f64(power_of_half(depth[i]));
            }
        }
        self.sights.extend_from_slice(&sights[..count]);
    }
}

/// Lanes of a packet at most.
const MOST_LANES: usize = 64;

/// 2^-n.
#[inline(always)]
fn power_of_half(n: u32) -> f64 {
    f64::from_bits(u64::from(1023 - n) << 52)
}

/// Out of line: the evaluator's loop is long, and called from several places.
#[inline(never)]
fn evaluate<R: Packet, N: Form<R>>(evaluator: &mut Evaluator<'_, N>, zero: R) -> N {
    zero.region(
        #[inline(always)]
        || {
            evaluator.run(
                #[inline(always)]
                |_| {},
            )
        },
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    use glam::DVec3;
    use proptest::prelude::*;
    use zeroset_expr::{Function, Parameters};
    use zeroset_ia::Mirror;
    use zeroset_raycast::{Camera, Projection, View};

    fn view() -> impl Strategy<Value = View> {
        let place = |far: f64| {
            [-1.0_f64..1.0, -1.0..1.0, -1.0..1.0].prop_map(move |v| far * DVec3::from(v))
        };
        let size = || prop_oneof![Just(1_usize), 2_usize..70, Just(4096)];
        let projection = prop_oneof![
            (0.01_f64..175.0).prop_map(|fov| Projection::Perspective { fov }),
            (-8_i32..12).prop_map(|e| Projection::Orthographic { height: 2.0_f64.powi(e) }),
        ];
        let eye = (-3_i32..24).prop_flat_map(move |e| place(2.0_f64.powi(e)));
        (eye, place(1.0), place(1.0), projection, size(), size()).prop_map(
            |(eye, at, up, projection, width, height)| {
                View::new(Camera { eye, at, up, projection }, width, height)
            },
        )
    }

    /// The boxes of a cell over a range of t hold the points of the rays through its base.
    fn check<R: Packet, N: Form<R>>(
        zero: R,
        view: &View,
        (cell, size): (Cell, u32),
        [u, v]: [f64; 2],
        t: [f64; 2],
    ) -> Result<(), TestCaseError> {
        // The eye is where single precision has few digits, and a face of the box is near.
        let eye = view.camera().eye;
        let beside = eye + DVec3::new(0.003, -0.5, -0.5);
        let boxes = [(DVec3::splat(-1.0), DVec3::splat(1.0)), (beside, beside + DVec3::splat(1.0))];
        for (min, max) in boxes {
            let domain = Domain::new(min, max).expect("a box");
            check_in::<R, N>(zero, view, (cell, size), [u, v], t, domain)?;
        }
        Ok(())
    }

    fn check_in<R: Packet, N: Form<R>>(
        zero: R,
        view: &View,
        (cell, size): (Cell, u32),
        [u, v]: [f64; 2],
        t: [f64; 2],
        domain: Domain,
    ) -> Result<(), TestCaseError> {
        let Ok(Some(optics)) = Optics::new(view, &domain) else { return Ok(()) };
        let function = Function::parse("x+y+z").expect("an equation");
        let tape = function.tape(&Parameters::default(), 128).expect("defaults");
        let image = [view.width, view.height];
        let cells = [cell];
        let cast = Cast {
            tape: &tape,
            optics: &optics,
            domain: &domain,
            stop: Stop::Thin,
            size,
            image,
            tolerance: 1.0,
            cells: &cells,
        };
        let context = N::point(zero);
        let mut caster = Caster {
            function: tape.evaluator(&context),
            lenses: optics.tapes.each_ref().map(|tape| tape.evaluator(&context)),
            region: Region::new(&domain),
            far: R::Scalar::from_f64(optics.range[1].into()),
            tolerance: R::Scalar::from_f64(1.0),
            deepest: 1,
            sees: false,
            sights: Vec::new(),
            zero,
        };
        let beams = caster.beams(&cast, &cells);
        let ends = t.map(|t| zero.splat(R::Scalar::from_f64(t)));
        let points = beams.points(ends);
        let place = |i: u32, share: f64, side: usize| {
            (f64::from(size) * (f64::from(i) + share)).min(side as f64)
        };
        let ray = view.ray_at(place(cell.column, u, image[0]), place(cell.row, v, image[1]));
        prop_assert!(ray.is_valid());
        for at in [t[0], 0.5 * (t[0] + t[1]), t[1]] {
            // Exact, but for a rounding of double precision.
            let exact = ray.over([at, at]);
            for (axis, point) in exact.into_iter().enumerate() {
                let [lo, hi] = points[axis].range().map(|x| x.lane(0).to_f64());
                prop_assert!(lo <= point.hi && point.lo <= hi, "{lo} {hi} {point:?} {ray:?}");
            }
        }
        // What enters the domain does so in the range.
        if let Some(clip) = domain.clip(ray, [0.0, f64::INFINITY]).and_then(|clip| clip.inner) {
            let [near, far] = optics.range.map(f64::from);
            prop_assert!(near <= clip[0] && clip[1] <= far, "{near} {far} {clip:?} {ray:?}");
        }
        Ok(())
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(4000))]

        #[test]
        fn boxes_hold_the_rays_of_their_bases(
            view in view(),
            place in (0.0_f64..1.0, 0.0_f64..1.0),
            level in 0_u32..6,
            // Corners and edges too.
            u in prop_oneof![Just(0.0), Just(1.0), 0.0_f64..1.0],
            v in prop_oneof![Just(0.0), Just(1.0), 0.0_f64..1.0],
            t in (0.0_f32..1000.0, 0.0_f32..100.0),
        ) {
            let size = 1 << level;
            let index = |share: f64, side: usize| (share * side as f64) as u32 / size;
            let (column, row) = (index(place.0, view.width), index(place.1, view.height));
            let cell = Cell { column, row, start: 0.0 };
            let t = [t.0, t.0 + t.1].map(f64::from);
            let (cell, place) = ((cell, size), [u, v]);
            check::<_, Interval<_>>(Mirror(0.0), &view, cell, place, t)?;
            check::<_, Interval<_>>(0.0_f32, &view, cell, place, t)?;
            check::<_, Interval<_>>(0.0_f64, &view, cell, place, t)?;
            check::<_, AffineBeam<_>>(Mirror(0.0), &view, cell, place, t)?;
            check::<_, AffineBeam<_>>(0.0_f32, &view, cell, place, t)?;
        }
    }
}
