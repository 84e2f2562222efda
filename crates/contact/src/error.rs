//! Errors of the contact crate.

/// What can be wrong with a bearing's geometry or a contact on it.
#[derive(Debug, thiserror::Error, Clone, PartialEq)]
pub enum ContactError {
    /// The groove does not enclose the ball.
    #[error(
        "the {side} groove radius is {groove_radius_mm:.4} mm, not larger than the ball radius {ball_radius_mm:.4} mm; \
         expected a groove radius of 0.51 to 0.6 ball diameters"
    )]
    GrooveTooTight {
        /// `inner` or `outer`.
        side: &'static str,
        /// Groove radius, mm.
        groove_radius_mm: f64,
        /// Ball radius, mm.
        ball_radius_mm: f64,
    },
    /// The clearance is larger than the grooves allow.
    #[error(
        "the diametral clearance {clearance_mm:.4} mm exceeds {limit_mm:.4} mm, four times the groove distance A: \
         the balls touch no groove at any angle; check the raceway diameters against the ball diameter"
    )]
    ClearanceTooLarge {
        /// Diametral clearance, mm.
        clearance_mm: f64,
        /// 4 A, mm.
        limit_mm: f64,
    },
    /// A contact lies outside the raceway's facets.
    #[error(
        "ball {ball} leaves the {side} raceway: contact angle {angle_deg:.2} deg, the groove of the mesh \
         reaches from {low_deg:.2} to {high_deg:.2} deg; raise the shoulder or lower the load"
    )]
    OffRaceway {
        /// Ball number, from 0.
        ball: usize,
        /// `inner` or `outer`.
        side: &'static str,
        /// Contact angle, deg.
        angle_deg: f64,
        /// Lowest groove angle of the mesh, deg.
        low_deg: f64,
        /// Highest groove angle of the mesh, deg.
        high_deg: f64,
    },
    /// A contact lies beyond the shoulders of a rigid ring.
    #[error(
        "ball {ball} leaves the {side} raceway: contact angle {angle_deg:.2} deg, between its shoulders the groove \
         reaches from {low_deg:.2} to {high_deg:.2} deg; raise the shoulder or lower the load"
    )]
    BeyondShoulder {
        /// Ball number, from 0.
        ball: usize,
        /// `inner` or `outer`.
        side: &'static str,
        /// Contact angle, deg.
        angle_deg: f64,
        /// Lowest groove angle, deg.
        low_deg: f64,
        /// Highest groove angle, deg.
        high_deg: f64,
    },
    /// A ball presses where no groove can be.
    #[error(
        "ball {ball} presses on the {side} ring at a contact angle of {angle_deg:.1} deg, but no groove reaches \
         beyond 90 deg: the load pulls the ring off its balls, or the ball has left its groove; turn the load, add \
         preload, or hold the shaft"
    )]
    OffGroove {
        /// Ball number, from 0.
        ball: usize,
        /// `inner` or `outer`.
        side: &'static str,
        /// Contact angle, deg.
        angle_deg: f64,
    },
    /// A patch point lies in no facet.
    #[error(
        "no facet of the {side} raceway holds azimuth {azimuth_deg:.4} deg, groove angle {angle_deg:.4} deg: \
         the raceway group of the mesh has a hole there or does not go round; expected a closed track of facets"
    )]
    Hole {
        /// `inner` or `outer`.
        side: &'static str,
        /// Azimuth, deg.
        azimuth_deg: f64,
        /// Groove angle, deg.
        angle_deg: f64,
    },
}
