//! Writing on a thread of its own, so that computing does not wait for the disk.
//!
//! Steps pass through a queue of fixed length: when the disk is slower than the computation, [`BackgroundOutput::
//! write_step`] waits, and memory stays bounded by the queue. The files are those [`Output`] writes, in the same
//! order. A step is committed only when the thread has written it; [`BackgroundOutput::finish`] waits for all.

use std::fs::File;
use std::path::PathBuf;
use std::sync::mpsc::{SyncSender, sync_channel};
use std::thread::{self, JoinHandle};
use std::time::{Duration, Instant};

use crate::error::CheckpointError;
use crate::output::Output;
use crate::point_table::PointTable;
use crate::record::StepRecord;

/// A file that grows beside the steps, such as a table of the run. What the caller has written to it when it hands
/// over a step is on the disk before that step is committed: a step never knows more than the tables.
#[derive(Debug)]
pub struct Companion {
    /// Path, for messages.
    pub path: PathBuf,
    /// The file, open for writing.
    pub file: File,
}

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
    waited: Duration,
}

/// The folder when all steps are committed, and what that took.
#[derive(Debug)]
pub struct Written {
    /// The folder, for a final [`Output::finish`].
    pub output: Output,
    /// Time that the thread spent making records.
    pub making: Duration,
    /// Time that the thread spent writing.
    pub writing: Duration,
    /// Time that the caller spent waiting for it.
    pub waited: Duration,
}

impl BackgroundOutput {
    /// Starts the thread. `queue_length` steps may wait besides the one being written; memory is
    /// `queue_length + 2` records at most, the caller's included.
    pub fn start(
        output: Output,
        queue_length: usize,
        companions: Vec<Companion>,
    ) -> Result<BackgroundOutput, CheckpointError> {
        let (queue, waiting) = sync_channel::<Maker>(queue_length);
        let dir = output.dir().to_path_buf();
        let writer = thread::Builder::new().spawn(move || write_all(output, &waiting, &companions));
        Ok(BackgroundOutput {
            queue: Some(queue),
            writer: Some(writer.map_err(CheckpointError::io("start a thread that writes to", &dir))?),
            waited: Duration::ZERO,
        })
    }

    /// Hands over a step, waiting while the queue is full. An error of an earlier step is returned by the first
    /// call after it.
    pub fn write_step(&mut self, record: StepRecord) -> Result<(), CheckpointError> {
        self.write_step_made_by(move || Made { record, table: None })
    }

    /// The same for a record that the thread makes when its turn comes, so that this costs the caller nothing.
    pub fn write_step_made_by(
        &mut self,
        make: impl FnOnce() -> Made + Send + 'static,
    ) -> Result<(), CheckpointError> {
        let clock = Instant::now();
        let accepted = self
            .queue
            .as_ref()
            .is_some_and(|queue| queue.send(Box::new(make)).is_ok());
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
    waiting: &std::sync::mpsc::Receiver<Maker>,
    companions: &[Companion],
) -> Result<Written, CheckpointError> {
    let (mut making, mut writing) = (Duration::ZERO, Duration::ZERO);
    for make in waiting {
        let clock = Instant::now();
        let Made { record, table } = make();
        making += clock.elapsed();
        let clock = Instant::now();
        for companion in companions {
            let synced = companion.file.sync_data();
            synced.map_err(CheckpointError::io("write", &companion.path))?;
        }
        output.write_step(&record)?;
        if let Some((name, table)) = table {
            output.write_table(name, &table)?;
        }
        writing += clock.elapsed();
    }
    Ok(Written {
        output,
        making,
        writing,
        waited: Duration::ZERO,
    })
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
