//! Scenes that differ from a given one in a single effect.

use dynamics::effects::{About, Context, EffectEntry, SpeedRole};
use scene::{Analysis, ContactMode, FlexibleRing, Ring, Scene, StressOutput, Support};

/// Name and `--set` arguments of a variant.
pub type Variant = (String, Vec<String>);

/// Every effect that is on turned off, and every other turned on as far as the scene allows.
pub fn of(scene: &Scene) -> Vec<Variant> {
    let effects = scene.effects.list();
    let mut variants: Vec<Variant> = effects.iter().filter_map(|e| variant(scene, *e)).collect();
    for (name, ring) in [("inner", &scene.inner), ("outer", &scene.outer)] {
        variants.extend(ring_variants(scene, name, ring));
    }
    variants.extend(near_field(scene));
    variants.extend(without_inertia(scene));
    variants
}

/// An effect turned off, or on with the values of its trial where the scene allows it; None for a load that is not
/// varied.
fn variant(scene: &Scene, entry: &dyn EffectEntry) -> Option<Variant> {
    let about = entry.about();
    let (name, trial) = (about.name, about.trial?);
    if entry.table().is_some() {
        let mut set = vec![format!("effects.{name}=none")];
        set.extend(unused_speed(scene, about));
        return Some((format!("{name} off"), set));
    }
    if !about.fits(scene::effects_context(scene)) {
        return None;
    }
    let set = match trial.keys {
        [] => vec![format!("effects.{name}={{}}")],
        keys => keys
            .iter()
            .map(|(key, value)| format!("effects.{name}.{key}={value}"))
            .collect(),
    };
    Some(match trial.what {
        "" => (format!("{name} on"), set),
        what => (format!("{name} on, {what}"), set),
    })
}

/// At rest a speed without an effect that uses it is refused: it goes with the last of them.
fn unused_speed(scene: &Scene, off: About) -> Option<String> {
    let is_user = |about: About| matches!(about.speed, SpeedRole::Force | SpeedRole::BallForce);
    let mut others = scene.effects.list().into_iter().filter(|e| e.table().is_some());
    let is_at_rest = matches!(scene.analysis, Analysis::Static | Analysis::Sweep(_));
    let is_last = others.all(|e| !is_user(e.about()) || e.about().name == off.name);
    (is_at_rest && is_user(off) && is_last).then(|| "speed=none".to_string())
}

/// Takes out the effects that the scene has and that do nothing once `change` has changed what they go with.
fn idle(scene: &Scene, change: impl Fn(&mut Context)) -> Vec<String> {
    let mut context = scene::effects_context(scene);
    change(&mut context);
    let entries = scene.effects.list().into_iter().filter(|e| e.table().is_some());
    let idle = entries.map(|e| e.about()).filter(|about| !about.fits(context));
    idle.flat_map(|about| {
        let off = format!("effects.{}=none", about.name);
        [Some(off), unused_speed(scene, about)].into_iter().flatten()
    })
    .collect()
}

/// A flexible ring made rigid, and held the other way.
fn ring_variants(scene: &Scene, name: &str, ring: &Ring) -> Vec<Variant> {
    let Some(FlexibleRing { support, .. }) = &ring.body else {
        return Vec::new();
    };
    let mut rigid = vec![format!("{name}.flexible=false")];
    rigid.extend(idle(scene, |context| {
        context.is_flexible[usize::from(name == "outer")] = false;
    }));
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
    let gauges = scene
        .probes
        .gauges
        .iter()
        .filter(|gauge| gauge.ring.key() == name);
    rigid.extend(gauges.map(|gauge| format!("probes.gauge.{}=none", gauge.name)));
    let is_other_rigid = [&scene.inner, &scene.outer].iter().any(|r| r.body.is_none());
    if is_other_rigid || scene.contact.mode == ContactMode::Rigid {
        rigid.push("contact.mode=rigid".to_string());
        if scene.stress.near_field_reach.is_some() {
            rigid.push("stress=none".to_string());
        }
    }
    let (held, other) = match support {
        Support::Clamped => ("held in its mean motion", "mean_motion"),
        Support::MeanMotion | Support::Body => ("clamped", "clamped"),
    };
    let mut held_so = vec![format!("{name}.support={other}")];
    if *support == Support::Body {
        // Neither a rigid ring nor one that is held otherwise takes a body.
        rigid.push("body=none".to_string());
        held_so.push("body=none".to_string());
    }
    vec![
        (format!("{name} ring rigid"), rigid),
        (format!("{name} ring {held}"), held_so),
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
    set.extend(idle(scene, |context| context.is_without_inertia = true));
    // What stands in space needs no stiffness by the stress of turning, so that an equilibrium refuses it.
    let frame = scene.effects.frame_rotation.as_ref();
    if frame.is_some_and(|frame| frame.stress_stiffening) {
        set.push("effects.frame_rotation.stress_stiffening=false".to_string());
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

    /// Wrong: a motion with stiffness by the stress of turning would lose its equilibria, which refuse that key.
    #[test]
    fn every_variant_of_a_motion_with_stressed_rings_is_sound() {
        let base = [
            "static=none",
            "dynamic={ duration = \"1 ms\", step = \"10 us\", output_every = 10 }",
            "shaft.mass=\"0.5 kg\"",
            "speed.inner=\"1800 rpm\"",
            "effects.frame_rotation.stress_stiffening=true",
        ];
        let base = base.map(str::to_string);
        let variants = of(&scene(&base));
        for (_, set) in &variants {
            scene(&[&base[..], set].concat());
        }
        assert!(variants.iter().any(|(name, _)| name.starts_with("inertia off")));
    }

    /// Wrong: a variant of a scene with near field and probes would be refused, or a scene without stress offered a
    /// near field.
    #[test]
    fn every_variant_of_a_scene_with_near_field_is_sound() {
        let point = "probes.point.p={ ring = \"outer\", azimuth = \"0 deg\", groove_angle = \"19 deg\", depth = \"0 \
                     mm\" }";
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
