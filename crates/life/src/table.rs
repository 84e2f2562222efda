//! The numbers of a life on the screen.

use comm::print;

use crate::assess::{Assessment, CatalogueLife, RacewayLife};
use crate::run::SweepLife;
use crate::spectrum::SpectrumLife;
use crate::stress_life::StressLife;

fn line(name: &str, value: &str) {
    print::line(format_args!("  {name:<34}{value}"));
}

fn kilonewton(value: f64) -> String {
    format!("{:.3} kN", 1e-3 * value)
}

/// A number with about five digits.
fn digits(value: f64) -> String {
    match value.abs() {
        size if size >= 1e6 || size < 1e-3 && size > 0.0 => format!("{value:.4e}"),
        size if size >= 1e3 => format!("{value:.1}"),
        size if size >= 10.0 => format!("{value:.2}"),
        _ => format!("{value:.4}"),
    }
}

fn or_dash(value: Option<f64>, shown: impl Fn(f64) -> String) -> String {
    value.map_or("-".to_string(), shown)
}

/// A life: millions of revolutions, and hours where the speed is known.
fn life(revolutions: Option<f64>, hours: Option<f64>) -> String {
    let millions = or_dash(revolutions, |life| {
        format!("{} million revolutions", digits(1e-6 * life))
    });
    hours.map_or(millions.clone(), |hours| {
        format!("{millions}, {} h", digits(hours))
    })
}

/// ISO 281.
pub fn print_catalogue(found: &CatalogueLife) {
    print::line(format_args!("ISO 281, catalogue"));
    line(
        "contact angle, pitch diameter",
        &format!(
            "{:.2} deg, {:.3} mm",
            found.contact_angle_rad.to_degrees(),
            1e3 * found.pitch_diameter_m
        ),
    );
    line("dynamic rating C_r", &kilonewton(found.c_r_n));
    line("static rating C_0r", &kilonewton(found.c_0r_n));
    line("fatigue load limit C_u", &kilonewton(found.c_u_n));
    line("equivalent load P", &or_dash(found.p_n, kilonewton));
    let safety = or_dash(found.static_safety, |s| {
        format!(", safety C_0r/P_0 {}", digits(s))
    });
    line(
        "static equivalent load P_0",
        &format!(
            "{}{}",
            or_dash(found.p_0_n, kilonewton),
            safety.trim_start_matches('-')
        ),
    );
    line("life L_10", &life(found.l10_revolutions, found.l10_hours));
    let reliability = format!("{} %, {}", found.reliability, found.a_1);
    line("reliability, a_1", &reliability);
    line("viscosity ratio kappa", &or_dash(found.kappa, digits));
    line("life L_nm", &life(found.l_nm_revolutions, None));
}

/// ISO 281 and ISO 16281.
pub fn print_assessment(found: &Assessment) {
    print_catalogue(&found.catalogue);
    print::line(format_args!(
        "ISO 16281, forces of the balls ({} grooves)",
        found.grooves
    ));
    let both = |shown: &dyn Fn(&RacewayLife) -> String| {
        format!("{:<16}{}", shown(&found.inner), shown(&found.outer))
    };
    line("", &format!("{:<16}outer", "inner"));
    line("rating of a ball Q_c, N", &both(&|ring| digits(ring.q_c_n)));
    line("equivalent force Q_e, N", &both(&|ring| digits(ring.q_e_n)));
    line(
        "life of the ring, million rev.",
        &both(&|ring| or_dash(ring.l10r_revolutions, |life| digits(1e-6 * life))),
    );
    line("reference load P_ref", &or_dash(found.p_ref_n, kilonewton));
    line("life L_10r", &life(found.l10r_revolutions, found.l10r_hours));
    line("a_ISO", &or_dash(found.a_iso, digits));
    line("life L_nmr", &life(found.l_nmr_revolutions, found.l_nmr_hours));
    let safety = or_dash(found.pressure_safety, digits);
    line(
        "largest pressure",
        &format!(
            "{:.0} MPa, 4200 MPa is {safety} times that",
            1e-6 * found.peak_pressure_pa
        ),
    );
    print_notes(&found.catalogue.notes);
}

/// What a reader must know.
pub fn print_notes(notes: &[String]) {
    for note in notes {
        let text = match note.starts_with("warning") {
            true => note.clone(),
            false => format!("note: {note}"),
        };
        print::line(format_args!("{text}"));
    }
}

/// A line per point of a sweep.
pub fn print_sweep(column: &str, points: &[(SweepLife, Assessment)]) {
    let width = column.len().max(14);
    print::line(format_args!(
        "{column:>width$} {:>12} {:>12} {:>12} {:>12} {:>12}",
        "P, N", "L_10, 1e6", "P_ref, N", "L_10r, 1e6", "L_nmr, 1e6"
    ));
    let million = |life: Option<f64>| or_dash(life, |life| digits(1e-6 * life));
    for (point, found) in points {
        let value = or_dash(point.value.filter(|value| !value.is_nan()), digits);
        print::line(format_args!(
            "{value:>width$} {:>12} {:>12} {:>12} {:>12} {:>12}",
            or_dash(found.catalogue.p_n, digits),
            million(found.catalogue.l10_revolutions),
            or_dash(found.p_ref_n, digits),
            million(found.l10r_revolutions),
            million(found.l_nmr_revolutions)
        ));
    }
    if let Some((_, last)) = points.last() {
        print_notes(&last.catalogue.notes);
    }
}

/// A line per condition, then all together.
pub fn print_spectrum(spectrum: &SpectrumLife) {
    if let Some(title) = &spectrum.title {
        print::line(format_args!("{title}"));
    }
    for condition in &spectrum.conditions {
        let found = &condition.life;
        let point = condition
            .point
            .map_or(String::new(), |point| format!(" point {point}"));
        print::line(format_args!(
            "{}{point}: {:.4} of time, {:.4} of the turns, L_10r {}",
            condition.results,
            condition.share,
            condition.share_of_turns,
            life(found.l10r_revolutions, found.l10r_hours)
        ));
    }
    print_assessment(&spectrum.whole);
}

/// Life from stress, as a ratio.
pub fn print_stress_life(found: &StressLife) {
    print::line(format_args!(
        "life from stress over that without {} (research)",
        found.left_out.join(", ")
    ));
    line("by loads and stress", &digits(found.ratio));
    line("by the loads alone", &digits(found.ratio_of_loads));
    line("by the stress of the rings alone", &digits(found.ratio_of_stress));
    for (name, ring) in [("inner", &found.inner), ("outer", &found.outer)] {
        line(&format!("{name} raceway, by both"), &digits(ring.ratio));
        line(
            &format!("{name} hoop stress, with, without"),
            &format!(
                "{:.1} MPa, {:.1} MPa",
                1e-6 * ring.hoop_stress_pa,
                1e-6 * ring.reference_hoop_stress_pa
            ),
        );
    }
    print_notes(&found.notes);
}
