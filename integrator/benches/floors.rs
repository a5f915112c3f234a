//! Cycles of one step, against the floor that its dependency chain sets: `cargo bench -p integrator --bench floors`.
//!
//! Every candidate runs in turn in one process, for many rounds, with a chain of integer multiplications and exclusive ors (three
//! cycles and one on every current x86-64 core) as the clock of the round; the least and the median of the ratios are printed.
//! Each line ends with the last state, so that nobody times code that the compiler has folded away.

use std::hint::black_box;
use std::time::Instant;

use integrator::lanes::Fused;
use integrator::methods::{ExplicitEuler, Rk4, SemiImplicitEuler};
use integrator::pose::{Fixed, Pose, Twist};
use integrator::rigid_body::WorldOmega;
use integrator::rotation::cross;
use integrator::{Model, Rotation, State, Vector};
use nalgebra::{Matrix3, Vector3};
use wide::f64x4;

mod models;
use models::{Free, Lanes, STEPS, go, inertia, spin, spring};

const ROUNDS: usize = 200;

/// The world frame as textbooks print it: I_w = R I R^T and its inverse as matrices, omega' = I_w^-1 (-omega x I_w omega).
struct Textbook(Vector3<f64>);

impl Model<f64> for Textbook {
    type Config = Pose<f64>;
    #[inline(always)]
    fn rate(&self, _t: f64, s: &State<Pose<f64>>) -> Twist<f64> {
        let r = s.q.attitude.matrix();
        let inertia = r * Matrix3::from_diagonal(&self.0) * r.transpose();
        let inverse = r * Matrix3::from_diagonal(&self.0.map(f64::recip)) * r.transpose();
        let omega = s.v.angular;
        Twist { linear: Vector3::zeros(), angular: inverse * cross(inertia * omega, omega) }
    }
}

fn world(seed: f64) -> State<Pose<f64>> {
    let angular = Vector3::new(black_box(seed), black_box(-0.75), black_box(1.0));
    State { q: Pose::new(Vector3::zeros(), Rotation::identity()), v: Twist { linear: Vector3::zeros(), angular } }
}

fn fma_peak() -> f64x4 {
    let (a, b) = (f64x4::splat(black_box(0.999_999)), f64x4::splat(black_box(1e-9)));
    let mut sums = [f64x4::splat(1.0); 12];
    for _ in 0..STEPS {
        for sum in &mut sums {
            *sum = sum.mul_add(a, b);
        }
    }
    sums.into_iter().fold(f64x4::splat(0.0), |total, sum| total + sum)
}

/// Four cycles a step: a multiplication (three) and an exclusive or (one), which no compiler can put together.
fn clock() -> f64 {
    let mut x = black_box(3_u64);
    let by = black_box(0x9E37_79B9_7F4A_7C15_u64);
    for _ in 0..STEPS {
        x = x.wrapping_mul(by) ^ by;
    }
    x as f64
}

struct Candidate {
    name: &'static str,
    /// What theory or the best hand-written kernel allows, cycles.
    floor: &'static str,
    /// Trajectories stepped at once, and floating-point operations of one step of one of them.
    lanes: (f64, f64),
    run: fn() -> f64,
}

fn candidates() -> Vec<Candidate> {
    let one = (1.0, 0.0);
    vec![
        Candidate {
            name: "oscillator, explicit Euler, fused",
            floor: "4",
            lanes: one,
            run: || go(&ExplicitEuler, spring::<Fused<f64>>(0.75)).0,
        },
        Candidate {
            name: "oscillator, explicit Euler, plain",
            floor: "6",
            lanes: one,
            run: || go(&ExplicitEuler, spring::<f64>(0.75)),
        },
        Candidate {
            name: "oscillator, semi-implicit Euler, fused",
            floor: "8",
            lanes: one,
            run: || go(&SemiImplicitEuler, spring::<Fused<f64>>(0.75)).0,
        },
        Candidate {
            name: "oscillator, semi-implicit Euler, plain",
            floor: "12",
            lanes: one,
            run: || go(&SemiImplicitEuler, spring::<f64>(0.75)),
        },
        Candidate {
            name: "oscillator, RK4, fused",
            floor: "30",
            lanes: one,
            run: || go(&Rk4, spring::<Fused<f64>>(0.75)).0,
        },
        Candidate { name: "oscillator, RK4, plain", floor: "-", lanes: one, run: || go(&Rk4, spring::<f64>(0.75)) },
        Candidate {
            name: "free body (body omega), semi-implicit Euler, fused",
            floor: "17-22",
            lanes: one,
            run: || go(&SemiImplicitEuler, spin::<Fused<f64>>(1.5)).0,
        },
        Candidate {
            name: "free body (body omega), semi-implicit Euler, plain",
            floor: "-",
            lanes: one,
            run: || go(&SemiImplicitEuler, spin::<f64>(1.5)),
        },
        Candidate {
            name: "free body (body omega), RK4, fused",
            floor: "60",
            lanes: one,
            run: || go(&Rk4, spin::<Fused<f64>>(1.5)).0,
        },
        Candidate {
            name: "free body (body omega), RK4, plain",
            floor: "-",
            lanes: one,
            run: || go(&Rk4, spin::<f64>(1.5)),
        },
        Candidate {
            name: "free body (world omega, factor by factor), semi-implicit Euler, plain",
            floor: "-",
            lanes: one,
            run: || {
                let start = {
                    let s = world(1.5);
                    State {
                        q: Pose::new(Fixed::zero(), s.q.attitude),
                        v: Twist { linear: Fixed::zero(), angular: s.v.angular },
                    }
                };
                go(&SemiImplicitEuler, (WorldOmega::<_>::new(Free(inertia::<f64>())), start))
            },
        },
        Candidate {
            name: "free body (textbook R I R^T), semi-implicit Euler, plain",
            floor: "124-190",
            lanes: one,
            run: || go(&SemiImplicitEuler, (Textbook(inertia()), world(1.5))),
        },
        Candidate {
            name: "FMA peak, f64x4 x 12",
            floor: "0.125",
            lanes: (48.0, 2.0),
            run: || fma_peak().to_array()[0],
        },
        Candidate {
            name: "ensemble of 16 oscillators, semi-implicit Euler",
            floor: "60 % of peak",
            lanes: (16.0, 4.0),
            run: || go(&SemiImplicitEuler, spring::<Lanes<4>>(0.75)).0[0].0.to_array()[0],
        },
        Candidate {
            name: "ensemble of 24 oscillators, semi-implicit Euler",
            floor: "60 % of peak",
            lanes: (24.0, 4.0),
            run: || go(&SemiImplicitEuler, spring::<Lanes<6>>(0.75)).0[0].0.to_array()[0],
        },
        Candidate {
            name: "ensemble of 4 free bodies, semi-implicit Euler",
            floor: "60 % of peak",
            lanes: (4.0, 72.0),
            run: || go(&SemiImplicitEuler, spin::<Lanes<1>>(1.5)).0[0].0.to_array()[0],
        },
        Candidate {
            name: "ensemble of 8 free bodies, semi-implicit Euler",
            floor: "60 % of peak",
            lanes: (8.0, 72.0),
            run: || go(&SemiImplicitEuler, spin::<Lanes<2>>(1.5)).0[0].0.to_array()[0],
        },
        Candidate {
            name: "ensemble of 16 free bodies, semi-implicit Euler",
            floor: "60 % of peak",
            lanes: (16.0, 72.0),
            run: || go(&SemiImplicitEuler, spin::<Lanes<4>>(1.5)).0[0].0.to_array()[0],
        },
    ]
}

/// How much faster two threads do twice an ensemble's work than one: the best of many short rounds.
fn gain_of_two_threads(work: fn() -> f64) -> f64 {
    // A millisecond or more: a thread is started in a fiftieth of it, and a busy machine still leaves some rounds alone.
    let start = Instant::now();
    black_box(work());
    let repeats = (1e-3 / start.elapsed().as_secs_f64()).ceil() as usize;
    let seconds = |threads: usize| {
        let start = Instant::now();
        std::thread::scope(|scope| {
            for _ in 0..threads {
                scope.spawn(|| (0..repeats).for_each(|_| _ = black_box(work())));
            }
        });
        start.elapsed().as_secs_f64()
    };
    let mut least = [f64::INFINITY; 2];
    for _ in 0..ROUNDS {
        for threads in [1, 2] {
            least[threads - 1] = least[threads - 1].min(seconds(threads));
        }
    }
    2.0 * least[0] / least[1]
}

fn main() {
    let candidates = candidates();
    let mut ratios = vec![Vec::with_capacity(ROUNDS); candidates.len()];
    let mut sums = vec![0.0; candidates.len()];
    let seconds = |work: &dyn Fn() -> f64, sum: &mut f64| {
        let start = Instant::now();
        *sum = black_box(work());
        start.elapsed().as_secs_f64()
    };
    for _ in 0..ROUNDS {
        for (i, candidate) in candidates.iter().enumerate() {
            // The clock before and after: an interruption of one of them must not make a candidate look fast.
            let before = seconds(&clock, &mut 0.0);
            let time = seconds(&candidate.run, &mut sums[i]);
            let cycle = before.min(seconds(&clock, &mut 0.0)) / 4.0;
            ratios[i].push(time / cycle);
        }
    }
    println!(
        "{:<72} {:>8} {:>8} {:>14}  {:>9}",
        "cycles of a step of one trajectory", "least", "median", "floor", "last"
    );
    for ((candidate, mut ratios), sum) in candidates.iter().zip(ratios).zip(sums) {
        ratios.sort_by(f64::total_cmp);
        let (lanes, operations) = candidate.lanes;
        let cycles = |r: f64| r / lanes;
        let share = if operations > 0.0 {
            format!("{:.1} flop/cycle", operations / cycles(ratios[ROUNDS / 2]))
        } else {
            String::new()
        };
        println!(
            "{:<72} {:>8.2} {:>8.2} {:>14}  {:>9.6} {share}",
            candidate.name,
            cycles(ratios[0]),
            cycles(ratios[ROUNDS / 2]),
            candidate.floor,
            sum
        );
    }
    for candidate in candidates.iter().filter(|candidate| candidate.lanes.0 == 24.0 || candidate.lanes.0 == 16.0) {
        println!("two threads, {:<59} {:>8.2} times one", candidate.name, gain_of_two_threads(candidate.run));
    }
}
