//! Writing on threads of its own, so that computing does not wait for the disk.
//!
//! Three threads hand steps on: the first makes the record, the second forms its file, the third brings it to the disk
//! and commits it. The library lets one thread in at a time, so more would not write faster. In front of them steps
//! pass through a queue of fixed length: when the disk is slower than the computation, [`BackgroundOutput::
//! write_step`] waits, and memory stays bounded. The files are those [`Output`] writes, in the same order.
//! [`BackgroundOutput::finish`] waits until all steps are committed.

use std::fs::File;
use std::path::PathBuf;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{Receiver, SyncSender, sync_channel};
use std::thread::{self, JoinHandle};
use std::time::{Duration, Instant};

use crate::atomic::Unsealed;
use crate::error::CheckpointError;
use crate::output::Output;
use crate::point_table::PointTable;
use crate::record::StepRecord;
use crate::step_writer::{StepWriter, WrittenStep};

/// A file that grows beside the steps, such as a table of the run. What the caller has written to it when it hands
/// over a step is on the disk before that step is committed: a step never knows more than the tables.
#[derive(Debug)]
pub struct Companion {
    /// Path, for messages.
    pub path: PathBuf,
    /// The file, open for writing.
    pub file: File,
}

/// For a message.
const START: &str = "start a thread that writes to";

/// What makes a record when its turn comes.
type Maker = Box<dyn FnOnce() -> Made + Send>;

/// A step, and fields of the run up to it that are written once the step is committed, as a file of this name.
#[derive(Debug)]
pub struct Made {
    /// The step.
    pub record: StepRecord,
    /// Name of the file, and fields.
    pub table: Option<(&'static str, PointTable)>,
}

/// An [`Output`] behind a queue.
#[derive(Debug)]
pub struct BackgroundOutput {
    queue: Option<SyncSender<Maker>>,
    writer: Option<JoinHandle<Result<Written, CheckpointError>>>,
    /// A step could not be written or committed.
    failed: Arc<AtomicBool>,
    waited: Duration,
}

/// The folder when all steps are committed, and what that took.
#[derive(Debug)]
pub struct Written {
    /// The folder, for a final [`Output::finish`].
    pub output: Output,
    /// Time spent making records.
    pub making: Duration,
    /// Time spent on their files, the sum of two threads.
    pub writing: Duration,
    /// Time that the caller spent waiting for it.
    pub waited: Duration,
}

impl BackgroundOutput {
    /// Starts the threads. `queue_length` steps may wait besides the one being made and the one being written;
    /// memory is `queue_length + 3` records at most, the caller's included.
    pub fn start(
        output: Output,
        queue_length: usize,
        companions: Vec<Companion>,
    ) -> Result<BackgroundOutput, CheckpointError> {
        let (queue, waiting) = sync_channel::<Maker>(queue_length);
        let dir = output.dir().to_path_buf();
        let failed = Arc::new(AtomicBool::new(false));
        let tell = Arc::clone(&failed);
        let writer = thread::Builder::new().spawn(move || write_all(output, waiting, &companions, &tell));
        Ok(BackgroundOutput {
            queue: Some(queue),
            writer: Some(writer.map_err(CheckpointError::io(START, &dir))?),
            failed,
            waited: Duration::ZERO,
        })
    }

    /// Hands over a step, waiting while the queue is full. An error of an earlier step is returned by the first
    /// call that finds it.
    pub fn write_step(&mut self, record: StepRecord) -> Result<(), CheckpointError> {
        self.write_step_made_by(move || Made { record, table: None })
    }

    /// The same for a record that a thread makes when its turn comes, so that this costs the caller nothing.
    pub fn write_step_made_by(
        &mut self,
        make: impl FnOnce() -> Made + Send + 'static,
    ) -> Result<(), CheckpointError> {
        let clock = Instant::now();
        let queue = self.queue.as_ref();
        let accepted = !self.failed.load(Ordering::Relaxed)
            && queue.is_some_and(|queue| queue.send(Box::new(make)).is_ok());
        self.waited += clock.elapsed();
        if accepted {
            return Ok(());
        }
        self.join().and(Err(CheckpointError::WriterStopped))
    }

    /// Time spent waiting for the disk so far.
    pub fn waited(&self) -> Duration {
        self.waited
    }

    /// Waits until all steps are committed and returns the folder.
    pub fn finish(mut self) -> Result<Written, CheckpointError> {
        let clock = Instant::now();
        let mut written = self.join()?.ok_or(CheckpointError::WriterStopped)?;
        written.waited = self.waited + clock.elapsed();
        Ok(written)
    }

    /// Ends the thread; `None` when it was ended before.
    fn join(&mut self) -> Result<Option<Written>, CheckpointError> {
        self.queue = None;
        match self.writer.take().map(JoinHandle::join) {
            None => Ok(None),
            Some(Ok(result)) => result.map(Some),
            Some(Err(panic)) => std::panic::resume_unwind(panic),
        }
    }
}

/// Writes what comes until the queue is closed, stopping at the first error.
fn write_all(
    mut output: Output,
    waiting: Receiver<Maker>,
    companions: &[Companion],
    failed: &AtomicBool,
) -> Result<Written, CheckpointError> {
    let (to_write, made) = sync_channel(0);
    let (to_commit, written) = sync_channel(0);
    let (writer, last) = (output.step_writer(), output.last_step());
    let write = move || {
        let result = write_each(&writer, last, made, to_commit);
        failed.fetch_or(result.is_err(), Ordering::Relaxed);
        result
    };
    thread::scope(|scope| {
        let making = thread::Builder::new().spawn_scoped(scope, move || make_each(waiting, to_write));
        let making = making.map_err(CheckpointError::io(START, output.dir()))?;
        let writing = thread::Builder::new().spawn_scoped(scope, write);
        let writing = writing.map_err(CheckpointError::io(START, output.dir()))?;
        let committing = commit_each(&mut output, written, companions);
        failed.fetch_or(committing.is_err(), Ordering::Relaxed);
        // A step that could not be committed stands before one that could not be written.
        let (committing, writing) = (committing?, joined(writing)?);
        Ok(Written {
            making: joined(making),
            writing: writing + committing,
            output,
            waited: Duration::ZERO,
        })
    })
}

fn joined<T>(thread: thread::ScopedJoinHandle<'_, T>) -> T {
    thread
        .join()
        .unwrap_or_else(|panic| std::panic::resume_unwind(panic))
}

/// Makes records until there are no more or nobody takes them; returns the time that took.
fn make_each(waiting: Receiver<Maker>, made: SyncSender<Made>) -> Duration {
    let mut time = Duration::ZERO;
    for make in waiting {
        let clock = Instant::now();
        let step = make();
        time += clock.elapsed();
        if made.send(step).is_err() {
            break;
        }
    }
    time
}

/// What is to be committed: a step, and after it a table of the run up to it.
type ToCommit = (WrittenStep, Option<Unsealed>);

/// Writes the files of steps that follow `last`; returns the time that took.
fn write_each(
    writer: &StepWriter,
    mut last: Option<(u64, f64)>,
    steps: Receiver<Made>,
    written: SyncSender<ToCommit>,
) -> Result<Duration, CheckpointError> {
    let mut time = Duration::ZERO;
    for Made { record, table } in steps {
        let clock = Instant::now();
        let step = writer.write(&record, last)?;
        last = Some((step.step, step.time));
        drop(record);
        let table = table.map(|(name, table)| writer.write_table((name, step.step), &table));
        let table = table.transpose()?;
        time += clock.elapsed();
        if written.send((step, table)).is_err() {
            break;
        }
    }
    Ok(time)
}

/// Brings companions, then each step and what belongs to it to the disk; returns the time that took.
fn commit_each(
    output: &mut Output,
    written: Receiver<ToCommit>,
    companions: &[Companion],
) -> Result<Duration, CheckpointError> {
    let mut time = Duration::ZERO;
    for (step, table) in written {
        let clock = Instant::now();
        for companion in companions {
            let synced = companion.file.sync_data();
            synced.map_err(CheckpointError::io("write", &companion.path))?;
        }
        output.commit(step)?;
        table.map_or(Ok(()), Unsealed::publish)?;
        time += clock.elapsed();
    }
    Ok(time)
}

/// Steps already handed over are written even when the run ends early without [`BackgroundOutput::finish`].
impl Drop for BackgroundOutput {
    fn drop(&mut self) {
        self.queue = None;
        if let Some(writer) = self.writer.take() {
            // An error here has nobody left to hear it; the files that are there are whole in any case.
            let _ = writer.join();
        }
    }
}
