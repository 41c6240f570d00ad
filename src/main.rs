//! The command line.
//!
//! Results go to standard output, progress and warnings to standard error. The exit status is 0 for
//! done, 1 for a failure, 2 for wrong usage, 130 for an interruption.

mod animate;
mod camera;
mod compare;
mod destination;
mod devices;
mod failure;
mod frame;
mod lighting;
mod list;
mod motion;
mod numbers;
mod options;
mod output;
mod pictures;
mod pieces;
mod ray_file;
mod render;
mod resident;
mod show;
mod slim;
mod surface;
mod table;
mod trace;
mod track;
mod tune;
mod volume;
mod watch;

use std::process::ExitCode;

use clap::{Parser, Subcommand};

use crate::failure::Failure;

/// A research test bed for ray casting implicit surfaces f(x, y, z) = 0.
#[derive(Parser, Debug)]
#[command(version = concat!(env!("CARGO_PKG_VERSION"), " (", env!("ZEROSET_REVISION"), ")"))]
#[command(after_help = "Start with: zeroset compare barth-sextic")]
struct CommandLine {
    #[command(subcommand)]
    command: Command,
    /// Worker threads [default: one a core]
    #[arg(long, global = true, value_name = "N", value_parser = options::threads)]
    #[arg(allow_hyphen_values = true, display_order = 900)]
    threads: Option<usize>,
}

#[derive(Subcommand, Debug)]
enum Command {
    List(list::List),
    Show(show::Show),
    Render(Box<render::Render>),
    Compare(Box<compare::Compare>),
    Trace(Box<trace::Trace>),
    Tune(Box<tune::Tune>),
    Slim(slim::SlimCommand),
    Volume(volume::VolumeCommand),
    Devices(devices::Devices),
}

fn main() -> ExitCode {
    let command_line = CommandLine::parse();
    match run(&command_line) {
        Ok(()) => ExitCode::SUCCESS,
        Err(failure) => {
            eprintln!("zeroset: {failure}");
            failure.status()
        }
    }
}

fn run(command_line: &CommandLine) -> Result<(), Failure> {
    if let Some(threads) = command_line.threads {
        rayon::ThreadPoolBuilder::new()
            .num_threads(threads)
            .build_global()
            .map_err(|error| Failure::work(format!("cannot start {threads} threads: {error}")))?;
    }
    match &command_line.command {
        Command::List(list) => list.run(),
        Command::Show(show) => show.run(),
        Command::Render(render) => render.run(),
        Command::Compare(compare) => compare.run(),
        Command::Trace(trace) => trace.run(),
        Command::Tune(tune) => tune.run(),
        Command::Slim(command) => command.run(),
        Command::Volume(command) => command.run(),
        Command::Devices(devices) => devices.run(),
    }
}
