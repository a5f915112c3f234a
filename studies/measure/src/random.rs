//! Random numbers that are the same everywhere and always: a seed, no clock.
//!
//! SplitMix64: G. L. Steele, D. Lea, C. H. Flood, Fast Splittable Pseudorandom Number Generators, OOPSLA 2014, figure 16; every one
//! of its 2^64 states follows every other.

use std::f64::consts::TAU;

/// SplitMix64: a Weyl sequence, mixed.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Generator(u64);

impl Generator {
    /// The sequence of a seed. Every seed is good.
    pub fn new(seed: u64) -> Self {
        Generator(seed)
    }

    /// The next 64 random bits.
    pub fn bits(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        z ^ (z >> 31)
    }

    /// Uniform in [0, 1): a multiple of 2^-53.
    pub fn unit(&mut self) -> f64 {
        (self.bits() >> 11) as f64 * (f64::EPSILON / 2.0)
    }

    /// Uniform in [low, high].
    pub fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.unit()
    }

    /// 1 or -1.
    pub fn sign(&mut self) -> f64 {
        if self.bits() >> 63 == 0 { 1.0 } else { -1.0 }
    }

    /// An angle, uniform in [0, 2 pi), rad.
    pub fn angle(&mut self) -> f64 {
        TAU * self.unit()
    }

    /// A unit vector, uniform on the sphere: its z is uniform (Archimedes), and so is its azimuth.
    pub fn direction(&mut self) -> [f64; 3] {
        let z = self.between(-1.0, 1.0);
        let (sine, cosine) = libm::sincos(self.angle());
        let across = ((1.0 - z) * (1.0 + z)).sqrt();
        [across * cosine, across * sine, z]
    }

    /// An attitude (w, x, y, z), uniform on SO(3): two angles and how a unit quaternion is shared between their planes.
    /// Source: K. Shoemake, Uniform random rotations, Graphics Gems III (1992), 124.
    pub fn attitude(&mut self) -> [f64; 4] {
        let share = self.unit();
        let [(s1, c1), (s2, c2)] = [self.angle(), self.angle()].map(libm::sincos);
        let (a, b) = ((1.0 - share).sqrt(), share.sqrt());
        [b * c2, a * s1, a * c1, b * s2]
    }
}
