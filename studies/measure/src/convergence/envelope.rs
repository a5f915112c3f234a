//! Errors that theory only bounds: an event anywhere in a step makes error / h^p jump between bounds from step to step, so
//! that no local order means anything. What can be tested is the envelope.

use reports::Claim;

use super::Row;
use super::order_row::{Measure, OrderRow};
use crate::claim::{Evidence, claim, largest};
use crate::order::{Sample, Verdict};

/// The largest error / h^p of the coarser and of the finer half of a sweep may differ by the factor 8: over the half of
/// 12 halvings that is an order within p +- 1/2.
const HALVES_DIFFER: f64 = 8.0;
/// The bound holds to leading order: what the next terms of the error add to it at the finer half of a sweep, as a part.
const NEXT_TERMS: f64 = 0.05;
/// Fewer runs with steps for which the bound holds show nothing.
const LEAST_RUNS: usize = 4;
/// A bound that no error comes within this part of is not the bound.
const REACHED: f64 = 0.1;

/// The envelope of one sweep. `constant` is the largest error / h^p of its finer half, `order` the p +- of the two halves.
pub(super) fn order_of(first: &Row, measure: Measure, samples: &[Sample]) -> OrderRow {
    let p = first.theory_order.unwrap_or(0.0);
    let below_h_s = first.theory_below_h_s.unwrap_or(f64::INFINITY);
    let all = samples.len();
    let samples = &samples[samples.iter().take_while(|s| s.h_s > below_h_s).count()..];
    let ratios: Vec<f64> = samples.iter().map(|s| s.error.map_or(f64::NAN, |e| e / s.h_s.powf(p))).collect();
    let (coarse, fine) = ratios.split_at(ratios.len() / 2);
    let top = |part: &[f64]| largest(part.iter().copied().map(Some)).unwrap_or(f64::NAN);
    let (coarse_top, fine_top) = (top(coarse), top(fine));
    let middle = samples.len() / 2;
    let span = samples.first().zip(samples.get(middle)).map_or(1.0, |(a, b)| (a.h_s / b.h_s).ln());
    // Rounding fills the fine end of a sweep in f32 and f64; the claims are made in double-double.
    let halves = coarse_top / fine_top;
    let exact = samples.iter().all(|s| s.error.is_some_and(|e| e <= 64.0 * first.precision.epsilon() * first.scale));
    // An error that falls faster is below its bound all the same.
    // So is one that the bound of theory covers: the phase of an event, doubled from run to run, may come slowly into its own.
    let is_covered = first.theory_constant.is_some_and(|bound| fine_top <= bound * (1.0 + NEXT_TERMS));
    let holds = halves >= 1.0 / HALVES_DIFFER || exact || is_covered;
    OrderRow {
        scene: first.scene.clone(),
        method: first.method.clone(),
        precision: first.precision,
        quantity: first.quantity,
        measure,
        theory_order: first.theory_order,
        theory_is_envelope: true,
        order: Some(p + halves.ln() / span).filter(|x| x.is_finite()),
        order_low: None,
        order_high: None,
        window_from_h_s: samples.get(middle).map(|s| s.h_s),
        window_to_h_s: samples.last().map(|s| s.h_s),
        runs: all,
        window_points: Some(if samples.len() < LEAST_RUNS { 0 } else { fine.len() }),
        constant: Some(fine_top).filter(|x| x.is_finite()),
        constant_change: None,
        coarse_constant: coarse_top,
        fine_constant: fine_top,
        theory_constant: if measure == Measure::End { first.theory_constant } else { None },
        theory_doubt: first.theory_doubt,
        leading: None,
        leading_doubt: None,
        finest_order: None,
        is_rounding: false,
        is_coarse: false,
        is_erratic: false,
        coarsest_failure_h_s: None,
        time_scale_s: first.time_scale_s,
        floor: None,
        unit: first.unit.clone(),
        verdict: if holds { Verdict::AsExpected } else { Verdict::NotAsymptotic },
        tolerance: 0.5,
        note: format!("largest error / h^{p}: {coarse_top:.3e} in the coarser half, {fine_top:.3e} in the finer half"),
    }
}

/// The errors of the finer half stay below the bound of theory, and one of them comes near it.
pub(super) fn envelope_claim(o: &OrderRow) -> Option<Claim> {
    if !o.theory_is_envelope {
        return None;
    }
    let bound = o.theory_constant?;
    let p = o.theory_order?;
    let texts = [
        format!("the {} error of {} on {} stays in the envelope of theory", o.quantity.id(), o.method, o.scene),
        format!("error / h^{p} <= {bound:.6e} {}/s^{p}", o.unit),
        o.constant.map_or_else(|| "a run failed".to_owned(), |x| format!("largest of the finer half {x:.6e}")),
        format!("between {REACHED} and 1 + {NEXT_TERMS} of it"),
    ];
    let evidence = match o.constant.filter(|_| o.window_points != Some(0)) {
        // A sweep in which no event fell badly, or a run failed, shows nothing of the bound.
        None => Evidence::Undecided,
        Some(largest) if largest < bound * REACHED => Evidence::Undecided,
        // The next term still covers the bound, and falls faster than it.
        Some(largest)
            if largest > bound * (1.0 + NEXT_TERMS) && o.coarse_constant > (1.0 + NEXT_TERMS) * o.fine_constant =>
        {
            Evidence::Undecided
        }
        largest => Evidence::within(largest, [bound * REACHED, bound * (1.0 + NEXT_TERMS)]),
    };
    let id = format!("{}.{}.{}.envelope", o.scene, o.method, o.quantity.id());
    Some(claim("convergence", &id, texts, [evidence]).on(&o.scene).by(&o.method))
}
