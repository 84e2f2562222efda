//! The seat of a ring on the side of its body: nodes that lie on the cylinder of the ring, as wide as it is.

use crate::error::{SurroundingError, mesh_advice};
use crate::seat::{SeatCylinder, SeatFunctions, SeatSpace};

/// Allowed difference of the radii of ring and seat, share.
const RADIUS_TOLERANCE: f64 = 2e-3;
/// The same of the widths.
const WIDTH_TOLERANCE: f64 = 1e-2;
/// Allowed distance along z of the middles of ring and seat, share of the width: a chamfer.
const PLACE_TOLERANCE: f64 = 0.1;
/// The same of a reference node, which may stand anywhere in the ring.
const REFERENCE_TOLERANCE: f64 = 0.5;

/// A seat of a body and the functions that are tied there.
#[derive(Clone, Debug)]
pub struct BodySeat {
    /// Facet group, or the file of its nodes; empty of the only seat of a body from matrices.
    pub name: String,
    /// Functions in the coordinates of its ring.
    pub space: SeatSpace,
    /// Where the middle of the seat stands in the body, m along its ring's z; None: in its own middle.
    pub middle: Option<f64>,
    /// Whether its ring stands turned by 180 deg about x in the frame of the body.
    pub is_turned: bool,
}

impl BodySeat {
    /// For messages.
    fn words(&self) -> String {
        match self.name.as_str() {
            "" => "the seat".to_string(),
            name => format!("the seat \"{name}\""),
        }
    }

    /// The same with its body.
    pub(crate) fn of_body(&self, body: &str) -> String {
        format!("{} of body \"{body}\"", self.words())
    }
}

/// A seat on the body's side.
pub(crate) struct SeatJoint {
    pub functions: SeatFunctions,
    /// What is added to z for the coordinates of its ring, m.
    pub shift: f64,
    /// Its middle along the body's z, m.
    pub middle: f64,
    /// Whether its ring stands turned by 180 deg about x.
    pub is_turned: bool,
}

/// Where the ring's middle stands along the seat whose own middle is `middle`, m.
fn middle_of_ring(
    what: &str,
    seat: &BodySeat,
    (middle, tolerance): (f64, f64),
) -> Result<f64, SurroundingError> {
    let of_ring = seat.middle.unwrap_or(middle);
    let (beside, width) = ((of_ring - middle).abs(), 2.0 * seat.space.half_width);
    if beside > tolerance * width {
        return Err(SurroundingError::Beside {
            what: what.to_string(),
            beside_mm: 1e3 * beside,
            width_mm: 1e3 * width,
            most_mm: 1e3 * tolerance * width,
        });
    }
    Ok(of_ring)
}

/// The functions of a seat on the body's side.
pub(crate) fn joint(
    body: &str,
    seat: &BodySeat,
    areas: &[(usize, f64)],
    places: &[[f64; 3]],
    tags: &[u64],
) -> Result<SeatJoint, SurroundingError> {
    let what = seat.of_body(body);
    let sign = if seat.is_turned { -1.0 } else { 1.0 };
    let in_ring = |node: usize| {
        let [x, y, z] = places[node];
        [x, sign * y, sign * z]
    };
    let nodes = areas.iter().map(|&(node, _)| (tags[node], in_ring(node)));
    let cylinder = SeatCylinder::of_nodes(&what, nodes)?;
    let space = &seat.space;
    let ratio = cylinder.radius / space.radius;
    if (ratio - 1.0).abs() > RADIUS_TOLERANCE {
        return Err(SurroundingError::Radius {
            body: body.to_string(),
            found_mm: 1e3 * cylinder.radius,
            expected_mm: 1e3 * space.radius,
            limit: 100.0 * RADIUS_TOLERANCE,
            advice: mesh_advice::RADIUS,
            unit: unit_of(ratio),
        });
    }
    let width = 2.0 * space.half_width;
    if (cylinder.width() / width - 1.0).abs() > WIDTH_TOLERANCE {
        return Err(SurroundingError::Width {
            body: body.to_string(),
            found_mm: 1e3 * cylinder.width(),
            expected_mm: 1e3 * width,
            limit: 100.0 * WIDTH_TOLERANCE,
            advice: mesh_advice::WIDTH,
        });
    }
    let middle = middle_of_ring(&what, seat, (cylinder.middle(), PLACE_TOLERANCE))?;
    let shift = space.middle - middle;
    let place = |node: usize| {
        let [x, y, z] = in_ring(node);
        [x, y, z + shift]
    };
    let mut functions = SeatFunctions::new(&what, *space, areas, place)?;
    if seat.is_turned {
        functions.half_turn();
    }
    Ok(SeatJoint {
        functions,
        shift,
        middle: sign * middle,
        is_turned: seat.is_turned,
    })
}

/// The functions of a seat that moves with a reference node at a place of the body, m. `rows` are the numbers of the
/// two threes of rows of the node.
pub(crate) fn reference_joint(
    body: &str,
    seat: &BodySeat,
    place: [f64; 3],
    rows: [usize; 2],
) -> Result<SeatJoint, SurroundingError> {
    let what = seat.of_body(body);
    let sign = if seat.is_turned { -1.0 } else { 1.0 };
    let [x, y, z] = [place[0], sign * place[1], sign * place[2]];
    let (off, most) = (x.hypot(y), RADIUS_TOLERANCE * seat.space.radius);
    if off > most {
        return Err(SurroundingError::OffAxis {
            what,
            off_mm: 1e3 * off,
            most_mm: 1e3 * most,
        });
    }
    let middle = middle_of_ring(&what, seat, (z, REFERENCE_TOLERANCE))?;
    let mut functions = SeatFunctions::of_reference(seat.space, rows, [-x, -y, middle - z]);
    if seat.is_turned {
        functions.half_turn();
    }
    Ok(SeatJoint {
        functions,
        shift: seat.space.middle - middle,
        middle: sign * middle,
        is_turned: seat.is_turned,
    })
}

/// A remark on the unit of a mesh whose seat is `ratio` times too large.
fn unit_of(ratio: f64) -> String {
    for (factor, remark) in [
        (
            1e3,
            "its lengths seem to be in a unit 1000 times smaller, such as mm for m",
        ),
        (
            1e-3,
            "its lengths seem to be in a unit 1000 times larger, such as m for mm",
        ),
        (1.0 / 25.4, "its lengths seem to be in inch"),
    ] {
        if (ratio / factor - 1.0).abs() < 0.05 {
            return format!("; {remark}");
        }
    }
    String::new()
}

/// Refuses a seat with nodes that are held.
pub(crate) fn refuse_fixed(
    body: &str,
    seat: &BodySeat,
    areas: &[(usize, f64)],
    fixed: &[bool],
    tags: &[u64],
) -> Result<(), SurroundingError> {
    match areas.iter().find(|(node, _)| fixed[*node]) {
        None => Ok(()),
        Some(&(node, _)) => Err(SurroundingError::FixedSeat {
            body: body.to_string(),
            seat: seat.words(),
            node: tags[node],
            advice: mesh_advice::FIXED,
        }),
    }
}
