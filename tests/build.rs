//! Lets the tests of this package, which are those of the built program, run in larger number than there are processors.

mod test_threads;

/// They wait for programs, simulated controllers and time-outs and compute for a fifth of their time.
const TESTS_PER_PROCESSOR: usize = 4;

fn main() {
    println!("cargo:rerun-if-changed=build.rs");
    println!("cargo:rerun-if-changed=test_threads.rs");
    test_threads::set_test_threads(TESTS_PER_PROCESSOR);
}
