//! `genga`: draws 3-D models as anime and American comics from the command line.

mod args;
mod commands;
mod console;
mod failure;
mod gpu;
mod inspect;
mod model;
mod names;
mod output;
mod save;
mod snippet;
mod source;
mod style_choice;
mod template;
mod text;
mod view;

use std::process::ExitCode;

use clap::Parser as _;

use args::{Args, Command};
use console::Console;

fn main() -> ExitCode {
    // Prints help and usage errors itself, and ends with status 0 and 2.
    let args = Args::parse();
    start_log(args.verbose, args.quiet);
    let console = Console::new(args.quiet);
    let result = match args.command {
        Command::Render(args) => commands::render::run(&args, &console),
        Command::Turntable(args) => commands::turntable::run(&args, &console),
        Command::Info(args) => commands::info::run(&args, &console),
        Command::Styles(args) => commands::styles::run(&args),
        Command::Check(args) => commands::check::run(&args, &console),
        Command::Schema(args) => commands::schema::run(&args),
        Command::Adapters(args) => commands::adapters::run(&args),
        Command::Bench(args) => commands::bench::run(&args, &console),
    };
    match result {
        Ok(()) => ExitCode::SUCCESS,
        Err(failure) => {
            failure.print(&console);
            failure.exit_code()
        }
    }
}

/// Messages of the libraries, on standard error. `RUST_LOG` wins over `-v`.
fn start_log(verbose: u8, quiet: bool) {
    let filter = match (quiet, verbose) {
        (true, _) | (false, 0) => "off",
        (false, 1) => "warn,genga=info",
        (false, 2) => "info,genga=debug",
        (false, _) => "debug",
    };
    let env = env_logger::Env::default().default_filter_or(filter);
    env_logger::Builder::from_env(env).init();
}
