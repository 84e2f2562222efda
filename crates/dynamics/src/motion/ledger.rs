//! The energy ledger: every joule in the model and every joule that came or went.
//!
//! total = kinetic + strain + Hertz energy, each body in its own frame. It may change only by work of loads (ball
//! centrifugal force is one), of imposed shaft displacements, of the turning frame (its inertia forces, and what the
//! drive gives because loads fixed in space turn against the ring), of patches that move and change size with the
//! contacts, of surfaces that move under them, and by dissipation. What is left is the defect: the error of the
//! scheme. A run whose defect exceeds its tolerance stops.

/// Energies and works, J, at the end of a step; works and losses are sums since the start.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Ledger {
    /// Kinetic energy of inner ring (with shaft), outer ring, balls.
    pub kinetic: [f64; 3],
    /// Strain energy of inner and outer ring.
    pub strain: [f64; 2],
    /// Energy of the local contacts.
    pub hertz: f64,
    /// Work of shaft, ring and ball loads.
    pub load_work: f64,
    /// Work of imposed shaft displacements, and of other bearings on the body that carries this one.
    pub imposed_work: f64,
    /// Work of the turning frame.
    pub frame_work: f64,
    /// Work of moving and resized patches.
    pub patch_work: f64,
    /// Work of surfaces that move under the contacts; 0 on smooth grooves.
    pub profile_work: f64,
    /// Work of temperatures that change: grooves and balls that grow against the forces of the contacts. 0 where
    /// temperatures are constant.
    pub temperature_work: f64,
    /// Energy lost to contact damping.
    pub contact_loss: f64,
    /// Energy lost to Rayleigh damping.
    pub rayleigh_loss: f64,
    /// Energy lost to the numerical dissipation of the integrator.
    pub numerical_loss: f64,
    /// Total at the start.
    pub initial: f64,
    /// Largest energy or work so far: the scale of the defect.
    pub largest: f64,
    /// Friction of free balls; None: balls are not free.
    pub friction: Option<FrictionLedger>,
    /// A free cage; None: there is none.
    pub cage: Option<CageLedger>,
}

/// What friction does where balls are free, J, since the start.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct FrictionLedger {
    /// Energy lost to friction: never falls.
    pub loss: f64,
    /// Part of it that the integrator adds, of the first order in the step where slip changes, and of either sign.
    pub integrator_share: f64,
    /// Work of the drives that keep both rings at their speeds against friction.
    pub drive_work: f64,
    /// Energy lost to the drag of balls: never falls.
    pub drag_loss: f64,
}

/// Energies of a free cage, and what its contacts do, J, since the start.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct CageLedger {
    /// Kinetic energy.
    pub kinetic: f64,
    /// Energy stored in pockets and on the land.
    pub strain: f64,
    /// Energy lost to impacts: never falls.
    pub impact_loss: f64,
    /// Energy lost to friction: never falls.
    pub friction_loss: f64,
    /// Part of it that the integrator adds, of either sign.
    pub integrator_share: f64,
    /// Energy lost to the drag of the land: never falls.
    pub drag_loss: f64,
    /// Work of the drive that keeps the ring of the land at its speed.
    pub drive_work: f64,
}

/// Share of the largest energy above which a user should know what the integrator took.
pub const LOSSY: f64 = 0.25;

impl Ledger {
    /// What the integrator took over the largest energy.
    pub fn numerical_share(&self) -> f64 {
        if self.largest > 0.0 {
            self.numerical_loss / self.largest
        } else {
            0.0
        }
    }

    /// Energy in the model.
    pub fn total(&self) -> f64 {
        let cage = self.cage.map_or(0.0, |cage| cage.kinetic + cage.strain);
        self.kinetic.iter().chain(&self.strain).sum::<f64>() + self.hertz + cage
    }

    /// Works since the start: of loads, imposed displacements, frame, patches, profiles, temperatures.
    pub fn works(&self) -> [f64; 6] {
        [
            self.load_work,
            self.imposed_work,
            self.frame_work,
            self.patch_work,
            self.profile_work,
            self.temperature_work,
        ]
    }

    /// Losses since the start: contact damping, Rayleigh damping, integrator.
    pub fn losses(&self) -> [f64; 3] {
        [self.contact_loss, self.rayleigh_loss, self.numerical_loss]
    }

    /// Energy that no work or loss explains.
    pub fn defect(&self) -> f64 {
        let works: f64 = self.works().iter().sum();
        let losses: f64 = self.losses().iter().sum();
        let defect = self.total() - self.initial - works + losses;
        let defect = match self.friction {
            Some(friction) => defect - friction.drive_work + friction.loss + friction.drag_loss,
            None => defect,
        };
        match self.cage {
            Some(cage) => defect - cage.drive_work + cage.impact_loss + cage.friction_loss + cage.drag_loss,
            None => defect,
        }
    }

    /// Notes the present energies as a candidate for the scale.
    pub fn note_scale(&mut self) {
        let entries = self.works().into_iter().chain(self.losses());
        let friction = self
            .friction
            .iter()
            .flat_map(|f| [f.loss, f.drive_work, f.drag_loss]);
        let cage = self
            .cage
            .iter()
            .flat_map(|c| [c.impact_loss, c.friction_loss, c.drag_loss, c.drive_work]);
        let largest = entries
            .chain(friction)
            .chain(cage)
            .fold(self.total().abs(), |m, w| m.max(w.abs()));
        self.largest = self.largest.max(largest);
    }

    /// Defect over the largest energy: positive is a gain that nothing explains, negative a loss.
    pub fn relative_defect(&self) -> f64 {
        if self.largest > 0.0 {
            self.defect() / self.largest
        } else {
            0.0
        }
    }
}
