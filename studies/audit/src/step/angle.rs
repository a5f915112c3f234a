//! Candidates for the step of a pendulum: an angle and its rate.

use integrator::methods::{MethodId, Visitor};
use integrator::{Method, Single, State};
use nalgebra::Vector1;

use super::candidate::{Candidate, Kin, Precision};
use super::own::{Memory, Tableau};
use crate::physics::Swing;

#[derive(Clone, Copy)]
enum Scheme {
    Method(MethodId),
    Tableau(Tableau),
    Memory(Memory),
}

/// All candidates for theta'' = -omega0^2 sin theta.
pub(super) fn candidates(square: f64, single: bool) -> Vec<Candidate> {
    let mut schemes: Vec<Scheme> = MethodId::ALL.iter().map(|m| Scheme::Method(*m)).collect();
    schemes.extend(Tableau::ALL.into_iter().take(3).map(Scheme::Tableau));
    schemes.extend(Memory::ALL.map(Scheme::Memory));
    let mut all = Vec::new();
    for &precision in Precision::tried(single) {
        for &scheme in &schemes {
            for substeps in [1_u32, 2, 4, 8] {
                let memory = matches!(scheme, Scheme::Memory(_));
                if substeps > 1 && !matches!(scheme, Scheme::Method(MethodId::SemiImplicitEuler)) {
                    continue;
                }
                let mut id = match scheme {
                    Scheme::Method(m) => m.id(),
                    Scheme::Tableau(t) => t.id(),
                    Scheme::Memory(m) => m.id(),
                }
                .to_owned();
                if substeps > 1 {
                    id = format!("{id}, {substeps} substeps");
                }
                if precision == Precision::Single {
                    id += ", f32";
                }
                let run = move |start: &Kin, h: f64, k: u64, rows: u64| {
                    let (h, k) = (h / f64::from(substeps), k * u64::from(substeps));
                    match precision {
                        Precision::Double => run::<f64>(scheme, square, start, h, k, rows),
                        Precision::Single => run::<f32>(scheme, square, start, h, k, rows),
                    }
                };
                all.push(Candidate { id, memory, steps: None, damping: None, substeps, run: Box::new(run) });
            }
        }
    }
    all
}

struct Once<T: Single> {
    model: Swing,
    h: T,
    s: State<Vector1<T>>,
}

impl<T: Single> Visitor<T, Swing> for Once<T> {
    type Output = State<Vector1<T>>;
    fn visit<A: Method<T, Swing>>(self, method: &A) -> Self::Output {
        method.step(&self.model, T::lit(0.0), self.h, self.s)
    }
}

fn run<T: Single>(scheme: Scheme, square: f64, start: &Kin, h: f64, k: u64, rows: u64) -> Vec<Kin> {
    let model = Swing(square);
    let h = T::lit(h);
    let mut s = State { q: Vector1::new(T::lit(start.angle[0])), v: Vector1::new(T::lit(start.angle[1])) };
    let kin = |s: &State<Vector1<T>>| Kin { angle: [s.q.x.to_f64(), s.v.x.to_f64()], ..*start };
    let mut out = Vec::with_capacity(rows as usize);
    if let Scheme::Memory(memory) = scheme {
        let mut n = 0;
        memory.run(&model, h, s, k * rows, |s| {
            n += 1;
            if n % k == 0 {
                out.push(kin(s));
            }
        });
        return out;
    }
    for _ in 0..rows {
        for _ in 0..k {
            s = match scheme {
                Scheme::Method(method) => method.visit(Once { model, h, s }),
                Scheme::Tableau(tableau) => tableau.step(&model, T::lit(0.0), h, s),
                Scheme::Memory(_) => s,
            };
        }
        out.push(kin(&s));
    }
    out
}
