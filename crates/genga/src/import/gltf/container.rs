//! The GLB container: a header, a JSON chunk and an optional binary chunk.

use super::super::Problem;

/// The JSON of a `.gltf` or `.glb` file, and the binary chunk of the latter.
pub(super) fn split(bytes: &[u8]) -> Result<(&[u8], Option<&[u8]>), Problem> {
    if !bytes.starts_with(b"glTF") {
        return Ok((bytes, None));
    }
    let word = |at: usize| {
        bytes
            .get(at..)
            .and_then(<[u8]>::first_chunk)
            .map(|word| u32::from_le_bytes(*word))
            .ok_or_else(|| Problem::Damaged("its GLB header is incomplete".to_owned()))
    };
    let version = word(4)?;
    if version != 2 {
        return Err(Problem::Version(format!("{version}")));
    }
    let length = word(8)? as usize;
    let Some(bytes) = bytes.get(..length) else {
        return Err(Problem::Damaged(format!(
            "its header promises {length} bytes, but it has {}",
            bytes.len()
        )));
    };
    let mut rest = bytes.get(12..).unwrap_or(&[]);
    let mut json = None;
    let mut binary = None;
    while let Some((header, after)) = rest.split_first_chunk::<8>() {
        let [l0, l1, l2, l3, kind @ ..] = *header;
        let length = u32::from_le_bytes([l0, l1, l2, l3]) as usize;
        let Some((chunk, next)) = after.split_at_checked(length) else {
            return Err(Problem::Damaged(format!(
                "a GLB chunk promises {length} bytes, but {} are left",
                after.len()
            )));
        };
        match &kind {
            b"JSON" if json.is_none() => json = Some(chunk),
            b"BIN\0" if binary.is_none() => binary = Some(chunk),
            // Chunks of other kinds are to be ignored.
            _ => {}
        }
        rest = next;
    }
    let json = json.ok_or_else(|| Problem::Damaged("its GLB has no JSON chunk".to_owned()))?;
    Ok((json, binary))
}
