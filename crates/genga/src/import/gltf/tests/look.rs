//! Materials, textures and pictures.

use std::io::{self, Cursor};

use base64::Engine;
use glam::{Vec2, Vec3, Vec4};
use image::{ImageFormat, RgbaImage};

use super::*;
use crate::scene::{AlphaMode, Filter, MipFilter, Sampler, Wrap};

fn picture(format: ImageFormat) -> Vec<u8> {
    let picture = RgbaImage::from_fn(2, 1, |x, _| image::Rgba([x as u8 * 255, 10, 20, 255]));
    let mut bytes = Cursor::new(Vec::new());
    if format == ImageFormat::Jpeg {
        image::DynamicImage::from(picture).into_rgb8().write_to(&mut bytes, format).unwrap();
    } else {
        picture.write_to(&mut bytes, format).unwrap();
    }
    bytes.into_inner()
}

/// A triangle with texture coordinates whose material uses texture 0.
fn textured() -> Glb {
    let mut glb = Glb::triangle();
    let uvs = glb.floats("VEC2", &[0.0; 6]);
    let primitive = &mut glb.json["meshes"][0]["primitives"][0];
    primitive["attributes"]["TEXCOORD_0"] = json!(uvs);
    primitive["material"] = json!(0);
    glb.json["materials"] =
        json!([{ "pbrMetallicRoughness": { "baseColorTexture": { "index": 0 } } }]);
    glb
}

#[test]
fn material_properties() {
    let mut glb = Glb::triangle();
    glb.json["materials"] = json!([
        {
            "name": "skin",
            "pbrMetallicRoughness": { "baseColorFactor": [0.5, 2.0, 0.25, 0.75] },
            "emissiveFactor": [0.5, 1.0, 0.0],
            "alphaMode": "MASK", "doubleSided": true,
            "extensions": {
                "KHR_materials_unlit": {},
                "KHR_materials_emissive_strength": { "emissiveStrength": 4.0 },
            },
        },
        { "alphaMode": "BLEND" },
        { "extensions": { "KHR_materials_pbrSpecularGlossiness": {
            "diffuseFactor": [0.1, 0.2, 0.3, 1.0] } } },
        { "alphaMode": "MASK", "alphaCutoff": 0.25 },
    ]);
    let materials = glb.imported().scene.materials;
    let skin = &materials[0];
    assert_eq!(skin.name, "skin");
    assert_eq!(skin.base_color, Vec4::new(0.5, 1.0, 0.25, 0.75));
    assert_eq!(skin.emissive, Vec3::new(2.0, 4.0, 0.0));
    assert_eq!(skin.alpha, AlphaMode::Mask { cutoff: 0.5 });
    assert!(skin.double_sided && skin.unlit);
    assert_eq!(materials[1].alpha, AlphaMode::Blend);
    assert!(!materials[1].double_sided && !materials[1].unlit);
    assert_eq!(materials[2].base_color, Vec4::new(0.1, 0.2, 0.3, 1.0));
    assert_eq!(materials[3].alpha, AlphaMode::Mask { cutoff: 0.25 });
}

#[test]
fn pictures_in_a_view_a_data_uri_and_a_file() {
    for format in [ImageFormat::Png, ImageFormat::Jpeg, ImageFormat::WebP] {
        let bytes = picture(format);
        let mut glb = textured();
        let view = glb.view(&bytes);
        let data = base64::engine::general_purpose::STANDARD.encode(&bytes);
        glb.json["textures"] = json!([{ "source": 0 }, { "source": 1 }, { "source": 2 }]);
        glb.json["images"] = json!([
            { "bufferView": view, "mimeType": "image/png" },
            { "uri": format!("data:image/png;base64,{data}") },
            { "uri": "a%20picture.png" },
        ]);
        glb.json["materials"] = json!([0, 1, 2].map(|i| {
            json!({ "pbrMetallicRoughness": { "baseColorTexture": { "index": i } } })
        }));
        let files =
            |path: &str| if path == "a picture.png" { Ok(bytes.clone()) } else { no_files(path) };
        let imported = from_bytes("t.glb", &glb.bytes(), None, &files).unwrap();
        assert_eq!(imported.warnings, [""; 0]);
        assert_eq!(imported.scene.images.len(), 3);
        for image in &imported.scene.images {
            assert_eq!((image.width, image.height), (2, 1));
            assert_eq!(image.rgba, imported.scene.images[0].rgba);
            assert!(image.rgba[4] > 200 && image.rgba[0] < 60, "{format:?} {:?}", image.rgba);
        }
    }
}

#[test]
fn the_webp_extension_gives_the_source() {
    let mut glb = textured();
    let view = glb.view(&picture(ImageFormat::WebP));
    glb.json["extensionsRequired"] = json!(["EXT_texture_webp"]);
    glb.json["textures"] = json!([{ "extensions": { "EXT_texture_webp": { "source": 0 } } }]);
    glb.json["images"] = json!([{ "bufferView": view, "mimeType": "image/webp" }]);
    assert_eq!(glb.imported().scene.images.len(), 1);
}

#[test]
fn equal_sources_are_decoded_once_and_unused_textures_not_at_all() {
    let mut glb = textured();
    let view = glb.view(&picture(ImageFormat::Png));
    glb.json["textures"] = json!([{ "source": 0 }, { "source": 1 }, { "source": 2 }]);
    glb.json["images"] =
        json!([{ "bufferView": view }, { "bufferView": view }, { "uri": "normals.png" }]);
    glb.json["materials"] = json!([{
        "pbrMetallicRoughness": { "baseColorTexture": { "index": 1 } },
        "emissiveTexture": { "index": 0 },
        "normalTexture": { "index": 2 },
    }]);
    let scene = glb.imported().scene;
    assert_eq!((scene.textures.len(), scene.images.len()), (2, 1));
    assert_eq!(scene.materials[0].base_color_texture.unwrap().texture, 0);
    assert_eq!(scene.materials[0].emissive_texture.unwrap().texture, 1);
}

#[test]
fn samplers() {
    let mut glb = textured();
    let view = glb.view(&picture(ImageFormat::Png));
    glb.json["images"] = json!([{ "bufferView": view }]);
    glb.json["textures"] = json!([{ "source": 0, "sampler": 0, "name": "atlas" }]);
    glb.json["samplers"] =
        json!([{ "magFilter": 9728, "minFilter": 9985, "wrapS": 33_071, "wrapT": 33_648 }]);
    let texture = &glb.imported().scene.textures[0];
    assert_eq!(texture.name, "atlas");
    let expected = Sampler {
        mag: Filter::Nearest,
        min: Filter::Linear,
        mip: MipFilter::Nearest,
        wrap_u: Wrap::Clamp,
        wrap_v: Wrap::Mirror,
    };
    assert_eq!(texture.sampler, expected);
}

#[test]
fn texture_transforms_may_choose_another_set() {
    let mut glb = textured();
    let view = glb.view(&picture(ImageFormat::Png));
    glb.json["images"] = json!([{ "bufferView": view }]);
    glb.json["textures"] = json!([{ "source": 0 }]);
    let attributes = &mut glb.json["meshes"][0]["primitives"][0]["attributes"];
    attributes["TEXCOORD_1"] = attributes["TEXCOORD_0"].clone();
    let info = &mut glb.json["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"];
    info["extensions"] = json!({ "KHR_texture_transform": {
        "offset": [0.5, 0.25], "rotation": 1.5, "scale": [2.0, 3.0], "texCoord": 1 } });
    let texture = glb.imported().scene.materials[0].base_color_texture.unwrap();
    assert_eq!(texture.uv_set, 1);
    assert_eq!(texture.transform.offset, Vec2::new(0.5, 0.25));
    assert_eq!(texture.transform.rotation, 1.5);
    assert_eq!(texture.transform.scale, Vec2::new(2.0, 3.0));
}

#[test]
fn missing_and_broken_textures_are_drawn_white_with_a_warning() {
    let mut glb = textured();
    assert!(glb.warning().contains("texture 0, which does not exist"));
    glb.json["textures"] = json!([{}]);
    assert!(glb.warning().contains("drawn white"));
    glb.json["textures"] = json!([{ "source": 3 }]);
    assert!(glb.warning().contains("image 3, which does not exist"));
    glb.json["textures"] = json!([{ "source": 0 }]);
    for (image, why) in [
        (json!({ "uri": "gone.png" }), "'gone.png'"),
        (json!({ "uri": "/etc/passwd" }), "absolute"),
        (json!({ "uri": "https://example.org/a.png" }), "URL"),
        (json!({ "uri": "data:image/png;base64,AAAA" }), "format is unknown"),
        (json!({ "bufferView": 99 }), "buffer view 99"),
        (json!({}), "no data"),
    ] {
        glb.json["images"] = json!([image]);
        let warning = glb.warning();
        assert!(warning.contains(why) && warning.contains("white"), "{warning}");
        let scene = glb.read().unwrap().scene;
        assert_eq!(scene.textures[0].image, None);
        assert!(scene.images.is_empty());
    }
    let mut cut = picture(ImageFormat::Png);
    cut.truncate(50);
    let view = glb.view(&cut);
    glb.json["images"] = json!([{ "bufferView": view }]);
    assert!(glb.warning().contains("white"));
}

#[test]
fn a_texture_without_coordinates_is_mentioned() {
    let mut glb = textured();
    let view = glb.view(&picture(ImageFormat::Png));
    glb.json["images"] = json!([{ "bufferView": view }]);
    glb.json["textures"] = json!([{ "source": 0 }]);
    let attributes = &mut glb.json["meshes"][0]["primitives"][0]["attributes"];
    attributes.as_object_mut().unwrap().remove("TEXCOORD_0");
    assert!(glb.warning().contains("no texture coordinates 0"));
}

#[test]
fn external_and_embedded_buffers() {
    let glb = Glb::triangle();
    let data = base64::engine::general_purpose::STANDARD.encode(&glb.binary);
    let files = |path: &str| -> io::Result<Vec<u8>> {
        if path == "../shared/a.bin" { Ok(glb.binary.clone()) } else { no_files(path) }
    };
    for uri in ["../shared/a.bin".to_owned(), format!("data:application/gltf-buffer;base64,{data}")]
    {
        let mut json = glb.json.clone();
        json["buffers"] = json!([{ "byteLength": glb.binary.len(), "uri": uri }]);
        let mut text = b"\xef\xbb\xbf \n".to_vec();
        text.extend(serde_json::to_vec_pretty(&json).unwrap());
        let imported = from_bytes("a.gltf", &text, None, &files).unwrap();
        assert_eq!(imported.scene.triangle_count(), 1);
    }
}
