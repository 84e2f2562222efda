#[path = "../tests/support/mod.rs"]
mod support;
use contact::Side;
use dynamics::Hold;
use support::rings::{Level, ring};
use std::time::Instant;
fn main() {
    for level in [Level::hex8(180,14,3,4), Level::hex8(90,8,2,3), Level::hex8(360,14,3,6), Level::hex20(90,8,2,3)] {
        for side in Side::BOTH {
        let r = ring(side, level, Hold::Clamped);
        let m = &r.mesh;
        let full = fem::assemble_stiffness(m, &r.material).unwrap();
        let t = Instant::now();
        let o = solver::angular_dissection(&m.nodes, &m.connectivity, m.kind.n_nodes());
        let a = t.elapsed();
        let s = solver::Symbolic::new(&full, &solver::expand(&o,3)).unwrap();
        println!("{:?} {:?} {} dofs order {:?} factor {} flops {:.4e}", level.kind, side, m.n_dofs(), a, s.factor_bytes(), s.flops());
        }
    }
    // tets from bricks
    let r = ring(Side::Inner, Level::hex8(180,14,3,4), Hold::Clamped);
    let m = &r.mesh;
    let corners = [[0,1,2,6],[0,2,3,6],[0,3,7,6],[0,7,4,6],[0,4,5,6],[0,5,1,6]];
    let tets: Vec<usize> = m.connectivity.chunks_exact(8).flat_map(|b| corners.iter().flatten().map(|&c| b[c]).collect::<Vec<_>>()).collect();
    let full = fem::assemble_stiffness(m, &r.material).unwrap();
    let t = Instant::now();
    let o = solver::angular_dissection(&m.nodes, &tets, 4);
    let a = t.elapsed();
    let s = solver::Symbolic::new(&full, &solver::expand(&o,3)).unwrap();
    println!("tets order {:?} factor {} flops {:.4e}", a, s.factor_bytes(), s.flops());
}
