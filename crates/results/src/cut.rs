//! A table of a run that goes on from an earlier step: its later rows are moved aside, nothing of them is lost.
//!
//! A killed run leaves rows beyond its last step file, the last of them perhaps torn. The run that resumes computes
//! these steps again, so that its tables end up as those of a run that was never interrupted.

use std::fs::File;
use std::io::{BufRead, BufReader, Read, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};

use anyhow::{Context, anyhow};
use checkpoint::{FileStamp, GrowingFile, open_own, start_of};

use crate::integrity::{doubt, newest_agreeing};

/// Where a table is to be cut.
pub struct TableCut {
    path: PathBuf,
    header: String,
    /// What stays.
    keep: FileStamp,
    /// All bytes.
    length: u64,
}

impl TableCut {
    /// The table `name` in `dir` is cut where a step file says that it ended, and must be what that file
    /// tells of. Its header must be `header`.
    pub fn at_stamp(
        dir: &Path,
        name: &str,
        header: &str,
        (last, stamp): (u64, FileStamp),
    ) -> anyhow::Result<TableCut> {
        let path = dir.join(name);
        if let Some(doubt) = doubt(&path, stamp, last)? {
            let advice = match newest_agreeing(dir, last) {
                Some(step) => format!(
                    "put it back, or go on from step {step}, the newest whose tables are as written: --step {step}"
                ),
                None => "put it back, or run the scene again".to_string(),
            };
            return Err(anyhow!("{doubt}; {advice}"));
        }
        let file = open_own(&path)?;
        let length = file.metadata().map_or(0, |data| data.len());
        let mut lines = Lines {
            reader: BufReader::new(file),
            bytes: Vec::new(),
        };
        require_header(&mut lines, header, &path)?;
        Ok(TableCut {
            path,
            header: header.to_string(),
            keep: stamp,
            length,
        })
    }

    /// The same for a step of a version that kept no checksums of tables: there must be rows up to step `last`.
    pub fn find(dir: &Path, name: &str, header: &str, last: u64) -> anyhow::Result<TableCut> {
        let path = dir.join(name);
        let file = open_own(&path)?;
        let length = file.metadata().map_or(0, |data| data.len());
        let mut lines = Lines {
            reader: BufReader::new(file),
            bytes: Vec::new(),
        };
        require_header(&mut lines, header, &path)?;
        let (mut keep, mut newest) = (header.len() as u64 + 1, None);
        while let Some(line) = lines.next(&path)? {
            let step = line.split(',').next().and_then(|cell| cell.parse::<u64>().ok());
            match step {
                // A torn row has no end of line.
                Some(step) if step <= last && line.ends_with('\n') => newest = Some(step),
                _ => break,
            }
            keep += line.len() as u64;
        }
        if newest != Some(last) {
            let newest = newest.map_or("the header".to_string(), |step| format!("step {step}"));
            return Err(anyhow!(
                "{} ends with {newest}, but the run resumes at step {last}: rows are missing; resume at an earlier \
                 step with --step, or put the table back",
                path.display()
            ));
        }
        Ok(TableCut {
            keep: start_of(&path, keep)?,
            path,
            header: header.to_string(),
            length,
        })
    }

    /// Moves what follows the cut into the folder that `aside` makes and returns the table, open for appending.
    pub fn make(&self, aside: &mut dyn FnMut() -> anyhow::Result<PathBuf>) -> anyhow::Result<GrowingFile> {
        let rows = if self.length > self.keep.length {
            Some(aside()?)
        } else {
            None
        };
        let cut = || format!("cannot cut {} at the step to resume from", self.path.display());
        if let Some(aside) = rows {
            self.copy_rows(&aside).with_context(cut)?;
        }
        GrowingFile::reopen(&self.path, self.keep).with_context(cut)
    }

    fn copy_rows(&self, aside: &Path) -> anyhow::Result<()> {
        let name = self.path.file_name().expect("a table has a name");
        let mut rows = open_own(&self.path)?;
        rows.seek(SeekFrom::Start(self.keep.length))?;
        let mut copy = File::create_new(aside.join(name))?;
        writeln!(copy, "{}", self.header)?;
        std::io::copy(&mut rows, &mut copy)?;
        copy.sync_all()?;
        File::open(aside)?.sync_all()?;
        Ok(())
    }
}

/// The step of the last row of a table up to where the file of step `last` says that it ended; None if it has none.
pub fn last_row(path: &Path, (last, stamp): (u64, FileStamp)) -> anyhow::Result<Option<u64>> {
    if let Some(doubt) = doubt(path, stamp, last)? {
        return Err(anyhow!("{doubt}; put it back, or run the scene again"));
    }
    let mut lines = Lines {
        reader: BufReader::new(open_own(path)?.take(stamp.length)),
        bytes: Vec::new(),
    };
    let mut newest = None;
    while let Some(line) = lines.next(path)? {
        let step = line.split(',').next().and_then(|cell| cell.parse().ok());
        newest = step.or(newest);
    }
    Ok(newest)
}

fn require_header(lines: &mut Lines<File>, header: &str, path: &Path) -> anyhow::Result<()> {
    let found = lines.next(path)?.unwrap_or_default().trim_end().to_string();
    if found == header {
        return Ok(());
    }
    Err(anyhow!(
        "{} has the columns {found:?}, this version writes {header:?}; resume with the version of the run",
        path.display()
    ))
}

/// Lines of a file with their ends; bytes that are no text end the reading like the end of the file.
struct Lines<R> {
    reader: BufReader<R>,
    bytes: Vec<u8>,
}

impl<R: Read> Lines<R> {
    fn next(&mut self, path: &Path) -> anyhow::Result<Option<String>> {
        self.bytes.clear();
        let read = self.reader.read_until(b'\n', &mut self.bytes);
        read.with_context(|| format!("cannot read {}", path.display()))?;
        let text = String::from_utf8(std::mem::take(&mut self.bytes)).ok();
        Ok(text.filter(|line| !line.is_empty()))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const TABLE: &str = "step,x\n0,1.5\n1,2.5\n1,3.5\n2,4.5\n3,5.";

    fn cut(dir: &Path, last: u64) -> anyhow::Result<()> {
        let mut file = TableCut::find(dir, "t.csv", "step,x", last)?.make(&mut || {
            let aside = dir.join("aside");
            std::fs::create_dir_all(&aside)?;
            Ok(aside)
        })?;
        writeln!(file, "{},9.5", last + 1)?;
        Ok(())
    }

    /// Wrong: a table would have steps twice, lose rows, or end in a torn row.
    #[test]
    fn rows_after_the_step_are_moved_aside() {
        let dir = tempfile::tempdir().unwrap();
        let path = dir.path().join("t.csv");
        std::fs::write(&path, TABLE).unwrap();
        cut(dir.path(), 1).unwrap();
        assert_eq!(
            std::fs::read_to_string(&path).unwrap(),
            "step,x\n0,1.5\n1,2.5\n1,3.5\n2,9.5\n"
        );
        let aside = std::fs::read_to_string(dir.path().join("aside/t.csv")).unwrap();
        assert_eq!(aside, "step,x\n2,4.5\n3,5.");
        // The torn row of step 3 does not count as a step.
        std::fs::write(&path, TABLE).unwrap();
        let text = cut(dir.path(), 3).unwrap_err().to_string();
        assert!(
            text.contains("t.csv ends with step 2, but the run resumes at step 3"),
            "{text}"
        );
        assert_eq!(
            std::fs::read_to_string(&path).unwrap(),
            TABLE,
            "refused, so untouched"
        );
    }

    /// Wrong: a table of another version would be continued with other columns.
    #[test]
    fn another_header_is_refused() {
        let dir = tempfile::tempdir().unwrap();
        std::fs::write(dir.path().join("t.csv"), "step,y\n0,1\n").unwrap();
        let text = cut(dir.path(), 0).unwrap_err().to_string();
        assert!(
            text.contains("has the columns \"step,y\", this version writes \"step,x\""),
            "{text}"
        );
        std::fs::remove_file(dir.path().join("t.csv")).unwrap();
        assert!(
            cut(dir.path(), 0)
                .unwrap_err()
                .to_string()
                .contains("cannot read")
        );
    }
}
