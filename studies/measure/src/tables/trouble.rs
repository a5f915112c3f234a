//! What is wrong with a column of errors, by name.

use serde::Serialize;

use crate::order::local_order;

/// A kind of trouble.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum TroubleKind {
    /// Rounding, not the step, makes the errors.
    AtTheFloor,
    /// The steps are too large for the error to tell anything of them.
    Saturated,
    /// A clean order, lower than the expected one.
    Capped,
    /// The errors level off at a number far above rounding.
    ModelError,
    /// The error changes its sign within the table.
    SignChange,
    /// All rows but one agree.
    BadRun,
    /// Runs have no error.
    FailedRun,
    /// Values go up and down.
    Oscillating,
    /// Values move apart.
    Diverging,
    /// Values do not differ by more than the digits written.
    Unresolved,
    /// Local orders do not agree.
    NotAsymptotic,
}

/// One trouble with its evidence and what to do.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Trouble {
    /// What it is.
    pub kind: TroubleKind,
    /// The numbers that show it.
    pub evidence: String,
    /// What to do.
    pub remedy: &'static str,
}

impl TroubleKind {
    /// Its name for a reader.
    pub fn title(self) -> &'static str {
        match self {
            Self::AtTheFloor => "at the rounding floor",
            Self::Saturated => "saturated",
            Self::Capped => "capped",
            Self::ModelError => "model error",
            Self::SignChange => "sign change",
            Self::BadRun => "one bad run",
            Self::FailedRun => "failed runs",
            Self::Oscillating => "oscillating",
            Self::Diverging => "diverging",
            Self::Unresolved => "not resolved",
            Self::NotAsymptotic => "not asymptotic",
        }
    }

    fn remedy(self) -> &'static str {
        match self {
            Self::AtTheFloor => "take larger steps, or a wider arithmetic, and leave these rows out",
            Self::Saturated => "leave the coarsest rows out, or start from smaller steps",
            Self::Capped => {
                "look for a part of lower order: the start-up of a multistep method, the time at which a force is taken, \
                 interpolation of the output, a kink of the motion"
            }
            Self::ModelError => {
                "look for what does not depend on the step: another equation or parameter than the truth has, a tolerance of an \
                 inner solver, a reference or an output with too few digits"
            }
            Self::SignChange => "judge the signed error, or leave out the rows around the zero",
            Self::BadRun => "run it again and compare its settings with the others",
            Self::FailedRun => "start from smaller steps",
            Self::Oscillating => "take finer steps; no order can be read off values that go up and down",
            Self::Diverging => "take finer steps; values that move apart have no limit to extrapolate to",
            Self::Unresolved => "write more digits, or take larger steps",
            Self::NotAsymptotic => "add finer rows until the rates agree",
        }
    }

    pub(super) fn with(self, evidence: String) -> Trouble {
        Trouble { kind: self, evidence, remedy: self.remedy() }
    }
}

/// The errors of a column with what is known of them.
pub(super) struct Errors<'a> {
    pub(super) h: &'a [f64],
    /// As they stand in the table, signs and all.
    pub(super) signed: &'a [Option<f64>],
    /// Indices of the rows that show the order.
    pub(super) window: Option<(usize, usize)>,
    pub(super) slope: Option<f64>,
    pub(super) expected: Option<f64>,
    /// One rounding of the quantity.
    pub(super) unit: f64,
    /// Error from which on it says nothing of the step.
    pub(super) saturation: f64,
}

/// Errors within so many roundings may be nothing else: 2^10 operations that all err the same way.
const REACH: f64 = 1024.0;
/// Errors within so many roundings may be nothing else where their rates have no order at all: 2^20 operations.
pub(super) const LONG_REACH: f64 = 1_048_576.0;
/// A rate below this is none.
const FLAT: f64 = 0.2;
/// Rates that fall to this part of the largest lead to none.
const LEVELLING: f64 = 0.4;
/// Rates that agree differ by less.
const AGREE: f64 = 0.1;
/// Rates of a settling sweep change by less from pair to pair.
const STEADY: f64 = 0.4;
/// An error is off the line of its neighbours by this factor or more.
const OFF: f64 = 1.5;
/// Rates by an error near its zero are this far from the order on either side.
const DIP: f64 = 0.7;

impl Errors<'_> {
    fn rate(&self, i: usize, j: usize) -> Option<f64> {
        local_order((self.h[i], self.signed[i]?.abs()), (self.h[j], self.signed[j]?.abs()))
    }

    fn rates(&self) -> Vec<f64> {
        (1..self.h.len()).filter_map(|i| self.rate(i - 1, i)).collect()
    }

    /// Every trouble that the numbers show.
    pub(super) fn troubles(&self) -> Vec<Trouble> {
        let mut found = Vec::new();
        let failed = self.signed.iter().filter(|e| e.is_none()).count();
        if failed > 0 {
            found.push(TroubleKind::FailedRun.with(format!("{failed} of {} rows have no error", self.h.len())));
        }
        found.extend(self.sign_change().or_else(|| self.bad_run()).or_else(|| self.dip()));
        found.extend(self.floor());
        let levels_off = self.level();
        if !found.iter().any(|t| t.kind == TroubleKind::AtTheFloor) {
            found.extend(levels_off);
        }
        if !found.iter().any(|t| matches!(t.kind, TroubleKind::SignChange | TroubleKind::BadRun)) {
            found.extend(self.saturated());
        }
        if found.iter().all(|t| matches!(t.kind, TroubleKind::FailedRun | TroubleKind::Saturated)) {
            found.extend(self.capped());
        }
        if self.window.is_none() && found.iter().all(|t| t.kind == TroubleKind::FailedRun) {
            let rates: Vec<String> = self.rates().iter().map(|p| format!("{p:.2}")).collect();
            let evidence = match rates.len() {
                0 | 1 => "two rows show a rate and no order".to_owned(),
                _ => format!("the rates {} do not agree", rates.join(", ")),
            };
            found.push(TroubleKind::NotAsymptotic.with(evidence));
        }
        found
    }

    fn sign_change(&self) -> Option<Trouble> {
        let known: Vec<(f64, f64)> =
            self.h.iter().zip(self.signed).filter_map(|(h, e)| Some((*h, (*e)?))).filter(|(_, e)| *e != 0.0).collect();
        let pair = known.windows(2).find(|w| w[0].1 * w[1].1 < 0.0)?;
        // Rounding has either sign.
        if pair.iter().any(|(_, e)| e.abs() <= REACH * self.unit) {
            return None;
        }
        let evidence =
            format!("the error is {:.3e} at {:.4e} and {:.3e} at {:.4e}", pair[0].1, pair[0].0, pair[1].1, pair[1].0);
        Some(TroubleKind::SignChange.with(evidence))
    }

    /// One row between others that is off their line, where the rates of the others change by little from pair to pair.
    fn bad_run(&self) -> Option<Trouble> {
        let is_clear = |i: &usize| self.signed[*i].is_some_and(|e| e.abs() > REACH * self.unit);
        let clear: Vec<usize> = (0..self.h.len()).filter(is_clear).collect();
        if clear.len() < 5 {
            return None;
        }
        (1..clear.len() - 1).find_map(|at| {
            let (bad, before, after) = (clear[at], clear[at - 1], clear[at + 1]);
            let kept: Vec<usize> = clear.iter().copied().filter(|i| *i != bad).collect();
            let rates = kept.windows(2).map(|w| self.rate(w[0], w[1])).collect::<Option<Vec<f64>>>()?;
            let is_steady = rates.windows(2).all(|w| (w[0] - w[1]).abs() < STEADY);
            let rate = self.rate(before, after)?;
            let e = self.signed[bad]?.abs();
            let expected = self.signed[before]?.abs() * (self.h[bad] / self.h[before]).powf(rate);
            if !is_steady || rate < FLAT || (e / expected).ln().abs() < OFF.ln() {
                return None;
            }
            let evidence = format!(
                "the row at {:.4e} has the error {e:.3e} where its neighbours give {expected:.3e}; without it the rates are steady, {rate:.2} there",
                self.h[bad]
            );
            Some(TroubleKind::BadRun.with(evidence))
        })
    }

    /// Two neighbouring rates, one too high and one too low: an error that passes zero and is written without its sign.
    fn dip(&self) -> Option<Trouble> {
        let mut sorted = self.rates();
        sorted.sort_by(f64::total_cmp);
        let order = self.expected.or(self.slope).or(sorted.get(sorted.len() / 2).copied())?;
        (1..self.h.len().saturating_sub(1)).find_map(|i| {
            let (before, after) = (self.rate(i - 1, i)?, self.rate(i, i + 1)?);
            let e = self.signed[i]?.abs();
            let dips = before > order + DIP && after < order - DIP && e > REACH * self.unit;
            let evidence = format!(
                "the rate is {before:.2} before {:.4e} and {after:.2} after it: the error is near zero there",
                self.h[i]
            );
            dips.then(|| TroubleKind::SignChange.with(evidence))
        })
    }

    fn floor(&self) -> Option<Trouble> {
        let after = self.window.map_or(0, |(_, last)| last + 1);
        let rest: Vec<f64> = self.signed[after..].iter().filter_map(|e| Some((*e)?.abs())).collect();
        let finest = *rest.last()?;
        let rates = self.rates();
        let erratic = self.window.is_none()
            && (rates.iter().any(|p| *p < 0.0) || rates.windows(2).any(|w| (w[0] - w[1]).abs() > 1.0));
        let rises = rest.windows(2).any(|w| w[1] > w[0]);
        let reach = if erratic || rises { LONG_REACH } else { REACH };
        if finest > reach * self.unit {
            return None;
        }
        let small: Vec<f64> = rest.iter().copied().filter(|e| *e <= reach * self.unit).collect();
        let [low, high] =
            [small.iter().fold(f64::INFINITY, |a, b| a.min(*b)), small.iter().fold(0.0_f64, |a, b| a.max(*b))];
        let evidence = format!(
            "{} of {} errors, {low:.1e} to {high:.1e}, are within {:.0} roundings of {:.1e}",
            small.len(),
            self.h.len(),
            (high / self.unit).ceil(),
            self.unit
        );
        Some(TroubleKind::AtTheFloor.with(evidence))
    }

    /// The errors of the finest rows are one number.
    fn level(&self) -> Option<Trouble> {
        let n = self.h.len();
        let flat = (1..n).rev().take_while(|i| self.rate(i - 1, *i).is_some_and(|p| p.abs() < FLAT)).count();
        let at = self.signed.last().copied()??.abs();
        if at <= REACH * self.unit || at >= self.saturation {
            return None;
        }
        let rates = self.rates();
        let falls = rates.last_chunk().is_some_and(|[a, b, c]| a > b && b > c);
        let largest = rates.iter().copied().fold(0.0, f64::max);
        if flat == 0 {
            let last = rates.last().copied().filter(|last| falls && *last < LEVELLING * largest)?;
            let evidence =
                format!("the rates fall from {largest:.2} to {last:.2}: the error levels off below {at:.3e}");
            return Some(TroubleKind::ModelError.with(evidence));
        }
        // A single flat pair after steady rates is as likely one run; after rates that fall it is where they lead.
        if flat == 1 && n > 2 && !falls && self.window.is_some_and(|(_, last)| last + 1 == n) {
            return None;
        }
        let before = if flat + 1 < n {
            format!("it falls down to {:.4e} and then ", self.h[n - 1 - flat])
        } else {
            String::new()
        };
        let last = self.rate(n - 2, n - 1).unwrap_or(0.0);
        let evidence =
            format!("the error does not depend on the step: {before}it stays at {at:.3e}, with a rate of {last:.2}");
        Some(TroubleKind::ModelError.with(evidence))
    }

    fn saturated(&self) -> Option<Trouble> {
        let (first, _) = self.window?;
        let slope = self.slope?;
        let coarse = (0..first).filter(|i| {
            let e = self.signed[*i].map(f64::abs);
            e.is_some_and(|e| e >= self.saturation) || self.rate(*i, i + 1).is_some_and(|p| p < 0.5 * slope)
        });
        let rows = coarse.count();
        (rows > 0 && slope > FLAT).then(|| {
            let evidence =
                format!("{rows} row(s) with steps from {:.4e} on fall more slowly than the rest", self.h[rows - 1]);
            TroubleKind::Saturated.with(evidence)
        })
    }

    fn capped(&self) -> Option<Trouble> {
        let (slope, expected) = (self.slope?, self.expected?);
        let is_clean = (slope - slope.round()).abs() < AGREE && slope > 0.5 && slope < expected - 0.5;
        is_clean.then(|| {
            TroubleKind::Capped.with(format!("a clean order {:.0} where {expected} is expected", slope.round()))
        })
    }
}
