//! Where a bearing sits on the shaft, and its frame.
//!
//! The shaft's axes x, y, z have z along the shaft; positions count along z. A bearing's own frame has its origin in
//! the plane of its inner groove centres and z in the direction in which a force on the shaft presses it. Orientation
//! "+z" has the axes of the shaft; "-z" is turned by 180 deg about x:
//!
//! ```text
//! (x, y, z) -> (x, -y, -z),   azimuth psi -> -psi,   rotation vectors as vectors,   a spin along z -> against z
//! ```
//!
//! The line of contact meets the axis at the pressure centre, (pitch diameter / 2) tan(angle) from the balls against
//! the bearing's z. So "+z" before "-z" is back to back (pressure centres outside), "-z" before "+z" face to face.
//!
//! **Pressing together.** With the faces ground by `offset`, clamping moves the rings of a "+z" bearing against those
//! of a "-z" bearing by that much. Each gets half of it, as a shift of its inner ring along its own z; how it is
//! shared matters only where the shaft is held along z. Inner rings (back to back) or outer ones (face to face) give
//! the same.

use dynamics::Model;
use dynamics::stiffness::{N_SHAFT, ShaftMatrix};

/// How a bearing sits on the shaft.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Orientation {
    /// A force on the shaft along +z presses it.
    PlusZ,
    /// A force on the shaft along -z presses it.
    MinusZ,
}

/// A bearing on the shaft. Its model is in its own frame: loads in space, spins and azimuths are turned with it, and it
/// has no load of the shaft.
pub struct MountedBearing {
    /// Its name in the scene.
    pub name: String,
    /// Where it sits.
    pub place: Seating,
    /// The bearing.
    pub model: Model,
}

impl Orientation {
    /// That of a word in a scene.
    pub fn named(word: &str) -> Option<Orientation> {
        [Orientation::PlusZ, Orientation::MinusZ]
            .into_iter()
            .find(|orientation| orientation.name() == word)
    }

    /// Its word in scenes.
    pub fn name(self) -> &'static str {
        match self {
            Orientation::PlusZ => "+z",
            Orientation::MinusZ => "-z",
        }
    }

    /// Factor of each component x, y, z, tilt x, tilt y under the rotation; it is its own inverse.
    fn turn(self) -> [f64; N_SHAFT] {
        match self {
            Orientation::PlusZ => [1.0; N_SHAFT],
            Orientation::MinusZ => [1.0, -1.0, -1.0, 1.0, -1.0],
        }
    }

    /// A displacement or load in the shaft's frame from one in the bearing's, or the other way.
    pub fn turned(self, vector: [f64; N_SHAFT]) -> [f64; N_SHAFT] {
        let turn = self.turn();
        std::array::from_fn(|i| turn[i] * vector[i])
    }

    /// A stiffness in the shaft's frame from one in the bearing's, or the other way.
    pub fn turned_matrix(self, matrix: &ShaftMatrix) -> ShaftMatrix {
        self.turned_block(self, matrix)
    }

    /// The same of loads on this bearing by displacements of a bearing of another orientation.
    pub fn turned_block(self, other: Orientation, matrix: &ShaftMatrix) -> ShaftMatrix {
        let [own, other] = [self, other].map(Orientation::turn);
        std::array::from_fn(|i| std::array::from_fn(|j| own[i] * matrix[i][j] * other[j]))
    }

    /// A vector in space [x, y, z] in the bearing's frame, or back.
    pub fn turned_vector(self, [x, y, z]: [f64; 3]) -> [f64; 3] {
        match self {
            Orientation::PlusZ => [x, y, z],
            Orientation::MinusZ => [x, -y, -z],
        }
    }

    /// A symmetric tensor in space, xx yy zz xy yz xz, in the bearing's frame, or back.
    pub fn turned_tensor(self, [xx, yy, zz, xy, yz, xz]: [f64; 6]) -> [f64; 6] {
        match self {
            Orientation::PlusZ => [xx, yy, zz, xy, yz, xz],
            Orientation::MinusZ => [xx, yy, zz, -xy, yz, -xz],
        }
    }

    /// An azimuth, or a spin, in the bearing's frame, or back.
    pub fn turned_angle(self, angle: f64) -> f64 {
        match self {
            Orientation::PlusZ => angle,
            Orientation::MinusZ => -angle,
        }
    }
}

/// Seating of a bearing on the shaft.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Seating {
    /// Position of the plane of its inner groove centres along the shaft, m.
    pub position: f64,
    /// Which way it is turned.
    pub orientation: Orientation,
    /// Shift of its inner ring against the shaft along its own z, m: half of a pairing's offset.
    pub shift: f64,
}

impl Seating {
    /// Displacement in the bearing's frame of the shaft's at the place.
    pub fn into_bearing(&self, of_shaft: [f64; N_SHAFT]) -> [f64; N_SHAFT] {
        let mut own = self.orientation.turned(of_shaft);
        own[2] += self.shift;
        own
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Wrong: a bearing that is turned twice would not be the one it was.
    #[test]
    fn a_turn_undoes_itself_and_keeps_work() {
        let (u, f) = ([1.0, 2.0, 3.0, 4.0, 5.0], [2.0, -1.0, 0.5, 7.0, 3.0]);
        let o = Orientation::MinusZ;
        assert_eq!(o.turned(o.turned(u)), u);
        let work = |a: [f64; 5], b: [f64; 5]| -> f64 { (0..5).map(|i| a[i] * b[i]).sum() };
        assert_eq!(work(o.turned(u), o.turned(f)), work(u, f));
    }

    /// Wrong: stress of a turned bearing would act in other directions than its displacements show.
    #[test]
    fn a_turned_tensor_has_the_turned_traction() {
        let stress = [3.0, -2.0, 0.5, 0.3, 0.8, -0.4];
        let traction = |[xx, yy, zz, xy, yz, xz]: [f64; 6], [x, y, z]: [f64; 3]| {
            [
                xx * x + xy * y + xz * z,
                xy * x + yy * y + yz * z,
                xz * x + yz * y + zz * z,
            ]
        };
        let normal = [0.6, -0.48, 0.64];
        for o in [Orientation::PlusZ, Orientation::MinusZ] {
            let turned = traction(o.turned_tensor(stress), o.turned_vector(normal));
            assert_eq!(turned, o.turned_vector(traction(stress, normal)));
        }
    }
}
