//! The amplification matrix of a method on a linear scene: y(n+1) = M y(n) + b, y = (q, v).
//!
//! Column j of M is S(y0 + e_j) - S(y0), where S is one step of the scene's own model: nothing of the method or of the scene
//! is written down a second time. A step is stable where no eigenvalue of M lies outside the unit circle.
//! Source: E. Hairer, G. Wanner, Solving Ordinary Differential Equations II (1996), IV.2; E. I. Jury, Theory and Application
//! of the z-Transform Method (1964), section 3.

use faer::{Mat, c64, fx128};
use integrator::{Real, Single};

use scenes::observation::{largest, worse};
use scenes::run::Precision;
use scenes::stepping::{Stepping, coordinates, dimension};
use scenes::theory::StabilityLimit;

/// Eigenvalues this near to 1 are positions under no force: a double one moves by the root of the rounding errors of the
/// matrix, sqrt(2e-16 |M|) < 1e-6, and grows no faster than a power of time.
pub const NEUTRAL: f64 = 1e-6;
/// A spectral radius of the other eigenvalues up to this much above 1 is 1. At the limit itself they may be double too
/// (h omega = 2); that moves the limit by the square of the eigenvalue's error only.
pub const ROUNDING: f64 = 1e-12;
/// How far a step may miss superposition, in parts of the sizes involved, in double-double with Newton's rounding.
const SUPERPOSITION: f64 = 1e-20;
/// A determinant or trace of two by two in double-double may miss Jury's conditions by this much, in parts of its terms.
const JURY: f64 = 1e-24;
/// Rungs of the ladder on which theory's limit is looked for, in natural time scales: no method of the list becomes
/// stable again beyond its limit.
const LADDER: [f64; 2] = [0.002, 1024.0];
/// Ratio of two rungs.
const RUNG: f64 = 2.0;
/// Rungs below the ladder for two by two, where its first step is not stable: light damping holds explicit Euler with steps of
/// 2 zeta / omega. A growth of z^4 / 8 is still above `JURY` there; larger matrices are known to `ROUNDING` only.
const RUNGS_BELOW: i32 = 10;

/// A square matrix, row after row.
#[derive(Clone, Debug, PartialEq)]
pub struct Amplification {
    /// Rows and columns.
    pub n: usize,
    /// Entries, row after row.
    pub entries: Vec<fx128>,
}

/// The matrix of one step of length `h_s`; `None` where a step is not an affine map of the coordinates (the scene is not
/// linear, its space is curved, or Newton's iteration failed).
pub fn matrix(stepping: &Stepping<'_>, h_s: f64) -> Option<Amplification> {
    columns(stepping, h_s, true)
}

/// The same; whether steps obey superposition is tested if asked for.
fn columns(stepping: &Stepping<'_>, h_s: f64, test: bool) -> Option<Amplification> {
    let exact = Stepping { precision: Precision::DoubleDouble, ..*stepping };
    let n = 2 * dimension(stepping.scene);
    let step = |displacement: &[f64]| -> Option<Vec<fx128>> {
        let end = exact.walk(h_s, 1, displacement, &[1])?;
        end.end().map(coordinates).filter(|y| y.len() == n)
    };
    let moved = |entries: &[(usize, f64)]| {
        let mut displacement = vec![0.0; n];
        for &(j, by) in entries {
            displacement[j] = by;
        }
        displacement
    };
    let origin = step(&[])?;
    let minus = |a: &[fx128], b: &[fx128]| -> Vec<fx128> { a.iter().zip(b).map(|(&x, &y)| x - y).collect() };
    let mut columns = Vec::with_capacity(n);
    for j in 0..n {
        let column = minus(&step(&moved(&[(j, 1.0)]))?, &origin);
        if test {
            // Superposition, far along e_j and with its neighbour: a square, a modulus or a contact betrays itself.
            let far = minus(&step(&moved(&[(j, -64.0)]))?, &origin);
            let other = ((j + 1) % n, 2.0);
            let mixed = minus(&step(&moved(&[(j, 1.0), other]))?, &step(&moved(&[other]))?);
            if !proportional(&far, &column, -64.0) || !proportional(&mixed, &column, 1.0) {
                return None;
            }
        }
        columns.push(column);
    }
    let entries = (0..n * n).map(|k| columns[k % n][k / n]).collect();
    Some(Amplification { n, entries })
}

fn proportional(a: &[fx128], b: &[fx128], factor: f64) -> bool {
    let size = a.iter().chain(b).map(|x| x.to_f64().abs()).fold(1.0, worse);
    a.iter().zip(b).all(|(&x, &y)| (x - y * fx128::lit(factor)).to_f64().abs() <= SUPERPOSITION * size)
}

impl Amplification {
    /// All eigenvalues; `None` where the matrix is not finite.
    pub fn eigenvalues(&self) -> Option<Vec<c64>> {
        self.faer().eigenvalues().ok()
    }

    /// max |lambda|; `None` where the matrix is not finite.
    pub fn spectral_radius(&self) -> Option<f64> {
        let values = self.eigenvalues()?;
        largest(values.iter().map(|l| l.re.hypot(l.im)))
    }

    /// Real part of an eigenvector to the eigenvalue of greatest modulus: the direction that grows fastest.
    pub fn dominant_direction(&self) -> Option<Vec<f64>> {
        let eigen = self.faer().eigen().ok()?;
        let values: Vec<c64> = eigen.S().column_vector().iter().copied().collect();
        let modulus = |j: usize| values[j].re.hypot(values[j].im);
        let j = (0..self.n).max_by(|&a, &b| modulus(a).total_cmp(&modulus(b)))?;
        Some((0..self.n).map(|i| eigen.U()[(i, j)].re).collect())
    }

    /// Whether no error grows exponentially. For two by two by Jury's conditions |det| <= 1, |tr| <= 1 + det, which are exact
    /// where the eigenvalues are not: at h omega = 2 they are a defective pair, and next to 1 a growth of h^2 is less than they round.
    pub fn is_stable(&self) -> Option<bool> {
        self.is_stable_to(JURY, ROUNDING)
    }

    /// The same of entries that are known to a relative `of_entries`; the moduli of larger matrices to `of_moduli`.
    pub fn is_stable_to(&self, of_entries: f64, of_moduli: f64) -> Option<bool> {
        if let [a, b, c, d] = self.entries[..] {
            let (trace, det) = (a + d, a * d - b * c);
            let terms = fx128::ONE + a.abs() + d.abs() + (a * d).abs() + (b * c).abs();
            let most = fx128::ONE + terms * fx128::lit(of_entries);
            return (trace + det).is_finite().then(|| det.abs() <= most && trace.abs() <= most + det);
        }
        let values = self.eigenvalues()?;
        let not_neutral = values.iter().filter(|l| (l.re - 1.0).hypot(l.im) > NEUTRAL);
        Some(not_neutral.map(|l| l.re.hypot(l.im)).fold(0.0, worse) <= 1.0 + of_moduli)
    }

    fn faer(&self) -> Mat<f64> {
        Mat::from_fn(self.n, self.n, |i, j| self.entries[i * self.n + j].to_f64())
    }
}

/// The largest stable step according to the amplification matrix: the first rung of a ladder of steps at which it is not
/// stable, then bisection to rounding. `None` where the scene is not linear.
pub fn limit(stepping: &Stepping<'_>) -> Option<StabilityLimit> {
    let scale = stepping.scene.scene().info().time_scale_s;
    // A scene is linear at every step or at none.
    matrix(stepping, scale)?;
    let stable = |h: f64| columns(stepping, h, false).and_then(|m| m.is_stable());
    let mut low = LADDER[0] * scale;
    let is_small = dimension(stepping.scene) == 1;
    let floor = low / RUNG.powi(if is_small { RUNGS_BELOW } else { 0 });
    while !stable(low)? {
        low /= RUNG;
        if low < floor {
            return Some(StabilityLimit::NoStep);
        }
    }
    while low < LADDER[1] * scale {
        let high = low * RUNG;
        if stable(high)? {
            low = high;
            continue;
        }
        return Some(StabilityLimit::Below(boundary(low, high, |h| stable(h) == Some(true))));
    }
    Some(StabilityLimit::Unlimited)
}

/// The point between `low`, where `holds`, and `high`, where it does not, at which it ceases to: to rounding.
pub fn boundary(mut low: f64, mut high: f64, holds: impl Fn(f64) -> bool) -> f64 {
    loop {
        let middle = 0.5 * (low + high);
        if middle <= low || middle >= high {
            return low;
        }
        if holds(middle) {
            low = middle;
        } else {
            high = middle;
        }
    }
}
