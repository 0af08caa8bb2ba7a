//! What is drawn: a model by itself, or a scene file.

use std::path::{Path, PathBuf};

use genga::render::{Orbit, ViewCamera};
use genga::scene::{Beam, BeamMotion, Pose, Projection, Scene, Wave, WaveMotion};
use genga::scene_file::{Picture, SceneCamera, SceneFile};
use genga::style::{Motion, Style};
use glam::Vec3;

use crate::args::OrbitArgs;
use crate::console::Console;
use crate::failure::{Failure, Outcome};
use crate::model;
use crate::style_choice::{self, StyleChoice};
use crate::text::{nearest, one_line};

/// Something to draw.
pub(crate) struct Source {
    /// The file's name without folder and ending.
    pub(crate) name: String,
    /// Everything in it.
    pub(crate) scene: Scene,
    /// All files that were read for it.
    pub(crate) files: Vec<PathBuf>,
    /// The picture that it asks for.
    pub(crate) picture: Picture,
    camera: Option<SceneCamera>,
    animation: Animation,
}

/// A source at one moment.
pub(crate) struct Moment {
    pub(crate) pose: Pose,
    pub(crate) waves: Vec<Wave>,
    pub(crate) beams: Vec<Beam>,
}

/// How a source moves.
enum Animation {
    /// By one clip of the model.
    Clip(Option<usize>),
    /// Each model by its own clip, as the file says.
    File {
        file: Box<SceneFile>,
        /// The models, if they move.
        models: Vec<(PathBuf, Scene)>,
        /// Where everything stands at the file's own moment.
        pose: Pose,
    },
}

/// Whether a path is that of a scene file.
pub(crate) fn is_scene_file(path: &Path) -> bool {
    path.extension().is_some_and(|ending| ending.eq_ignore_ascii_case("toml"))
}

/// Reads a model or scene, with the style that a scene asks for. `moves` says whether a moment or
/// frame is asked for.
pub(crate) fn load(
    path: &Path,
    clip: Option<&str>,
    moves: bool,
    console: &Console,
) -> Outcome<(Source, Option<StyleChoice>)> {
    if is_scene_file(path) {
        return load_scene(path, clip, moves, console);
    }
    let model = model::load(path).map_err(Failure::message)?;
    warn(console, &path.display().to_string(), &model.warnings);
    let scene = model.scene;
    let clip = match clip {
        Some(clip) => Some(find_clip(&scene, clip)?),
        None if moves && scene.clips.is_empty() => {
            console
                .warning(&format!("{}: it has no animation, so it stands still", path.display()));
            None
        }
        None => (moves && !scene.clips.is_empty()).then_some(0),
    };
    let source = Source {
        name: model::display_name(path),
        scene,
        files: model.files,
        picture: Picture::default(),
        camera: None,
        animation: Animation::Clip(clip),
    };
    Ok((source, None))
}

fn load_scene(
    path: &Path,
    clip: Option<&str>,
    moves: bool,
    console: &Console,
) -> Outcome<(Source, Option<StyleChoice>)> {
    if clip.is_some() {
        return Err(Failure::Usage(format!(
            "'--clip' is for models; '{}' says by itself which clip each of its models plays",
            path.display()
        )));
    }
    let file = SceneFile::load(path)?;
    let mut files = vec![path.to_owned()];
    let style = file.load_style()?.map(|style| scene_style(path, &file, style));
    files.extend(style.iter().filter_map(|style| style.file.clone()));
    let mut models: Vec<(PathBuf, Scene)> = Vec::new();
    let assembled = file.assemble(|path| {
        let model = model::load(path)?;
        warn(console, &path.display().to_string(), &model.warnings);
        files.extend(model.files);
        if moves {
            models.push((path.to_owned(), model.scene.clone()));
        }
        Ok::<_, genga::import::ImportError>(model.scene)
    })?;
    for warning in &assembled.warnings {
        console.warning(&one_line(warning));
    }
    let stands = file.models.iter().all(|model| model.clip.is_none())
        && file.waves.iter().all(|wave| wave.motion == WaveMotion::default())
        && file.beams.iter().all(|beam| beam.motion == BeamMotion::default());
    if moves && stands {
        console.warning(&format!(
            "{}: none of its models has a 'clip' and none of its waves and beams a 'motion', so it \
             stands still",
            path.display()
        ));
    }
    let source = Source {
        name: model::display_name(path),
        scene: assembled.scene,
        files,
        picture: file.picture,
        camera: assembled.camera,
        animation: Animation::File { file: Box::new(file), models, pose: assembled.pose },
    };
    Ok((source, style))
}

fn scene_style(path: &Path, file: &SceneFile, style: Style) -> StyleChoice {
    let name = file.style.as_ref().map_or("", |name| name.as_str());
    if style_choice::is_preset(name) {
        return StyleChoice { name: name.to_owned(), file: None, style };
    }
    let file = path.parent().unwrap_or(Path::new("")).join(name);
    StyleChoice { name: model::display_name(&file), file: Some(file), style }
}

fn warn(console: &Console, name: &str, warnings: &[String]) {
    for warning in warnings {
        console.warning(&one_line(&format!("{name}: {warning}")));
    }
}

impl Source {
    /// Where everything stands, `seconds` into the clip if that is given. For a scene file the
    /// seconds are added to each model's own.
    pub(crate) fn pose(&self, seconds: Option<f32>) -> Outcome<Pose> {
        Ok(self.moment(seconds)?.pose)
    }

    /// The poses before a moment that speed lines and smears need; none in other styles.
    pub(crate) fn past(&self, seconds: Option<f32>, motion: &Motion) -> Outcome<Vec<Pose>> {
        let moments = motion.moments();
        moments.iter().map(|before| self.pose(Some(seconds.unwrap_or(0.0) - before))).collect()
    }

    /// Everything that moves.
    pub(crate) fn moment(&self, seconds: Option<f32>) -> Outcome<Moment> {
        let still = |pose| Moment { pose, waves: Vec::new(), beams: Vec::new() };
        match &self.animation {
            Animation::Clip(Some(clip)) => {
                Ok(still(Pose::at(&self.scene, *clip, seconds.unwrap_or(0.0))))
            }
            Animation::Clip(None) => Ok(still(Pose::rest(&self.scene))),
            Animation::File { file, models, pose } => match seconds {
                None => Ok(Moment {
                    pose: pose.clone(),
                    waves: self.scene.waves.clone(),
                    beams: self.scene.beams.clone(),
                }),
                Some(seconds) => {
                    let mut file = file.clone();
                    for model in &mut file.models {
                        model.time += seconds;
                    }
                    for wave in &mut file.waves {
                        wave.time += seconds;
                    }
                    for beam in &mut file.beams {
                        beam.time += seconds;
                    }
                    let assembled = file.assemble(|path| {
                        match models.iter().find(|(known, _)| known == path) {
                            Some((_, scene)) => Ok(scene.clone()),
                            None => model::load(path).map(|model| model.scene),
                        }
                    })?;
                    let Scene { waves, beams, .. } = assembled.scene;
                    Ok(Moment { pose: assembled.pose, waves, beams })
                }
            },
        }
    }

    /// The points that a camera is fitted to, or a sentence if nothing is drawn.
    pub(crate) fn drawn(&self, points: Vec<Vec3>) -> Outcome<Vec<Vec3>> {
        if points.is_empty() {
            return Err(Failure::Message(format!(
                "{}: there is nothing to draw: it has neither triangles nor waves nor beams",
                self.name
            )));
        }
        Ok(points)
    }

    /// Says which waves a camera does not see since they lie beyond their reach.
    pub(crate) fn warn_of_reach(&self, camera: &ViewCamera, pose: &Pose, console: &Console) {
        let from_world = camera.world_from_camera.inverse();
        let distance = |place: &Vec3| {
            let seen = from_world.transform_point3(*place);
            match camera.projection {
                Projection::Perspective { .. } => seen.length(),
                Projection::Orthographic { .. } => -seen.z,
            }
        };
        for wave in &self.scene.waves {
            let Some(radius) = wave.radius else { continue };
            let places = wave.places(pose, 65);
            let nearest = places.iter().map(distance).fold(f32::INFINITY, f32::min);
            if nearest - radius > wave.reach {
                console.warning(&one_line(&format!(
                    "{}: wave '{}' is {nearest:.0} m away from the camera, but it shines only up to \
                     its reach of {} m: give it a larger 'reach', or place the camera nearer to it",
                    self.name, wave.name, wave.reach
                )));
            }
        }
    }

    /// The camera of the model with that name or number.
    pub(crate) fn named_camera(&self, name: &str, pose: &Pose) -> Outcome<ViewCamera> {
        let cameras: Vec<(usize, &str, &str)> = (self.scene.nodes.iter().enumerate())
            .filter_map(|(index, node)| {
                let camera = self.scene.cameras.get(node.camera?)?;
                Some((index, node.name.as_str(), camera.name.as_str()))
            })
            .collect();
        let by_name = cameras.iter().find(|(_, node, camera)| *node == name || *camera == name);
        let by_number = || name.parse().ok().and_then(|index: usize| cameras.get(index));
        let found = by_name.or_else(by_number);
        let camera = found.and_then(|(node, ..)| ViewCamera::from_node(&self.scene, pose, *node));
        camera.ok_or_else(|| {
            let known = cameras
                .iter()
                .map(|(_, node, camera)| if camera.is_empty() { *node } else { *camera });
            Failure::Message(not_there(&self.name, "camera", name, &known.collect::<Vec<_>>()))
        })
    }

    /// The camera without a name: as the options say, else as the scene file says, else the
    /// library's own.
    pub(crate) fn camera(
        &self,
        options: &OrbitArgs,
        pose: &Pose,
        points: &[Vec3],
        aspect: f32,
    ) -> ViewCamera {
        match self.camera {
            Some(SceneCamera::Placed(placed)) if !options.any() => ViewCamera {
                world_from_camera: placed.world_from_camera,
                projection: placed.projection,
                near: placed.near,
            },
            Some(SceneCamera::Node(node)) if !options.any() => {
                ViewCamera::from_node(&self.scene, pose, node)
                    .unwrap_or_else(|| self.fitted(options, points, aspect))
            }
            _ => self.fitted(options, points, aspect),
        }
    }

    fn fitted(&self, options: &OrbitArgs, points: &[Vec3], aspect: f32) -> ViewCamera {
        ViewCamera::orbit_points(points, &self.orbit(options), aspect)
    }

    /// The orbit that the options ask for; the rest is the scene file's or the library's.
    pub(crate) fn orbit(&self, options: &OrbitArgs) -> Orbit {
        let base = match self.camera {
            Some(SceneCamera::Orbit(orbit)) => Orbit {
                azimuth_deg: orbit.azimuth_deg,
                elevation_deg: orbit.elevation_deg,
                zoom: orbit.zoom,
                fov_deg: orbit.fov_deg,
                orthographic: orbit.orthographic,
            },
            _ => Orbit::default(),
        };
        Orbit {
            azimuth_deg: options.camera_azimuth_angle.unwrap_or(base.azimuth_deg),
            elevation_deg: options.camera_elevation_angle.unwrap_or(base.elevation_deg),
            zoom: options.camera_zoom.unwrap_or(base.zoom),
            fov_deg: options.camera_fov_angle.unwrap_or(base.fov_deg),
            orthographic: options.orthographic
                || (base.orthographic && options.camera_fov_angle.is_none()),
        }
    }
}

impl OrbitArgs {
    /// Whether any of the options is given.
    pub(crate) fn any(&self) -> bool {
        self.orthographic
            || [
                self.camera_azimuth_angle,
                self.camera_elevation_angle,
                self.camera_zoom,
                self.camera_fov_angle,
            ]
            .iter()
            .any(Option::is_some)
    }
}

fn find_clip(scene: &Scene, name: &str) -> Outcome<usize> {
    let by_number = || name.parse().ok().filter(|&index: &usize| index < scene.clips.len());
    scene.find_clip(name).or_else(by_number).ok_or_else(|| {
        let known: Vec<&str> = scene.clips.iter().map(|clip| clip.name.as_str()).collect();
        Failure::Message(not_there(&scene.name, "clip", name, &known))
    })
}

fn not_there(file: &str, what: &str, name: &str, known: &[&str]) -> String {
    const SHOWN: usize = 20;
    if known.is_empty() {
        return format!("{file}: there is no {what} '{name}': there are no {what}s at all");
    }
    let meant = match nearest(name, known.iter().copied()) {
        Some(meant) => format!(", did you mean '{}'?", one_line(meant)),
        None => String::new(),
    };
    let list: Vec<String> = known
        .iter()
        .enumerate()
        .take(SHOWN)
        .map(|(i, name)| if name.is_empty() { i.to_string() } else { one_line(name) })
        .collect();
    let more = if known.len() > SHOWN { ", …" } else { "" };
    format!("{file}: there is no {what} '{name}'{meant} (known: {}{more})", list.join(", "))
}
