//! What is run. The same keys on the command line, in a plan file and in a report's manifest.

use std::collections::BTreeSet;
use std::path::Path;

use clap::Args;
use integrator::methods::{MethodId, RigidStep};
use serde::{Deserialize, Serialize};

use measure::error::Error;
use measure::game_loop::Loop;
use scenes::any::AnyScene;
use scenes::run::{Precision, method_from_id};
use scenes::scheme::Scheme;
use scenes::settings;

use crate::units;
use measure::study::{Draws, Length, Selection, distinct};
use measure::sweep::Progress;

/// All that decides the numbers of a run, and nothing else: the same plan gives the same bytes, but for times. An empty list
/// means all.
#[derive(Args, Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
#[command(next_help_heading = "What to run")]
pub struct Plan {
    /// Scene, or scene/preset, to look at; may be given again [default: all]
    #[arg(long, value_name = "ID")]
    pub scene: Vec<String>,

    /// Method, or scheme for rigid bodies, to look at; may be given again [default: all]
    #[arg(long, value_name = "ID")]
    pub method: Vec<String>,

    /// Arithmetic: f32, f64 or double-double; may be given again [default: all]
    #[arg(long, value_name = "ID")]
    pub precision: Vec<String>,

    /// Set a parameter of every chosen scene that has it, as zeta=0.2 or c=0.8; may be given again
    #[arg(long, value_name = "NAME=VALUE", allow_hyphen_values = true)]
    pub set: Vec<String>,

    /// Numbers of steps of a sweep, at least 1 each [default: 12 halvings from the scene's coarsest]
    #[arg(long, value_name = "N,N,..", value_delimiter = ',', value_parser = steps, allow_hyphen_values = true)]
    pub steps: Vec<u64>,

    /// Length of a run: seconds, 2min, or 100rev of the scene's own period [default: the scene's horizon]
    #[arg(long = "for", value_name = "TIME", value_parser = length, allow_hyphen_values = true)]
    #[serde(rename = "for", skip_serializing_if = "Option::is_none")]
    pub length: Option<RunLength>,

    /// Members of an ensemble [default: 256]
    #[arg(long, value_name = "N", value_parser = members, allow_hyphen_values = true)]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub members: Option<usize>,

    /// Seed from which the members are drawn [default: 1]
    #[arg(long, value_name = "S", value_parser = seed, allow_hyphen_values = true)]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub seed: Option<u64>,

    /// How the step is used: frames, substeps, damping, clock and more; may be given again (--help lists the keys)
    #[arg(long = "loop", long_help = measure::game_loop::settings::HELP, value_name = "KEY=VALUE", allow_hyphen_values = true)]
    #[serde(rename = "loop", skip_serializing_if = "Vec::is_empty")]
    pub looped: Vec<String>,

    /// One preset of each scene, fewer halvings and shorter runs
    #[arg(long)]
    pub quick: bool,
}

fn members(text: &str) -> Result<usize, String> {
    let number = text.trim().parse().ok().filter(|n| *n > 0);
    number.ok_or_else(|| "not a whole number greater than 0; give a number of starts, such as 1000".to_owned())
}

fn seed(text: &str) -> Result<u64, String> {
    text.trim().parse().map_err(|_| format!("not a whole number from 0 to {}; give a seed, such as 1", u64::MAX))
}

const STEPS_REMEDY: &str = "a run has at least 1 step; give numbers such as 64,128,256";

fn steps(text: &str) -> Result<u64, String> {
    text.trim().parse().ok().filter(|&n| n > 0).ok_or_else(|| format!("not a number of steps; {STEPS_REMEDY}"))
}

/// The length of a run, positive and finite: a number of seconds, or a text with a unit.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(try_from = "LengthText", into = "LengthText")]
pub struct RunLength(pub Length);

/// A length as a plan file has it.
#[derive(Serialize, Deserialize)]
#[serde(untagged, expecting = "the length of a run is a number of seconds, or a text such as \"100rev\"")]
enum LengthText {
    Seconds(f64),
    Text(String),
}

/// Positive and finite numbers are equal to themselves.
impl Eq for RunLength {}

const LENGTH_REMEDY: &str = "seconds above 0, such as 2.5, or 2min, or 100rev";

impl TryFrom<LengthText> for RunLength {
    type Error = String;
    fn try_from(text: LengthText) -> Result<Self, String> {
        match text {
            LengthText::Seconds(s) => length(&s.to_string()),
            LengthText::Text(text) => length(&text),
        }
    }
}

impl From<RunLength> for LengthText {
    fn from(RunLength(length): RunLength) -> Self {
        match length {
            Length::Seconds(s) => LengthText::Seconds(s),
            Length::Periods(n) => LengthText::Text(format!("{n}rev")),
        }
    }
}

impl std::fmt::Display for RunLength {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self.0 {
            Length::Seconds(s) => write!(f, "{s}"),
            Length::Periods(n) => write!(f, "{n}rev"),
        }
    }
}

fn length(text: &str) -> Result<RunLength, String> {
    units::length(text, LENGTH_REMEDY).map(RunLength)
}

/// The head of every plan file that is written.
const HEAD: &str = "# What was run. `--plan plan.toml` runs it again; an empty list means all.\n";

impl Plan {
    /// The plan in a TOML file: the flags' long names are its keys, and each may be left out.
    ///
    /// # Errors
    /// A file that cannot be read; with the line, an unknown key or a value of another kind; a plan that cannot be run.
    pub fn read(path: &Path) -> Result<Self, Error> {
        let place = path.display();
        let text = std::fs::read_to_string(path).map_err(|error| {
            Error::plan(place.to_string(), format!("cannot be read: {error}; give the plan.toml of a report"))
        })?;
        let plan: Plan = toml::from_str(&text).map_err(|error| {
            let line = error.span().map_or(1, |span| 1 + text[..span.start].matches('\n').count());
            let message = error.message().trim_end().replace('\n', ", ");
            Error::plan(format!("{place}:{line}"), format!("{message}; the keys of a plan are {}", Self::keys()))
        })?;
        plan.selection().map_err(|error| Error::plan(place.to_string(), error.to_string()))?;
        Ok(plan)
    }

    fn keys() -> &'static str {
        "scene, method, precision, set, loop (lists of texts), steps (a list of numbers), for (seconds, or a text as \"100rev\"), members, seed (whole numbers) and quick (true or false)"
    }

    /// The plan as TOML.
    ///
    /// # Errors
    /// None that is known: every value has a form in TOML.
    pub fn to_toml(&self) -> Result<String, Error> {
        let text = toml::to_string(self).map_err(|error| Error::plan("plan".to_owned(), error.to_string()))?;
        Ok(format!("{HEAD}{text}"))
    }

    /// This plan with what `flags` give in its place: a list given replaces the list, a parameter set replaces the one of
    /// that name, `--quick` is added.
    #[must_use]
    pub fn overridden_by(self, flags: Plan) -> Plan {
        fn either<T>(flags: Vec<T>, plan: Vec<T>) -> Vec<T> {
            if flags.is_empty() { plan } else { flags }
        }
        let name = |setting: &String| setting.split('=').next().unwrap_or_default().to_owned();
        let given: Vec<String> = flags.set.iter().map(name).collect();
        let kept = self.set.into_iter().filter(|setting| !given.contains(&name(setting)));
        Plan {
            scene: either(flags.scene, self.scene),
            method: either(flags.method, self.method),
            precision: either(flags.precision, self.precision),
            set: kept.chain(flags.set.iter().cloned()).collect(),
            steps: either(flags.steps, self.steps),
            length: flags.length.or(self.length),
            members: flags.members.or(self.members),
            seed: flags.seed.or(self.seed),
            looped: either(flags.looped, self.looped),
            quick: self.quick || flags.quick,
        }
    }

    /// Refuses a key that the study `id`, which heeds those of `heeds`, would not look at: no run does less than its plan says.
    ///
    /// # Errors
    /// The first such key.
    pub fn heeded(&self, id: &str, heeds: &[&str]) -> Result<(), Error> {
        let given = [
            ("precision", !self.precision.is_empty()),
            ("steps", !self.steps.is_empty()),
            ("for", self.length.is_some()),
            ("members", self.members.is_some()),
            ("seed", self.seed.is_some()),
            ("loop", !self.looped.is_empty()),
        ];
        let unheard = given.into_iter().find(|(key, is_given)| *is_given && !heeds.contains(key));
        unheard.map_or(Ok(()), |(key, _)| {
            let message = format!("{id} runs what it needs, whatever is given; leave it out");
            Err(Error::plan(format!("--{key}"), message))
        })
    }

    /// The flags beside `--scene` that run this plan again on one scene (on all where it is `None`), with a blank before each.
    pub(crate) fn flags(&self, scene: Option<&str>) -> String {
        let mut flags = String::new();
        let mut add = |flag: &str, values: &[String]| {
            flags.extend(values.iter().map(|value| format!(" --{flag} {value}")));
        };
        add("method", &self.method);
        add("precision", &self.precision);
        add("loop", &self.looped);
        // A parameter that the scene lacks would be refused.
        let takes = |setting: &&String| {
            let Some((scene, (name, value))) = scene.zip(setting.split_once('=')) else { return false };
            scenes::by_id(scene)
                .is_ok_and(|mut s| settings::apply(s.as_mut(), &[(name, value)]).is_ok_and(|taken| taken == [true]))
        };
        add("set", &self.set.iter().filter(takes).cloned().collect::<Vec<_>>());
        let steps: Vec<String> = self.steps.iter().map(u64::to_string).collect();
        add("steps", &if steps.is_empty() { Vec::new() } else { vec![steps.join(",")] });
        if let Some(length) = self.length {
            flags += &format!(" --for {length}");
        }
        if let Some(members) = self.members {
            flags += &format!(" --members {members}");
        }
        if let Some(seed) = self.seed {
            flags += &format!(" --seed {seed}");
        }
        if self.quick {
            flags += " --quick";
        }
        flags
    }

    /// The scenes, methods and precisions that it names.
    ///
    /// # Errors
    /// An unknown name, a parameter outside its range, or a number of steps that is zero.
    pub fn selection(&self) -> Result<Selection, Error> {
        if self.steps.contains(&0) {
            return Err(Error::plan("steps".to_owned(), STEPS_REMEDY.to_owned()));
        }
        let mut chosen = if self.scene.is_empty() {
            let mut all = scenes::all();
            if self.quick {
                // One preset of each scene.
                all.dedup_by_key(|scene| scene.id().split('/').next());
            }
            all
        } else {
            distinct(&self.scene).into_iter().map(|id| scenes::by_id(id)).collect::<Result<_, _>>()?
        };
        self.apply_settings(&mut chosen)?;
        let (methods, schemes) = self.rules()?;
        let length = self.checked_length(&chosen)?;
        Ok(Selection {
            scenes: chosen,
            methods,
            schemes,
            precisions: named(&self.precision, Precision::from_id, &Precision::ALL)?,
            steps: {
                let mut steps = distinct(self.steps.iter().copied());
                steps.sort_unstable();
                steps
            },
            length,
            quick: self.quick,
            draws: Draws {
                members: self.members.unwrap_or(Draws::default().members),
                seed: self.seed.unwrap_or(Draws::default().seed),
            },
            looped: (!self.looped.is_empty()).then(|| Loop::read(&self.looped)).transpose()?,
            shard: None,
            progress: Progress::silent(),
        })
    }

    /// The methods, and the schemes for rigid bodies that are chosen by their own name.
    fn rules(&self) -> Result<(Vec<MethodId>, Vec<Scheme>), Error> {
        if self.method.is_empty() {
            return Ok((MethodId::ALL.to_vec(), Vec::new()));
        }
        let (mut methods, mut schemes) = (Vec::new(), Vec::new());
        for name in distinct(&self.method) {
            match (method_from_id(name), Scheme::from_id(name)) {
                (Ok(method), _) => methods.push(method),
                (Err(_), Some(scheme)) => schemes.push(scheme),
                (Err(_), None) => {
                    let general = MethodId::ALL.iter().map(|method| method.id().to_owned());
                    let rigid = RigidStep::ALL.iter().map(|step| step.id().to_owned());
                    return Err(Error::unknown("method", name, general.chain(rigid)));
                }
            }
        }
        Ok((methods, schemes))
    }

    /// The length of the runs, where it is given: one that every scene has.
    fn checked_length(&self, chosen: &[Box<dyn AnyScene>]) -> Result<Option<Length>, Error> {
        let Some(RunLength(length)) = self.length else { return Ok(None) };
        for scene in chosen {
            let ends_s = scene.scene().ends_s();
            if ends_s <= length.end_s(scene.as_ref())? {
                let message = format!("the motion of {} is over at {ends_s:.4} s; give less", scene.id());
                return Err(Error::plan("for".to_owned(), message));
            }
        }
        Ok(Some(length))
    }

    fn apply_settings(&self, chosen: &mut [Box<dyn AnyScene>]) -> Result<(), Error> {
        let pairs: Vec<(&str, &str)> = self
            .set
            .iter()
            .map(|setting| {
                setting.split_once('=').ok_or_else(|| {
                    let message = format!("'{setting}' is not of the form NAME=VALUE; `list SCENE` shows the names");
                    Error::plan("set".to_owned(), message)
                })
            })
            .collect::<Result<_, _>>()?;
        let mut taken = vec![false; pairs.len()];
        for scene in chosen.iter_mut() {
            let by_scene = settings::apply(scene.as_mut(), &pairs)?;
            taken.iter_mut().zip(by_scene).for_each(|(all, one)| *all |= one);
        }
        // Another scene may have the parameter.
        if let Some(i) = taken.iter().position(|taken| !taken) {
            let known: BTreeSet<String> = chosen.iter().flat_map(|scene| settings::names(scene.as_ref())).collect();
            return Err(scenes::error::Error::unknown("parameter", pairs[i].0, known).into());
        }
        Ok(chosen.iter().try_for_each(|scene| scene.scene().check())?)
    }
}

/// The values of the given names in the order given, each once; all values if no name is given.
fn named<V: Copy + PartialEq>(
    names: &[String],
    by_name: impl Fn(&str) -> Result<V, scenes::error::Error>,
    all: &[V],
) -> Result<Vec<V>, Error> {
    if names.is_empty() {
        return Ok(all.to_vec());
    }
    Ok(distinct(names.iter().map(|name| by_name(name)).collect::<Result<Vec<_>, _>>()?))
}
