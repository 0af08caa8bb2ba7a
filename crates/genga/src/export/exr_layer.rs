use std::io::{BufWriter, Seek, Write};

use exr::image::IntoSample;
use exr::image::write::channels::WritableChannels;
use exr::prelude::{
    Encoding, Error as ExrError, Image, Layer, LayerAttributes, SpecificChannels, Text, Vec2,
    WritableImage as _,
};

use super::{ExportError, check_size};

/// The values of a layer: all channels of the first pixel, then of the next one, row 0 on top.
#[derive(Clone, Copy, Debug)]
pub enum Samples<'a> {
    /// 32-bit floats.
    F32(&'a [f32]),
    /// 32-bit unsigned integers, for ids.
    U32(&'a [u32]),
}

/// Writes an OpenEXR file of one layer, with ZIP compression (lossless).
///
/// `names` are the channels' names in the order of the samples: `R`, `G`, `B`, `A` for a picture
/// (linear, premultiplied), `Z` for depth, `N.X`, `N.Y`, `N.Z` for normals. One to four channels.
///
/// # Errors
/// [`ExportError::Size`] if there are not `width · height · names.len()` samples,
/// [`ExportError::Channels`] if the names cannot be used, [`ExportError::Write`] if the writer
/// fails.
pub fn write_exr(
    writer: impl Write + Seek,
    width: u32,
    height: u32,
    names: &[&str],
    samples: Samples<'_>,
) -> Result<(), ExportError> {
    let texts: Option<Vec<Text>> = names.iter().map(Text::new_or_none).collect();
    let texts = texts.ok_or(ExportError::Channels)?;
    let repeated = names.iter().enumerate().any(|(i, name)| names[..i].contains(name));
    if repeated || names.iter().any(|name| name.is_empty()) {
        return Err(ExportError::Channels);
    }
    match samples {
        Samples::F32(values) => write_channels(writer, width, height, &texts, values),
        Samples::U32(values) => write_channels(writer, width, height, &texts, values),
    }
}

fn write_channels<S: IntoSample>(
    writer: impl Write + Seek,
    width: u32,
    height: u32,
    names: &[Text],
    values: &[S],
) -> Result<(), ExportError> {
    let count = names.len();
    if count > 0 {
        check_size(width, height, count, values.len())?;
    }
    let size = Vec2(width as usize, height as usize);
    let start = move |at: Vec2<usize>| (at.y() * size.x() + at.x()) * count;
    let build = SpecificChannels::build();
    // The encoder fetches the pixels of 16 rows at a time.
    match names {
        [a] => {
            let build = build.with_channel::<S>(a.clone());
            let channels = build.with_pixel_fn(move |at| (values[start(at)],));
            encode(writer, &image(size, channels))
        }
        [a, b] => {
            let build = build.with_channel::<S>(a.clone()).with_channel::<S>(b.clone());
            let channels = build.with_pixel_fn(move |at| {
                let i = start(at);
                (values[i], values[i + 1])
            });
            encode(writer, &image(size, channels))
        }
        [a, b, c] => {
            let build = build.with_channel::<S>(a.clone()).with_channel::<S>(b.clone());
            let build = build.with_channel::<S>(c.clone());
            let channels = build.with_pixel_fn(move |at| {
                let i = start(at);
                (values[i], values[i + 1], values[i + 2])
            });
            encode(writer, &image(size, channels))
        }
        [a, b, c, d] => {
            let build = build.with_channel::<S>(a.clone()).with_channel::<S>(b.clone());
            let build = build.with_channel::<S>(c.clone()).with_channel::<S>(d.clone());
            let channels = build.with_pixel_fn(move |at| {
                let i = start(at);
                (values[i], values[i + 1], values[i + 2], values[i + 3])
            });
            encode(writer, &image(size, channels))
        }
        _ => Err(ExportError::Channels),
    }
}

fn image<'a, C: WritableChannels<'a> + 'a>(size: Vec2<usize>, channels: C) -> Image<Layer<C>> {
    let attributes = LayerAttributes::default();
    Image::from_layer(Layer::new(size, attributes, Encoding::SMALL_LOSSLESS, channels))
}

fn encode<'a, C: WritableChannels<'a>>(
    writer: impl Write + Seek,
    image: &'a Image<Layer<C>>,
) -> Result<(), ExportError> {
    let mut writer = BufWriter::new(writer);
    image.write().non_parallel().to_buffered(&mut writer).map_err(|error| match error {
        ExrError::Io(error) => ExportError::Write(error),
        other => ExportError::Encode(other.to_string()),
    })?;
    // The encoder does not, and dropping the buffer would hide a full disk.
    writer.flush()?;
    Ok(())
}

#[cfg(test)]
mod tests {
    use std::io::{self, Cursor, SeekFrom};

    use exr::prelude::{FlatSamples, ReadChannels as _, ReadLayers as _};

    use super::*;

    /// Each channel's name and samples, as another program would read them.
    fn read(file: &[u8]) -> Vec<(String, FlatSamples)> {
        let image = exr::prelude::read()
            .no_deep_data()
            .largest_resolution_level()
            .all_channels()
            .first_valid_layer()
            .all_attributes()
            .from_buffered(Cursor::new(file))
            .expect("an EXR file");
        let channels = image.layer_data.channel_data.list;
        channels.into_iter().map(|c| (c.name.to_string(), c.sample_data)).collect()
    }

    #[test]
    fn floats_are_read_again_under_their_names() {
        let (width, height) = (19_u32, 33_u32);
        for names in [&["Z"][..], &["N.X", "N.Y", "N.Z"], &["R", "G", "B", "A"]] {
            let count = names.len();
            let values: Vec<f32> =
                (0..width as usize * height as usize * count).map(|i| i as f32 * 0.37).collect();
            let mut file = Cursor::new(Vec::new());
            write_exr(&mut file, width, height, names, Samples::F32(&values)).expect("a layer");
            let channels = read(file.get_ref());
            assert_eq!(channels.len(), count);
            for (name, samples) in channels {
                let channel = names.iter().position(|n| *n == name).expect("a known channel");
                let expected = values.iter().skip(channel).step_by(count).copied().collect();
                assert_eq!(samples, FlatSamples::F32(expected), "{name}");
            }
        }
    }

    #[test]
    fn ids_stay_integers() {
        let values = [1, u32::MAX, 3, 4, 5, 1 << 25];
        let mut file = Cursor::new(Vec::new());
        write_exr(&mut file, 3, 1, &["object", "material"], Samples::U32(&values))
            .expect("a layer");
        let channels = read(file.get_ref());
        assert!(channels.contains(&("object".to_owned(), FlatSamples::U32(vec![1, 3, 5]))));
        let material = FlatSamples::U32(vec![u32::MAX, 4, 1 << 25]);
        assert!(channels.contains(&("material".to_owned(), material)));
    }

    #[test]
    fn wrong_input_is_refused() {
        let write = |width, height, names: &[&str], values: &[f32]| {
            write_exr(Cursor::new(Vec::new()), width, height, names, Samples::F32(values))
        };
        assert!(matches!(write(2, 2, &["Z"], &[0.0; 3]), Err(ExportError::Size { .. })));
        assert!(matches!(write(0, 2, &["Z"], &[]), Err(ExportError::Size { .. })));
        assert!(matches!(write(1, 1, &[], &[]), Err(ExportError::Channels)));
        assert!(matches!(write(1, 1, &["Z", "Z"], &[0.0; 2]), Err(ExportError::Channels)));
        assert!(matches!(write(1, 1, &[""], &[0.0]), Err(ExportError::Channels)));
        assert!(matches!(write(1, 1, &["深"], &[0.0]), Err(ExportError::Channels)));
        let five = ["a", "b", "c", "d", "e"];
        assert!(matches!(write(1, 1, &five, &[0.0; 5]), Err(ExportError::Channels)));
    }

    /// A disk with little room.
    struct Full {
        inner: Cursor<Vec<u8>>,
        room: u64,
    }

    impl Write for Full {
        fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
            if self.inner.position() + bytes.len() as u64 > self.room {
                return Err(io::ErrorKind::StorageFull.into());
            }
            self.inner.write(bytes)
        }

        fn flush(&mut self) -> io::Result<()> {
            Ok(())
        }
    }

    impl Seek for Full {
        fn seek(&mut self, to: SeekFrom) -> io::Result<u64> {
            self.inner.seek(to)
        }
    }

    #[test]
    fn a_full_disk_is_an_error() {
        let values: Vec<f32> = (0..64 * 64).map(|i| (i as f32).sin()).collect();
        for room in [0, 100, 5_000] {
            let disk = Full { inner: Cursor::new(Vec::new()), room };
            let result = write_exr(disk, 64, 64, &["Z"], Samples::F32(&values));
            assert!(matches!(result, Err(ExportError::Write(_))), "{room}: {result:?}");
        }
    }
}
