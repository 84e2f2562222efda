//! Damaged files are refused, with the file and the data set in the message.

use std::fs;
use std::path::{Path, PathBuf};

use checkpoint::{CheckpointError, FolderLock, Output, Precision, Storage, read_step};

use crate::fixture::{bodies, record};

const EXACT: Storage = Storage {
    stress: Precision::F64,
    stress_error: None,
    displacement: Precision::F64,
    compression: checkpoint::Compression::None,
};

fn one_step(dir: &Path) -> PathBuf {
    Output::create(dir, &bodies(), EXACT)
        .unwrap()
        .write_step(&record(4))
        .unwrap()
}

/// The HDF5 content of a file, without its seal.
fn content(path: &Path) -> Vec<u8> {
    let mut bytes = fs::read(path).unwrap();
    let table_length: usize = str::from_utf8(&bytes[bytes.len() - 20..][..10])
        .unwrap()
        .parse()
        .unwrap();
    bytes.truncate(bytes.len() - 25 - table_length);
    bytes
}

/// Writes `content` with a seal that fits, as if it had been damaged before it was sealed.
fn seal(path: &Path, content: &[u8]) {
    let (crc, length) = (crc32fast::hash(content), content.len());
    let table = format!("{crc:08x} 0 {length} (structure)\n{crc:08x} 0 {length} /\n");
    let footer = format!(
        "seal {:010} {:08x}\n",
        table.len(),
        crc32fast::hash(table.as_bytes())
    );
    fs::write(path, [content, table.as_bytes(), footer.as_bytes()].concat()).unwrap();
}

/// Wrong if the checksums of the data sets themselves were not compared: with a seal that fits, only they can tell.
#[test]
fn a_wrong_value_under_a_good_seal_is_found() {
    let dir = tempfile::tempdir().unwrap();
    let path = one_step(dir.path());
    let mut bytes = content(&path);
    let value = record(4).points.force_outer.unwrap()[3][2].to_le_bytes();
    let at = bytes.windows(8).position(|window| window == value).unwrap();
    seal(&path, &bytes);
    assert_eq!(
        read_step(&path).unwrap(),
        record(4),
        "sealing again must not be damage itself"
    );
    bytes[at] ^= 1;
    seal(&path, &bytes);
    let text = read_step(&path).unwrap_err().to_string();
    assert!(
        text.contains("step_000004.hdf") && text.contains("/VTKHDF/PointData/force_outer"),
        "{text}"
    );
}

/// Wrong if damage inside a compressed array could not be told from damage elsewhere.
#[test]
fn a_wrong_byte_in_a_compressed_field_names_it_too() {
    let dir = tempfile::tempdir().unwrap();
    let storage = Storage {
        compression: checkpoint::Compression::Deflate(1),
        ..EXACT
    };
    let path = Output::create(dir.path(), &bodies(), storage)
        .unwrap()
        .write_step(&record(4))
        .unwrap();
    let (offset, size) = {
        let file = hdf5::File::open(&path).unwrap();
        let chunk = file
            .dataset("/VTKHDF/PointData/stress")
            .unwrap()
            .chunk_info(0)
            .unwrap();
        (chunk.addr as usize, chunk.size as usize)
    };
    let mut bytes = fs::read(&path).unwrap();
    bytes[offset + size / 2] ^= 0x10;
    fs::write(&path, bytes).unwrap();
    let text = read_step(&path).unwrap_err().to_string();
    assert!(text.contains("/VTKHDF/PointData/stress"), "{text}");
}

/// Wrong if a flipped bit in the stored values of a field came back as a result.
#[test]
fn a_wrong_byte_in_a_field_names_file_and_data_set() {
    let dir = tempfile::tempdir().unwrap();
    let path = one_step(dir.path());
    let mut bytes = fs::read(&path).unwrap();
    let value = record(4).points.acceleration.unwrap()[5][1].to_le_bytes();
    let at = bytes.windows(8).position(|window| window == value).unwrap();
    bytes[at] ^= 1;
    fs::write(&path, bytes).unwrap();
    let error = read_step(&path).unwrap_err();
    assert!(matches!(error, CheckpointError::Damaged { .. }), "{error}");
    let text = error.to_string();
    assert!(
        text.contains("step_000004.hdf") && text.contains("/VTKHDF/PointData/acceleration"),
        "{text}"
    );
    assert!(text.contains("use an earlier step"), "{text}");
}

/// Wrong if a wrong byte in some data set were not noticed, or blamed on another one.
#[test]
fn a_wrong_byte_in_each_data_set_names_it() {
    let dir = tempfile::tempdir().unwrap();
    let path = one_step(dir.path());
    let good = fs::read(&path).unwrap();
    let arrays = checkpoint::describe(&path).unwrap().arrays;
    assert_eq!(
        arrays.len(),
        2 + 7 + 2 + record(4).state.len(),
        "time, step, all fields, the state: {arrays:?}"
    );
    for array in &arrays {
        fs::write(&path, &good).unwrap();
        let stored = hdf5::File::open(&path).unwrap().dataset(&array.path).unwrap();
        let at = match stored.is_chunked() {
            true => (array.bytes > 0).then(|| stored.chunk_info(0).unwrap().addr),
            false => stored.offset(),
        };
        // While it is open, the library would not look at the file again.
        drop(stored);
        let Some(at) = at else {
            assert_eq!(array.bytes, 0, "{array:?} lies nowhere");
            continue;
        };
        let mut bad = good.clone();
        bad[at as usize + array.bytes as usize - 1] ^= 0x40;
        fs::write(&path, &bad).unwrap();
        let text = read_step(&path).unwrap_err().to_string();
        assert!(text.contains(&format!("data set {} of", array.path)), "{text}");
        // Number and time are read to be told; of the others it is told that they are damaged.
        let found = match checkpoint::describe(&path) {
            Ok(described) => described.damage.unwrap(),
            Err(error) => error,
        };
        assert!(found.to_string().contains(&array.path), "{found}");
    }
}

/// Wrong if there were bytes in a file whose damage goes unnoticed or crashes the library: names, types, sizes and
/// links count too. Every 13th byte is inverted in turn, and every one of the seal.
#[test]
fn every_wrong_byte_is_noticed() {
    let dir = tempfile::tempdir().unwrap();
    let path = one_step(dir.path());
    let good = fs::read(&path).unwrap();
    for at in (0..good.len()).step_by(13).chain(good.len() - 25..good.len()) {
        let mut bytes = good.clone();
        bytes[at] ^= 0xff;
        fs::write(&path, bytes).unwrap();
        let read = read_step(&path);
        assert!(read.is_err(), "byte {at} of {} is wrong unnoticed", good.len());
    }
    fs::write(&path, good).unwrap();
    assert_eq!(read_step(&path).unwrap(), record(4));
}

/// Wrong if a file cut short by a full or failing disk were read.
#[test]
fn a_truncated_file_is_refused() {
    let dir = tempfile::tempdir().unwrap();
    let path = one_step(dir.path());
    let good = fs::read(&path).unwrap();
    for length in [0, 100, good.len() / 2, good.len() - 1] {
        fs::write(&path, &good[..length]).unwrap();
        let text = read_step(&path).unwrap_err().to_string();
        assert!(text.contains("step_000004.hdf"), "{text}");
    }
}

/// Wrong if a field could vanish from a file and read as a field that was never written.
#[test]
fn a_missing_data_set_is_named() {
    let dir = tempfile::tempdir().unwrap();
    let path = one_step(dir.path());
    fs::write(&path, content(&path)).unwrap();
    hdf5::File::open_rw(&path)
        .unwrap()
        .unlink("/VTKHDF/PointData/velocity")
        .unwrap();
    seal(&path, &fs::read(&path).unwrap());
    let text = read_step(&path).unwrap_err().to_string();
    assert!(
        text.contains("step_000004.hdf") && text.contains("velocity is missing"),
        "{text}"
    );
}

/// Wrong if a missing file gave the library's message instead of the system's.
#[test]
fn a_missing_file_says_so() {
    let text = read_step(Path::new("no/such/step_000000.hdf"))
        .unwrap_err()
        .to_string();
    assert!(
        text.starts_with("cannot read no/such/step_000000.hdf: No such file"),
        "{text}"
    );
}

/// A step file whose content somebody has changed with the library, under a seal that fits.
fn forged(dir: &Path, change: impl FnOnce(&hdf5::File)) -> PathBuf {
    let path = one_step(dir);
    let bytes = content(&path);
    fs::write(&path, bytes).unwrap();
    let file = hdf5::File::open_rw(&path).unwrap();
    change(&file);
    file.close().unwrap();
    seal(&path, &fs::read(&path).unwrap());
    path
}

/// Wrong: a hostile file would make the program ask for terabytes, or stop it in a place of its own.
#[test]
fn a_size_that_the_file_cannot_hold_is_refused_before_memory_is_taken() {
    const TERABYTES: usize = 600_000_000_000;
    let path_of = "VTKHDF/PointData/von_mises";
    let forge = |make: &dyn Fn(&hdf5::File)| {
        let dir = tempfile::tempdir().unwrap();
        let path = forged(dir.path(), |file| {
            file.unlink(path_of).unwrap();
            make(file);
            let von_mises = file.dataset(path_of).unwrap();
            von_mises
                .new_attr::<u32>()
                .create("crc32")
                .unwrap()
                .write_scalar(&0u32)
                .unwrap();
        });
        let read = read_step(&path).unwrap_err().to_string();
        let described = checkpoint::describe(&path).map(|_| ()).unwrap_err().to_string();
        assert_eq!(read, described);
        let index = checkpoint::rebuild_index(dir.path()).unwrap_err().to_string();
        assert!(index.contains("cannot hold"), "{index}");
        read
    };
    let text = forge(&|file| {
        file.new_dataset::<f64>()
            .shape([TERABYTES])
            .create(path_of)
            .unwrap();
    });
    assert!(
        text.contains("/VTKHDF/PointData/von_mises has shape [600000000000], which its 0 bytes of"),
        "{text}"
    );
    let text = forge(&|file| {
        let chunks = file.new_dataset::<f64>().chunk([1 << 20]).deflate(9);
        chunks.shape([TERABYTES]).create(path_of).unwrap();
    });
    assert!(text.contains("cannot hold"), "{text}");
    let text = forge(&|file| {
        file.new_dataset::<f64>()
            .shape(hdf5::Extents::Null)
            .create(path_of)
            .unwrap();
    });
    assert!(text.contains("has shape [], which"), "{text}");
    // Zeros that are not stored: as many as a displacement has, not more.
    let text = forge(&|file| {
        let chunks = file.new_dataset::<f64>().chunk([128]);
        chunks.shape([TERABYTES]).create(path_of).unwrap();
    });
    assert!(
        text.contains("has shape [600000000000], which its 0 bytes of"),
        "{text}"
    );
}

/// Wrong: a displacement that is not stored would be read as zero, or bound nothing.
#[test]
fn a_displacement_that_is_not_in_the_file_is_refused() {
    let path_of = "VTKHDF/PointData/displacement";
    let dir = tempfile::tempdir().unwrap();
    let path = forged(dir.path(), |file| {
        file.unlink(path_of).unwrap();
        let chunks = file.new_dataset::<f64>().chunk([128, 3]);
        let displacement = chunks.shape([1 << 40, 3]).create(path_of).unwrap();
        let crc = displacement.new_attr::<u32>().create("crc32").unwrap();
        crc.write_scalar(&0u32).unwrap();
    });
    let text = read_step(&path).unwrap_err().to_string();
    assert!(
        text.contains(
            "data set /VTKHDF/PointData/displacement is sparse beside no /VTKHDF/PointData/displacement"
        ),
        "{text}"
    );
}

/// Wrong: a bound that is none would be taken for one when a pack is undone.
#[test]
fn an_error_bound_that_is_none_is_refused() {
    let dir = tempfile::tempdir().unwrap();
    let path = forged(dir.path(), |file| {
        let stress = file.dataset("VTKHDF/PointData/stress").unwrap();
        let bound = stress.new_attr::<f64>().create("error_bound").unwrap();
        bound.write_scalar(&-1.0).unwrap();
    });
    let newer = dir.path().join("step_000009.hdf");
    fs::copy(&path, newer).unwrap();
    let lock = FolderLock::acquire(dir.path()).unwrap();
    let text = checkpoint::pack_steps(&lock, 1, 9).unwrap_err().to_string();
    assert!(
        text.contains("data set /VTKHDF/PointData/stress has the error bound -1, expected a positive number"),
        "{text}"
    );
}

/// Wrong: a text of hundreds of megabytes would be read, at several times its size.
#[test]
fn a_text_that_no_scene_has_is_refused() {
    let dir = tempfile::tempdir().unwrap();
    let path = one_step(dir.path());
    let mut bytes = content(&path);
    bytes.resize(80 << 20, b' ');
    seal(&path, &bytes);
    let text = read_step(&path).unwrap_err().to_string();
    assert!(
        text.contains("it has 83886080 bytes outside of its arrays, expected at most 67108864"),
        "{text}"
    );
}

/// Wrong: a step under the number of another would be shown or resumed from as that one.
#[test]
fn a_step_under_another_number_is_refused() {
    let dir = tempfile::tempdir().unwrap();
    let path = one_step(dir.path());
    let copy = dir.path().join("step_000009.hdf");
    fs::copy(path, &copy).unwrap();
    let text = checkpoint::read_any_step(dir.path(), 9).unwrap_err().to_string();
    assert!(
        text.contains("step_000009.hdf is not a complete step file: it holds step 4"),
        "{text}"
    );
    let newest = checkpoint::newest_step(dir.path(), |_| {}).unwrap();
    assert_eq!(newest.step, 4);
}

/// Wrong: who has a damaged mesh would look for an earlier step, which does not help, or take a Gmsh file
/// for damaged results.
#[test]
fn the_advice_is_that_of_the_kind_of_file() {
    let dir = tempfile::tempdir().unwrap();
    one_step(dir.path());
    let mesh = dir.path().join("mesh.hdf");
    let bytes = fs::read(&mesh).unwrap();
    fs::write(&mesh, &bytes[..bytes.len() / 2]).unwrap();
    let text = checkpoint::read_mesh(dir.path()).unwrap_err().to_string();
    assert!(
        text.contains(
            "mesh.hdf is not a complete mesh of results: its seal is missing or damaged; \
             raceway resume writes it again"
        ),
        "{text}"
    );
    let other = dir.path().join("ring.msh");
    fs::write(&other, "$MeshFormat").unwrap();
    let text = checkpoint::describe(&other).unwrap_err().to_string();
    assert!(text.contains("ring.msh is no file of results: "), "{text}");
}
