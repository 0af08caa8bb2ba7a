//! `genga`: draws 3-D models as anime and American comics from the command line.

mod args;
mod commands;
mod console;
mod failure;
mod gpu;
mod inspect;
mod keys;
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
    keep_wayland_quiet();
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

/// Mesa's Vulkan layer asks Wayland which GPU to prefer. Without a session, as on servers, that
/// prints an `error:` which is none; with a folder to look for the session in, it does not.
fn keep_wayland_quiet() {
    if cfg!(target_os = "linux") && std::env::var_os("XDG_RUNTIME_DIR").is_none() {
        #[allow(unsafe_code, reason = "the environment cannot be set otherwise")]
        // SAFETY: this is the first thing the program does, so there are no other threads.
        unsafe {
            std::env::set_var("XDG_RUNTIME_DIR", std::env::temp_dir());
        }
    }
}
