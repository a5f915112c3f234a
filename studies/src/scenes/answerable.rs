//! Parameters whose motion has no answer in double-double are refused, by name.

use crate::error::Error;
use crate::observation::{Observation, Value};
use crate::scenes::parameters::{ParameterValue, Parameters};
use crate::special::scaled::exponent_of;

/// Radians that double-double resolves to 2^-56, half the rounding of f64 over 8: 2^-106 times 2^50.
pub(crate) const MOST_RADIANS: f64 = 1_125_899_906_842_624.0;

/// Refuses a phase at the horizon that double-double does not resolve.
pub(crate) fn phase<V: ParameterValue>(
    scene: &str,
    (parameter, value): (&str, &V),
    radians: f64,
    horizon_s: f64,
) -> Result<(), Error> {
    if radians.abs() <= MOST_RADIANS {
        return Ok(());
    }
    Err(Error::Parameter {
        scene: scene.to_owned(),
        parameter: parameter.to_owned(),
        value: value.show(),
        expected: format!(
            "the phase reaches {:.1e} rad in the {horizon_s} s of a run, and double-double resolves {MOST_RADIANS:.1e}: \
             take a slower motion",
            radians.abs()
        ),
    })
}

/// Refuses a motion that leaves the range of f64, naming the parameter that is farthest from 1.
pub(crate) fn range(scene: &str, parameters: &dyn Parameters, seen: &Observation, horizon_s: f64) -> Result<(), Error> {
    let finite = seen.values.iter().all(|(_, value)| match value {
        Value::Vector(components) => components.iter().all(|c| c.is_finite()),
        Value::Rotation(q) => q.is_finite(),
    });
    if finite {
        return Ok(());
    }
    let size = |text: &str| {
        text.split(',').filter_map(|c| c.parse().ok()).map(|x: f64| exponent_of(x).unsigned_abs()).max().unwrap_or(0)
    };
    let all = parameters.parameters();
    let farthest = all.into_iter().max_by_key(|parameter| size(&parameter.value));
    let (parameter, value) = farthest.map_or_else(Default::default, |p| (p.name.to_owned(), p.value));
    Err(Error::Parameter {
        scene: scene.to_owned(),
        parameter,
        value,
        expected: format!(
            "the motion leaves the range of numbers within the {horizon_s} s of a run: take a smaller one"
        ),
    })
}
