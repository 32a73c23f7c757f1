//! Has functions of the same code share it in the linked program, where the linker that Rust brings along does it: a MB of 33. Lets the tests of
//! the suite `commands` run in larger number than there are processors.

#[path = "../tests/test_threads.rs"]
mod test_threads;

/// They wait for programs, simulated controllers and time-outs and compute for a twelfth of their time: with as many as processors these would
/// have nothing to do.
const TESTS_PER_PROCESSOR: usize = 8;

fn main() {
    println!("cargo:rerun-if-changed=build.rs");
    println!("cargo:rerun-if-env-changed=RUSTC_LINKER");
    // Rust links with its own LLD for this target alone (release notes of Rust 1.90); others have linkers without the option, and so may one that was chosen, as Zig's, by
    // which packages are made for an old C library.
    let is_usual = std::env::var_os("RUSTC_LINKER").is_none();
    if is_usual && std::env::var("TARGET").is_ok_and(|target| target == "x86_64-unknown-linux-gnu") {
        println!("cargo:rustc-link-arg-bins=-Wl,--icf=all");
    }
    println!("cargo:rerun-if-changed=../tests/test_threads.rs");
    test_threads::set_test_threads(TESTS_PER_PROCESSOR);
}
