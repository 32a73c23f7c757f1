//! Has Cargo run more tests of a package at once than there are processors. For build scripts.

/// Sets it, at so many tests for each processor, unless `RUST_TEST_THREADS` says otherwise: Cargo sets what a build script sets for the tests of its package too, and for no others.
pub(crate) fn set_test_threads(tests_per_processor: usize) {
    println!("cargo:rerun-if-env-changed=RUST_TEST_THREADS");
    if std::env::var_os("RUST_TEST_THREADS").is_none() {
        let processors = std::thread::available_parallelism().map_or(1, usize::from);
        println!("cargo:rustc-env=RUST_TEST_THREADS={}", tests_per_processor * processors);
    }
}
