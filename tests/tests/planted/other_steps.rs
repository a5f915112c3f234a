//! Faults of methods in another form of the step.

use integrator::methods::MethodId;

use super::methods::{EXPLICIT, IMPLICIT, MIDPOINT, RK4, SEMI_IMPLICIT, Steps};
use super::{BODIES, FLAT, METHODS};

/// The faults of methods that are not a coefficient.
pub(super) fn other_steps() -> Vec<(&'static str, MethodId, Steps, &'static [&'static str])> {
    let rk4 = |a, c, b, brackets| Steps::Rk4 { a, c, b, brackets };
    let Steps::Rk4 { a, c, b, brackets } = RK4 else { return Vec::new() };
    let kdk = |kicks, half, mix, times, ahead, stale| Steps::Kdk { kicks, drift: 1.0, half, mix, times, ahead, stale };
    let [explicit, semi, verlet, _, implicit, midpoint] = METHODS.map(|(method, _)| method);
    let rk = MethodId::Rk4;
    vec![
        ("rk4: every stage at the time of the first", rk, rk4(a, [0.0; 3], b, brackets), &FLAT[..]),
        ("rk4: stages at the end", rk, rk4(a, [1.0; 3], b, brackets), &FLAT[..]),
        ("rk4: weights of the 3/8 rule", rk, rk4(a, c, [0.125, 0.375, 0.375, 0.125], brackets), &FLAT[..]),
        ("rk4: weights in another order", rk, rk4(a, c, [b[1], b[0], b[3], b[2]], brackets), &FLAT[..]),
        ("rk4: the last stage at the middle", rk, rk4([0.5; 3], c, b, brackets), &FLAT[..]),
        ("rk4: weights rounded to f32", rk, rk4(a, c, b.map(|x| f64::from(x as f32)), brackets), &FLAT[..]),
        ("rk4: no first bracket", rk, rk4(a, c, b, [0.0, brackets[1]]), &BODIES[..]),
        ("rk4: no second bracket", rk, rk4(a, c, b, [brackets[0], 0.0]), &BODIES[..]),
        ("rk4: first bracket negative", rk, rk4(a, c, b, [-brackets[0], brackets[1]]), &BODIES[..]),
        ("rk4: second bracket negative", rk, rk4(a, c, b, [brackets[0], -brackets[1]]), &BODIES[..]),
        ("rk4: first bracket 1 % off", rk, rk4(a, c, b, [1.01 * brackets[0], brackets[1]]), &BODIES[..]),
        ("rk4: second bracket 1 % off", rk, rk4(a, c, b, [brackets[0], 1.01 * brackets[1]]), &BODIES[..]),
        ("explicit: moves with the new velocity", explicit, SEMI_IMPLICIT, &FLAT[..]),
        (
            "explicit: force at the end of the step",
            explicit,
            kdk([1.0, 0.0], 0.0, 0.0, [1.0, 1.0], 1.0, false),
            &FLAT[..],
        ),
        (
            "explicit: moves with the mean velocity",
            explicit,
            kdk([1.0, 0.0], 0.0, 0.5, [0.0, 1.0], 1.0, false),
            &FLAT[..],
        ),
        ("semi-implicit: moves with the old velocity", semi, EXPLICIT, &FLAT[..]),
        (
            "semi-implicit: force at the end of the step",
            semi,
            kdk([1.0, 0.0], 0.0, 1.0, [1.0, 1.0], 1.0, false),
            &FLAT[..],
        ),
        (
            "semi-implicit: moves with the mean velocity",
            semi,
            kdk([1.0, 0.0], 0.0, 0.5, [0.0, 1.0], 1.0, false),
            &FLAT[..],
        ),
        (
            "verlet: kicks twice with the first force",
            verlet,
            kdk([0.5, 0.5], 0.5, 1.0, [0.0, 1.0], 1.0, true),
            &FLAT[..],
        ),
        (
            "verlet: second force at the first time",
            verlet,
            kdk([0.5, 0.5], 0.5, 1.0, [0.0, 0.0], 1.0, false),
            &FLAT[..],
        ),
        (
            "verlet: first force at the second time",
            verlet,
            kdk([0.5, 0.5], 0.5, 1.0, [1.0, 1.0], 1.0, false),
            &FLAT[..],
        ),
        (
            "verlet: second force at the half velocity",
            verlet,
            kdk([0.5, 0.5], 0.5, 1.0, [0.0, 1.0], 0.5, false),
            &FLAT[..],
        ),
        (
            "verlet: second force at the old velocity",
            verlet,
            kdk([0.5, 0.5], 0.5, 1.0, [0.0, 1.0], 0.0, false),
            &FLAT[..],
        ),
        ("verlet: moves with the old velocity", verlet, kdk([0.5, 0.5], 0.5, 0.0, [0.0, 1.0], 1.0, false), &FLAT[..]),
        ("verlet: a whole first kick", verlet, kdk([1.0, 0.5], 0.5, 1.0, [0.0, 1.0], 1.0, false), &FLAT[..]),
        ("verlet: no second kick", verlet, kdk([0.5, 0.0], 0.5, 1.0, [0.0, 1.0], 1.0, false), &FLAT[..]),
        ("implicit Euler: one iteration", implicit, Steps::Theta { theta: 1.0, time: 1.0, iterations: 1 }, &FLAT[..1]),
        ("implicit Euler: the midpoint rule", implicit, MIDPOINT, &FLAT[..1]),
        (
            "implicit midpoint: one iteration",
            midpoint,
            Steps::Theta { theta: 0.5, time: 0.5, iterations: 1 },
            &FLAT[..1],
        ),
        (
            "implicit midpoint: two iterations",
            midpoint,
            Steps::Theta { theta: 0.5, time: 0.5, iterations: 2 },
            &FLAT[..1],
        ),
        ("implicit midpoint: implicit Euler", midpoint, IMPLICIT, &FLAT[..1]),
        (
            "implicit midpoint: force at the start",
            midpoint,
            Steps::Theta { theta: 0.5, time: 0.0, iterations: 64 },
            &FLAT[..1],
        ),
    ]
}
