//! Lets the tests of this package, which are those of the built program, run in larger number than there are processors.

/// They wait for programs, simulated controllers and time-outs and compute for a fifth of their time.
const TESTS_PER_PROCESSOR: usize = 4;

/// Cargo sets what a build script sets for the tests of its package too, and for no others: those of the window and of the tuner compute, and go
/// on with one test for each processor.
fn main() {
    println!("cargo:rerun-if-changed=build.rs");
    println!("cargo:rerun-if-env-changed=RUST_TEST_THREADS");
    if std::env::var_os("RUST_TEST_THREADS").is_none() {
        let processors = std::thread::available_parallelism().map_or(1, usize::from);
        println!("cargo:rustc-env=RUST_TEST_THREADS={}", TESTS_PER_PROCESSOR * processors);
    }
}
