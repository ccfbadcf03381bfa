//! The program `conelab`.

use clap::Parser;
use std::process::ExitCode;

fn main() -> ExitCode {
    match conelab::commands::run(conelab::commands::Cli::parse()) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("{}", conelab::commands::told(&error));
            ExitCode::FAILURE
        }
    }
}
