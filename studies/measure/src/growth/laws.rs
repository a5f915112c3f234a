//! The fits of the two families of laws to stretches of a run, and the choice between them.

use super::{BINS, CLEARLY, Envelope, FEWEST, Growth, Law};
use crate::fit;
use crate::fit::Line;

/// The law of samples that are all above the floor, with `largest` the largest error of the run.
pub(super) fn of(samples: &[Envelope], largest: f64) -> Growth {
    let Some(end) = samples.last() else {
        return Growth::blank(Law::Unclassified, "the run ends at the floor".to_owned());
    };
    let decade = thinned(samples, end.t_s / 10.0, end.t_s);
    if let Some(growth) = before_saturation(samples, largest) {
        return growth;
    }
    let growth = Stretch::new(&decade).map(|s| s.growth("the last decade"));
    let settled = growth.as_ref().is_some_and(|g| g.law != Law::Unclassified);
    let quarter = thinned(samples, end.t_s / 4.0, end.t_s);
    let tail = Stretch::new(&quarter).filter(|_| !settled).map(|s| s.growth("the last quarter"));
    let tail = tail.filter(|g| g.law != Law::Unclassified);
    let few = || Growth::blank(Law::Unclassified, "fewer than eight samples above the floor".to_owned());
    tail.or(growth).unwrap_or_else(few)
}

/// Exponential growth by at least a factor of 100 up to a tenth of the level at which the second half of the run stays.
fn before_saturation(samples: &[Envelope], largest: f64) -> Option<Growth> {
    let t_end = samples.last()?.t_s;
    let level = samples.iter().filter(|s| s.t_s >= t_end / 2.0).map(|s| s.error).fold(f64::INFINITY, f64::min);
    if level < largest / 2.0 {
        return None;
    }
    let onset = samples.iter().position(|s| s.error > largest / 10.0)?;
    let rise = thinned(&samples[..onset], 0.0, t_end);
    let (first, last) = (rise.first()?, rise.last()?);
    let growth = Stretch::new(&rise)?.growth("the stretch before it saturates");
    (last.error >= 100.0 * first.error && growth.law == Law::Exponential).then_some(growth)
}

/// The largest error of each of `BINS` bins of equal ratio between the times, with the time it was reached.
fn thinned(samples: &[Envelope], from_s: f64, to_s: f64) -> Vec<Envelope> {
    let inside: Vec<Envelope> =
        samples.iter().filter(|s| s.t_s >= from_s * (1.0 - 4.0 * f64::EPSILON) && s.t_s <= to_s).copied().collect();
    let (Some(first), Some(last)) = (inside.first(), inside.last()) else { return vec![] };
    let width = (last.t_s / first.t_s).ln() / BINS as f64;
    let bin = |s: &Envelope| ((s.t_s / first.t_s).ln() / width) as usize;
    inside
        .chunk_by(|a, b| bin(a) == bin(b))
        .filter_map(|c| c.iter().copied().reduce(|a, b| if b.error > a.error { b } else { a }))
        .collect()
}

/// A stretch of the run with the fits of both families, over all of it and over its halves.
struct Stretch {
    from_s: f64,
    to_s: f64,
    power: [Line; 3],
    exponential: [Line; 3],
}

impl Stretch {
    /// None for fewer than eight samples or an error that is zero.
    fn new(samples: &[Envelope]) -> Option<Self> {
        if samples.len() < FEWEST {
            return None;
        }
        let (early, late) = samples.split_at(samples.len() / 2);
        let fits = |x: fn(f64) -> f64| {
            let line =
                |part: &[Envelope]| fit::line(&part.iter().map(|s| (x(s.t_s), s.error.ln())).collect::<Vec<_>>());
            Some([line(samples)?, line(early)?, line(late)?])
        };
        let (from_s, to_s) = (samples.first()?.t_s, samples.last()?.t_s);
        Some(Self { from_s, to_s, power: fits(f64::ln)?, exponential: fits(|t| t)? })
    }

    fn growth(&self, stretch: &str) -> Growth {
        let (power, exponential) = (self.power[0], self.exponential[0]);
        let misfit_ratio = power.rms / exponential.rms;
        let law = self.law();
        let interval = if law == Law::Exponential { exponential.interval() } else { power.interval() };
        let alternative = match law {
            Law::Bounded => None,
            Law::Exponential => of_exponent(power.slope).filter(|_| misfit_ratio < 2.0 * CLEARLY),
            Law::Unclassified if misfit_ratio < 1.0 => of_exponent(power.slope),
            _ => Some(Law::Exponential).filter(|_| misfit_ratio * 2.0 * CLEARLY > 1.0 && exponential.slope > 0.0),
        };
        let evidence = format!(
            "{stretch} ({:.3e} s to {:.3e} s): t^{:.3} (rms {:.3}; halves {:.3}, {:.3}), exp({:.3e} t) (rms {:.3})",
            self.from_s,
            self.to_s,
            power.slope,
            power.rms,
            self.power[1].slope,
            self.power[2].slope,
            exponential.slope,
            exponential.rms,
        );
        Growth {
            law,
            exponent: Some(power.slope),
            rate: Some(exponential.slope),
            interval: Some(interval),
            misfit_ratio: Some(misfit_ratio).filter(|r| r.is_finite()),
            alternative,
            ..Growth::blank(law, evidence)
        }
    }

    fn law(&self) -> Law {
        let (power, exponential) = (self.power[0], self.exponential[0]);
        let rise = exponential.slope * (self.to_s - self.from_s);
        let power_law = of_exponent(power.slope).filter(|_| agree(&self.power, 0.3));
        if power.slope <= BOUNDED && self.power[2].slope <= 2.0 * BOUNDED {
            Law::Bounded
        } else if exponential.rms * CLEARLY < power.rms
            && rise >= 1.0
            && agree(&self.exponential, 0.35 * exponential.slope)
        {
            Law::Exponential
        } else if power.rms * CLEARLY < exponential.rms {
            power_law.unwrap_or(Law::Unclassified)
        } else {
            Law::Unclassified
        }
    }
}

/// The largest exponent of what is called bounded: less than 1.42 times the error in ten times the time.
const BOUNDED: f64 = 0.15;

/// The law of an exponent, within what an envelope of a decade leaves uncertain; None between two laws.
fn of_exponent(p: f64) -> Option<Law> {
    match p {
        _ if p <= BOUNDED => Some(Law::Bounded),
        0.35..=0.7 => Some(Law::SqrtT),
        0.8..=1.25 => Some(Law::Linear),
        1.7..=2.4 => Some(Law::Quadratic),
        _ => None,
    }
}

/// Whether the slopes of both halves agree to `tolerance` or to their scatter: a law keeps its exponent.
fn agree([_, early, late]: &[Line; 3], tolerance: f64) -> bool {
    (early.slope - late.slope).abs() <= tolerance.max(early.half_width() + late.half_width())
}
