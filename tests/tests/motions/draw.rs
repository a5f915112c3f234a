//! Parameters drawn from the allowed ranges.

use std::collections::HashMap;

use scenes::any::AnyScene;
use scenes::parameters::{Parameter, Range};

/// SplitMix64 (G. Steele, D. Lea, C. Flood 2014).
pub(super) struct Random(pub(super) u64);

impl Random {
    pub(super) fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }
    pub(super) fn unit(&mut self) -> f64 {
        (self.next() >> 11) as f64 / 9_007_199_254_740_992.0
    }
    pub(super) fn below(&mut self, n: u64) -> u64 {
        self.next() % n
    }
    /// `x` times 2^u with u in +-reach.
    pub(super) fn near(&mut self, x: f64, reach: f64) -> f64 {
        x * ((2.0 * self.unit() - 1.0) * reach).exp2()
    }
}

pub(super) type Values = HashMap<&'static str, Vec<f64>>;

pub(super) fn numbers(parameter: &Parameter) -> Vec<f64> {
    parameter.value.split(',').map(|c| c.parse().expect("a number")).collect()
}

pub(super) fn values(scene: &dyn AnyScene) -> Values {
    scene.scene().parameters().iter().map(|p| (p.name, numbers(p))).collect()
}

pub(super) fn set(scene: &mut dyn AnyScene, name: &str, to: &[f64]) {
    let (id, text) = (scene.id(), to.iter().map(f64::to_string).collect::<Vec<_>>().join(","));
    scene.scene_mut().set(id, name, &text).unwrap_or_else(|e| panic!("{e}"));
}

/// One component: a special value, or one that is log-uniform about the default.
pub(super) fn draw(random: &mut Random, range: Range, default: f64, before: Option<f64>, reach: f64) -> f64 {
    let size = if default == 0.0 { 1.0 } else { default.abs() };
    let sign = if random.below(2) == 0 { 1.0 } else { -1.0 };
    let special = random.below(8);
    match range {
        Range::Closed(0.0, 2.0) => random.below(3) as f64,
        Range::Closed(low, high) => match special {
            0 | 1 => high,
            2 => high - (-4.0 - 30.0 * random.unit()).exp2(),
            _ => low + (high - low) * random.unit(),
        },
        Range::HalfOpen(low, high) => match special {
            0 => low,
            1 => (-40.0 * random.unit()).exp2(),
            2 => high - (-12.0 * random.unit()).exp2(),
            _ => low + (high - low) * random.unit(),
        },
        Range::Positive => match special {
            0 => size,
            1 => size.next_up(),
            _ => random.near(size, reach),
        },
        Range::NonNegative => match special {
            0 | 1 => 0.0,
            2 => 1.0,
            3 => 1.0_f64.next_up(),
            4 => 1.0_f64.next_down(),
            _ => random.near(size, reach),
        },
        Range::Finite => match special {
            0 | 1 => 0.0,
            2 => before.unwrap_or(size),
            _ => sign * random.near(size, reach),
        },
    }
}

/// Moments of a body that can exist: equal, nearly equal, flat or any.
pub(super) fn moments(random: &mut Random, reach: f64) -> Vec<f64> {
    let (a, b) = (random.near(1.0, reach), random.near(1.0, reach));
    let (a, b) = match random.below(6) {
        0 => (a, a),
        1 => (a, a.next_up()),
        2 => (a, a * (1.0 + (-45.0 * random.unit()).exp2())),
        _ => (a, b),
    };
    let c = match random.below(6) {
        0 => a,
        1 => (a + b) * (1.0 - f64::EPSILON),
        _ => (a - b).abs() + (a + b - (a - b).abs()) * random.unit(),
    };
    let mut all = vec![a, b, c];
    all.rotate_left(random.below(3) as usize);
    all
}

pub(super) fn randomise(scene: &mut dyn AnyScene, random: &mut Random) {
    let reach = [2.0, 2.0, 8.0, 30.0][random.below(4) as usize];
    for parameter in scene.scene().parameters() {
        let defaults = numbers(&parameter);
        let mut drawn: Vec<f64> = Vec::new();
        for &default in &defaults {
            drawn.push(draw(random, parameter.range, default, drawn.last().copied(), reach));
        }
        if parameter.name == "inertia" && drawn.len() == 3 {
            drawn = moments(random, reach.min(6.0));
        }
        match (parameter.name, random.below(6)) {
            ("attitude", _) if drawn.iter().all(|&c| c == 0.0) => drawn = defaults,
            // Along an axis, or at rest.
            ("omega", 0) if drawn.len() == 3 => {
                let along = random.below(4) as usize;
                drawn.iter_mut().enumerate().filter(|(i, _)| *i != along).for_each(|(_, w)| *w = 0.0);
            }
            // Nearly along an axis.
            ("omega", 1) if drawn.len() == 3 => {
                let (along, part) = (random.below(3) as usize, (-60.0 * random.unit()).exp2());
                drawn.iter_mut().enumerate().filter(|(i, _)| *i != along).for_each(|(_, w)| *w *= part);
            }
            _ => {}
        }
        set(scene, parameter.name, &drawn);
    }
    tie(scene, random);
}

/// Values of one parameter at which another's makes the formula change.
pub(super) fn tie(scene: &mut dyn AnyScene, random: &mut Random) {
    if random.below(4) != 0 {
        return;
    }
    let of = values(scene);
    let beside = |x: f64, random: &mut Random| match random.below(4) {
        0 => x,
        1 => x.next_up(),
        2 => x.next_down(),
        _ => x * (1.0 + (-50.0 * random.unit()).exp2()),
    };
    match scene.id().split('/').next() {
        Some("forced-oscillator") => {
            let (m, k) = (of["mass"][0], of["stiffness"][0]);
            let (name, at) =
                if random.below(2) == 0 { ("drive", (k / m).sqrt()) } else { ("damping", 2.0 * (k * m).sqrt()) };
            let value = beside(at, random);
            set(scene, name, &[value]);
        }
        Some("pendulum") => {
            let w0 = (of["gravity"][0] / of["length"][0]).sqrt();
            let value = beside(2.0 * w0 * (of["angle"][0] * 0.5).cos(), random);
            set(scene, "omega", &[value]);
        }
        Some("heavy-top") => {
            let [w, x, y, z] = [0, 1, 2, 3].map(|i| of["attitude"][i]);
            // L_z = L_3 of a top released from rest or with a spin alone; or a start on the vertical.
            match random.below(3) {
                0 => set(scene, "omega", &[0.0, 0.0, 0.0]),
                1 => set(scene, "omega", &[0.0, 0.0, 1e-8 * random.unit()]),
                _ if w != 0.0 || z != 0.0 => set(scene, "attitude", &[w, 0.0, 0.0, z]),
                _ => set(scene, "attitude", &[0.0, x, y, 0.0]),
            }
        }
        Some("torque-free-spin" | "tennis-racket" | "box-tumbling") => {
            // The separatrix, as near as f64 has it: I_hi w_hi^2 (I_hi - I_b) = I_lo w_lo^2 (I_b - I_lo).
            let mut order = [0, 1, 2];
            order.sort_by(|&i, &j| of["inertia"][i].total_cmp(&of["inertia"][j]));
            let [low, middle, high] = order.map(|i| of["inertia"][i]);
            let mut omega = of["omega"].clone();
            omega[order[2]] = omega[order[0]] * (low * (middle - low) / (high * (high - middle))).sqrt();
            if omega[order[2]].is_finite() {
                set(scene, "omega", &omega);
            }
        }
        _ => {}
    }
}
