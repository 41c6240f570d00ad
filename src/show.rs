//! `zeroset show`: what is known of a surface.

use clap::Args;
use zeroset::raycast::catalogue::{Rotation, Status, Surface};
use zeroset::raycast::{Blending, Bound, Domain, Geometry, Patch, Scene, Sides};

use crate::failure::Failure;
use crate::{output, pieces, surface};

/// Shows a surface: its equation, its source, and what is known of it.
#[derive(Args, Clone, Debug)]
pub(crate) struct Show {
    /// A catalogue id; else a file that holds an equation, or pieces (FILE.slim, FILE.tets), or a
    /// catalogue of your own: FILE.toml, or FILE.toml#ID; else an equation such as "x^4+y^4+z^4=1"
    #[arg(value_name = "SURFACE", allow_hyphen_values = true)]
    surface: String,
}

impl Show {
    /// Runs the command.
    pub(crate) fn run(&self) -> Result<(), Failure> {
        let lines = match pieces::scene(&self.surface)? {
            Some(scene) => of_pieces(&scene),
            None => self.of_function()?,
        };
        let text: String = lines
            .iter()
            .map(|(key, value)| {
                format!("{key:<11}{}\n", value.replace('\n', &format!("\n{:11}", "")))
            })
            .collect();
        output::print(text.as_bytes())
    }

    fn of_function(&self) -> Result<Vec<(&'static str, String)>, Failure> {
        let surface = surface::resolve(&self.surface)?;
        let function = surface.function().map_err(|error| surface::unreadable(&error))?;
        let scene = surface.scene().map_err(|error| surface::unreadable(&error))?;
        let mut lines = vec![("surface", format!("{} ({})", surface.id, surface.name))];
        if surface.name == surface.id {
            lines.clear();
        }
        lines.push(("f", surface.equation.trim().to_owned()));
        for parameter in function.parameters() {
            lines.push(("parameter", format!("{} = {}", parameter.name, parameter.default)));
        }
        let tape = function.tape(&scene.parameters, 128).map_err(Failure::usage)?;
        if let Some(degree) = tape.degree() {
            lines.push(("degree", degree.to_string()));
        }
        lines.push(("domain", domain(&scene.domain)));
        lines.extend(facts(&surface));
        Ok(lines)
    }
}

/// What there is to say of a surface in pieces.
fn of_pieces(scene: &Scene) -> Vec<(&'static str, String)> {
    let mut lines = vec![("surface", scene.id.clone())];
    if let Geometry::Patches(patches) = &scene.geometry {
        let balls = |p: &&Patch| matches!(p.bound, Bound::Ball { .. });
        let balls = patches.all().iter().filter(balls).count();
        let solids = patches.all().len() - balls;
        lines.push(("pieces", format!("{balls} in balls, {solids} in tetrahedra")));
        let sides = match patches.sides() {
            Sides::Front => "seen from outside",
            Sides::Both => "seen from both sides",
        };
        let blending = match patches.blending() {
            Blending::None => "the first hit counts".into(),
            Blending::Weighted { offset } => format!("blended, with an offset of {offset} radii"),
        };
        lines.push(("hits", format!("{sides}; {blending}")));
    }
    lines.push(("domain", domain(&scene.domain)));
    lines
}

fn domain(domain: &Domain) -> String {
    let Domain { min, max, ball } = domain;
    let side = |axis: usize| format!("[{}, {}]", min[axis], max[axis]);
    let sides = format!("{} x {} x {}", side(0), side(1), side(2));
    ball.map_or_else(|| sides.clone(), |r| format!("{sides}, cut with a ball of radius {r}"))
}

fn rotation(rotation: &Rotation) -> String {
    let axis = ["x", "y", "z"][rotation.axis as usize];
    match rotation.order {
        Some(order) => format!("by 360/{order} degrees about {axis}"),
        None => format!("by any angle about {axis}"),
    }
}

/// What a catalogue knows of a surface.
fn facts(surface: &Surface) -> Vec<(&'static str, String)> {
    let mut facts: Vec<(&str, String)> = Vec::new();
    let mut add = |key, value: &Option<String>| {
        if let Some(value) = value {
            facts.push((key, value.clone()));
        }
    };
    add("same as", &surface.algebraic_form);
    add("variant of", &surface.variant_of);
    add("form of", &surface.form_of);
    add("printed as", &surface.printed_as);
    add("correction", &surface.correction);
    add("sign", &surface.sign);
    add("singular", &surface.singular_kind);
    add("where", &surface.singular_locus);
    facts.extend(surface.papers.iter().map(|paper| ("source", paper.clone())));
    let doubt = match surface.status {
        Status::Sound => None,
        Status::Ambiguous => Some("the sources leave open which equation is meant"),
        Status::Printed => Some("as printed, though probably not meant"),
        Status::Variant => Some("implied by a paper, not printed"),
        Status::Chosen => Some("values that no paper publishes were chosen"),
    };
    facts.extend(doubt.map(|doubt| ("status", doubt.into())));
    if let Some(step) = surface.published_step {
        facts.push(("AMP step", format!("{step} [singh2010], Table 1")));
    }
    if !surface.simple_roots_only {
        facts
            .push(("roots", "sheets touch or cross: tests for a change of sign lose parts".into()));
    }
    facts.extend(surface.symmetries.iter().map(|s| ("symmetry", s.to_string())));
    facts.extend(surface.rotations.iter().map(|r| ("rotation", rotation(r))));
    facts.extend(surface.facts.iter().map(|fact| ("fact", fact.clone())));
    facts
}
