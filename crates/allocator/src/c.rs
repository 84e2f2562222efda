//! The memory of libraries in C, on glibc.
//!
//! HDF5 asks the C library for memory by itself, and may crash where there is none. The three functions below take the
//! place of those of the C library and pass every call on to it, so that such a request ends the program as well.

use std::ffi::c_void;

use super::given;

unsafe extern "C" {
    fn __libc_malloc(size: usize) -> *mut c_void;
    fn __libc_calloc(n_items: usize, size: usize) -> *mut c_void;
    fn __libc_realloc(block: *mut c_void, size: usize) -> *mut c_void;
}

/// See malloc(3).
///
/// # Safety
///
/// As malloc(3).
#[unsafe(no_mangle)]
pub unsafe extern "C" fn malloc(size: usize) -> *mut c_void {
    // SAFETY: the C library's own function, as it was called.
    given(unsafe { __libc_malloc(size) }.cast(), size).cast()
}

/// See calloc(3).
///
/// # Safety
///
/// As calloc(3).
#[unsafe(no_mangle)]
pub unsafe extern "C" fn calloc(n_items: usize, size: usize) -> *mut c_void {
    // SAFETY: as above.
    given(
        unsafe { __libc_calloc(n_items, size) }.cast(),
        n_items.saturating_mul(size),
    )
    .cast()
}

/// See realloc(3).
///
/// # Safety
///
/// As realloc(3).
#[unsafe(no_mangle)]
pub unsafe extern "C" fn realloc(block: *mut c_void, size: usize) -> *mut c_void {
    // SAFETY: as above.
    let block = unsafe { __libc_realloc(block, size) };
    // Of size 0 it frees the block and returns nothing.
    if size == 0 {
        block
    } else {
        given(block.cast(), size).cast()
    }
}
