//! Natural modes of the bearings and their shaft about an equilibrium: small free vibration without turning.
//!
//! Elastic rings and the bodies to which they are tied vibrate with all their mass ([`dynamics::modes`]). The shaft has
//! its own mass and stiffness, what is fixed to it, and rigid inner rings that have a mass. Dofs of a rigid shaft that
//! are held stay.

use dense::Searched;
use dynamics::ModesSettings;
use dynamics::modes::{BearingOnFreeShaft, FreeShaft, ModesOfSeveral, modes_of_several};
use dynamics::stiffness::N_SHAFT;
use dynamics::whirl::shaft_inertia;

use crate::assembly::{Assembly, AssemblySolution};
use crate::error::AssemblyError;
use crate::place::MountedBearing;
use crate::shaft::Station;

/// The modes about an equilibrium of the assembly.
pub fn modes(
    assembly: &Assembly,
    solution: &AssemblySolution,
    settings: ModesSettings,
    progress: &mut dyn FnMut(Searched),
) -> Result<ModesOfSeveral, AssemblyError> {
    let free = free_dofs(assembly);
    let stations = assembly.stations_at(solution);
    let pairs = assembly.bearings.iter().zip(&solution.bearings).zip(&stations);
    let bearings: Vec<BearingOnFreeShaft<'_>> = pairs
        .map(|((bearing, equilibrium), station)| BearingOnFreeShaft {
            model: &bearing.model,
            equilibrium,
            place: motion_of(bearing, station, &free),
        })
        .collect();
    let found = modes_of_several(
        &bearings,
        &free_shaft((assembly, solution), &free),
        settings,
        progress,
    );
    found.map_err(|source| AssemblyError::Modes { source })
}

/// Numbers of the free dofs of the shaft.
pub fn free_dofs(assembly: &Assembly) -> Vec<usize> {
    let held = &assembly.shaft.held;
    (0..held.len()).filter(|&i| held[i].is_none()).collect()
}

/// Motion of the shaft at a bearing, in its frame, by free dofs.
fn motion_of(bearing: &MountedBearing, station: &Station, free: &[usize]) -> [Vec<(usize, f64)>; N_SHAFT] {
    let mut motion = [const { Vec::new() }; N_SHAFT];
    for (number, dof) in free.iter().enumerate() {
        let Some(j) = dof.checked_sub(station.first).filter(|j| *j < N_SHAFT) else {
            continue;
        };
        let column = station.motion.map(|row| row[j]);
        for (row, value) in motion.iter_mut().zip(bearing.place.orientation.turned(column)) {
            if value != 0.0 {
                row.push((number, value));
            }
        }
    }
    motion
}

/// The shaft by its free dofs, with the rigid rings on it.
fn free_shaft((assembly, solution): (&Assembly, &AssemblySolution), free: &[usize]) -> FreeShaft {
    let mut shaft = assembly.shaft.clone();
    for (bearing, mount) in assembly.bearings.iter().zip(assembly.mounts()) {
        shaft.add_inertia(&mount.station, &shaft_inertia(&bearing.model));
    }
    let (n, arm) = (shaft.n(), assembly.scales().tilt_arm);
    let of_levers = assembly.of_levers(solution);
    Station::on_rigid_shaft(0.0).add_matrix(&of_levers, n, &mut shaft.stiffness);
    let pick = |matrix: &[f64]| -> Vec<f64> {
        let row = |i: &usize| free.iter().map(|k| matrix[n * i + k]).collect::<Vec<f64>>();
        free.iter().flat_map(row).collect()
    };
    FreeShaft {
        n: free.len(),
        mass: pick(&shaft.mass),
        stiffness: pick(&shaft.stiffness),
        arms: free
            .iter()
            .map(|i| if i % N_SHAFT < 3 { 1.0 } else { arm })
            .collect(),
    }
}
