//! Data in pages that fit a storage binding of WebGPU's default limits.

/// Bytes of a page: `max_storage_buffer_binding_size` of WebGPU's default limits.
pub(crate) const PAGE_BYTES: usize = 128 << 20;

/// A place in a page.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(crate) struct Place {
    pub(crate) page: usize,
    pub(crate) first: u32,
}

/// Elements in pages; what is added together stays in one page.
pub(crate) struct Pages<T> {
    pub(crate) pages: Vec<Vec<T>>,
    capacity: usize,
}

impl<T: Copy> Pages<T> {
    pub(crate) fn new() -> Self {
        Self { pages: Vec::new(), capacity: PAGE_BYTES / size_of::<T>() }
    }

    /// Elements that a page holds.
    pub(crate) fn capacity(&self) -> usize {
        self.capacity
    }

    /// Adds at most [`Self::capacity`] elements.
    pub(crate) fn add(&mut self, items: &[T]) -> Place {
        debug_assert!(items.len() <= self.capacity);
        let fits = self.pages.last().is_some_and(|page| page.len() + items.len() <= self.capacity);
        if !fits {
            self.pages.push(Vec::with_capacity(items.len()));
        }
        let page = self.pages.len() - 1;
        let first = self.pages[page].len() as u32;
        self.pages[page].extend_from_slice(items);
        Place { page, first }
    }

    /// Adds any number of elements, in as many pieces as it takes: (place, count).
    pub(crate) fn add_pieces(&mut self, items: &[T]) -> Vec<(Place, u32)> {
        items.chunks(self.capacity).map(|piece| (self.add(piece), piece.len() as u32)).collect()
    }
}
