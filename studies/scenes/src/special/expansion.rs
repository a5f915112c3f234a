//! Sums of products of f64, exactly: what decides on which side of the separatrix a body starts, and how near.
//!
//! J. R. Shewchuk, Adaptive precision floating-point arithmetic and fast robust geometric predicates, Discrete Comput.
//! Geom. 18 (1997) 305-363: GROW-EXPANSION and products term by term. Exact unless a product underflows or overflows.

use faer::fx128;

/// An exact number: the unevaluated sum of non-overlapping parts of growing size.
#[derive(Clone, Debug, Default)]
pub(super) struct Expansion(Vec<f64>);

impl Expansion {
    /// The exact sum of two numbers.
    pub(super) fn sum(a: f64, b: f64) -> Self {
        Self::default().add_scaled(a).add_scaled(b)
    }

    /// GROW-EXPANSION: the exact sum with one more f64, zeros dropped.
    fn add_scaled(self, b: f64) -> Self {
        let mut carry = b;
        let mut parts = Vec::with_capacity(self.0.len() + 1);
        for part in self.0 {
            let sum = carry + part;
            let virtual_part = sum - carry;
            let error = (carry - (sum - virtual_part)) + (part - virtual_part);
            if error != 0.0 {
                parts.push(error);
            }
            carry = sum;
        }
        if carry != 0.0 {
            parts.push(carry);
        }
        Self(parts)
    }

    /// The exact product with one f64.
    pub(super) fn times(&self, b: f64) -> Self {
        self.0.iter().fold(Self::default(), |sum, &part| {
            let product = part * b;
            sum.add_scaled(part.mul_add(b, -product)).add_scaled(product)
        })
    }

    /// The exact difference.
    pub(super) fn minus(&self, other: &Self) -> Self {
        other.0.iter().fold(self.clone(), |sum, &part| sum.add_scaled(-part))
    }

    /// The value rounded to double-double, relative error below 2^-104.
    pub(super) fn rounded(&self) -> fx128 {
        self.0.iter().fold(fx128::ZERO, |sum, &part| sum.add_accurate(fx128::from_f64(part)))
    }
}
