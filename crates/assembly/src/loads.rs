//! Loads on the shaft, and what a rigid shaft that tilts by a finite rotation makes of their levers.
//!
//! A force acts on a point of a rigid shaft, at a distance along it from its origin. Its moment about that is the
//! distance along the turned axis times the force, of which a straight shaft has the first order
//! ([`dynamics::bodies::TiltedLoads`]). The loads of bearings belong to their coordinates: forces to points of the
//! axis, and moments to the rotation vector that all of a rigid shaft shares. So their forces have levers, and their
//! moments stay. A beam is linear, and so is a shaft under an elastic body that carries several bearings: no levers.

use dynamics::bodies::TiltedLoads;
use dynamics::stiffness::N_SHAFT;
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
        self.add_arm([0, 1, 2].map(|i| station.lever * load[i]));
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
        let taken_off = |lever: [f64; 3], (station, load): (Station, [f64; N_SHAFT])| {
            [0, 1, 2].map(|i| lever[i] - station.lever * load[i])
        };
        let lever = on_bearings.fold(self.lever, taken_off);
        Some(TiltedLoads { lever, moment })
    }

    /// What they have of that alone, beyond those on the dofs, over an interval of the shaft's dofs, N and N m.
    pub fn over(&self, shaft: &ShaftBody, interval: Interval, ends: [&[f64]; 2]) -> [f64; N_SHAFT] {
        let own = self.beyond_straight(shaft, std::iter::empty());
        own.map_or([0.0; N_SHAFT], |loads| loads.over(interval, ends.map(first_dofs)))
    }
}

/// The first five dofs of a shaft: of a rigid one, all.
pub fn first_dofs(q: &[f64]) -> [f64; N_SHAFT] {
    std::array::from_fn(|i| q[i])
}
