//! The named steps, to be tracked from version to version: `cargo bench --manifest-path integrator/benches/tracked/Cargo.toml`.
//!
//! Criterion compares each with its own last run (`--save-baseline`, `--baseline`). How far a step is from what the machine
//! allows is printed by `floors`, which needs no earlier run.

use std::hint::black_box;

use criterion::{Criterion, Throughput};
use integrator::lanes::Fused;
use integrator::methods::{ExplicitEuler, Rk4, SemiImplicitEuler, VelocityVerlet};
use wide::f64x4;

#[path = "../models/mod.rs"]
mod models;
use models::{Lanes, STEPS, go, spin, spring};

fn main() {
    let mut criterion = Criterion::default().configure_from_args();
    steps(&mut criterion);
    criterion.final_summary();
}

fn steps(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("step");
    group.throughput(Throughput::Elements(STEPS));
    macro_rules! bench {
        ($($method:ident $arithmetic:ty, $name:literal;)*) => {$(
            group.bench_function(concat!("oscillator/", $name), |b| {
                b.iter(|| black_box(go(&$method, spring::<$arithmetic>(0.75))));
            });
            group.bench_function(concat!("free-body/", $name), |b| {
                b.iter(|| black_box(go(&$method, spin::<$arithmetic>(1.5))));
            });
        )*};
    }
    bench! {
        ExplicitEuler f64, "explicit-euler/plain";
        SemiImplicitEuler f64, "semi-implicit-euler/plain";
        VelocityVerlet f64, "velocity-verlet/plain";
        Rk4 f64, "rk4/plain";
        SemiImplicitEuler Fused<f64>, "semi-implicit-euler/fused";
        Rk4 Fused<f64>, "rk4/fused";
        SemiImplicitEuler Lanes<4>, "semi-implicit-euler/16-lanes";
        Rk4 Lanes<4>, "rk4/16-lanes";
        SemiImplicitEuler f64x4, "semi-implicit-euler/4-plain-lanes";
    }
    group.finish();
}
