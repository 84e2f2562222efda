//! The geometry of an angular contact ball bearing: grooves, free contact angle, just-touching positions.
//!
//! Each groove is a torus. The reference (just-touching) position has every ball touching both raceways: the
//! inner groove centres lie A sin(a0) further along +z than the outer ones. A positive axial load on the inner
//! ring presses it along +z into the balls. A contact angle is positive in that sense on both raceways.
//! Reference: Harris, Rolling Bearing Analysis (4th ed.), chapter 2.

use crate::error::ContactError;
use crate::meridian::Meridian;

/// Which raceway.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Side {
    /// Raceway of the inner ring.
    Inner,
    /// Raceway of the outer ring.
    Outer,
}

impl Side {
    /// Both raceways, inner first: the order of every array over sides.
    pub const BOTH: [Side; 2] = [Side::Inner, Side::Outer];

    /// Index in arrays over sides.
    pub fn index(self) -> usize {
        self as usize
    }

    /// Of two values the one of this side.
    pub fn choose<T>(self, inner: T, outer: T) -> T {
        match self {
            Side::Inner => inner,
            Side::Outer => outer,
        }
    }

    /// What fallible work makes of the inner side, then of the outer one; nothing is begun after a failure.
    pub fn try_both<T, E>(mut of: impl FnMut(Side) -> Result<T, E>) -> Result<[T; 2], E> {
        let [inner, outer] = Side::BOTH;
        Ok([of(inner)?, of(outer)?])
    }

    /// Name used in files and messages.
    pub fn name(self) -> &'static str {
        self.choose("inner", "outer")
    }

    /// +1 where the groove bottom lies outside the groove centre (outer ring), -1 inside (inner ring).
    pub fn sign(self) -> f64 {
        self.choose(-1.0, 1.0)
    }
}

/// A value of each side, inner first.
pub type BySide<T> = [T; 2];

/// Dimensions of the bearing, m.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BearingGeometry {
    /// Number of balls.
    pub n_balls: usize,
    /// Ball diameter D_w.
    pub ball_diameter: f64,
    /// Inner raceway (groove-bottom) diameter d_i.
    pub inner_raceway_diameter: f64,
    /// Outer raceway (groove-bottom) diameter D_e.
    pub outer_raceway_diameter: f64,
    /// Inner groove radius R_i.
    pub inner_groove_radius: f64,
    /// Outer groove radius R_o.
    pub outer_groove_radius: f64,
    /// Azimuth of ball 0, rad.
    pub first_ball_azimuth: f64,
}

impl BearingGeometry {
    /// The 7010C of the paper.
    pub fn reference_7010c() -> BearingGeometry {
        BearingGeometry {
            n_balls: 18,
            ball_diameter: 9e-3,
            inner_raceway_diameter: 56.01e-3,
            outer_raceway_diameter: 74.037e-3,
            inner_groove_radius: 4.65e-3,
            outer_groove_radius: 4.75e-3,
            first_ball_azimuth: 0.0,
        }
    }

    /// Checks that the grooves enclose the balls and that both raceways can be touched.
    pub fn validate(&self) -> Result<(), ContactError> {
        for side in Side::BOTH {
            if self.groove_radius(side) <= 0.5 * self.ball_diameter {
                return Err(ContactError::GrooveTooTight {
                    side: side.name(),
                    groove_radius_mm: 1e3 * self.groove_radius(side),
                    ball_radius_mm: 0.5e3 * self.ball_diameter,
                });
            }
        }
        if self.clearance() > 4.0 * self.groove_distance() {
            return Err(ContactError::ClearanceTooLarge {
                clearance_mm: 1e3 * self.clearance(),
                limit_mm: 4e3 * self.groove_distance(),
            });
        }
        Ok(())
    }

    /// Groove radius of one raceway, m.
    pub fn groove_radius(&self, side: Side) -> f64 {
        side.choose(self.inner_groove_radius, self.outer_groove_radius)
    }

    /// Principal curvature of a raceway in the rolling direction where a ball touches it at the free contact angle,
    /// 1/m; positive on the convex inner raceway. By Meusnier's theorem cos a0 over the distance from the axis.
    pub fn rolling_curvature(&self, side: Side) -> f64 {
        let cos = self.free_contact_angle().cos();
        let radius = self.centre_radius(side) + side.sign() * self.groove_radius(side) * cos;
        -side.sign() * cos / radius
    }

    /// Curvature of ball and raceway against each other in the rolling direction, 1/m.
    pub fn sum_of_rolling_curvatures(&self, side: Side) -> f64 {
        2.0 / self.ball_diameter + self.rolling_curvature(side)
    }

    /// Radius of the circle of groove centres, m.
    pub fn centre_radius(&self, side: Side) -> f64 {
        side.choose(
            0.5 * self.inner_raceway_diameter + self.inner_groove_radius,
            0.5 * self.outer_raceway_diameter - self.outer_groove_radius,
        )
    }

    /// Diametral clearance P_d = D_e - d_i - 2 D_w, m; negative is interference.
    pub fn clearance(&self) -> f64 {
        self.outer_raceway_diameter - self.inner_raceway_diameter - 2.0 * self.ball_diameter
    }

    /// Distance of the groove centres of a ball that touches both raceways, A = R_i + R_o - D_w, m.
    pub fn groove_distance(&self) -> f64 {
        self.inner_groove_radius + self.outer_groove_radius - self.ball_diameter
    }

    /// Free contact angle a0, cos a0 = 1 - P_d/(2 A), rad. With interference the balls are squeezed at a0 = 0.
    pub fn free_contact_angle(&self) -> f64 {
        (1.0 - self.clearance() / (2.0 * self.groove_distance()))
            .clamp(-1.0, 1.0)
            .acos()
    }

    /// Axial distance of the inner from the outer groove centres in the reference position, A sin a0, m.
    pub fn axial_offset(&self) -> f64 {
        self.groove_distance() * self.free_contact_angle().sin()
    }

    /// Groove centre in the reference position, m; axial from the outer groove centres.
    pub fn groove_centre(&self, side: Side) -> Meridian {
        let axial = match side {
            Side::Inner => self.axial_offset(),
            Side::Outer => 0.0,
        };
        Meridian::new(self.centre_radius(side), axial)
    }

    /// Distance from groove centre to ball centre when they touch, R - D_w/2, m.
    pub fn touching_distance(&self, side: Side) -> f64 {
        self.groove_radius(side) - 0.5 * self.ball_diameter
    }

    /// Ball centre in the reference position, m: on the line of groove centres, with equal
    /// gap (or interference) to both raceways.
    pub fn ball_centre(&self) -> Meridian {
        let [inner, outer] = Side::BOTH.map(|side| self.groove_centre(side));
        let [touching_inner, touching_outer] = Side::BOTH.map(|side| self.touching_distance(side));
        midway(inner, outer, touching_inner, touching_outer)
    }

    /// Pitch diameter, twice the ball centre's radius in the reference position, m.
    pub fn pitch_diameter(&self) -> f64 {
        2.0 * self.ball_centre().radial
    }

    /// Azimuth of ball `ball`, rad, in 0..2 pi.
    pub fn azimuth(&self, ball: usize) -> f64 {
        let turn = 2.0 * std::f64::consts::PI;
        (self.first_ball_azimuth + turn * ball as f64 / self.n_balls as f64).rem_euclid(turn)
    }
}

/// Point with equal approach to two groove centres at touching distances `di`, `do_`, on their line. Where one groove
/// is so much wider that there is none between the centres, the point is at most half a touching distance beyond one:
/// it touches neither.
pub fn midway(inner: Meridian, outer: Meridian, di: f64, do_: f64) -> Meridian {
    let line = inner - outer;
    let length = line.norm();
    // From the outer centre: |x - outer| - do_ = |x - inner| - di.
    let share = if length > 0.0 {
        let equal = 0.5 * (length + do_ - di) / length;
        equal.clamp(-0.5 * do_ / length, 1.0 + 0.5 * di / length)
    } else {
        0.5
    };
    outer + line.map(|x| share * x)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Wrong: a loose ball would be pushed through the narrower groove when the other is much wider.
    #[test]
    fn a_ball_midway_touches_neither_groove() {
        for (di, do_) in [(0.2, 0.3), (0.3, 5.7), (5.7, 0.3), (1.0, 1.0)] {
            for gap in [1e-3, 0.1, 0.9] {
                // The discs in which the ball is free overlap by `gap` of the smaller one, or hold one another.
                let outer = Meridian::new(0.0, (di + do_ - gap * f64::min(di, do_)).min(1.5));
                let x = midway(Meridian::default(), outer, di, do_);
                assert!(
                    x.norm() < di && (x - outer).norm() < do_,
                    "{di} {do_} {gap}: {x:?}"
                );
            }
        }
    }

    /// Wrong: the derived numbers of the reference bearing (clearance 0.027 mm, A 0.4 mm, 14.93 deg).
    #[test]
    fn the_7010c_has_its_derived_dimensions() {
        let g = BearingGeometry::reference_7010c();
        assert!((g.clearance() - 0.027e-3).abs() < 1e-15);
        assert!((g.groove_distance() - 0.4e-3).abs() < 1e-15);
        let degrees = g.free_contact_angle().to_degrees();
        assert!((degrees - 14.93).abs() < 5e-3, "{degrees}");
        assert!((g.centre_radius(Side::Outer) - 32.2685e-3).abs() < 1e-15);
        assert!((g.centre_radius(Side::Inner) - 32.655e-3).abs() < 1e-15);
        assert!((g.axial_offset() - 0.103e-3).abs() < 5e-7);
    }

    /// Wrong: balls would not just touch in the reference position.
    #[test]
    fn the_reference_position_just_touches() {
        let g = BearingGeometry::reference_7010c();
        let x = g.ball_centre();
        for side in Side::BOTH {
            let c = g.groove_centre(side);
            let approach = (x - c).norm() - g.touching_distance(side);
            assert!(approach.abs() < 1e-17, "{side:?}: {approach}");
            let normal = side.sign() * (x - c).radial;
            assert!(normal > 0.0, "{side:?}: the ball lies towards the groove bottom");
        }
    }

    /// Wrong: interference would have no reference position.
    #[test]
    fn interference_is_shared_at_zero_angle() {
        let g = BearingGeometry {
            outer_raceway_diameter: 74.0e-3,
            ..BearingGeometry::reference_7010c()
        };
        assert!(g.clearance() < 0.0 && g.free_contact_angle() == 0.0);
        let x = g.ball_centre();
        let approach = |s| (x - g.groove_centre(s)).radial.abs() - g.touching_distance(s);
        assert!((approach(Side::Inner) - approach(Side::Outer)).abs() < 1e-16);
        assert!((approach(Side::Inner) + approach(Side::Outer) + 0.5 * g.clearance()).abs() < 1e-16);
    }

    /// Wrong: an impossible bearing would be accepted.
    #[test]
    fn impossible_bearings_are_refused() {
        let tight = BearingGeometry {
            inner_groove_radius: 4.5e-3,
            ..BearingGeometry::reference_7010c()
        };
        assert!(
            tight
                .validate()
                .unwrap_err()
                .to_string()
                .contains("inner groove radius is 4.5000 mm")
        );
        let loose = BearingGeometry {
            outer_raceway_diameter: 76e-3,
            ..BearingGeometry::reference_7010c()
        };
        assert!(
            loose
                .validate()
                .unwrap_err()
                .to_string()
                .contains("exceeds 1.6000 mm")
        );
    }
}
