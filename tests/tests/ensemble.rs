//! Ensembles: every lane is its member alone, to the last bit; the starts are drawn as their rules say; failures are counted.
//!
//! Not seen here: how fast the lanes are.

use std::f64::consts::{FRAC_1_SQRT_2, FRAC_PI_2, PI};

use integrator::lanes::{FromLanes, Fused, Pack};
use integrator::methods::MethodId;
use integrator::pose::Fixed;
use integrator::rigid_body::{BodyOmega, Kinematics, RigidModel, WorldOmega};
use integrator::{Model, Real, Rotation, State, Vector};
use measure::ensemble::draw::{Members, draw, with_a_rule};
use measure::ensemble::lanes::{Coordinates, Eight, WIDTH, run_pack, runs_in_lanes};
use measure::ensemble::random::Generator;
use measure::ensemble::{Row, measure};
use measure::study::{Length, Selection};
use measure::sweep::Progress;
use nalgebra::{Matrix3, Vector1, Vector2, Vector3};
use reports::write_csv;
use scenes::observation::{Observation, Quantity, Value};
use scenes::run::{Precision, Run};
use scenes::{Kepler, Pendulum, TorqueFreeSpin};
use wide::f64x4;

const IN_LANES: [MethodId; 4] =
    [MethodId::ExplicitEuler, MethodId::SemiImplicitEuler, MethodId::VelocityVerlet, MethodId::Rk4];
/// One full pack, and one with five lanes to spare.
const MEMBERS: usize = WIDTH + 3;
/// One block of the driver, one settling of the quaternion, and a part of the next block.
const STEPS: u64 = 100;

fn drawn(id: &str, count: usize) -> Box<dyn Members> {
    draw(scenes::by_id(id).expect("a scene").as_ref(), count, 7).expect("a scene with a rule")
}

fn bits(seen: &Observation) -> Vec<[u64; 2]> {
    let components = seen.values.iter().flat_map(|(_, value)| match value {
        Value::Vector(v) => v.clone(),
        Value::Rotation(q) => q.wxyz().to_vec(),
    });
    components.map(|x| [x.0.to_bits(), x.1.to_bits()]).chain([[seen.norm_error.to_bits(), 0]]).collect()
}

// Fails if: a lane's arithmetic differs from f64's, lanes are mixed up, a start is not the member's, the law differs between
// members, or the driver settles at other steps.
#[test]
fn a_lane_has_the_bits_of_its_member_alone_in_every_scene_and_method() {
    assert!(with_a_rule().len() >= 20, "{:?}", with_a_rule());
    for id in with_a_rule() {
        let scene = scenes::by_id(id).expect("a scene");
        let (members, end_s) = (drawn(id, MEMBERS), scene.scene().info().horizon_s);
        for method in IN_LANES {
            let ends =
                [0..WIDTH, WIDTH..MEMBERS].map(|some| members.ends(some, method, end_s, STEPS).expect("in lanes"));
            let ends = ends.concat();
            assert_eq!(ends.len(), MEMBERS);
            for (i, end) in ends.iter().enumerate() {
                let alone = members
                    .alone(i)
                    .run(&Run::new(method, Precision::F64, end_s, STEPS), STEPS)
                    .expect("a general method");
                let (end, alone) = (end.as_ref().map(bits), alone.end().map(bits));
                assert!(end.is_some() && end == alone, "{id} {} member {i}: {end:?} {alone:?}", method.id());
            }
            let first = ends[0].as_ref().map(bits);
            assert!(ends[1..].iter().all(|end| end.as_ref().map(bits) != first), "{id}: the members are all alike");
        }
    }
}

/// Every number of every end, or nothing for a member that failed.
fn packs<L: FromLanes, M: Model<L>, Q: Coordinates<Scalar = f64>>(
    model: &M,
    starts: &[State<Q>],
    method: MethodId,
) -> Vec<Option<Vec<u64>>>
where
    M::Config: Coordinates<Scalar = L>,
{
    let numbers = |state: State<Q>| {
        let q = (0..Q::COUNT).map(|i| state.q.coordinate(i));
        let v = (0..Q::Tangent::DIM).map(|i| state.v.component(i));
        q.chain(v).map(f64::to_bits).collect()
    };
    let ends = starts
        .chunks(L::LANES)
        .flat_map(|pack| run_pack::<L, M, Q>(model, pack, method, 1.75, STEPS).expect("in lanes"));
    ends.map(|end| end.map(numbers)).collect()
}

type FusedEight = Pack<Fused<f64x4>, 2>;

/// Plain lanes against plain numbers, fused ones against fused ones.
fn agree<M, Q: Coordinates<Scalar = f64>>(model: &M, starts: &[State<Q>])
where
    M: Model<f64> + Model<Eight> + Model<Fused<f64>> + Model<FusedEight>,
    <M as Model<f64>>::Config: Coordinates,
    <M as Model<Eight>>::Config: Coordinates,
    <M as Model<Fused<f64>>>::Config: Coordinates,
    <M as Model<FusedEight>>::Config: Coordinates,
{
    for method in IN_LANES {
        let [plain, fused] =
            [packs::<f64, M, Q>(model, starts, method), packs::<Fused<f64>, M, Q>(model, starts, method)];
        assert_eq!(packs::<Eight, M, Q>(model, starts, method), plain, "{}", method.id());
        assert_eq!(packs::<FusedEight, M, Q>(model, starts, method), fused, "{} fused", method.id());
        assert_ne!(plain, fused, "{}: fusing has changed nothing", method.id());
    }
}

// Fails if: an operation of the fused lanes rounds twice, or one of the plain lanes once.
#[test]
fn fused_lanes_have_the_bits_of_fused_numbers_and_plain_lanes_those_of_plain_ones() {
    let mut random = Generator::new(11);
    let mut spread = |scale: f64| random.between(-scale, scale);
    let flat: Vec<_> =
        (0..MEMBERS).map(|_| State { q: Vector1::new(spread(3.0)), v: Vector1::new(spread(2.0)) }).collect();
    agree(&Pendulum::default(), &flat);
    let plane: Vec<_> = (0..MEMBERS)
        .map(|_| State {
            q: Vector2::new(spread(0.25) + 1.0, spread(0.5)),
            v: Vector2::new(spread(0.25), spread(0.25) + 1.25),
        })
        .collect();
    agree(&Kepler::default(), &plane);
}

// Fails if: an attitude's components are permuted or normalised on their way into the lanes, or one lane's large angle
// sends the others through another sum.
#[test]
fn fused_lanes_of_rigid_bodies_have_the_bits_of_single_ones() {
    let body = TorqueFreeSpin::default();
    let mut random = Generator::new(13);
    // |omega| h from 0.02 to 2 rad: both sides of the bound of the Taylor sums, in one pack.
    let starts: Vec<Kinematics<f64, Fixed<f64>>> = (0..MEMBERS)
        .map(|i| Kinematics {
            position: Fixed::zero(),
            velocity: Fixed::zero(),
            attitude: Rotation::from_wxyz(random.attitude()),
            omega_body: Vector3::from(random.direction()) * (1.0 + 10.0 * i as f64),
        })
        .collect();
    let world = WorldOmega::<_>::new(&body);
    agree(&world, &starts.iter().map(|at| world.state(at)).collect::<Vec<_>>());
    let in_body = BodyOmega::<_>::new(&body);
    agree(&in_body, &starts.iter().map(|at| in_body.state(at)).collect::<Vec<_>>());
}

/// x'' = x^3: a start far out is infinite soon.
struct Runaway;

impl<T: Real> Model<T> for Runaway {
    type Config = Vector1<T>;
    fn rate(&self, _t: T, s: &State<Vector1<T>>) -> Vector1<T> {
        s.q * (s.q.x * s.q.x)
    }
}

// Fails if: one member's failure takes its neighbours with it, or is not noticed.
#[test]
fn a_member_that_fails_leaves_its_neighbours_their_bits() {
    let starts: Vec<_> = (0..MEMBERS)
        .map(|i| State { q: Vector1::new(if i % 4 == 1 { 1e6 } else { 0.0625 * i as f64 }), v: Vector1::new(0.0) })
        .collect();
    for method in IN_LANES {
        let alone = packs::<f64, _, _>(&Runaway, &starts, method);
        assert_eq!(alone.iter().filter(|end| end.is_none()).count(), 3, "{}", method.id());
        assert_eq!(packs::<Eight, _, _>(&Runaway, &starts, method), alone, "{}", method.id());
    }
}

fn selection(id: &str, methods: &[MethodId], steps: &[u64]) -> Selection {
    Selection {
        scenes: vec![scenes::by_id(id).expect("a scene")],
        methods: methods.to_vec(),
        schemes: Vec::new(),
        precisions: vec![Precision::F64],
        steps: steps.to_vec(),
        length: None,
        quick: true,
        draws: Default::default(),
        looped: None,
        shard: None,
        progress: Progress::silent(),
    }
}

fn first(rows: &[Row], method: MethodId, quantity: Quantity) -> &Row {
    rows.iter().find(|row| row.method == method.id() && row.quantity == quantity).expect("a row")
}

// Fails if: a failed member scores as 0, or is left out of the count.
#[test]
fn failed_members_are_counted_and_never_scored() {
    let mut plan = Selection { length: Some(Length::Seconds(2.25)), ..selection("linear-drag", &IN_LANES, &[16]) };
    plan.scenes[0].scene_mut().set("linear-drag", "drag", "1e200").expect("a parameter");
    for row in measure(&plan, 20, 1) {
        assert_eq!((row.members, row.failed, row.worst_member), (20, 20, 0));
        assert_eq!((row.median, row.percentile_95, row.worst), (None, None, None));
    }
}

// Fails if: the phase is not uniform, a quantile has another rank, or the error is not that of the end. Every method is linear
// here, so that the error of a start with the phase p is E |cos(p - p0)|, whatever the step: the quantile u of |cos p| is
// cos((1 - u) pi / 2), with the standard deviation sqrt(u (1 - u) / N) / f, f = (2 / pi) / sin((1 - u) pi / 2).
#[test]
fn oscillator_errors_over_a_uniform_phase_are_distributed_as_a_cosine() {
    const N: usize = 4096;
    let rows = measure(&selection("oscillator", &IN_LANES, &[64]), N, 3);
    assert_eq!(rows.len(), 8);
    for row in &rows {
        let worst = row.worst.expect("finished");
        for (u, quantile) in [(0.5, row.median), (0.95, row.percentile_95)] {
            let rest = (1.0 - u) * FRAC_PI_2;
            let deviation = (u * (1.0 - u) / N as f64).sqrt() * FRAC_PI_2 * rest.sin();
            let ratio = quantile.expect("finished") / worst;
            assert!((ratio - rest.cos()).abs() <= 5.0 * deviation, "{} {u}: {ratio}", row.method);
        }
    }
    assert!((f64::cos(0.5 * FRAC_PI_2) - FRAC_1_SQRT_2).abs() < 1e-15);
}

// Fails if: members have laws of their own, or errors are taken against another member's motion. Theory: x is wrong by exactly
// a T h / 2, wherever it started; rounding adds a few ulps of |x| < 32 m.
#[test]
fn every_start_of_a_projectile_has_the_same_error() {
    let rows = measure(&selection("constant-force", &IN_LANES, &[64]), 100, 5);
    let acceleration: f64 = Vector3::new(0.625, -0.3125, -12.1875).norm() / 1.25;
    let expected = acceleration * 1.5 * (1.5 / 64.0) / 2.0;
    for method in [MethodId::ExplicitEuler, MethodId::SemiImplicitEuler] {
        let row = first(&rows, method, Quantity::Position);
        for error in [row.median, row.percentile_95, row.worst] {
            let error: f64 = error.expect("finished");
            assert!((error - expected).abs() <= 64.0 * 32.0 * f64::EPSILON, "{error} {expected}");
        }
    }
}

// Fails if: --set of the reported start does not lead to the reported error.
#[test]
fn the_reported_start_has_the_reported_error() {
    for (id, quantity) in [("kepler", Quantity::Position), ("tennis-racket", Quantity::Attitude)] {
        let rows = measure(&selection(id, &[MethodId::Rk4], &[STEPS]), 50, 1);
        let row = first(&rows, MethodId::Rk4, quantity);
        let mut scene = scenes::by_id(id).expect("a scene");
        for setting in row.worst_start.split(' ') {
            let (name, value) = setting.split_once('=').expect("name=value");
            scene.scene_mut().set(id, name, value).expect("a parameter");
        }
        let end_s = scene.scene().info().horizon_s;
        let run = scene.run(&Run::new(MethodId::Rk4, Precision::F64, end_s, STEPS), STEPS).expect("a general method");
        let exact = scene.exact(faer::fx128::lit(end_s));
        let errors = run.end().expect("finished").distances(&exact);
        let error = errors.iter().find(|(q, _)| *q == quantity).map(|(_, error)| *error);
        assert_eq!(error, row.worst, "{id}: {}", row.worst_start);
    }
}

// Fails if: members are drawn in the order in which threads come to them, from a clock, or all from one seed.
#[test]
fn the_same_seed_gives_the_same_bytes_on_any_number_of_threads() {
    let bytes = |threads: usize, count: usize, seed: u64| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("a pool");
        pool.install(|| {
            write_csv(&measure(&selection("torque-free-spin", &IN_LANES, &[32, 64]), count, seed)).expect("rows")
        })
    };
    let alone = bytes(1, 70, 1);
    assert_eq!(bytes(2, 70, 1), alone);
    assert_eq!(bytes(3, 70, 1), alone);
    assert_ne!(bytes(1, 70, 2), alone);
    // Two members more of the same sequence: the first ones are the same.
    let start = |members: Box<dyn Members>, i| members.alone(i).scene().parameters();
    assert_eq!(start(drawn("kepler", 5), 4), start(drawn("kepler", 7), 4));
    assert_ne!(start(drawn("kepler", 7), 4), start(drawn("kepler", 7), 5));
}

// Fails if: the study claims an order that theory does not promise, or fits failed runs.
#[test]
fn median_and_worst_fall_with_the_order_of_the_method() {
    use measure::study::Study;
    let rows = measure(&selection("torque-free-spin", &IN_LANES, &[8, 16, 32, 64, 128, 256, 512, 1024, 2048]), 64, 1);
    let claims = measure::ensemble::Ensemble::claims(&rows);
    assert_eq!(claims.len(), 4 * 2 * 2);
    assert!(claims.iter().all(|claim| claim.verdict == reports::Verdict::Holds), "{claims:#?}");
}

// Fails if: a wrong choice is run without a word.
#[test]
fn what_cannot_run_in_lanes_is_refused_with_what_can() {
    let refused = |id: &str, methods: &[MethodId], precision, count| {
        let plan = Selection { precisions: vec![precision], ..selection(id, methods, &[8]) };
        measure::ensemble::check(&plan, count, 1).err().map(|error| error.to_string()).unwrap_or_default()
    };
    let contacts = refused("bouncing-ball", &IN_LANES, Precision::F64, 4);
    assert!(contacts.contains("bouncing-ball") && contacts.contains("kepler"), "{contacts}");
    let implicit = refused("kepler", &[MethodId::ImplicitEuler], Precision::F64, 4);
    assert!(implicit.contains("rk4") && !implicit.contains("implicit-midpoint"), "{implicit}");
    assert!(refused("kepler", &IN_LANES, Precision::F32, 4).contains("--precision"));
    assert!(refused("kepler", &IN_LANES, Precision::F64, 0).contains("1 to"));
    assert!(IN_LANES.into_iter().all(runs_in_lanes) && !runs_in_lanes(MethodId::ImplicitMidpoint));
}

// The first numbers of the seed 1234567, from S. Vigna's splitmix64.c (2015).
#[test]
fn the_generator_is_splitmix64() {
    let mut random = Generator::new(1_234_567);
    let expected = [6_457_827_717_110_365_317, 3_203_168_211_198_807_973, 9_817_491_932_198_370_423];
    assert_eq!([random.bits(), random.bits(), random.bits()], expected);
}

const DRAWS: usize = 100_000;

/// By how many of its standard deviations each first and second moment of R misses that of the uniform distribution, at
/// most. An entry is uniform in [-1, 1]: mean 0 and variance 1/3, mean square 1/3 and its variance 1/5 - 1/9. Two different
/// entries have the mean product 0, with a variance of at most 1/5 (Cauchy and Schwarz).
fn deviation(mut attitude: impl FnMut() -> [f64; 4]) -> f64 {
    let (mut first, mut second) = (Matrix3::zeros(), [[0.0; 9]; 9]);
    for _ in 0..DRAWS {
        let r: Matrix3<f64> = Rotation::from_wxyz(attitude()).matrix();
        first += r;
        for (i, row) in second.iter_mut().enumerate() {
            for (j, sum) in row.iter_mut().enumerate() {
                *sum += r[i] * r[j];
            }
        }
    }
    let n = DRAWS as f64;
    let means = first.iter().map(|sum| (sum / n).abs() / (1.0 / (3.0 * n)).sqrt());
    let squares = (0..9).flat_map(|i| (0..9).map(move |j| (i, j))).map(|(i, j)| {
        let (mean, variance) = if i == j { (1.0 / 3.0, 1.0 / 5.0 - 1.0 / 9.0) } else { (0.0, 1.0 / 5.0) };
        (second[i][j] / n - mean).abs() / (variance / n).sqrt()
    });
    means.chain(squares).fold(0.0, f64::max)
}

// Fails if: the share is not uniform, or an angle spans half a turn. The seed is fixed: 5 deviations are certain, not likely.
#[test]
fn attitudes_are_uniform_on_so3() {
    let mut random = Generator::new(1);
    let missed = deviation(|| random.attitude());
    assert!(missed <= 5.0, "{missed} standard deviations");
}

// The check sees what is nearly uniform: a uniform axis with a uniform angle, and four numbers uniform in a cube, normalised.
#[test]
fn biased_attitudes_are_seen() {
    let mut random = Generator::new(1);
    let axis_angle = deviation(|| {
        let (axis, half) = (random.direction(), random.between(0.0, PI) / 2.0);
        [half.cos(), axis[0] * half.sin(), axis[1] * half.sin(), axis[2] * half.sin()]
    });
    let cube = deviation(|| [0; 4].map(|_| random.between(-1.0, 1.0)));
    assert!(axis_angle > 5.0 && cube > 5.0, "{axis_angle} {cube}");
}

// Fails if: the poles are favoured, or the circle at z is not sqrt(1 - z^2) wide.
#[test]
fn directions_are_uniform_on_the_sphere() {
    let mut random = Generator::new(1);
    let (mut sum, mut squares) = (Vector3::zeros(), Vector3::zeros());
    for _ in 0..DRAWS {
        let direction = Vector3::from(random.direction());
        // Three roundings of squares of at most 1, and those of sine and cosine.
        assert!((direction.norm_squared() - 1.0).abs() <= 8.0 * f64::EPSILON);
        sum += direction;
        squares += direction.component_mul(&direction);
    }
    let n = DRAWS as f64;
    assert!((sum / n).abs().max() <= 5.0 * (1.0 / (3.0 * n)).sqrt(), "{sum}");
    assert!(
        (squares / n).add_scalar(-1.0 / 3.0).abs().max() <= 5.0 * ((1.0 / 5.0 - 1.0 / 9.0) / n).sqrt(),
        "{squares}"
    );
}
