//! Objects under an address, through the crate `object_store`.
//!
//! | address | credentials, from the environment alone |
//! |---|---|
//! | `s3://bucket/path` | `AWS_ACCESS_KEY_ID`, `AWS_SECRET_ACCESS_KEY`, `AWS_SESSION_TOKEN`, `AWS_REGION`, `AWS_ENDPOINT_URL` |
//! | `gs://bucket/path` | `GOOGLE_SERVICE_ACCOUNT`, `GOOGLE_SERVICE_ACCOUNT_KEY`, `GOOGLE_APPLICATION_CREDENTIALS` |
//! | `az://container/path` | `AZURE_STORAGE_ACCOUNT_NAME`, `AZURE_STORAGE_ACCOUNT_KEY`, `AZURE_STORAGE_SAS_KEY` |
//! | `http://…`, `https://…` | none |
//!
//! Without a key in the environment requests are not signed, which is how public buckets are read; no other place is
//! asked for credentials, neither files nor the machine. They are never part of an error.
//!
//! A request that fails for a reason that may pass (no connection, a connection that breaks, a reply that is late, an
//! error of the server) is tried again, a few times, after longer and longer waits; then the error says so.

use super::super::error::StoreError;
use futures_util::TryStreamExt;
use object_store::aws::AmazonS3Builder;
use object_store::azure::MicrosoftAzureBuilder;
use object_store::gcp::GoogleCloudStorageBuilder;
use object_store::http::HttpBuilder;
use object_store::path::Path as ObjectPath;
use object_store::{
    BackoffConfig, ClientOptions, GetOptions, GetRange, GetResult, ObjectStore, ObjectStoreExt, PutPayload, RetryConfig,
};
use std::ops::Range;
use std::sync::{Arc, OnceLock};
use std::time::Duration;
use tokio::runtime::Runtime;
use url::Url;

/// How often a request is made before it is given up.
const TRIES: u32 = 5;

/// Wait after the first failure; it doubles from try to try.
const FIRST_WAIT: Duration = Duration::from_millis(100);

/// Largest object that is read as a whole: metadata and masks.
const MOST_WHOLE: u64 = 256 << 20;

/// The seconds after which a reply is too late, if this variable does not state them.
const TIMEOUT_VARIABLE: &str = "PETROGLYPH_REMOTE_TIMEOUT";
const TIMEOUT_SECONDS: f64 = 30.0;

/// The objects under an address.
#[derive(Debug)]
pub(super) struct Remote {
    url: String,
    store: Arc<dyn ObjectStore>,
    prefix: ObjectPath,
}

/// The threads on which requests run.
fn runtime() -> Result<&'static Runtime, String> {
    static RUNTIME: OnceLock<Result<Runtime, String>> = OnceLock::new();
    let made = RUNTIME.get_or_init(|| {
        // Another part of the program may have chosen one already.
        let _ = rustls::crypto::ring::default_provider().install_default();
        let built = tokio::runtime::Builder::new_multi_thread().worker_threads(2).enable_all().build();
        built.map_err(|error| error.to_string())
    });
    made.as_ref().map_err(Clone::clone)
}

impl Remote {
    /// The objects under `url`. Nothing is asked of the storage yet.
    pub(super) fn open(url: &str) -> Result<Self, StoreError> {
        let url = url.trim_end_matches('/');
        let fail = |reason: String| StoreError::Remote { url: url.to_owned(), reason };
        let parsed = Url::parse(url).map_err(|error| fail(format!("it is no address ({error})")))?;
        if !parsed.username().is_empty() || parsed.password().is_some() {
            let reason = "credentials are not part of an address; set them in the environment".to_owned();
            return Err(StoreError::Remote { url: format!("{}://…", parsed.scheme()), reason });
        }
        // Clients need what the runtime sets up.
        runtime().map_err(fail)?;
        let store = store_of(&parsed).map_err(|error| fail(short(&error)))?;
        let prefix = ObjectPath::from_url_path(parsed.path()).map_err(|error| fail(error.to_string()))?;
        Ok(Self { url: url.to_owned(), store, prefix })
    }

    /// The address of an object.
    pub(super) fn url_of(&self, key: &str) -> String {
        format!("{}/{key}", self.url)
    }

    /// A small object as a whole.
    pub(super) fn get(&self, key: &str) -> Result<Vec<u8>, StoreError> {
        let options = GetOptions::default;
        self.tried(key, async || {
            let found = self.store.get_opts(&self.path(key), options()).await?;
            if found.meta.size > MOST_WHOLE {
                return Ok(Err(format!("it has {} bytes, which no metadata have", found.meta.size)));
            }
            Ok(Ok(collected(found).await?))
        })?
        .map_err(|reason| StoreError::Remote { url: self.url_of(key), reason })
    }

    /// Some bytes of an object.
    pub(super) fn get_range(&self, key: &str, range: &Range<u64>) -> Result<Vec<u8>, StoreError> {
        let bytes = self.tried(key, async || {
            let options = GetOptions { range: Some(GetRange::Bounded(range.clone())), ..GetOptions::default() };
            collected(self.store.get_opts(&self.path(key), options).await?).await
        })?;
        if bytes.len() as u64 == range.end - range.start {
            return Ok(bytes);
        }
        let reason = format!("{} bytes were asked for and {} came", range.end - range.start, bytes.len());
        Err(StoreError::Remote { url: self.url_of(key), reason })
    }

    /// Length of an object.
    pub(super) fn length(&self, key: &str) -> Result<u64, StoreError> {
        Ok(self.head(key)?.0)
    }

    /// What changes when an object is replaced: its tag, or its length and time.
    pub(super) fn tag(&self, key: &str) -> Result<String, StoreError> {
        Ok(self.head(key)?.1)
    }

    fn head(&self, key: &str) -> Result<(u64, String), StoreError> {
        self.tried(key, async || {
            let options = GetOptions { head: true, ..GetOptions::default() };
            let meta = self.store.get_opts(&self.path(key), options).await?.meta;
            let tag = meta.e_tag.clone().unwrap_or_else(|| format!("{} {}", meta.size, meta.last_modified.timestamp()));
            Ok((meta.size, tag))
        })
    }

    /// Whether there is such an object.
    pub(super) fn is_there(&self, key: &str) -> Result<bool, StoreError> {
        self.tried(key, async || {
            let options = GetOptions { head: true, ..GetOptions::default() };
            match self.store.get_opts(&self.path(key), options).await {
                Ok(_) => Ok(true),
                Err(object_store::Error::NotFound { .. }) => Ok(false),
                Err(error) => Err(error),
            }
        })
        .map_err(written)
    }

    /// Writes an object as a whole; one of this name is replaced.
    pub(super) fn put(&self, key: &str, bytes: Vec<u8>) -> Result<(), StoreError> {
        let payload = PutPayload::from(bytes);
        self.tried(key, async || self.store.put(&self.path(key), payload.clone()).await.map(drop)).map_err(written)
    }

    /// Removes an object, in one try.
    pub(super) fn remove(&self, key: &str) -> Result<(), StoreError> {
        let fail = |reason: String| StoreError::RemoteWrite { url: self.url_of(key), reason };
        match runtime().map_err(fail)?.block_on(self.store.delete(&self.path(key))) {
            Ok(()) | Err(object_store::Error::NotFound { .. }) => Ok(()),
            Err(error) => Err(fail(short(&error))),
        }
    }

    fn path(&self, key: &str) -> ObjectPath {
        key.split('/').fold(self.prefix.clone(), |path, part| path.join(part))
    }

    /// Makes a request until it succeeds or fails for a reason that does not pass.
    fn tried<T>(&self, key: &str, request: impl AsyncFn() -> object_store::Result<T>) -> Result<T, StoreError> {
        let fail = |reason: String| StoreError::Remote { url: self.url_of(key), reason };
        let runtime = runtime().map_err(&fail)?;
        let mut wait = FIRST_WAIT;
        for tried in 1.. {
            let error = match runtime.block_on(request()) {
                Ok(found) => return Ok(found),
                Err(error) => error,
            };
            if let Some(reason) = lasting(&error) {
                return Err(fail(reason));
            }
            if tried >= TRIES {
                return Err(fail(format!(
                    "{tried} tries failed, the last one so: {}; try again later, or check the network and the endpoint",
                    short(&error)
                )));
            }
            std::thread::sleep(wait);
            wait *= 2;
        }
        unreachable!("the last try returns")
    }
}

/// The same error of an object that was to be written.
fn written(error: StoreError) -> StoreError {
    match error {
        StoreError::Remote { url, reason } => StoreError::RemoteWrite { url, reason },
        other => other,
    }
}

/// The bytes of a reply.
async fn collected(found: GetResult) -> object_store::Result<Vec<u8>> {
    let mut bytes = Vec::new();
    let mut parts = found.into_stream();
    while let Some(part) = parts.try_next().await? {
        bytes.extend_from_slice(&part);
    }
    Ok(bytes)
}

/// Why a request fails in vain, in words; `None` for what may pass.
fn lasting(error: &object_store::Error) -> Option<String> {
    use object_store::Error::{InvalidPath, NotFound, NotImplemented, NotSupported, PermissionDenied, Unauthenticated};
    match error {
        NotFound { .. } => Some("there is no such bucket or object; check the address".to_owned()),
        PermissionDenied { .. } | Unauthenticated { .. } => Some(
            "the storage refuses it; set the credentials in the environment (such as AWS_ACCESS_KEY_ID and \
             AWS_SECRET_ACCESS_KEY)"
                .to_owned(),
        ),
        NotSupported { .. } | NotImplemented { .. } | InvalidPath { .. } => Some(short(error)),
        _ => None,
    }
}

/// An error in one line: its innermost cause, without what a server writes at length.
fn short(error: &object_store::Error) -> String {
    let mut innermost: &dyn std::error::Error = error;
    while let Some(cause) = innermost.source() {
        innermost = cause;
    }
    let text = innermost.to_string();
    let line = text.lines().next().unwrap_or_default();
    line.chars().take(200).collect()
}

/// The storage of an address, with what the environment says.
fn store_of(url: &Url) -> object_store::Result<Arc<dyn ObjectStore>> {
    let has = |names: &[&str]| names.iter().any(|name| std::env::var_os(name).is_some_and(|value| !value.is_empty()));
    let seconds = std::env::var(TIMEOUT_VARIABLE).ok().and_then(|text| text.parse().ok()).unwrap_or(TIMEOUT_SECONDS);
    let timeout = Duration::from_secs_f64(f64::clamp(seconds, 0.05, 3600.0));
    let is_plain = url.scheme() == "http"
        || ["AWS_ENDPOINT_URL", "AWS_ENDPOINT_URL_S3", "AWS_ENDPOINT"]
            .iter()
            .any(|name| std::env::var(name).is_ok_and(|value| value.starts_with("http://")));
    let client = ClientOptions::new().with_timeout(timeout).with_connect_timeout(timeout).with_allow_http(is_plain);
    // Tries are counted here, over whole replies.
    let retry = RetryConfig { backoff: BackoffConfig::default(), max_retries: 0, retry_timeout: timeout };
    Ok(match url.scheme() {
        "s3" | "s3a" => {
            let builder =
                AmazonS3Builder::from_env().with_url(url.as_str()).with_client_options(client).with_retry(retry);
            let unsigned = !has(&["AWS_ACCESS_KEY_ID"]);
            // One by one, as every storage of this kind can.
            Arc::new(builder.with_skip_signature(unsigned).with_disable_bulk_delete(true).build()?)
        }
        "gs" => {
            let unsigned = !has(&[
                "GOOGLE_SERVICE_ACCOUNT",
                "GOOGLE_SERVICE_ACCOUNT_PATH",
                "GOOGLE_SERVICE_ACCOUNT_KEY",
                "GOOGLE_APPLICATION_CREDENTIALS",
            ]);
            let builder = GoogleCloudStorageBuilder::from_env().with_url(url.as_str()).with_client_options(client);
            Arc::new(builder.with_retry(retry).with_skip_signature(unsigned).build()?)
        }
        "http" | "https" => {
            let host = &url[..url::Position::BeforePath];
            Arc::new(HttpBuilder::new().with_url(host).with_client_options(client).with_retry(retry).build()?)
        }
        _ => {
            let unsigned = !has(&[
                "AZURE_STORAGE_ACCOUNT_KEY",
                "AZURE_STORAGE_ACCESS_KEY",
                "AZURE_STORAGE_SAS_KEY",
                "AZURE_STORAGE_SAS_TOKEN",
                "AZURE_STORAGE_CLIENT_ID",
            ]);
            let builder = MicrosoftAzureBuilder::from_env().with_url(url.as_str()).with_client_options(client);
            Arc::new(builder.with_retry(retry).with_skip_signature(unsigned).build()?)
        }
    })
}
