//! How a program uses a step: [`Loop`].

use integrator::methods::MethodId;

use crate::error::Error;

/// A choice among named values.
macro_rules! choices {
    ($(#[$doc:meta])* $name:ident { $( $(#[$value_doc:meta])* $value:ident = $id:literal, )* }) => {
        $(#[$doc])*
        #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
        pub enum $name {
            $( $(#[$value_doc])* $value, )*
        }

        impl $name {
            pub(super) fn id(self) -> &'static str {
                match self { $( $name::$value => $id, )* }
            }

            pub(super) fn from_text(key: &str, text: &str) -> Result<Self, Error> {
                match text {
                    $( $id => Ok($name::$value), )*
                    _ => Err(wrong(key, text, &[$( $id ),*].join(", "))),
                }
            }
        }
    };
}

/// The lengths of the frames.
#[derive(Clone, Debug, Default, PartialEq)]
pub enum Frames {
    /// Every frame lasts h.
    #[default]
    Uniform,
    /// These lengths, s, one after the other and again.
    Pattern(Vec<f64>),
    /// h (1 + part u), with u uniform in \[-1, 1\].
    Jitter {
        /// The part of h by which a frame may differ, in \[0, 1).
        part: f64,
        /// Seed of the draws.
        seed: u64,
    },
}

choices! {
    /// When the force is evaluated in the substeps of a frame.
    Force {
        /// In every substep.
        #[default]
        Fresh = "fresh",
        /// Once, at the start of the frame.
        Frozen = "frozen",
    }
}

/// The factor by which the velocity is multiplied in a step of length h, for a rate c in 1/s.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Damping {
    /// 1.
    #[default]
    None,
    /// 1 - c h.
    Linear(f64),
    /// 1 / (1 + c h).
    Implicit(f64),
    /// (1 - c)^h, with c the part lost in a second.
    Power(f64),
    /// exp(-c h).
    Exponential(f64),
}

impl Damping {
    /// The factor of a step.
    pub fn factor(self, h_s: f64) -> f64 {
        match self {
            Damping::None => 1.0,
            Damping::Linear(c) => 1.0 - c * h_s,
            Damping::Implicit(c) => 1.0 / (1.0 + c * h_s),
            Damping::Power(c) => libm::pow(1.0 - c, h_s),
            Damping::Exponential(c) => libm::exp(-c * h_s),
        }
    }

    /// The rate c of the motion exp(-c t) that the rule tends to, 1/s.
    pub fn rate_per_s(self) -> f64 {
        match self {
            Damping::None => 0.0,
            Damping::Linear(c) | Damping::Implicit(c) | Damping::Exponential(c) => c,
            Damping::Power(c) => -libm::log1p(-c),
        }
    }
}

choices! {
    /// When the velocity is damped.
    Damped {
        /// After the configuration has moved.
        #[default]
        AfterMove = "after-move",
        /// Between the kick and the move.
        BeforeMove = "before-move",
    }
}

choices! {
    /// What is done to the velocity before the first step.
    Start {
        /// Nothing: it is the velocity at t = 0.
        #[default]
        Plain = "plain",
        /// Half a kick back: it becomes the velocity at -h / 2, and semi-implicit Euler becomes leapfrog.
        HalfKick = "half-kick",
    }
}

choices! {
    /// Which velocity is read.
    Read {
        /// The stored one.
        #[default]
        Stored = "stored",
        /// The stored one and half a kick: a velocity that lives half a step behind, brought to the time of the position.
        Synchronised = "synchronised",
    }
}

choices! {
    /// The clock that the force and the end of the run see.
    Clock {
        /// i h for equal steps, a sum in double-double for others.
        #[default]
        Exact = "exact",
        /// t += h in f64.
        SumF64 = "sum-f64",
        /// t += h in f32.
        SumF32 = "sum-f32",
    }
}

choices! {
    /// How a number is stored between steps.
    Stored {
        /// 53 bits.
        #[default]
        F64 = "f64",
        /// 24 bits.
        F32 = "f32",
    }
}

impl Stored {
    /// The stored number.
    pub fn round(self, x: f64) -> f64 {
        match self {
            Stored::F64 => x,
            Stored::F32 => f64::from(x as f32),
        }
    }
}

choices! {
    /// When a contact (the bounce of a ball) is handled.
    Contact {
        /// At the end of the step.
        #[default]
        End = "end",
        /// At the start of the step, before the kick.
        BeforeKick = "before-kick",
        /// Between the kick and the move.
        AfterKick = "after-kick",
        /// Between the kick and the move; the body does not move in that step.
        NoMove = "no-move",
        /// At the time of impact, found to the last bit; the rest of the step follows.
        Impact = "impact",
    }
}

choices! {
    /// What is drawn at the end of a frame.
    Drawn {
        /// The last state.
        #[default]
        Last = "last",
        /// Between the last two states, one step behind the clock.
        Interpolated = "interpolated",
        /// The last state moved along its velocity, up to the clock.
        Extrapolated = "extrapolated",
    }
}

/// How a program uses a step. The default is the plain loop: equal steps, and nothing else.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Loop {
    /// The lengths of the frames.
    pub frames: Frames,
    /// A longer frame is cut to this, s: the simulation then falls behind.
    pub clamp_s: Option<f64>,
    /// An accumulator takes inner steps of this length, s, and keeps what is left for the next frame.
    pub inner_s: Option<f64>,
    /// Steps of equal length in a frame, or in an inner step; 0 stands for 1.
    pub substeps: u32,
    /// When the force is evaluated.
    pub force: Force,
    /// How the velocity is damped.
    pub damping: Damping,
    /// When the velocity is damped.
    pub damped: Damped,
    /// How the run starts.
    pub start: Start,
    /// Which velocity is read.
    pub read: Read,
    /// The clock.
    pub clock: Clock,
    /// How a position is stored.
    pub position: Stored,
    /// How a velocity is stored.
    pub velocity: Stored,
    /// When a contact is handled.
    pub contact: Contact,
    /// What is drawn.
    pub drawn: Drawn,
}

pub(super) fn wrong(key: &str, value: &str, expected: &str) -> Error {
    Error::plan(format!("--loop {key}"), format!("'{value}' is not known; give one of {expected}"))
}

/// Inner steps in a frame, at most.
const MOST_INNER: f64 = 65_536.0;

impl Loop {
    /// Whether the step of a frame is taken apart: its kick and its move must be known.
    pub fn needs_the_kick(&self) -> bool {
        let damps = self.damping != Damping::None && self.damped == Damped::BeforeMove;
        damps || matches!(self.contact, Contact::AfterKick | Contact::NoMove)
    }

    /// Refuses what has no meaning for a method.
    ///
    /// # Errors
    /// The setting, with the method that it needs.
    pub fn suits(&self, method: MethodId) -> Result<(), Error> {
        if self.needs_the_kick() && method != MethodId::SemiImplicitEuler {
            let message = format!("{} has no time between kick and move", method.id());
            return Err(Error::plan("--loop", format!("{message}; give --method semi-implicit-euler")));
        }
        Ok(())
    }

    /// Refuses inner steps that a frame of `step_s` would hold without end.
    ///
    /// # Errors
    /// The setting, with the number.
    pub fn fits(&self, step_s: f64) -> Result<(), Error> {
        let longest = match &self.frames {
            Frames::Pattern(lengths) => lengths.iter().copied().fold(0.0, f64::max),
            Frames::Uniform => step_s,
            Frames::Jitter { part, .. } => step_s * (1.0 + part),
        };
        match self.inner_s {
            Some(inner) if longest / inner > MOST_INNER => {
                let message = format!("a frame of {longest} s holds more than {MOST_INNER} inner steps of {inner} s");
                Err(Error::plan("--loop inner", format!("{message}; give longer inner steps")))
            }
            _ => Ok(()),
        }
    }

    /// The same loop with every length of time multiplied, rates unchanged.
    #[must_use]
    pub fn scaled(&self, factor: f64) -> Self {
        let frames = match &self.frames {
            Frames::Pattern(lengths) => Frames::Pattern(lengths.iter().map(|h| h * factor).collect()),
            other => other.clone(),
        };
        let scaled = |s: Option<f64>| s.map(|s| s * factor);
        Loop { frames, clamp_s: scaled(self.clamp_s), inner_s: scaled(self.inner_s), ..self.clone() }
    }
}
