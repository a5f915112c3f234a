use crate::methods::facts::{Conserved, Facts};
use crate::methods::free_splitting::FreeSplitting;
use crate::model::{Method, Model, State};
use crate::pose::{Body, Pose, Update};
use crate::real::Real;
use crate::rigid_body::{BodyOmega, RigidBody};
use crate::space::{Space, Vector};

/// The first half of the lengths of a symmetric composition, the middle one last, each as a sum of two numbers: 32 digits.
type Lengths = &'static [(f64, f64)];

/// 1 / (4 - 4^(1/3)) four times, and what remains. M. Suzuki, Phys. Lett. A 146 (1990) 319.
const SUZUKI4: Lengths = &[
    (0.4144907717943757, 2.5197374150855977e-17),
    (0.4144907717943757, 2.5197374150855977e-17),
    (-0.657963087177503, 1.023280585909174e-17),
];

/// Nine steps, order 6. W. Kahan, R.-C. Li, Math. Comp. 66 (1997) 1089, s9odr6a; more digits from the order conditions.
const KAHAN_LI6: Lengths = &[
    (0.3921614440073141, 1.98260947060107e-17),
    (0.33259913678935943, 9.998816855838094e-18),
    (-0.7062461725576393, -3.081725796879443e-17),
    (0.0822135962935508, 5.551218883768462e-18),
    (0.79854399093483, -9.117744953645643e-18),
];

/// Seventeen steps, order 8. W. Kahan, R.-C. Li, Math. Comp. 66 (1997) 1089, s17odr8a; more digits from the order conditions.
const KAHAN_LI8: Lengths = &[
    (0.13020248308889007, 1.1160926478587086e-17),
    (0.5611629817751084, 1.3032594119637553e-17),
    (-0.38947496264484727, -1.9606416548443513e-17),
    (0.1588419065551556, 7.801358340211594e-18),
    (-0.39590389413323757, -1.126979043912623e-17),
    (0.1845396409783157, -3.9144420253532585e-18),
    (0.25837438768632204, 9.4003188033679e-18),
    (0.2950117236093103, 2.6483903313385904e-17),
    (-0.6055085338300346, 4.4845398377981585e-17),
];

/// The i-th length of a composition, as a part of the step.
#[inline(always)]
fn length<T: Real>(half: Lengths, i: usize) -> T {
    let (high, low) = half[i.min(2 * half.len() - 2 - i)];
    T::lit(high) + T::lit(low)
}

/// Velocity Verlet's steps one after the other; the force at the end of one is that at the start of the next.
#[inline(always)]
fn composed_verlet<T: Real, M: Model<T>>(
    half: Lengths,
    m: &M,
    (t, h): (T, T),
    s: State<M::Config>,
) -> State<M::Config> {
    let (mut s, mut a, mut elapsed) = (s, m.rate(t, &s), T::lit(0.0));
    for i in 0..2 * half.len() - 1 {
        let part: T = length(half, i);
        let (step, half_step) = (part * h, part * h * T::lit(0.5));
        elapsed += part;
        let u = s.v.add_scaled(a, half_step);
        let q_half = s.q.retract(m.velocity(s.q, u), half_step);
        let q = s.q.retract(m.velocity(q_half, u), step);
        a = m.rate(elapsed.mul_add(h, t), &State { q, v: s.v.add_scaled(a, step) });
        s = State { q, v: u.add_scaled(a, half_step) };
    }
    s
}

macro_rules! compositions_of_verlet {
    ($($(#[$doc:meta])* $method:ident: $lengths:ident, $stages:literal, $order:literal, $id:literal, $title:literal, $source:literal;)*) => {$(
        $(#[$doc])*
        ///
        /// Symplectic and reversible. Where the force depends on the velocity, and on rotations, the order is 2: the force at
        /// the start of a step of velocity Verlet is then the one predicted for the end of the last.
        #[derive(Clone, Copy, Debug, Default)]
        pub struct $method;

        impl $method {
            /// What is known of it.
            pub const FACTS: Facts = Facts {
                id: $id,
                title: $title,
                order: $order,
                order_with_velocity: Some(2),
                order_on_rotations: Some(2),
                evaluations: Some($stages + 1),
                symplectic: Some(true),
                reversible: Some(true),
                formula: concat!($stages, " steps of velocity Verlet, of the lengths g_i h with g_i = g_", $stages, "+1-i"),
                latex: &[
                    r"\Phi_h = S_{\gamma_1 h}\circ S_{\gamma_2 h}\circ\dots\circ S_{\gamma_2 h}\circ S_{\gamma_1 h}",
                    r"S_h: \text{velocity Verlet},\quad \sum_i\gamma_i = 1,\quad \sum_i\gamma_i^3 = 0",
                ],
                source: $source,
                ..Facts::NOTHING_KNOWN
            };
        }

        impl<T: Real, M: Model<T>> Method<T, M> for $method {
            #[inline]
            fn step(&self, m: &M, t: T, h: T, s: State<M::Config>) -> State<M::Config> {
                composed_verlet($lengths, m, (t, h), s)
            }
        }
    )*};
}

compositions_of_verlet! {
    /// Five steps of velocity Verlet after M. Suzuki. Order 4, six evaluations.
    VerletSuzuki4: SUZUKI4, 5, 4, "verlet-suzuki-4", "Velocity Verlet, Suzuki 4",
        "M. Suzuki, Phys. Lett. A 146 (1990) 319";
    /// Nine steps of velocity Verlet after W. Kahan and R.-C. Li. Order 6, ten evaluations.
    VerletKahanLi6: KAHAN_LI6, 9, 6, "verlet-kahan-li-6", "Velocity Verlet, Kahan-Li 6",
        "W. Kahan, R.-C. Li, Math. Comp. 66 (1997) 1089, s9odr6a";
    /// Seventeen steps of velocity Verlet after W. Kahan and R.-C. Li. Order 8, eighteen evaluations.
    VerletKahanLi8: KAHAN_LI8, 17, 8, "verlet-kahan-li-8", "Velocity Verlet, Kahan-Li 8",
        "W. Kahan, R.-C. Li, Math. Comp. 66 (1997) 1089, s17odr8a";
}

macro_rules! compositions_of_splitting {
    ($($(#[$doc:meta])* $method:ident: $lengths:ident, $stages:literal, $order:literal, $id:literal, $title:literal, $source:literal;)*) => {$(
        $(#[$doc])*
        ///
        /// Without a torque R l is kept and a step is a Poisson map. Where the torque depends on the velocities the order is 3:
        /// the splitting is then not symmetric.
        #[derive(Clone, Copy, Debug, Default)]
        pub struct $method;

        impl $method {
            /// What is known of it.
            pub const FACTS: Facts = Facts {
                id: $id,
                title: $title,
                order: $order,
                order_with_velocity: Some(3),
                evaluations: Some(2 * $stages),
                symplectic: Some(true),
                reversible: Some(true),
                conserves: &[Conserved::Momentum],
                formula: concat!($stages, " steps of the free splitting, of the lengths g_i h with g_i = g_", $stages, "+1-i"),
                latex: &[
                    r"\Phi_h = S_{\gamma_1 h}\circ S_{\gamma_2 h}\circ\dots\circ S_{\gamma_2 h}\circ S_{\gamma_1 h}",
                    r"S_h: \text{the splitting into axis rotations},\quad \sum_i\gamma_i = 1,\quad \sum_i\gamma_i^3 = 0",
                ],
                source: $source,
                ..Facts::NOTHING_KNOWN
            };
        }

        impl<T: Real, B: RigidBody<T>, U: Update<Frame = Body>> Method<T, BodyOmega<B, U>> for $method {
            #[inline]
            fn step(
                &self,
                m: &BodyOmega<B, U>,
                t: T,
                h: T,
                s: State<Pose<T, U, B::Position>>,
            ) -> State<Pose<T, U, B::Position>> {
                let (mut s, mut elapsed) = (s, T::lit(0.0));
                for i in 0..$stages {
                    let part: T = length($lengths, i);
                    s = FreeSplitting.step(m, elapsed.mul_add(h, t), part * h, s);
                    elapsed += part;
                }
                s
            }
        }
    )*};
}

compositions_of_splitting! {
    /// Five steps of [`FreeSplitting`] after M. Suzuki. Order 4, ten evaluations.
    SplittingSuzuki4: SUZUKI4, 5, 4, "splitting-suzuki-4", "Splitting, Suzuki 4",
        "M. Suzuki, Phys. Lett. A 146 (1990) 319";
    /// Nine steps of [`FreeSplitting`] after W. Kahan and R.-C. Li. Order 6, eighteen evaluations.
    SplittingKahanLi6: KAHAN_LI6, 9, 6, "splitting-kahan-li-6", "Splitting, Kahan-Li 6",
        "W. Kahan, R.-C. Li, Math. Comp. 66 (1997) 1089, s9odr6a";
    /// Seventeen steps of [`FreeSplitting`] after W. Kahan and R.-C. Li. Order 8, thirty-four evaluations.
    SplittingKahanLi8: KAHAN_LI8, 17, 8, "splitting-kahan-li-8", "Splitting, Kahan-Li 8",
        "W. Kahan, R.-C. Li, Math. Comp. 66 (1997) 1089, s17odr8a";
}
