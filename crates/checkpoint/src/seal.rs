//! The seal at the end of a file: checksums of its bytes, verified before the HDF5 library sees any of them.
//!
//! The library trusts a file's inner structure: one wrong byte there can crash it or make it ask for absurd amounts
//! of memory (seen with HDF5 1.10.8). So behind the HDF5 content, where the format allows other bytes and every
//! reader ignores them, stand lines of text
//!
//! ```text
//! CRC OFFSET LENGTH PATH     one per contiguous array or compressed chunk
//! CRC 0 LENGTH (structure)   all bytes outside of these arrays
//! CRC 0 LENGTH /             the whole HDF5 content
//! seal LENGTH CRC            of the lines above, fixed width
//! ```
//! The first lines name the data set when the content is damaged. The structure is all that the library itself
//! interprets: it is enough to verify it before names, shapes, times and texts are read from many files. Cost: one
//! pass over the file after it is written (from the system's cache) and one before it is read; the structure is a
//! few kilobytes.

use std::fs::{File, OpenOptions};
use std::io::{self, Read, Seek, SeekFrom, Write};
use std::path::Path;

use crc32fast::Hasher;

use crate::error::CheckpointError;
use crate::regular::open_regular;

/// Length of the last line: `seal`, ten digits, eight hexadecimal digits.
const FOOTER_LENGTH: u64 = 25;
/// Most bytes of a step outside of its arrays, nearly all of them the text of its scene.
const MOST_STRUCTURE: u64 = 64 << 20;
/// A mesh has some arrays that its seal does not tell apart: not more than this part of the file.
const MESH_SHARE: u64 = 4;
/// Bytes read at a time.
const BLOCK: usize = 1 << 18;

/// A piece of a file that holds values of one data set.
#[derive(Debug)]
pub(crate) struct Extent {
    /// Path of the data set.
    pub path: String,
    /// First byte.
    pub offset: u64,
    /// Number of bytes.
    pub length: u64,
}

/// Where the values of a data set lie in its file; an empty one lies nowhere.
pub(crate) fn extents(file: &hdf5::File, path: &str) -> hdf5::Result<Vec<Extent>> {
    let dataset = file.dataset(path)?;
    let extent = |offset, length| Extent {
        path: path.to_string(),
        offset,
        length,
    };
    if let Some(offset) = dataset.offset() {
        return Ok(vec![extent(offset, dataset.storage_size())]);
    }
    let n_chunks = dataset.num_chunks().unwrap_or(0);
    Ok((0..n_chunks)
        .filter_map(|i| dataset.chunk_info(i))
        .map(|chunk| extent(chunk.addr, chunk.size))
        .collect())
}

/// Path that stands for all bytes outside of the arrays.
const STRUCTURE: &str = "(structure)";

/// Appends the seal and brings the file to the disk. The extents do not overlap, so one pass serves them and the
/// whole: the checksum of a sequence follows from those of its parts.
pub(crate) fn append_seal(path: &Path, mut extents: Vec<Extent>) -> io::Result<()> {
    let mut file = OpenOptions::new().read(true).append(true).open(path)?;
    let length = file.metadata()?.len();
    extents.sort_by_key(|extent| extent.offset);
    let (mut table, mut end) = (String::new(), 0);
    let (mut whole, mut structure) = (Hasher::new(), Hasher::new());
    for extent in &extents {
        let gap = hash(&mut file, end, extent.offset - end)?;
        let part = hash(&mut file, extent.offset, extent.length)?;
        structure.combine(&gap);
        whole.combine(&gap);
        whole.combine(&part);
        let crc = part.finalize();
        table += &format!("{crc:08x} {} {} {}\n", extent.offset, extent.length, extent.path);
        end = extent.offset + extent.length;
    }
    let gap = hash(&mut file, end, length - end)?;
    structure.combine(&gap);
    whole.combine(&gap);
    table += &format!("{:08x} 0 {length} {STRUCTURE}\n", structure.finalize());
    table += &format!("{:08x} 0 {length} /\n", whole.finalize());
    let footer = format!(
        "seal {:010} {:08x}\n",
        table.len(),
        crc32fast::hash(table.as_bytes())
    );
    file.write_all(table.as_bytes())?;
    file.write_all(footer.as_bytes())?;
    file.sync_all()
}

/// The seal of a file as read.
struct Seal {
    /// Checksum and place of the arrays, by growing offset.
    arrays: Vec<(u32, Extent)>,
    /// Checksum of all other bytes.
    structure: u32,
    /// Checksum of all bytes.
    whole: u32,
    /// Bytes that are sealed.
    length: u64,
}

/// Fails unless every byte of the file is as it was written; names the damaged data set if it can.
pub(crate) fn verify_seal(path: &Path) -> Result<(), CheckpointError> {
    let (mut file, seal) = open_sealed(path)?;
    let found = hash(&mut file, 0, seal.length).map_err(CheckpointError::io("read", path))?;
    if found.finalize() == seal.whole {
        return Ok(());
    }
    for (expected, extent) in &seal.arrays {
        let found = hash(&mut file, extent.offset, extent.length);
        let found = found.map_err(CheckpointError::io("read", path))?.finalize();
        if found != *expected {
            let (path, dataset, expected) = (path.to_path_buf(), extent.path.clone(), *expected);
            return Err(CheckpointError::Damaged {
                path,
                dataset,
                expected,
                found,
            });
        }
    }
    Err(damaged_structure(path))
}

/// Fails unless everything but the values of the arrays is as it was written: after this the library may open the
/// file, and names, shapes and texts are right. Values have checksums of their own.
pub(crate) fn verify_structure(path: &Path) -> Result<(), CheckpointError> {
    let (mut file, seal) = open_sealed(path)?;
    let mut gaps = || -> io::Result<u32> {
        let (mut structure, mut end) = (Hasher::new(), 0);
        for (_, extent) in &seal.arrays {
            structure.combine(&hash(&mut file, end, extent.offset.saturating_sub(end))?);
            end = extent.offset.saturating_add(extent.length);
        }
        structure.combine(&hash(&mut file, end, seal.length.saturating_sub(end))?);
        Ok(structure.finalize())
    };
    let found = gaps().map_err(CheckpointError::io("read", path))?;
    if found == seal.structure {
        Ok(())
    } else {
        Err(damaged_structure(path))
    }
}

fn damaged_structure(path: &Path) -> CheckpointError {
    CheckpointError::malformed(path, "its bytes differ from those written, outside of its arrays")
}

fn open_sealed(path: &Path) -> Result<(File, Seal), CheckpointError> {
    let mut file = open_regular(path)?;
    let table = read_table(&mut file).map_err(CheckpointError::io("read", path))?;
    match table.as_deref().and_then(parse_table) {
        Some(seal) => {
            require_small_structure(path, &seal)?;
            Ok((file, seal))
        }
        None => Err(CheckpointError::malformed(path, "its seal is missing or damaged")),
    }
}

/// Fails if there is more outside of the arrays than names, shapes and texts can be: the library reads all
/// of that into memory.
fn require_small_structure(path: &Path, seal: &Seal) -> Result<(), CheckpointError> {
    let arrays = seal
        .arrays
        .iter()
        .fold(0, |sum: u64, (_, extent)| sum.saturating_add(extent.length));
    let structure = seal.length.saturating_sub(arrays);
    let most = MOST_STRUCTURE
        .saturating_mul(steps_in(path))
        .max(seal.length / MESH_SHARE);
    if structure <= most {
        return Ok(());
    }
    let what = format!("it has {structure} bytes outside of its arrays, expected at most {most}");
    Err(CheckpointError::malformed(path, what))
}

/// Steps that a file holds by its name: one, or those of a pack.
fn steps_in(path: &Path) -> u64 {
    let name = path.file_stem().unwrap_or_default().to_string_lossy();
    let range = name.strip_prefix("pack_").and_then(|range| range.split_once('_'));
    let ends = range.and_then(|(first, last)| Some((first.parse::<u64>().ok()?, last.parse::<u64>().ok()?)));
    ends.map_or(1, |(first, last)| last.saturating_sub(first).saturating_add(1))
}

/// The lines above the footer, if the footer belongs to them.
fn read_table(file: &mut File) -> io::Result<Option<String>> {
    let length = file.metadata()?.len();
    let Some(footer_start) = length.checked_sub(FOOTER_LENGTH) else {
        return Ok(None);
    };
    let Some((table_length, crc)) = parse_footer(&read_range(file, footer_start, FOOTER_LENGTH)?) else {
        return Ok(None);
    };
    let in_file = footer_start.checked_sub(table_length);
    let Some(table_start) = in_file.filter(|_| table_length <= MOST_STRUCTURE) else {
        return Ok(None);
    };
    let table = read_range(file, table_start, table_length)?;
    if crc32fast::hash(&table) != crc {
        return Ok(None);
    }
    Ok(String::from_utf8(table).ok())
}

fn parse_footer(footer: &[u8]) -> Option<(u64, u32)> {
    let (length, crc) = str::from_utf8(footer)
        .ok()?
        .strip_prefix("seal ")?
        .strip_suffix('\n')?
        .split_once(' ')?;
    Some((length.parse().ok()?, u32::from_str_radix(crc, 16).ok()?))
}

fn parse_table(table: &str) -> Option<Seal> {
    let entry = |line: &str| {
        let mut words = line.splitn(4, ' ');
        let crc = u32::from_str_radix(words.next()?, 16).ok()?;
        let (offset, length) = (words.next()?.parse().ok()?, words.next()?.parse().ok()?);
        let path = words.next()?.to_string();
        Some((crc, Extent { path, offset, length }))
    };
    let mut arrays = table.lines().map(entry).collect::<Option<Vec<_>>>()?;
    let (whole, all) = arrays.pop().filter(|(_, last)| last.path == "/")?;
    let (structure, _) = arrays.pop().filter(|(_, last)| last.path == STRUCTURE)?;
    Some(Seal {
        arrays,
        structure,
        whole,
        length: all.length,
    })
}

fn read_range(file: &mut File, offset: u64, length: u64) -> io::Result<Vec<u8>> {
    file.seek(SeekFrom::Start(offset))?;
    let mut bytes = Vec::new();
    file.take(length).read_to_end(&mut bytes)?;
    Ok(bytes)
}

/// CRC-32 of a range of bytes; a range beyond the end counts what is there.
fn hash(file: &mut File, offset: u64, length: u64) -> io::Result<Hasher> {
    file.seek(SeekFrom::Start(offset))?;
    let mut range = file.take(length);
    let (mut hasher, mut block) = (Hasher::new(), vec![0; BLOCK.min(length as usize)]);
    loop {
        match range.read(&mut block)? {
            0 => return Ok(hasher),
            n => hasher.update(&block[..n]),
        }
    }
}
