//! Any bytes as an OBJ file, up to a NUL, and what follows as its materials.
#![no_main]

use genga::import::{Format, from_bytes};
use libfuzzer_sys::fuzz_target;

fuzz_target!(|bytes: &[u8]| {
    let mut parts = bytes.splitn(2, |&byte| byte == 0);
    let model = parts.next().unwrap_or(&[]);
    let library = parts.next().unwrap_or(&[]);
    let files = |_: &str| Ok(library.to_vec());
    if let Ok(imported) = from_bytes("fuzz.obj", model, Some(Format::Obj), &files) {
        assert!(imported.scene.validate().is_ok());
    }
});
