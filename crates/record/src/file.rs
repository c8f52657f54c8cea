//! Files that are whole or absent.

use crate::RecordError;
use std::{fs, io::Write, path::Path};

/// Writes `bytes` to `path` whole: temporary file beside it, flush, rename.
/// A file that already holds these bytes is left untouched; the answer says whether it was written.
pub fn write_whole(path: &Path, bytes: &[u8]) -> Result<bool, RecordError> {
    if fs::read(path).is_ok_and(|old| old == bytes) {
        return Ok(false);
    }
    let folder = path.parent().unwrap_or(Path::new("."));
    let disk = |what| move |source| RecordError::Disk { path: path.to_path_buf(), what, source };
    fs::create_dir_all(folder).map_err(disk("cannot make the folder"))?;
    let mut file = tempfile::Builder::new()
        .prefix(".")
        .suffix(".part")
        .permissions(readable())
        .tempfile_in(folder)
        .map_err(disk("cannot make a temporary file"))?;
    file.write_all(bytes).and_then(|()| file.flush()).map_err(disk("cannot write"))?;
    file.persist(path).map_err(|e| disk("cannot rename")(e.error))?;
    Ok(true)
}

/// What an ordinary file has: the temporary file's own mode would keep other users out.
fn readable() -> fs::Permissions {
    use std::os::unix::fs::PermissionsExt;
    fs::Permissions::from_mode(0o644)
}
