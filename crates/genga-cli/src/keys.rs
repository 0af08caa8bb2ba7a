//! `--dump-keys`: where each highlight stands in a picture.

use std::fmt::Write as _;
use std::io::Write as _;

use genga::render::{HighlightState, Prepared, View};
use genga::scene::{PanoramaPlacement, Placement, yaw_pitch};
use glam::Vec3;

use crate::failure::{Failure, Outcome};

/// Prints all highlights of a picture to standard output.
pub(crate) fn print(name: &str, frame: i64, prepared: &Prepared, view: &View) -> Outcome {
    let mut text = format!("# {}, frame {frame}\n", name.replace(char::is_control, " "));
    for state in prepared.highlight_states(view) {
        let Some(highlight) = prepared.highlights().get(state.index) else { continue };
        // Writing to a string cannot fail.
        let _ = describe(&mut text, &state, &highlight.placement);
    }
    let mut out = std::io::stdout().lock();
    let written = out.write_all(text.as_bytes()).and_then(|()| out.flush());
    written.map_err(|error| Failure::standard_output(&error))
}

/// Light and view as keys of the scene file have them, then the place.
fn describe(text: &mut String, state: &HighlightState, placement: &Placement) -> std::fmt::Result {
    let HighlightState { moment, placed, .. } = state;
    writeln!(text, "[[highlight]]")?;
    writeln!(text, "name = {}", toml_string(&state.name))?;
    writeln!(text, "light_deg = {}", azimuth_elevation(moment.light))?;
    writeln!(text, "view_deg = {}", azimuth_elevation(moment.view))?;
    writeln!(text, "# the reflected direction of its middle, and the normal that shows it")?;
    writeln!(text, "middle_deg = {}", azimuth_elevation(placed.middle().as_vec3()))?;
    writeln!(text, "normal_deg = {}", azimuth_elevation(state.normal))?;
    if let (Placement::Panorama(_), Some([yaw, pitch])) = (placement, placed.panorama) {
        let [at_yaw, at_pitch] = PanoramaPlacement::relative(moment).map(f32::to_degrees);
        let (yaw, pitch) = (yaw.to_degrees(), pitch.to_degrees());
        writeln!(text, "yaw_key = {{ at_deg = {at_yaw:.3}, place_deg = {yaw:.3} }}")?;
        writeln!(text, "pitch_key = {{ at_deg = {at_pitch:.3}, place_deg = {pitch:.3} }}")?;
        return Ok(());
    }
    writeln!(text, "rotation_deg = {:.3}", placed.rotation.to_degrees())?;
    writeln!(text, "scale = [{:.4}, {:.4}]", placed.scale[0], placed.scale[1])?;
    writeln!(text, "split = [{:.4}, {:.4}]", placed.split[0], placed.split[1])?;
    writeln!(text, "square = {:.4}", placed.square)?;
    writeln!(text, "opacity = {:.4}", placed.opacity)
}

/// Degrees to the right of the front, and above the horizon.
fn azimuth_elevation(direction: Vec3) -> String {
    let [yaw, pitch] = yaw_pitch(direction).map(f32::to_degrees);
    format!("[{yaw:.3}, {:.3}]", 0.0 - pitch)
}

/// A basic string of TOML.
fn toml_string(text: &str) -> String {
    let mut result = String::from('"');
    for c in text.chars() {
        match c {
            '"' | '\\' => result.extend(['\\', c]),
            c if c.is_control() => {
                let _ = write!(result, "\\u{:04X}", c as u32);
            }
            c => result.push(c),
        }
    }
    result.push('"');
    result
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_strings_of_toml() {
        assert_eq!(toml_string("a \"b\" \\ \n"), "\"a \\\"b\\\" \\\\ \\u000A\"");
    }

    #[test]
    fn directions_are_written_as_keys_have_them() {
        assert_eq!(azimuth_elevation(Vec3::new(1.0, 0.0, 0.0)), "[90.000, 0.000]");
        assert_eq!(azimuth_elevation(Vec3::Y), "[0.000, 90.000]");
    }
}
