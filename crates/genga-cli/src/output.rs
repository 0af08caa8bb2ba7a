//! Where pictures go: names, and files that appear whole or not at all.

use std::collections::HashSet;
use std::ffi::OsString;
use std::fs::{self, File};
use std::io::{self, BufWriter, IsTerminal as _, Write as _};
use std::path::{Path, PathBuf};

use genga::export::ExportError;

use crate::failure::{Failure, Outcome, reason};
use crate::template::Template;

/// What `--output` says.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) enum Output {
    /// `-`
    Stdout,
    /// The name of one or more files.
    Files(Template),
}

impl Output {
    /// Reads the argument of `--output`.
    pub(crate) fn parse(text: &str) -> Result<Self, String> {
        if text == "-" {
            return Ok(Self::Stdout);
        }
        let template = Template::parse(text)?;
        if !text.to_ascii_lowercase().ends_with(".png") {
            let instead = match Path::new(text).extension() {
                Some(_) if !text.ends_with('}') => Path::new(text).with_extension("png"),
                _ if text.ends_with('/') => Path::new(text).join("{model}.png"),
                _ => PathBuf::from(format!("{text}.png")),
            };
            return Err(format!(
                "pictures are written as PNG: give a name that ends in .png, such as '{}'",
                instead.display()
            ));
        }
        Ok(Self::Files(template))
    }
}

/// Refuses to send a picture to a terminal.
pub(crate) fn check_stdout() -> Outcome {
    if io::stdout().is_terminal() {
        return Err(Failure::Usage(
            "standard output is a terminal: send the picture into a file or a program ('> picture.png'), or give '--output' a name"
                .to_owned(),
        ));
    }
    Ok(())
}

/// Checks, before anything is drawn, that the outputs are different files and that none is a
/// folder or one of the inputs.
pub(crate) fn check_files(outputs: &[PathBuf], inputs: &[PathBuf]) -> Outcome {
    let mut seen = HashSet::new();
    for output in outputs {
        let shown = output.display();
        if output.is_dir() {
            return Err(Failure::Usage(format!(
                "'{shown}' is a folder: give a file's name, such as '{}'",
                output.join("{model}.png").display()
            )));
        }
        if !seen.insert(identity(output)) {
            return Err(Failure::Usage(format!(
                "several pictures would be written to '{shown}': put {{model}}, {{style}}, {{frame:04}} or {{index}} into '--output' to tell them apart"
            )));
        }
    }
    refuse_inputs(outputs, inputs)
}

/// Checks that no output is a file that was read.
pub(crate) fn refuse_inputs(outputs: &[PathBuf], inputs: &[PathBuf]) -> Outcome {
    // Comparing what is named alike is enough, except through links.
    let inputs: Vec<PathBuf> = inputs.iter().map(|path| identity(path)).collect();
    for output in outputs {
        if inputs.contains(&identity(output)) {
            return Err(Failure::Usage(format!(
                "'{}' is read for this picture and will not be overwritten: choose another '--output'",
                output.display()
            )));
        }
    }
    Ok(())
}

/// The same for all ways to write the path of a file, whether it exists or not.
fn identity(path: &Path) -> PathBuf {
    if let Ok(path) = path.canonicalize() {
        return path;
    }
    let parent = match path.parent() {
        Some(parent) if parent != Path::new("") => parent.canonicalize(),
        _ => std::env::current_dir(),
    };
    match (parent, path.file_name()) {
        (Ok(parent), Some(name)) => parent.join(name),
        _ => path.to_owned(),
    }
}

/// `knight.depth.exr` for the layer `depth` beside `knight.png`.
pub(crate) fn layer_path(picture: &Path, layer: &str, ending: &str) -> PathBuf {
    let mut name = picture.file_stem().map_or_else(OsString::new, OsString::from);
    name.push(format!(".{layer}.{ending}"));
    picture.with_file_name(name)
}

/// Writes a file so that it is there whole or not at all: beside it, then renamed. A file of that
/// name is replaced only on success, and keeps its permissions. Missing folders are made.
pub(crate) fn write_file(
    path: &Path,
    encode: impl FnOnce(&mut BufWriter<&File>) -> Result<(), ExportError>,
) -> Outcome {
    let fail = |error: &ExportError| {
        let why = match error {
            ExportError::Write(error) => reason(error),
            other => other.to_string(),
        };
        Failure::Message(format!("cannot write '{}': {why}", path.display()))
    };
    write_atomically(path, encode).map_err(|error| fail(&error))
}

fn write_atomically(
    path: &Path,
    encode: impl FnOnce(&mut BufWriter<&File>) -> Result<(), ExportError>,
) -> Result<(), ExportError> {
    // Through a link, so that the link stays.
    let path = fs::canonicalize(path).unwrap_or_else(|_| path.to_owned());
    let old = fs::metadata(&path).ok();
    if let Some(old) = &old
        && !old.is_file()
        && !old.is_dir()
    {
        // A device or pipe cannot be replaced.
        let file = File::options().write(true).open(&path)?;
        return write_all(&file, encode);
    }
    let folder = match path.parent() {
        Some(folder) if folder != Path::new("") => folder,
        _ => Path::new("."),
    };
    fs::create_dir_all(folder)?;
    let mut builder = tempfile::Builder::new();
    builder.prefix(".genga-").suffix(".part");
    #[cfg(unix)]
    {
        use std::os::unix::fs::PermissionsExt as _;
        // Less the umask, as for any new file.
        builder.permissions(fs::Permissions::from_mode(0o666));
    }
    // Deleted again on every return before `persist`.
    let file = builder.tempfile_in(folder)?;
    write_all(file.as_file(), encode)?;
    if let Some(old) = old {
        file.as_file().set_permissions(old.permissions())?;
    }
    // Some file systems report a full disk only here.
    file.as_file().sync_data()?;
    file.persist(&path).map_err(|error| ExportError::Write(error.error))?;
    Ok(())
}

fn write_all(
    file: &File,
    encode: impl FnOnce(&mut BufWriter<&File>) -> Result<(), ExportError>,
) -> Result<(), ExportError> {
    let mut writer = BufWriter::with_capacity(1 << 18, file);
    encode(&mut writer)?;
    writer.flush()?;
    Ok(())
}

/// Writes to standard output.
pub(crate) fn write_stdout(
    encode: impl FnOnce(&mut io::StdoutLock<'static>) -> Result<(), ExportError>,
) -> Outcome {
    let mut stdout = io::stdout().lock();
    let result = encode(&mut stdout).and_then(|()| Ok(stdout.flush()?));
    result.map_err(|error| match error {
        ExportError::Write(error) => Failure::standard_output(&error),
        other => Failure::message(other),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn names(folder: &Path) -> Vec<String> {
        let mut names: Vec<String> = fs::read_dir(folder)
            .expect("a folder")
            .map(|entry| entry.expect("an entry").file_name().to_string_lossy().into_owned())
            .collect();
        names.sort();
        names
    }

    #[test]
    fn output_names_end_in_png() {
        assert_eq!(Output::parse("-"), Ok(Output::Stdout));
        assert!(matches!(Output::parse("{model}.PNG"), Ok(Output::Files(_))));
        let error = |text| Output::parse(text).expect_err("not a PNG");
        assert!(error("a.jpg").contains("'a.png'"));
        assert!(error("out/").contains("'out/{model}.png'"));
        assert!(error("{model}").contains("'{model}.png'"));
        assert!(error("{mode}.png").contains("did you mean"));
    }

    #[test]
    fn layers_stand_beside_the_picture() {
        let path = layer_path(Path::new("out/knight_0001.png"), "depth", "exr");
        assert_eq!(path, Path::new("out/knight_0001.depth.exr"));
    }

    #[test]
    fn a_failed_write_leaves_everything_as_it_was() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("a.png");
        fs::write(&path, "old").expect("a file");
        let result = write_file(&path, |writer| {
            writer.write_all(&[7; 1 << 20])?;
            Err(io::Error::from(io::ErrorKind::StorageFull).into())
        });
        let Err(Failure::Message(text)) = result else { panic!("{result:?}") };
        assert!(text.contains("a.png") && text.contains("disk is full"), "{text}");
        assert_eq!(fs::read(&path).expect("the file"), b"old");
        assert_eq!(names(folder.path()), ["a.png"]);
    }

    #[test]
    fn a_written_file_replaces_the_old_one() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("deep/er/a.png");
        for text in ["first", "second"] {
            write_file(&path, |writer| Ok(writer.write_all(text.as_bytes())?)).expect("written");
            assert_eq!(fs::read_to_string(&path).expect("the file"), text);
        }
        assert_eq!(names(&folder.path().join("deep/er")), ["a.png"]);
    }

    #[cfg(unix)]
    #[test]
    fn links_and_permissions_stay() {
        use std::os::unix::fs::{PermissionsExt as _, symlink};
        let folder = tempfile::tempdir().expect("a folder");
        let (file, link) = (folder.path().join("a.png"), folder.path().join("b.png"));
        fs::write(&file, "old").expect("a file");
        fs::set_permissions(&file, fs::Permissions::from_mode(0o640)).expect("permissions");
        symlink(&file, &link).expect("a link");
        write_file(&link, |writer| Ok(writer.write_all(b"new")?)).expect("written");
        assert!(fs::symlink_metadata(&link).expect("the link").is_symlink());
        assert_eq!(fs::read(&file).expect("the file"), b"new");
        let mode = fs::metadata(&file).expect("the file").permissions().mode();
        assert_eq!(mode & 0o777, 0o640);
    }

    #[cfg(target_os = "linux")]
    #[test]
    fn a_full_device_is_reported() {
        let result =
            write_file(Path::new("/dev/full"), |writer| Ok(writer.write_all(&[0; 1 << 20])?));
        let Err(Failure::Message(text)) = result else { panic!("{result:?}") };
        assert!(text.contains("disk is full"), "{text}");
    }

    #[test]
    fn inputs_are_not_overwritten() {
        let folder = tempfile::tempdir().expect("a folder");
        let input = folder.path().join("a.png");
        fs::write(&input, "texture").expect("a file");
        let around = folder.path().join("../").join(folder.path().file_name().unwrap_or_default());
        let check = |outputs: &[PathBuf]| check_files(outputs, std::slice::from_ref(&input));
        assert!(matches!(check(&[around.join("a.png")]), Err(Failure::Usage(_))));
        assert!(check(&[around.join("b.png")]).is_ok());
        let twice = [folder.path().join("c.png"), around.join("c.png")];
        assert!(matches!(check(&twice), Err(Failure::Usage(_))));
        assert!(matches!(check(&[folder.path().to_owned()]), Err(Failure::Usage(_))));
    }
}
