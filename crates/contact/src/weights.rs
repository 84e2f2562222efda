//! Nodal weights of one contact: the same numbers spread its force and measure its motion.

/// Two linear functionals of the nodal displacements, [radial, axial] in the ball's meridian plane.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct NodalWeights {
    /// Nodes.
    pub nodes: Vec<usize>,
    /// Coefficients at these nodes: `u_c[i] = sum over a of coefficients[a][i] . u_a`.
    pub coefficients: Vec<[[f64; 3]; 2]>,
}

impl NodalWeights {
    /// Weights of plain interpolation: every node moves the point by its share.
    pub fn interpolation(nodes: Vec<usize>, shares: &[f64], azimuth: f64) -> NodalWeights {
        let (sin, cos) = azimuth.sin_cos();
        let coefficients = shares
            .iter()
            .map(|&w| [[w * cos, w * sin, 0.0], [0.0, 0.0, w]])
            .collect();
        NodalWeights { nodes, coefficients }
    }

    /// Motion [radial, axial], m, from nodal displacements, m, `[n_nodes][3]` flat.
    pub fn measure(&self, displacement: &[f64]) -> [f64; 2] {
        let mut sum = [0.0; 2];
        for (&node, c) in self.nodes.iter().zip(&self.coefficients) {
            for i in 0..2 {
                for k in 0..3 {
                    sum[i] += c[i][k] * displacement[3 * node + k];
                }
            }
        }
        sum
    }

    /// Adds the nodal loads, N, of a force [radial, axial], N.
    pub fn add_load(&self, force: [f64; 2], load: &mut [f64]) {
        for (&node, c) in self.nodes.iter().zip(&self.coefficients) {
            for k in 0..3 {
                load[3 * node + k] += c[0][k] * force[0] + c[1][k] * force[1];
            }
        }
    }
}
