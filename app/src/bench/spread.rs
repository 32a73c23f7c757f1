//! Percentiles of what was measured, and the spread of moments at which to measure.

/// The value below which `part` (0 to 1) of the values lie, by nearest rank; NaN when there are none.
pub fn percentile(values: &[f64], part: f64) -> f64 {
    let mut sorted = values.to_vec();
    sorted.sort_by(f64::total_cmp);
    let rank = (part * sorted.len() as f64).ceil().max(1.0) as usize;
    sorted.get(rank - 1).copied().unwrap_or(f64::NAN)
}

/// The middle value.
pub fn median(values: &[f64]) -> f64 {
    percentile(values, 0.5)
}

/// The lowest and the highest value as text.
pub fn range(values: &[f64], decimals: usize) -> String {
    let (low, high) = (percentile(values, 0.0), percentile(values, 1.0));
    format!("{low:.decimals$} to {high:.decimals$} in {} rounds", values.len())
}

/// Numbers from 0 to 1 that spread evenly and follow no rhythm of what is measured: multiples of the golden ratio.
pub fn scattered() -> impl Iterator<Item = f64> {
    const GOLDEN: f64 = 0.618_033_988_749_894_9;
    (1_u32..).map(|index| (f64::from(index) * GOLDEN).fract())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn percentiles_are_by_nearest_rank() {
        let values: Vec<f64> = (1..=200).rev().map(f64::from).collect();
        assert_eq!((median(&values), percentile(&values, 0.99)), (100.0, 198.0));
        assert_eq!((percentile(&values, 0.0), percentile(&values, 1.0)), (1.0, 200.0));
        assert!(median(&[]).is_nan());
    }

    #[test]
    fn scattered_numbers_fill_every_tenth() {
        let mut tenths = [0; 10];
        scattered().take(100).for_each(|part| tenths[(part * 10.0) as usize] += 1);
        assert!(tenths.iter().all(|count| (9..=11).contains(count)), "{tenths:?}");
    }
}
