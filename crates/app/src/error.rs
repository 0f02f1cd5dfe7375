//! Why there is no window.

use std::path::PathBuf;

/// A window could not be opened.
#[derive(Debug, thiserror::Error)]
pub enum WindowError {
    /// There is no desktop session to open it in.
    #[error(
        "there is no display to open a window on ({reason}); start it in a desktop session or set DISPLAY, \
         or make pictures with `petroglyph render`"
    )]
    NoDisplay {
        /// What the system said.
        reason: String,
    },
    /// There is no graphics driver.
    #[error(
        "there is no graphics driver for the window ({reason}); install one (Mesa's software driver will do: \
         mesa-vulkan-drivers), or make pictures with `petroglyph render --device cpu`"
    )]
    NoDriver {
        /// What the system said.
        reason: String,
    },
    /// Any other reason.
    #[error("the window could not be opened ({reason}); try again, or make pictures with `petroglyph render`")]
    Failed {
        /// What the system said.
        reason: String,
    },
    /// The table of frame times could not be written.
    #[error("{} cannot be written: {source}", path.display())]
    FrameTimes {
        /// The file.
        path: PathBuf,
        /// What the system said.
        source: std::io::Error,
    },
}

impl From<eframe::Error> for WindowError {
    fn from(error: eframe::Error) -> Self {
        // Winit prefixes its message with the source line that raised it; only the message is shown.
        let text = error.to_string();
        let reason = text.rsplit("): ").next().and_then(|tail| tail.rsplit(".rs:").next()).unwrap_or(&text);
        let reason = reason
            .trim_start_matches(|c: char| c.is_ascii_digit() || c == ':' || c == ' ')
            .trim_end_matches(')')
            .to_owned();
        match error {
            eframe::Error::Winit(_) | eframe::Error::WinitEventLoop(_) => Self::NoDisplay { reason },
            eframe::Error::Wgpu(_) => Self::NoDriver { reason },
            eframe::Error::AppCreation(_) => Self::Failed { reason },
        }
    }
}
