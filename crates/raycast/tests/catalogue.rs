//! The catalogue holds every surface of the papers, and what it says of them is true.
//!
//! Facts are checked with 256 bits: an enclosure that holds 0 is then 0 to 60 digits or so.

use std::collections::{BTreeMap, BTreeSet, HashSet};

use zeroset_expr::{Definitions, Evaluator, Function, Parameters, Tape};
use zeroset_ia::{BigInterval, Dual, Number, Unary};
use zeroset_raycast::catalogue::{Axis, Catalogue, Surface};

const PRECISION: usize = 256;

const IDS: [&str; 91] = [
    "ding-dong",
    "ding-dong-printed",
    "clebsch",
    "cayley",
    "torus",
    "nordstrand",
    "cushion",
    "goursat",
    "kummer",
    "miter",
    "cross-cap",
    "piriform",
    "tooth",
    "cassini",
    "cassini-z4",
    "steiner",
    "steiner-knoll",
    "mitchell",
    "mitchell-ganacim",
    "tangle",
    "octdong",
    "sphere",
    "parabolic-cylinder",
    "hyperboloid",
    "intersecting-planes",
    "peninsula",
    "kiss",
    "kiss-printed",
    "dervish",
    "teardrop",
    "barth-sextic",
    "hunt",
    "klein",
    "heart-singh",
    "heart-nordstrand",
    "heart-taubin",
    "high-silhouette",
    "labs-septic",
    "nonisol",
    "endrass-octic",
    "endrass-octic-minus",
    "steiner2",
    "linked-tori",
    "barth-decic",
    "sarti-dodecic",
    "chmutov-6",
    "chmutov-6-recurrence",
    "chmutov-6-cosine",
    "chmutov-7",
    "chmutov-7-recurrence",
    "chmutov-7-cosine",
    "chmutov-8",
    "chmutov-8-recurrence",
    "chmutov-8-cosine",
    "chmutov-9",
    "chmutov-9-recurrence",
    "chmutov-9-cosine",
    "chmutov-12",
    "chmutov-12-recurrence",
    "chmutov-12-cosine",
    "chmutov-14",
    "chmutov-14-recurrence",
    "chmutov-14-cosine",
    "chmutov-18",
    "chmutov-18-recurrence",
    "chmutov-18-cosine",
    "chmutov-22",
    "chmutov-22-recurrence",
    "chmutov-22-cosine",
    "chmutov-50",
    "chmutov-50-recurrence",
    "chmutov-50-cosine",
    "torus-sqrt",
    "blobby",
    "scherk",
    "diamond",
    "superquadric-0p75",
    "superquadric-2p5",
    "superquadric-8",
    "superquadric-twisting",
    "blinn-blobby-75",
    "blinn-blobby-moving",
    "blobby-knoll",
    "blinn-blob-ganacim",
    "absolute-value",
    "absolute-value-z",
    "inverse-function",
    "inverse-function-cleared",
    "trilinear-patch",
    "morph-hyperboloid-torus",
    "bilinear-quad",
];

/// How many finite nodes each surface has in `nodes.csv`.
const NODES: [(&str, usize); 14] = [
    ("ding-dong", 1),
    ("cayley", 4),
    ("kummer", 12),
    ("octdong", 1),
    ("cassini", 2),
    ("dervish", 31),
    ("barth-sextic", 50),
    ("labs-septic", 99),
    ("endrass-octic", 144),
    ("endrass-octic-minus", 128),
    ("barth-decic", 300),
    ("sarti-dodecic", 560),
    ("chmutov-7", 81),
    ("chmutov-9", 192),
];

type Point = [BigInterval; 3];

fn surface(id: &str) -> &'static Surface {
    Catalogue::builtin().get(id).unwrap_or_else(|| panic!("{id}"))
}

fn big(x: f64) -> BigInterval {
    BigInterval::from_f64(x, PRECISION)
}

fn tape(surface: &Surface) -> Tape {
    let function = surface.function().unwrap_or_else(|e| panic!("{}: {e:?}", surface.id));
    function
        .tape(&Parameters::default(), PRECISION)
        .unwrap_or_else(|e| panic!("{}: {e}", surface.id))
}

fn evaluator(tape: &Tape) -> Evaluator<'_, BigInterval> {
    tape.evaluator(&big(0.0))
}

/// Points of a surface's domain, the same on every run, with few digits and no symmetry.
fn places(surface: &Surface) -> Vec<Point> {
    let domain = surface.domain.expect("the built-in surfaces have domains");
    let mut state = 1_u64;
    let mut fraction = || {
        state =
            state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 44) as f64 / f64::from(1 << 20)
    };
    let mut place = || {
        std::array::from_fn(|i| big(domain.min[i] + fraction() * (domain.max[i] - domain.min[i])))
    };
    (0..6).map(|_| place()).collect()
}

/// Are two enclosures narrow, and of the same number as far as one can tell?
fn agree(a: &BigInterval, b: &BigInterval) -> bool {
    let difference = a.clone() - b.clone();
    let scale = a.nearest().abs().max(1.0);
    difference.contains_zero() && difference.width() <= 1e-30 * scale
}

/// Is the enclosure narrow, and does it hold 0?
fn vanishes(value: &BigInterval) -> bool {
    value.contains_zero() && value.width() <= 1e-30
}

/// The value of a constant expression.
fn constant(text: &str) -> BigInterval {
    let function = Function::parse("x + value; value = 0").expect("an equation");
    let mut values = Parameters::default();
    values.set("value", text);
    let tape = function.tape(&values, PRECISION).unwrap_or_else(|e| panic!("{text}: {e}"));
    evaluator(&tape).evaluate([big(0.0), big(0.0), big(0.0)])
}

#[test]
fn every_surface_is_there_once() {
    let ids: Vec<&str> = Catalogue::builtin().iter().map(|s| s.id.as_str()).collect();
    assert_eq!(ids, IDS);
}

#[test]
fn every_equation_is_a_scene() {
    for surface in Catalogue::builtin().iter() {
        let scene = surface.scene().unwrap_or_else(|e| panic!("{}: {e:?}", surface.id));
        assert_eq!(scene.id, surface.id);
        assert_eq!(Some(scene.domain), surface.domain, "{}", surface.id);
        assert_eq!(scene.published_step, surface.published_step);
        if let Some(ball) = scene.domain.ball {
            // A ball that contains the box would cut nothing.
            assert!(2.0 * ball <= scene.domain.longest_side(), "{}", surface.id);
        }
        // Nothing is defined in vain.
        let function = surface.function().expect("it was read");
        let used: HashSet<&str> = function.parameters().iter().map(|p| p.name.as_str()).collect();
        for parameter in &surface.definitions.parameters {
            assert!(used.contains(parameter.name.as_str()), "{}: {}", surface.id, parameter.name);
        }
        assert_eq!(used.len(), surface.definitions.parameters.len(), "{}", surface.id);
    }
}

#[test]
fn references_lead_somewhere() {
    let keys = ["singh2010 ", "knoll2007 ", "ganacim2011 ", "stoll2006 "];
    for surface in Catalogue::builtin().iter() {
        let Surface { variant_of, form_of, algebraic_form, .. } = surface;
        for id in [variant_of, form_of, algebraic_form].into_iter().flatten() {
            assert!(IDS.contains(&id.as_str()) && *id != surface.id, "{}: {id}", surface.id);
        }
        assert!(!surface.papers.is_empty() && surface.sign.is_some(), "{}", surface.id);
        for paper in &surface.papers {
            assert!(keys.iter().any(|key| paper.starts_with(key)), "{}: {paper}", surface.id);
        }
        let is_smooth = surface.singular_kind.as_deref() == Some("none");
        assert!(!(is_smooth && surface.singular_locus.is_some()), "{}", surface.id);
    }
}

#[test]
fn degrees_are_those_of_the_functions() {
    for surface in Catalogue::builtin().iter() {
        assert_eq!(tape(surface).degree(), surface.degree, "{}", surface.id);
        assert!(surface.degree.is_none() || surface.zero_set_degree.is_none(), "{}", surface.id);
    }
}

#[test]
fn values_are_those_computed_elsewhere() {
    let rows =
        include_str!("../catalogue/values.csv").lines().filter(|line| !line.starts_with('#'));
    let mut ids = Vec::new();
    for row in rows.skip(1) {
        let columns: Vec<&str> = row.split(',').collect();
        let [id, x, y, z, expected] = columns[..] else { panic!("{row}") };
        let value = evaluator(&tape(surface(id))).evaluate([x, y, z].map(constant));
        let expected = constant(expected);
        let error = (value - expected.clone()).nearest().abs();
        assert!(error <= 1e-23 * expected.nearest().abs(), "{id}: off by {error:e}");
        ids.push(id);
    }
    assert_eq!(ids, IDS);
}

#[test]
fn parameters_are_exact() {
    let defaults = |id: &str| -> Vec<(String, String)> {
        let function = surface(id).function().expect("an equation");
        function.parameters().iter().map(|p| (p.name.clone(), p.default.clone())).collect()
    };
    let pair = |name: &str, value: &str| (name.to_owned(), value.to_owned());
    assert_eq!(defaults("barth-sextic"), [pair("phi", "(1+sqrt(5))/2")]);
    assert_eq!(defaults("labs-septic"), [pair("al", "root:7*a^3+7*a+1")]);
    assert_eq!(defaults("superquadric-0p75"), [pair("m", "0.75")]);

    // 20 digits, where decimals of doubles have 16.
    let near = |text: &str, digits: &str| {
        let error = constant(text) - constant(digits);
        assert!(error.nearest().abs() < 1e-20, "{text}");
    };
    near("(1+sqrt(5))/2", "1.6180339887498948482045868");
    near("root:7*a^3+7*a+1", "-0.14010685498712477645");
    near("sqrt(5-sqrt(5))", "1.662507751109813714359870");
}

#[test]
fn symmetries_hold() {
    for surface in Catalogue::builtin().iter() {
        let tape = tape(surface);
        let mut f = evaluator(&tape);
        for place in places(surface) {
            let value = f.evaluate(place.clone());
            for symmetry in &surface.symmetries {
                let image = symmetry.sign.apply(f.evaluate(symmetry.apply(&place)));
                assert!(agree(&value, &image), "{}: {symmetry}", surface.id);
            }
        }
    }
}

#[test]
fn rotations_hold() {
    let mut count = 0;
    for surface in Catalogue::builtin().iter() {
        let tape = tape(surface);
        let mut f = evaluator(&tape);
        for rotation in &surface.rotations {
            count += 1;
            let angles = match rotation.order {
                Some(order) => {
                    vec![big(2.0) * BigInterval::pi(PRECISION) / big(f64::from(order.get()))]
                }
                None => vec![big(0.5), big(2.0)],
            };
            let (a, b) = match rotation.axis {
                Axis::X => (1, 2),
                Axis::Y => (2, 0),
                Axis::Z => (0, 1),
            };
            for place in places(surface) {
                let value = f.evaluate(place.clone());
                for angle in &angles {
                    let cos = angle.clone().unary(Unary::Cos);
                    let sin = angle.clone().unary(Unary::Sin);
                    let mut image = place.clone();
                    image[a] = cos.clone() * place[a].clone() - sin.clone() * place[b].clone();
                    image[b] = sin * place[a].clone() + cos * place[b].clone();
                    assert!(agree(&value, &f.evaluate(image)), "{}: {rotation:?}", surface.id);
                }
            }
        }
    }
    assert!(count > 10, "{count} rotations");
}

#[test]
fn points_lie_on_their_surfaces() {
    for surface in Catalogue::builtin().iter() {
        let tape = tape(surface);
        let mut f = evaluator(&tape);
        for point in &surface.points {
            let value = f.evaluate(point.each_ref().map(|text| constant(text)));
            assert!(vanishes(&value), "{}: {point:?} gives {:?}", surface.id, value.to_f64());
        }
    }
}

#[test]
fn algebraic_forms_have_the_same_zeros() {
    for one in Catalogue::builtin().iter() {
        let Some(id) = &one.algebraic_form else { continue };
        let other = surface(id);
        assert_eq!(other.degree, one.zero_set_degree);
        assert!(one.points.len() > 2);
        for (points, tape) in [(&one.points, tape(other)), (&other.points, tape(one))] {
            for point in points {
                let value = evaluator(&tape).evaluate(point.each_ref().map(|text| constant(text)));
                assert!(vanishes(&value), "{}, {id}: {point:?}", one.id);
            }
        }
    }
}

#[test]
fn chmutov_surfaces_are_sums_of_chebyshev_polynomials() {
    let chmutov = |s: &&Surface| s.id.starts_with("chmutov-");
    for surface in Catalogue::builtin().functions().filter(chmutov) {
        let n = surface.degree.expect("a polynomial");
        let constant = n % 2;
        let text = format!("T({n}, x) + T({n}, y) + T({n}, z) + {constant}");
        let sum = Function::parse(&text).expect("an equation");
        let sum = sum.tape(&Parameters::default(), PRECISION).expect("no parameters");
        let tape = tape(surface);
        for place in places(surface) {
            let value = evaluator(&tape).evaluate(place.clone());
            assert!(agree(&value, &evaluator(&sum).evaluate(place)), "{}", surface.id);
        }
    }
}

#[test]
fn forms_have_the_same_f_everywhere() {
    // Coordinates in [-1, 1], at its ends, and outside.
    let inside = [constant("-3/7"), constant("2/3"), constant("1/9")];
    let ends = [big(1.0), big(-1.0), big(0.0)];
    let outside = [constant("-10/9"), constant("17/16"), constant("-3/2")];
    let mixed = [constant("4/7"), constant("-5/3"), constant("8/7")];
    let mut forms = 0;
    for form in Catalogue::builtin().iter() {
        let Some(id) = &form.form_of else { continue };
        forms += 1;
        let of = surface(id);
        assert!(of.form_of.is_none(), "{}", form.id);
        assert_eq!((form.domain, &form.sign), (of.domain, &of.sign), "{}", form.id);
        assert_eq!(form.degree.or(form.zero_set_degree), of.degree, "{}", form.id);
        let (f, g) = (tape(form), tape(of));
        assert_ne!(form.function(), of.function(), "{} is {id} itself", form.id);
        let fixed = [&inside, &ends, &outside, &mixed].map(Clone::clone);
        for place in places(form).into_iter().chain(fixed) {
            let (a, b) = (evaluator(&f).evaluate(place.clone()), evaluator(&g).evaluate(place));
            assert!(agree(&a, &b), "{}: {:?}, {id}: {:?}", form.id, a.to_f64(), b.to_f64());
        }
    }
    assert_eq!(forms, 18);
}

/// A surface's tape with a value for a parameter.
fn moved(surface: &Surface, name: &str, value: &str) -> Tape {
    let mut values = Parameters::default();
    values.set(name, value);
    let function = surface.function().expect("an equation");
    function.tape(&values, PRECISION).unwrap_or_else(|e| panic!("{name} = {value}: {e}"))
}

#[test]
fn the_superquadric_twists() {
    let twisting = surface("superquadric-twisting");
    let box_ = Function::parse("x^8 + y^8 + (z/2)^8 - 1").expect("an equation");
    let box_ = box_.tape(&Parameters::default(), PRECISION).expect("no parameters");
    let straight = moved(twisting, "twist", "0");
    let twisted = moved(twisting, "twist", "0.7");
    for place in places(twisting) {
        let value = evaluator(&box_).evaluate(place.clone());
        assert!(agree(&value, &evaluator(&straight).evaluate(place.clone())));
        // The slice at z, turned by 0.7 z.
        let [x, y, z] = place;
        let angle = constant("0.7") * z.clone();
        let (cos, sin) = (angle.clone().unary(Unary::Cos), angle.unary(Unary::Sin));
        let image = [cos.clone() * x.clone() - sin.clone() * y.clone(), sin * x + cos * y, z];
        assert!(agree(&value, &evaluator(&twisted).evaluate(image)));
    }
}

#[test]
fn the_balls_go_round_closed_curves() {
    let balls = surface("blinn-blobby-moving");
    let [start, halfway, end] = ["0", "pi", "2*pi"].map(|u| moved(balls, "u", u));
    let mut moved = 0;
    for place in places(balls) {
        let [a, b, c] =
            [&start, &halfway, &end].map(|tape| evaluator(tape).evaluate(place.clone()));
        assert!(agree(&a, &c), "{:?} {:?}", a.to_f64(), c.to_f64());
        moved += usize::from(!agree(&a, &b));
    }
    assert_eq!(moved, 6);
    // Apart at first, so that there is no ball at the origin; then one body around it.
    let centre = [big(0.0), big(0.0), big(0.0)];
    assert!(evaluator(&start).evaluate(centre.clone()).nearest() < 0.0);
    assert!(evaluator(&halfway).evaluate(centre).nearest() > 1.0);
}

#[test]
fn variants_are_related_as_stated() {
    let f = tape(surface("steiner"));
    let g = tape(surface("steiner-knoll"));
    for place in places(surface("steiner")) {
        let image = place.each_ref().map(|x| x.clone() * big(-2.0));
        let scaled = evaluator(&f).evaluate(image) / big(16.0);
        assert!(agree(&scaled, &evaluator(&g).evaluate(place)));
    }
    // Images of a sphere: (bc, 2ab, a^2 - b^2), (bc, ca, ab).
    let [a, b, c] = [big(2.0) / big(7.0), big(3.0) / big(7.0), big(6.0) / big(7.0)];
    let cross_cap = [
        b.clone() * c.clone(),
        big(2.0) * a.clone() * b.clone(),
        a.clone().sqr() - b.clone().sqr(),
    ];
    assert!(vanishes(&evaluator(&tape(surface("cross-cap"))).evaluate(cross_cap)));
    let root = big(2.0).unary(Unary::Sqrt);
    let [a, b, c] = [a, b, c].map(|x| x * root.clone());
    let steiner = [b.clone() * c.clone(), c * a.clone(), a * b];
    assert!(vanishes(&evaluator(&f).evaluate(steiner)));
}

/// Decimals of the nodes' coordinates.
const DECIMALS: usize = 24;

/// A coordinate in units of the last decimal.
fn units(text: &str) -> i128 {
    let (negative, digits) = match text.strip_prefix('-') {
        Some(digits) => (true, digits),
        None => (false, text),
    };
    let (whole, fraction) = digits.split_once('.').unwrap_or((digits, ""));
    let value: i128 = format!("{whole}{fraction:0<DECIMALS$}").parse().expect("digits");
    if negative { -value } else { value }
}

/// All nodes of each surface: those of the file, and their images under its symmetries.
fn nodes() -> BTreeMap<&'static str, BTreeSet<[i128; 3]>> {
    let mut nodes: BTreeMap<_, BTreeSet<[i128; 3]>> = BTreeMap::new();
    let rows = include_str!("../catalogue/nodes.csv").lines().filter(|line| !line.starts_with('#'));
    for row in rows.skip(1) {
        let columns: Vec<&str> = row.split(',').collect();
        let [id, x, y, z] = columns[..] else { panic!("{row}") };
        let all = nodes.entry(id).or_default();
        let mut new = vec![[units(x), units(y), units(z)]];
        while let Some(node) = new.pop() {
            if all.insert(node) {
                new.extend(surface(id).symmetries.iter().map(|symmetry| symmetry.apply(&node)));
            }
        }
    }
    nodes
}

#[test]
fn the_nodes_are_all_there() {
    let counts: Vec<(&str, usize)> = nodes().into_iter().map(|(id, all)| (id, all.len())).collect();
    let mut expected = NODES.to_vec();
    expected.sort_unstable();
    assert_eq!(counts, expected);
}

#[test]
fn values_and_gradients_vanish_at_nodes() {
    let last = constant("1e-24");
    let digits = |x: i128| {
        // Both halves are doubles.
        let (high, low) = (x >> 50, x & ((1 << 50) - 1));
        let units = big(high as f64) * big(f64::from(1_u32 << 25)).sqr() + big(low as f64);
        (units + BigInterval::from_bounds(-1.0, 1.0, PRECISION)) * last.clone()
    };
    for (id, nodes) in nodes() {
        let tape = tape(surface(id));
        let context = Dual::<_, 3>::constant_value(big(0.0));
        let mut f = tape.evaluator(&context);
        let variable = |value: [BigInterval; 3]| {
            let mut axis = 0;
            value.map(|x| {
                axis += 1;
                Dual::variable(x, axis - 1)
            })
        };
        // One of each four suffices: symmetries map nodes to nodes.
        for node in nodes.iter().step_by(if nodes.len() > 100 { 4 } else { 1 }) {
            let node = node.map(digits);
            let near = [
                node[0].clone() + constant("0.001"),
                node[1].clone() + constant("0.0007"),
                node[2].clone() + constant("0.0004"),
            ];
            let (at, beside) = (f.evaluate(variable(node)), f.evaluate(variable(near)));
            // F grows with the square of the distance from a node, 1e-6 here, the gradient with it.
            let magnitude =
                |x: &BigInterval| x.to_f64().into_iter().fold(0.0, |m, x| x.abs().max(m));
            assert!(at.value.contains_zero(), "{id}");
            assert!(magnitude(&at.value) < 1e-12 * magnitude(&beside.value), "{id}");
            let slope = beside.tangent.iter().map(magnitude).fold(0.0, f64::max);
            for derivative in &at.tangent {
                assert!(derivative.contains_zero(), "{id}");
                assert!(magnitude(derivative) < 1e-12 * slope, "{id}");
            }
        }
    }
}

#[test]
fn ids_that_are_nearly_right_are_suggested() {
    let suggest = |id| Catalogue::builtin().suggest(id);
    assert_eq!(suggest("barth-sextik")[0], "barth-sextic");
    assert_eq!(suggest("Torus")[0], "torus");
    assert_eq!(suggest("barth"), ["barth-decic", "barth-sextic"]);
    assert_eq!(suggest("chmutov").len(), 10);
    assert!(suggest("elephant").is_empty() && suggest("").is_empty());
}

#[test]
fn tables_are_those_of_the_equations() {
    // [knoll2007] writes the sum out; so do these five balls.
    let balls = surface("blobby-knoll");
    let Definitions { tables, .. } = &balls.definitions;
    let entry = |name: &str, i: usize| {
        let (_, entries) = tables.iter().find(|(n, _)| n == name).expect("a table");
        constant(&entries[i])
    };
    let tape = tape(balls);
    for [x, y, z] in places(balls) {
        let mut sum = big(-1.0);
        for i in 0..5 {
            let square = [(&x, "cx"), (&y, "cy"), (&z, "cz")]
                .map(|(x, name)| (x.clone() - entry(name, i)).sqr())
                .into_iter()
                .reduce(|a, b| a + b)
                .expect("three squares");
            sum = sum + entry("r", i).sqr() / square;
        }
        assert!(agree(&sum, &evaluator(&tape).evaluate([x, y, z])));
    }
}
