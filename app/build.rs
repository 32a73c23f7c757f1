//! Has functions of the same code share it in the linked program, where the linker that Rust brings along does it: a MB of 33. Lets the tests of
//! the suite `commands` run in larger number than there are processors.

/// They wait for programs, simulated controllers and time-outs and compute for a seventh of their time: with as many as processors these would
/// have nothing to do.
const TESTS_PER_PROCESSOR: usize = 4;

fn main() {
    println!("cargo:rerun-if-changed=build.rs");
    println!("cargo:rerun-if-env-changed=RUSTC_LINKER");
    // Rust links with its own LLD for this target alone (release notes of Rust 1.90); others have linkers without the option, and so may one that was chosen, as Zig's, by
    // which packages are made for an old C library.
    let is_usual = std::env::var_os("RUSTC_LINKER").is_none();
    if is_usual && std::env::var("TARGET").is_ok_and(|target| target == "x86_64-unknown-linux-gnu") {
        println!("cargo:rustc-link-arg-bins=-Wl,--icf=all");
    }
    // Cargo sets what a build script sets for the tests of this package too, and for no others: those of the window and of the tuner compute, and
    // go on with one test for each processor.
    println!("cargo:rerun-if-env-changed=RUST_TEST_THREADS");
    if std::env::var_os("RUST_TEST_THREADS").is_none() {
        let processors = std::thread::available_parallelism().map_or(1, usize::from);
        println!("cargo:rustc-env=RUST_TEST_THREADS={}", TESTS_PER_PROCESSOR * processors);
    }
}
