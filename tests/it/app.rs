//! The window: told clearly where there can be none, and driven for real where there is a display to be had.

use crate::program::{Run, command, project, run_in};
use std::io::{BufRead, BufReader, Read};
use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};

/// Longest wait for the window to do something.
const PATIENCE: Duration = Duration::from_secs(120);

#[test]
#[cfg(all(unix, not(target_os = "macos")))]
fn without_a_display_there_is_a_reason_and_a_way() {
    let mut view = command();
    view.arg("view").env_remove("DISPLAY").env_remove("WAYLAND_DISPLAY").env_remove("WAYLAND_SOCKET");
    let run = Run::of(&view.output().unwrap()).failed(&["display", "petroglyph render"]);
    assert!(run.stdout.is_empty());
    let nobody =
        Run::of(&command().arg("view").env("DISPLAY", ":4711").env_remove("WAYLAND_DISPLAY").output().unwrap());
    nobody.failed(&["display"]);
}

/// Ends a process however the test ends.
struct Ended(Child);

impl Ended {
    /// Panics, with what the process said last, if it has ended by itself.
    fn is_there(&mut self) {
        if let Some(status) = self.0.try_wait().unwrap() {
            let mut said = String::new();
            if let Some(mut stderr) = self.0.stderr.take() {
                stderr.read_to_string(&mut said).unwrap();
            }
            panic!("the window ended with {status}: {said}");
        }
    }
}

impl Drop for Ended {
    fn drop(&mut self) {
        // One that has ended by itself is what is wanted.
        let _ = self.0.kill();
        let _ = self.0.wait();
    }
}

/// A display of its own; `None` where the programs for it are missing.
fn display() -> Option<(Ended, String)> {
    let has = |tool: &str| Command::new("which").arg(tool).output().is_ok_and(|found| found.status.success());
    if !["Xvfb", "xdotool"].into_iter().all(has) {
        return None;
    }
    let server = Command::new("Xvfb")
        .args(["-displayfd", "1", "-screen", "0", "1280x800x24"])
        .stdout(Stdio::piped())
        .stderr(Stdio::null())
        .spawn()
        .ok()?;
    let mut server = Ended(server);
    let mut number = String::new();
    BufReader::new(server.0.stdout.take()?).read_line(&mut number).ok()?;
    (!number.trim().is_empty()).then(|| (server, format!(":{}", number.trim())))
}

fn step(at: &Path) -> u64 {
    let text = std::fs::read_to_string(at.join("p.petro/project.toml")).unwrap();
    let line = text.lines().find_map(|line| line.strip_prefix("step = ")).unwrap();
    line.parse().unwrap()
}

#[test]
fn the_real_window_undoes_on_a_key_and_is_remembered_when_killed() {
    let Some((_server, display)) = display() else {
        eprintln!("skipped: Xvfb and xdotool are not installed");
        return;
    };
    let folder = project();
    let at = folder.path();
    let before = step(at);
    run_in(at, "velocity p.petro 2500").done();
    assert_eq!(step(at), before + 1);
    let mut view = command();
    view.current_dir(at).args(["view", "p.petro"]).env("DISPLAY", &display).env_remove("WAYLAND_DISPLAY");
    view.env("XDG_CONFIG_HOME", at.join("settings")).stdout(Stdio::null()).stderr(Stdio::piped());
    let mut window = Ended(view.spawn().unwrap());
    let tool = |arguments: &[&str]| Command::new("xdotool").env("DISPLAY", &display).args(arguments).output().unwrap();
    let start = Instant::now();
    // Its title begins with the project's name once that is open.
    while !tool(&["search", "--onlyvisible", "--name", "Petroglyph$", "windowfocus"]).status.success() {
        window.is_there();
        assert!(start.elapsed() < PATIENCE, "no window shows");
        std::thread::sleep(Duration::from_millis(200));
    }
    // The key is given until the project is open and obeys it.
    while step(at) != before {
        window.is_there();
        assert!(start.elapsed() < PATIENCE, "the window does not undo");
        tool(&["key", "ctrl+z"]);
        std::thread::sleep(Duration::from_secs(2));
        assert!(step(at) <= before + 1);
        if step(at) < before {
            // A slow frame took two keys: that is two undos, and no less obedient.
            break;
        }
    }
    // Killed as by a power cut: what was open is remembered for the next start, and the project is whole.
    window.0.kill().unwrap();
    let left = std::fs::read_to_string(at.join("settings/petroglyph/window.toml")).unwrap();
    assert!(left.contains("[left]") && left.contains("p.petro"), "{left}");
    run_in(at, "info p.petro").done();
}
