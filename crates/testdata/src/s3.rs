//! A tiny object storage on loopback, for tests: enough of S3's GET, HEAD, PUT, DELETE and LIST, with faults
//! on demand.
//!
//! Objects live in memory. A path is `/BUCKET/KEY`, as S3 has it with path-style addresses, and as plain HTTP has it.
//! Nothing is checked but that the bucket is there, and that a request is signed where that is asked for.

use std::collections::BTreeMap;
use std::io::{self, BufRead, BufReader, Write};
use std::net::{SocketAddr, TcpListener, TcpStream};
use std::path::Path;
use std::sync::atomic::{AtomicBool, AtomicU64, AtomicUsize, Ordering};
use std::sync::{Arc, Mutex, PoisonError};
use std::time::Duration;

/// What a storage is asked and how it fails.
#[derive(Default)]
pub struct Counters {
    /// Requests that were answered with an object or a part of one.
    pub gets: AtomicUsize,
    /// Bytes of objects that were sent.
    pub bytes: AtomicU64,
    /// The next so many requests are answered with an error of the server.
    pub errors: AtomicUsize,
    /// The next so many replies break off in the middle.
    pub drops: AtomicUsize,
    /// Milliseconds before each reply.
    pub delay_ms: AtomicU64,
    /// How many of the next replies are late.
    pub delayed: AtomicUsize,
    /// Objects beyond this number are not taken; 0 = no limit.
    pub most_objects: AtomicUsize,
    /// Whether requests that are not signed are refused.
    pub private: AtomicBool,
}

/// Objects by `BUCKET/KEY`.
type Objects = Arc<Mutex<BTreeMap<String, Vec<u8>>>>;

/// A storage that runs until it is dropped.
pub struct Server {
    address: SocketAddr,
    bucket: String,
    objects: Objects,
    /// What it was asked, and how it fails.
    pub counters: Arc<Counters>,
    stop: Arc<AtomicBool>,
}

impl Server {
    /// A storage with an empty bucket.
    ///
    /// # Errors
    /// There is no free port.
    pub fn start(bucket: &str) -> io::Result<Self> {
        let listener = TcpListener::bind("127.0.0.1:0")?;
        let (objects, counters, stop) = (Objects::default(), Arc::<Counters>::default(), Arc::<AtomicBool>::default());
        let server = Self {
            address: listener.local_addr()?,
            bucket: bucket.to_owned(),
            objects: objects.clone(),
            counters: counters.clone(),
            stop: stop.clone(),
        };
        let bucket = bucket.to_owned();
        std::thread::spawn(move || {
            for stream in listener.incoming().flatten() {
                if stop.load(Ordering::Relaxed) {
                    return;
                }
                let connection =
                    Connection { objects: objects.clone(), counters: counters.clone(), bucket: bucket.clone() };
                // A client that goes away ends its thread.
                std::thread::spawn(move || connection.serve(&stream));
            }
        });
        Ok(server)
    }

    /// The endpoint, `http://127.0.0.1:PORT`.
    pub fn endpoint(&self) -> String {
        format!("http://{}", self.address)
    }

    /// Puts an object into the bucket.
    pub fn put(&self, key: &str, bytes: Vec<u8>) {
        self.objects.lock().unwrap_or_else(PoisonError::into_inner).insert(format!("{}/{key}", self.bucket), bytes);
    }

    /// Puts a folder with all that is in it into the bucket.
    ///
    /// # Errors
    /// It cannot be read.
    pub fn put_folder(&self, key: &str, folder: &Path) -> io::Result<()> {
        for entry in std::fs::read_dir(folder)? {
            let entry = entry?;
            let key = format!("{key}/{}", entry.file_name().to_string_lossy());
            if entry.file_type()?.is_dir() {
                self.put_folder(&key, &entry.path())?;
            } else {
                self.put(&key, std::fs::read(entry.path())?);
            }
        }
        Ok(())
    }

    /// Changes the bytes of an object in the bucket.
    pub fn change(&self, key: &str, change: impl FnOnce(&mut Vec<u8>)) {
        let mut objects = self.objects.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(bytes) = objects.get_mut(&format!("{}/{key}", self.bucket)) {
            change(bytes);
        }
    }

    /// Keys of all objects in the bucket, in the order of the alphabet.
    pub fn keys(&self) -> Vec<String> {
        let objects = self.objects.lock().unwrap_or_else(PoisonError::into_inner);
        objects.keys().map(|name| name[self.bucket.len() + 1..].to_owned()).collect()
    }

    /// The bytes of an object in the bucket.
    pub fn object(&self, key: &str) -> Option<Vec<u8>> {
        let objects = self.objects.lock().unwrap_or_else(PoisonError::into_inner);
        objects.get(&format!("{}/{key}", self.bucket)).cloned()
    }

    /// Removes an object from the bucket.
    pub fn remove(&self, key: &str) {
        self.objects.lock().unwrap_or_else(PoisonError::into_inner).remove(&format!("{}/{key}", self.bucket));
    }

    /// Bytes of all objects.
    pub fn total_bytes(&self) -> u64 {
        self.objects.lock().unwrap_or_else(PoisonError::into_inner).values().map(|bytes| bytes.len() as u64).sum()
    }

    /// Sets what was asked to nothing.
    pub fn forget(&self) {
        self.counters.gets.store(0, Ordering::Relaxed);
        self.counters.bytes.store(0, Ordering::Relaxed);
    }
}

impl Drop for Server {
    fn drop(&mut self) {
        self.stop.store(true, Ordering::Relaxed);
        // Wakes the thread that waits for a connection.
        let _ = TcpStream::connect(self.address);
    }
}

/// One connection, which may ask several times.
struct Connection {
    objects: Objects,
    counters: Arc<Counters>,
    bucket: String,
}

/// A request.
struct Request {
    method: String,
    /// Path without its query.
    path: String,
    query: String,
    range: Option<(u64, u64)>,
    is_signed: bool,
    body: Vec<u8>,
}

/// Takes one of a count, if there is one left.
fn take(count: &AtomicUsize) -> bool {
    count.fetch_update(Ordering::Relaxed, Ordering::Relaxed, |left| left.checked_sub(1)).is_ok()
}

impl Connection {
    fn serve(&self, stream: &TcpStream) {
        let mut input = BufReader::new(stream);
        while let Some(request) = read_request(&mut input) {
            if self.answer(&request, stream).is_err() {
                return;
            }
        }
    }

    fn answer(&self, request: &Request, mut out: &TcpStream) -> io::Result<()> {
        if take(&self.counters.delayed) {
            std::thread::sleep(Duration::from_millis(self.counters.delay_ms.load(Ordering::Relaxed)));
        }
        if take(&self.counters.errors) {
            return reply(out, "500 Internal Server Error", "", b"<Error><Code>InternalError</Code></Error>", false);
        }
        let name = request.path.trim_start_matches('/').to_owned();
        let bucket = name.split('/').next().unwrap_or_default();
        if bucket != self.bucket {
            return reply(
                out,
                "404 Not Found",
                "",
                b"<Error><Code>NoSuchBucket</Code></Error>",
                request.method == "HEAD",
            );
        }
        if self.counters.private.load(Ordering::Relaxed) && !request.is_signed {
            let is_head = request.method == "HEAD";
            return reply(out, "403 Forbidden", "", b"<Error><Code>AccessDenied</Code></Error>", is_head);
        }
        if request.method == "PUT" {
            return self.take_in(name, request, out);
        }
        if request.method == "DELETE" {
            self.objects.lock().unwrap_or_else(PoisonError::into_inner).remove(&name);
            return reply(out, "204 No Content", "", b"", false);
        }
        if request.query.contains("list-type=2") {
            return self.list(request, out);
        }
        let found = self.objects.lock().unwrap_or_else(PoisonError::into_inner).get(&name).cloned();
        let Some(bytes) = found else {
            return reply(out, "404 Not Found", "", b"<Error><Code>NoSuchKey</Code></Error>", request.method == "HEAD");
        };
        let tag = bytes.iter().fold(5381u64, |hash, byte| hash.wrapping_mul(33) ^ u64::from(*byte));
        let facts =
            format!("ETag: \"{tag:x}\"\r\nLast-Modified: Tue, 24 Nov 2026 10:00:00 GMT\r\nAccept-Ranges: bytes\r\n");
        if request.method == "HEAD" {
            write!(out, "HTTP/1.1 200 OK\r\n{facts}Content-Length: {}\r\n\r\n", bytes.len())?;
            return out.flush();
        }
        let total = bytes.len() as u64;
        let (status, facts, part) = match request.range {
            Some((first, last)) if first < total => {
                let last = last.min(total - 1);
                let range = format!("{facts}Content-Range: bytes {first}-{last}/{total}\r\n");
                ("206 Partial Content", range, &bytes[first as usize..=last as usize])
            }
            Some(_) => ("416 Range Not Satisfiable", facts, &bytes[..0]),
            None => ("200 OK", facts, bytes.as_slice()),
        };
        if take(&self.counters.drops) {
            write!(out, "HTTP/1.1 {status}\r\n{facts}Content-Length: {}\r\n\r\n", part.len())?;
            out.write_all(&part[..part.len() / 2])?;
            out.flush()?;
            return Err(io::ErrorKind::ConnectionAborted.into());
        }
        self.counters.gets.fetch_add(1, Ordering::Relaxed);
        self.counters.bytes.fetch_add(part.len() as u64, Ordering::Relaxed);
        reply(out, status, &facts, part, false)
    }

    fn take_in(&self, name: String, request: &Request, out: &TcpStream) -> io::Result<()> {
        let most = self.counters.most_objects.load(Ordering::Relaxed);
        {
            let mut objects = self.objects.lock().unwrap_or_else(PoisonError::into_inner);
            if most > 0 && objects.len() >= most {
                return reply(out, "507 Insufficient Storage", "", b"<Error><Code>Full</Code></Error>", false);
            }
            objects.insert(name, request.body.clone());
        }
        if take(&self.counters.drops) {
            return Err(io::ErrorKind::ConnectionAborted.into());
        }
        reply(out, "200 OK", "ETag: \"put\"\r\n", b"", false)
    }

    fn list(&self, request: &Request, out: &TcpStream) -> io::Result<()> {
        let prefix = request.query.split('&').find_map(|part| part.strip_prefix("prefix=")).unwrap_or_default();
        let prefix = format!("{}/{}", self.bucket, prefix.replace("%2F", "/"));
        let objects = self.objects.lock().unwrap_or_else(PoisonError::into_inner);
        let contents: String = objects
            .range(prefix.clone()..)
            .take_while(|(name, _)| name.starts_with(&prefix))
            .map(|(name, bytes)| {
                let key = &name[self.bucket.len() + 1..];
                format!(
                    "<Contents><Key>{key}</Key><LastModified>2026-11-24T10:00:00.000Z</LastModified><Size>{}</Size></Contents>",
                    bytes.len()
                )
            })
            .collect();
        let body = format!("<ListBucketResult><IsTruncated>false</IsTruncated>{contents}</ListBucketResult>");
        reply(out, "200 OK", "Content-Type: application/xml\r\n", body.as_bytes(), false)
    }
}

fn reply(mut out: &TcpStream, status: &str, facts: &str, body: &[u8], is_head: bool) -> io::Result<()> {
    write!(out, "HTTP/1.1 {status}\r\n{facts}Content-Length: {}\r\n\r\n", body.len())?;
    if !is_head {
        out.write_all(body)?;
    }
    out.flush()
}

/// The next request; `None` at the end of the connection.
fn read_request(input: &mut impl BufRead) -> Option<Request> {
    let mut line = String::new();
    input.read_line(&mut line).ok().filter(|&bytes| bytes > 0)?;
    let mut words = line.split_whitespace();
    let (method, target) = (words.next()?.to_owned(), words.next()?.to_owned());
    let (path, query) = target.split_once('?').unwrap_or((&target, ""));
    let (mut range, mut length, mut is_signed) = (None, 0, false);
    loop {
        let mut header = String::new();
        input.read_line(&mut header).ok()?;
        let header = header.trim();
        if header.is_empty() {
            break;
        }
        let (name, value) = header.split_once(':')?;
        if name.eq_ignore_ascii_case("range") {
            let (first, last) = value.trim().strip_prefix("bytes=")?.split_once('-')?;
            range = Some((first.parse().ok()?, last.parse().unwrap_or(u64::MAX)));
        } else if name.eq_ignore_ascii_case("authorization") {
            is_signed = true;
        } else if name.eq_ignore_ascii_case("content-length") {
            length = value.trim().parse().ok()?;
        }
    }
    let mut body = vec![0; length];
    input.read_exact(&mut body).ok()?;
    Some(Request { method, path: path.to_owned(), query: query.to_owned(), range, is_signed, body })
}
