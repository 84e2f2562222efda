//! Probes: single numbers of a run, a line per step in `probes.csv`. The scene's own documentation says what they are.

use anyhow::anyhow;
use contact::{Meridian, Side};
use dynamics::Model;
use dynamics::balls::BallResult;
use dynamics::kinematics::Speed;
use fem::stress::{NodeRecovery, von_mises};
use scene::{Analysis, Axes, ContactProbe, NodeTags, Scene};

use super::gauges::Gauges;
use super::on_ball::{force_on_ball, moment_on_ball};
use super::probe_places::{NodePlace, place, side_of};
use super::shown::{RingField, Shown, Turn, add};
use super::stress_points::{self, StressPoints};
use super::timed_near_field::TimedNearField;
use crate::failure::Failure;

/// The probes of a run, placed on its meshes.
pub struct PlacedProbes {
    nodes: Vec<PlacedNodeProbe>,
    /// Stress of the probed nodes of each ring, in the order of `nodes`; None where nothing is probed.
    recoveries: [Option<NodeRecovery>; 2],
    /// The probed nodes of each ring for the near field, if the scene asks for it.
    near_fields: [Option<TimedNearField>; 2],
    contacts: Vec<ContactProbe>,
    points: Option<StressPoints>,
    profiles: Option<StressPoints>,
    gauges: Gauges,
    /// Name and speed.
    tachometers: Vec<(String, Speed)>,
}

/// Profile, number of the point, and azimuth, groove angle, depth and stress in SI.
pub type ProfileRow = (String, usize, Vec<f64>);

struct PlacedNodeProbe {
    place: NodePlace,
    side: Side,
    axes: Axes,
    has_acceleration: bool,
}

const CYLINDRICAL: [&str; 6] = ["rr", "tt", "zz", "rt", "tz", "rz"];
const CARTESIAN: [&str; 6] = ["xx", "yy", "zz", "xy", "yz", "xz"];

impl PlacedProbes {
    /// Finds the nodes of a scene's probes; None when it has no probes, and then nothing is made.
    pub fn new(scene: &Scene, model: &Model, tags: &NodeTags) -> Result<Option<PlacedProbes>, Failure> {
        if scene.probes.is_empty() {
            return Ok(None);
        }
        require_motion(scene)?;
        let find = |probe: &scene::NodeProbe| {
            let side = side_of(probe.ring);
            let (ring, tags) = match (model.ring(side), &tags[side.index()]) {
                (Some(ring), Some(tags)) => (ring, tags),
                _ => unreachable!("the scene refuses nodes of rigid rings"),
            };
            Ok::<_, Failure>(PlacedNodeProbe {
                place: place(probe, ring, tags)?,
                side,
                axes: probe.axes,
                has_acceleration: probe.has_acceleration,
            })
        };
        let nodes: Vec<PlacedNodeProbe> = scene.probes.nodes.iter().map(find).collect::<Result<_, _>>()?;
        let recovery = |side: Side| {
            let own = nodes.iter().filter(|probe| probe.side == side);
            let own: Vec<usize> = own.map(|probe| probe.place.node).collect();
            match model.ring(side) {
                Some(ring) if !own.is_empty() => {
                    Ok(Some(NodeRecovery::new(&ring.mesh, &ring.material, &own)?))
                }
                _ => Ok::<_, Failure>(None),
            }
        };
        let reach = scene.stress.near_field_reach;
        let near_field = |side: Side| {
            let (ring, reach) = (model.ring(side)?, reach?);
            let own = nodes.iter().filter(|probe| probe.side == side);
            let positions: Vec<[f64; 3]> = own.map(|probe| ring.mesh.nodes[probe.place.node]).collect();
            (!positions.is_empty()).then(|| TimedNearField::new(ring, reach, &positions))
        };
        let lines = |lines: &[scene::StressLine]| {
            let some = !lines.is_empty();
            some.then(|| StressPoints::new(lines, model, reach)).transpose()
        };
        let tachometer = |probe: &scene::Tachometer| {
            let speeds = scene
                .speed
                .as_ref()
                .expect("the scene refuses a tachometer without a speed");
            (probe.name.clone(), speeds.of(side_of(probe.ring)).clone())
        };
        Ok(Some(PlacedProbes {
            near_fields: Side::BOTH.map(near_field),
            points: lines(&scene.probes.points)?,
            profiles: lines(&scene.probes.profiles)?,
            recoveries: Side::try_both(recovery)?,
            nodes,
            contacts: scene.probes.contacts.clone(),
            gauges: Gauges::new(&scene.probes.gauges, model)?,
            tachometers: scene.probes.tachometers.iter().map(tachometer).collect(),
        }))
    }

    /// Nodes of a ring that are probed.
    pub fn nodes(&self, side: Side) -> Vec<usize> {
        let own = self.nodes.iter().filter(|probe| probe.side == side);
        own.map(|probe| probe.place.node).collect()
    }

    /// Nodes that are probed and where they lie.
    pub fn places(&self) -> impl Iterator<Item = &NodePlace> {
        self.nodes.iter().map(|probe| &probe.place)
    }

    /// Seconds spent on near fields so far; None where no probe has one.
    pub fn near_field_seconds(&self) -> Option<f64> {
        let lines = [&self.points, &self.profiles].into_iter().flatten();
        let of_lines = lines.filter_map(StressPoints::near_field_seconds);
        let of_nodes = self.near_fields.iter().flatten().map(TimedNearField::seconds);
        of_nodes.chain(of_lines).reduce(|a, b| a + b)
    }

    /// Names of the columns of probes, without step and time; None where there are only profiles.
    pub fn columns(&self) -> Option<Vec<String>> {
        let mut columns = Vec::new();
        for probe in &self.nodes {
            let name = &probe.place.name;
            let (pairs, axes) = match probe.axes {
                Axes::Cylindrical => (CYLINDRICAL, ["r", "t", "z"]),
                Axes::Cartesian => (CARTESIAN, ["x", "y", "z"]),
            };
            columns.extend(pairs.map(|ij| format!("{name}_stress_{ij}_pa")));
            columns.push(format!("{name}_von_mises_pa"));
            columns.extend(axes.map(|i| format!("{name}_displacement_{i}_m")));
            if probe.has_acceleration {
                columns.extend(axes.map(|i| format!("{name}_acceleration_{i}_m_per_s2")));
            }
        }
        for ContactProbe { name, .. } in &self.contacts {
            columns.extend(["x", "y", "z"].map(|i| format!("{name}_force_{i}_n")));
            columns.push(format!("{name}_force_n"));
            columns.extend(["x", "y", "z"].map(|i| format!("{name}_moment_{i}_n_m")));
            columns.push(format!("{name}_moment_n_m"));
        }
        for line in self.points.iter().flat_map(StressPoints::lines) {
            columns.extend(stress_points::COLUMNS.map(|column| format!("{}_{column}", line.name)));
        }
        columns.extend(self.gauges.columns());
        columns.extend(
            self.tachometers
                .iter()
                .map(|(name, _)| format!("{name}_angle_rad")),
        );
        (!columns.is_empty()).then_some(columns)
    }

    /// Names of the columns of profiles, without step and time; None without profiles.
    pub fn profile_columns(&self) -> Option<Vec<String>> {
        self.profiles.as_ref()?;
        let place = ["profile", "point", "azimuth_rad", "groove_angle_rad", "depth_m"];
        let names = place.iter().chain(&stress_points::COLUMNS);
        Some(names.map(|name| name.to_string()).collect())
    }

    /// Rows of the profiles at one instant: name, number of the point, and numbers in SI.
    pub fn profile_rows(&self, shown: &Shown<'_>) -> Result<Vec<ProfileRow>, Failure> {
        let Some(profiles) = &self.profiles else {
            return Ok(Vec::new());
        };
        let mut values = profiles.values(shown)?.into_iter();
        let mut rows = Vec::new();
        for line in profiles.lines() {
            for (i, place) in line.points().into_iter().enumerate() {
                let stress = values.next().expect("a stress per point of every line");
                rows.push((line.name.clone(), i, [&place[..], &stress[..]].concat()));
            }
        }
        Ok(rows)
    }

    /// Values of the columns at one instant, SI.
    pub fn values(&self, shown: &Shown<'_>) -> Result<Vec<f64>, Failure> {
        let mut rings = [None, None];
        for side in Side::BOTH {
            let Some(recovery) = &self.recoveries[side.index()] else {
                continue;
            };
            if let Some(ring) = shown.ring_at(side, recovery.nodes()) {
                let mut stress = recovery.stress(&ring.strained);
                if let Some(own) = &ring.own_stress {
                    add(&mut stress, &recovery.pick(&own.nodal));
                }
                if let Some(near_field) = &self.near_fields[side.index()] {
                    near_field.add(&shown.patches(side).map_err(Failure::solving)?, &mut stress);
                }
                rings[side.index()] = Some((ring, stress.into_iter()));
            }
        }
        let accelerations = Side::BOTH.map(|side| self.accelerations(shown, side));
        let mut values = Vec::new();
        for probe in &self.nodes {
            let Some((ring, stress)) = &mut rings[probe.side.index()] else {
                unreachable!("a ring with probed nodes has a field while it is shown")
            };
            let stress = stress.next().expect("one stress per probed node of the ring");
            values.extend(node_values(probe, ring, stress));
            if let Some(field) = accelerations[probe.side.index()]
                .as_ref()
                .filter(|_| probe.has_acceleration)
            {
                values.extend(node_acceleration(probe, ring, field));
            }
        }
        let balls = shown.balls();
        for probe in &self.contacts {
            values.extend(contact_values(probe, shown.model(), &balls[probe.ball]));
        }
        if let Some(points) = &self.points {
            values.extend(points.values(shown)?.into_iter().flatten());
        }
        values.extend(self.gauges.values(shown));
        values.extend(
            self.tachometers
                .iter()
                .map(|(_, speed)| speed.angle(shown.time())),
        );
        Ok(values)
    }
}

impl PlacedProbes {
    /// Accelerations of a ring where a probe asks for them, m/s^2, `[n_nodes][3]` flat.
    fn accelerations(&self, shown: &Shown<'_>, side: Side) -> Option<Vec<f64>> {
        let own = self.nodes.iter();
        let own = own.filter(|probe| probe.side == side && probe.has_acceleration);
        let nodes: Vec<usize> = own.map(|probe| probe.place.node).collect();
        match nodes.is_empty() {
            true => None,
            false => shown.accelerations_at(side, &nodes),
        }
    }
}

/// Fails where nothing has an acceleration.
fn require_motion(scene: &Scene) -> Result<(), Failure> {
    let probes = &mut scene.probes.nodes.iter();
    match (probes.find(|probe| probe.has_acceleration), &scene.analysis) {
        (None, _) | (_, Analysis::Dynamic(_)) => Ok(()),
        (Some(probe), _) => Err(Failure::User(anyhow!(
            "probes.node.{}.acceleration is true, but only a motion has accelerations; expected [dynamic], or leave it \
             out",
            probe.name
        ))),
    }
}

/// Acceleration of a node along the axes of its probe.
fn node_acceleration(probe: &PlacedNodeProbe, ring: &RingField<'_>, field: &[f64]) -> [f64; 3] {
    let node = probe.place.node;
    let own = [0, 1, 2].map(|i| field[3 * node + i]);
    match probe.axes {
        Axes::Cylindrical => Turn::new(-probe.place.azimuth_rad).vector(own),
        Axes::Cartesian => ring.turn.vector(own),
    }
}

/// Stress, von Mises stress and displacement of a node.
fn node_values(probe: &PlacedNodeProbe, ring: &RingField<'_>, stress: [f64; 6]) -> Vec<f64> {
    let node = probe.place.node;
    let in_space = ring.turn.tensor(stress);
    let (tensor, displacement) = match probe.axes {
        Axes::Cylindrical => {
            let back = Turn::new(-probe.place.azimuth_rad);
            (back.tensor(stress), back.vector(ring.displacement(node)))
        }
        Axes::Cartesian => (in_space, ring.shown_displacement(node)),
    };
    // An invariant, evaluated as the step files have it.
    [&tensor[..], &[von_mises(in_space)], &displacement].concat()
}

/// Force of the ring on the ball and its moment about the probe's point, each with its size.
fn contact_values(probe: &ContactProbe, model: &Model, ball: &BallResult) -> Vec<f64> {
    let side = side_of(probe.ring);
    let force = force_on_ball(side, ball);
    let Meridian { radial, axial } = model.geometry.ball_centre();
    let (sin, cos) = ball.azimuth_rad.sin_cos();
    let radius = radial + ball.displacement_m.radial;
    let centre = [radius * cos, radius * sin, axial + ball.displacement_m.axial];
    let arm = [0, 1, 2].map(|i| centre[i] - probe.about[i]);
    let lever = model.contact_lever(probe.ball, ball.contact(side).approach_m);
    let moment = moment_on_ball(side, ball, arm, lever);
    let size = |v: [f64; 3]| v[0].hypot(v[1]).hypot(v[2]);
    [&force[..], &[size(force)], &moment, &[size(moment)]].concat()
}
