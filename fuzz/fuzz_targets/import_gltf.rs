//! Any bytes as a glTF file: an error or a scene that holds together, never a panic.
#![no_main]

use genga::import::{Format, from_bytes};
use genga::scene::Pose;
use libfuzzer_sys::fuzz_target;

fuzz_target!(|bytes: &[u8]| {
    // Every file that the model refers to is the model itself.
    let files = |_: &str| Ok(bytes.to_vec());
    if let Ok(imported) = from_bytes("fuzz.glb", bytes, Some(Format::Gltf), &files) {
        let scene = imported.scene;
        assert!(scene.validate().is_ok());
        // Many nodes may show one large mesh, which is right but slow.
        if scene.vertex_count() < 100_000 {
            let _ = scene.bounds(&Pose::at(&scene, 0, 0.5));
        }
    }
});
