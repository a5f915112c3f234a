//! JSON Schema, as far as the schemas of `reports/schemas` use it: a keyword that is not known here is a panic, never a pass.

use std::collections::BTreeSet;

use serde_json::{Map, Value};

/// A schema with what it was held against.
pub struct Schema {
    root: Value,
    /// Properties that some value had, by the place of their schema.
    met: BTreeSet<String>,
}

/// Keywords that say nothing about a value.
const WORDS: [&str; 4] = ["$schema", "$defs", "title", "description"];

impl Schema {
    /// From its text.
    ///
    /// # Panics
    /// If it is no JSON.
    pub fn read(text: &str) -> Self {
        Schema { root: serde_json::from_str(text).expect("a schema is JSON"), met: BTreeSet::new() }
    }

    /// What is wrong with a value, each with its place.
    pub fn faults(&mut self, value: &Value) -> Vec<String> {
        let root = self.root.clone();
        let mut faults = Vec::new();
        self.walk(&root, "#", value, "", &mut faults);
        faults
    }

    /// Properties of the schema that no value had yet, and properties without a description.
    pub fn unmet(&self) -> (Vec<String>, Vec<String>) {
        let (mut unmet, mut silent) = (Vec::new(), Vec::new());
        let mut properties = Vec::new();
        collect(&self.root, "#", &mut properties);
        for (place, schema) in properties {
            if !self.met.contains(&place) {
                unmet.push(place.clone());
            }
            if schema.get("description").is_none() && schema.get("$ref").is_none() {
                silent.push(place);
            }
        }
        (unmet, silent)
    }

    fn walk(&mut self, schema: &Value, place: &str, value: &Value, at: &str, faults: &mut Vec<String>) {
        let schema = schema.as_object().unwrap_or_else(|| panic!("{place} is no schema"));
        for (keyword, rule) in schema {
            let is_wrong = match keyword.as_str() {
                "$ref" => {
                    let target = rule.as_str().expect("a text");
                    let pointer = target.strip_prefix('#').expect("a place in the same file");
                    let other = self.root.pointer(pointer).unwrap_or_else(|| panic!("{target} is not there")).clone();
                    self.walk(&other, target, value, at, faults);
                    false
                }
                "type" => !list(rule).iter().any(|name| is_of(value, name)),
                "enum" => !rule.as_array().expect("a list").contains(value),
                "const" => rule != value,
                "minimum" => value.as_f64().is_some_and(|x| x < rule.as_f64().expect("a number")),
                "required" => value.as_object().is_some_and(|o| list(rule).iter().any(|key| !o.contains_key(key))),
                "items" => {
                    for (i, item) in value.as_array().into_iter().flatten().enumerate() {
                        self.walk(rule, &format!("{place}/items"), item, &format!("{at}/{i}"), faults);
                    }
                    false
                }
                "properties" => {
                    self.properties(rule, place, value, at, faults);
                    false
                }
                "additionalProperties" => self.others(schema, rule, place, value, at, faults),
                word if WORDS.contains(&word) => false,
                other => panic!("{place}: the keyword '{other}' is not known here"),
            };
            if is_wrong {
                let short: String = value.to_string().chars().take(60).collect();
                faults.push(format!("{at}: {keyword} {rule}: {short}"));
            }
        }
    }

    fn properties(&mut self, rule: &Value, place: &str, value: &Value, at: &str, faults: &mut Vec<String>) {
        for (key, schema) in rule.as_object().expect("schemas by name") {
            if let Some(own) = value.get(key) {
                let place = format!("{place}/properties/{key}");
                self.met.insert(place.clone());
                self.walk(schema, &place, own, &format!("{at}/{key}"), faults);
            }
        }
    }

    /// Whether a key is there that must not be.
    fn others(
        &mut self,
        schema: &Map<String, Value>,
        rule: &Value,
        place: &str,
        value: &Value,
        at: &str,
        faults: &mut Vec<String>,
    ) -> bool {
        let known = schema.get("properties").and_then(Value::as_object);
        let other = |key: &&String| known.is_none_or(|known| !known.contains_key(*key));
        let others: Vec<String> = value.as_object().into_iter().flat_map(Map::keys).filter(other).cloned().collect();
        if rule == &Value::Bool(false) {
            return !others.is_empty();
        }
        for key in others {
            self.walk(rule, &format!("{place}/additionalProperties"), &value[&key], &format!("{at}/{key}"), faults);
        }
        false
    }
}

/// Every property of a schema, with its place.
fn collect(schema: &Value, place: &str, found: &mut Vec<(String, Value)>) {
    for (keyword, rule) in schema.as_object().into_iter().flatten() {
        match keyword.as_str() {
            "properties" | "$defs" => {
                for (key, own) in rule.as_object().into_iter().flatten() {
                    let place = format!("{place}/{keyword}/{key}");
                    if keyword == "properties" {
                        found.push((place.clone(), own.clone()));
                    }
                    collect(own, &place, found);
                }
            }
            "items" | "additionalProperties" => collect(rule, &format!("{place}/{keyword}"), found),
            _ => {}
        }
    }
}

fn list(rule: &Value) -> Vec<String> {
    let texts = |values: &[Value]| values.iter().filter_map(Value::as_str).map(str::to_owned).collect();
    rule.as_array().map_or_else(|| texts(std::slice::from_ref(rule)), |values| texts(values))
}

fn is_of(value: &Value, name: &str) -> bool {
    match name {
        "null" => value.is_null(),
        "boolean" => value.is_boolean(),
        "integer" => value.is_u64() || value.is_i64(),
        "number" => value.is_number(),
        "string" => value.is_string(),
        "array" => value.is_array(),
        "object" => value.is_object(),
        other => panic!("no type of JSON: {other}"),
    }
}
