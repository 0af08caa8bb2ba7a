use std::io;

use glam::{Vec2, Vec3, Vec4};

use crate::import::{Imported, from_bytes, no_files};
use crate::scene::{AlphaMode, Primitive, Wrap};

const SQUARE: &str = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";

fn read_with(text: &str, files: &dyn Fn(&str) -> io::Result<Vec<u8>>) -> Imported {
    from_bytes("folder/test.obj", text.as_bytes(), None, files).unwrap()
}

fn read(text: &str) -> Imported {
    let imported = read_with(text, &no_files);
    assert_eq!(imported.warnings, [""; 0]);
    imported
}

fn primitive(text: &str) -> Primitive {
    read(text).scene.meshes.remove(0).primitives.remove(0)
}

fn error(text: &str) -> String {
    from_bytes("test.obj", text.as_bytes(), None, &no_files).unwrap_err().to_string()
}

#[test]
fn a_square_without_anything_else() {
    let imported = read(&format!("# a comment\n{SQUARE}f 1 2 3 4 # another\r\n"));
    assert_eq!(imported.scene.name, "test");
    assert_eq!(imported.scene.nodes[0].name, "node-0");
    let primitive = &imported.scene.meshes[0].primitives[0];
    assert_eq!(primitive.positions, [Vec3::ZERO, Vec3::X, Vec3::new(1.0, 1.0, 0.0), Vec3::Y]);
    assert_eq!(primitive.indices, [0, 1, 2, 0, 2, 3]);
    assert_eq!(primitive.normals, [Vec3::Z; 4]);
    assert!(primitive.uvs.is_empty() && primitive.colors.is_empty());
}

#[test]
fn corners_of_every_form() {
    let text = format!(
        "{SQUARE}vt 0.25 0.75\nvt 1 0\nvn 0 0 -1\nf 1/1/1 2/2/1 3/-1/-1\nf -4//1 \\\n 3 4/2\n"
    );
    let primitive = primitive(&text);
    assert_eq!(primitive.indices, [0, 1, 2, 3, 4, 5]);
    // The picture's origin is at the top.
    assert_eq!(primitive.uvs[0][..2], [Vec2::new(0.25, 0.25), Vec2::new(1.0, 1.0)]);
    assert_eq!(primitive.uvs[0][3], Vec2::ZERO);
    assert_eq!(primitive.normals[..4], [Vec3::NEG_Z; 4]);
    // Corners without a normal get a smooth one.
    assert_eq!(primitive.normals[4..], [Vec3::Z; 2]);
}

#[test]
fn equal_corners_share_a_vertex() {
    let text = format!("{SQUARE}vt 0 0\nvt 1 1\nf 1/1 2/1 3/1\nf 1/1 3/1 4/1\nf 1/2 3/1 4/1\n");
    assert_eq!(primitive(&text).positions.len(), 5);
}

#[test]
fn a_node_for_each_object_and_a_primitive_for_each_material() {
    let text = format!(
        "mtllib a.mtl\n{SQUARE}o Body\nusemtl skin\nf 1 2 3\nusemtl cloth\nf 1 3 4\nusemtl skin\n\
         f 1 2 4\ng Head\nf 1 2 3\ng Body\nf 2 3 4\no Empty\n"
    );
    let library = |_: &str| Ok(b"newmtl skin\nnewmtl cloth\n".to_vec());
    let imported = read_with(&text, &library);
    assert_eq!(imported.warnings, [""; 0]);
    let scene = imported.scene;
    let names: Vec<_> = scene.nodes.iter().map(|node| node.name.as_str()).collect();
    assert_eq!(names, ["Body", "Head"]);
    assert_eq!(scene.roots, [0, 1]);
    let body = &scene.meshes[0].primitives;
    assert_eq!(body.iter().map(|p| p.indices.len() / 3).collect::<Vec<_>>(), [3, 1]);
    assert_eq!(scene.materials[body[0].material.unwrap()].name, "skin");
    assert_eq!(scene.materials[body[1].material.unwrap()].name, "cloth");
}

#[test]
fn normals_are_smooth_across_materials() {
    let text = "v 0 0 0\nv 0 0 1\nv -1 -1 0\nv 1 -1 0\nusemtl a\nf 1 3 2\nusemtl b\nf 1 2 4\n";
    let scene = read_with(text, &no_files).scene;
    let [a, b] = scene.meshes[0].primitives.as_slice() else { panic!() };
    assert!((a.normals[0] - b.normals[0]).length() < 1e-6);
}

#[test]
fn vertex_colors_are_displayed_colors() {
    let colors = primitive("v 0 0 0 1 0.5 0\nv 1 0 0\nv 0 1 0 0 0 0\nf 1 2 3\n").colors;
    assert!((colors[0] - Vec4::new(1.0, 0.214_041, 0.0, 1.0)).length() < 1e-5);
    assert_eq!(colors[1..], [Vec4::ONE, Vec4::W]);
}

#[test]
fn materials() {
    let mtl = "newmtl skin\nKd 1 0.5 0\nKe 0.5\nd 0.25\nnewmtl metal\nTr 0.5\nKs 1 1 1\n\
               newmtl cloth\nKd 0 0 0\nmap_Kd -s 2 4 -o 0.5 0 0 -clamp on -bm 1 my tex.png\n";
    let png = |path: &str| {
        let mut png = io::Cursor::new(Vec::new());
        image::RgbaImage::new(3, 1).write_to(&mut png, image::ImageFormat::Png).unwrap();
        match path {
            "a b.mtl" => Ok(mtl.as_bytes().to_vec()),
            "my tex.png" => Ok(png.into_inner()),
            _ => no_files(path),
        }
    };
    let text = format!("mtllib a b.mtl\n{SQUARE}vt 0 0\nusemtl cloth\nf 1/1 2/1 3/1\n");
    let imported = read_with(&text, &png);
    assert_eq!(imported.warnings, [""; 0]);
    let [skin, metal, cloth] = imported.scene.materials.as_slice() else { panic!() };
    assert!((skin.base_color - Vec4::new(1.0, 0.214_041, 0.0, 0.25)).length() < 1e-5);
    assert!((skin.emissive - Vec3::splat(0.214_041)).length() < 1e-5);
    assert_eq!(skin.alpha, AlphaMode::Blend);
    assert_eq!(metal.base_color.w, 0.5);
    assert_eq!((cloth.base_color, cloth.alpha), (Vec4::ONE, AlphaMode::Opaque));
    let texture = cloth.base_color_texture.unwrap();
    // At the top of the picture, OBJ's v is 1: 4 · 1 + 0 from the bottom.
    assert_eq!(texture.transform.offset, Vec2::new(0.5, -3.0));
    assert_eq!(texture.transform.scale, Vec2::new(2.0, 4.0));
    assert_eq!(imported.scene.textures[0].sampler.wrap_u, Wrap::Clamp);
    assert_eq!(imported.scene.images[0].width, 3);
}

#[test]
fn missing_libraries_and_pictures_are_warnings() {
    let text = format!("mtllib gone.mtl\n{SQUARE}usemtl skin\nf 1 2 3\n");
    let imported = read_with(&text, &no_files);
    assert_eq!(imported.warnings.len(), 1);
    assert!(imported.warnings[0].contains("'gone.mtl'"), "{}", imported.warnings[0]);
    assert_eq!(imported.scene.materials[0].base_color, Vec4::ONE);

    let files = |path: &str| match path {
        "a.mtl" => Ok(b"newmtl skin\nKd 1 x 0\nmap_Kd gone.png\nmap_Ke\n".to_vec()),
        _ => no_files(path),
    };
    let text = format!("mtllib a.mtl\n{SQUARE}vt 0 0\nusemtl skin\nf 1/1 2/1 3/1\nusemtl tin\n");
    let imported = read_with(&text, &files);
    let warnings = imported.warnings.join("\n");
    assert!(warnings.contains("line 2 is left out: 'x' is not a number"), "{warnings}");
    assert!(warnings.contains("line 4 is left out"), "{warnings}");
    assert!(warnings.contains("'gone.png' is drawn white"), "{warnings}");
    assert!(warnings.contains("'tin' is in no library"), "{warnings}");
}

#[test]
fn broken_lines_are_named() {
    assert!(error("v 0 0\n").contains("line 1: there are 2 numbers where 3 are needed"));
    assert!(error("v 0 0 nan\n").contains("'nan' is not finite"));
    assert!(error("v 0 1e30 0\n").contains("far too large"));
    assert!(error("v 0 zero 0\n").contains("'zero' is not a number"));
    let index = |corner: &str| error(&format!("{SQUARE}vt 0 0\nf 1 2 {corner}\n"));
    for corner in ["5", "0", "-5", "3/2", "3//1", "9223372036854775807", "-9223372036854775808"] {
        let message = index(corner);
        assert!(message.contains("line 6: index") && message.contains("out of range"), "{message}");
    }
    assert!(index("x").contains("'x' is not a whole number"));
    assert!(index("99999999999999999999").contains("not a whole number"));
    assert!(index("/1").contains("has no position"));
}

#[test]
fn what_cannot_be_drawn_is_skipped() {
    let text = format!("{SQUARE}l 1 2\np 1\nf 1 2\ncurv 1\nf 1 2 3\n");
    let imported = read_with(&text, &no_files);
    assert_eq!(imported.scene.triangle_count(), 1);
    assert_eq!(imported.warnings.len(), 3);
    let imported = read_with("v 0 0 0\n", &no_files);
    assert!(imported.warnings[0].contains("nothing to draw"));
}

#[test]
fn content_is_recognised_without_an_ending() {
    let text = format!("# made by hand\n{SQUARE}f 1 2 3\n");
    let imported = from_bytes("model", text.as_bytes(), None, &no_files).unwrap();
    assert_eq!(imported.scene.triangle_count(), 1);
}
