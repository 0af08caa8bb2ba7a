use serde::Serialize;

/// Milliseconds of many runs.
#[derive(Clone, Debug, Default)]
pub(super) struct Samples(Vec<f64>);

/// What is reported of them.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub(super) struct Summary {
    pub(super) min_ms: f64,
    pub(super) median_ms: f64,
    pub(super) max_ms: f64,
}

impl Samples {
    pub(super) fn push(&mut self, milliseconds: f64) {
        self.0.push(milliseconds);
    }

    /// Least, middle and greatest; zeros without any run.
    pub(super) fn summary(&self) -> Summary {
        let mut sorted = self.0.clone();
        sorted.sort_by(f64::total_cmp);
        let at = |index: usize| sorted.get(index).copied().unwrap_or(0.0);
        let half = sorted.len() / 2;
        let median_ms = if sorted.len() % 2 == 1 {
            at(half)
        } else {
            0.5 * (at(half.saturating_sub(1)) + at(half))
        };
        Summary { min_ms: at(0), median_ms, max_ms: at(sorted.len().saturating_sub(1)) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_median_stands_in_the_middle() {
        let summary = |values: &[f64]| Samples(values.to_vec()).summary();
        let expected = |min_ms, median_ms, max_ms| Summary { min_ms, median_ms, max_ms };
        assert_eq!(summary(&[3.0, 1.0, 2.0]), expected(1.0, 2.0, 3.0));
        assert_eq!(summary(&[4.0, 1.0, 2.0, 8.0]), expected(1.0, 3.0, 8.0));
        assert_eq!(summary(&[5.0]), expected(5.0, 5.0, 5.0));
        assert_eq!(summary(&[]), expected(0.0, 0.0, 0.0));
    }
}
