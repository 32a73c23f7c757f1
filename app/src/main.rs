//! The program `brushwork`.

fn main() {}
