//! What the deformation must know of smears.

use super::DrawItem;
use crate::render::generated::Deform;
use crate::scene::{Pose, Primitive, Scene};
use crate::style::Style;

/// Streaks are at least so many edges of the mesh wide: between finer ones there are no vertices, and
/// rims would be torn into teeth.
const EDGES_PER_STREAK: f32 = 4.0;

/// Writes what a style smears into the deformations of what is drawn; `counts` are those of all
/// matrices and morph weights, which the past's follow.
pub(super) fn add<'a>(
    scene: &Scene,
    style: &Style,
    deforms: impl Iterator<Item = (&'a mut Deform, &'a DrawItem)>,
    [matrices, weights]: [u32; 2],
) {
    let motion = &style.motion;
    let Some(smear) = motion.smear.as_ref().filter(|_| motion.is_drawn()) else { return };
    let rest = Pose::rest(scene);
    for (deform, item) in deforms {
        let [node, number] = item.surface;
        let object = &scene.nodes[node];
        let Some(mesh) = object.mesh.and_then(|mesh| scene.meshes.get(mesh)) else { continue };
        let primitive = &mesh.primitives[number];
        let material = primitive.material.map_or("", |m| scene.materials[m].name.as_str());
        if !(smear.objects.matches(&object.name) && smear.materials.matches(material)) {
            continue;
        }
        let matrix = rest.world_from_node[node].matrix3;
        let metres = matrix.determinant().abs().max(1e-30).cbrt();
        deform.past_offset = matrices;
        deform.past_weights = weights;
        deform.smear = smear.amount;
        deform.smear_from = smear.threshold * motion.shutter_s();
        deform.smear_noise = smear.noise;
        deform.smear_spacing =
            (smear.spacing / metres).max(EDGES_PER_STREAK * mean_edge(primitive));
        deform.smear_seed = smear.seed;
    }
}

/// Mean length of the sides of a primitive's triangles; 0 without any.
fn mean_edge(primitive: &Primitive) -> f32 {
    let at = |corner: u32| primitive.positions.get(corner as usize).copied().unwrap_or_default();
    let sides = primitive.indices.chunks_exact(3).flat_map(|t| {
        let [a, b, c] = [at(t[0]), at(t[1]), at(t[2])];
        [a.distance(b), b.distance(c), c.distance(a)]
    });
    let usable = sides.filter(|side| side.is_finite());
    let (sum, count) = usable.fold((0.0_f64, 0_u32), |(s, n), side| (s + f64::from(side), n + 1));
    if count > 0 { (sum / f64::from(count)) as f32 } else { 0.0 }
}
