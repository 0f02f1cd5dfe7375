//! Links the program of a debug build at a fixed address. It then starts in a third of the time, and the tests start it
//! thousands of times (`tests/it/steps`). Release builds are linked as usual, to be loaded anywhere.

use std::env;

fn main() {
    println!("cargo:rerun-if-changed=build.rs");
    let is = |name: &str, wanted: &str| env::var(name).is_ok_and(|found| found == wanted);
    if is("PROFILE", "debug") && is("CARGO_CFG_TARGET_OS", "linux") && is("CARGO_CFG_TARGET_ENV", "gnu") {
        println!("cargo:rustc-link-arg-bins=-no-pie");
    }
}
