//! Names of scenes as readers and pages use them.

/// The name of a scene or preset in a sentence: `forced-oscillator/resonance` is 'Forced oscillator, resonance'.
pub fn scene_title(id: &str) -> String {
    let words = id.replace('/', ", ").replace('-', " ");
    let mut letters = words.chars();
    letters.next().map_or_else(String::new, |first| first.to_uppercase().chain(letters).collect())
}

/// The anchor of what has that name within a section.
pub fn anchor(section: &str, name: &str) -> String {
    format!("{section}-{}", name.replace('/', "-"))
}
