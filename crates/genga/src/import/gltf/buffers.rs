//! Buffers and views of them.

use std::borrow::Cow;
use std::io;

use super::super::{Problem, files};
use super::document::{Buffer, Document};

/// The data of all buffers. One that could not be read is a problem only for what uses it.
pub(super) struct Buffers<'a> {
    buffers: Vec<Result<Cow<'a, [u8]>, String>>,
}

impl<'a> Buffers<'a> {
    /// Reads all buffers; `binary` is the GLB's own.
    pub(super) fn read(
        document: &Document,
        binary: Option<&'a [u8]>,
        files: &dyn Fn(&str) -> io::Result<Vec<u8>>,
    ) -> Self {
        let buffers = document
            .buffers
            .iter()
            .enumerate()
            .map(|(index, buffer)| read_buffer(index, buffer, binary, files))
            .collect();
        Self { buffers }
    }

    /// Bytes of all buffers together.
    pub(super) fn total_len(&self) -> u64 {
        self.buffers.iter().flatten().map(|buffer| buffer.len() as u64).sum()
    }

    /// The bytes of a buffer view.
    pub(super) fn view(&self, document: &Document, index: usize) -> Result<&[u8], Problem> {
        let part = || format!("buffer view {index}");
        let Some(view) = document.buffer_views.get(index) else {
            let count = document.buffer_views.len();
            return Err(Problem::invalid(part(), format!("it does not exist, there are {count}")));
        };
        let buffer = match self.buffers.get(view.buffer.0) {
            Some(Ok(buffer)) => buffer,
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

fn read_buffer<'a>(
    index: usize,
    buffer: &Buffer,
    binary: Option<&'a [u8]>,
    files: &dyn Fn(&str) -> io::Result<Vec<u8>>,
) -> Result<Cow<'a, [u8]>, String> {
    let mut data: Cow<[u8]> = match (&buffer.uri, binary) {
        (Some(uri), _) => Cow::Owned(files::read_uri(uri, files)?),
        (None, Some(binary)) if index == 0 => Cow::Borrowed(binary),
        (None, _) => return Err("it has no data".to_owned()),
    };
    let wanted = buffer.byte_length.0;
    if data.len() < wanted {
        let has = data.len();
        return Err(format!(
            "it should have {wanted} bytes, but only {has} are there; export the model again"
        ));
    }
    // A GLB chunk is padded to four bytes.
    match &mut data {
        Cow::Borrowed(data) => *data = data.get(..wanted).unwrap_or(data),
        Cow::Owned(data) => data.truncate(wanted),
    }
    Ok(data)
}
