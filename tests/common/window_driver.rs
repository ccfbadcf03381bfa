//! A driver: a virtual screen with the program on it, a hand for mouse and keys, and an eye on pixels and events.
#![allow(dead_code, reason = "each test uses a part")]

use crate::common::conelab;
use serde_json::Value;
use std::collections::HashMap;
use std::fs::File;
use std::io::{BufRead, BufReader, Read};
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::sync::{Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};
use tempfile::TempDir;
use x11rb::connection::Connection;
use x11rb::protocol::xproto::{
    AtomEnum, ClientMessageEvent, ConfigureWindowAux, ConnectionExt as _, EventMask, ImageFormat,
    InputFocus, MapState, Window,
};
use x11rb::protocol::xtest::ConnectionExt as _;
use x11rb::rust_connection::RustConnection;

/// How long nothing may be logged while a test waits. A loaded machine needs longer for everything, so only a standstill fails.
pub const PATIENCE: Duration = Duration::from_secs(60);

/// Size of the window.
pub const WINDOW: (u32, u32) = (1280, 800);

/// One program at a time: what is measured must not depend on how many tests run.
static ONE: Mutex<()> = Mutex::new(());

/// A rectangle of the screen: left, top, right, bottom.
pub type Rect = [f64; 4];

pub const SHIFT: u32 = 0xffe1;
pub const CONTROL: u32 = 0xffe3;
pub const F1: u32 = 0xffbe;

/// What is on the screen where the picture is, one RGBA a texel of the picture.
#[derive(Clone, PartialEq)]
pub struct Screenshot {
    pub size: (usize, usize),
    pub rgba: Vec<u8>,
}

impl Screenshot {
    /// Some columns, without `rim` rows and columns at the edges.
    pub fn part(&self, columns: std::ops::Range<usize>, rim: usize) -> Vec<u8> {
        let rows = self
            .rgba
            .chunks_exact(4 * self.size.0)
            .skip(rim)
            .take(self.size.1 - 2 * rim);
        let columns = columns.start.max(rim)..columns.end.min(self.size.0 - rim);
        rows.flat_map(|row| &row[4 * columns.start..4 * columns.end])
            .copied()
            .collect()
    }

    /// All but the rim, where the window may draw a border.
    pub fn inner(&self) -> Vec<u8> {
        self.part(0..self.size.0, 4)
    }
}

/// A virtual screen, ended with the value.
struct Screen(Child);

impl Drop for Screen {
    fn drop(&mut self) {
        let _ = self.0.kill();
        let _ = self.0.wait();
    }
}

pub struct WindowDriver {
    pub home: TempDir,
    display: String,
    program: Child,
    x: RustConnection,
    root: Window,
    window: Window,
    log: BufReader<File>,
    line: String,
    pub events: Vec<Value>,
    known: HashMap<String, Screenshot>,
    _screen: Screen,
    _one: MutexGuard<'static, ()>,
}

impl Drop for WindowDriver {
    fn drop(&mut self) {
        let _ = self.program.kill();
        let _ = self.program.wait();
    }
}

fn screen() -> (Screen, String) {
    let mut server = Command::new("Xvfb")
        .args([
            "-displayfd",
            "1",
            "-screen",
            "0",
            "1400x900x24",
            "-nolisten",
            "tcp",
        ])
        .stdout(Stdio::piped())
        .stderr(Stdio::null())
        .spawn()
        .unwrap_or_else(|e| {
            panic!(
                "cannot start Xvfb ({e}): install the package xvfb, or run `scripts/setup.sh test`"
            )
        });
    let mut number = String::new();
    let mut out = BufReader::new(server.stdout.take().unwrap());
    out.read_line(&mut number).unwrap();
    (Screen(server), format!(":{}", number.trim()))
}

/// The program in a folder of its own, on a screen, and its log of events.
fn spawn(
    home: &TempDir,
    display: &str,
    log: &str,
    args: &[&str],
    variables: &[(&str, &str)],
) -> (Child, BufReader<File>) {
    let path = home.path().join(log);
    File::create(&path).unwrap();
    let mut program = conelab(home.path());
    program.arg("view").args(args).args(["--events", log]);
    if !args.is_empty() {
        program.args(["--window", &format!("{}x{}", WINDOW.0, WINDOW.1)]);
    }
    let program = program
        .env("DISPLAY", display)
        .env("WINIT_X11_SCALE_FACTOR", "1")
        .envs(variables.iter().copied())
        .env_remove("WAYLAND_DISPLAY")
        .env_remove("WAYLAND_SOCKET")
        .stdout(Stdio::null())
        .stderr(File::create(home.path().join("stderr")).unwrap())
        .spawn()
        .unwrap();
    (program, BufReader::new(File::open(path).unwrap()))
}

impl WindowDriver {
    /// The program on a copy of passes, shaders and configs, with an experiment (RON) that is opened, and arguments.
    #[track_caller]
    pub fn open(experiment: &str, args: &[&str]) -> WindowDriver {
        WindowDriver::open_with(experiment, args, &[])
    }

    /// The same, with variables of the environment.
    #[track_caller]
    pub fn open_with(experiment: &str, args: &[&str], variables: &[(&str, &str)]) -> WindowDriver {
        let one = ONE.lock().unwrap_or_else(PoisonError::into_inner);
        let home = crate::common::home();
        std::fs::write(home.path().join("configs/opened.ron"), experiment).unwrap();
        let (server, display) = screen();
        let mut all = vec!["configs/opened.ron"];
        all.extend(args);
        let (program, log) = spawn(&home, &display, "events.jsonl", &all, variables);
        let (x, number) = x11rb::connect(Some(&display)).unwrap();
        let root = x.setup().roots[number].root;
        let mut driver = WindowDriver {
            home,
            display,
            program,
            x,
            root,
            window: 0,
            log,
            line: String::new(),
            events: Vec::new(),
            known: HashMap::new(),
            _screen: server,
            _one: one,
        };
        driver.find_window();
        driver
    }

    #[track_caller]
    fn find_window(&mut self) {
        let until = Instant::now() + PATIENCE;
        self.window = loop {
            if let Some(window) = self.windows() {
                break window;
            }
            assert!(Instant::now() < until, "no window\n{}", self.stderr());
            std::thread::sleep(Duration::from_millis(20));
        };
        // There is no window manager to do it.
        self.focus();
    }

    /// Kills the program and starts it again in the same folder, without an experiment.
    #[track_caller]
    pub fn kill_and_restart(&mut self) {
        self.program.kill().unwrap();
        self.program.wait().unwrap();
        let (program, log) = spawn(&self.home, &self.display, "again.jsonl", &[], &[]);
        (self.program, self.log) = (program, log);
        self.line.clear();
        self.events.clear();
        self.known.clear();
        self.find_window();
    }

    /// The number of a name of the window system.
    fn atom(&self, name: &[u8]) -> u32 {
        let asked = self.x.intern_atom(false, name).unwrap();
        asked.reply().unwrap().atom
    }

    /// The window's title.
    pub fn title(&self) -> String {
        let (name, kind) = (self.atom(b"_NET_WM_NAME"), self.atom(b"UTF8_STRING"));
        let property = self.x.get_property(false, self.window, name, kind, 0, 64);
        String::from_utf8(property.unwrap().reply().unwrap().value).unwrap()
    }

    fn windows(&self) -> Option<Window> {
        let tree = self.x.query_tree(self.root).unwrap().reply().unwrap();
        tree.children.into_iter().find(|w| {
            let name = self
                .x
                .get_property(false, *w, AtomEnum::WM_NAME, AtomEnum::ANY, 0, 64)
                .unwrap()
                .reply();
            let mapped = self.x.get_window_attributes(*w).unwrap().reply();
            name.is_ok_and(|n| n.value.ends_with(b"conelab"))
                && mapped.is_ok_and(|m| m.map_state == MapState::VIEWABLE)
        })
    }

    fn focus(&self) {
        self.x
            .set_input_focus(InputFocus::PARENT, self.window, x11rb::CURRENT_TIME)
            .unwrap();
        self.x.flush().unwrap();
    }

    /// What the program wrote to its standard error.
    pub fn stderr(&self) -> String {
        std::fs::read_to_string(self.home.path().join("stderr")).unwrap_or_default()
    }

    // Events.

    /// Takes in what was logged since; returns how many events there are.
    pub fn now(&mut self) -> usize {
        while self.log.read_line(&mut self.line).unwrap() > 0 {
            if !self.line.ends_with('\n') {
                break;
            }
            self.events.push(serde_json::from_str(&self.line).unwrap());
            self.line.clear();
        }
        self.events.len()
    }

    /// The first event after the first `since` for which `is` holds.
    #[track_caller]
    pub fn wait(&mut self, since: usize, what: &str, is: impl Fn(&Value) -> bool) -> Value {
        self.wait_at_most(PATIENCE, since, what, is)
    }

    #[track_caller]
    pub fn wait_at_most(
        &mut self,
        time: Duration,
        since: usize,
        what: &str,
        is: impl Fn(&Value) -> bool,
    ) -> Value {
        let mut until = Instant::now() + time;
        let mut next = since;
        loop {
            if self.now() > next {
                until = Instant::now() + time;
            }
            if let Some(event) = self.events[next..].iter().find(|e| is(e)) {
                return event.clone();
            }
            next = self.events.len();
            if Instant::now() > until || self.program.try_wait().unwrap().is_some() {
                let mut last: Vec<String> = self.events[since..]
                    .iter()
                    .filter(|e| e["event"] != "widgets")
                    .map(Value::to_string)
                    .collect();
                last.drain(..last.len().saturating_sub(12));
                let text = self.texts().join(" | ");
                panic!(
                    "no {what}; but\n{}\n{}\non the screen: {text}",
                    last.join("\n"),
                    self.stderr()
                );
            }
            std::thread::sleep(Duration::from_millis(1));
        }
    }

    /// The next event of a name after the first `since`.
    #[track_caller]
    pub fn event(&mut self, since: usize, name: &str) -> Value {
        self.wait(since, name, |e| e["event"] == name)
    }

    /// Waits until the program shows its first picture that is no preview, and returns its fingerprint.
    #[track_caller]
    pub fn first_picture(&mut self) -> String {
        self.wait(0, "first picture", |e| {
            e["event"] == "picture" && e["preview"] == false
        });
        self.resting(0)
    }

    /// The fingerprint of A's or B's picture once none follows for a while and it is on the screen.
    #[track_caller]
    pub fn resting(&mut self, side: usize) -> String {
        let mut count = self.pictures(side).len();
        let mut since = Instant::now();
        // The next picture of a slow device may take longer.
        let frame = |driver: &WindowDriver| {
            let last = driver
                .events
                .iter()
                .rev()
                .find(|e| e["event"] == "picture" && e["side"] == side);
            last.and_then(|e| e["gpu_ms"].as_f64()).unwrap_or(0.0)
        };
        // More frames follow until the picture has converged.
        let converged = |driver: &WindowDriver| {
            let last = driver
                .events
                .iter()
                .rev()
                .find(|e| e["event"] == "picture" && e["side"] == side);
            last.is_none_or(|e| e["left"] == 0)
        };
        while since.elapsed() < Duration::from_secs_f64(frame(self).mul_add(2e-3, 0.35))
            || !converged(self) && since.elapsed() < PATIENCE
        {
            std::thread::sleep(Duration::from_millis(10));
            let now = self.pictures(side).len();
            if now != count {
                (count, since) = (now, Instant::now());
            }
        }
        self.pictures(side).pop().expect("a picture")
    }

    /// Fingerprints of the pictures so far.
    pub fn pictures(&mut self, side: usize) -> Vec<String> {
        self.now();
        let list = self
            .events
            .iter()
            .filter(|e| e["event"] == "picture" && e["side"] == side && e["preview"] == false);
        list.map(|e| e["fingerprint"].as_str().unwrap().to_string())
            .collect()
    }

    /// Waits for a picture with this fingerprint.
    #[track_caller]
    pub fn picture(&mut self, since: usize, side: usize, print: &str) {
        self.wait(since, &format!("picture {print}"), |e| {
            e["event"] == "picture" && e["side"] == side && e["fingerprint"] == print
        });
    }

    /// Waits for a picture with another fingerprint, which it returns.
    #[track_caller]
    pub fn other_picture(&mut self, since: usize, side: usize, print: &str) -> String {
        let event = self.wait(since, &format!("picture other than {print}"), |e| {
            e["event"] == "picture"
                && e["side"] == side
                && e["preview"] == false
                && e["fingerprint"] != print
        });
        event["fingerprint"].as_str().unwrap().to_string()
    }

    // Widgets.

    fn widgets(&mut self) -> Vec<Value> {
        self.now();
        let last = self.events.iter().rev().find(|e| e["event"] == "widgets");
        last.map_or(Vec::new(), |e| e["list"].as_array().unwrap().clone())
    }

    /// All labels on the screen.
    pub fn texts(&mut self) -> Vec<String> {
        self.widgets()
            .iter()
            .map(|w| w["label"].as_str().unwrap().to_string())
            .collect()
    }

    /// Waits until `holds` of the labels.
    #[track_caller]
    pub fn texts_until(&mut self, what: &str, holds: impl Fn(&[String]) -> bool) {
        let until = Instant::now() + PATIENCE;
        while !holds(&self.texts()) {
            assert!(Instant::now() < until, "{what}: {:?}", self.texts());
            std::thread::sleep(Duration::from_millis(5));
        }
    }

    /// The place of the widget with this role ("" for any) and label, once it has stood still.
    #[track_caller]
    pub fn find(&mut self, role: &str, label: &str) -> Rect {
        let until = Instant::now() + PATIENCE;
        let mut last = None;
        loop {
            let widgets = self.widgets();
            let found = widgets
                .iter()
                .find(|w| w["label"] == label && (role.is_empty() || w["role"] == role));
            let rect = found.map(|w| [0, 1, 2, 3].map(|i| w["rect"][i].as_f64().unwrap()));
            match rect {
                // Groups and menus open with a movement; the log of widgets comes ten times a second.
                Some(rect) if last == Some(rect) => return rect,
                _ => last = rect,
            }
            assert!(
                Instant::now() < until,
                "no {role} '{label}' among {:?}",
                self.texts()
            );
            std::thread::sleep(Duration::from_millis(150));
        }
    }

    /// The place of the first widget for which `is` holds.
    #[track_caller]
    pub fn widget(&mut self, is: impl Fn(&Value) -> bool) -> Rect {
        let until = Instant::now() + PATIENCE;
        loop {
            if let Some(found) = self.widgets().iter().find(|w| is(w)) {
                return [0, 1, 2, 3].map(|i| found["rect"][i].as_f64().unwrap());
            }
            assert!(Instant::now() < until, "no such widget: {:?}", self.texts());
            std::thread::sleep(Duration::from_millis(20));
        }
    }

    #[track_caller]
    pub fn click(&mut self, role: &str, label: &str) {
        let at = centre(self.find(role, label));
        self.click_at(at);
    }

    // The hand.

    fn fake(&self, kind: u8, detail: u8, (x, y): (f64, f64)) {
        let origin = self
            .x
            .translate_coordinates(self.window, self.root, 0, 0)
            .unwrap()
            .reply()
            .unwrap();
        let at = (
            origin.dst_x + x.round() as i16,
            origin.dst_y + y.round() as i16,
        );
        self.x
            .xtest_fake_input(kind, detail, 0, self.root, at.0, at.1, 0)
            .unwrap()
            .check()
            .unwrap();
        // A frame of the window.
        std::thread::sleep(Duration::from_millis(40));
    }

    /// Moves the mouse there.
    pub fn point_at(&self, at: (f64, f64)) {
        self.fake(6, 0, at);
    }

    pub fn click_at(&mut self, at: (f64, f64)) {
        self.fake(6, 0, at);
        self.fake(4, 1, at);
        self.release(1, at);
    }

    /// Releases a button, and waits until the program has laid out what follows from it: else the
    /// next click would go to where a widget was. A dialog of the system may never answer.
    fn release(&mut self, button: u8, at: (f64, f64)) {
        let since = self.now();
        let until = Instant::now() + PATIENCE / 4;
        self.fake(5, button, at);
        loop {
            self.now();
            let answered = self.events[since..]
                .iter()
                .any(|e| e["event"] == "released");
            if answered || Instant::now() > until {
                return;
            }
            std::thread::sleep(Duration::from_millis(5));
        }
    }

    /// Clicks the right button on a widget.
    pub fn right_click(&mut self, role: &str, label: &str) {
        let at = centre(self.find(role, label));
        self.fake(6, 0, at);
        self.fake(4, 3, at);
        self.release(3, at);
    }

    /// Presses at one place and releases at another.
    pub fn drag(&mut self, from: (f64, f64), to: (f64, f64)) {
        self.fake(6, 0, from);
        self.fake(4, 1, from);
        // Press and release in one frame are a click.
        std::thread::sleep(Duration::from_millis(250));
        for i in 1..=4 {
            let t = f64::from(i) / 4.0;
            self.fake(
                6,
                0,
                (from.0 + t * (to.0 - from.0), from.1 + t * (to.1 - from.1)),
            );
        }
        self.release(1, to);
    }

    /// Gives the lower of the two stacks of tabs most of the height.
    pub fn grow_lower_tabs(&mut self) {
        let [left, top, ..] = self.find("", "Chart");
        // The gap above the lower stack.
        self.drag((left, top - 2.0), (left, 150.0));
    }

    /// Scrolls the panel at a point to its end.
    pub fn scroll_down(&self, at: (f64, f64)) {
        self.fake(6, 0, at);
        for _ in 0..30 {
            self.fake(4, 5, at);
            self.fake(5, 5, at);
        }
    }

    /// Turns the wheel up by so many notches, while keys are held.
    pub fn wheel(&self, at: (f64, f64), notches: usize, held: &[u32]) {
        let key = |kind: u8, symbol: &u32| {
            self.x
                .xtest_fake_input(kind, self.code(*symbol), 0, self.root, 0, 0, 0)
                .unwrap()
                .check()
                .unwrap();
        };
        self.fake(6, 0, at);
        held.iter().for_each(|s| key(2, s));
        for _ in 0..notches {
            self.fake(4, 4, at);
            self.fake(5, 4, at);
        }
        held.iter().for_each(|s| key(3, s));
    }

    /// Presses keys together, the last one after the others, and releases them.
    pub fn keys(&self, symbols: &[u32]) {
        let codes: Vec<u8> = symbols.iter().map(|s| self.code(*s)).collect();
        for code in &codes {
            self.x
                .xtest_fake_input(2, *code, 0, self.root, 0, 0, 0)
                .unwrap()
                .check()
                .unwrap();
        }
        std::thread::sleep(Duration::from_millis(10));
        for code in codes.iter().rev() {
            self.x
                .xtest_fake_input(3, *code, 0, self.root, 0, 0, 0)
                .unwrap()
                .check()
                .unwrap();
        }
    }

    /// Types small letters, digits and underscores.
    pub fn text(&self, text: &str) {
        for c in text.bytes() {
            match c {
                b'_' => self.keys(&[SHIFT, u32::from(b'-')]),
                c => self.keys(&[u32::from(c)]),
            }
            std::thread::sleep(Duration::from_millis(20));
        }
    }

    fn code(&self, symbol: u32) -> u8 {
        let (low, high) = (self.x.setup().min_keycode, self.x.setup().max_keycode);
        let map = self
            .x
            .get_keyboard_mapping(low, high - low + 1)
            .unwrap()
            .reply()
            .unwrap();
        let per = usize::from(map.keysyms_per_keycode);
        let row = map
            .keysyms
            .chunks(per)
            .position(|row| row[0] == symbol)
            .expect("a key for it");
        low + u8::try_from(row).unwrap()
    }

    // The window.

    pub fn resize(&self, width: u32, height: u32) {
        let size = ConfigureWindowAux::new().width(width).height(height);
        self.x
            .configure_window(self.window, &size)
            .unwrap()
            .check()
            .unwrap();
    }

    /// Its size, pixels.
    pub fn size(&self) -> (u32, u32) {
        let size = self.x.get_geometry(self.window).unwrap().reply().unwrap();
        (size.width.into(), size.height.into())
    }

    pub fn unmap(&self) {
        self.x.unmap_window(self.window).unwrap().check().unwrap();
    }

    pub fn map(&self) {
        self.x.map_window(self.window).unwrap().check().unwrap();
        self.focus();
    }

    /// Presses the button of the window's frame that closes it.
    pub fn ask_to_close(&self) {
        let data = [self.atom(b"WM_DELETE_WINDOW"), 0, 0, 0, 0];
        let message = ClientMessageEvent::new(32, self.window, self.atom(b"WM_PROTOCOLS"), data);
        self.x
            .send_event(false, self.window, EventMask::NO_EVENT, message)
            .unwrap()
            .check()
            .unwrap();
    }

    /// Closes the window as its frame's button would, whatever was changed; how long it took.
    #[track_caller]
    pub fn close(&mut self) -> Duration {
        let start = Instant::now();
        self.ask_to_close();
        // The second time it does not ask about changes.
        self.ask_to_close();
        self.end(start)
    }

    /// Waits until the program has ended without an error; how long it took.
    #[track_caller]
    pub fn end(&mut self, start: Instant) -> Duration {
        loop {
            if let Some(status) = self.program.try_wait().unwrap() {
                assert_eq!(status.code(), Some(0), "{}", self.stderr());
                return start.elapsed();
            }
            assert!(
                start.elapsed() < PATIENCE,
                "it does not end\n{}",
                self.stderr()
            );
            std::thread::sleep(Duration::from_millis(5));
        }
    }

    /// Resident memory, MiB.
    pub fn memory(&self) -> f64 {
        let mut text = String::new();
        File::open(format!("/proc/{}/status", self.program.id()))
            .unwrap()
            .read_to_string(&mut text)
            .unwrap();
        let line = text.lines().find_map(|l| l.strip_prefix("VmRSS:")).unwrap();
        line.trim()
            .trim_end_matches(" kB")
            .trim()
            .parse::<f64>()
            .unwrap()
            / 1024.0
    }

    // The eye.

    /// Where picture A is, in pixels of the window.
    pub fn place(&mut self) -> Rect {
        self.now();
        let last = self
            .events
            .iter()
            .rev()
            .find(|e| e["event"] == "place")
            .expect("a picture");
        [0, 1, 2, 3].map(|i| last["rect"][i].as_f64().unwrap())
    }

    /// Waits until `holds` of where picture A is.
    #[track_caller]
    pub fn wait_place(&mut self, what: &str, holds: impl Fn(Rect) -> bool) {
        let until = Instant::now() + PATIENCE;
        while !holds(self.place()) {
            assert!(Instant::now() < until, "{what}: {:?}", self.place());
            std::thread::sleep(Duration::from_millis(10));
        }
    }

    /// The picture on the screen, at one point a texel.
    pub fn screenshot(&mut self) -> Screenshot {
        let [left, top, right, bottom] = self.place().map(|v| v as i16);
        let last = self
            .events
            .iter()
            .rev()
            .find(|e| e["event"] == "picture")
            .unwrap();
        let size = [0, 1].map(|i| usize::try_from(last["size"][i].as_u64().unwrap()).unwrap());
        let (width, height) = ((right - left).max(1) as u16, (bottom - top).max(1) as u16);
        let image = self.x.get_image(
            ImageFormat::Z_PIXMAP,
            self.window,
            left,
            top,
            width,
            height,
            !0,
        );
        // While the window is smaller than the picture was, there is nothing to see.
        let Ok(image) = image.unwrap().reply() else {
            return Screenshot {
                size: (0, 0),
                rgba: Vec::new(),
            };
        };
        let bytes = image.data;
        let mut rgba = Vec::new();
        for y in 0..size[1] {
            for x in 0..size[0] {
                let at = |i: usize, n: usize, to: u16| (2 * i + 1) * usize::from(to) / (2 * n);
                let i = 4 * (at(y, size[1], height) * usize::from(width) + at(x, size[0], width));
                rgba.extend([bytes[i + 2], bytes[i + 1], bytes[i], 255]);
            }
        }
        Screenshot {
            size: (size[0], size[1]),
            rgba,
        }
    }

    /// Waits until `holds` of what is on the screen.
    #[track_caller]
    pub fn screenshot_until(
        &mut self,
        what: &str,
        holds: impl Fn(&Screenshot) -> bool,
    ) -> Screenshot {
        let until = Instant::now() + PATIENCE;
        loop {
            let shot = self.screenshot();
            if holds(&shot) {
                return shot;
            }
            if Instant::now() > until {
                self.keep_screen();
                panic!(
                    "{what} is not on the screen (kept in {})\n{:?}",
                    kept().display(),
                    self.texts()
                );
            }
            std::thread::sleep(Duration::from_millis(30));
        }
    }

    /// Waits until this picture is on the screen: as it was when it was seen first.
    #[track_caller]
    pub fn shows(&mut self, print: &str) -> Screenshot {
        // A tooltip can lie over the picture: the pointer goes to the line at the foot.
        self.point_at((f64::from(WINDOW.0) - 200.0, f64::from(WINDOW.1) - 6.0));
        if let Some(known) = self.known.get(print).cloned() {
            return self.screenshot_until(&format!("picture {print}"), |shot| *shot == known);
        }
        self.wait(0, &format!("painting of {print}"), |e| {
            e["event"] == "painted"
                && e["fingerprints"]
                    .as_array()
                    .unwrap()
                    .iter()
                    .any(|f| f == print)
        });
        let shot = self.still_screenshot();
        self.known.insert(print.to_string(), shot.clone());
        shot
    }

    /// What is on the screen once it stands still.
    pub fn still_screenshot(&mut self) -> Screenshot {
        let mut shot = self.screenshot();
        loop {
            std::thread::sleep(Duration::from_millis(150));
            let next = self.screenshot();
            if next == shot {
                return shot;
            }
            shot = next;
        }
    }

    /// Keeps what the window shows, for a person to look at.
    pub fn keep_screen(&self) {
        let size = self.x.get_geometry(self.window).unwrap().reply().unwrap();
        let image = self.x.get_image(
            ImageFormat::Z_PIXMAP,
            self.window,
            0,
            0,
            size.width,
            size.height,
            !0,
        );
        let bytes = image.unwrap().reply().unwrap().data;
        let rgb = bytes
            .chunks_exact(4)
            .flat_map(|p| [p[2], p[1], p[0]])
            .collect();
        let picture =
            image::RgbImage::from_raw(size.width.into(), size.height.into(), rgb).unwrap();
        picture.save(kept()).unwrap();
    }

    // Files.

    /// Saves as editors do: a new file takes the place of the old one.
    pub fn rename_into(&self, name: &str, text: &str) {
        let path = self.home.path().join(name);
        let new = path.with_extension("new~");
        std::fs::write(&new, text).unwrap();
        std::fs::rename(new, path).unwrap();
    }

    /// Saves into the file itself.
    pub fn write(&self, name: &str, text: &str) {
        std::fs::write(self.home.path().join(name), text).unwrap();
    }

    pub fn file(&self, name: &str) -> String {
        std::fs::read_to_string(self.home.path().join(name)).unwrap()
    }
}

/// Where pictures of failures are kept.
fn kept() -> PathBuf {
    Path::new(env!("CARGO_TARGET_TMPDIR")).join("window.png")
}

pub fn centre(r: Rect) -> (f64, f64) {
    ((r[0] + r[2]) / 2.0, (r[1] + r[3]) / 2.0)
}

/// A text with its only `old` replaced.
#[track_caller]
pub fn with(text: &str, old: &str, new: &str) -> String {
    assert_eq!(text.matches(old).count(), 1, "'{old}' stands once");
    text.replace(old, new)
}
