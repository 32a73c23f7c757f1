//! Seeded measurement noise. Seed 0 means a machine without noise.

use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::{Rng, SeedableRng};

/// A source of nearly normal noise, the same for the same seed on every machine.
#[derive(Clone, Debug)]
pub struct Noise {
    source: Option<ChaCha8Rng>,
}

impl Noise {
    /// `seed` 0 gives silence; `stream` tells apart the sources that share a seed.
    pub fn new(seed: u64, stream: u64) -> Self {
        let source = (seed != 0).then(|| {
            let mut source = ChaCha8Rng::seed_from_u64(seed);
            source.set_stream(stream);
            source
        });
        Self { source }
    }

    /// A number of mean 0 and standard deviation 1: the sum of four even ones, so never beyond 3.5.
    pub fn normal(&mut self) -> f64 {
        let Some(source) = &mut self.source else { return 0.0 };
        let bits = source.next_u64();
        let sum: u64 = (0..4).map(|n| (bits >> (16 * n)) & 0xFFFF).sum();
        // Four numbers, even over 0..65536, have a mean of 4 * 32767.5 and a variance of 4 * 65536^2 / 12.
        (sum as f64 - 131_070.0) / (65_536.0 / 3.0_f64.sqrt())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn noise_has_mean_zero_and_deviation_one_and_seed_zero_is_silent() {
        let mut noise = Noise::new(7, 1);
        let drawn: Vec<f64> = (0..100_000).map(|_| noise.normal()).collect();
        let mean = drawn.iter().sum::<f64>() / 1e5;
        let variance = drawn.iter().map(|x| (x - mean).powi(2)).sum::<f64>() / 1e5;
        assert!(mean.abs() < 0.01, "{mean}");
        assert!((variance - 1.0).abs() < 0.02, "{variance}");
        assert_eq!(Noise::new(0, 1).normal(), 0.0);
        assert_ne!(Noise::new(7, 2).normal(), Noise::new(7, 1).normal());
    }
}
