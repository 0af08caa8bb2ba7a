//! What the tests of both kinds of files share.

use crate::FileError;

/// Makes small random changes to a valid text, `rounds` times. Whatever comes of one, `read`
/// must accept it or show a place in the text. Returns how many were accepted.
pub(crate) fn mutate(
    valid: &str,
    rounds: usize,
    mut read: impl FnMut(&str) -> Result<(), FileError>,
) -> usize {
    const PIECES: [&str; 24] = [
        "[",
        "]",
        "{",
        "}",
        "=",
        ".",
        "\"",
        "'",
        "\n",
        "#",
        ",",
        "-",
        "1e99",
        "nan",
        "inf",
        "é",
        "\0",
        "[[",
        "\"\"\"",
        "\\",
        "99999999999999999999",
        "[lines]",
        "model = 1",
        "2024-01-01",
    ];
    let mut seed = 0x2545_f491_4f6c_dd17_u64;
    let mut random = move |below: usize| {
        seed ^= seed << 13;
        seed ^= seed >> 7;
        seed ^= seed << 17;
        usize::try_from(seed >> 33).unwrap_or(0) % below.max(1)
    };
    let mut accepted = 0;
    for round in 0..rounds {
        let mut text: Vec<char> = valid.chars().collect();
        for _ in 0..=round % 4 {
            let at = random(text.len());
            match random(3) {
                0 => drop(text.drain(at..(at + 1 + random(20)).min(text.len()))),
                1 => drop(text.splice(at..at, PIECES[random(PIECES.len())].chars())),
                _ => {
                    let from = random(text.len());
                    let copy: Vec<char> =
                        text.iter().skip(from).take(random(40)).copied().collect();
                    drop(text.splice(at..at, copy));
                }
            }
        }
        let text: String = text.into_iter().collect();
        match read(&text) {
            Ok(()) => accepted += 1,
            Err(error) => {
                assert!(text.get(error.span.clone()).is_some(), "{error}");
                assert!((1..=text.lines().count() + 1).contains(&error.line), "{error}");
                // Serde's own words would mean that the schema is looser than the types.
                for words in ["invalid type", "invalid length", "did not match any variant"] {
                    assert!(!error.message.contains(words), "{error}\n{text}");
                }
                assert!(!error.to_string().contains('\n') && error.message.len() < 400, "{error}");
            }
        }
    }
    accepted
}
