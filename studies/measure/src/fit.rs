//! Straight lines through scattered points, with an honest account of how well they are known.
//!
//! Source: N. R. Draper, H. Smith, *Applied Regression Analysis*, 3rd ed., 1998, equations (1.2.9) and (1.4.4).

use serde::{Deserialize, Serialize};

/// A least squares line `y = intercept + slope x` and what its residuals say about it.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Line {
    /// dy/dx of the line.
    pub slope: f64,
    /// y of the line at x = 0.
    pub intercept: f64,
    /// Standard error of the slope, `sqrt(s^2 / sum (x - mean x)^2)` with `s^2 = sum r^2 / (n - 2)`.
    pub slope_error: f64,
    /// Root mean square of the residuals, `sqrt(sum r^2 / n)`.
    pub rms: f64,
    /// Number of points.
    pub points: usize,
}

impl Line {
    /// Half the width of the two-sided 95 % confidence interval of the slope, `t(n - 2) slope_error`.
    ///
    /// It takes the residuals as independent and of one size; a curved relation is neither.
    pub fn half_width(&self) -> f64 {
        student_t_95(self.points.saturating_sub(2)) * self.slope_error
    }

    /// The two-sided 95 % confidence interval of the slope.
    pub fn interval(&self) -> [f64; 2] {
        [self.slope - self.half_width(), self.slope + self.half_width()]
    }
}

/// The least squares line through the points (x, y).
///
/// None for fewer than three points (no residual is left to judge by), if a coordinate is not finite,
/// or if all x are equal.
pub fn line(points: &[(f64, f64)]) -> Option<Line> {
    if points.len() < 3 {
        return None;
    }
    let n = points.len() as f64;
    let x_mean = points.iter().map(|p| p.0).sum::<f64>() / n;
    let y_mean = points.iter().map(|p| p.1).sum::<f64>() / n;
    let s_xx: f64 = points.iter().map(|p| (p.0 - x_mean).powi(2)).sum();
    let s_xy: f64 = points.iter().map(|p| (p.0 - x_mean) * (p.1 - y_mean)).sum();
    if !(s_xx > 0.0 && s_xx.is_finite() && s_xy.is_finite()) {
        return None;
    }
    let slope = s_xy / s_xx;
    let residuals: f64 = points.iter().map(|p| (p.1 - y_mean - slope * (p.0 - x_mean)).powi(2)).sum();
    Some(Line {
        slope,
        intercept: y_mean - slope * x_mean,
        slope_error: (residuals / (n - 2.0) / s_xx).sqrt(),
        rms: (residuals / n).sqrt(),
        points: points.len(),
    })
}

/// The 97.5 % quantile of Student's t, so that `|t| <` it with probability 95 %; infinite for no degree of freedom.
///
/// One and two degrees of freedom have closed forms (12.706, 4.303). From three on it is the Cornish-Fisher series
/// about the normal quantile z up to 1/n^4 (M. Abramowitz, I. Stegun, *Handbook of Mathematical Functions*, 1964,
/// 26.7.5), which is low by 0.2 % at three degrees and by less than 0.05 % from four on.
pub fn student_t_95(degrees: usize) -> f64 {
    const Z: f64 = 1.959_963_984_540_054;
    let n = degrees as f64;
    match degrees {
        0 => f64::INFINITY,
        1 => (0.475 * std::f64::consts::PI).tan(),
        2 => 2.0 * 0.95 / (1.0_f64 - 0.95 * 0.95).sqrt() * 0.5_f64.sqrt(),
        _ => {
            let z2 = Z * Z;
            let g1 = (z2 + 1.0) / 4.0;
            let g2 = ((5.0 * z2 + 16.0) * z2 + 3.0) / 96.0;
            let g3 = (((3.0 * z2 + 19.0) * z2 + 17.0) * z2 - 15.0) / 384.0;
            let g4 = ((((79.0 * z2 + 776.0) * z2 + 1482.0) * z2 - 1920.0) * z2 - 945.0) / 92160.0;
            Z * (1.0 + g1 / n + g2 / n.powi(2) + g3 / n.powi(3) + g4 / n.powi(4))
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Worked by hand: mean x = 2, S_xx = 10, S_xy = 8, residuals (0.6, -1.2, 0, 1.2, -0.6) with sum of squares 3.6.
    #[test]
    fn a_line_has_the_slope_and_errors_of_the_textbook() {
        let y = [1.0 + 0.6, 1.8 - 1.2, 2.6, 3.4 + 1.2, 4.2 - 0.6];
        let points: Vec<(f64, f64)> = y.iter().enumerate().map(|(i, y)| (i as f64, *y)).collect();
        let l = line(&points).expect("five points");
        let near = |a: f64, b: f64| (a - b).abs() < 1e-14;
        assert!(near(l.slope, 0.8) && near(l.intercept, 1.0), "{l:?}");
        assert!(near(l.slope_error, 0.12_f64.sqrt()) && near(l.rms, 0.72_f64.sqrt()), "{l:?}");
        assert_eq!(l.points, 5);
        let half_width = 3.182_446 * 0.12_f64.sqrt();
        let [low, high] = l.interval();
        assert!((low - (0.8 - half_width)).abs() < 0.004 && (high - (0.8 + half_width)).abs() < 0.004, "{low} {high}");
    }

    #[test]
    fn what_is_no_line_is_none() {
        assert_eq!(line(&[(0.0, 1.0), (1.0, 2.0)]), None);
        assert_eq!(line(&[(1.0, 1.0), (1.0, 2.0), (1.0, 3.0)]), None);
        assert_eq!(line(&[(0.0, 1.0), (1.0, f64::NAN), (2.0, 3.0)]), None);
        assert_eq!(line(&[(0.0, 1.0), (f64::INFINITY, 2.0), (2.0, 3.0)]), None);
    }

    /// Quantiles of the Handbook of Mathematical Functions, table 26.10, to its three decimals.
    #[test]
    fn the_t_quantile_is_that_of_the_tables() {
        let table =
            [(1, 12.706), (2, 4.303), (4, 2.776), (5, 2.571), (8, 2.306), (10, 2.228), (30, 2.042), (120, 1.980)];
        for (degrees, t) in table {
            assert!((student_t_95(degrees) - t).abs() < 0.001, "{degrees}: {}", student_t_95(degrees));
        }
        assert!((student_t_95(3) - 3.182).abs() < 0.002 * 3.182, "{}", student_t_95(3));
        assert_eq!(student_t_95(0), f64::INFINITY);
    }
}
