//! The `petroglyph` program.

#[global_allocator]
static MEMORY: system::kept_memory::ProgramMemory = system::kept_memory::ProgramMemory;

fn main() -> std::process::ExitCode {
    petroglyph::main()
}
