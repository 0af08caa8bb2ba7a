//! Any text as a style file: a style or a sentence, never a panic.
#![no_main]

use genga::style::Style;
use libfuzzer_sys::fuzz_target;

fuzz_target!(|text: &str| {
    if let Err(error) = Style::from_toml_str(text) {
        assert!(!error.to_string().is_empty());
    }
});
