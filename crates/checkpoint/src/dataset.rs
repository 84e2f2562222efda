//! Data sets with checksums, and the frame of a VTKHDF file.
//!
//! A data set is named by its absolute path in the file, which also enters its checksum. In a file of many steps
//! (see [`crate::pack`]) the path starts at the group of its step. Time stamps are off, so that equal content gives
//! equal files.

use std::path::Path;

use hdf5::dataset::Layout;
use hdf5::types::{FixedAscii, FloatSize, TypeDescriptor, VarLenUnicode};
use hdf5::{Dataset, File, Group, Location};

use crate::checksum::{CHECKSUM_ATTRIBUTE, Element, below, checksum, write_checksum};
use crate::error::CheckpointError;
use crate::field::{Field, IN_REGION, VECTOR};
use crate::region;
use crate::regular::open_regular;
use crate::storage::{Coding, Compression, ErrorBound, Precision};

/// Size of a compressed chunk, bytes: large enough for the filters, small enough for their caches.
const CHUNK_BYTES: usize = 1 << 18;
/// Level of deflate for what is compressed in any case, where the scene asks for no other. Of rounded stress, level 2
/// of zlib-ng makes 5 % less than level 1 of zlib in half the time; level 1 of zlib-ng makes 29 % more.
const ROUNDED_LEVEL: u8 = if cfg!(feature = "static-hdf5") { 2 } else { 1 };
/// Attribute of such an array: the bound, Pa.
const ERROR_BOUND: &str = "error_bound";
/// A field that has a value at every point.
const DISPLACEMENT: &str = "/VTKHDF/PointData/displacement";
/// Rows of a chunk of vectors that are mostly zero: more than most bearings have balls. An index of chunks takes 2.6
/// kB, so fewer rows are stored as others are.
const SPARSE_ROWS: usize = 128;
/// Bytes of the longest row: a cell with 27 tensors.
const MOST_OF_ROW: u64 = 27 * 6 * 8;
/// Bytes that a byte of deflated data can stand for at most (zlib, "Technical Details": 1032).
const MOST_DEFLATED: u64 = 1032;

/// Creates the groups and attributes of a VTKHDF unstructured grid of the given version.
///
/// `Type` must be a fixed-length ASCII attribute; VTK refuses other strings.
pub(crate) fn create_vtkhdf(file: &Group, version: [i64; 2]) -> hdf5::Result<()> {
    let root = create_group(file, "VTKHDF")?;
    root.new_attr::<i64>()
        .shape(2)
        .create("Version")?
        .write_raw(&version)?;
    let kind = FixedAscii::<16>::from_ascii("UnstructuredGrid").map_err(|e| e.to_string())?;
    root.new_attr::<FixedAscii<16>>()
        .create("Type")?
        .write_scalar(&kind)?;
    create_group(&root, "CellData")?;
    create_group(&root, "PointData")?;
    Ok(())
}

/// Creates a group without time stamps.
pub(crate) fn create_group(parent: &Group, name: &str) -> hdf5::Result<Group> {
    parent.create_group_builder().obj_track_times(false).create(name)
}

/// Links the mesh of `mesh.hdf` into a VTKHDF file of the same folder.
pub(crate) fn link_mesh(file: &File, mesh_file: &str) -> hdf5::Result<()> {
    let mesh = [
        "NumberOfPoints",
        "NumberOfCells",
        "NumberOfConnectivityIds",
        "Points",
        "Connectivity",
    ];
    let cells = ["Offsets", "Types", "CellData/body", "CellData/radius"];
    for name in mesh.iter().chain(&cells) {
        let path = format!("/VTKHDF/{name}");
        file.link_external(mesh_file, &path, &path)?;
    }
    Ok(())
}

/// Writes a row-major array with its checksum.
pub(crate) fn write_array<T: Element>(
    file: &Group,
    path: &str,
    shape: &[usize],
    values: &[T],
    compression: Compression,
) -> hdf5::Result<()> {
    let mut builder = file.new_dataset::<T>().obj_track_times(false);
    if let (Compression::Deflate(level), false) = (compression, values.is_empty()) {
        let row_bytes = size_of::<T>() * shape[1..].iter().product::<usize>();
        let mut chunk = shape.to_vec();
        chunk[0] = (CHUNK_BYTES / row_bytes).clamp(1, shape[0]);
        builder = builder.chunk(chunk).shuffle().deflate(level.clamp(1, 9));
    }
    let dataset = builder.shape(shape).create(below(path))?;
    dataset.write_raw(values)?;
    write_checksum(&dataset, checksum(path, shape, values))
}

/// Writes an array over points or cells, `[n_rows][n_components]` or `[n_rows]` for one component.
pub(crate) fn write_field(
    file: &Group,
    path: &str,
    field: &Field<'_>,
    compression: Compression,
) -> hdf5::Result<()> {
    let rows = field.values.len() / field.n_components;
    let shape = match field.n_components {
        1 => vec![rows],
        n => vec![rows, n],
    };
    match field.coding {
        Coding::Full(precision) => write_values(file, path, &shape, field.values, precision, compression),
        Coding::Packed(precision) => {
            write_values(file, path, &shape, field.values, precision, packed(compression))
        }
        Coding::Rounded(precision, bound) => {
            let rounded = bound.round(field.values);
            write_values(file, path, &shape, &rounded, precision, packed(compression))?;
            write_bound(file, path, bound)
        }
        Coding::Region(precision, bound) => {
            let rounded = bound.map(|bound| bound.round(field.values));
            let values = rounded.as_deref().unwrap_or(field.values);
            region::write(file, path, (&shape, values), precision, packed(compression))?;
            bound.map_or(Ok(()), |bound| write_bound(file, path, bound))
        }
        Coding::MostlyZero if rows <= SPARSE_ROWS => {
            write_values(file, path, &shape, field.values, Precision::F64, compression)
        }
        Coding::MostlyZero => write_mostly_zero(file, path, field.values.as_chunks::<VECTOR>().0),
    }
}

/// The level of what is compressed in any case.
fn packed(compression: Compression) -> Compression {
    match compression {
        Compression::None => Compression::Deflate(ROUNDED_LEVEL),
        chosen => chosen,
    }
}

fn write_bound(file: &Group, path: &str, bound: ErrorBound) -> hdf5::Result<()> {
    let bound_of = file.dataset(below(path))?.new_attr::<f64>();
    bound_of.create(ERROR_BOUND)?.write_scalar(&bound.bound())
}

pub(crate) fn write_values(
    file: &Group,
    path: &str,
    shape: &[usize],
    values: &[f64],
    precision: Precision,
    compression: Compression,
) -> hdf5::Result<()> {
    match precision {
        Precision::F64 => write_array(file, path, shape, values, compression),
        Precision::F32 => {
            let rounded: Vec<f32> = values.iter().map(|&value| value as f32).collect();
            write_array(file, path, shape, &rounded, compression)
        }
    }
}

/// Writes vectors with their checksum. Chunks in which every bit is zero are not allocated: readers find the fill value
/// there, which is zero.
fn write_mostly_zero(file: &Group, path: &str, vectors: &[[f64; VECTOR]]) -> hdf5::Result<()> {
    let shape = [vectors.len(), VECTOR];
    let builder = file.new_dataset::<f64>().obj_track_times(false);
    let builder = builder.chunk([SPARSE_ROWS, VECTOR]);
    let dataset = builder.shape(shape).create(below(path))?;
    for (i, chunk) in vectors.chunks(SPARSE_ROWS).enumerate() {
        let first = i * SPARSE_ROWS;
        if chunk.as_flattened().iter().any(|value| value.to_bits() != 0) {
            dataset.write_slice::<_, f64, _, _>(chunk, (first..first + chunk.len(), ..))?;
        }
    }
    write_checksum(&dataset, checksum(path, &shape, vectors.as_flattened()))
}

/// Writes a text as an attribute of its group or data set, with its checksum beside it. As a data set it would cost 2
/// ms: the library fills megabytes of buffers to write one string. HDF5 ends texts at a NUL, so there must be none.
pub(crate) fn write_text(file: &Group, path: &str, text: &str) -> hdf5::Result<()> {
    let value: VarLenUnicode = text.parse().map_err(|e| format!("{path}: {e}"))?;
    let (owner, name) = owner_and_name(path);
    let owner = object(file, owner)?;
    owner
        .new_attr::<VarLenUnicode>()
        .create(name)?
        .write_scalar(&value)?;
    let crc = checksum(path, &[text.len()], text.as_bytes());
    owner
        .new_attr::<u32>()
        .create(&*format!("{name}_{CHECKSUM_ATTRIBUTE}"))?
        .write_scalar(&crc)
}

/// A group or a data set.
fn object(file: &Group, path: &str) -> hdf5::Result<Location> {
    match file.group(below(path)) {
        Ok(group) => Ok((*group).clone()),
        Err(_) => file.dataset(below(path)).map(|dataset| (**dataset).clone()),
    }
}

fn owner_and_name(path: &str) -> (&str, &str) {
    path.rsplit_once('/').expect("texts are named by absolute paths")
}

/// A file open for reading; every value it returns has passed its checksum.
pub(crate) struct CheckedFile<'a> {
    path: &'a Path,
    /// Bytes of the file: no array can have more.
    length: u64,
    /// The group at which paths start.
    file: Group,
}

impl<'a> CheckedFile<'a> {
    /// Opens `path`.
    pub fn open(path: &'a Path) -> Result<Self, CheckpointError> {
        CheckedFile::open_at(path, "/")
    }

    /// Opens `path` with the group `root` as the start of all paths.
    pub fn open_at(path: &'a Path, root: &str) -> Result<Self, CheckpointError> {
        // The library's own words for a missing or forbidden file are less clear than the system's.
        let plain = open_regular(path)?;
        let length = plain.metadata().map_err(CheckpointError::io("read", path))?.len();
        let file = File::open(path).and_then(|file| file.group(root));
        let file = file.map_err(CheckpointError::hdf("read", path))?;
        Ok(CheckedFile { path, length, file })
    }

    /// True when the file has this data set.
    pub fn has(&self, dataset: &str) -> bool {
        self.file.link_exists(below(dataset))
    }

    /// Names in a group, sorted.
    pub fn members(&self, group: &str) -> Result<Vec<String>, CheckpointError> {
        let read = || self.file.group(below(group))?.member_names();
        let mut names = read().map_err(CheckpointError::hdf("read", self.path))?;
        names.sort();
        Ok(names)
    }

    /// Names of the texts of a group, sorted.
    pub fn texts(&self, group: &str) -> Result<Vec<String>, CheckpointError> {
        let read = || self.file.group(below(group))?.attr_names();
        let mut names = read().map_err(CheckpointError::hdf("read", self.path))?;
        let checksums = format!("_{CHECKSUM_ATTRIBUTE}");
        names.retain(|name| !name.ends_with(&checksums));
        names.sort();
        Ok(names)
    }

    /// Shape and row-major values.
    pub fn array<T: Element>(&self, dataset: &str) -> Result<(Vec<usize>, Vec<T>), CheckpointError> {
        let open = || self.file.dataset(below(dataset));
        let stored = open().map_err(CheckpointError::hdf("read", self.path))?;
        self.require_size(dataset, &stored)?;
        let read = || Ok((stored.shape(), stored.read_raw::<T>()?, read_checksum(&stored)?));
        let (shape, values, expected) = read().map_err(CheckpointError::hdf("read", self.path))?;
        self.compare(dataset, expected, checksum(dataset, &shape, &values))?;
        Ok((shape, values))
    }

    /// Fails unless a data set has the size that its bytes in the file can have, before memory is taken for it.
    fn require_size(&self, dataset: &str, stored: &Dataset) -> Result<(), CheckpointError> {
        let hdf = CheckpointError::hdf("read", self.path);
        let element = stored.dtype().map_err(hdf)?.size() as u64;
        let bytes_of = |shape: &[usize]| {
            let rows = shape
                .iter()
                .try_fold(element, |n, &extent| n.checked_mul(extent as u64));
            rows.filter(|_| !shape.is_empty())
        };
        let (shape, in_file) = (stored.shape(), stored.storage_size());
        let bytes = bytes_of(&shape);
        // A chunk is unpacked as a whole.
        let chunk = stored.chunk().map_or(Some(0), |chunk| bytes_of(&chunk));
        let is_sparse = stored.is_chunked() && bytes.is_some_and(|bytes| bytes > in_file);
        let most = match stored.filters().is_empty() {
            // Zeros are not in the file; displacement, which all steps have in full, has as many rows.
            true if is_sparse => self.most_sparse(dataset)?,
            true => in_file,
            false => self.most_packed(dataset, in_file.saturating_mul(MOST_DEFLATED))?,
        };
        let fits = in_file <= self.length
            && bytes.is_some_and(|bytes| {
                bytes <= most && chunk.is_some_and(|chunk| chunk <= bytes.max(CHUNK_BYTES as u64))
            });
        if fits {
            return Ok(());
        }
        let what = format!(
            "data set {dataset} has shape {shape:?}, which its {in_file} bytes of {} in the file cannot hold",
            self.length
        );
        Err(CheckpointError::malformed(self.path, what))
    }

    /// Bytes that compressed data can have: those that are in the file, unpacked, or a row for each of a region.
    fn most_packed(&self, dataset: &str, unpacked: u64) -> Result<u64, CheckpointError> {
        let mask = mask_of(dataset);
        match mask != dataset && self.has(&mask) {
            true => Ok(unpacked.max(self.most_of_region(&mask)?)),
            false => Ok(unpacked),
        }
    }

    /// Bytes that a field over a region can have, by the rows of its mask.
    fn most_of_region(&self, mask: &str) -> Result<u64, CheckpointError> {
        Ok((self.shape(mask)?[0] as u64).saturating_mul(MOST_OF_ROW))
    }

    /// Bytes that vectors of which most are zero can have: those of a displacement in f64, or a row for each of a
    /// region.
    fn most_sparse(&self, dataset: &str) -> Result<u64, CheckpointError> {
        let mask = mask_of(dataset);
        if self.has(&mask) {
            return self.most_of_region(&mask);
        }
        let dense = |stored: &Dataset| !(stored.is_chunked() && stored.filters().is_empty());
        let stored = self.file.dataset(below(DISPLACEMENT));
        let stored = stored.ok().filter(dense).ok_or_else(|| {
            let what = format!("data set {dataset} is sparse beside no {DISPLACEMENT} that is not");
            CheckpointError::malformed(self.path, what)
        })?;
        self.require_size(DISPLACEMENT, &stored)?;
        Ok((stored.size() * size_of::<f64>()) as u64)
    }

    /// Bound of the errors of an array; None where it was written as it was.
    pub fn error_bound(&self, dataset: &str) -> Result<Option<ErrorBound>, CheckpointError> {
        let read = || {
            let stored = self.file.dataset(below(dataset))?;
            match stored.attr_names()?.iter().any(|name| name == ERROR_BOUND) {
                true => stored.attr(ERROR_BOUND)?.read_scalar::<f64>().map(Some),
                false => Ok(None),
            }
        };
        let bound = read().map_err(CheckpointError::hdf("read", self.path))?;
        match bound.map(|bound| (bound, ErrorBound::new(bound))) {
            None => Ok(None),
            Some((_, Some(bound))) => Ok(Some(bound)),
            Some((bound, None)) => Err(CheckpointError::malformed(
                self.path,
                format!("data set {dataset} has the error bound {bound}, expected a positive number"),
            )),
        }
    }

    /// Shape and row-major values of a floating-point array of either precision.
    pub fn field(&self, dataset: &str) -> Result<(Vec<usize>, Vec<f64>), CheckpointError> {
        match self.precision(dataset)? {
            Precision::F64 => self.array::<f64>(dataset),
            Precision::F32 => {
                let (shape, values) = self.array::<f32>(dataset)?;
                Ok((shape, values.into_iter().map(f64::from).collect()))
            }
        }
    }

    /// Precision of a floating-point array.
    pub fn precision(&self, dataset: &str) -> Result<Precision, CheckpointError> {
        match self.descriptor(dataset)? {
            TypeDescriptor::Float(FloatSize::U4) => Ok(Precision::F32),
            TypeDescriptor::Float(FloatSize::U8) => Ok(Precision::F64),
            other => {
                let what = format!("data set {dataset} holds {other}, expected floating-point numbers");
                Err(CheckpointError::malformed(self.path, what))
            }
        }
    }

    /// How an array is compressed.
    pub fn compression(&self, dataset: &str) -> Result<Compression, CheckpointError> {
        let read = || Ok(self.file.dataset(below(dataset))?.filters());
        let filters = read().map_err(CheckpointError::hdf("read", self.path))?;
        let level = filters.iter().find_map(|filter| match filter {
            hdf5::filters::Filter::Deflate(level) => Some(*level),
            _ => None,
        });
        Ok(level.map_or(Compression::None, Compression::Deflate))
    }

    /// Type of the elements.
    pub fn descriptor(&self, dataset: &str) -> Result<TypeDescriptor, CheckpointError> {
        let read = || self.file.dataset(below(dataset))?.dtype()?.to_descriptor();
        read().map_err(CheckpointError::hdf("read", self.path))
    }

    /// Shape, without reading the values; at least one extent.
    pub fn shape(&self, dataset: &str) -> Result<Vec<usize>, CheckpointError> {
        let stored = self.file.dataset(below(dataset));
        let stored = stored.map_err(CheckpointError::hdf("read", self.path))?;
        self.require_size(dataset, &stored)?;
        Ok(stored.shape())
    }

    /// Shape of a data set that is only listed. One that shows those of other files has no bytes of its own.
    pub fn listed_shape(&self, dataset: &str) -> Result<Vec<usize>, CheckpointError> {
        let stored = self.file.dataset(below(dataset));
        let stored = stored.map_err(CheckpointError::hdf("read", self.path))?;
        match stored.layout() {
            Layout::Virtual => Ok(stored.shape()),
            _ => self.shape(dataset),
        }
    }

    /// The only value of a data set with one element.
    pub fn scalar<T: Element>(&self, dataset: &str) -> Result<T, CheckpointError> {
        let (_, values) = self.array::<T>(dataset)?;
        match values[..] {
            [value] => Ok(value),
            _ => {
                let what = format!("data set {dataset} has {} values, expected one", values.len());
                Err(CheckpointError::malformed(self.path, what))
            }
        }
    }

    /// A text.
    pub fn text(&self, path: &str) -> Result<String, CheckpointError> {
        let read = || {
            let (owner, name) = owner_and_name(path);
            let owner = object(&self.file, owner)?;
            let text: VarLenUnicode = owner.attr(name)?.read_scalar()?;
            let crc: u32 = owner
                .attr(&format!("{name}_{CHECKSUM_ATTRIBUTE}"))?
                .read_scalar()?;
            Ok((text.as_bytes().to_vec(), crc))
        };
        let (bytes, expected) = read().map_err(CheckpointError::hdf("read", self.path))?;
        self.compare(path, expected, checksum(path, &[bytes.len()], &bytes))?;
        String::from_utf8(bytes)
            .map_err(|_| CheckpointError::malformed(self.path, format!("text {path} is not UTF-8 text")))
    }

    /// Whether there is such a text.
    pub fn has_text(&self, path: &str) -> Result<bool, CheckpointError> {
        let (owner, name) = owner_and_name(path);
        Ok(self.texts(owner)?.iter().any(|text| text == name))
    }

    fn compare(&self, dataset: &str, expected: u32, found: u32) -> Result<(), CheckpointError> {
        if expected == found {
            return Ok(());
        }
        let (path, dataset) = (self.path.to_path_buf(), dataset.to_string());
        Err(CheckpointError::Damaged {
            path,
            dataset,
            expected,
            found,
        })
    }
}

/// Path of the mask of the region that a field over points or cells may be kept in.
fn mask_of(dataset: &str) -> String {
    format!("{}/{IN_REGION}", owner_and_name(dataset).0)
}

fn read_checksum(dataset: &Dataset) -> hdf5::Result<u32> {
    dataset.attr(CHECKSUM_ATTRIBUTE)?.read_scalar()
}
