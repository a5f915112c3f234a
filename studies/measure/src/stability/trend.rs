//! Whether something grows exponentially, told apart from a bounded transient and from growth as a power of time.

/// First and last step of the shortest windows looked at, as powers of two.
const FIRST_WINDOW: u32 = 4;
/// Looks in one window. Their distance is odd, so that an error that alternates from step to step is seen in both phases.
const SAMPLES: u64 = 64;
/// A window whose largest size exceeds that of the one before by less than this does not grow: the largest of 64 looks at an
/// oscillating size repeats to a few per cent.
const STEADY: f64 = 1.1;
/// A window that falls below the one before by this factor decays.
const FALLING: f64 = 0.9;
/// Steps of a run in which growth by 1e-6 a step shows.
pub const PATIENCE: u64 = 1 << 14;
/// A factor from window to window that no linear drift has.
const MORE_THAN_LINEAR: f64 = 2.5;
/// Growth by this factor within one window is exponential already: a power t^p would need p > 23.
const HUGE: f64 = 1e7;
/// A size that has fallen to this part of its start is decaying, whatever it does in between.
const GONE: f64 = 1e-9;

/// What a size does in the long run.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Trend {
    /// It stays below a bound, or decays.
    Bounded,
    /// It grows as a power of time.
    Power,
    /// It grows exponentially or faster.
    Exponential,
}

/// The steps to look at in a run of 2^`log2_steps` steps: windows of doubling length.
pub fn samples(log2_steps: u32) -> Vec<u64> {
    let mut steps = vec![0];
    for window in FIRST_WINDOW..log2_steps {
        let (start, length) = (1_u64 << window, 1_u64 << window);
        let stride = (length / SAMPLES).max(1) | 1;
        steps.extend((0..SAMPLES).map(|i| start + i * stride).take_while(|step| *step < start + length));
    }
    steps.push(1 << log2_steps);
    steps.dedup();
    steps
}

/// The trend of a size seen at the steps of [`samples`]; `None` where a longer run has to decide.
///
/// In windows of doubling length the largest size of exponential growth rises by a factor that squares itself from window to
/// window, that of a power stays the same, that of a bounded size tends to one.
pub fn trend(sizes: &[(u64, f64)]) -> Option<Trend> {
    trend_after(sizes, PATIENCE)
}

/// The same, where growth needs `patience` steps to show.
pub fn trend_after(sizes: &[(u64, f64)], patience: u64) -> Option<Trend> {
    let length = sizes.last().map_or(0, |(step, _)| *step);
    let start = sizes.first().map_or(0.0, |(_, size)| *size);
    // What has gone stays gone; further on the numbers would underflow.
    if sizes.iter().any(|(_, size)| *size <= GONE * start) {
        return Some(Trend::Bounded);
    }
    if sizes.iter().any(|(_, size)| !size.is_finite()) {
        return Some(Trend::Exponential);
    }
    let maxima = window_maxima(sizes);
    let [.., before, last_but_one, last] = maxima[..] else { return None };
    let (earlier, now) = (last_but_one / before, last / last_but_one);
    if now > HUGE {
        return Some(Trend::Exponential);
    }
    if now <= 1.0 + 0.2 * (STEADY - 1.0) {
        // Standing still proves something only where slow growth would have shown itself.
        return (now <= FALLING || length >= patience).then_some(Trend::Bounded);
    }
    if earlier > 1.0 && now.ln() < 1.2 * earlier.ln() {
        return (length >= patience).then_some(Trend::Power);
    }
    // A drift that comes up from below a constant has factors that rise to 2: only beyond is it more than that.
    (now > MORE_THAN_LINEAR).then_some(Trend::Exponential)
}

fn window_maxima(sizes: &[(u64, f64)]) -> Vec<f64> {
    let mut maxima = Vec::new();
    let mut window = 0;
    for &(step, size) in sizes.iter().filter(|(step, _)| *step >= 1 << FIRST_WINDOW) {
        let of_step = step.ilog2();
        if of_step > window && !(step.is_power_of_two() && step == sizes.last().map_or(0, |(s, _)| *s)) {
            window = of_step;
            maxima.push(0.0_f64);
        }
        if let Some(largest) = maxima.last_mut() {
            *largest = largest.max(size);
        }
    }
    maxima
}
