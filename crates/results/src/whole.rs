//! Files that commands write: whole or not at all, never through a link, and only over what the program wrote itself.
//!
//! The content goes to a new hidden file in the same folder, is brought to the disk, and renamed.

use std::fs::File;
use std::io::{BufWriter, Write};
use std::path::Path;

use anyhow::{Context, anyhow};
use checkpoint::may_not_write;

/// Writes a file. One that is there already is replaced if `is_own` knows its content as the program's own.
pub fn write(path: &Path, content: &[u8], is_own: impl Fn(&[u8]) -> bool) -> anyhow::Result<()> {
    require_own(path, is_own)?;
    write_by(path, |file| file.write_all(content))
}

/// Writes a file that is not there yet, by what `fill` writes.
pub fn write_new(
    path: &Path,
    fill: impl FnOnce(&mut dyn Write) -> std::io::Result<()>,
) -> anyhow::Result<()> {
    if path.symlink_metadata().is_ok() {
        return Err(anyhow!("cannot write {}: File exists", path.display()));
    }
    write_by(path, fill)
}

/// Fails if there is something at `path` that the program did not write.
pub fn require_own(path: &Path, is_own: impl Fn(&[u8]) -> bool) -> anyhow::Result<()> {
    let Ok(data) = path.symlink_metadata() else {
        return Ok(());
    };
    if !data.is_file() {
        return Err(anyhow!(
            "{} is no plain file, so it is not written over; move it away, or give another --out \
             where the command has one",
            path.display()
        ));
    }
    let old = std::fs::read(path).with_context(|| format!("cannot read {}", path.display()))?;
    if is_own(&old) {
        return Ok(());
    }
    Err(anyhow!(
        "{} was not written by this command, so it is not written over; move it away, or give another --out \
             where the command has one",
        path.display()
    ))
}

/// Fails if a picture of this name, without ending, would replace one that the program did not draw. A PNG
/// has no place for a mark; it is known by the SVG beside it.
pub fn require_own_picture(path: &Path) -> anyhow::Result<()> {
    let svg = path.with_added_extension("svg");
    let is_own = |old: &[u8]| old.starts_with(b"<svg width=\"") && holds(old, "DejaVu Sans");
    require_own(&svg, is_own)?;
    require_own(&path.with_added_extension("png"), |_| svg.exists())
}

/// Writes a picture under a name without ending as SVG and PNG, in the place of those that the program drew before.
pub fn write_picture(path: &Path, svg: &str, png: &[u8]) -> anyhow::Result<()> {
    require_own_picture(path)?;
    write(&path.with_added_extension("svg"), svg.as_bytes(), |_| true)?;
    write(&path.with_added_extension("png"), png, |_| true)
}

/// Fails if a folder holds any of these: nothing is written over.
pub fn require_free(dir: &Path, names: &[&str]) -> anyhow::Result<()> {
    let is_taken = |name: &&&str| dir.join(name).symlink_metadata().is_ok();
    match names.iter().find(is_taken) {
        None => Ok(()),
        Some(name) => Err(anyhow!(
            "{} already holds {name}; choose another --out or remove it",
            dir.display()
        )),
    }
}

/// The folder that a command writes into: the one asked for, where nothing of these names may be yet, or that of the
/// results.
pub fn output_folder<'a>(asked: Option<&'a Path>, dir: &'a Path, names: &[&str]) -> anyhow::Result<&'a Path> {
    let Some(out) = asked else { return Ok(dir) };
    require_free(out, names)?;
    make_asked_folder(out)?;
    Ok(out)
}

/// Makes a folder in one that is there, unless somebody else just did. A link in its place is not followed.
pub fn make_folder(path: &Path) -> anyhow::Result<()> {
    match std::fs::create_dir(path) {
        Ok(()) => Ok(()),
        Err(error) => match path.symlink_metadata() {
            Ok(data) if data.is_dir() => Ok(()),
            Ok(_) => Err(anyhow!(
                "{} is a link or a file; expected a folder or nothing there, remove it or choose another --out",
                path.display()
            )),
            Err(_) => Err(cannot("create folder", path, error)),
        },
    }
}

/// Makes a folder that was asked for, which may be a link, with those above it.
pub fn make_asked_folder(path: &Path) -> anyhow::Result<()> {
    std::fs::create_dir_all(path).map_err(|error| cannot("create folder", path, error))
}

/// Makes the folder that a command writes to: the one asked for, which may be a link, or `path` in the results.
pub fn make_output_folder(asked: Option<&Path>, path: &Path) -> anyhow::Result<()> {
    match asked {
        Some(asked) => make_asked_folder(asked),
        None => make_folder(path),
    }
}

/// Whether a file holds a text.
pub fn holds(content: &[u8], text: &str) -> bool {
    content
        .windows(text.len())
        .any(|window| window == text.as_bytes())
}

fn write_by(path: &Path, fill: impl FnOnce(&mut dyn Write) -> std::io::Result<()>) -> anyhow::Result<()> {
    let name = path.file_name().unwrap_or_default().to_string_lossy();
    let hidden = path.with_file_name(format!(".{name}.{}.tmp", std::process::id()));
    // What a process of this number left; it is gone if there was none.
    let _ = std::fs::remove_file(&hidden);
    let written = write_hidden(&hidden, fill).and_then(|()| std::fs::rename(&hidden, path));
    remove_stale(path, &name);
    if written.is_err() {
        // The first error is the one to report.
        let _ = std::fs::remove_file(&hidden);
    }
    written.map_err(|error| cannot("write", path, error))
}

/// Removes what processes left beside a file that were killed while they wrote it. A failure leaves a hidden file.
fn remove_stale(path: &Path, name: &str) {
    let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty());
    let entries = std::fs::read_dir(folder.unwrap_or(Path::new(".")));
    for entry in entries.into_iter().flatten().flatten() {
        let own = entry.file_name();
        let number = own.to_str().and_then(|own| {
            let rest = own.strip_prefix('.')?.strip_prefix(name)?.strip_prefix('.')?;
            rest.strip_suffix(".tmp")?.parse::<u32>().ok()
        });
        let is_plain = entry.file_type().is_ok_and(|kind| kind.is_file());
        if number.is_some_and(|number| is_plain && has_ended(number, &entry.path())) {
            let _ = std::fs::remove_file(entry.path());
        }
    }
}

/// Whether nobody writes a hidden file: not the process of its number here, nor one elsewhere, which has it locked.
fn has_ended(process: u32, hidden: &Path) -> bool {
    let is_here = Path::new("/proc").join(process.to_string()).exists();
    !is_here && File::open(hidden).is_ok_and(|file| file.try_lock().is_ok())
}

/// Why a file or folder cannot be made. Where it may not be made at all another place is the way out.
fn cannot(action: &str, path: &Path, error: std::io::Error) -> anyhow::Error {
    let text = match may_not_write(&error) {
        true => format!(
            "cannot {action} {}: {error}; give another --out where the command has one",
            path.display()
        ),
        false => format!("cannot {action} {}", path.display()),
    };
    anyhow::Error::new(error).context(text)
}

fn write_hidden(
    hidden: &Path,
    fill: impl FnOnce(&mut dyn Write) -> std::io::Result<()>,
) -> std::io::Result<()> {
    let file = File::create_new(hidden)?;
    // Where a file system knows no locks, nobody takes this one for left behind.
    let _ = file.try_lock();
    let mut file = BufWriter::new(file);
    fill(&mut file)?;
    file.flush()?;
    file.get_ref().sync_all()
}

#[cfg(test)]
mod tests {
    use std::io::ErrorKind;

    use super::*;
    use crate::failure::one_line;

    /// Wrong: what a study that was killed had half written would stay for ever, or a file would go that another
    /// process writes, or the user's. No process has the number.
    #[test]
    fn what_a_killed_process_left_goes() {
        let dir = tempfile::tempdir().unwrap();
        let path = |name: &str| dir.path().join(name);
        let left = [".a.md.4194305.tmp", ".a.md.4194306.tmp"].map(path);
        let others = [".a.md.notes.tmp", ".b.md.4194305.tmp", ".a.md.1.tmp"].map(path);
        left.iter()
            .chain(&others)
            .for_each(|path| std::fs::write(path, "half").unwrap());
        let writer = File::open(&left[1]).unwrap();
        writer.lock().unwrap();
        write_new(&path("a.md"), |file| file.write_all(b"whole")).unwrap();
        assert!(!left[0].exists() && left[1].exists());
        assert!(others.iter().all(|path| path.exists()));
        drop(writer);
        write(&path("a.md"), b"again", |_| true).unwrap();
        assert!(!left[1].exists());
    }

    /// Wrong: a command would replace a file of the user's, write through a link, or leave half a file.
    #[test]
    fn only_own_files_are_written_over() {
        let dir = tempfile::tempdir().unwrap();
        let path = dir.path().join("a.html");
        let own = |old: &[u8]| old.starts_with(b"ours");
        write(&path, b"ours 1", own).unwrap();
        write(&path, b"ours 2", own).unwrap();
        assert_eq!(std::fs::read(&path).unwrap(), b"ours 2");
        std::fs::write(&path, "theirs").unwrap();
        let text = write(&path, b"ours 3", own).unwrap_err().to_string();
        assert!(text.contains("a.html was not written by this command"), "{text}");
        let link = dir.path().join("link");
        std::os::unix::fs::symlink(&path, &link).unwrap();
        let text = write(&link, b"ours 3", own).unwrap_err().to_string();
        assert!(text.contains("link is no plain file"), "{text}");
        let text = write_new(&link, |_| Ok(())).unwrap_err().to_string();
        assert!(text.contains("File exists"), "{text}");
        assert_eq!(std::fs::read(&path).unwrap(), b"theirs");
        let half = |file: &mut dyn Write| {
            file.write_all(b"half")?;
            Err(std::io::Error::other("full"))
        };
        let text = format!("{:#}", write_new(&dir.path().join("b"), half).unwrap_err());
        assert!(text.contains("cannot write ") && text.ends_with("full"), "{text}");
        assert_eq!(
            std::fs::read_dir(dir.path()).unwrap().count(),
            2,
            "no hidden file stays"
        );
    }

    /// Wrong: results of somebody else, or on a disk that is read alone, would leave a reader without a word on where
    /// figures and pages may go.
    #[test]
    fn a_place_that_may_not_be_written_to_is_said_with_the_way_out() {
        for kind in [ErrorKind::PermissionDenied, ErrorKind::ReadOnlyFilesystem] {
            let found = one_line(&cannot("write", Path::new("out/report.html"), kind.into()));
            let expected = format!(
                "cannot write out/report.html: {}; give another --out where the command has one",
                std::io::Error::from(kind)
            );
            assert_eq!(found, expected);
        }
        let full = cannot("write", Path::new("a"), ErrorKind::StorageFull.into());
        assert!(!one_line(&full).contains("--out"), "{full:#}");
    }
}
