//! Fields that are known in a region alone: NaN outside, and there without a place in the file.
//!
//! A data set has chunks of [`ROWS`] rows, shuffled and deflated. A chunk without a row of the region is not allocated:
//! readers find the fill value, NaN. In the other chunks rows outside are NaN as well, of which deflate leaves little,
//! so that the size follows the region in any order of the nodes. Plain HDF5 reads it.

use hdf5::{Dataset, Group, H5Type};

use crate::checksum::{Element, below, checksum, write_checksum};
use crate::storage::{Compression, Precision};

/// Rows of a chunk: few enough that a region leaves chunks out, enough for the filters.
const ROWS: usize = 1024;

/// Writes an array over points or cells, `[n_rows][n]` or `[n_rows]`, with its checksum.
pub(crate) fn write(
    file: &Group,
    path: &str,
    (shape, values): (&[usize], &[f64]),
    precision: Precision,
    compression: Compression,
) -> hdf5::Result<()> {
    // One NaN for all, so that what is written and what is filled in have the same bits.
    match precision {
        Precision::F64 => {
            let values: Vec<f64> = values
                .iter()
                .map(|&v| if v.is_nan() { f64::NAN } else { v })
                .collect();
            write_as(file, path, (shape, &values), f64::NAN, compression)
        }
        Precision::F32 => {
            let round = |&v: &f64| if v.is_nan() { f32::NAN } else { v as f32 };
            let values: Vec<f32> = values.iter().map(round).collect();
            write_as(file, path, (shape, &values), f32::NAN, compression)
        }
    }
}

/// The same in the format of the fill value.
fn write_as<T: Element + Into<hdf5::types::OwnedDynValue> + Into<f64>>(
    file: &Group,
    path: &str,
    (shape, values): (&[usize], &[T]),
    fill: T,
    compression: Compression,
) -> hdf5::Result<()> {
    let mut chunk = shape.to_vec();
    chunk[0] = ROWS.min(shape[0]).max(1);
    let builder = file.new_dataset::<T>().obj_track_times(false).fill_value(fill);
    let mut builder = builder.chunk(chunk);
    if let Compression::Deflate(level) = compression {
        builder = builder.shuffle().deflate(level.clamp(1, 9));
    }
    let dataset = builder.shape(shape).create(below(path))?;
    // Rows of a vector, a tensor, and of the tensors of the elements that there are.
    match shape {
        [_] => write_known(values, 1, |rows, chunk| {
            dataset.write_slice::<_, T, _, _>(chunk, rows)
        })?,
        [_, 3] => write_rows::<T, 3>(&dataset, values)?,
        [_, 6] => write_rows::<T, 6>(&dataset, values)?,
        [_, 24] => write_rows::<T, 24>(&dataset, values)?,
        [_, 48] => write_rows::<T, 48>(&dataset, values)?,
        [_, 162] => write_rows::<T, 162>(&dataset, values)?,
        _ => dataset.write_raw(values)?,
    }
    write_checksum(&dataset, checksum(path, shape, values))
}

fn write_rows<T: Element + Into<f64>, const N: usize>(dataset: &Dataset, values: &[T]) -> hdf5::Result<()> {
    write_known(values, N, |rows, chunk| {
        dataset.write_slice::<_, T, _, _>(chunk.as_chunks::<N>().0, (rows, ..))
    })
}

/// Hands on the chunks of rows of `n` numbers that are not all NaN.
fn write_known<T: H5Type + Copy + Into<f64>>(
    values: &[T],
    n: usize,
    write: impl Fn(std::ops::Range<usize>, &[T]) -> hdf5::Result<()>,
) -> hdf5::Result<()> {
    for (i, chunk) in values.chunks(ROWS * n).enumerate() {
        let is_known = |&value: &T| !Into::<f64>::into(value).is_nan();
        if chunk.iter().any(is_known) {
            write(i * ROWS..i * ROWS + chunk.len() / n, chunk)?;
        }
    }
    Ok(())
}
