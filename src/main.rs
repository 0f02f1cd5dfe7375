//! The `petroglyph` program.

#[global_allocator]
static MEMORY: survey::kept_memory::ProgramMemory = survey::kept_memory::ProgramMemory;

fn main() -> std::process::ExitCode {
    petroglyph::main()
}
