//! Scenes that differ from a given one in a single effect.

use scene::{Analysis, ContactMode, FlexibleRing, Ring, Scene, StressOutput, Support};

/// Name and `--set` arguments of a variant.
pub type Variant = (String, Vec<String>);

/// An effect with a table of its own, and the values that a scene without it gets.
struct Entry {
    name: &'static str,
    is_on: bool,
    /// `--set` arguments that turn it on; none when it cannot be turned on in this scene.
    on: Option<(&'static str, &'static [&'static str])>,
}

/// Every effect that is on turned off, and every other turned on as far as the scene allows.
pub fn of(scene: &Scene) -> Vec<Variant> {
    let mut variants: Vec<Variant> = entries(scene).iter().filter_map(|e| variant(scene, e)).collect();
    for (name, ring) in [("inner", &scene.inner), ("outer", &scene.outer)] {
        variants.extend(ring_variants(scene, name, ring));
    }
    variants.extend(near_field(scene));
    variants.extend(without_inertia(scene));
    variants
}

fn entries(scene: &Scene) -> Vec<Entry> {
    let e = &scene.effects;
    let turns = scene.speed.is_some();
    let moves = matches!(scene.analysis, Analysis::Dynamic(_));
    let when = |condition: bool, on| condition.then_some(on);
    vec![
        Entry {
            name: "gravity",
            is_on: e.gravity.is_some(),
            on: when(
                true,
                (
                    "9.81 m/s2 along -y",
                    &[
                        "effects.gravity.acceleration=9.81 m/s2",
                        "effects.gravity.direction=[0.0, -1.0, 0.0]",
                    ][..],
                ),
            ),
        },
        Entry {
            name: "ball_centrifugal",
            is_on: e.ball_centrifugal,
            on: when(turns, ("", &["effects.ball_centrifugal={}"][..])),
        },
        Entry {
            name: "gyroscopic_moment",
            is_on: e.gyroscopic_moment.is_some(),
            on: when(
                turns,
                ("outer raceway control", &["effects.gyroscopic_moment={}"][..]),
            ),
        },
        Entry {
            name: "cage_slip",
            is_on: e.cage_slip.is_some(),
            on: when(
                turns,
                (
                    "2 % at the inner raceway",
                    &["effects.cage_slip.inner=0.02", "effects.cage_slip.outer=0.0"][..],
                ),
            ),
        },
        Entry {
            name: "frame_rotation",
            is_on: e.frame_rotation,
            on: when(
                turns && scene.inner.body.is_some(),
                ("", &["effects.frame_rotation={}"][..]),
            ),
        },
        Entry {
            name: "contact_damping",
            is_on: e.contact_damping.is_some(),
            on: when(
                moves,
                (
                    "0.05 N s/mm from 1 um on",
                    &[
                        "effects.contact_damping.coefficient=5e-2 N s/mm",
                        "effects.contact_damping.full_approach=1 um",
                    ][..],
                ),
            ),
        },
        Entry {
            name: "rayleigh_damping",
            is_on: e.rayleigh_damping.is_some(),
            on: when(
                moves,
                (
                    "1e-7 s times stiffness",
                    &[
                        "effects.rayleigh_damping.mass=0 1/s",
                        "effects.rayleigh_damping.stiffness=1e-7 s",
                    ][..],
                ),
            ),
        },
    ]
}

fn variant(scene: &Scene, entry: &Entry) -> Option<Variant> {
    if entry.is_on {
        let mut set = vec![format!("effects.{}=none", entry.name)];
        set.extend(unused_speed(scene, entry.name));
        return Some((format!("{} off", entry.name), set));
    }
    let (how, set) = entry.on?;
    let name = match how {
        "" => format!("{} on", entry.name),
        how => format!("{} on, {how}", entry.name),
    };
    Some((name, set.iter().map(|s| s.to_string()).collect()))
}

/// At rest a speed without an effect that uses it is refused: it goes with the last of them.
fn unused_speed(scene: &Scene, off: &str) -> Option<String> {
    let e = &scene.effects;
    let users = [
        ("ball_centrifugal", e.ball_centrifugal),
        ("gyroscopic_moment", e.gyroscopic_moment.is_some()),
        ("frame_rotation", e.frame_rotation),
    ];
    let is_at_rest = matches!(scene.analysis, Analysis::Static | Analysis::Sweep(_));
    let is_last = users.iter().all(|(name, is_on)| !is_on || *name == off);
    let is_user = users.iter().any(|(name, _)| *name == off);
    (is_at_rest && is_user && is_last).then(|| "speed=none".to_string())
}

/// A flexible ring made rigid, and held the other way.
fn ring_variants(scene: &Scene, name: &str, ring: &Ring) -> Vec<Variant> {
    let Some(FlexibleRing { support, .. }) = &ring.body else {
        return Vec::new();
    };
    let mut rigid = vec![format!("{name}.flexible=false")];
    if name == "inner" && scene.effects.frame_rotation {
        rigid.push("effects.frame_rotation=none".to_string());
        rigid.extend(unused_speed(scene, "frame_rotation"));
    }
    // Probes of a ring without a mesh are refused.
    let probes = scene.probes.nodes.iter().filter(|p| p.ring.key() == name);
    rigid.extend(probes.map(|p| format!("probes.node.{}=none", p.name)));
    for (table, lines) in [
        ("point", &scene.probes.points),
        ("profile", &scene.probes.profiles),
    ] {
        let own = lines.iter().filter(|line| line.ring.key() == name);
        rigid.extend(own.map(|line| format!("probes.{table}.{}=none", line.name)));
    }
    let is_other_rigid = [&scene.inner, &scene.outer].iter().any(|r| r.body.is_none());
    if is_other_rigid || scene.contact.mode == ContactMode::Rigid {
        rigid.push("contact.mode=rigid".to_string());
        if scene.stress.near_field_reach.is_some() {
            rigid.push("stress=none".to_string());
        }
    }
    let (held, other) = match support {
        Support::Clamped => ("held in its mean motion", "mean_motion"),
        Support::MeanMotion => ("clamped", "clamped"),
    };
    vec![
        (format!("{name} ring rigid"), rigid),
        (
            format!("{name} ring {held}"),
            vec![format!("{name}.support={other}")],
        ),
    ]
}

/// The near field of contacts, where there is stress to correct.
fn near_field(scene: &Scene) -> Option<Variant> {
    if scene.stress.near_field_reach.is_some() {
        return Some(("near field off".to_string(), vec!["stress=none".to_string()]));
    }
    let probes = &scene.probes;
    let has_stress = scene.output.stress != StressOutput::None
        || !(probes.nodes.is_empty() && probes.points.is_empty() && probes.profiles.is_empty());
    let is_flexible = [&scene.inner, &scene.outer].iter().any(|r| r.body.is_some());
    let is_possible = is_flexible && has_stress && scene.contact.mode == ContactMode::Patch;
    is_possible.then(|| {
        (
            "near field on".to_string(),
            vec!["stress.near_field=true".to_string()],
        )
    })
}

/// A motion as a series of equilibria, without damping.
fn without_inertia(scene: &Scene) -> Option<Variant> {
    let Analysis::Dynamic(dynamic) = &scene.analysis else {
        return None;
    };
    let mut set = vec![
        "dynamic=none".to_string(),
        format!("quasi_static.duration={:?} s", dynamic.duration),
        format!("quasi_static.step={:?} s", dynamic.step),
        format!("quasi_static.output_every={}", dynamic.output_every),
    ];
    if scene.effects.contact_damping.is_some() {
        set.push("effects.contact_damping=none".to_string());
    }
    if scene.effects.rayleigh_damping.is_some() {
        set.push("effects.rayleigh_damping=none".to_string());
    }
    Some(("inertia off (quasi-static)".to_string(), set))
}

#[cfg(test)]
mod tests {
    use super::*;
    use scene::MeshFiles;

    const SCENE: &str = include_str!("../../../../tests/fixtures/7010c.toml");

    fn scene(set: &[String]) -> Scene {
        Scene::parse(SCENE, "scene.toml".as_ref(), set, MeshFiles::MayBeMissing).unwrap()
    }

    /// Wrong: a variant of a scene with near field and probes would be refused, or a scene without stress offered a near field.
    #[test]
    fn every_variant_of_a_scene_with_near_field_is_sound() {
        let point = "probes.point.p={ ring = \"outer\", azimuth = \"0 deg\", groove_angle = \"19 deg\", depth = \"0 mm\" }";
        let line = "probes.profile.q={ ring = \"outer\", azimuth = \"0 deg\", groove_angle = \"19 deg\", \
                    depth = [\"0 mm\", \"1 mm\"], points = 3 }";
        let base = ["stress.near_field=true", "inner.flexible=false", point, line].map(str::to_string);
        let variants = of(&scene(&base));
        for (name, set) in &variants {
            scene(&[&base[..], set].concat());
            assert_ne!(name, "near field on");
        }
        let off = variants.iter().find(|(name, _)| name == "near field off");
        assert!(
            scene(&[&base[..], &off.unwrap().1].concat())
                .stress
                .near_field_reach
                .is_none()
        );
        let silent = scene(&["output.stress=none".to_string()]);
        assert!(
            of(&silent)
                .iter()
                .all(|(name, _)| !name.starts_with("near field"))
        );
    }
}
