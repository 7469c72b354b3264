//! Memory that is held, counted by the allocator itself.

use std::alloc::{GlobalAlloc, Layout, System};
use std::sync::atomic::{AtomicIsize, Ordering};
use std::time::Instant;

struct Counting;

static HELD: AtomicIsize = AtomicIsize::new(0);

// SAFETY: hands every call on to the system allocator.
unsafe impl GlobalAlloc for Counting {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        HELD.fetch_add(layout.size() as isize, Ordering::Relaxed);
        unsafe { System.alloc(layout) }
    }
    unsafe fn dealloc(&self, pointer: *mut u8, layout: Layout) {
        HELD.fetch_sub(layout.size() as isize, Ordering::Relaxed);
        unsafe { System.dealloc(pointer, layout) }
    }
    unsafe fn realloc(&self, pointer: *mut u8, layout: Layout, size: usize) -> *mut u8 {
        let more = size as isize - layout.size() as isize;
        HELD.fetch_add(more, Ordering::Relaxed);
        unsafe { System.realloc(pointer, layout, size) }
    }
}

#[global_allocator]
static ALLOCATOR: Counting = Counting;

/// Bytes on the heap now.
pub fn held() -> isize {
    HELD.load(Ordering::Relaxed)
}

/// What it took to make something, once and for all bodies that share it.
#[derive(Clone, Copy, Debug, Default)]
pub struct Making {
    /// Wall time, s.
    pub seconds: f64,
    /// What is held afterwards.
    pub bytes: isize,
    /// Falls, solutions or forces that were computed for it, here or for the file that is shipped.
    pub samples: usize,
}

impl Making {
    /// Makes it; `samples` counts what was computed for it.
    pub fn of<T, E>(
        make: impl FnOnce() -> Result<T, E>,
        samples: impl FnOnce(&T) -> usize,
    ) -> Result<(T, Self), E> {
        let (before, clock) = (held(), Instant::now());
        let made = make()?;
        let making = Self {
            seconds: clock.elapsed().as_secs_f64(),
            bytes: held() - before,
            samples: samples(&made),
        };
        Ok((made, making))
    }
}
