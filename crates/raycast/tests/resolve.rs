//! A surface is an id of the catalogue, else an existing file, else an equation.

use std::fs;
use std::path::{Path, PathBuf};

use glam::DVec3;
use zeroset_expr::Parameters;
use zeroset_raycast::Domain;
use zeroset_raycast::catalogue::{Catalogue, CatalogueError, ResolveError, resolve};

/// A file of that name with that text, in a folder of this test program.
fn file(name: &str, text: &str) -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("resolve");
    fs::create_dir_all(&folder).expect("a folder");
    let path = folder.join(name);
    fs::write(&path, text).expect("a file");
    path
}

fn text(path: &Path) -> &str {
    path.to_str().expect("an ordinary path")
}

fn error(text: &str) -> ResolveError {
    resolve(text, None).expect_err("it is no surface")
}

const EGG: &str = r#"
[[surface]]
id = "egg"
equation = "x^2 + y^2 + (z/a)^2 = 1"
params = { a = 1.50 }
domain = [-2, -2, -2, 2, 2, 2]
ball = 1.75
"#;

const PAIR: &str = r#"
[[surface]]
id = "torus"
equation = "(sqrt(x^2 + y^2) - 1)^2 + z^2 = 0.01"

[[surface]]
id = "sum"
equation = "sum(i, 1, 3, t[i]*x^i) - y"
tables = { t = [1_0.5e0, 2, "sqrt(2)"] }
"#;

#[test]
fn ids_come_first() {
    let surface = resolve(" barth-sextic\n", None).expect("an id");
    assert_eq!(surface.name, "Barth sextic");
    let own = Catalogue::parse(PAIR, "own.toml").expect("a catalogue");
    let surface = resolve("torus", Some(&own)).expect("an id of both");
    assert!(surface.equation.contains("0.01"));
    assert_eq!(resolve("sphere", Some(&own)).expect("an id").id, "sphere");
}

#[test]
fn files_hold_a_catalogue_or_an_equation() {
    let egg = file("egg.toml", EGG);
    let surface = resolve(text(&egg), None).expect("one surface");
    assert_eq!((surface.id.as_str(), surface.name.as_str()), ("egg", "egg"));
    assert_eq!(surface.definitions.parameters[0].default, "1.50");
    assert_eq!(surface.domain.and_then(|domain| domain.ball), Some(1.75));

    let pair = file("pair.toml", PAIR);
    let message = error(text(&pair)).to_string();
    assert!(message.contains("pair.toml#torus; there are torus, sum"), "{message}");
    let chosen = format!("{}#sum", text(&pair));
    let surface = resolve(&chosen, None).expect("it says which");
    assert_eq!(
        surface.definitions.tables,
        [("t".into(), vec!["10.5e0".into(), "2".into(), "sqrt(2)".into()])]
    );
    surface.scene().expect("an equation");
    let missing = format!("{}#ring", text(&pair));
    assert!(matches!(error(&missing), ResolveError::NotInFile { id, .. } if id == "ring"));

    let ball = file("ball.txt", "# a ball\r\nx^2 + y^2 # and\r\n  + z^2 = r^2;\nr = 3 # large");
    let surface = resolve(text(&ball), None).expect("an equation");
    assert_eq!(surface.id, "ball");
    let scene = surface.scene().expect("an equation");
    assert!(scene.domain.min.x < -3.0 && scene.domain.min.x > -4.0);

    let broken = file("broken.txt", "# a comment\nx^2 + * y");
    let ResolveError::EquationInFile { file: named, error: fault } = error(text(&broken)) else {
        panic!("it cannot be read")
    };
    assert_eq!(named, text(&broken));
    assert_eq!(fault.span.start, "# a comment\nx^2 + ".len());

    let marked = file("marked.txt", "\u{feff}x^2 + y^2 = 1\r\n");
    resolve(text(&marked), None).expect("a byte order mark is no part of the equation");
    let folder = marked.parent().expect("a folder");
    assert!(matches!(error(text(folder)), ResolveError::Folder(_)));
    let long = file("long.txt", &"#".repeat(2 << 20));
    assert!(error(text(&long)).to_string().contains("longer than"));
}

#[test]
fn anything_else_is_an_equation() {
    let surface = resolve("x^2 + y^2 + z^2 = 1", None).expect("an equation");
    assert_eq!(surface.id, "x^2 + y^2 + z^2 = 1");
    assert!(surface.domain.is_none());
    assert!(matches!(error("x^2 +"), ResolveError::Equation(_)));
    assert!(matches!(error("2x"), ResolveError::Equation(_)));
    assert!(matches!(error(""), ResolveError::Equation(_)));
}

#[test]
fn what_looks_like_an_id_is_answered_with_ids() {
    let message = error("barth-sextik").to_string();
    assert!(message.contains("\"barth-sextik\"") && message.contains("barth-sextic"), "{message}");
    assert!(
        matches!(error("elephant"), ResolveError::Unknown { suggestions, .. } if suggestions.is_empty())
    );
    let own = Catalogue::parse(EGG, "own.toml").expect("a catalogue");
    let message = resolve("eg", Some(&own)).expect_err("not quite").to_string();
    assert!(message.contains("\"eg\""), "{message}");
}

#[test]
fn missing_files_are_missed() {
    for path in ["own.toml", "no/such/file.txt", "./egg", "own.toml#egg"] {
        assert_eq!(error(path), ResolveError::NoFile(path.into()));
    }
}

#[test]
fn what_is_wrong_in_a_catalogue_is_said_with_its_place() {
    let head = "[[surface]]\nid = \"egg\"\nequation = \"x^2 + y^2 + z^2 = 1\"\n";
    let cases = [
        (
            format!("{head}colour = 3\n"),
            "own.toml:4, surface egg, key colour: unknown field `colour`",
        ),
        (format!("{head}degree = \"two\"\n"), "own.toml:4, surface egg, key degree: invalid type"),
        (format!("{head}domain = [0, 0, 0, 1, 1]\n"), "own.toml:4, surface egg, key domain: "),
        (
            format!("{head}\n\ndomain = [0, 0, 0, 1, -1, 1]\n"),
            "own.toml:6, surface egg, key domain: the domain's y range [0, -1]",
        ),
        (
            format!("{head}domain = [0, 0, 0, 1, inf, 1]\n"),
            "key domain: the domain's y range [0, inf]",
        ),
        (
            format!("{head}domain = [0, 0, 0, 1, 1, 1]\nball = 0\n"),
            "own.toml:5, surface egg, key ball: the domain's ball has radius 0",
        ),
        (format!("{head}ball = 1\n"), "key ball: a ball needs a domain"),
        (
            format!("{head}params = {{ a = true }}\n"),
            "own.toml:4, surface egg, key params: true is no constant",
        ),
        (format!("{head}params = {{ a = nan }}\n"), "key params: nan is no constant"),
        (format!("{head}status = \"fine\"\n"), "key status: unknown variant `fine`"),
        (
            format!("{head}symmetries = [\n  \"(x, y, z)\",\n  \"(x, x, z)\",\n]\n"),
            "own.toml:4, surface egg, key symmetries: \"(x, x, z)\" is no symmetry",
        ),
        (format!("{head}rotations = [{{ axis = \"z\", order = 0 }}]\n"), "key rotations: "),
        (
            format!("{head}published_step = -0.1\n"),
            "key published_step: the step -0.1 is not above 0",
        ),
        (format!("{head}{head}"), "own.toml:5, surface egg, key id: there are two surfaces egg"),
        (head.replace("egg", "an egg"), "own.toml:2, surface an egg, key id: \"an egg\" is no id"),
        (head.replace("y^2", "y^"), "own.toml:3, surface egg, key equation: "),
        (
            head.replace("\"x^2 + y^2 + z^2 = 1\"", "\"\"\"\nx^2 + y^2\n+ c*z^2\n = 1\"\"\""),
            "own.toml:5, surface egg, key equation: ",
        ),
        (head.replace("y^2", "b*y^2"), "own.toml:3, surface egg, key equation: "),
        ("[[surface]]\nid = \"egg\"\n".into(), "own.toml:1, surface egg: missing field `equation`"),
        (format!("{head}facts = [\"open\n"), "own.toml:4, surface egg, key facts: "),
        ("[surfaces]\n".into(), "own.toml:1: unknown field `surfaces`"),
        (String::new(), "own.toml has no surface"),
    ];
    for (text, says) in cases {
        let message = Catalogue::parse(&text, "own.toml").expect_err(&text).to_string();
        assert!(message.contains(says), "{says:?} is not in {message:?}");
        assert!(!message.contains('\n'), "{message:?}");
    }
}

#[test]
fn unreadable_files_are_named() {
    let error = Catalogue::load(Path::new("no/such.toml")).expect_err("there is none");
    assert!(matches!(&error, CatalogueError::Unreadable { file, .. } if file == "no/such.toml"));
    let path = file("latin1.toml", "");
    fs::write(&path, [0x66, 0xe9]).expect("a file");
    assert!(matches!(Catalogue::load(&path), Err(CatalogueError::Unreadable { .. })));
}

/// The domain of an equation.
fn found(equation: &str) -> Domain {
    let surface = resolve(equation, None).unwrap_or_else(|e| panic!("{equation}: {e}"));
    surface.scene().expect("it was read").domain
}

fn cube(half: f64) -> Domain {
    Domain::new(DVec3::splat(-half), DVec3::splat(half)).expect("a domain")
}

#[test]
fn bounded_surfaces_get_a_box_around_them() {
    for (equation, min, max) in [
        ("x^2 + y^2 + z^2 = 1", DVec3::splat(-1.0), DVec3::splat(1.0)),
        ("x^2 + y^2 + z^2 = 9", DVec3::splat(-3.0), DVec3::splat(3.0)),
        ("(x/4)^2 + y^2 + (4*z)^2 = 1", DVec3::new(-4.0, -1.0, -0.25), DVec3::new(4.0, 1.0, 0.25)),
        ("(x-10)^2 + y^2 + z^2 = 1", DVec3::new(9.0, -1.0, -1.0), DVec3::new(11.0, 1.0, 1.0)),
        ("x^4 - x^3 + y^2 + z^2", DVec3::new(0.0, -0.33, -0.33), DVec3::new(1.0, 0.33, 0.33)),
    ] {
        let domain = found(equation);
        let slack = 0.1 * (max - min).max_element();
        for axis in 0..3 {
            let (lo, hi) = (domain.min[axis], domain.max[axis]);
            assert!(lo < min[axis] && lo > min[axis] - slack, "{equation}: {domain:?}");
            assert!(hi > max[axis] && hi < max[axis] + slack, "{equation}: {domain:?}");
        }
    }
}

#[test]
fn unbounded_surfaces_get_the_first_cube_that_they_meet() {
    for (equation, half) in [
        ("x*y", 2.0),
        ("x^2 + y^2 = 1", 2.0),
        ("z = sin(x)*sin(y)", 2.0),
        ("1/(x-y^2) - z", 2.0),
        ("z = 10", 16.0),
        ("z = 1000", 2.0),
        // Nothing at all, and nothing that is defined.
        ("x^2 + 1", 2.0),
        ("sqrt(-1 - x^2) + y", 2.0),
    ] {
        assert_eq!(found(equation), cube(half), "{equation}");
    }
}

#[test]
fn parameters_change_the_domain_that_is_found() {
    let surface = resolve("x^2 + y^2 + z^2 = r^2; r = 1", None).expect("an equation");
    let mut parameters = Parameters::default();
    parameters.set("r", "5");
    let scene = surface.scene_with(&parameters).expect("it was read");
    assert!(scene.domain.max.z > 5.0 && scene.domain.max.z < 6.5);
    assert_eq!(scene.parameters, parameters);
    // Values that are none are not this part's concern.
    parameters.set("r", "no number");
    assert_eq!(surface.scene_with(&parameters).expect("it was read").domain, cube(2.0));
}

#[test]
fn the_same_equation_has_the_same_domain() {
    for surface in Catalogue::builtin().functions().filter(|s| s.equation.len() < 400) {
        let mut surface = surface.clone();
        surface.domain = None;
        let once = surface.scene().expect("an equation").domain;
        Domain::new(once.min, once.max).unwrap_or_else(|e| panic!("{}: {e}", surface.id));
        assert_eq!(once, surface.scene().expect("an equation").domain, "{}", surface.id);
    }
}
