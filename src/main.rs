//! The `petroglyph` program.

fn main() -> std::process::ExitCode {
    petroglyph::main()
}
