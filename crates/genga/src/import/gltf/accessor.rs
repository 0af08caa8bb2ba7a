//! Typed, bounds-checked access to buffer data, with sparse replacements.

use bytemuck::Pod;

use super::super::Problem;
use super::GltfFile;
use super::document::{Accessor as Item, Sparse as SparseItem};

/// A number format of the file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Component {
    I8,
    U8,
    I16,
    U16,
    U32,
    F32,
}

impl Component {
    fn from_code(code: usize) -> Option<Self> {
        Some(match code {
            5120 => Self::I8,
            5121 => Self::U8,
            5122 => Self::I16,
            5123 => Self::U16,
            5125 => Self::U32,
            5126 => Self::F32,
            _ => return None,
        })
    }

    fn size(self) -> usize {
        match self {
            Self::I8 | Self::U8 => 1,
            Self::I16 | Self::U16 => 2,
            Self::U32 | Self::F32 => 4,
        }
    }
}

/// What an element is made of.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Shape {
    Scalar,
    Vec2,
    Vec3,
    Vec4,
    Mat4,
}

impl Shape {
    fn from_name(name: &str) -> Option<Self> {
        Some(match name {
            "SCALAR" => Self::Scalar,
            "VEC2" => Self::Vec2,
            "VEC3" => Self::Vec3,
            "VEC4" => Self::Vec4,
            "MAT4" => Self::Mat4,
            _ => return None,
        })
    }

    /// Numbers per element.
    pub(super) fn width(self) -> usize {
        match self {
            Self::Scalar => 1,
            Self::Vec2 => 2,
            Self::Vec3 => 3,
            Self::Vec4 => 4,
            Self::Mat4 => 16,
        }
    }
}

/// Elements in a buffer, known to lie within it.
#[derive(Clone, Copy)]
struct Elements<'a> {
    /// From the first element to the last one's end; the last stride may be cut short.
    bytes: &'a [u8],
    stride: usize,
}

/// The elements that replace some of the others.
struct Sparse<'a> {
    /// Which ones; each is below the accessor's count.
    indices: Vec<u32>,
    values: Elements<'a>,
}

/// One accessor of the file, checked: reading it cannot fail.
pub(super) struct Accessor<'a> {
    /// Number of elements.
    pub(super) count: usize,
    pub(super) shape: Shape,
    component: Component,
    normalized: bool,
    /// `None` for zeros.
    base: Option<Elements<'a>>,
    sparse: Option<Sparse<'a>>,
}

/// Checks that `count` elements of `size` bytes lie within `view`.
fn elements<'a>(
    view: &'a [u8],
    offset: usize,
    stride: usize,
    size: usize,
    count: usize,
) -> Option<Elements<'a>> {
    let length = match count.checked_sub(1) {
        None => 0,
        Some(before) => before.checked_mul(stride)?.checked_add(size)?,
    };
    let bytes = view.get(offset..offset.checked_add(length)?)?;
    Some(Elements { bytes, stride })
}

impl<'a> Accessor<'a> {
    /// The accessor of that index, with all its bounds checked.
    pub(super) fn new(file: &'a GltfFile, index: usize) -> Result<Self, Problem> {
        let invalid = |why: String| Problem::invalid(format!("accessor {index}"), why);
        let accessors = &file.document.accessors;
        let item = accessors
            .get(index)
            .ok_or_else(|| invalid(format!("it does not exist, there are {}", accessors.len())))?;
        let component = Component::from_code(item.component_type.0).ok_or_else(|| {
            invalid(format!("its component type {} is unknown", item.component_type.0))
        })?;
        let shape = Shape::from_name(&item.shape).ok_or_else(|| {
            invalid(format!("its type {} cannot be used here", super::quoted(&item.shape)))
        })?;
        let count = item.count.0;
        // Elements are read as 32-bit numbers, whatever the file has.
        file.charge(count.saturating_mul(shape.width() * 4))?;
        let size = component.size() * shape.width();
        let base = match item.buffer_view {
            None => None,
            Some(view) => {
                Some(Self::base(file, item, view.0, size).map_err(|problem| match problem {
                    Ok(why) => invalid(why),
                    Err(problem) => problem,
                })?)
            }
        };
        let sparse = match &item.sparse {
            Some(sparse) if sparse.count.0 > 0 => {
                Some(Self::sparse(file, index, count, sparse, size)?)
            }
            _ => None,
        };
        Ok(Self { count, shape, component, normalized: item.normalized, base, sparse })
    }

    /// The accessor of that index, which must have one of these shapes.
    pub(super) fn of_shape(
        file: &'a GltfFile,
        index: usize,
        shapes: &[Shape],
    ) -> Result<Self, Problem> {
        let accessor = Self::new(file, index)?;
        if shapes.contains(&accessor.shape) {
            return Ok(accessor);
        }
        let has = accessor.shape;
        let part = format!("accessor {index}");
        Err(Problem::invalid(part, format!("its type {has:?} is not one of {shapes:?}")))
    }

    /// The same accessor with whole numbers read as −1…1 or 0…1.
    pub(super) fn normalized(self) -> Self {
        Self { normalized: true, ..self }
    }

    fn base(
        file: &'a GltfFile,
        item: &Item,
        view_index: usize,
        size: usize,
    ) -> Result<Elements<'a>, Result<String, Problem>> {
        let view = file.view(view_index).map_err(Err)?;
        let stride = file
            .document
            .buffer_views
            .get(view_index)
            .and_then(|view| view.byte_stride)
            .map_or(0, |stride| stride.0);
        // Some exporters write 0 for 'tightly packed'.
        let stride = if stride == 0 { size } else { stride };
        if stride < size {
            return Err(Ok(format!(
                "its elements of {size} bytes overlap, as buffer view {view_index} has a stride of {stride}"
            )));
        }
        let count = item.count.0;
        elements(view, item.byte_offset.0, stride, size, count).ok_or_else(|| {
            Ok(format!(
                "its {count} elements of {size} bytes do not fit into the {} bytes of buffer view {view_index}",
                view.len()
            ))
        })
    }

    fn sparse(
        file: &'a GltfFile,
        index: usize,
        count: usize,
        item: &SparseItem,
        size: usize,
    ) -> Result<Sparse<'a>, Problem> {
        let invalid = |why: &str| Problem::invalid(format!("accessor {index}, sparse part"), why);
        let n = item.count.0;
        if n > count {
            return Err(invalid("it replaces more elements than there are"));
        }
        let component = Component::from_code(item.indices.component_type.0)
            .filter(|c| matches!(c, Component::U8 | Component::U16 | Component::U32))
            .ok_or_else(|| invalid("its indices have the wrong component type"))?;
        let does_not_fit = || invalid("it does not fit into its buffer views");
        let view = file.view(item.indices.buffer_view.0)?;
        let step = component.size();
        let at =
            elements(view, item.indices.byte_offset.0, step, step, n).ok_or_else(does_not_fit)?;
        let view = file.view(item.values.buffer_view.0)?;
        let values =
            elements(view, item.values.byte_offset.0, size, size, n).ok_or_else(does_not_fit)?;
        let mut indices = vec![0; n];
        decode_integers(at, component, 1, &mut indices);
        if indices.iter().any(|&i| i as usize >= count) {
            return Err(invalid("it replaces an element that does not exist"));
        }
        Ok(Sparse { indices, values })
    }

    /// The elements as floats; normalised integers become −1…1 or 0…1, others keep their value.
    ///
    /// `T` is a plain type of as many `f32` as an element has numbers (see [`Shape::width`]);
    /// with any other, the elements run together.
    pub(super) fn floats<T: Pod>(&self) -> Vec<T> {
        let width = self.shape.width();
        let mut out = vec![T::zeroed(); self.count * width * 4 / size_of::<T>().max(1)];
        let flat: &mut [f32] = bytemuck::cast_slice_mut(&mut out);
        if let Some(base) = self.base {
            decode_floats(base, self.component, self.normalized, width, flat);
        }
        if let Some(sparse) = &self.sparse {
            let mut values = vec![0.0; sparse.indices.len() * width];
            decode_floats(sparse.values, self.component, self.normalized, width, &mut values);
            replace(flat, &values, &sparse.indices, width);
        }
        out
    }

    /// The elements as whole numbers, or `None` if the file has floats or signed numbers.
    pub(super) fn integers(&self) -> Option<Vec<u32>> {
        if !matches!(self.component, Component::U8 | Component::U16 | Component::U32) {
            return None;
        }
        let width = self.shape.width();
        let mut out = vec![0; self.count * width];
        if let Some(base) = self.base {
            decode_integers(base, self.component, width, &mut out);
        }
        if let Some(sparse) = &self.sparse {
            let mut values = vec![0; sparse.indices.len() * width];
            decode_integers(sparse.values, self.component, width, &mut values);
            replace(&mut out, &values, &sparse.indices, width);
        }
        Some(out)
    }
}

fn replace<T: Copy>(out: &mut [T], values: &[T], indices: &[u32], width: usize) {
    for (&index, value) in indices.iter().zip(values.chunks_exact(width)) {
        let start = index as usize * width;
        if let Some(element) = out.get_mut(start..start + width) {
            element.copy_from_slice(value);
        }
    }
}

fn decode_floats(
    from: Elements,
    component: Component,
    normalized: bool,
    width: usize,
    out: &mut [f32],
) {
    // Normalised values by glTF 2.0, 3.11.
    match (component, normalized) {
        (Component::F32, _) => convert(from, width, out, f32::from_le_bytes),
        (Component::U8, true) => {
            convert(from, width, out, |b| f32::from(u8::from_le_bytes(b)) / 255.0);
        }
        (Component::U16, true) => {
            convert(from, width, out, |b| f32::from(u16::from_le_bytes(b)) / 65_535.0);
        }
        (Component::I8, true) => {
            convert(from, width, out, |b| (f32::from(i8::from_le_bytes(b)) / 127.0).max(-1.0));
        }
        (Component::I16, true) => {
            convert(from, width, out, |b| (f32::from(i16::from_le_bytes(b)) / 32_767.0).max(-1.0));
        }
        (Component::U8, false) => convert(from, width, out, |b| f32::from(u8::from_le_bytes(b))),
        (Component::U16, false) => convert(from, width, out, |b| f32::from(u16::from_le_bytes(b))),
        (Component::I8, false) => convert(from, width, out, |b| f32::from(i8::from_le_bytes(b))),
        (Component::I16, false) => convert(from, width, out, |b| f32::from(i16::from_le_bytes(b))),
        (Component::U32, normalized) => {
            let scale = if normalized { f64::from(u32::MAX).recip() } else { 1.0 };
            convert(from, width, out, |b| (f64::from(u32::from_le_bytes(b)) * scale) as f32);
        }
    }
}

fn decode_integers(from: Elements, component: Component, width: usize, out: &mut [u32]) {
    match component {
        Component::U8 => convert(from, width, out, |b| u32::from(u8::from_le_bytes(b))),
        Component::U16 => convert(from, width, out, |b| u32::from(u16::from_le_bytes(b))),
        Component::U32 => convert(from, width, out, u32::from_le_bytes),
        Component::I8 | Component::I16 | Component::F32 => {}
    }
}

/// Converts `width` numbers of `SIZE` bytes per element. Packed data takes the loop that
/// compiles to a plain copy.
fn convert<const SIZE: usize, T>(
    from: Elements,
    width: usize,
    out: &mut [T],
    number: impl Fn([u8; SIZE]) -> T,
) {
    if from.stride == SIZE * width {
        for (to, bytes) in out.iter_mut().zip(from.bytes.as_chunks().0) {
            *to = number(*bytes);
        }
        return;
    }
    for (element, bytes) in out.chunks_exact_mut(width).zip(from.bytes.chunks(from.stride)) {
        for (to, bytes) in element.iter_mut().zip(bytes.as_chunks().0) {
            *to = number(*bytes);
        }
    }
}
