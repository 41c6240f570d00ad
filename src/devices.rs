//! `zeroset devices`: what methods on the GPU can run on.

use clap::Args;
use comfy_table::{Table, presets};
use serde_json::json;
use zeroset::gpu::{AdapterReport, adapters, device};

use crate::failure::Failure;
use crate::output;

/// Lists the devices for methods whose ids end in -gpu, by the numbers that --device takes.
#[derive(Args, Clone, Debug)]
pub(crate) struct Devices {
    /// Prints JSON
    #[arg(long)]
    json: bool,
}

impl Devices {
    /// Runs the command.
    pub(crate) fn run(&self) -> Result<(), Failure> {
        let adapters = adapters();
        let text = if self.json {
            let list: Vec<_> = adapters
                .iter()
                .map(|a| {
                    json!({
                        "name": a.name,
                        "kind": a.kind,
                        "backend": a.backend,
                        "driver": a.driver,
                        "largest_binding": a.largest_binding,
                        "timestamps": a.timestamps,
                    })
                })
                .collect();
            format!("{:#}\n", json!(list))
        } else if adapters.is_empty() {
            format!("{}\n", zeroset::gpu::DeviceError::NoAdapter)
        } else {
            table(&adapters)
        };
        output::print(text.as_bytes())
    }
}

fn table(adapters: &[AdapterReport]) -> String {
    let mut table = Table::new();
    table.load_preset(presets::NOTHING);
    table.set_header(["number", "name", "kind", "interface", "driver", "largest buffer", "clock"]);
    for (number, a) in adapters.iter().enumerate() {
        table.add_row([
            number.to_string(),
            a.name.clone(),
            a.kind.into(),
            a.backend.clone(),
            a.driver.clone(),
            format!("{} MiB", a.largest_binding >> 20),
            if a.timestamps { "yes" } else { "no" }.into(),
        ]);
    }
    format!(
        "{}\n\nNumber 0 is used unless --device or the variable {} names another.\n",
        table.trim_fmt(),
        device::VARIABLE
    )
}
