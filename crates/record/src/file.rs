//! Files that are whole or absent.

use crate::RecordError;
use std::{
    ffi::OsStr,
    fs::{self, File},
    io::Write,
    path::Path,
};

/// How the name of a temporary file ends.
const PART: &str = ".part";

/// Writes `bytes` to `path` whole: temporary file beside it, flush, rename.
/// A file that already holds these bytes is left untouched; the answer says whether it was written.
/// What a writer of `path` that was killed left beside it is removed.
pub fn write_whole(path: &Path, bytes: &[u8]) -> Result<bool, RecordError> {
    let folder = path.parent().unwrap_or(Path::new("."));
    let prefix = format!(".{}.", path.file_name().unwrap_or(OsStr::new("")).to_string_lossy());
    sweep(folder, &prefix);
    if fs::read(path).is_ok_and(|old| old == bytes) {
        return Ok(false);
    }
    let disk = |what| move |source| RecordError::Disk { path: path.to_path_buf(), what, source };
    fs::create_dir_all(folder).map_err(disk("cannot make the folder"))?;
    let mut file = tempfile::Builder::new()
        .prefix(&prefix)
        .suffix(PART)
        .permissions(readable())
        .tempfile_in(folder)
        .map_err(disk("cannot make a temporary file"))?;
    // Whose writer lives is locked. A disk that knows no locks knows none of the sweeper's either.
    let _ = file.as_file().lock();
    file.write_all(bytes).and_then(|()| file.flush()).map_err(disk("cannot write"))?;
    file.persist(path).map_err(|e| disk("cannot rename")(e.error))?;
    Ok(true)
}

/// Removes the temporary files of this prefix whose writer is dead; one that cannot be removed does no harm.
fn sweep(folder: &Path, prefix: &str) {
    for entry in fs::read_dir(folder).into_iter().flatten().flatten() {
        let name = entry.file_name();
        let name = name.to_string_lossy();
        let dead = |file: &File| file.try_lock().is_ok();
        if name.starts_with(prefix)
            && name.ends_with(PART)
            && File::open(entry.path()).as_ref().is_ok_and(dead)
        {
            let _ = fs::remove_file(entry.path());
        }
    }
}

/// What an ordinary file has: the temporary file's own mode would keep other users out.
fn readable() -> fs::Permissions {
    use std::os::unix::fs::PermissionsExt;
    fs::Permissions::from_mode(0o644)
}
