//! Writing on a thread of its own, so that computing does not wait for the disk.
//!
//! Steps pass through a queue of fixed length: when the disk is slower than the computation, [`BackgroundOutput::
//! write_step`] waits, and memory stays bounded by the queue. The files are those [`Output`] writes, in the same
//! order. A step is committed only when the thread has written it; [`BackgroundOutput::finish`] waits for all.

use std::sync::mpsc::{SyncSender, sync_channel};
use std::thread::{self, JoinHandle};

use crate::error::CheckpointError;
use crate::output::Output;
use crate::record::StepRecord;

/// An [`Output`] behind a queue.
#[derive(Debug)]
pub struct BackgroundOutput {
    queue: Option<SyncSender<StepRecord>>,
    writer: Option<JoinHandle<Result<Output, CheckpointError>>>,
}

impl BackgroundOutput {
    /// Starts the thread. `queue_length` steps may wait besides the one being written; memory is
    /// `queue_length + 2` records at most, the caller's included.
    pub fn start(output: Output, queue_length: usize) -> BackgroundOutput {
        let (queue, waiting) = sync_channel::<StepRecord>(queue_length);
        let mut output = output;
        let writer = thread::spawn(move || {
            for record in waiting {
                output.write_step(&record)?;
            }
            Ok(output)
        });
        BackgroundOutput {
            queue: Some(queue),
            writer: Some(writer),
        }
    }

    /// Hands over a step, waiting while the queue is full. An error of an earlier step is returned by the first
    /// call after it.
    pub fn write_step(&mut self, record: StepRecord) -> Result<(), CheckpointError> {
        let accepted = self
            .queue
            .as_ref()
            .is_some_and(|queue| queue.send(record).is_ok());
        if accepted {
            return Ok(());
        }
        self.join().and(Err(CheckpointError::WriterStopped))
    }

    /// Waits until all steps are committed and returns the folder, for a final [`Output::finish`].
    pub fn finish(mut self) -> Result<Output, CheckpointError> {
        self.join()?.ok_or(CheckpointError::WriterStopped)
    }

    /// Ends the thread; `None` when it was ended before.
    fn join(&mut self) -> Result<Option<Output>, CheckpointError> {
        self.queue = None;
        match self.writer.take().map(JoinHandle::join) {
            None => Ok(None),
            Some(Ok(result)) => result.map(Some),
            Some(Err(panic)) => std::panic::resume_unwind(panic),
        }
    }
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
