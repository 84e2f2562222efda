//! The sections of MSH 4.1, text and binary of either byte order (Gmsh reference manual, "MSH file format").
//!
//! A partitioned file (`gmsh -part`) has its elements in partition entities, whose physical groups are their own
//! and those of the parent entity of the same dimension. Gmsh writes such a file with all points of the geometry, used
//! or not (arc centres), where it leaves them out of any other: there, nodes of points are construction.

use std::collections::BTreeMap;

use super::block::ElementBlock;
use super::cursor::Cursor;
use super::types::gmsh_type;
use crate::error::MeshError;

/// Physical groups by entity, and the entity of each element block.
#[derive(Default)]
pub(crate) struct Entities {
    /// (dimension, tag) to physical groups.
    physical: BTreeMap<(i64, i64), Vec<i64>>,
    /// (dimension, tag) of a partition entity to (dimension, tag) of its parent.
    parent: BTreeMap<(i64, i64), (i64, i64)>,
    /// Entity of each block read.
    of_block: Vec<(i64, i64)>,
    /// Tags of the nodes on points.
    point_nodes: Vec<u64>,
    is_partitioned: bool,
}

impl Entities {
    /// Sorted tags of the nodes that may be construction points: those on points, in a partitioned file.
    pub(crate) fn take_construction(&mut self) -> Vec<u64> {
        let mut tags = if self.is_partitioned {
            std::mem::take(&mut self.point_nodes)
        } else {
            Vec::new()
        };
        tags.sort_unstable();
        tags
    }

    /// Gives each block the physical groups of its entity.
    pub(crate) fn assign(&self, blocks: &mut [ElementBlock]) {
        for (block, entity) in blocks.iter_mut().zip(&self.of_block) {
            let mut groups = self.physical.get(entity).cloned().unwrap_or_default();
            if let Some(parent) = self.parent.get(entity).filter(|parent| parent.0 == entity.0) {
                groups.extend(self.physical.get(parent).into_iter().flatten());
            }
            groups.sort_unstable();
            groups.dedup();
            block.physical = groups;
        }
    }
}

/// Reads `$Entities`.
pub(crate) fn read_entities(cursor: &mut Cursor<'_>, entities: &mut Entities) -> Result<(), MeshError> {
    for (dimension, count) in read_entity_counts(cursor)?.into_iter().enumerate() {
        for _ in 0..count {
            let tag = cursor.int("an entity tag")?;
            read_entity_tail(cursor, (dimension as i64, tag), entities)?;
        }
    }
    Ok(())
}

/// Reads `$PartitionedEntities`.
pub(crate) fn read_partitioned(cursor: &mut Cursor<'_>, entities: &mut Entities) -> Result<(), MeshError> {
    entities.is_partitioned = true;
    cursor.size("a number of partitions")?;
    for _ in 0..cursor.count("ghost entities", [2, 0, 0])? {
        cursor.int("a ghost entity tag")?;
        cursor.int("the partition of a ghost entity")?;
    }
    for (dimension, count) in read_entity_counts(cursor)?.into_iter().enumerate() {
        for _ in 0..count {
            let entity = (dimension as i64, cursor.int("a partition entity tag")?);
            let parent = (
                cursor.int("the dimension of the parent")?,
                cursor.int("the tag of the parent")?,
            );
            for _ in 0..cursor.count("partitions of an entity", [1, 0, 0])? {
                cursor.int("a partition")?;
            }
            entities.parent.insert(entity, parent);
            read_entity_tail(cursor, entity, entities)?;
        }
    }
    Ok(())
}

/// Numbers of points, curves, surfaces and volumes.
fn read_entity_counts(cursor: &mut Cursor<'_>) -> Result<[usize; 4], MeshError> {
    Ok([
        cursor.count("points", [1, 1, 3])?,
        cursor.count("curves", [1, 2, 6])?,
        cursor.count("surfaces", [1, 2, 6])?,
        cursor.count("volumes", [1, 2, 6])?,
    ])
}

/// Place or bounding box, physical groups, and boundary of an entity.
fn read_entity_tail(
    cursor: &mut Cursor<'_>,
    entity: (i64, i64),
    entities: &mut Entities,
) -> Result<(), MeshError> {
    for _ in 0..if entity.0 == 0 { 3 } else { 6 } {
        cursor.real("a bound of an entity")?;
    }
    let n_groups = cursor.count("physical groups of an entity", [1, 0, 0])?;
    let mut groups = Vec::with_capacity(n_groups);
    for _ in 0..n_groups {
        // The sign is an orientation.
        groups.push(cursor.int("a physical group")?.saturating_abs());
    }
    if entity.0 > 0 {
        for _ in 0..cursor.count("bounding entities", [1, 0, 0])? {
            cursor.int("a bounding entity")?;
        }
    }
    entities.physical.entry(entity).or_default().extend(groups);
    Ok(())
}

/// Reads `$Nodes`: tag and coordinates, in the order of the file.
pub(crate) fn read_nodes(
    cursor: &mut Cursor<'_>,
    entities: &mut Entities,
) -> Result<Vec<(u64, [f64; 3])>, MeshError> {
    let n_blocks = cursor.count("node blocks", [3, 1, 0])?;
    let announced = cursor.count("nodes", [0, 1, 3])?;
    cursor.size("the smallest node tag")?;
    cursor.size("the largest node tag")?;
    let mut nodes = Vec::with_capacity(announced);
    for _ in 0..n_blocks {
        let dimension = read_dimension(cursor)?;
        cursor.int("an entity tag")?;
        let parameters = match cursor.int("0, or 1 for parametric nodes")? {
            0 => 0,
            1 => dimension,
            other => return Err(cursor.damaged("0, or 1 for parametric nodes", other.to_string())),
        };
        let n = cursor.count("nodes of a block", [0, 1, 3])?;
        let first = nodes.len();
        for _ in 0..n {
            nodes.push((cursor.size("a node tag")?, [0.0; 3]));
        }
        if dimension == 0 {
            entities
                .point_nodes
                .extend(nodes[first..].iter().map(|node| node.0));
        }
        for node in &mut nodes[first..] {
            for c in 0..3 {
                node.1[c] = cursor.real("a node coordinate")?;
            }
            for _ in 0..parameters {
                cursor.real("a node parameter")?;
            }
        }
    }
    if nodes.len() != announced {
        return Err(cursor.mismatch("nodes", announced as u64, nodes.len()));
    }
    Ok(nodes)
}

/// Reads `$Elements`; the physical groups are assigned at the end of the file.
pub(crate) fn read_elements(
    cursor: &mut Cursor<'_>,
    entities: &mut Entities,
) -> Result<Vec<ElementBlock>, MeshError> {
    let n_blocks = cursor.count("element blocks", [3, 1, 0])?;
    let announced = cursor.count("elements", [0, 2, 0])?;
    cursor.size("the smallest element tag")?;
    cursor.size("the largest element tag")?;
    let mut blocks = Vec::new();
    let mut total = 0;
    for _ in 0..n_blocks {
        let dimension = read_dimension(cursor)?;
        let tag = cursor.int("an entity tag")?;
        let block = read_block(cursor, dimension)?;
        total += block.tags.len();
        entities.of_block.push((dimension as i64, tag));
        blocks.push(block);
    }
    if total != announced {
        return Err(cursor.mismatch("elements", announced as u64, total));
    }
    Ok(blocks)
}

fn read_block(cursor: &mut Cursor<'_>, dimension: usize) -> Result<ElementBlock, MeshError> {
    let number = cursor.int("an element type")?;
    let Some((type_dimension, n_nodes, name)) = gmsh_type(number) else {
        return Err(cursor.damaged("an element type of the format", number.to_string()));
    };
    if type_dimension != dimension {
        let expected = format!("elements of dimension {dimension}");
        return Err(cursor.damaged(&expected, name));
    }
    let n = cursor.count("elements of a block", [0, 1 + n_nodes, 0])?;
    let (mut tags, mut nodes) = (Vec::with_capacity(n), Vec::with_capacity(n * n_nodes));
    for _ in 0..n {
        tags.push(cursor.size("an element tag")?);
        for _ in 0..n_nodes {
            nodes.push(cursor.size("a node tag")?);
        }
    }
    Ok(ElementBlock {
        dimension,
        gmsh_type: number,
        n_nodes,
        physical: Vec::new(),
        tags,
        nodes,
    })
}

fn read_dimension(cursor: &mut Cursor<'_>) -> Result<usize, MeshError> {
    let dimension = cursor.int("a dimension from 0 to 3")?;
    if (0..=3).contains(&dimension) {
        Ok(dimension as usize)
    } else {
        Err(cursor.damaged("a dimension from 0 to 3", dimension.to_string()))
    }
}
