use std::borrow::Cow;
use std::fs::File;
use std::io::{self, Read};
use std::path::Path;

use base64::Engine;
use base64::alphabet;
use base64::engine::{DecodePaddingMode, GeneralPurpose, GeneralPurposeConfig};

use super::warnings::quoted;

/// Files over this size are refused: GLB ends at 4 GiB, and nothing larger fits a picture.
const MAX_FILE_BYTES: u64 = 4 << 30;

/// The `files` of [`super::from_bytes`] for models that must not refer to any.
///
/// # Errors
/// Always.
pub fn no_files(_: &str) -> io::Result<Vec<u8>> {
    Err(io::Error::new(io::ErrorKind::NotFound, "other files are not available here"))
}

/// Reads a regular file; devices and pipes, which need not end, are refused.
pub(super) fn read_file(path: &Path) -> io::Result<Vec<u8>> {
    let is_file = |meta: &std::fs::Metadata| {
        if meta.is_file() { Ok(()) } else { Err(io::Error::other("this is not a regular file")) }
    };
    // Checked before opening too: opening a pipe would wait for its other end.
    is_file(&std::fs::metadata(path)?)?;
    let file = File::open(path)?;
    let meta = file.metadata()?;
    is_file(&meta)?;
    if meta.len() > MAX_FILE_BYTES {
        return Err(io::Error::new(io::ErrorKind::FileTooLarge, "it is larger than 4 GiB"));
    }
    let mut bytes = Vec::with_capacity(usize::try_from(meta.len()).unwrap_or(0));
    file.take(MAX_FILE_BYTES).read_to_end(&mut bytes)?;
    Ok(bytes)
}

/// The bytes behind a URI: a `data:` URI or a file relative to the model.
///
/// # Errors
/// A clause that says why there are none, to follow the name of what refers to it.
pub(super) fn read_uri(
    uri: &str,
    files: &dyn Fn(&str) -> io::Result<Vec<u8>>,
) -> Result<Vec<u8>, String> {
    if let Some(data) = strip_prefix_ignoring_case(uri, "data:") {
        return read_data_uri(data);
    }
    let path =
        percent_encoding::percent_decode_str(uri).decode_utf8().unwrap_or(Cow::Borrowed(uri));
    read_relative(&path, files).or_else(|error| {
        // Some exporters do not encode a '%' that is part of a file's name.
        if path == uri { Err(error) } else { read_relative(uri, files).map_err(|_| error) }
    })
}

/// The bytes of a file relative to the model.
///
/// # Errors
/// A clause that says why there are none.
pub(super) fn read_relative(
    path: &str,
    files: &dyn Fn(&str) -> io::Result<Vec<u8>>,
) -> Result<Vec<u8>, String> {
    if path.contains("://") {
        return Err(format!("it is at the URL {}, and Genga reads only files", quoted(path)));
    }
    let drive = path.as_bytes().get(1) == Some(&b':');
    if drive || path.starts_with(['/', '\\']) {
        return Err(format!(
            "its path {} is absolute; make it relative to the model's folder",
            quoted(path)
        ));
    }
    if path.is_empty() || path.contains('\0') {
        return Err("its path is empty or not a path".to_owned());
    }
    match files(path) {
        // Paths written on Windows.
        Err(_) if path.contains('\\') => files(&path.replace('\\', "/")),
        result => result,
    }
    .map_err(|error| {
        format!(
            "the file {}, which belongs beside the model, cannot be read ({error})",
            quoted(path)
        )
    })
}

/// Decodes what follows `data:`.
fn read_data_uri(data: &str) -> Result<Vec<u8>, String> {
    let Some((header, body)) = data.split_once(',') else {
        return Err("its data URI has no ','".to_owned());
    };
    let body: Vec<u8> = percent_encoding::percent_decode_str(body).collect();
    let encoding = header.rsplit(';').next().unwrap_or("").trim();
    if !encoding.eq_ignore_ascii_case("base64") {
        return Ok(body);
    }
    let config = GeneralPurposeConfig::new()
        .with_decode_padding_mode(DecodePaddingMode::Indifferent)
        .with_decode_allow_trailing_bits(true);
    let body: Vec<u8> = if body.iter().any(u8::is_ascii_whitespace) {
        body.into_iter().filter(|byte| !byte.is_ascii_whitespace()).collect()
    } else {
        body
    };
    GeneralPurpose::new(&alphabet::STANDARD, config)
        .decode(&body)
        .map_err(|error| format!("its data URI is not valid base64 ({error})"))
}

fn strip_prefix_ignoring_case<'a>(text: &'a str, prefix: &str) -> Option<&'a str> {
    let (head, tail) = text.split_at_checked(prefix.len())?;
    head.eq_ignore_ascii_case(prefix).then_some(tail)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn echo(path: &str) -> io::Result<Vec<u8>> {
        if path.contains("missing") { no_files(path) } else { Ok(path.as_bytes().to_vec()) }
    }

    #[test]
    fn uris_name_files_or_hold_data() {
        let read = |uri| read_uri(uri, &echo).unwrap();
        assert_eq!(read("a%20b/../%C3%A9.bin"), "a b/../é.bin".as_bytes());
        assert_eq!(read("a b.bin"), b"a b.bin");
        assert_eq!(read("data:application/octet-stream;base64,AAEC/w=="), [0, 1, 2, 255]);
        assert_eq!(read("data:;base64,AAEC\n/w"), [0, 1, 2, 255]);
        assert_eq!(read("DATA:text/plain,a%20b"), b"a b");
    }

    #[test]
    fn a_literal_percent_sign_is_found() {
        let files = |path: &str| if path == "50%25.png" { Ok(vec![1]) } else { no_files(path) };
        assert_eq!(read_uri("50%25.png", &files).unwrap(), [1]);
    }

    #[test]
    fn windows_separators_are_tried_as_slashes() {
        let files = |path: &str| if path == "tex/a.png" { Ok(vec![1]) } else { no_files(path) };
        assert_eq!(read_uri("tex\\a.png", &files).unwrap(), [1]);
    }

    #[test]
    fn absolute_paths_and_urls_are_refused() {
        for uri in ["/etc/passwd", "%2Fetc%2Fpasswd", "C:\\a.png", "c:a.png", "\\\\host\\share"] {
            assert!(read_uri(uri, &no_files).unwrap_err().contains("absolute"), "{uri}");
        }
        for uri in ["https://example.org/a.bin", "file:///etc/passwd"] {
            assert!(read_uri(uri, &no_files).unwrap_err().contains("URL"), "{uri}");
        }
    }

    #[test]
    fn broken_uris_say_why() {
        let why = |uri| read_uri(uri, &echo).unwrap_err();
        assert!(why("data:base64").contains("no ','"));
        assert!(why("data:;base64,?").contains("base64"));
        assert!(why("missing.bin").contains("'missing.bin'"));
        assert!(why("").contains("empty"));
    }

    #[test]
    fn folders_and_devices_are_refused() {
        let folder = tempfile::tempdir().unwrap();
        assert!(read_file(folder.path()).is_err());
        assert!(read_file(&folder.path().join("nothing")).is_err());
        #[cfg(unix)]
        assert!(read_file(Path::new("/dev/zero")).is_err());
    }
}
