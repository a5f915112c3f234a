//! A question: what to do, with which scene, method and step.

use integrator::methods::{MethodId, RigidStep};
use integrator::rigid_body::{AttitudeUpdate, Formulation};
use scenes::error::Error;
use scenes::run::{Precision, Run, method_from_id};
use scenes::scheme::{Rule, Scheme};

/// What is asked.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Command {
    /// What the scene is: parameters, quantities, invariants, as text.
    #[default]
    Describe,
    /// A run, observed every `stride` steps.
    Run,
    /// The exact motion at `steps` + 1 evenly spaced times.
    Exact,
    /// The errors of a run to the scene's horizon, as the convergence study measures them.
    Errors,
    /// The spectral radius of one step, at `steps` steps up to the length `end_s`.
    Amplification,
}

/// A question, read.
#[derive(Clone, Debug, PartialEq)]
pub struct Question {
    /// What is asked.
    pub command: Command,
    /// Scene or preset.
    pub scene: String,
    /// Parameters that differ from the preset's: name and value.
    pub set: Vec<(String, String)>,
    /// The rule of a step.
    pub rule: Rule,
    /// What a rigid body stores.
    pub storage: Formulation,
    /// How its attitude is advanced.
    pub update: AttitudeUpdate,
    /// The arithmetic.
    pub precision: Precision,
    /// End of the run, s.
    pub end_s: f64,
    /// Number of steps.
    pub steps: u64,
    /// Steps between two looks.
    pub stride: u64,
    /// Whether the errors at the checkpoints are wanted too, as in the report; each is an exact motion more to be evaluated.
    pub checkpoints: bool,
    /// Whether semi-implicit Euler starts with half a kick and is read half a kick back.
    pub half_kick: bool,
    /// Part by which the steps vary at random, either way.
    pub jitter: f64,
    /// Whether the double-double run of the same step is wanted for the rounding errors.
    pub rounding: bool,
}

impl Question {
    /// Reads a question.
    ///
    /// # Errors
    /// An unknown command, key or name, or a number that is none.
    pub fn read(text: &str) -> Result<Self, Error> {
        let mut lines = text.lines().map(str::trim).filter(|line| !line.is_empty());
        let mut question = Question {
            command: command(lines.next().unwrap_or_default())?,
            scene: String::new(),
            set: Vec::new(),
            rule: Rule::General(MethodId::SemiImplicitEuler),
            storage: Formulation::default(),
            update: AttitudeUpdate::default(),
            precision: Precision::F64,
            end_s: 1.0,
            steps: 1,
            stride: 1,
            checkpoints: false,
            half_kick: false,
            jitter: 0.0,
            rounding: false,
        };
        for line in lines {
            let (key, value) = line.split_once(' ').unwrap_or((line, ""));
            question.take(key, value)?;
        }
        if question.steps == 0 || question.stride == 0 || !(question.end_s.is_finite() && question.end_s > 0.0) {
            return Err(Error::plan("steps, stride, end_s", "must be greater than zero"));
        }
        if !(0.0..1.0).contains(&question.jitter) || (question.jitter > 0.0 && question.half_kick) {
            return Err(Error::plan("jitter", "must be from 0 to below 1, and 0 beside half_kick"));
        }
        Ok(question)
    }

    fn take(&mut self, key: &str, value: &str) -> Result<(), Error> {
        match key {
            "scene" => value.clone_into(&mut self.scene),
            "set" => {
                let (name, value) = value.split_once('=').ok_or_else(|| Error::plan("set", "must be NAME=VALUE"))?;
                self.set.push((name.to_owned(), value.to_owned()));
            }
            "method" => self.rule = Rule::General(method_from_id(value)?),
            "step" => self.rule = Rule::Rigid(named("step", RigidStep::ALL, RigidStep::id, value)?),
            "storage" => self.storage = named("storage", &Formulation::ALL, Formulation::id, value)?,
            "update" => self.update = named("update", &AttitudeUpdate::ALL, AttitudeUpdate::id, value)?,
            "precision" => self.precision = Precision::from_id(value)?,
            "end_s" => self.end_s = number(key, value)?,
            "steps" => self.steps = number(key, value)?,
            "stride" => self.stride = number(key, value)?,
            "checkpoints" => self.checkpoints = number(key, value)?,
            "half_kick" => self.half_kick = number(key, value)?,
            "jitter" => self.jitter = number(key, value)?,
            "rounding" => self.rounding = number(key, value)?,
            _ => return Err(Error::unknown("key", key, KEYS.map(str::to_owned))),
        }
        Ok(())
    }

    /// The run that is asked for.
    pub fn run(&self) -> Run {
        let scheme = match self.rule {
            Rule::General(method) => Scheme::general(method, self.storage, self.update),
            Rule::Rigid(step) => Scheme::rigid(step, self.update),
        };
        Run::new(scheme, self.precision, self.end_s, self.steps)
    }
}

const KEYS: [&str; 14] = [
    "scene",
    "set",
    "method",
    "step",
    "storage",
    "update",
    "precision",
    "end_s",
    "steps",
    "stride",
    "checkpoints",
    "half_kick",
    "jitter",
    "rounding",
];

fn command(name: &str) -> Result<Command, Error> {
    let all = [
        ("describe", Command::Describe),
        ("run", Command::Run),
        ("exact", Command::Exact),
        ("errors", Command::Errors),
        ("amplification", Command::Amplification),
    ];
    named("command", &all, |(name, _)| name, name).map(|(_, command)| command)
}

fn named<A: Copy>(kind: &'static str, all: &[A], id: impl Fn(A) -> &'static str, name: &str) -> Result<A, Error> {
    let found = all.iter().copied().find(|a| id(*a) == name);
    found.ok_or_else(|| Error::unknown(kind, name, all.iter().map(|a| id(*a).to_owned())))
}

fn number<N: std::str::FromStr>(key: &str, text: &str) -> Result<N, Error> {
    text.parse().map_err(|_| Error::plan(key, format!("'{text}' is not of the right form")))
}
