//! The checksum of a data set: CRC-32 of its name, element type, shape and values.
//!
//! CRC-32 (ISO 3309, the polynomial of Ethernet and gzip) finds every single error burst of up to 32 bits and
//! misses other damage with probability 2⁻³². Name, type and shape are included because a wrong byte may hit
//! those: an array read back under another name is damage too. Values enter in little-endian order as stored,
//! before compression. Cost: one pass over the data, several GB/s.

use std::fs::File;
use std::io::Read;
use std::path::Path;

use crc32fast::Hasher;

use crate::error::CheckpointError;

/// Name of the attribute that holds the checksum of a data set.
pub const CHECKSUM_ATTRIBUTE: &str = "crc32";

/// Values hashed together; a block stays in the first-level cache.
const BLOCK: usize = 512;

/// An element type the files hold.
pub trait Element: hdf5::H5Type + Copy {
    /// Name of the type in the checksum.
    const TYPE_NAME: &'static str;

    /// Writes the value, little-endian, into `bytes`, which has the size of the type.
    fn store(self, bytes: &mut [u8]);
}

macro_rules! element {
    ($type:ty) => {
        impl Element for $type {
            const TYPE_NAME: &'static str = stringify!($type);

            fn store(self, bytes: &mut [u8]) {
                bytes.copy_from_slice(&self.to_le_bytes());
            }
        }
    };
}
element!(f64);
element!(f32);
element!(i64);
element!(u8);

/// Checksum of the data set at path `name` with the given `shape` and row-major `values`.
pub fn checksum<T: Element>(name: &str, shape: &[usize], values: &[T]) -> u32 {
    let mut hasher = Hasher::new();
    hasher.update(name.as_bytes());
    hasher.update(T::TYPE_NAME.as_bytes());
    for &extent in shape {
        hasher.update(&(extent as u64).to_le_bytes());
    }
    let size = size_of::<T>();
    let mut bytes = vec![0; size * BLOCK];
    for block in values.chunks(BLOCK) {
        let bytes = &mut bytes[..size_of_val(block)];
        for (slot, &value) in bytes.chunks_exact_mut(size).zip(block) {
            value.store(slot);
        }
        hasher.update(bytes);
    }
    hasher.finalize()
}

/// Writes the checksum of a data set beside it.
pub fn write_checksum(dataset: &hdf5::Dataset, value: u32) -> hdf5::Result<()> {
    dataset
        .new_attr::<u32>()
        .create(CHECKSUM_ATTRIBUTE)?
        .write_scalar(&value)
}

/// The path of a data set as HDF5 wants it relative to a group; absolute paths would leave the group.
pub fn below(path: &str) -> &str {
    match path.strip_prefix('/') {
        Some("") => ".",
        Some(rest) => rest,
        None => path,
    }
}

/// Length in bytes and CRC-32 of a whole file of any kind: whether it is still the one it was.
pub fn file_checksum(path: &Path) -> Result<(u64, u32), CheckpointError> {
    let sum = || -> std::io::Result<(u64, u32)> {
        let (mut file, mut hasher) = (File::open(path)?, Hasher::new());
        let (mut block, mut length) = (vec![0; 1 << 18], 0);
        loop {
            match file.read(&mut block)? {
                0 => return Ok((length, hasher.finalize())),
                n => {
                    hasher.update(&block[..n]);
                    length += n as u64;
                }
            }
        }
    };
    sum().map_err(CheckpointError::io("read", path))
}
