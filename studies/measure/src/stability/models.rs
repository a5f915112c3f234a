//! The small models behind the maps: a damped oscillator with omega = 1, the scalar test equation, Kepler's problem.

use integrator::methods::{MethodId, Visitor};
use integrator::{Method, Model, State};
use nalgebra::{Complex, Vector1, Vector2};

use super::trend::{self, Trend};
use scenes::DampedOscillator;
use scenes::scene::Scene;
use scenes::theory::StabilityLimit;

/// x'' = -x - 2 zeta x'.
#[derive(Clone, Copy, Debug)]
pub struct Damped {
    /// Damping ratio.
    pub zeta: f64,
}

impl Model<f64> for Damped {
    type Config = Vector1<f64>;

    #[inline(always)]
    fn rate(&self, _t: f64, s: &State<Vector1<f64>>) -> Vector1<f64> {
        -s.q - s.v * (2.0 * self.zeta)
    }
}

/// Semi-implicit Euler with the damping force taken at the end of the step, as physics engines do:
/// v1 = (v0 - h x0) / (1 + 2 zeta h), x1 = x0 + h v1.
#[derive(Clone, Copy, Debug)]
pub struct ImplicitDamping;

impl Method<f64, Damped> for ImplicitDamping {
    #[inline(always)]
    fn step(&self, m: &Damped, _t: f64, h: f64, s: State<Vector1<f64>>) -> State<Vector1<f64>> {
        let v = (s.v - s.q * h) / (1.0 + 2.0 * m.zeta * h);
        State { q: s.q + v * h, v }
    }
}

/// A rule for the damped oscillator.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Scheme {
    /// One of the list, the damping taken as every other force.
    Listed(MethodId),
    /// [`ImplicitDamping`].
    ImplicitDamping,
}

impl Scheme {
    /// Those of the maps.
    pub const ALL: [Scheme; 6] = [
        Scheme::Listed(MethodId::ExplicitEuler),
        Scheme::Listed(MethodId::SemiImplicitEuler),
        Scheme::ImplicitDamping,
        Scheme::Listed(MethodId::VelocityVerlet),
        Scheme::Listed(MethodId::Rk4),
        Scheme::Listed(MethodId::ImplicitEuler),
    ];

    /// The name in tables.
    pub fn id(self) -> &'static str {
        match self {
            Scheme::Listed(method) => method.id(),
            Scheme::ImplicitDamping => "semi-implicit-euler-implicit-damping",
        }
    }

    /// The name in a sentence.
    pub fn title(self) -> &'static str {
        match self {
            Scheme::Listed(MethodId::SemiImplicitEuler) => "Semi-implicit Euler, explicit damping",
            Scheme::Listed(method) => method.title(),
            Scheme::ImplicitDamping => "Semi-implicit Euler, implicit damping",
        }
    }

    /// Whether the damped oscillator stays bounded with the step h (omega = 1), as a run shows.
    pub fn holds(self, zeta: f64, h: f64) -> bool {
        let lengths: &[u32] = if self == Scheme::Listed(MethodId::ImplicitEuler) { &[7, 9] } else { &[8, 11, 14] };
        for &log2_steps in lengths {
            let run = Sizes { model: Damped { zeta }, h, log2_steps };
            let sizes = match self {
                Scheme::Listed(method) => method.visit(run),
                Scheme::ImplicitDamping => run.visit(&ImplicitDamping),
            };
            if let Some(trend) = trend::trend(&sizes) {
                return trend != Trend::Exponential;
            }
        }
        true
    }

    /// The largest stable h omega of theory as a function of the damping ratio; infinite where there is none.
    ///
    /// Of a listed method the limit of the scene `damped-oscillator`; with implicit damping 2 (sqrt(1 + zeta^2) + zeta).
    pub fn limit(self, zeta: f64) -> f64 {
        let Scheme::Listed(method) = self else { return 2.0 * (zeta.hypot(1.0) + zeta) };
        let scene = DampedOscillator { mass: 1.0, stiffness: 1.0, zeta, ..DampedOscillator::default() };
        match (&scene as &dyn Scene).expected_limit(method) {
            Some((StabilityLimit::NoStep, _)) => 0.0,
            Some((StabilityLimit::Below(h_s), _)) => h_s,
            Some((StabilityLimit::Unlimited, _)) | None => f64::INFINITY,
        }
    }
}

/// |z|.
pub fn modulus((re, im): (f64, f64)) -> f64 {
    re.hypot(im)
}

/// R(z) of a method on y' = lambda y, z = h lambda: what a step does to a velocity that no position acts on. NaN where it is
/// not known.
pub fn stability_function(method: MethodId, (x, y): (f64, f64)) -> (f64, f64) {
    let r = method
        .facts()
        .linear
        .map_or(Complex::new(f64::NAN, f64::NAN), |linear| linear.velocity().at(Complex::new(x, y)));
    (r.re, r.im)
}

struct Sizes {
    model: Damped,
    h: f64,
    log2_steps: u32,
}

impl Visitor<f64, Damped> for Sizes {
    type Output = Vec<(u64, f64)>;

    fn visit<A: Method<f64, Damped>>(self, method: &A) -> Self::Output {
        // Moving outwards: no eigenvector of a damped oscillator does, so that every mode has its part.
        let mut s = State { q: Vector1::new(0.75), v: Vector1::new(0.8125) };
        let (mut sizes, mut done) = (Vec::new(), 0);
        for look in trend::samples(self.log2_steps) {
            while done < look {
                s = method.step(&self.model, 0.0, self.h, s);
                done += 1;
            }
            let size = s.q.x.hypot(s.v.x);
            sizes.push((look, size));
            if !(1e-12..1e12).contains(&size) {
                // Decided; the rest would only cost time.
                sizes.push((look + 1, if size < 1.0 { 0.0 } else { f64::INFINITY }));
                break;
            }
        }
        sizes
    }
}

/// v' = lambda v in the complex plane: the test equation, in the part of the state that every method treats as such.
pub(super) struct TestEquation {
    pub(super) lambda: (f64, f64),
}

impl Model<f64> for TestEquation {
    type Config = Vector2<f64>;

    #[inline(always)]
    fn rate(&self, _t: f64, s: &State<Vector2<f64>>) -> Vector2<f64> {
        let (re, im) = self.lambda;
        Vector2::new(re * s.v.x - im * s.v.y, re * s.v.y + im * s.v.x)
    }
}

/// |y1| / |y0| of one step of y' = z y with h = 1.
pub fn amplification(method: MethodId, z: (f64, f64)) -> f64 {
    struct OneStep(TestEquation);
    impl Visitor<f64, TestEquation> for OneStep {
        type Output = f64;
        fn visit<A: Method<f64, TestEquation>>(self, method: &A) -> f64 {
            let start = State { q: Vector2::zeros(), v: Vector2::new(1.0, 0.0) };
            method.step(&self.0, 0.0, 1.0, start).v.norm()
        }
    }
    method.visit(OneStep(TestEquation { lambda: z }))
}

/// x'' = -x / |x|^3: period 2 pi for a = 1.
pub(super) struct KeplerPlane;

impl Model<f64> for KeplerPlane {
    type Config = Vector2<f64>;

    #[inline(always)]
    fn rate(&self, _t: f64, s: &State<Vector2<f64>>) -> Vector2<f64> {
        let r2 = s.q.norm_squared();
        s.q / (-r2 * r2.sqrt())
    }
}

/// How many orbits pass, at most `most`, until the energy is wrong by half of itself; started at the apocentre.
pub fn orbits_survived(method: MethodId, eccentricity: f64, steps_an_orbit: f64, most: u32) -> f64 {
    struct Survive {
        eccentricity: f64,
        steps_an_orbit: f64,
        most: u32,
    }
    impl Visitor<f64, KeplerPlane> for Survive {
        type Output = f64;
        fn visit<A: Method<f64, KeplerPlane>>(self, method: &A) -> f64 {
            let e = self.eccentricity;
            let h = std::f64::consts::TAU / self.steps_an_orbit;
            let mut s =
                State { q: Vector2::new(-(1.0 + e), 0.0), v: Vector2::new(0.0, -((1.0 - e) / (1.0 + e)).sqrt()) };
            let steps = (f64::from(self.most) * self.steps_an_orbit) as u64;
            for i in 1..=steps {
                s = method.step(&KeplerPlane, 0.0, h, s);
                let energy = 0.5 * s.v.norm_squared() - 1.0 / s.q.norm();
                // NaN counts as failed.
                if !((energy + 0.5).abs() <= 0.25) {
                    return i as f64 / self.steps_an_orbit;
                }
            }
            f64::from(self.most)
        }
    }
    method.visit(Survive { eccentricity, steps_an_orbit, most })
}
