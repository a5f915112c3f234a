//! Maps of where a method holds, cell by cell as measured, with what theory says of each cell.

use integrator::methods::MethodId;

use super::failure::Failure;
use super::models::{Scheme, amplification, modulus, orbits_survived, stability_function};
use super::spin::{FACTOR_TOLERANCE, SpinScheme};
use super::{Part, Row};
use scenes::run::Precision;

/// A regular grid of cells.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Grid {
    /// Left and right edge.
    pub x: [f64; 2],
    /// Number of columns.
    pub nx: usize,
    /// Lower and upper edge.
    pub y: [f64; 2],
    /// Number of rows.
    pub ny: usize,
}

impl Grid {
    /// Width of a cell.
    pub fn dx(&self) -> f64 {
        (self.x[1] - self.x[0]) / self.nx as f64
    }

    /// Centre of a column.
    pub fn x_at(&self, i: usize) -> f64 {
        self.x[0] + (i as f64 + 0.5) * self.dx()
    }

    /// Centre of a row.
    pub fn y_at(&self, j: usize) -> f64 {
        self.y[0] + (j as f64 + 0.5) * (self.y[1] - self.y[0]) / self.ny as f64
    }

    /// The same window with a third of the cells each way.
    #[must_use]
    pub fn coarse(self) -> Self {
        Grid { nx: self.nx / 3, ny: self.ny / 3, ..self }
    }
}

/// Damped oscillator: h omega across, damping ratio up.
pub const DAMPED: Grid = Grid { x: [0.0, 6.0], nx: 90, y: [0.0, 1.5], ny: 45 };
/// Spinning body: h omega3 across, I3/I1 up; no body is beyond 2.
pub const SPIN: Grid = Grid { x: [0.0, std::f64::consts::PI], nx: 60, y: [0.0, 2.0], ny: 40 };
/// The complex plane of h lambda.
pub const REGION: Grid = Grid { x: [-4.5, 3.5], nx: 72, y: [-3.5, 3.5], ny: 63 };
/// Kepler: log2 of the steps in an orbit across (fewest to the right), eccentricity up.
pub const KEPLER: Grid = Grid { x: [-10.0, -3.0], nx: 42, y: [0.0, 0.96], ny: 32 };
/// Most orbits followed.
pub const MOST_ORBITS: u32 = 64;

/// Methods whose stability function is mapped: the others have none.
pub const ONE_STEP: [MethodId; 4] =
    [MethodId::ExplicitEuler, MethodId::Rk4, MethodId::ImplicitEuler, MethodId::ImplicitMidpoint];
/// Methods whose orbits are counted.
pub const ORBITING: [MethodId; 3] = [MethodId::SemiImplicitEuler, MethodId::VelocityVerlet, MethodId::Rk4];

/// One row of cells of a map.
#[derive(Clone, Copy, Debug)]
pub(super) enum MapRow {
    Damped(Scheme),
    Spin(SpinScheme),
    Region(MethodId),
    Kepler(MethodId),
}

impl MapRow {
    /// The grid of the map.
    pub(super) fn grid(self) -> Grid {
        match self {
            MapRow::Damped(_) => DAMPED,
            MapRow::Spin(_) => SPIN,
            MapRow::Region(_) => REGION,
            MapRow::Kepler(_) => KEPLER,
        }
    }

    /// The cells of row `j`.
    pub(super) fn rows(self, grid: &Grid, j: usize) -> Vec<Row> {
        (0..grid.nx).map(|i| self.cell(grid.x_at(i), grid.y_at(j))).collect()
    }

    fn cell(self, x: f64, y: f64) -> Row {
        let row = |part, scene, method, quantity, parameter: &str, measured: f64, theory: f64| Row {
            h_omega: Some(x),
            parameter: parameter.to_owned(),
            value: Some(y),
            measured: Some(measured),
            theory: Some(theory),
            ..Row::new(part, scene, method, Precision::F64, quantity, "1")
        };
        match self {
            MapRow::Damped(scheme) => {
                let holds = scheme.holds(y, x);
                let theory = f64::from(u8::from(x <= scheme.limit(y)));
                let failure = if holds { Failure::None } else { Failure::ExponentialGrowth };
                let measured = f64::from(u8::from(holds));
                let row = row(Part::DampedMap, "damped", scheme.id(), "bounded", "zeta", measured, theory);
                Row { failure, ..row }
            }
            MapRow::Spin(scheme) => {
                let (measured, theory) = (scheme.measured(y, x), scheme.theory(y, x));
                let grows = measured > 1.0 + FACTOR_TOLERANCE;
                let failure = if grows { Failure::ExponentialGrowth } else { Failure::None };
                let row = row(Part::SpinMap, "spin", scheme.id(), "nutation factor", "I3/I1", measured, theory);
                Row { failure, ..row }
            }
            MapRow::Region(method) => {
                let (measured, theory) = (amplification(method, (x, y)), modulus(stability_function(method, (x, y))));
                let row = row(Part::Region, "test-equation", method.id(), "|R|", "Im h lambda", measured, theory);
                // At a pole of R there is no number.
                let finite = |x: Option<f64>| x.filter(|x| x.is_finite());
                Row { measured: finite(row.measured), theory: finite(row.theory), ..row }
            }
            MapRow::Kepler(method) => {
                let orbits = orbits_survived(method, y, (-x).exp2(), MOST_ORBITS);
                let row =
                    Row { theory: None, ..row(Part::KeplerMap, "kepler", method.id(), "orbits", "e", orbits, 0.0) };
                Row { h_omega: Some(x.exp2()), ..row }
            }
        }
    }
}

/// Where along a row of cells the verdict changes first, from bounded to not: the middle between the two cells.
/// `None` where it does not change.
pub fn boundary(cells: &[(f64, bool)]) -> Option<f64> {
    cells.windows(2).find(|pair| pair[0].1 && !pair[1].1).map(|pair| 0.5 * (pair[0].0 + pair[1].0))
}

/// The largest distance, in cells, of the measured boundary from theory's curve over all rows of a map of (x, y, bounded).
///
/// A row whose boundary lies outside the window counts only if the other's is in sight by more than a cell.
pub fn boundary_distance(cells: &[(f64, f64, bool)], grid: &Grid, theory: impl Fn(f64) -> f64) -> f64 {
    cells.chunk_by(|a, b| a.1 == b.1).fold(0.0, |worst: f64, row| {
        let verdicts: Vec<(f64, bool)> = row.iter().map(|&(x, _, bounded)| (x, bounded)).collect();
        let clip = |x: f64| x.clamp(grid.x[0], grid.x[1]);
        let all = |wanted: bool| verdicts.iter().all(|(_, bounded)| *bounded == wanted);
        let measured = match boundary(&verdicts) {
            Some(x) => x,
            None if all(true) => grid.x[1],
            None if all(false) => grid.x[0],
            None => f64::NAN,
        };
        let distance = (measured - clip(theory(row[0].1))).abs() / grid.dx();
        // NaN is the worst.
        if distance.is_nan() { f64::INFINITY } else { worst.max(distance) }
    })
}
