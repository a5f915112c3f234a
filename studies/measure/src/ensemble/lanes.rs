//! Many starts of one law of motion, stepped side by side in SIMD lanes.
//!
//! The law is one for all; each lane has its own start. A lane has the bits of the run of its member alone (in the same
//! arithmetic), so that nothing is known of an ensemble that is not known of its members.

use integrator::lanes::{FromLanes, Pack};
use integrator::methods::{MethodId, Visitor};
use integrator::pose::Pose;
use integrator::{Method, Model, Real, Rotation, Space, State, Vector, drive};
use nalgebra::{SMatrix, Vector3};
use wide::f64x4;

/// The arithmetic of an ensemble: plain `f64`, eight members at a time.
pub type Eight = Pack<f64x4, 2>;
/// Its members.
pub const WIDTH: usize = <Eight as FromLanes>::LANES;

/// A configuration as a list of numbers.
pub trait Coordinates: Space {
    /// How many there are.
    const COUNT: usize;
    /// The configuration whose i-th number is `f(i)`.
    fn from_coordinates(f: impl FnMut(usize) -> Self::Scalar) -> Self;
    /// The i-th number, i < [`Self::COUNT`].
    fn coordinate(&self, i: usize) -> Self::Scalar;
}

impl<T: Real, const R: usize, const C: usize> Coordinates for SMatrix<T, R, C> {
    const COUNT: usize = R * C;

    fn from_coordinates(f: impl FnMut(usize) -> T) -> Self {
        Vector::from_fn(f)
    }
    fn coordinate(&self, i: usize) -> T {
        self[i]
    }
}

impl<T: Real, U: integrator::pose::Update, P: Vector<T>> Coordinates for Pose<T, U, P> {
    const COUNT: usize = P::DIM + 4;

    fn from_coordinates(mut f: impl FnMut(usize) -> T) -> Self {
        let position = P::from_fn(&mut f);
        // As it is: normalising would change bits.
        let w = f(P::DIM);
        Pose::new(position, Rotation { w, v: Vector3::from_fn(|i, _| f(P::DIM + 1 + i)) })
    }
    fn coordinate(&self, i: usize) -> T {
        match i.checked_sub(P::DIM) {
            None => self.position.component(i),
            Some(0) => self.attitude.w,
            Some(i) => self.attitude.v[i - 1],
        }
    }
}

/// The states of up to `L::LANES` members, the last of them in every lane that is left.
fn packed<L: FromLanes, Q, P>(members: &[State<Q>]) -> State<P>
where
    Q: Coordinates<Scalar = f64>,
    P: Coordinates<Scalar = L>,
{
    let member = |lane: usize| &members[lane.min(members.len() - 1)];
    State {
        q: P::from_coordinates(|i| L::from_lanes(|lane| member(lane).q.coordinate(i))),
        v: Vector::from_fn(|i| L::from_lanes(|lane| member(lane).v.component(i))),
    }
}

/// The state of one member.
fn unpacked<L: FromLanes, Q, P>(state: &State<P>, lane: usize) -> State<Q>
where
    Q: Coordinates<Scalar = f64>,
    P: Coordinates<Scalar = L>,
{
    State {
        q: Q::from_coordinates(|i| state.q.coordinate(i).lane(lane)),
        v: Vector::from_fn(|i| state.v.component(i).lane(lane)),
    }
}

/// Whether a method takes its step by arithmetic alone, the same in every lane: one that solves equations goes on until
/// they are solved, and each member has its own end.
pub fn runs_in_lanes(method: MethodId) -> bool {
    !method.is_implicit()
}

/// Runs members of one law, at least one and at most `L::LANES`, to the end; `None` for one that left the finite numbers.
///
/// A failure stops the pack; then every member is run again with all lanes to itself, which gives it the same bits.
/// The outer `None`: the method does not run in lanes.
pub fn run_pack<L: FromLanes, M: Model<L>, Q: Coordinates<Scalar = f64>>(
    model: &M,
    members: &[State<Q>],
    method: MethodId,
    end_s: f64,
    steps: u64,
) -> Option<Vec<Option<State<Q>>>>
where
    M::Config: Coordinates<Scalar = L>,
{
    let run = |members: &[State<Q>]| method.visit_explicit(Members { model, start: packed(members), end_s, steps });
    let end = |state: &State<M::Config>, lane| unpacked(state, lane);
    Some(match run(members)? {
        Some(state) => (0..members.len()).map(|lane| Some(end(&state, lane))).collect(),
        None => members.iter().map(|member| run(&[*member]).flatten().map(|state| end(&state, 0))).collect(),
    })
}

/// One run of a pack to the end.
struct Members<'a, L: FromLanes, M: Model<L>> {
    model: &'a M,
    start: State<M::Config>,
    end_s: f64,
    steps: u64,
}

impl<L: FromLanes, M: Model<L>> Visitor<L, M> for Members<'_, L, M> {
    type Output = Option<State<M::Config>>;

    fn visit<A: Method<L, M>>(self, method: &A) -> Self::Output {
        let h = L::lit(self.end_s) / L::lit(self.steps as f64);
        drive::advance(method, self.model, self.start, h, self.steps).ok()
    }
}
