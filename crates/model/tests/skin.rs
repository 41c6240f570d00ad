//! A skin is what its definition says, the least power over all spheres of the convex hull, and no ray passes
//! between its patches.

use std::collections::BTreeMap;

use glam::{DMat3, DVec3};
use proptest::prelude::*;
use zeroset_model::skin::{Atom, Kind, MixedCell, Skin, benzene, ethanol, water};
use zeroset_raycast::{Bound, Patches, Sides};

mod casting;
use casting::crossings;

/// Numbers in \[0, 1) that look random.
struct Random(u64);

impl Random {
    fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(0x5851_f42d_4c95_7f2d).wrapping_add(0x1405_7b7e_f767_814f);
        (self.0 >> 11) as f64 / (1u64 << 53) as f64
    }

    fn direction(&mut self) -> DVec3 {
        let point = DVec3::new(self.next(), self.next(), self.next()) - 0.5;
        if point.length() > 0.1 { point.normalize() } else { self.direction() }
    }

    /// A point between others.
    fn between(&mut self, corners: &[DVec3]) -> DVec3 {
        let weights: Vec<_> = corners.iter().map(|_| -(1.0 - self.next()).ln()).collect();
        let sum: f64 = weights.iter().sum();
        corners.iter().zip(weights).map(|(&p, w)| w / sum * p).sum()
    }
}

/// f(x) by its definition, without any triangulation: the least value over all sets of up to four atoms of
/// |x - y|^2 - s W(y) with y between them.
fn defined(atoms: &[Atom], s: f64, x: DVec3) -> f64 {
    let mut least = f64::INFINITY;
    let n = atoms.len();
    for a in 0..n {
        least = least.min(between(&[atoms[a]], s, x));
        for b in a + 1..n {
            least = least.min(between(&[atoms[a], atoms[b]], s, x));
            for c in b + 1..n {
                least = least.min(between(&[atoms[a], atoms[b], atoms[c]], s, x));
                for d in c + 1..n {
                    least = least.min(between(&[atoms[a], atoms[b], atoms[c], atoms[d]], s, x));
                }
            }
        }
    }
    least
}

/// The least value for y = z0 + E c where the derivative by c is 0, if that is between the atoms.
fn between(atoms: &[Atom], s: f64, x: DVec3) -> f64 {
    let lift = |a: &Atom| a.centre.length_squared() - a.radius * a.radius / s;
    let (first, rest) = atoms.split_first().unwrap();
    let edge = |i: usize| rest.get(i).map_or(DVec3::ZERO, |a| a.centre - first.centre);
    let [e, f, g] = [edge(0), edge(1), edge(2)];
    let edges = DMat3::from_cols(e, f, g);
    // Directions that there are none of say c = 0.
    let none = DVec3::from([0, 1, 2].map(|i| f64::from(i >= rest.len())));
    let gram = edges.transpose() * edges + DMat3::from_diagonal(none);
    let rise = DVec3::from([0, 1, 2].map(|i| rest.get(i).map_or(0.0, |a| lift(a) - lift(first))));
    if !(gram.determinant() > 1e-9) {
        return f64::INFINITY;
    }
    let right = edges.transpose() * (x - (1.0 - s) * first.centre) - 0.5 * s * rise;
    let c = gram.inverse() * right / (1.0 - s);
    if c.min_element() < 0.0 || c.element_sum() > 1.0 {
        return f64::INFINITY;
    }
    let y = first.centre + edges * c;
    x.distance_squared(y) - s * y.length_squared() + s * (lift(first) + c.dot(rise))
}

fn atom(x: f64, y: f64, z: f64, radius: f64) -> Atom {
    Atom { centre: DVec3::new(x, y, z), radius }
}

/// Each cell has the value of the definition at points of its own; how many were looked at.
fn holds(atoms: &[Atom], skin: Skin, random: &mut Random, each: usize) -> usize {
    let cells = skin.cells(atoms).unwrap();
    let mut count = 0;
    for cell in &cells {
        for _ in 0..each.min(cell.tetrahedra.len()) {
            let index = (random.next() * cell.tetrahedra.len() as f64) as usize;
            let x = random.between(&cell.tetrahedra[index]);
            let (f, expected) = (cell.value(x), defined(atoms, skin.shrink, x));
            let tolerance = 1e-7 / skin.shrink.min(1.0 - skin.shrink);
            assert!((f - expected).abs() < tolerance, "{f} {expected} at {x} in {cell:?}");
            count += 1;
        }
    }
    count
}

#[test]
fn molecules_have_the_skin_of_the_definition() {
    let mut random = Random(1);
    for molecule in [water(), ethanol(), benzene()] {
        for shrink in [0.1, 0.5, 0.9] {
            let count = holds(&molecule.atoms(), Skin { shrink }, &mut random, 12);
            assert!(count >= 40, "{count}");
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::with_cases(400) })]

    /// On a grid: many are on a sphere, in a plane or on a line, in one place or within another.
    #[test]
    fn atoms_anywhere_have_the_skin_of_the_definition(
        places in prop::collection::vec(([0..3i32, 0..3i32, 0..3i32], 1..4i32), 1..9),
        shrink in prop_oneof![Just(0.5), 0.1..0.9f64], seed in any::<u64>(),
    ) {
        let atoms: Vec<_> = places
            .into_iter()
            .map(|(p, r)| Atom { centre: DVec3::from(p.map(f64::from)), radius: 0.4 * f64::from(r) })
            .collect();
        let skin = Skin { shrink };
        prop_assert!(holds(&atoms, skin, &mut Random(seed), 3) > 0);
        covers(&atoms, skin, &mut Random(seed), 10);
    }
}

/// Points of all atoms are in a tetrahedron of the complex.
fn covers(atoms: &[Atom], skin: Skin, random: &mut Random, count: usize) {
    let cells = skin.cells(atoms).unwrap();
    for _ in 0..count {
        let of = atoms[(random.next() * atoms.len() as f64) as usize];
        let x = of.centre + of.radius * random.next() * random.direction();
        let is_in = |t: &[DVec3; 4]| {
            let l = DMat3::from_cols(t[1] - t[0], t[2] - t[0], t[3] - t[0]).inverse() * (x - t[0]);
            l.min_element() >= -1e-9 && l.element_sum() <= 1.0 + 1e-9
        };
        let holders = cells.iter().filter(|cell| cell.tetrahedra.iter().any(is_in)).count();
        assert!(holders > 0, "{x} is nowhere, in {atoms:?}");
    }
}

fn kinds(cells: &[MixedCell]) -> Vec<(Kind, usize)> {
    let mut counts = BTreeMap::new();
    for cell in cells {
        *counts.entry(cell.kind).or_default() += 1;
    }
    counts.into_iter().collect()
}

#[test]
fn one_atom_is_a_sphere_of_its_radius() {
    for shrink in [0.3, 0.5, 0.8] {
        let skin = Skin { shrink };
        let patches = skin.patches(&[atom(1.0, 2.0, 3.0, 1.5)]).unwrap();
        assert_eq!(patches.sides(), Sides::Front);
        let mut random = Random(7);
        for _ in 0..200 {
            let direction = random.direction();
            let hits = crossings(&patches, DVec3::new(1.0, 2.0, 3.0), direction);
            assert!(hits.iter().any(|hit| (hit.t - 1.5).abs() < 1e-8 && hit.slope > 0.0));
            assert!(hits.iter().any(|hit| (hit.t + 1.5).abs() < 1e-8 && hit.slope < 0.0));
        }
    }
}

#[test]
fn two_atoms_are_spheres_and_a_hyperboloid() {
    let skin = Skin::default();
    let near = skin.cells(&[atom(-1.0, 0.0, 0.0, 1.2), atom(1.0, 0.0, 0.0, 1.2)]).unwrap();
    assert_eq!(kinds(&near), [(Kind::Sphere, 2), (Kind::OneSheet, 1)]);
    let neck = near.iter().find(|cell| cell.kind == Kind::OneSheet).unwrap();
    // R^2 = 1.44 / s - 1 at the middle; the neck's radius there is sqrt(s R^2), and it is y^2 - x^2 = 0.94.
    for (x, y) in [(0.0, 0.94f64.sqrt()), (0.5, 1.19f64.sqrt())] {
        assert!(neck.value(DVec3::new(x, 0.0, y)).abs() < 1e-8);
        assert!(neck.value(DVec3::new(-x, y, 0.0)).abs() < 1e-8);
    }
    // Spheres meet it halfway to the centres.
    for cell in near.iter().filter(|cell| cell.kind == Kind::Sphere) {
        let corners = cell.tetrahedra.iter().flatten();
        let nearest = corners.map(|p| p.x.abs()).fold(f64::INFINITY, f64::min);
        assert!((nearest - 0.5).abs() < 1e-7);
        assert!(cell.value(cell.focus + DVec3::new(0.0, 1.2, 0.0)).abs() < 1e-8);
    }
    let far = skin.cells(&[atom(-2.0, 0.0, 0.0, 1.2), atom(2.0, 0.0, 0.0, 1.2)]).unwrap();
    assert_eq!(kinds(&far), [(Kind::Sphere, 2), (Kind::TwoSheets, 1)]);
    let gap = far.iter().find(|cell| cell.kind == Kind::TwoSheets).unwrap();
    assert!((gap.value(DVec3::ZERO) - 0.56).abs() < 1e-8, "outside: 2 - 1.44");
}

#[test]
fn size_and_place_do_not_matter() {
    let atoms = ethanol().atoms();
    let skin = Skin::default();
    let plain = skin.patches(&atoms).unwrap();
    for (scale, shift) in [(2f64.powi(-33), DVec3::ZERO), (1.0, DVec3::new(1e3, -500.0, 7.0))] {
        let moved = |a: &Atom| Atom { centre: scale * a.centre + shift, radius: scale * a.radius };
        let moved: Vec<_> = atoms.iter().map(moved).collect();
        let there = skin.patches(&moved).unwrap();
        assert_eq!(there.all().len(), plain.all().len());
    }
}

/// The corners of a triangle, in one order whoever has it.
fn key(mut corners: Vec<DVec3>) -> Vec<[u64; 3]> {
    corners.sort_by(|a, b| a.to_array().partial_cmp(&b.to_array()).unwrap());
    corners.into_iter().map(|p| p.to_array().map(f64::to_bits)).collect()
}

fn triangles(tetrahedron: [DVec3; 4]) -> [[DVec3; 3]; 4] {
    [0, 1, 2, 3].map(|i| [1, 2, 3].map(|k| tetrahedron[(i + k) % 4]))
}

/// A patch's tetrahedron in space.
fn place(patches: &Patches, index: usize) -> [DVec3; 4] {
    let patch = &patches.all()[index];
    let Bound::Tetrahedron(corners) = patch.bound else { panic!("a ball") };
    corners.map(|corner| patch.origin + corner)
}

#[test]
fn neighbours_share_triangles_bit_for_bit_wherever_the_skin_passes() {
    for molecule in [water(), ethanol(), benzene()] {
        let patches = Skin::default().patches(&molecule.atoms()).unwrap();
        let mut shared = BTreeMap::<_, Vec<(usize, [DVec3; 3])>>::new();
        for index in 0..patches.all().len() {
            for triangle in triangles(place(&patches, index)) {
                shared.entry(key(triangle.to_vec())).or_default().push((index, triangle));
            }
        }
        let mut random = Random(3);
        let mut count = 0;
        for holders in shared.into_values() {
            assert!(holders.len() <= 2);
            let values = |&(index, triangle): &(usize, [DVec3; 3]), random: &mut Random| {
                let patch = patches.all()[index];
                let value = |_| patch.quadric.value(random.between(&triangle) - patch.origin);
                (0..30).map(value).collect::<Vec<_>>()
            };
            if let [alone] = holders[..] {
                let values = values(&alone, &mut random);
                let is_passed =
                    values.iter().any(|f| *f > 1e-9) && values.iter().any(|f| *f < -1e-9);
                assert!(!is_passed, "{}: an open triangle {alone:?}", molecule.name);
            } else {
                count += 1;
                let [a, b] = [&holders[0], &holders[1]].map(|&(index, _)| patches.all()[index]);
                let x = random.between(&holders[0].1);
                let [f, g] = [a, b].map(|p| p.quadric.value(x - p.origin));
                assert!((f - g).abs() < 1e-12, "{f} {g}");
            }
        }
        assert!(count > 50, "{}: {count}", molecule.name);
    }
}

/// A point between two where f is 0, if it has different signs there.
fn root(f: impl Fn(DVec3) -> f64, [mut a, mut b]: [DVec3; 2]) -> Option<DVec3> {
    if f(a) * f(b) >= 0.0 {
        return None;
    }
    for _ in 0..60 {
        let middle = a.midpoint(b);
        if f(middle) * f(a) > 0.0 { a = middle } else { b = middle }
    }
    Some(a)
}

/// Does a ray enter before it leaves, as often as it enters? None if it grazes.
fn alternates(patches: &Patches, origin: DVec3, direction: DVec3) -> Option<bool> {
    let hits = crossings(patches, origin, direction);
    let mut signs: Vec<(f64, f64)> = Vec::new();
    for hit in &hits {
        let patch = patches.all()[hit.patch];
        let x = origin + hit.t * direction - patch.origin;
        if hit.slope.abs() < 0.02 * patch.quadric.half_gradient(x).length() {
            return None;
        }
        let is_new =
            signs.last().is_none_or(|&(t, sign)| hit.t - t > 1e-6 || sign != hit.slope.signum());
        if is_new {
            signs.push((hit.t, hit.slope.signum()));
        }
    }
    let is_turn = |(i, &(_, sign)): (usize, &(f64, f64))| (sign < 0.0) == (i % 2 == 0);
    Some(signs.len().is_multiple_of(2) && signs.iter().enumerate().all(is_turn))
}

#[test]
fn no_ray_passes_through_triangles_edges_or_corners_that_are_shared() {
    let mut random = Random(5);
    for molecule in [water(), ethanol(), benzene()] {
        let atoms = molecule.atoms();
        let patches = Skin::default().patches(&atoms).unwrap();
        let mut aims = Vec::new();
        for (index, patch) in patches.all().iter().enumerate() {
            let f = |x: DVec3| patch.quadric.value(x - patch.origin);
            let tetrahedron = place(&patches, index);
            aims.extend(tetrahedron.map(|corner| (corner, false)));
            for triangle in triangles(tetrahedron) {
                let inside = [random.between(&triangle), random.between(&triangle)];
                let edge = [random.between(&triangle[..2]), triangle[0]];
                aims.extend([inside, edge].into_iter().filter_map(|e| Some((root(f, e)?, true))));
            }
        }
        let (mut rays, mut met) = (0, 0);
        for (at, is_on_skin) in aims.iter().copied().cycle().take(4 * aims.len()) {
            let direction = random.direction();
            let origin = at - 20.0 * direction;
            let Some(is_closed) = alternates(&patches, origin, direction) else { continue };
            assert!(is_closed, "{}: the ray through {at} along {direction}", molecule.name);
            rays += 1;
            if is_on_skin {
                let hits = crossings(&patches, origin, direction);
                assert!(hits.iter().any(|hit| (hit.t - 20.0).abs() < 1e-6), "{at} {direction}");
                met += 1;
            }
        }
        assert!(rays > 300 && met > 200, "{}: {rays} {met}", molecule.name);
    }
}

#[test]
fn thirty_atoms_are_one_closed_surface() {
    let mut random = Random(11);
    let place = |random: &mut Random| 6.0 * DVec3::new(random.next(), random.next(), random.next());
    let atoms: Vec<_> =
        (0..30).map(|_| Atom { centre: place(&mut random), radius: 0.6 + random.next() }).collect();
    let patches = Skin::default().patches(&atoms).unwrap();
    let mut rays = 0;
    for _ in 0..300 {
        let direction = random.direction();
        let origin = place(&mut random) - 30.0 * direction;
        if let Some(is_closed) = alternates(&patches, origin, direction) {
            assert!(is_closed, "{origin} {direction}");
            rays += 1;
        }
    }
    assert!(rays > 200, "{rays}");
}

/// On a grid but for a little, which may be as little as what weights are changed by.
#[test]
fn atoms_that_are_nearly_on_a_sphere_or_in_a_plane_are_closed() {
    let mut random = Random(77);
    let mut rays = 0;
    for case in 0..120 {
        let jitter = 10f64.powi(-3 - case % 12);
        let mut axis = || (3.0 * random.next()).floor();
        let places: Vec<_> =
            (0..4 + case % 12).map(|_| DVec3::new(axis(), axis(), axis())).collect();
        let atoms: Vec<_> = places
            .into_iter()
            .map(|place| Atom {
                centre: place + jitter * random.direction(),
                radius: 0.4 * (1.0 + (2.0 * random.next()).floor()),
            })
            .collect();
        let patches = Skin::default().patches(&atoms).unwrap();
        for _ in 0..20 {
            let direction = random.direction();
            let origin = DVec3::from([0; 3].map(|_| 2.6 * random.next() - 0.3)) - 10.0 * direction;
            if let Some(is_closed) = alternates(&patches, origin, direction) {
                assert!(is_closed, "{origin} {direction} at {atoms:?}");
                rays += 1;
            }
        }
    }
    assert!(rays > 1500, "{rays}");
}
