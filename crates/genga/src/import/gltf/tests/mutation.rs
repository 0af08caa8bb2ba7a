//! Thousands of damaged versions of one file: errors are fine, panics are not.

use std::io::Cursor;

use super::*;
use crate::scene::Pose;

/// A small generator of pseudo-random numbers (Marsaglia's xorshift64), the same in every run.
struct Random(u64);

impl Random {
    fn next(&mut self) -> u64 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        self.0
    }

    fn below(&mut self, limit: usize) -> usize {
        (self.next() % limit.max(1) as u64) as usize
    }
}

/// A file with a bit of everything: skin, morph target, sparse accessor, texture, clip.
fn rich() -> Glb {
    let mut glb = super::scene::skinned();
    let at = glb.view(&[1]);
    let values = glb.view(&[0; 12]);
    let offsets = glb.push(
        "accessors",
        json!({
            "componentType": F32, "type": "VEC3", "count": 3,
            "sparse": {
                "count": 1,
                "indices": { "bufferView": at, "componentType": U8 },
                "values": { "bufferView": values },
            },
        }),
    );
    let indices = glb.shorts("SCALAR", 1, &[0, 1, 2, 2, 1, 0]);
    let uvs = glb.shorts("VEC2", 2, &[0, 0, 9, 9, 0, 9]);
    let times = glb.floats("SCALAR", &[0.0, 1.0]);
    let turns = glb.floats("VEC4", &[0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 1.0, 0.0]);
    let mut png = Cursor::new(Vec::new());
    image::RgbaImage::new(2, 2).write_to(&mut png, image::ImageFormat::Png).unwrap();
    let picture = glb.view(&png.into_inner());
    let primitive = &mut glb.json["meshes"][0]["primitives"][0];
    primitive["targets"] = json!([{ "POSITION": offsets }]);
    primitive["indices"] = json!(indices);
    primitive["attributes"]["TEXCOORD_0"] = json!(uvs);
    primitive["material"] = json!(0);
    glb.json["materials"] =
        json!([{ "pbrMetallicRoughness": { "baseColorTexture": { "index": 0 } } }]);
    glb.json["textures"] = json!([{ "source": 0 }]);
    glb.json["images"] = json!([{ "bufferView": picture }]);
    glb.json["animations"] = json!([{
        "channels": [{ "sampler": 0, "target": { "node": 1, "path": "rotation" } }],
        "samplers": [{ "input": times, "output": turns }],
    }]);
    glb
}

/// Reads the file and, if that works, poses it.
fn exercise(bytes: &[u8]) -> bool {
    let Ok(imported) = read(bytes) else { return false };
    let scene = imported.scene;
    for time in [0.0, 0.5, f32::NAN] {
        let _ = scene.bounds(&Pose::at(&scene, 0, time));
    }
    true
}

#[test]
fn the_rich_file_itself_is_read() {
    let scene = rich().imported().scene;
    assert_eq!((scene.skins.len(), scene.clips.len(), scene.images.len()), (1, 1, 1));
    assert_eq!(scene.meshes[0].morph_weights.len(), 1);
}

#[test]
fn flipped_bits_do_not_panic() {
    let original = rich().bytes();
    let mut random = Random(0x9e37_79b9_7f4a_7c15);
    let mut readable = 0;
    for _ in 0..4000 {
        let mut bytes = original.clone();
        for _ in 0..=random.below(4) {
            let at = random.below(bytes.len());
            bytes[at] ^= 1 << random.below(8);
        }
        readable += usize::from(exercise(&bytes));
    }
    // The mutations must reach beyond the parser to be worth anything.
    assert!((400..4000).contains(&readable), "{readable} of 4000 were readable");
}

#[test]
fn changed_numbers_do_not_panic() {
    let glb = rich();
    let json = serde_json::to_string(&glb.json).unwrap();
    let text = json.replacen(
        "\"buffers\":[]",
        &format!("\"buffers\":[{{\"byteLength\":{}}}]", glb.binary.len()),
        1,
    );
    let digits: Vec<usize> = text
        .bytes()
        .enumerate()
        .filter(|(_, byte)| byte.is_ascii_digit())
        .map(|(i, _)| i)
        .collect();
    let mut random = Random(0x2545_f491_4f6c_dd1d);
    let mut readable = 0;
    for _ in 0..4000 {
        let mut text = text.clone();
        let at = digits[random.below(digits.len())];
        let numbers =
            ["0", "1", "2", "255", "5121", "5125", "65536", "4294967295", "18446744073709551615"];
        text.replace_range(at..=at, numbers[random.below(numbers.len())]);
        readable += usize::from(exercise(&super::glb(text.as_bytes(), &glb.binary)));
    }
    assert!((400..4000).contains(&readable), "{readable} of 4000 were readable");
}

#[test]
fn cut_files_do_not_panic() {
    let original = rich().bytes();
    let json_end = 20 + u32::from_le_bytes(*original[12..].first_chunk().unwrap()) as usize;
    for length in 0..original.len() {
        exercise(&original[..length]);
    }
    // A short binary chunk in an intact container.
    let json = &original[20..json_end];
    let binary = rich().binary;
    for length in 0..binary.len() {
        exercise(&super::glb(json, &binary[..length]));
    }
}
