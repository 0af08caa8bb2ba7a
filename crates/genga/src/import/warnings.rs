use std::collections::HashSet;

/// Most sentences that a file can cause.
const MAX: usize = 50;

/// Sentences for the user: each once, and not too many.
#[derive(Debug, Default)]
pub(super) struct Warnings {
    sentences: Vec<String>,
    seen: HashSet<String>,
    left_out: usize,
}

impl Warnings {
    /// Adds a sentence unless it is there already.
    pub(super) fn add(&mut self, sentence: String) {
        if self.seen.contains(&sentence) {
            return;
        }
        if self.sentences.len() >= MAX {
            self.left_out += 1;
            return;
        }
        self.seen.insert(sentence.clone());
        self.sentences.push(sentence);
    }

    /// The sentences in the order in which they came.
    pub(super) fn into_sentences(mut self) -> Vec<String> {
        if self.left_out > 0 {
            self.sentences.push(format!("There are {} more warnings of this kind.", self.left_out));
        }
        self.sentences
    }
}

/// A name from a file as messages show it: in quotes, short, without control characters.
pub(super) fn quoted(name: &str) -> String {
    const LONGEST: usize = 60;
    let mut shown: String = name.chars().take(LONGEST).flat_map(char::escape_debug).collect();
    if name.chars().nth(LONGEST).is_some() {
        shown.push('…');
    }
    format!("'{shown}'")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_sentence_once_and_bounded() {
        let mut warnings = Warnings::default();
        for i in 0..MAX + 7 {
            warnings.add(format!("warning {i}"));
            warnings.add(format!("warning {}", i.min(3)));
        }
        let sentences = warnings.into_sentences();
        assert_eq!(sentences.len(), MAX + 1);
        assert_eq!(sentences[MAX], "There are 7 more warnings of this kind.");
    }

    #[test]
    fn names_are_short_and_harmless() {
        assert_eq!(quoted("Arm"), "'Arm'");
        assert_eq!(quoted("a\u{1b}[31m\n"), "'a\\u{1b}[31m\\n'");
        assert_eq!(quoted(&"x".repeat(1000)).chars().count(), 63);
    }
}
