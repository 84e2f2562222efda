//! What the contact problem solves for.

/// Displacements of everything small: m, rad.
#[derive(Clone, Debug, PartialEq)]
pub struct Displacements {
    /// Shaft x, y, z, tilt x, tilt y.
    pub shaft: [f64; 5],
    /// Balls [radial, axial] from the just-touching position.
    pub balls: Vec<[f64; 2]>,
    /// Elastic motion of the groove centres, inner ring then outer, `[n_balls][2]`.
    pub grooves: [Vec<[f64; 2]>; 2],
}

impl Displacements {
    /// Zero displacement; `flexible` tells which rings have groove motions.
    pub fn zero(n_balls: usize, flexible: [bool; 2]) -> Displacements {
        Displacements {
            shaft: [0.0; 5],
            balls: vec![[0.0; 2]; n_balls],
            grooves: flexible.map(|f| if f { vec![[0.0; 2]; n_balls] } else { Vec::new() }),
        }
    }
}
