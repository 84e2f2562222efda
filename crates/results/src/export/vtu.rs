//! A step as VTK XML unstructured grid (`.vtu`), arrays inline in base64, and the collection (`.pvd`) of their times.
//!
//! Each array is the count of its bytes as UInt64, then the bytes, little-endian, all together in base64. Source: VTK
//! File Formats, Kitware, "XML file formats".

use std::io::{self, Write};

use base64::Engine;
use base64::prelude::BASE64_STANDARD;
use checkpoint::{Grid, StepRecord};

/// Names of the components of a symmetric tensor in VTK's order.
const TENSOR: [&str; 6] = ["XX", "YY", "ZZ", "XY", "YZ", "XZ"];

/// A field: name, components, and row-major values.
pub type FieldArray<'a> = (&'static str, usize, &'a [f64]);

/// Writes the grid with the fields of a step.
pub fn write(file: &mut dyn Write, grid: &Grid, record: &StepRecord) -> io::Result<()> {
    let (points, cells) = (record.points.arrays(), record.cells.arrays());
    write_fields(file, record.time, grid, [&points, &cells])
}

/// Writes a grid at a time, s, with fields over its points and over its cells.
pub fn write_fields(
    file: &mut dyn Write,
    time: f64,
    grid: &Grid,
    [of_points, of_cells]: [&[FieldArray<'_>]; 2],
) -> io::Result<()> {
    writeln!(
        file,
        "<?xml version=\"1.0\"?>\n<VTKFile type=\"UnstructuredGrid\" version=\"1.0\" byte_order=\"LittleEndian\" \
         header_type=\"UInt64\">\n<UnstructuredGrid>"
    )?;
    let time = time.to_le_bytes();
    writeln!(file, "<FieldData>")?;
    array(file, "Float64", "TimeValue", " NumberOfTuples=\"1\"", &time)?;
    writeln!(
        file,
        "</FieldData>\n<Piece NumberOfPoints=\"{}\" NumberOfCells=\"{}\">\n<PointData>",
        grid.points.len(),
        grid.types.len()
    )?;
    for (name, n_components, values) in of_points {
        array(file, "Float64", name, &components(*n_components), &reals(values))?;
    }
    writeln!(file, "</PointData>\n<CellData>")?;
    array(file, "UInt8", "body", "", &grid.body)?;
    array(file, "Float64", "radius", "", &reals(&grid.radius))?;
    for (name, n_components, values) in of_cells {
        array(file, "Float64", name, &components(*n_components), &reals(values))?;
    }
    writeln!(file, "</CellData>\n<Points>")?;
    array(
        file,
        "Float64",
        "Points",
        &components(3),
        &reals(grid.points.as_flattened()),
    )?;
    writeln!(file, "</Points>\n<Cells>")?;
    array(file, "Int64", "connectivity", "", &integers(&grid.connectivity))?;
    // VTU counts the ends of the cells only.
    array(file, "Int64", "offsets", "", &integers(&grid.offsets[1..]))?;
    array(file, "UInt8", "types", "", &grid.types)?;
    writeln!(file, "</Cells>\n</Piece>\n</UnstructuredGrid>\n</VTKFile>")
}

/// Writes the collection of files and their times, s.
pub fn write_collection(file: &mut dyn Write, names: &[(String, f64)]) -> io::Result<()> {
    writeln!(
        file,
        "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"0.1\" \
         byte_order=\"LittleEndian\">\n<Collection>"
    )?;
    for (name, time) in names {
        writeln!(
            file,
            "<DataSet timestep=\"{time:?}\" part=\"0\" file=\"{name}\"/>"
        )?;
    }
    writeln!(file, "</Collection>\n</VTKFile>")
}

fn array(file: &mut dyn Write, kind: &str, name: &str, more: &str, bytes: &[u8]) -> io::Result<()> {
    let mut content = (bytes.len() as u64).to_le_bytes().to_vec();
    content.extend_from_slice(bytes);
    writeln!(
        file,
        "<DataArray type=\"{kind}\" Name=\"{name}\"{more} format=\"binary\">{}</DataArray>",
        BASE64_STANDARD.encode(content)
    )
}

fn components(n: usize) -> String {
    let name = |i: usize| {
        let (point, name) = (i / TENSOR.len(), TENSOR[i % TENSOR.len()]);
        if n == TENSOR.len() {
            name.to_string()
        } else {
            format!("{point}_{name}")
        }
    };
    let tensors = if n.is_multiple_of(TENSOR.len()) { n } else { 0 };
    let names: String = (0..tensors)
        .map(|i| format!(" ComponentName{i}=\"{}\"", name(i)))
        .collect();
    format!(" NumberOfComponents=\"{n}\"{names}")
}

fn reals(values: &[f64]) -> Vec<u8> {
    values.iter().flat_map(|value| value.to_le_bytes()).collect()
}

fn integers(values: &[i64]) -> Vec<u8> {
    values.iter().flat_map(|value| value.to_le_bytes()).collect()
}
