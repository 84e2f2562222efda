//! Clearance and seats of a mounted bearing, for the log and `summary.json`.

use std::collections::BTreeMap;
use std::f64::consts::TAU;

use contact::Side;
use dynamics::mounting::{Clearance, MountingReport, SeatReport};
use serde::Serialize;

/// Clearance of the bearing unmounted, mounted at the reference temperature, and warm.
#[derive(Debug, Serialize)]
pub struct ClearanceSummary {
    unmounted: ClearanceState,
    mounted: ClearanceState,
    operating: ClearanceState,
    /// At time 0; absent where temperatures do not change.
    #[serde(skip_serializing_if = "Option::is_none")]
    start: Option<ClearanceState>,
}

/// Clearance in one of these states.
#[derive(Debug, Serialize)]
struct ClearanceState {
    radial_m: f64,
    free_contact_angle_rad: f64,
}

/// A seat with a fit.
#[derive(Debug, Serialize)]
pub struct FitSummary {
    interference_m: f64,
    pressure_pa: f64,
    groove_growth_m: f64,
    /// Absent where no speed loosens it.
    #[serde(skip_serializing_if = "Option::is_none")]
    loosening_speed_rad_per_s: Option<f64>,
}

impl ClearanceSummary {
    /// The clearances of a report.
    pub fn new(report: &MountingReport) -> ClearanceSummary {
        let state = |clearance: Clearance| ClearanceState {
            radial_m: clearance.radial,
            free_contact_angle_rad: clearance.free_contact_angle,
        };
        ClearanceSummary {
            unmounted: state(report.clearances.unmounted),
            mounted: state(report.clearances.mounted),
            operating: state(report.clearances.operating),
            start: report.at_start.map(state),
        }
    }
}

/// The fits of a report, by ring.
pub fn fits(report: Option<&MountingReport>) -> BTreeMap<&'static str, FitSummary> {
    let seats = report.iter().flat_map(|report| report.seats).zip(Side::BOTH);
    let fit = |(seat, side): (Option<SeatReport>, Side)| {
        let seat = seat?;
        let fit = FitSummary {
            interference_m: seat.interference,
            pressure_pa: seat.pressure,
            groove_growth_m: seat.groove_growth,
            loosening_speed_rad_per_s: seat.loosening_speed,
        };
        Some((side.name(), fit))
    };
    seats.filter_map(fit).collect()
}

/// Sentences of a log.
pub fn lines(report: &MountingReport) -> Vec<String> {
    let of = |name: &str, clearance: Clearance| {
        format!(
            "{name} {:.2} um, {:.2} deg",
            1e6 * clearance.radial,
            clearance.free_contact_angle.to_degrees()
        )
    };
    let all = report.clearances;
    let mut lines = vec![format!(
        "radial clearance and free contact angle: {}; {}; {}",
        of("unmounted", all.unmounted),
        of("mounted", all.mounted),
        match report.at_start {
            Some(start) => format!(
                "{}; {}",
                of("at the start", start),
                of("at the end", all.operating)
            ),
            None => of("operating", all.operating),
        },
    )];
    for (seat, side) in report.seats.iter().zip(Side::BOTH) {
        if let Some(seat) = seat {
            let limit = seat
                .loosening_speed
                .map_or("lets go at no speed".to_string(), |speed| {
                    format!("lets go at {:.0} rpm", 60.0 * speed / TAU)
                });
            lines.push(format!(
                "fit of the {} ring: interference {:.2} um, pressure {:.2} MPa, groove diameter {:+.2} um, {limit}",
                side.name(),
                1e6 * seat.interference,
                1e-6 * seat.pressure,
                2e6 * seat.groove_growth,
            ));
        }
    }
    lines
}

#[cfg(test)]
mod tests {
    use dynamics::mounting::Clearances;

    use super::*;

    /// Wrong: a reader of the log would see another fit than the summary has, or diameters as radii.
    #[test]
    fn a_report_is_told_in_micrometres_of_diameter() {
        let clearance = |radial: f64| Clearance {
            radial,
            free_contact_angle: 0.25,
        };
        let seat = SeatReport {
            interference: 10e-6,
            pressure: 4.2e6,
            groove_growth: 4.4635e-6,
            loosening_speed: Some(2864.0),
        };
        let report = MountingReport {
            clearances: Clearances {
                unmounted: clearance(27e-6),
                mounted: clearance(18e-6),
                operating: clearance(12.5e-6),
            },
            at_start: None,
            seats: [Some(seat), None],
            warnings: Vec::new(),
        };
        let said = lines(&report);
        assert_eq!(
            said,
            [
                "radial clearance and free contact angle: unmounted 27.00 um, 14.32 deg; mounted 18.00 um, 14.32 deg; \
                 operating 12.50 um, 14.32 deg",
                "fit of the inner ring: interference 10.00 um, pressure 4.20 MPa, groove diameter +8.93 um, lets go at \
                 27349 rpm"
            ]
        );
        let json = serde_json::to_value(ClearanceSummary::new(&report)).unwrap();
        assert_eq!(json["operating"]["radial_m"], 12.5e-6);
        let fits = serde_json::to_value(fits(Some(&report))).unwrap();
        assert_eq!(fits["inner"]["groove_growth_m"], 4.4635e-6);
        assert!(fits.get("outer").is_none());
    }
}
