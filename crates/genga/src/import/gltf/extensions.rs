//! Which glTF extensions are understood.

use super::super::Problem;
use super::super::warnings::{Warnings, quoted};
use super::document::Document;

/// Extensions whose content is read.
const READ: &[&str] = &[
    "EXT_texture_webp",
    "KHR_lights_punctual",
    "KHR_materials_emissive_strength",
    "KHR_materials_pbrSpecularGlossiness",
    "KHR_materials_unlit",
    "KHR_mesh_quantization",
    "KHR_texture_transform",
];

/// Extensions that change only how physically based light is reflected, which styles replace,
/// or that hold no part of the picture.
const WITHOUT_EFFECT: &[&str] = &[
    "KHR_materials_anisotropy",
    "KHR_materials_clearcoat",
    "KHR_materials_diffuse_transmission",
    "KHR_materials_dispersion",
    "KHR_materials_ior",
    "KHR_materials_iridescence",
    "KHR_materials_sheen",
    "KHR_materials_specular",
    "KHR_materials_transmission",
    "KHR_materials_variants",
    "KHR_materials_volume",
    "KHR_xmp",
    "KHR_xmp_json_ld",
];

/// Refuses files that require what is not known; warns of what is only used.
pub(super) fn check(document: &Document, warnings: &mut Warnings) -> Result<(), Problem> {
    let is_known = |name: &str| READ.contains(&name) || WITHOUT_EFFECT.contains(&name);
    if let Some(name) = document.extensions_required.iter().find(|name| !is_known(name)) {
        let advice = match name.as_str() {
            "KHR_draco_mesh_compression"
            | "EXT_meshopt_compression"
            | "KHR_meshopt_compression" => "export the model again without mesh compression",
            "KHR_texture_basisu" => "export the model again with PNG, JPEG or WebP textures",
            _ => "export the model again without it",
        };
        let extension = name.chars().take(60).flat_map(char::escape_debug).collect();
        return Err(Problem::Extension { extension, advice });
    }
    for name in document.extensions_used.iter().filter(|name| !is_known(name)) {
        warnings.add(format!("The glTF extension {} is not known and ignored.", quoted(name)));
    }
    Ok(())
}
