//! Any text as a scene file: a scene or a sentence, never a panic.
#![no_main]

use genga::scene_file::SceneFile;
use libfuzzer_sys::fuzz_target;

fuzz_target!(|text: &str| {
    if let Err(error) = SceneFile::from_toml_str(text) {
        assert!(!error.to_string().is_empty());
    }
});
