//! Forecast of the memory of each rank of a run in sectors, by the number of ranks, for `raceway check`.

use comm::print;
use dynamics::{Model, RankMemory, RingModel, Share, Substructures, forecast_rank_peak};
use scene::Analysis;

/// What the ranks hold of one ring, for every number of ranks shown.
pub struct RingOnRanks(Vec<Vec<RankMemory>>);

impl RingOnRanks {
    /// Forecast for a ring of which this process has all sectors.
    pub fn new(model: &Model, ring: &RingModel, parts: &Substructures) -> RingOnRanks {
        let n_balls = model.geometry.n_balls;
        let of = |n_ranks: usize| {
            let memory = |rank| RankMemory::new(ring, parts, n_balls, &share(rank, n_ranks));
            (0..n_ranks).map(memory).collect()
        };
        let n_sectors = parts.symbolic().layout().sectors().len();
        RingOnRanks(numbers_of_ranks(n_sectors).map(of).collect())
    }
}

/// 1, 2, 4 and so on, up to the number of sectors.
fn numbers_of_ranks(n_sectors: usize) -> impl Iterator<Item = usize> {
    std::iter::successors(Some(1), |n| Some(2 * n)).take_while(move |&n| n <= n_sectors)
}

fn share(rank: usize, n_ranks: usize) -> Share {
    Share {
        rank,
        n_ranks,
        n_threads: rayon::current_num_threads(),
    }
}

/// Prints what a rank holds of both rings, inner first; nothing when none is in sectors.
pub fn print(rings: &[Option<RingOnRanks>; 2], analysis: &Analysis) {
    let lengths = rings.iter().flatten().map(|ring| ring.0.len());
    let Some(n_rows) = lengths.min() else { return };
    let moves = usize::from(matches!(analysis, Analysis::Dynamic(_)));
    print::line(format_args!(
        "memory   per rank of {} threads, MB, largest rank but for rank 0, which has results as well:",
        rayon::current_num_threads()
    ));
    print::line(format_args!(
        "         ranks     mesh    lists  vectors matrices  factors interface  columns     work  results \
         peak of rank 0  of others"
    ));
    for row in 0..n_rows {
        let n_ranks = 1 << row;
        let of = |rank: usize| {
            rings
                .each_ref()
                .map(|ring| ring.as_ref().map(|ring| ring.0[row][rank]))
        };
        let peak = |rank: usize| {
            let [statics, motion] = forecast_rank_peak(&of(rank), &share(rank, n_ranks));
            statics.max(motion * moves)
        };
        let others = (1..n_ranks).max_by_key(|&rank| peak(rank));
        let sum = |rank: usize, part: &dyn Fn(&RankMemory) -> usize| {
            of(rank).iter().flatten().map(part).sum::<usize>() as f64 / 1e6
        };
        let shown = others.unwrap_or(0);
        print::line(format_args!(
            "         {n_ranks:5} {:8.1} {:8.1} {:8.1} {:8.1} {:8.1} {:9.1} {:8.1} {:8.1} {:8.1} {:14.0} {:>10}",
            sum(shown, &|r| r.mesh),
            sum(shown, &|r| r.lists[moves]),
            sum(shown, &|r| r.vectors[moves]),
            sum(shown, &|r| r.matrices),
            sum(shown, &|r| r.factors),
            sum(shown, &|r| r.interface),
            sum(shown, &|r| r.columns),
            sum(shown, &|r| r.work),
            sum(0, &|r| r.results),
            peak(0) as f64 / 1e6,
            others.map_or("-".to_string(), |rank| format!("{:.0}", peak(rank) as f64 / 1e6)),
        ));
    }
}
