//! The system's memory allocator, which ends the program with a message and an exit code where there is no more memory.
//!
//! Without it, an allocation that fails aborts the process, which tells a user nothing. Files are whole at any instant,
//! so that a run can end here. Code that could do with less memory is not asked. So [`end_when_empty`] is for a program
//! that runs alone, not for ranks, which agree on such a failure. On glibc this holds for libraries in C as well.

#[cfg(all(target_os = "linux", target_env = "gnu", not(target_feature = "crt-static")))]
mod c;

use std::alloc::{GlobalAlloc, Layout, System};
use std::io::Write;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::time::Duration;

use rustix::process::{Resource, getrlimit};

/// Exit code of a wrong set-up.
const USER: i32 = 2;
const MB: u64 = 1_000_000;

/// Whether an allocation that fails ends the program.
static ENDS: AtomicBool = AtomicBool::new(false);
/// Whether a thread says so already.
static SAID: AtomicBool = AtomicBool::new(false);
/// What the run needs by its forecast, bytes; 0 is not known.
static FORECAST: AtomicU64 = AtomicU64::new(0);

/// The allocator.
pub struct Ending;

/// From now on an allocation that fails ends the program.
pub fn end_when_empty() {
    ENDS.store(true, Ordering::Relaxed);
}

/// Tells what the run needs by its forecast, bytes, for the message.
pub fn expect(bytes: u64) {
    FORECAST.store(bytes, Ordering::Relaxed);
}

// SAFETY: every call goes to the system's allocator as it came, and its block comes back as it is.
unsafe impl GlobalAlloc for Ending {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        // SAFETY: the caller keeps the rules of this very function.
        given(unsafe { System.alloc(layout) }, layout.size())
    }

    unsafe fn alloc_zeroed(&self, layout: Layout) -> *mut u8 {
        // SAFETY: as above.
        given(unsafe { System.alloc_zeroed(layout) }, layout.size())
    }

    unsafe fn realloc(&self, block: *mut u8, layout: Layout, size: usize) -> *mut u8 {
        // SAFETY: as above.
        given(unsafe { System.realloc(block, layout, size) }, size)
    }

    unsafe fn dealloc(&self, block: *mut u8, layout: Layout) {
        // SAFETY: as above.
        unsafe { System.dealloc(block, layout) }
    }
}

fn given(block: *mut u8, size: usize) -> *mut u8 {
    if block.is_null() && ENDS.load(Ordering::Relaxed) {
        end(size);
    }
    block
}

/// Says that `size` bytes are not to be had, and ends the process at once; nothing here allocates.
#[cold]
fn end(size: usize) -> ! {
    if SAID.swap(true, Ordering::Relaxed) {
        // Another thread is about to end the process.
        loop {
            std::thread::sleep(Duration::from_secs(1));
        }
    }
    let mut line = [0; 512];
    let mut rest = &mut line[..];
    let limit = getrlimit(Resource::As).current;
    // A line that does not fit is cut.
    let _ = write_message(&mut rest, size as u64, limit, FORECAST.load(Ordering::Relaxed));
    let left = rest.len();
    let _ = std::io::stderr().write_all(&line[..line.len() - left]);
    signal_hook::low_level::exit(USER)
}

fn write_message(out: &mut impl Write, size: u64, limit: Option<u64>, forecast: u64) -> std::io::Result<()> {
    write!(out, "error: out of memory: {size} bytes more are not to be had")?;
    match limit.map(|bytes| bytes / MB) {
        Some(limit) => write!(out, ", the address space is limited to {limit} MB (ulimit -v)")?,
        None => write!(out, ", the system has no more")?,
    }
    match forecast / MB {
        0 => write!(out, "; raceway check says what a run needs")?,
        need => write!(
            out,
            "; the run needs about {need} MB by its forecast, and some to spare"
        )?,
    }
    writeln!(
        out,
        "; use a coarser mesh, fewer --threads or more memory, what was saved is whole"
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Wrong: the last words of a run would not say what a user can do.
    #[test]
    fn the_message_says_limit_forecast_and_remedy() {
        let text = |limit, forecast| {
            let mut out = Vec::new();
            write_message(&mut out, 64, limit, forecast).unwrap();
            String::from_utf8(out).unwrap()
        };
        assert_eq!(
            text(Some(400_000_000), 344_000_000),
            "error: out of memory: 64 bytes more are not to be had, the address space is limited to 400 MB (ulimit \
             -v); the run needs about 344 MB by its forecast, and some to spare; use a coarser mesh, fewer --threads \
             or more memory, what was saved is whole\n"
        );
        let text = text(None, 0);
        assert!(
            text.contains(
                ", the system has no more; raceway check says what a run needs; use a coarser mesh"
            ),
            "{text}"
        );
    }
}
