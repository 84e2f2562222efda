//! Loads on the shaft, and what a rigid shaft that tilts by a finite rotation makes of their levers.
//!
//! A force acts on a point of a rigid shaft, at a distance along it from its origin. Its moment about that is the
//! distance along the turned axis times the force, of which a straight shaft has the first order
//! ([`dynamics::bodies::TiltedLoads`]). The loads of bearings belong to their coordinates: forces to points of the
//! axis, and moments to the rotation vector that all of a rigid shaft shares. So their forces have levers, and their
//! moments stay. A beam is linear, and so is a shaft under an elastic body that carries several bearings: no levers.

use dynamics::bodies::TiltedLoads;
use dynamics::stiffness::{N_SHAFT, ShaftMatrix};
use dynamics::system::Interval;

use crate::shaft::{ShaftBody, Station};

/// Loads on a shaft.
#[derive(Clone, Debug, PartialEq)]
pub struct ShaftLoads {
    /// On its dofs when it is straight, N and N m.
    pub on_dofs: Vec<f64>,
    /// Forces times their distances from the origin of a rigid shaft, N m; those of a linear shaft count for nothing.
    pub lever: [f64; 3],
}

impl ShaftLoads {
    /// No loads on this shaft.
    pub fn none(shaft: &ShaftBody) -> ShaftLoads {
        ShaftLoads::at_origin(vec![0.0; shaft.n()])
    }

    /// Loads on the dofs themselves, N and N m: forces have no levers.
    pub fn at_origin(on_dofs: Vec<f64>) -> ShaftLoads {
        ShaftLoads {
            on_dofs,
            lever: [0.0; 3],
        }
    }

    /// Adds force x, y, z, N, and moment about x and y, N m, at a place.
    pub fn add(&mut self, station: &Station, load: [f64; N_SHAFT]) {
        station.add_load(load, &mut self.on_dofs);
        add_lever(&mut self.lever, station, load, 1.0);
    }

    /// Makes moments that are there already those of levers: forces times their distances from their place, N m.
    pub fn add_arm(&mut self, arms: [f64; 3]) {
        self.lever.iter_mut().zip(arms).for_each(|(sum, arm)| *sum += arm);
    }

    /// What is left of them beyond those of the straight shaft when bearings at these places, which it loads so, are
    /// taken off; None of a linear shaft.
    pub fn beyond_straight(
        &self,
        shaft: &ShaftBody,
        on_bearings: impl Iterator<Item = (Station, [f64; N_SHAFT])>,
    ) -> Option<TiltedLoads> {
        if shaft.is_linear() {
            return None;
        }
        let [.., about_x, about_y] = first_dofs(&self.on_dofs);
        let moment = [about_x + self.lever[1], about_y - self.lever[0]];
        let mut lever = self.lever;
        on_bearings.for_each(|(station, load)| add_lever(&mut lever, &station, load, -1.0));
        Some(TiltedLoads { lever, moment })
    }

    /// What they have of that alone, beyond those on the dofs, over an interval of the shaft's dofs, N and N m.
    pub fn over(&self, shaft: &ShaftBody, interval: Interval, ends: [&[f64]; 2]) -> [f64; N_SHAFT] {
        let own = self.beyond_straight(shaft, std::iter::empty());
        own.map_or([0.0; N_SHAFT], |loads| loads.over(interval, ends.map(first_dofs)))
    }
}

/// Growth of the load by which a rigid shaft that tilts so holds these loads, with its tilts.
pub fn lever_stiffness(loads: &TiltedLoads, [.., tilt_x, tilt_y]: [f64; N_SHAFT]) -> ShaftMatrix {
    let mut matrix = [[0.0; N_SHAFT]; N_SHAFT];
    for (row, [x, y]) in matrix[3..].iter_mut().zip(loads.slopes([tilt_x, tilt_y])) {
        (row[3], row[4]) = (0.0 - x, 0.0 - y);
    }
    matrix
}

/// Forces on places of a rigid shaft times their distances from its origin, of bearings that it loads so.
pub fn levers(on_bearings: impl Iterator<Item = (Station, [f64; N_SHAFT])>) -> TiltedLoads {
    let mut lever = [0.0; 3];
    on_bearings.for_each(|(station, load)| add_lever(&mut lever, &station, load, -1.0));
    TiltedLoads {
        lever,
        moment: [0.0; 2],
    }
}

/// The first five dofs of a shaft: of a rigid one, all.
pub fn first_dofs(q: &[f64]) -> [f64; N_SHAFT] {
    std::array::from_fn(|i| q[i])
}

fn add_lever(lever: &mut [f64; 3], station: &Station, load: [f64; N_SHAFT], sign: f64) {
    let pairs = lever.iter_mut().zip(load);
    pairs.for_each(|(sum, force)| *sum += sign * station.lever * force);
}
