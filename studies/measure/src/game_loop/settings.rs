//! The settings of a loop as text: read, and shown.

use std::fmt;

use super::description::{Clock, Contact, Damped, Damping, Drawn, Force, Frames, Loop, Read, Start, Stored, wrong};
use super::frames;
use crate::error::Error;

/// The settings of a loop, for `--help` and errors.
pub const SETTINGS: &str = "frames=S,S,.. or FILE.csv, jitter=PART[:SEED], clamp=S, inner=S, substeps=N, force=fresh|frozen, \
    damping=linear:C|implicit:C|power:C|exponential:C, damped=after-move|before-move, start=plain|half-kick, \
    read=stored|synchronised, clock=exact|sum-f64|sum-f32, position=f64|f32, velocity=f64|f32, \
    contact=end|before-kick|after-kick|no-move|impact, drawn=last|interpolated|extrapolated";

/// The help of a flag that takes settings.
pub const HELP: &str = "How the step is used; may be given again.\n\
    frames=S,S,..        lengths of frames in turn; or FILE.csv, its first column\n\
    jitter=PART[:SEED]   frames vary at random by this part, either way\n\
    clamp=S              a longer frame is cut\n\
    inner=S              an accumulator takes inner steps of this length\n\
    substeps=N           steps in a frame, or in an inner step\n\
    force=               fresh, or frozen over the frame\n\
    damping=             linear:C, implicit:C, power:C, exponential:C (C in 1/s)\n\
    damped=              after-move, or before-move\n\
    start=               plain, or half-kick (half a kick back)\n\
    read=                stored, or synchronised (half a kick on)\n\
    clock=               exact, sum-f64, sum-f32\n\
    position=, velocity= stored as f64 or f32\n\
    contact=             end, before-kick, after-kick, no-move, impact\n\
    drawn=               last, interpolated, extrapolated";

const KEYS: [&str; 15] = [
    "frames", "jitter", "clamp", "inner", "substeps", "force", "damping", "damped", "start", "read", "clock",
    "position", "velocity", "contact", "drawn",
];

fn not_a(key: &str, value: &str, expected: &str) -> Error {
    Error::plan(format!("--loop {key}"), format!("'{value}' is not {expected}"))
}

fn number(key: &str, text: &str, allowed: impl Fn(f64) -> bool, expected: &str) -> Result<f64, Error> {
    let quotient = |text: &str| match text.split_once('/') {
        Some((a, b)) => Some(a.trim().parse::<f64>().ok()? / b.trim().parse::<f64>().ok()?),
        None => text.trim().parse().ok(),
    };
    quotient(text).filter(|x| x.is_finite() && allowed(*x)).ok_or_else(|| not_a(key, text, expected))
}

const SECONDS: &str = "a length of time; give seconds above 0, such as 0.016 or 1/60";

impl Loop {
    /// The loop of these settings, each `key=value`.
    ///
    /// # Errors
    /// An unknown key or value, a number outside its range, a file of frames that cannot be read.
    pub fn read<S: AsRef<str>>(settings: &[S]) -> Result<Self, Error> {
        let mut plan = Loop::default();
        for setting in settings {
            plan.set(setting.as_ref())?;
        }
        Ok(plan)
    }

    fn set(&mut self, setting: &str) -> Result<(), Error> {
        let Some((key, value)) = setting.split_once('=') else {
            let message = format!("'{setting}' is not of the form KEY=VALUE; the keys are {SETTINGS}");
            return Err(Error::plan("--loop", message));
        };
        match key {
            "frames" => self.frames = Frames::Pattern(frames::read(value)?),
            "jitter" => self.frames = jitter(value)?,
            "clamp" => self.clamp_s = Some(number(key, value, |x| x > 0.0, SECONDS)?),
            "inner" => self.inner_s = Some(number(key, value, |x| x > 0.0, SECONDS)?),
            "substeps" => {
                let n = value.trim().parse().ok().filter(|n| (1..=4096).contains(n));
                self.substeps = n.ok_or_else(|| not_a(key, value, "a number of substeps; give 1 to 4096"))?;
            }
            "force" => self.force = Force::from_text(key, value)?,
            "damping" => self.damping = damping(value)?,
            "damped" => self.damped = Damped::from_text(key, value)?,
            "start" => self.start = Start::from_text(key, value)?,
            "read" => self.read = Read::from_text(key, value)?,
            "clock" => self.clock = Clock::from_text(key, value)?,
            "position" => self.position = Stored::from_text(key, value)?,
            "velocity" => self.velocity = Stored::from_text(key, value)?,
            "contact" => self.contact = Contact::from_text(key, value)?,
            "drawn" => self.drawn = Drawn::from_text(key, value)?,
            _ => return Err(Error::unknown("setting of a loop", key, KEYS.map(str::to_owned))),
        }
        Ok(())
    }
}

fn jitter(text: &str) -> Result<Frames, Error> {
    let (part, seed) = text.split_once(':').unwrap_or((text, "1"));
    let allowed = |x: f64| (0.0..1.0).contains(&x);
    let part = number("jitter", part, allowed, "a part of the frame; give 0 to below 1, such as 0.2")?;
    let seed = seed.trim().parse().map_err(|_| not_a("jitter", seed, "a seed; give a whole number, as in 0.2:7"))?;
    Ok(Frames::Jitter { part, seed })
}

fn damping(text: &str) -> Result<Damping, Error> {
    let (rule, rate) = text.split_once(':').unwrap_or((text, ""));
    let rate = |below: f64| {
        let expected = if below.is_finite() {
            "the part lost in a second; give 0 to below 1"
        } else {
            "a rate in 1/s; give 0 or more"
        };
        number("damping", rate, |c| (0.0..below).contains(&c), expected)
    };
    match rule {
        "none" => Ok(Damping::None),
        "linear" => Ok(Damping::Linear(rate(f64::INFINITY)?)),
        "implicit" => Ok(Damping::Implicit(rate(f64::INFINITY)?)),
        "power" => Ok(Damping::Power(rate(1.0)?)),
        "exponential" => Ok(Damping::Exponential(rate(f64::INFINITY)?)),
        _ => Err(wrong("damping", text, "none, linear:C, implicit:C, power:C, exponential:C")),
    }
}

/// The settings that differ from the plain loop, separated by blanks; `plain` if none does.
impl fmt::Display for Loop {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let plain = Loop::default();
        let mut settings: Vec<String> = Vec::new();
        match &self.frames {
            Frames::Uniform => {}
            Frames::Pattern(lengths) => {
                let lengths: Vec<String> = lengths.iter().map(f64::to_string).collect();
                settings.push(format!("frames={}", lengths.join(",")));
            }
            Frames::Jitter { part, seed } => settings.push(format!("jitter={part}:{seed}")),
        }
        settings.extend(self.clamp_s.map(|s| format!("clamp={s}")));
        settings.extend(self.inner_s.map(|s| format!("inner={s}")));
        if self.substeps > 1 {
            settings.push(format!("substeps={}", self.substeps));
        }
        settings.extend(match self.damping {
            Damping::None => None,
            Damping::Linear(c) => Some(format!("damping=linear:{c}")),
            Damping::Implicit(c) => Some(format!("damping=implicit:{c}")),
            Damping::Power(c) => Some(format!("damping=power:{c}")),
            Damping::Exponential(c) => Some(format!("damping=exponential:{c}")),
        });
        let named = [
            ("force", self.force.id(), plain.force.id()),
            ("damped", self.damped.id(), plain.damped.id()),
            ("start", self.start.id(), plain.start.id()),
            ("read", self.read.id(), plain.read.id()),
            ("clock", self.clock.id(), plain.clock.id()),
            ("position", self.position.id(), plain.position.id()),
            ("velocity", self.velocity.id(), plain.velocity.id()),
            ("contact", self.contact.id(), plain.contact.id()),
            ("drawn", self.drawn.id(), plain.drawn.id()),
        ];
        settings.extend(named.into_iter().filter(|(_, is, was)| is != was).map(|(key, is, _)| format!("{key}={is}")));
        if settings.is_empty() { write!(f, "plain") } else { write!(f, "{}", settings.join(" ")) }
    }
}
