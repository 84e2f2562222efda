//! A Timoshenko beam element with two nodes: stiffness, mass and gyroscopic matrix.
//!
//! ```text
//! plane z-x:  deflection x, slope  tilt_y         plane z-y:  deflection y, slope -tilt_x
//! phi = 12 E I / (k G A L^2)                      k  shear coefficient
//! ```
//!
//! Rows are x, y, z, tilt x, tilt y of the first node, then of the second. In each plane the four-row matrices of
//! Przemieniecki; along z a bar. The gyroscopic matrix is skew: with R the matrix of the rotary inertia in a plane and
//! I_p = 2 I of a circle, a spin W brings the forces 2 W R v_y in the plane z-x and -2 W R v_x in z-y, as
//! `dynamics::whirl` has them for a rigid shaft.

use fem::Material;

use super::section::BeamSection;

/// Rows of an element.
pub const N_ELEMENT: usize = 10;
/// Rows of a plane.
const N_PLANE: usize = 4;

type Plane = [[f64; N_PLANE]; N_PLANE];
/// A matrix over the dofs of both nodes.
pub type ElementMatrix = [[f64; N_ELEMENT]; N_ELEMENT];

/// Rows of the plane z-x in an element and their signs: x, tilt y of both nodes.
const IN_X: [(usize, f64); N_PLANE] = [(0, 1.0), (4, 1.0), (5, 1.0), (9, 1.0)];
/// Of the plane z-y: y, minus tilt x.
const IN_Y: [(usize, f64); N_PLANE] = [(1, 1.0), (3, -1.0), (6, 1.0), (8, -1.0)];

/// What its matrices are made of.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BeamElement {
    length: f64,
    /// E I, N m^2.
    bending: f64,
    /// E A, N.
    axial: f64,
    /// Mass per length, kg/m.
    line_mass: f64,
    /// Rotary inertia per length about a diameter, kg m.
    line_inertia: f64,
    /// The shear parameter phi.
    phi: f64,
}

impl BeamElement {
    /// Of a stretch of a section.
    pub fn new(section: &BeamSection, material: &Material, length: f64) -> BeamElement {
        let (area, second) = (section.area(), section.second_moment());
        let bending = material.young_modulus * second;
        let shear = section.shear_coefficient(material.poisson_ratio) * material.shear_modulus() * area;
        BeamElement {
            length,
            bending,
            axial: material.young_modulus * area,
            line_mass: material.density * area,
            line_inertia: material.density * second,
            phi: 12.0 * bending / (shear * length * length),
        }
    }

    /// Mass, kg.
    pub fn mass_total(&self) -> f64 {
        self.line_mass * self.length
    }

    /// Stiffness.
    pub fn stiffness(&self) -> ElementMatrix {
        let (l, phi) = (self.length, self.phi);
        let k = self.bending / (l.powi(3) * (1.0 + phi));
        let (a, b, c, d) = (
            12.0 * k,
            6.0 * l * k,
            (4.0 + phi) * l * l * k,
            (2.0 - phi) * l * l * k,
        );
        let plane = [[a, b, -a, b], [b, c, -b, d], [-a, -b, a, -b], [b, d, -b, c]];
        let mut matrix = in_both(&plane);
        let bar = self.axial / l;
        add_bar(&mut matrix, [bar, -bar]);
        matrix
    }

    /// Consistent mass with rotary inertia.
    pub fn mass(&self) -> ElementMatrix {
        let (l, phi) = (self.length, self.phi);
        let m = self.mass_total() / (1.0 + phi).powi(2);
        let a = m * (13.0 / 35.0 + 0.7 * phi + phi * phi / 3.0);
        let b = m * l * (11.0 / 210.0 + 11.0 / 120.0 * phi + phi * phi / 24.0);
        let c = m * (9.0 / 70.0 + 0.3 * phi + phi * phi / 6.0);
        let d = -m * l * (13.0 / 420.0 + 3.0 / 40.0 * phi + phi * phi / 24.0);
        let e = m * l * l * (1.0 / 105.0 + phi / 60.0 + phi * phi / 120.0);
        let f = -m * l * l * (1.0 / 140.0 + phi / 60.0 + phi * phi / 120.0);
        let plane: Plane = [[a, b, c, d], [b, e, -d, f], [c, -d, a, -b], [d, f, -b, e]];
        let rotary = self.rotary();
        let sum: Plane = std::array::from_fn(|i| std::array::from_fn(|j| plane[i][j] + rotary[i][j]));
        let mut matrix = in_both(&sum);
        let bar = self.mass_total();
        add_bar(&mut matrix, [bar / 3.0, bar / 6.0]);
        matrix
    }

    /// Gyroscopic matrix of a spin of 1 rad/s.
    pub fn gyroscopic(&self) -> ElementMatrix {
        let rotary = self.rotary();
        let mut matrix = [[0.0; N_ELEMENT]; N_ELEMENT];
        for (i, (row_x, sign_x)) in IN_X.into_iter().enumerate() {
            for (j, (row_y, sign_y)) in IN_Y.into_iter().enumerate() {
                let coupling = 2.0 * sign_x * sign_y * rotary[i][j];
                matrix[row_x][row_y] = coupling;
                matrix[row_y][row_x] = -coupling;
            }
        }
        matrix
    }

    /// Rotary inertia in a plane.
    fn rotary(&self) -> Plane {
        let (l, phi) = (self.length, self.phi);
        let r = self.line_inertia / (l * (1.0 + phi).powi(2));
        let (a, b) = (1.2 * r, r * l * (0.1 - 0.5 * phi));
        let c = r * l * l * (2.0 / 15.0 + phi / 6.0 + phi * phi / 3.0);
        let d = r * l * l * (-1.0 / 30.0 - phi / 6.0 + phi * phi / 6.0);
        [[a, b, -a, b], [b, c, -b, d], [-a, -b, a, -b], [b, d, -b, c]]
    }
}

/// The same matrix in both planes.
fn in_both(plane: &Plane) -> ElementMatrix {
    let mut matrix = [[0.0; N_ELEMENT]; N_ELEMENT];
    for rows in [IN_X, IN_Y] {
        for (i, (row, sign)) in rows.into_iter().enumerate() {
            for (j, (column, other)) in rows.into_iter().enumerate() {
                matrix[row][column] += sign * other * plane[i][j];
            }
        }
    }
    matrix
}

/// Adds a bar along z: entries on and off the diagonal.
fn add_bar(matrix: &mut ElementMatrix, [on, off]: [f64; 2]) {
    for (row, column, entry) in [(2, 2, on), (7, 7, on), (2, 7, off), (7, 2, off)] {
        matrix[row][column] += entry;
    }
}
