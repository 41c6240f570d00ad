//! `zeroset list`: what there is.

use clap::{Args, ValueEnum};
use comfy_table::{Table, presets};
use serde_json::{Value, json};
use zeroset::bench::Registry;
use zeroset::raycast::Method;
use zeroset::raycast::catalogue::{Catalogue, Surface};

use crate::failure::Failure;
use crate::output;
use crate::pieces::BUILTINS;

/// Lists the surfaces of the catalogue, and the methods with their knobs.
#[derive(Args, Clone, Debug)]
pub(crate) struct List {
    /// What is listed [default: both]
    #[arg(value_enum)]
    what: Option<What>,
    /// Prints JSON: {"surfaces": [..], "methods": [..]}, or one of the lists
    #[arg(long)]
    json: bool,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum What {
    Surfaces,
    Methods,
}

impl List {
    /// Runs the command.
    pub(crate) fn run(&self) -> Result<(), Failure> {
        let text = if self.json {
            let value = match self.what {
                Some(What::Surfaces) => surfaces_json(),
                Some(What::Methods) => methods_json(),
                None => json!({ "surfaces": surfaces_json(), "methods": methods_json() }),
            };
            format!("{value:#}\n")
        } else {
            match self.what {
                Some(What::Surfaces) => surfaces(),
                Some(What::Methods) => methods(),
                None => format!("{}\n{}", surfaces(), methods()),
            }
        };
        output::print(text.as_bytes())
    }
}

fn surfaces() -> String {
    let mut table = Table::new();
    table.load_preset(presets::NOTHING).set_header(["surface", "degree", "name"]);
    for surface in Catalogue::builtin().iter() {
        table.add_row([surface.id.clone(), degree(surface), surface.name.clone()]);
    }
    for builtin in &BUILTINS {
        table.add_row([builtin.id, "2", builtin.name]);
    }
    format!("{}\n", table.trim_fmt())
}

/// The degree, or that there is none.
fn degree(surface: &Surface) -> String {
    surface.degree.map_or_else(|| "-".into(), |d| d.to_string())
}

fn surfaces_json() -> Value {
    let surfaces = Catalogue::builtin().iter().map(|surface| {
        let parameters: serde_json::Map<String, Value> = surface
            .definitions
            .parameters
            .iter()
            .map(|p| (p.name.clone(), p.default.clone().into()))
            .collect();
        let domain = surface
            .domain
            .map(|d| json!({ "min": d.min.to_array(), "max": d.max.to_array(), "ball": d.ball }));
        json!({
            "id": surface.id,
            "name": surface.name,
            "equation": surface.equation,
            "parameters": parameters,
            "degree": surface.degree,
            "domain": domain,
            "papers": surface.papers,
            "simple_roots_only": surface.simple_roots_only,
        })
    });
    surfaces.collect()
}

fn methods() -> String {
    let mut text = String::new();
    for method in Registry::standard().iter() {
        text += &format!("{}: {}\n", method.id(), method.summary());
        for knob in method.knobs() {
            let setting = format!("{}.{}={}", method.id(), knob.name, knob.value);
            text += &format!("  {setting:<34} {}\n", knob.doc);
        }
    }
    text
}

fn methods_json() -> Value {
    let registry = Registry::standard();
    let methods = registry.iter().map(|method: &dyn Method| {
        let knobs: Vec<_> = method
            .knobs()
            .iter()
            .map(|knob| json!({ "name": knob.name, "value": knob.value, "doc": knob.doc }))
            .collect();
        json!({ "id": method.id(), "summary": method.summary(), "knobs": knobs })
    });
    methods.collect()
}
