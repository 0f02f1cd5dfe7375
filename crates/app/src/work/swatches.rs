//! Swatches of layers and patterns, drawn on a thread: a pattern is rasterised when it is first shown, which takes a
//! while.

use super::{Wake, spawn_quietly};
use figure::draw::swatch;
use image::RgbaImage;
use project::document::Document;
use project::styles;
use std::collections::HashMap;
use std::path::PathBuf;
use std::sync::mpsc::{Sender, channel};
use std::sync::{Arc, Mutex, PoisonError};
use ttf::{LayerStyle, Pattern, TextureLibrary};

/// A request for a swatch.
struct Request {
    key: String,
    style: LayerStyle,
    size_px: [u32; 2],
    px_per_mm: f32,
}

enum Order {
    Project(PathBuf, Box<Document>),
    Draw(Request),
}

#[derive(Default)]
struct Done {
    images: HashMap<String, Option<Arc<RgbaImage>>>,
    patterns: Arc<Vec<Pattern>>,
}

/// The thread that draws swatches, and the swatches that it has drawn.
pub struct Swatches {
    orders: Sender<Order>,
    done: Arc<Mutex<Done>>,
    textures: Option<(PathBuf, Vec<String>)>,
}

impl Swatches {
    /// Starts the thread.
    pub fn start(wake: Wake) -> Self {
        let (orders, received) = channel();
        let done = Arc::new(Mutex::new(Done::default()));
        let theirs = done.clone();
        spawn_quietly("swatches", move || {
            let mut library = TextureLibrary::builtin().ok();
            list(&theirs, library.as_ref());
            for order in received {
                match order {
                    Order::Project(root, document) => {
                        if let Ok(found) = styles::pattern_library(&root, &document) {
                            library = Some(found);
                        }
                        list(&theirs, library.as_ref());
                    }
                    Order::Draw(Request { key, style, size_px, px_per_mm }) => {
                        let drawn =
                            library.as_ref().and_then(|library| swatch::draw(&style, library, size_px, px_per_mm).ok());
                        let mut done = theirs.lock().unwrap_or_else(PoisonError::into_inner);
                        done.images.insert(key, drawn.map(Arc::new));
                    }
                }
                wake();
            }
        });
        Self { orders, done, textures: None }
    }

    /// Uses the tiles of this project, too.
    pub(crate) fn follow(&mut self, root: &std::path::Path, document: &Document) {
        let tiles = document.textures.iter().map(|entry| entry.file.clone()).collect();
        let textures = Some((root.to_owned(), tiles));
        if self.textures != textures {
            self.textures = textures;
            let tiles_only = Document { textures: document.textures.clone(), ..Document::empty(None) };
            let _ = self.orders.send(Order::Project(root.to_owned(), Box::new(tiles_only)));
        }
    }

    /// All patterns, in the order of the catalogue.
    pub fn patterns(&self) -> Arc<Vec<Pattern>> {
        self.done.lock().unwrap_or_else(PoisonError::into_inner).patterns.clone()
    }

    /// A swatch and its key; `None` until it is drawn.
    pub fn get(&self, style: &LayerStyle, size_px: [u32; 2], px_per_mm: f32) -> (String, Option<Arc<RgbaImage>>) {
        let nameless = LayerStyle { layer: String::new(), ..style.clone() };
        let key = format!("{nameless:?} {size_px:?} {px_per_mm}");
        let mut done = self.done.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(known) = done.images.get(&key) {
            return (key, known.clone());
        }
        done.images.insert(key.clone(), None);
        let _ = self.orders.send(Order::Draw(Request { key: key.clone(), style: nameless, size_px, px_per_mm }));
        (key, None)
    }
}

fn list(done: &Mutex<Done>, library: Option<&TextureLibrary>) {
    let patterns = library.map(|library| library.patterns().cloned().collect()).unwrap_or_default();
    let mut done = done.lock().unwrap_or_else(PoisonError::into_inner);
    done.patterns = Arc::new(patterns);
    done.images.clear();
}
