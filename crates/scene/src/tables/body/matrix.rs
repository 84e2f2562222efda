//! A `[[body]]` from matrices of another program, and what a mesh has no use for.

use std::path::PathBuf;

use body::matrix::{MatrixFiles, MatrixSeat};
use input::{LENGTH, MASS, Problems, STIFFNESS};

use super::{BodyContext, BodySource, RawSceneBody, file};
use crate::tables::unit_key::unit_of;

impl RawSceneBody {
    /// A body of matrices.
    pub(super) fn check_matrix(
        &self,
        key: &str,
        context: &BodyContext<'_>,
        problems: &mut Problems,
    ) -> Option<BodySource> {
        if self.material.is_some() || self.fixed.is_some() || self.mesh_unit.is_some() {
            problems.add(format!(
                "{key} comes from a matrix, which has material and supports in it; remove mesh_unit, material and \
                 fixed (nodes are held by fixed_nodes)"
            ));
        }
        self.check_matrix_seat(key, problems);
        let mut path = |name: &str, text: &Option<String>| match text {
            Some(text) => Some(file(&format!("{key}: {name}"), text, context, problems)),
            None => {
                problems.add(format!(
                    "{key}: {name} is missing; a body from a matrix needs stiffness, nodes and, for each seat, \
                     seat_nodes or reference_node"
                ));
                None
            }
        };
        let stiffness = path("stiffness", &self.stiffness);
        let nodes = path("nodes", &self.nodes);
        let seat = self.seat.first();
        let reference = seat.and_then(|seat| seat.reference_node);
        let of_seat = seat.and_then(|seat| seat.seat_nodes.as_ref());
        let seat = match reference {
            Some(tag) => Some(MatrixSeat::Reference(tag.unsigned_abs())),
            None => path("seat_nodes", &of_seat.or(self.seat_nodes.as_ref()).cloned()).map(MatrixSeat::Nodes),
        };
        let own = |text: &String| file(&format!("{key}: fixed_nodes"), text, context, problems);
        let fixed_nodes = self.fixed_nodes.as_ref().map(own);
        let length = self.length_unit.as_deref();
        let length = unit_of(&format!("{key}: length_unit"), length, (LENGTH, "mm"), problems);
        let unit = self.stiffness_unit.as_deref();
        let unit = unit_of(
            &format!("{key}: stiffness_unit"),
            unit,
            (STIFFNESS, "N/mm"),
            problems,
        );
        let mass = self.check_mass(key, context, problems);
        Some(BodySource::Matrix(MatrixFiles {
            stiffness: stiffness?,
            mass,
            nodes: nodes?,
            seats: vec![seat?],
            fixed_nodes,
            length_unit: length?,
            stiffness_unit: unit?,
        }))
    }

    /// Its mass and the unit of that, kg, if it has one.
    fn check_mass(
        &self,
        key: &str,
        context: &BodyContext<'_>,
        problems: &mut Problems,
    ) -> Option<(PathBuf, f64)> {
        let own = |text: &String| file(&format!("{key}: mass"), text, context, problems);
        match (self.mass.as_ref().map(own), self.mass_unit.as_deref()) {
            (None, None) => None,
            (None, Some(_)) => {
                problems.add(format!(
                    "{key} has mass_unit, but no mass; add the file of its mass matrix"
                ));
                None
            }
            (Some(path), typed) => {
                let unit = unit_of(&format!("{key}: mass_unit"), typed, (MASS, "kg"), problems);
                Some((path, unit?))
            }
        }
    }

    /// Its nodes of a seat stand in one place, and no group does.
    fn check_matrix_seat(&self, key: &str, problems: &mut Problems) {
        if self.seat.iter().any(|seat| seat.group.is_some()) {
            problems.add(format!(
                "{key} comes from a matrix, which has no facet groups; remove seat.group; seat_nodes or reference_node \
                 say what the seat is"
            ));
        }
        let has_own = self.seat.iter().any(|seat| seat.seat_nodes.is_some());
        if has_own && self.seat_nodes.is_some() {
            problems.add(format!(
                "{key} has seat_nodes itself and in a [[body.seat]]; keep that of the seat"
            ));
        }
        for seat in self.seat.iter().filter(|seat| seat.reference_node.is_some()) {
            if has_own || self.seat_nodes.is_some() {
                problems.add(format!(
                    "{key} has reference_node and seat_nodes; keep reference_node where the seat moves with one node, \
                     seat_nodes where the nodes of its cylinder are in the matrix"
                ));
            }
            if seat.harmonics.is_some() || seat.across.is_some() {
                problems.add(format!(
                    "{key} has reference_node, with which a seat moves as a rigid one, but harmonics or across too; \
                     remove them"
                ));
            }
            problems.require(
                seat.reference_node.is_some_and(|tag| tag >= 0),
                &format!("{key}: seat.reference_node"),
                seat.reference_node.unwrap_or_default(),
                "expected the number of a node, 0, 1, 2 ...",
            );
        }
    }

    /// What a body with a mesh has no use for.
    pub(super) fn refuse_matrix_keys(&self, key: &str, problems: &mut Problems) {
        if self.mass.is_some() || self.mass_unit.is_some() {
            problems.add(format!(
                "{key} has a mesh, whose mass follows from its density; remove mass and mass_unit"
            ));
        }
        let of_seat = self.seat.iter().any(|seat| seat.seat_nodes.is_some());
        let has_reference = self.seat.iter().any(|seat| seat.reference_node.is_some());
        let keys = [
            ("nodes", self.nodes.is_some()),
            ("seat_nodes", self.seat_nodes.is_some() || of_seat),
            ("reference_node", has_reference),
            ("fixed_nodes", self.fixed_nodes.is_some()),
            ("length_unit", self.length_unit.is_some()),
            ("stiffness_unit", self.stiffness_unit.is_some()),
        ];
        for (name, _) in keys.iter().filter(|(_, is_there)| *is_there) {
            problems.add(format!(
                "{key} has a mesh, but {name} is a key of a body from matrices; remove it, or give stiffness in the \
                 place of the mesh"
            ));
        }
    }
}
