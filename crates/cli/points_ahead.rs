//! Points of a run, solved on all threads ahead of the one that is written: of one bearing or of a list of them.
//!
//! What a point starts from follows from its number ([`dynamics::points`]), so that the bits do not depend on what is
//! solved at the same time. The caller takes the points in order. Of those that it has not taken yet at most
//! [`most_ahead`] are solved or under way, which bounds the memory. On one thread, and where ranks share the rings,
//! each point is solved when it is asked for.

use std::collections::{BTreeMap, VecDeque};
use std::panic::{AssertUnwindSafe, catch_unwind, resume_unwind};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{Receiver, Sender, channel};
use std::thread;

use assembly::points::{AssemblyPoint, AssemblyPointStart};
use dynamics::points::{PointStart, SolvedPoint, again_from, most_ahead, threads_of_points};
use rayon::Scope;
use results::failure::Failure;

/// The equilibrium of a point.
pub trait FoundPoint: Send {
    /// What it leaves to those that start from it.
    type Start: Clone + Send + Sync;

    /// The same of this one.
    fn start(&self) -> Self::Start;
}

/// A point with what else was made for it.
pub type PointAnswer<P, M> = Result<(P, M), Failure>;

/// Finds the equilibrium of a point, the first is 0, from another one.
pub type PointSolver<'a, P, M> =
    dyn Fn(u64, Option<&<P as FoundPoint>::Start>) -> PointAnswer<P, M> + Sync + 'a;

/// What a run goes on from.
#[derive(Clone)]
pub struct Taken<S> {
    /// The last point that was taken.
    pub n: u64,
    /// What it leaves.
    pub before: S,
    /// What the next ones start from.
    pub start: S,
    /// What it was found from itself; None: from zero displacement.
    pub from: Option<S>,
}

/// Points that start from the same one, in order.
#[derive(Clone, Copy)]
pub struct Grouping {
    /// How many these are.
    pub size: u64,
    /// The last of all points.
    pub last: u64,
}

/// The points ahead of the one that was taken last.
pub struct PointsAhead<'s, 'scope, P: FoundPoint, M> {
    /// Where points are solved at the same time; None: when they are asked for.
    scope: Option<&'s Scope<'scope>>,
    solve: &'scope PointSolver<'scope, P, M>,
    group: Grouping,
    taken: Option<Taken<P::Start>>,
    /// The last point whose followers wait or are under way.
    followed: Option<u64>,
    /// Points whose start is known, in the order in which they are solved.
    waiting: VecDeque<(u64, Arc<P::Start>)>,
    /// Points solved or under way.
    ahead: usize,
    found: BTreeMap<u64, thread::Result<PointAnswer<P, M>>>,
    answers: Answers<P, M>,
    /// Set once no more points are asked for.
    has_ended: Arc<AtomicBool>,
}

impl<P: FoundPoint, M> Drop for PointsAhead<'_, '_, P, M> {
    fn drop(&mut self) {
        self.end();
    }
}

impl<P: FoundPoint, M> PointsAhead<'_, '_, P, M> {
    /// No more points are asked for: those that nobody has begun are not solved.
    pub fn end(&self) {
        self.has_ended.store(true, Ordering::Relaxed);
    }
}

type NumberedAnswer<P, M> = (u64, thread::Result<PointAnswer<P, M>>);

type Answers<P, M> = (Sender<NumberedAnswer<P, M>>, Receiver<NumberedAnswer<P, M>>);

impl<'s, 'scope, P: FoundPoint, M: Send> PointsAhead<'s, 'scope, P, M> {
    /// Those of a run from its beginning, or of one that goes on.
    pub fn new(
        scope: &'s Scope<'scope>,
        solve: &'scope PointSolver<'scope, P, M>,
        group: Grouping,
        taken: Option<Taken<P::Start>>,
    ) -> PointsAhead<'s, 'scope, P, M> {
        let at_once = threads_of_points() > 1 && group.size > 1;
        let mut points = PointsAhead {
            scope: at_once.then_some(scope),
            solve,
            group,
            taken: None,
            followed: None,
            waiting: VecDeque::new(),
            ahead: 0,
            found: BTreeMap::new(),
            answers: channel(),
            has_ended: Arc::default(),
        };
        if let Some(taken) = taken {
            let first = taken.n / group.size * group.size;
            points.taken = Some(taken.clone());
            points.follow(first, taken.start);
        }
        points
    }

    /// What a run goes on from after the last point that was taken, if there is one.
    pub fn taken(&self) -> Option<&Taken<P::Start>> {
        self.taken.as_ref()
    }

    /// The next point. After a failure there is none.
    pub fn take(&mut self) -> PointAnswer<P, M> {
        let n = self.taken.as_ref().map_or(0, |taken| taken.n + 1);
        let first = match n > 0 && self.scope.is_some() {
            true => self.wait_for(n),
            false => (self.solve)(n, self.taken.as_ref().map(|taken| &taken.start)),
        };
        let again = again_from(n, self.group.size).and(self.taken.as_ref());
        let ((point, made), is_again) = match (first, again) {
            (Err(_), Some(taken)) => ((self.solve)(n, Some(&taken.before))?, true),
            (first, _) => (first?, false),
        };
        let from = self.taken.as_ref().map(|taken| match is_again {
            true => taken.before.clone(),
            false => taken.start.clone(),
        });
        let before = point.start();
        let start = match self.taken.take() {
            Some(taken) if !n.is_multiple_of(self.group.size) => taken.start,
            _ => before.clone(),
        };
        if n.is_multiple_of(self.group.size) {
            self.follow(n, start.clone());
        }
        self.taken = Some(Taken {
            n,
            before,
            start,
            from,
        });
        self.hand_out();
        Ok((point, made))
    }

    /// The points that start from point `n` may be solved. The last of them is the first: more points start from it.
    fn follow(&mut self, n: u64, start: P::Start) {
        if self.scope.is_none() || self.followed.is_some_and(|followed| followed >= n) {
            return;
        }
        self.followed = Some(n);
        let next = self.taken.as_ref().map_or(n, |taken| taken.n.max(n)) + 1;
        let (end, start) = (n + self.group.size, Arc::new(start));
        let others = next..end.min(self.group.last + 1);
        let order = (end <= self.group.last).then_some(end).into_iter().chain(others);
        self.waiting
            .extend(order.map(|point| (point, Arc::clone(&start))));
        self.hand_out();
    }

    /// Has points solved while not too many are ahead.
    fn hand_out(&mut self) {
        let Some(scope) = self.scope else { return };
        while self.ahead < most_ahead(threads_of_points())
            && let Some((n, start)) = self.waiting.pop_front()
        {
            let (solve, answer) = (self.solve, self.answers.0.clone());
            let has_ended = Arc::clone(&self.has_ended);
            self.ahead += 1;
            scope.spawn(move |_| {
                if has_ended.load(Ordering::Relaxed) {
                    return;
                }
                let found = catch_unwind(AssertUnwindSafe(|| solve(n, Some(&start))));
                // Nobody waits for it where the run has ended early.
                let _ = answer.send((n, found));
            });
        }
    }

    /// A point that is under way or waits.
    fn wait_for(&mut self, n: u64) -> PointAnswer<P, M> {
        loop {
            while let Ok(found) = self.answers.1.try_recv() {
                self.note(found);
            }
            if let Some(found) = self.found.remove(&n) {
                self.ahead -= 1;
                return found.unwrap_or_else(|panic| resume_unwind(panic));
            }
            let found = self.answers.1.recv();
            self.note(found.expect("a sender is kept here"));
        }
    }

    fn note(&mut self, (n, found): NumberedAnswer<P, M>) {
        if n.is_multiple_of(self.group.size)
            && let Ok(Ok((point, _))) = &found
        {
            self.follow(n, point.start());
        }
        self.found.insert(n, found);
    }
}

impl FoundPoint for SolvedPoint {
    type Start = PointStart;

    fn start(&self) -> PointStart {
        SolvedPoint::start(self)
    }
}

impl FoundPoint for AssemblyPoint {
    type Start = AssemblyPointStart;

    fn start(&self) -> AssemblyPointStart {
        AssemblyPoint::start(self)
    }
}

#[cfg(test)]
mod tests {
    use std::path::PathBuf;
    use std::sync::Mutex;

    use anyhow::anyhow;
    use dynamics::kinematics::{Rolling, Speed};
    use dynamics::points::points_per_start;
    use dynamics::{Model, QuasiStaticMotion};
    use scene::{Scene, build_model};

    use super::*;

    const LAST: u64 = 19;

    fn rigid() -> Model {
        let path = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("scenes/7010c_radial_sweep.toml");
        let rigid = ["inner.flexible=false", "outer.flexible=false"].map(String::from);
        build_model(&Scene::load(&path, &rigid).unwrap()).unwrap().0
    }

    /// Bits of all points where those of `hard` have no equilibrium but from the point just before them, and from which
    /// displacements each hard one was found.
    fn bits(n_threads: usize, hard: &[u64]) -> (Vec<String>, Vec<String>) {
        let model = rigid();
        let rolling = Rolling::new(&model.geometry, Speed::constant(188.5), [0.0; 2]);
        let bearing = QuasiStaticMotion::new(&model, rolling, 2e-4).unwrap();
        let (all, found) = (Mutex::new(BTreeMap::new()), Mutex::new(Vec::new()));
        let solve = |n: u64, from: Option<&PointStart>| -> PointAnswer<SolvedPoint, ()> {
            let text = format!("{from:?}");
            let before = n
                .checked_sub(1)
                .and_then(|before| all.lock().unwrap().get(&before).cloned());
            if hard.contains(&n) && before.is_none_or(|before| before != text) {
                return Err(Failure::Numerical(anyhow!("too far")));
            }
            let point = bearing.point(n, from).map_err(Failure::solving)?;
            all.lock()
                .unwrap()
                .insert(n, format!("{:?}", Some(point.start())));
            if hard.contains(&n) {
                found.lock().unwrap().push(text);
            }
            Ok((point, ()))
        };
        let group = Grouping {
            size: points_per_start(&model),
            last: LAST,
        };
        let pool = rayon::ThreadPoolBuilder::new()
            .num_threads(n_threads)
            .build()
            .unwrap();
        let take_all = || {
            rayon::in_place_scope(|scope| {
                let mut ahead = PointsAhead::new(scope, &solve, group, None);
                (0..=LAST).for_each(|_| drop(ahead.take().unwrap()));
            });
        };
        pool.install(take_all);
        (
            all.into_inner().unwrap().into_values().collect(),
            found.into_inner().unwrap(),
        )
    }

    /// Wrong: a point that is too far from its start would end the run, or start from what happens to be there. Points
    /// 5 and 8, from which others start, are found from 4 and 7 on any number of threads.
    #[test]
    fn a_point_too_far_from_its_start_starts_from_the_one_before() {
        let (alone, found) = bits(1, &[5, 8]);
        assert_eq!(alone.len(), 20);
        assert_eq!(found, [alone[4].clone(), alone[7].clone()]);
        for n_threads in [2, 4] {
            assert!(
                bits(n_threads, &[5, 8]) == (alone.clone(), found.clone()),
                "{n_threads} threads"
            );
        }
    }
}
