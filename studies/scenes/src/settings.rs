//! Settings of a scene's parameters as a user gives them, in any order.

use crate::any::AnyScene;
use crate::error::Error;
use crate::parameters::{ParameterValue, Substitute};

/// Two values of one parameter agree up to this part of them.
const SAME: f64 = 1e-12;

/// Sets parameters by name and text, those that stand for others last. `true` for each that the scene has.
///
/// # Errors
/// A value that is not allowed, or that contradicts another setting.
pub fn apply(scene: &mut dyn AnyScene, settings: &[(&str, &str)]) -> Result<Vec<bool>, Error> {
    let id = scene.id();
    let is_substitute = |name: &str| scene.scene().substitutes().iter().any(|s| s.name == name);
    let (late, own): (Vec<usize>, Vec<usize>) = (0..settings.len()).partition(|&i| is_substitute(settings[i].0));
    let mut taken = vec![false; settings.len()];
    let mut given: Vec<(&str, &str)> = Vec::new();
    for i in own {
        let (name, text) = settings[i];
        match scene.scene_mut().set(id, name, text) {
            Ok(()) => {
                taken[i] = true;
                given.push((name, text));
            }
            Err(Error::UnknownName { .. }) => {}
            Err(error) => return Err(error),
        }
    }
    for i in late {
        let (name, text) = settings[i];
        let all = scene.scene().substitutes();
        let Some(substitute) = all.iter().find(|s| s.name == name) else { continue };
        let value = own_value(id, substitute, text)?;
        taken[i] = true;
        match given.iter().find(|(other, _)| *other == substitute.of || all.iter().any(|s| s.name == *other)) {
            Some((other, other_text)) => {
                let now = scene.scene().parameters().into_iter().find(|p| p.name == substitute.of);
                let now = now.and_then(|p| p.value.parse::<f64>().ok()).unwrap_or(f64::NAN);
                // Written so that a NaN is refused.
                if !((now - value).abs() <= SAME * now.abs().max(value.abs())) {
                    let remedy = format!("contradicts {other} = {other_text}; give one of the two");
                    return Err(refusal(id, name, text, remedy));
                }
            }
            None => scene.scene_mut().set(id, substitute.of, &value.show()).map_err(|_| {
                refusal(id, name, text, format!("makes {} = {value}, which is not allowed", substitute.of))
            })?,
        }
        given.push((name, text));
    }
    Ok(taken)
}

/// The names that a scene takes.
pub fn names(scene: &dyn AnyScene) -> Vec<String> {
    let own = scene.scene().parameters().into_iter().map(|p| p.name.to_owned());
    own.chain(scene.scene().substitutes().into_iter().map(|s| s.name.to_owned())).collect()
}

fn own_value(id: &str, substitute: &Substitute, text: &str) -> Result<f64, Error> {
    let given = f64::parse(text).filter(|x| x.is_finite());
    let given = given.ok_or_else(|| refusal(id, substitute.name, text, "must be a finite number".to_owned()))?;
    Ok(given * substitute.factor)
}

fn refusal(scene: &str, parameter: &str, value: &str, expected: String) -> Error {
    Error::Parameter { scene: scene.to_owned(), parameter: parameter.to_owned(), value: value.to_owned(), expected }
}
