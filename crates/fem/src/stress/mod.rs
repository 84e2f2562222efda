//! Stress and strain: their six components, invariants, and recovery from displacements.
//!
//! **Order of the six components, here and everywhere: xx, yy, zz, xy, yz, xz** (that of VTK's symmetric tensors).
//! Strain has engineering shear, `gamma_xy = du_x/dy + du_y/dx`; stress is in Pa, tension positive.

mod gauge;
mod initial;
mod invariants;
pub(crate) mod kernel;
mod nodes;
mod points;
mod recovery;
mod sector;
mod sector_points;

pub use gauge::{GaugePoint, StrainGauge};
pub use invariants::{principal, von_mises};
pub use nodes::NodeRecovery;
pub use points::{MeshPoint, PointRecovery};
pub use recovery::{StressRecovery, StressWorkspace};
pub use sector::SectorStress;
pub use sector_points::SectorPoints;

/// Small strain with engineering shear from a displacement gradient, `gradient[i][j] = du_i/dx_j`.
pub fn strain(gradient: [[f64; 3]; 3]) -> [f64; 6] {
    let g = gradient;
    [
        g[0][0],
        g[1][1],
        g[2][2],
        g[0][1] + g[1][0],
        g[1][2] + g[2][1],
        g[0][2] + g[2][0],
    ]
}
