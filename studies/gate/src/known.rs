//! What a row may name: scenes, methods, quantities that a scene has, mutants.

use std::collections::BTreeMap;

use faer::fx128;
use integrator::Real;

use super::mutants::Mutant;
use super::row::{Kind, Row, Subject};
use super::stepper::Stepper;
use measure::drift::{Drift, drifts};
use measure::error::Error;
use scenes::any::AnyScene;
use scenes::observation::Quantity;
use scenes::run::Precision;
use scenes::theory::ExpectedOrder;

use measure::stability::amplification;
use scenes::stepping::Stepping;

/// The catalogue by name, and scenes with other parameters by name and settings: `oscillator mass=2 stiffness=8`.
pub struct Known {
    scenes: BTreeMap<String, Scene>,
}

/// The name by which rows name a scene with settings.
pub fn with_settings(id: &str, settings: &str) -> String {
    if settings.is_empty() { id.to_owned() } else { format!("{id} {settings}") }
}

/// The name of the scene, and the settings, of such a name.
pub fn without_settings(name: &str) -> (&str, &str) {
    name.split_once(' ').unwrap_or((name, ""))
}

struct Scene {
    scene: Box<dyn AnyScene>,
    quantities: Vec<Quantity>,
    invariants: Vec<Drift>,
    methods: Vec<String>,
}

impl Known {
    /// The catalogue with its default parameters.
    pub fn catalogue() -> Self {
        let all = scenes::all().into_iter();
        Known { scenes: all.map(|scene| (scene.id().to_owned(), Scene::of(scene))).collect() }
    }

    /// Takes in a scene with these parameters, `NAME=VALUE` parted by blanks. Rows name it by [`with_settings`].
    ///
    /// # Errors
    /// An unknown scene or parameter, a value that is not allowed, or parameters that do not fit together.
    pub fn add(&mut self, id: &str, settings: &str) -> Result<(), Error> {
        let name = with_settings(id, settings);
        if settings.is_empty() || self.scenes.contains_key(&name) {
            return Ok(());
        }
        let mut scene = scenes::by_id(id)?;
        for setting in settings.split_whitespace() {
            let Some((parameter, value)) = setting.split_once('=') else {
                let message = format!("'{setting}' is not of the form NAME=VALUE; part settings by blanks");
                return Err(Error::plan("set", message));
            };
            scene.scene_mut().set(id, parameter, value)?;
        }
        scene.scene().check()?;
        self.scenes.insert(name, Scene::of(scene));
        Ok(())
    }

    /// The scene of a row.
    ///
    /// # Errors
    /// An unknown name, with the list.
    pub fn scene(&self, row: &Row) -> Result<&dyn AnyScene, Error> {
        Ok(self.get(row)?.scene.as_ref())
    }

    fn get(&self, row: &Row) -> Result<&Scene, Error> {
        let unknown = || Error::unknown("scene", &row.scene, scenes::IDS.iter().map(|&id| id.to_owned()));
        self.scenes.get(row.scene.as_str()).ok_or_else(unknown)
    }

    /// The method of a row.
    ///
    /// # Errors
    /// An unknown name, with the list of those that the scene can be stepped with.
    pub fn method(&self, row: &Row) -> Result<Stepper, Error> {
        Stepper::from_id(&row.method, self.scene(row)?)
    }

    /// Whether some scene can be stepped with a method of this name.
    ///
    /// # Errors
    /// An unknown name, with the list of all methods.
    pub fn is_method(&self, id: &str) -> Result<(), Error> {
        let all = || self.scenes.values().flat_map(|scene| &scene.methods);
        if all().any(|method| method == id) {
            return Ok(());
        }
        let mut known: Vec<String> = all().cloned().collect();
        known.sort();
        known.dedup();
        Err(Error::unknown("method", id, known))
    }

    /// Whether the scene has the quantity of a row, and the quantity a number of its kind.
    ///
    /// # Errors
    /// What is missing.
    pub fn quantity(&self, row: &Row) -> Result<(), String> {
        let scene = self.get(row).map_err(|e| e.to_string())?;
        if !row.quantity.has(row.kind) {
            return Err(format!("{} has no {}", row.quantity.id(), row.kind.id()));
        }
        let has = match row.quantity {
            Subject::Error(quantity) => scene.quantities.contains(&quantity),
            Subject::Invariant(drift) => scene.invariants.contains(&drift),
            Subject::Step => self.method(row).is_ok_and(|stepper| has_limit(scene.scene.as_ref(), stepper)),
            Subject::Evaluations => true,
        };
        if !has {
            return Err(format!("{} of {} has no {}: no run matches", row.method, row.scene, row.quantity.id()));
        }
        if row.kind == Kind::ErrorConstant && self.order(row).is_none() {
            return Err(format!("theory names no order of {} on {}: no constant", row.method, row.scene));
        }
        Ok(())
    }

    /// The order of theory of a row's method and quantity.
    fn order(&self, row: &Row) -> Option<f64> {
        let Subject::Error(quantity) = row.quantity else { return None };
        let method = self.method(row).ok()?.of_theory()?;
        match self.get(row).ok()?.scene.scene().expected_error(method, quantity, row.end_s).order {
            ExpectedOrder::Of(order) => Some(order),
            _ => None,
        }
    }

    /// One rounding of what a row bounds: eps of its precision, times the length of an observed vector where that is above 1.
    pub fn rounding(&self, row: &Row) -> f64 {
        let size = match (row.quantity, self.scene(row)) {
            (Subject::Error(quantity), Ok(scene)) => scene.exact(fx128::lit(row.end_s)).scale(quantity).max(1.0),
            _ => 1.0,
        };
        row.precision.epsilon() * size
    }

    /// The unit of a row's numbers.
    pub fn unit(&self, row: &Row) -> String {
        row.quantity.unit(row.kind, self.order(row).unwrap_or(0.0))
    }

    /// Whether the mutant of a row is one.
    ///
    /// # Errors
    /// An unknown name, with the list.
    pub fn mutant(&self, row: &Row) -> Result<Option<Mutant>, Error> {
        if row.mutant.is_empty() { Ok(None) } else { Mutant::from_id(&row.mutant).map(Some) }
    }

    /// Every scene with every method and all that can be measured of the two. The quaternion's norm is not of a scene: the driver
    /// restores it, whatever moves.
    pub fn combinations(&self) -> Vec<(&'static str, String, Subject)> {
        let mut all = Vec::new();
        for (id, scene) in scenes::IDS.iter().filter_map(|&id| Some((id, self.scenes.get(id)?))) {
            for method in Stepper::all(scene.scene.as_ref()) {
                let errors = scene.quantities.iter().map(|&quantity| Subject::Error(quantity));
                let invariants = scene.invariants.iter().filter(|d| **d != Drift::QuaternionNorm);
                let step = has_limit(scene.scene.as_ref(), method).then_some(Subject::Step);
                let invariants = invariants.map(|&drift| Subject::Invariant(drift));
                let subjects = errors.chain(invariants).chain(step).chain([Subject::Evaluations]);
                all.extend(subjects.map(|subject| (id, method.id(), subject)));
            }
        }
        all
    }

    /// Every scene, in the order of the catalogue.
    pub fn in_order(&self) -> Vec<&dyn AnyScene> {
        scenes::IDS.iter().filter_map(|id| self.scenes.get(*id)).map(|scene| scene.scene.as_ref()).collect()
    }

    /// The first preset of each scene.
    pub fn first_presets() -> Vec<&'static str> {
        let mut first = scenes::IDS.to_vec();
        first.dedup_by_key(|id| id.split('/').next());
        first
    }
}

/// Whether a largest stable step can be measured: on a flat scene whose equation is linear.
fn has_limit(scene: &dyn AnyScene, stepper: Stepper) -> bool {
    let Stepper::Flat(method) = stepper else { return false };
    // Rounding is no part of the question.
    amplification::limit(&Stepping { scene, method, precision: Precision::F64 }).is_some()
}

impl Scene {
    fn of(scene: Box<dyn AnyScene>) -> Self {
        let start = scene.exact(fx128::ZERO);
        let invariants = scene.scene().invariants(fx128::ZERO, &start);
        let norm = start.rotation().map(|_| Drift::QuaternionNorm);
        Scene {
            quantities: start.values.iter().map(|(quantity, _)| *quantity).collect(),
            invariants: drifts(&invariants, &invariants).into_iter().map(|(drift, _)| drift).chain(norm).collect(),
            methods: Stepper::all(scene.as_ref()).into_iter().map(Stepper::id).collect(),
            scene,
        }
    }
}
