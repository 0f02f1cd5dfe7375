//! The `petroglyph` program.

mod bench;
mod cli;

fn main() -> std::process::ExitCode {
    cli::main()
}
