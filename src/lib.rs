//! A research test bed for ray casting implicit surfaces f(x, y, z) = 0: the methods of published
//! papers on the same equations, rays and machine, judged by a reference that proves what it says.
//!
//! This page is a guided tour, from an equation to a judged picture. The command line does the same:
//! `zeroset compare barth-sextic`.
//!
//! # 1. An equation becomes a function
//!
//! ```
//! use zeroset::expr::Function;
//!
//! let torus = Function::parse("(x^2 + y^2 + z^2 + 1 - r^2)^2 = 4*(x^2 + y^2); r = 0.5")?;
//! assert_eq!(torus.parameters()[0].name, "r");
//!
//! // Errors say where, and what was expected.
//! let error = Function::parse("x^2 + y^^2").unwrap_err();
//! assert_eq!(error.span.start, 8);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! Constants and parameters stay exact: 0.1 is no binary fraction, and an interval that contains it
//! must say so. See [`expr`].
//!
//! # 2. A function is evaluated over any number
//!
//! With values for its parameters, a function is a [`Tape`](expr::Tape). The same tape runs over
//! floats, intervals and duals; over SIMD lanes of each; and over intervals of any precision.
//!
//! ```
//! use zeroset::expr::{Function, Parameters};
//! use zeroset::ia::{Dual, Interval, Plain, Set};
//!
//! let sphere = Function::parse("x^2 + y^2 + z^2 = 1")?;
//! let tape = sphere.tape(&Parameters::default(), 128)?;
//! assert_eq!(tape.degree(), Some(2));
//!
//! // A value.
//! let value = tape.evaluator(&Plain(0.0)).evaluate([2.0, 0.0, 0.0].map(Plain));
//! assert_eq!(value.0, 3.0);
//!
//! // All values in the box [2, 3] x [0, 1] x [0, 1], enclosed: none is zero, so the box is empty.
//! type I = Interval<f64, Set>;
//! let range = [I::new(2.0, 3.0), I::new(0.0, 1.0), I::new(0.0, 1.0)];
//! let values = tape.evaluator(&I::point(0.0)).evaluate(range);
//! assert!(values.lo <= 3.0 && 10.0 <= values.hi && values.lo > 0.0);
//!
//! // The gradient.
//! let point = [0, 1, 2].map(|axis| Dual::<_, 3>::variable(Plain([1.0, 0.0, 0.0][axis]), axis));
//! let value = tape.evaluator(&point[0].clone()).evaluate(point);
//! assert_eq!(value.tangent.map(|t| t.0), [2.0, 0.0, 0.0]);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! Each number is written once, over machine reals; rounding belongs to the real. An
//! `Interval<f32>` is rounded outward and may prove; an `Interval<Nearest<f32>>` is what graphics
//! papers use, and may not. See [`ia`].
//!
//! # 3. A method is prepared for a scene, and answers rays
//!
//! A [`Scene`](raycast::Scene) is a function and the [`Domain`](raycast::Domain) in which its roots
//! count. A [`Method`](raycast::Method) is an algorithm with its knobs; prepared for a scene it is
//! an [`Intersector`](raycast::Intersector), which answers many rays at once.
//!
//! ```
//! use glam::{DVec3, Vec3};
//! use zeroset::cpu::Bisection;
//! use zeroset::expr::Function;
//! use zeroset::raycast::{Certificate, Domain, Hits, Method, Progress, Ray, RayBatch, Rays};
//! use zeroset::raycast::{Request, Scene};
//!
//! let sphere = Function::parse("x^2 + y^2 + z^2 = 1")?;
//! let domain = Domain::new(DVec3::splat(-2.0), DVec3::splat(2.0))?;
//! let scene = Scene::new("sphere", sphere, domain);
//!
//! let mut method = Bisection::kmarch();
//! method.for_precision(1e-6, &scene);
//! let intersector = method.prepare(&scene)?;
//!
//! let from = Vec3::new(0.0, 0.0, -3.0);
//! let batch = RayBatch::new(vec![Ray::new(from, Vec3::Z), Ray::new(from, Vec3::X)]);
//! let mut hits = Hits::new(Request::First, 2);
//! intersector.intersect(Rays::Batch(&batch), &mut hits, &Progress::new())?;
//!
//! assert_eq!(hits.certificate, [Certificate::PROVEN_HIT, Certificate::PROVEN_MISS]);
//! let [lo, hi] = hits.bracket[0];
//! assert!(lo <= 2.0 && 2.0 <= hi && hi - lo <= 1e-6);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! An answer is a bracket on the ray and a [`Certificate`](raycast::Certificate): found something,
//! nothing before it, a root in it, each proven or not. See [`raycast`] for the contract, and
//! [`cpu`] for the methods.
//!
//! # 4. Surfaces have names
//!
//! ```
//! use zeroset::raycast::catalogue::{self, Catalogue};
//!
//! let barth = Catalogue::builtin().get("barth-sextic").unwrap();
//! assert_eq!(barth.degree, Some(6));
//! assert!(barth.papers.iter().any(|paper| paper.starts_with("knoll2007")));
//!
//! // An id, a file or an equation, as on the command line; the domain is found from the function.
//! let scene = catalogue::resolve("x^2 + y^2 + z^2 = 9", None)?.scene()?;
//! assert!(scene.domain.min.x < -3.0 && 3.0 < scene.domain.max.x);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! # 5. Answers are judged, then timed
//!
//! ```
//! use zeroset::bench::{self, Options, Verdict};
//! use zeroset::raycast::{Camera, Progress, Rays, View, catalogue::Catalogue};
//!
//! let scene = Catalogue::builtin().get("torus").unwrap().scene()?;
//! let view = View::new(Camera::facing(&scene.domain), 32, 32);
//! let options = Options { runs: 1, ..Options::default() };
//! let methods = [bench::method("amp-sign")?, bench::method("kmarch")?];
//! let comparison = bench::compare(
//!     &scene,
//!     Rays::View(&view),
//!     &methods,
//!     &options,
//!     &Progress::new(),
//!     &mut |_stage, _share| {},
//! );
//! let kmarch = comparison.runs[1].outcome.as_ref().unwrap();
//! let judgement = kmarch.judgement.as_ref().unwrap();
//! assert_eq!(judgement.tally.count(Verdict::FalseMiss), 0);
//! assert_eq!(judgement.lies, []);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! The reference says of each ray whether its first root crosses the surface, touches it, or does
//! not exist; every answer, and every claim of its certificate, is held against that. See [`mod@bench`],
//! and [`shade`] for pictures and error maps.
//!
//! # 6. A method of your own
//!
//! Implement [`Method`](raycast::Method) and [`Intersector`](raycast::Intersector), add it to a
//! [`Registry`](bench::Registry), and hand it to [`bench::compare`](fn@bench::compare) and
//! [`bench::check`]. `examples/custom-method` in the repository is such a package.

pub use zeroset_beam as beam;
pub use zeroset_bench as bench;
pub use zeroset_cpu as cpu;
pub use zeroset_expr as expr;
pub use zeroset_gpu as gpu;
pub use zeroset_ia as ia;
pub use zeroset_model as model;
pub use zeroset_quadric as quadric;
pub use zeroset_raycast as raycast;
pub use zeroset_shade as shade;
