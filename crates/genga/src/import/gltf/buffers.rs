//! Buffers and views of them.

use std::collections::HashMap;
use std::io;
use std::rc::Rc;

use super::super::{Problem, files};
use super::document::Document;

/// The bytes of one buffer.
enum Data<'a> {
    /// The GLB's own.
    Binary(&'a [u8]),
    /// Those of a URI, of which the buffer is the first `length` bytes.
    Read { bytes: Rc<[u8]>, length: usize },
}

impl Data<'_> {
    fn bytes(&self) -> &[u8] {
        match self {
            Self::Binary(bytes) => bytes,
            Self::Read { bytes, length } => bytes.get(..*length).unwrap_or(bytes),
        }
    }
}

/// The data of all buffers. One that could not be read is a problem only for what uses it.
pub(super) struct Buffers<'a> {
    buffers: Vec<Result<Data<'a>, String>>,
    /// Bytes of all sources together, each counted once.
    pub(super) total_bytes: u64,
}

impl<'a> Buffers<'a> {
    /// Reads all buffers, each URI once; `binary` is the GLB's own.
    pub(super) fn read(
        document: &Document,
        binary: Option<&'a [u8]>,
        files: &dyn Fn(&str) -> io::Result<Vec<u8>>,
    ) -> Self {
        let mut total_bytes = binary.map_or(0, |binary| binary.len() as u64);
        let mut read_before: HashMap<&str, Result<Rc<[u8]>, String>> = HashMap::new();
        let mut buffers = Vec::with_capacity(document.buffers.len());
        for (index, buffer) in document.buffers.iter().enumerate() {
            let length = buffer.byte_length.0;
            let data = match (&buffer.uri, binary) {
                (Some(uri), _) => read_before
                    .entry(uri)
                    .or_insert_with(|| {
                        let bytes = files::read_uri(uri, files)?;
                        total_bytes += bytes.len() as u64;
                        Ok(bytes.into())
                    })
                    .clone()
                    .map(|bytes| Data::Read { bytes, length }),
                // A GLB's chunk is padded to four bytes.
                (None, Some(binary)) if index == 0 => {
                    Ok(Data::Binary(binary.get(..length).unwrap_or(binary)))
                }
                (None, _) => Err("it has no data".to_owned()),
            };
            buffers.push(data.and_then(|data| {
                let has = data.bytes().len();
                if has < length {
                    return Err(format!(
                        "it should have {length} bytes, but only {has} are there; export the model again"
                    ));
                }
                Ok(data)
            }));
        }
        Self { buffers, total_bytes }
    }

    /// The bytes of a buffer view.
    pub(super) fn view(&self, document: &Document, index: usize) -> Result<&[u8], Problem> {
        let part = || format!("buffer view {index}");
        let Some(view) = document.buffer_views.get(index) else {
            let count = document.buffer_views.len();
            return Err(Problem::invalid(part(), format!("it does not exist, there are {count}")));
        };
        let buffer = match self.buffers.get(view.buffer.0) {
            Some(Ok(buffer)) => buffer.bytes(),
            Some(Err(why)) => {
                return Err(Problem::invalid(format!("buffer {}", view.buffer.0), why.clone()));
            }
            None => {
                let why = format!("it lies in buffer {}, which does not exist", view.buffer.0);
                return Err(Problem::invalid(part(), why));
            }
        };
        let start = view.byte_offset.0;
        start.checked_add(view.byte_length.0).and_then(|end| buffer.get(start..end)).ok_or_else(
            || {
                let why = format!(
                    "{} bytes from byte {start} on do not fit into the {} bytes of buffer {}",
                    view.byte_length.0,
                    buffer.len(),
                    view.buffer.0
                );
                Problem::invalid(part(), why)
            },
        )
    }
}
