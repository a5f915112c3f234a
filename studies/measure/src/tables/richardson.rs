//! Values of which no truth is known: observed order, extrapolation to h = 0 and the grid convergence index.
//!
//! Source: I. B. Celik, U. Ghia, P. J. Roache, C. J. Freitas, H. Coleman, P. E. Raad, *Procedure for Estimation and
//! Reporting of Uncertainty Due to Discretization in CFD Applications*, J. Fluids Eng. 130 (2008) 078001.

use serde::Serialize;

/// What the finest three values say.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Extrapolation {
    /// Observed order p.
    pub order: f64,
    /// Lowest and highest p that the written digits allow.
    pub order_interval: [f64; 2],
    /// The value at h = 0, (r^p f1 - f2) / (r^p - 1).
    pub value: f64,
    /// |(f1 - f2) / f1|.
    pub approximate_error: f64,
    /// |(f0 - f1) / f0|.
    pub extrapolated_error: f64,
    /// Grid convergence index of the finest value, Fs |(f1 - f2) / f1| / (r^p - 1).
    pub gci: f64,
    /// The safety factor Fs.
    pub safety: f64,
    /// GCI_32 / (r^p GCI_21): 1 in the asymptotic range.
    pub asymptotic_ratio: f64,
}

/// Why three values have no order.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
#[serde(tag = "kind", rename_all = "kebab-case")]
pub enum Refusal {
    /// Their differences have opposite signs.
    Oscillating {
        /// (f1 - f2) / (f2 - f3).
        ratio: f64,
    },
    /// Their differences grow.
    Diverging {
        /// (f1 - f2) / (f2 - f3).
        ratio: f64,
    },
    /// A difference is not larger than the written digits or the rounding of the values.
    Unresolved {
        /// The smaller difference.
        difference: f64,
        /// What it would have to exceed.
        resolution: f64,
    },
}

/// The order p of three values f0 + C h^p at steps h1 < h2 < h3: the root of
/// (h2^p - h1^p) / (h3^p - h2^p) = (f2 - f1) / (f3 - f2); `None` where there is none above zero.
///
/// The left side falls with p, from ln(h2 / h1) / ln(h3 / h2) at p = 0 to 0. For equal ratios p = ln((f3 - f2) / (f2 - f1)) / ln r. The
/// fixed-point iteration of the source has the same root and does not settle for all ratios; bisection does.
pub fn order(values: [f64; 3], h: [f64; 3]) -> Option<f64> {
    let ratio = (values[1] - values[0]) / (values[2] - values[1]);
    let (fine, coarse) = ((h[1] / h[0]).ln(), (h[2] / h[1]).ln());
    if !(ratio > 0.0 && ratio < fine / coarse) {
        return None;
    }
    let model = |p: f64| (1.0 - (-p * fine).exp()) / ((p * coarse).exp_m1());
    let (mut low, mut high) = (0.0, 1.0);
    while model(high) > ratio {
        (low, high) = (high, 2.0 * high);
    }
    for _ in 0..200 {
        let middle = 0.5 * (low + high);
        if model(middle) > ratio { low = middle } else { high = middle }
    }
    Some(0.5 * (low + high))
}

/// An order below this is none: the factor r^p - 1 that the limit is divided by is next to nothing.
const LEAST_ORDER: f64 = 1e-3;

/// Extrapolates the finest three values; `half_digits` are half of the last digit that each is written with.
///
/// # Errors
/// Values that oscillate, diverge or are not resolved.
pub fn extrapolate(
    values: [f64; 3],
    h: [f64; 3],
    half_digits: [f64; 3],
    safety: f64,
) -> Result<Extrapolation, Refusal> {
    let (e21, e32) = (values[1] - values[0], values[2] - values[1]);
    let largest = values.iter().fold(0.0_f64, |m, v| m.max(v.abs()));
    let resolution = 2.0 * half_digits.iter().fold(0.0_f64, |m, d| m.max(*d)).max(4.0 * f64::EPSILON * largest);
    let smaller = e21.abs().min(e32.abs());
    if smaller <= resolution {
        return Err(Refusal::Unresolved { difference: smaller, resolution });
    }
    let ratio = e21 / e32;
    if ratio < 0.0 {
        return Err(Refusal::Oscillating { ratio });
    }
    let Some(p) = order(values, h).filter(|p| *p >= LEAST_ORDER) else {
        return Err(Refusal::Diverging { ratio });
    };
    let Some((lowest, highest)) = spread(values, h, half_digits, p) else {
        return Err(Refusal::Unresolved { difference: smaller, resolution });
    };
    let factor = (h[1] / h[0]).powf(p);
    let value = (factor * values[0] - values[1]) / (factor - 1.0);
    let gci = |fine: f64, difference: f64, r: f64| safety * (difference / fine).abs() / (r.powf(p) - 1.0);
    let (fine, coarse) = (gci(values[0], e21, h[1] / h[0]), gci(values[1], e32, h[2] / h[1]));
    Ok(Extrapolation {
        order: p,
        order_interval: [lowest, highest],
        value,
        approximate_error: (e21 / values[0]).abs(),
        extrapolated_error: ((value - values[0]) / value).abs(),
        gci: fine,
        safety,
        asymptotic_ratio: coarse / (factor * fine),
    })
}

/// The lowest and the highest order over the corners of what the written digits allow; `None` where a corner has no order.
fn spread(values: [f64; 3], h: [f64; 3], half: [f64; 3], p: f64) -> Option<(f64, f64)> {
    let corner = |corner: u32| {
        let sign = |i: usize| if corner >> i & 1 == 1 { 1.0 } else { -1.0 };
        order([0, 1, 2].map(|i| values[i] + sign(i) * half[i]), h)
    };
    (0..8).try_fold((p, p), |(low, high), i| corner(i).map(|p| (low.min(p), high.max(p))))
}
