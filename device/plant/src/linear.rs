//! Exact discretisation of the linear equations of an axis: the matrix exponential over one step.

/// `exp(a)` by scaling and squaring of the Taylor series. Small matrices only; used when a step length is first met.
pub fn exponential<const N: usize>(a: &[[f64; N]; N]) -> [[f64; N]; N] {
    let norm = a.iter().map(|row| row.iter().map(|x| x.abs()).sum::<f64>()).fold(0.0, f64::max);
    // Sixteen terms of the series are exact to rounding once the norm is at most one half.
    let halvings = if norm > 0.5 { (norm / 0.5).log2().ceil() as i32 } else { 0 };
    let scale = 0.5_f64.powi(halvings);
    let scaled = a.map(|row| row.map(|x| x * scale));
    let mut sum = identity();
    let mut term = identity();
    for n in 1..=16 {
        term = product(&term, &scaled).map(|row| row.map(|x| x / f64::from(n)));
        for (sum_row, term_row) in sum.iter_mut().zip(&term) {
            for (s, t) in sum_row.iter_mut().zip(term_row) {
                *s += t;
            }
        }
    }
    for _ in 0..halvings {
        sum = product(&sum, &sum);
    }
    sum
}

/// Sum of products of two short rows.
#[inline]
pub fn dot<const N: usize>(a: &[f64; N], b: &[f64; N]) -> f64 {
    let mut sum = 0.0;
    for (x, y) in a.iter().zip(b) {
        sum += x * y;
    }
    sum
}

fn identity<const N: usize>() -> [[f64; N]; N] {
    let mut one = [[0.0; N]; N];
    for (n, row) in one.iter_mut().enumerate() {
        row[n] = 1.0;
    }
    one
}

fn product<const N: usize>(a: &[[f64; N]; N], b: &[[f64; N]; N]) -> [[f64; N]; N] {
    let mut out = [[0.0; N]; N];
    for (out_row, a_row) in out.iter_mut().zip(a) {
        for (x, b_row) in a_row.iter().zip(b) {
            for (o, y) in out_row.iter_mut().zip(b_row) {
                *o += x * y;
            }
        }
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_exponential_of_a_decay_and_of_a_rotation_are_the_known_ones() {
        let decay = exponential(&[[-700.0, 0.0], [0.0, -3.0]]);
        assert!((decay[0][0] - (-700.0_f64).exp()).abs() < 1e-12);
        assert!((decay[1][1] - (-3.0_f64).exp()).abs() < 1e-14);
        let turn = exponential(&[[0.0, -1.2], [1.2, 0.0]]);
        assert!((turn[0][0] - 1.2_f64.cos()).abs() < 1e-14);
        assert!((turn[1][0] - 1.2_f64.sin()).abs() < 1e-14);
    }
}
