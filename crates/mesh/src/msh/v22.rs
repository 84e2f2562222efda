//! The sections of MSH 2.2 in text form (Gmsh reference manual, "MSH file format version 2").

use super::block::ElementBlock;
use super::cursor::Cursor;
use super::types::gmsh_type;
use crate::error::MeshError;

/// Reads `$Nodes`: tag and coordinates, in the order of the file.
pub(crate) fn read_nodes(cursor: &mut Cursor<'_>) -> Result<Vec<(u64, [f64; 3])>, MeshError> {
    let n = cursor.count("nodes", [0, 1, 3])?;
    let mut nodes = Vec::with_capacity(n);
    for _ in 0..n {
        let tag = cursor.size("a node tag")?;
        let mut x = [0.0; 3];
        for c in &mut x {
            *c = cursor.real("a node coordinate")?;
        }
        nodes.push((tag, x));
    }
    Ok(nodes)
}

/// Reads `$Elements`; neighbours of one type and group share a block.
pub(crate) fn read_elements(cursor: &mut Cursor<'_>) -> Result<Vec<ElementBlock>, MeshError> {
    let n = cursor.count("elements", [2, 2, 0])?;
    let mut blocks: Vec<ElementBlock> = Vec::new();
    for _ in 0..n {
        let tag = cursor.size("an element tag")?;
        let number = cursor.int("an element type")?;
        let Some((dimension, n_nodes, _)) = gmsh_type(number) else {
            return Err(cursor.damaged("an element type of the format", number.to_string()));
        };
        let physical = read_physical(cursor)?;
        let same = |block: &ElementBlock| block.gmsh_type == number && block.physical == physical;
        if !blocks.last().is_some_and(same) {
            let (tags, nodes) = (Vec::new(), Vec::new());
            blocks.push(ElementBlock {
                dimension,
                gmsh_type: number,
                n_nodes,
                physical,
                tags,
                nodes,
            });
        }
        if let Some(block) = blocks.last_mut() {
            block.tags.push(tag);
            for _ in 0..n_nodes {
                block.nodes.push(cursor.size("a node tag")?);
            }
        }
    }
    Ok(blocks)
}

/// The physical group is the first of an element's integer tags; 0 is none, the sign an orientation.
fn read_physical(cursor: &mut Cursor<'_>) -> Result<Vec<i64>, MeshError> {
    let n = cursor.count("tags of an element", [1, 0, 0])?;
    let mut physical = Vec::new();
    for i in 0..n {
        let value = cursor.int("a tag of an element")?;
        if i == 0 && value != 0 {
            physical.push(value.saturating_abs());
        }
    }
    Ok(physical)
}
