//! The operations by MPI.

use mpi::collective::CommunicatorCollectives;
use mpi::datatype::{Partition, PartitionMut};
use mpi::topology::{Communicator, SimpleCommunicator};
use mpi::traits::{Destination, Root, Source};

fn world() -> SimpleCommunicator {
    SimpleCommunicator::world()
}

pub(crate) fn rank() -> usize {
    usize::try_from(world().rank()).expect("ranks count from 0")
}

pub(crate) fn size() -> usize {
    usize::try_from(world().size()).expect("a number of ranks is positive")
}

/// MPI counts in 32-bit integers.
fn count(n: usize) -> i32 {
    i32::try_from(n).unwrap_or_else(|_| {
        panic!("{n} numbers in one message, MPI counts to 2^31; solve for fewer right-hand sides at a time")
    })
}

/// The values of all ranks in rank order.
pub(crate) fn all_gather(values: &[f64], lengths: &[usize]) -> Vec<f64> {
    let total = lengths.iter().sum();
    count(total);
    let (counts, starts) = partition(lengths);
    let mut all = vec![0.0; total];
    let mut parts = PartitionMut::new(&mut all[..], counts, starts);
    world().all_gather_varcount_into(values, &mut parts);
    all
}

/// `sent[r]` to rank r; returns what comes from all ranks, in rank order.
pub(crate) fn exchange(sent: &[Vec<f64>], lengths: &[usize]) -> Vec<f64> {
    let out = sent.concat();
    let total = lengths.iter().sum();
    count(out.len().max(total));
    let (counts, starts) = partition(&sent.iter().map(Vec::len).collect::<Vec<usize>>());
    let outgoing = Partition::new(&out[..], counts, starts);
    let (counts, starts) = partition(lengths);
    let mut all = vec![0.0; total];
    let mut incoming = PartitionMut::new(&mut all[..], counts, starts);
    world().all_to_all_varcount_into(&outgoing, &mut incoming);
    all
}

/// The values of rank `from`, on rank 0.
pub(crate) fn to_root(from: usize, values: Vec<f64>, length: usize) -> Option<Vec<f64>> {
    let (world, from) = (world(), count(from));
    count(length);
    match (world.rank(), from) {
        (0, 0) => Some(values),
        (0, _) => {
            let mut received = vec![0.0; length];
            world.process_at_rank(from).receive_into(&mut received[..]);
            Some(received)
        }
        (own, _) if own == from => {
            world.process_at_rank(0).send(&values[..]);
            None
        }
        _ => None,
    }
}

/// Numbers of consecutive pieces, and where each starts.
fn partition(lengths: &[usize]) -> (Vec<i32>, Vec<i32>) {
    let counts: Vec<i32> = lengths.iter().map(|&n| count(n)).collect();
    let starts = counts
        .iter()
        .scan(0, |start, n| {
            *start += n;
            Some(*start - n)
        })
        .collect();
    (counts, starts)
}

/// The bytes of rank 0.
pub(crate) fn from_root(mut bytes: Vec<u8>) -> Vec<u8> {
    let mut length = bytes.len() as u64;
    let world = world();
    let root = world.process_at_rank(0);
    root.broadcast_into(&mut length);
    bytes.resize(length as usize, 0);
    root.broadcast_into(&mut bytes[..]);
    bytes
}

/// What MPI takes in one message, bytes.
const MOST_BYTES: usize = 1 << 30;

/// The bytes of rank 0 for this rank, none for itself.
pub(crate) fn deal(mut of: impl FnMut(usize) -> Vec<u8>) -> Vec<u8> {
    let world = world();
    if rank() == 0 {
        for to in 1..size() {
            let (bytes, to) = (of(to), world.process_at_rank(count(to)));
            to.send(&(bytes.len() as u64));
            bytes.chunks(MOST_BYTES).for_each(|piece| to.send(piece));
        }
        return Vec::new();
    }
    let root = world.process_at_rank(0);
    let (length, _) = root.receive::<u64>();
    let mut bytes = vec![0; usize::try_from(length).expect("a length in memory")];
    for piece in bytes.chunks_mut(MOST_BYTES) {
        root.receive_into(piece);
    }
    bytes
}

/// The lowest rank that has failed.
pub(crate) struct FirstFailure {
    pub(crate) rank: usize,
    pub(crate) text: String,
    /// Whether all ranks have failed.
    pub(crate) of_all: bool,
}

/// The lowest rank with a message and that message, on all ranks.
pub(crate) fn first_failure(message: Option<String>) -> Option<FirstFailure> {
    let bytes = message.map(String::into_bytes);
    // One more than the length: an empty message is one too.
    let own = bytes.as_ref().map_or(0, |b| b.len() as u64 + 1);
    let mut lengths = vec![0_u64; size()];
    world().all_gather_into(&own, &mut lengths[..]);
    let failed = lengths.iter().position(|&n| n > 0)?;
    let mut text = match bytes {
        Some(bytes) if failed == rank() => bytes,
        _ => vec![0; lengths[failed] as usize - 1],
    };
    world()
        .process_at_rank(i32::try_from(failed).expect("a rank"))
        .broadcast_into(&mut text[..]);
    Some(FirstFailure {
        rank: failed,
        text: String::from_utf8_lossy(&text).into_owned(),
        of_all: !lengths.contains(&0),
    })
}

/// Ends all ranks at once.
pub(crate) fn abort(code: i32) -> ! {
    world().abort(code)
}
