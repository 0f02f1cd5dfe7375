//! A file of derived data: a kind, a body, and the BLAKE3 hash of both, so that a damaged or truncated file is not
//! used.

use super::Scratch;
use crate::folder::storage;
use serde::Serialize;
use serde::de::DeserializeOwned;
use std::fs::{self, File};
use std::io::{self, BufReader, BufWriter, Read, Write};
use std::path::{Path, PathBuf};
use survey::Progress;

/// Number of files stored for each kind: the present one, and those that a few undos lead back to.
pub(super) const KEPT: usize = 4;

/// A kind of derived data.
pub(super) struct Kind {
    /// Prefix of the file's name.
    pub prefix: &'static str,
    /// First bytes of the file; the last of them is the version.
    pub magic: &'static [u8; 8],
    /// The kind in words.
    pub what: &'static str,
}

impl Kind {
    fn file(&self, key: &str) -> String {
        format!("{}-{key}.bin", self.prefix)
    }

    pub(super) fn path(&self, root: &Path, key: &str) -> PathBuf {
        root.join(storage::DERIVED).join(self.file(key))
    }

    /// Stores what `body` writes under `key`; warns if that fails.
    pub(super) fn keep(
        &self,
        root: &Path,
        key: &str,
        progress: &Progress,
        body: impl FnOnce(&mut dyn Write) -> io::Result<()>,
    ) {
        let file = self.file(key);
        let written = Scratch::begin(root).map_err(io::Error::other).and_then(|scratch| {
            self.write(&scratch.path(&file), body)?;
            scratch.publish(&file).map_err(io::Error::other)
        });
        match written {
            Ok(()) => self.forget_old(root),
            Err(error) => progress.warn(format!("{}: used, but could not be stored: {error}", self.what)),
        }
    }

    /// What `body` reads from the file stored under `key`, whose length it is also given; `None` if there is no intact
    /// file.
    pub(super) fn load<T>(
        &self,
        root: &Path,
        key: &str,
        body: impl FnOnce(&mut dyn Read, u64) -> io::Result<T>,
    ) -> Option<T> {
        self.read(&self.path(root, key), body).ok()
    }

    fn write(&self, path: &Path, body: impl FnOnce(&mut dyn Write) -> io::Result<()>) -> io::Result<()> {
        let mut out = Hashing { inner: BufWriter::new(File::create(path)?), hash: blake3::Hasher::new() };
        out.write_all(self.magic)?;
        body(&mut out)?;
        let hash = out.hash.finalize();
        let mut file = out.inner;
        file.write_all(hash.as_bytes())?;
        file.into_inner().map_err(io::IntoInnerError::into_error)?.sync_all()
    }

    fn read<T>(&self, path: &Path, body: impl FnOnce(&mut dyn Read, u64) -> io::Result<T>) -> io::Result<T> {
        let length = system::file::ordinary(path)?.len();
        let file = File::open(path)?;
        let mut input = Hashing { inner: BufReader::new(file), hash: blake3::Hasher::new() };
        let mut magic = [0u8; 8];
        input.read_exact(&mut magic)?;
        if magic != *self.magic {
            return Err(damaged());
        }
        let value = body(&mut input, length)?;
        let expected = input.hash.finalize();
        let mut found = [0u8; 32];
        input.inner.read_exact(&mut found)?;
        if expected == found { Ok(value) } else { Err(damaged()) }
    }

    /// Removes all but the newest few files of this kind.
    fn forget_old(&self, root: &Path) {
        let prefix = format!("{}-", self.prefix);
        let ours = |name: &String| name.starts_with(&prefix) && name.ends_with(".bin");
        let written = |name: String| {
            let facts = fs::symlink_metadata(root.join(storage::DERIVED).join(&name)).ok()?;
            facts.is_file().then_some((facts.modified().ok()?, name))
        };
        let names = storage::names_in(&root.join(storage::DERIVED)).into_iter().filter(ours);
        let mut files: Vec<(std::time::SystemTime, String)> = names.filter_map(written).collect();
        files.sort();
        for (_, name) in files.iter().rev().skip(KEPT) {
            storage::remove(root, &format!("{}/{name}", storage::DERIVED));
        }
    }
}

/// Reads a file of any kind and compares its hash.
///
/// # Errors
/// It cannot be read, or is not what was written.
pub(crate) fn verify_kept(path: &Path) -> io::Result<()> {
    let length = system::file::ordinary(path)?.len();
    let Some(body) = length.checked_sub(blake3::OUT_LEN as u64) else {
        return Err(io::Error::new(io::ErrorKind::InvalidData, format!("only {length} bytes are left of it")));
    };
    let mut input = Hashing { inner: BufReader::new(File::open(path)?), hash: blake3::Hasher::new() };
    io::copy(&mut (&mut input).take(body), &mut io::sink())?;
    let mut found = [0u8; blake3::OUT_LEN];
    input.inner.read_exact(&mut found)?;
    if input.hash.finalize() == found {
        return Ok(());
    }
    Err(io::Error::new(io::ErrorKind::InvalidData, "its hash does not fit its content"))
}

/// Writes a header as JSON, preceded by its length.
pub(super) fn write_header(out: &mut dyn Write, header: &impl Serialize) -> io::Result<()> {
    let header = serde_json::to_vec(header)?;
    out.write_all(&(header.len() as u64).to_le_bytes())?;
    out.write_all(&header)
}

/// Reads the header that [`write_header`] wrote to a file of this length.
pub(super) fn read_header<T: DeserializeOwned>(input: &mut dyn Read, length: u64) -> io::Result<T> {
    let mut count = [0u8; 8];
    input.read_exact(&mut count)?;
    let text: Vec<u8> = read_array(input, usize::try_from(u64::from_le_bytes(count)).map_err(|_| damaged())?, length)?;
    Ok(serde_json::from_slice(&text)?)
}

/// Reads this many numbers from a file of `length` bytes; never allocates more than the file can hold.
pub(super) fn read_array<T: bytemuck::Pod>(input: &mut dyn Read, count: usize, length: u64) -> io::Result<Vec<T>> {
    if count as u64 > length / size_of::<T>() as u64 {
        return Err(damaged());
    }
    let mut values = vec![T::zeroed(); count];
    input.read_exact(bytemuck::cast_slice_mut(&mut values))?;
    Ok(values)
}

/// The content is not what was written.
pub(super) fn damaged() -> io::Error {
    io::Error::from(io::ErrorKind::InvalidData)
}

/// Hashes the bytes that pass through.
struct Hashing<T> {
    inner: T,
    hash: blake3::Hasher,
}

impl<W: Write> Write for Hashing<W> {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        let count = self.inner.write(bytes)?;
        self.hash.update(&bytes[..count]);
        Ok(count)
    }

    fn flush(&mut self) -> io::Result<()> {
        self.inner.flush()
    }
}

impl<R: Read> Read for Hashing<R> {
    fn read(&mut self, bytes: &mut [u8]) -> io::Result<usize> {
        let count = self.inner.read(bytes)?;
        self.hash.update(&bytes[..count]);
        Ok(count)
    }
}
