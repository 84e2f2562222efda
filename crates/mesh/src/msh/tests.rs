//! Tests of the reader: every encoding gives the same mesh, and no damaged file does harm.

mod encodings;
mod malformed;

use std::path::Path;

use super::cursor::Encoding;
use super::{RawMsh, mesh_of};
use crate::error::MeshError;
use crate::mesh::Mesh;

/// Text of two bricks by gmsh 4.8.4.
const TEXT: &str = include_str!("../../tests/data/box_hex8.msh");

/// Reads bytes as a file called `t.msh` in metres.
fn read(data: &[u8]) -> Result<Mesh, MeshError> {
    let path = Path::new("t.msh");
    mesh_of(&RawMsh::parse(path, data)?, path, 1.0).map(|(mesh, _)| mesh)
}

/// Bytes of a file in some encoding.
struct Sink {
    bytes: Vec<u8>,
    encoding: Encoding,
}

impl Sink {
    fn text(&mut self, text: &str) {
        self.bytes.extend(text.as_bytes());
    }

    fn number(&mut self, little_endian: &[u8], text: String) {
        match self.encoding {
            Encoding::Ascii => self.text(&format!("{text} ")),
            Encoding::Binary {
                big_endian: false, ..
            } => self.bytes.extend(little_endian),
            Encoding::Binary { big_endian: true, .. } => self.bytes.extend(little_endian.iter().rev()),
        }
    }

    fn ints(&mut self, values: &[i32]) {
        values
            .iter()
            .for_each(|v| self.number(&v.to_le_bytes(), v.to_string()));
    }

    fn sizes(&mut self, values: &[u64]) {
        let bytes = if let Encoding::Binary { size_bytes: 4, .. } = self.encoding {
            4
        } else {
            8
        };
        values
            .iter()
            .for_each(|v| self.number(&v.to_le_bytes()[..bytes], v.to_string()));
    }

    fn reals(&mut self, values: &[f64]) {
        values
            .iter()
            .for_each(|v| self.number(&v.to_le_bytes(), format!("{v:e}")));
    }
}

/// One brick from (1, 0, 0) to (2, 1, 1) with the facet group `raceway` at its bottom. Node `i` of the brick has
/// the tag `tags[i]`; nodes are written in the order `order`.
fn brick(encoding: Encoding, tags: [u64; 8], order: [usize; 8]) -> Vec<u8> {
    let corners = [
        [0, 0, 0],
        [1, 0, 0],
        [1, 1, 0],
        [0, 1, 0],
        [0, 0, 1],
        [1, 0, 1],
        [1, 1, 1],
        [0, 1, 1],
    ];
    let mut sink = Sink {
        bytes: Vec::new(),
        encoding,
    };
    match encoding {
        Encoding::Ascii => sink.text("$MeshFormat\n4.1 0 8\n"),
        Encoding::Binary { size_bytes, .. } => {
            sink.text(&format!("$MeshFormat\n4.1 1 {size_bytes}\n"));
            sink.ints(&[1]);
        }
    }
    sink.text(
        "\n$EndMeshFormat\n$PhysicalNames\n2\n2 2 \"raceway\"\n3 1 \"ring\"\n$EndPhysicalNames\n$Entities\n",
    );
    sink.sizes(&[0, 0, 1, 1]);
    for (entity, group) in [(1, 2), (1, 1)] {
        sink.ints(&[entity]);
        sink.reals(&[1.0, 0.0, 0.0, 2.0, 1.0, 1.0]);
        sink.sizes(&[1]);
        sink.ints(&[group]);
        sink.sizes(&[0]);
    }
    let (low, high) = (tags.into_iter().min().unwrap(), tags.into_iter().max().unwrap());
    sink.text("\n$EndEntities\n$Nodes\n");
    sink.sizes(&[1, 8, low, high]);
    sink.ints(&[3, 1, 0]);
    sink.sizes(&[8]);
    sink.sizes(&order.map(|i| tags[i]));
    for i in order {
        let [x, y, z] = corners[i].map(f64::from);
        sink.reals(&[1.0 + x, y, z]);
    }
    sink.text("\n$EndNodes\n$Elements\n");
    sink.sizes(&[2, 2, 4, 9]);
    sink.ints(&[2, 1, 3]);
    sink.sizes(&[1, 9, tags[0], tags[1], tags[2], tags[3]]);
    sink.ints(&[3, 1, 5]);
    sink.sizes(&[1, 4]);
    sink.sizes(&tags);
    sink.text("\n$EndElements\n");
    sink.bytes
}

/// The encodings of MSH 4.1.
const ENCODINGS: [Encoding; 5] = [
    Encoding::Ascii,
    Encoding::Binary {
        big_endian: false,
        size_bytes: 8,
    },
    Encoding::Binary {
        big_endian: true,
        size_bytes: 8,
    },
    Encoding::Binary {
        big_endian: false,
        size_bytes: 4,
    },
    Encoding::Binary {
        big_endian: true,
        size_bytes: 4,
    },
];
const PLAIN: [u64; 8] = [1, 2, 3, 4, 5, 6, 7, 8];
const IN_ORDER: [usize; 8] = [0, 1, 2, 3, 4, 5, 6, 7];
