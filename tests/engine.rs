//! The engine of the workbench when its device fails: the driver resets it, a shader hangs, the program has a fault. What was
//! asked for last is not tried again by itself, and the next request is answered with a picture.

mod common;

use common::root;
use conelab::graph::param::Value;
use conelab::lab::Workspace;
use conelab::vulkan::{Faults, GpuOptions};
use conelab::workbench::desired::request::{RenderRequest, SideRequest};
use conelab::workbench::engine::Engine;
use conelab::workbench::engine::report::{PictureReport, Report};
use std::sync::{Arc, PoisonError, RwLock};
use std::time::{Duration, Instant};

const PATIENCE: Duration = Duration::from_secs(120);

/// A shader that hangs may take the GPU from all: it runs without the others.
static ALONE: RwLock<()> = RwLock::new(());

struct Driver {
    engine: Engine,
    faults: Arc<Faults>,
    options: GpuOptions,
    home: Workspace,
    request: RenderRequest,
}

impl Driver {
    fn start() -> Driver {
        let faults = Arc::new(Faults::default());
        let options = GpuOptions {
            device: Some(common::device()),
            validation: true,
            faults: Some(faults.clone()),
            ..GpuOptions::default()
        };
        let home = Workspace::with(root().to_path_buf(), Some(common::cache()));
        let engine = Engine::start(home.clone(), options.clone(), Arc::new(|| {}));
        let side = SideRequest {
            graph: "preview.ron".into(),
            ..SideRequest::default()
        };
        let request = RenderRequest {
            sides: [Some(side), None],
            scene: "triangles".into(),
            size: (64, 48),
            bytes: true,
            ..RenderRequest::default()
        };
        Driver {
            engine,
            faults,
            options,
            home,
            request,
        }
    }

    /// Asks for another frame.
    fn ask(&mut self) {
        self.request.clock.jumps += 1;
        self.engine
            .request(self.request.clock.jumps, self.request.clone());
    }

    /// The first report that `pick` takes.
    fn report<T>(&self, what: &str, mut pick: impl FnMut(Report) -> Option<T>) -> T {
        let until = Instant::now() + PATIENCE;
        loop {
            let left = until.saturating_duration_since(Instant::now());
            let report = self
                .engine
                .reports
                .recv_timeout(left)
                .unwrap_or_else(|e| panic!("{what}: {e}"));
            if let Some(found) = pick(report) {
                return found;
            }
        }
    }

    /// The graph's picture of the last request.
    fn picture(&self) -> PictureReport {
        let number = self.request.clock.jumps;
        self.report("a picture", |r| match r {
            Report::Picture(p) if !p.preview && p.request >= number && p.bytes.is_some() => Some(p),
            _ => None,
        })
    }

    fn failure(&self) -> String {
        self.report("a failure", |r| match r {
            Report::DeviceFailed(why) => Some(why),
            _ => None,
        })
    }
}

#[test]
fn a_hundred_lost_devices_and_twenty_that_hang_are_replaced() {
    let _beside = ALONE.read().unwrap_or_else(PoisonError::into_inner);
    let mut driver = Driver::start();
    driver.ask();
    let first = driver.picture();
    for turn in 0..120 {
        let hangs = turn % 6 == 5;
        if hangs {
            driver.faults.hang();
        } else {
            driver.faults.lose();
        }
        driver.ask();
        let why = driver.failure();
        let expected = if hangs {
            "has not finished a frame"
        } else {
            "the GPU was lost"
        };
        assert!(
            why.contains(expected) && why.contains("Change a shader or a value"),
            "{why}"
        );
        driver.ask();
        let again = driver.picture();
        assert!(
            again.bytes == first.bytes,
            "another picture after failure {turn}"
        );
        assert!(driver.engine.failure().is_none());
    }
    assert_eq!(driver.engine.stop(PATIENCE), Vec::<String>::new());
}

#[test]
fn an_engine_that_ends_by_a_fault_says_so_and_another_goes_on() {
    let _beside = ALONE.read().unwrap_or_else(PoisonError::into_inner);
    let mut driver = Driver::start();
    driver.ask();
    let first = driver.picture();
    driver.faults.panic();
    driver.ask();
    let until = Instant::now() + PATIENCE;
    let why = loop {
        assert!(Instant::now() < until, "the fault was not noticed");
        match driver.engine.failure() {
            Some(why) => break why,
            None => std::thread::sleep(Duration::from_millis(5)),
        }
    };
    assert!(
        why.contains("the renderer crashed") && why.contains("injected by a test"),
        "{why}"
    );
    let failed = (driver.request.clock.jumps, driver.request.clone());
    driver.engine = Engine::replace(
        driver.home.clone(),
        driver.options.clone(),
        Arc::new(|| {}),
        failed,
    );
    // It does not try the same again by itself.
    assert!(
        driver
            .engine
            .reports
            .recv_timeout(Duration::from_millis(300))
            .is_err()
    );
    driver.ask();
    assert!(driver.picture().bytes == first.bytes);
    assert_eq!(driver.engine.stop(PATIENCE), Vec::<String>::new());
}

#[test]
fn a_shader_that_hangs_is_left_behind() {
    if common::on_software() {
        eprintln!("skipped: the software device ends endless loops by itself");
        return;
    }
    let _alone = ALONE.write().unwrap_or_else(PoisonError::into_inner);
    let home = tempfile::tempdir().unwrap();
    let write = |name: &str, text: &str| {
        std::fs::create_dir_all(home.path().join(name).parent().unwrap()).unwrap();
        std::fs::write(home.path().join(name), text).unwrap();
    };
    write(
        "passes/endless.ron",
        r#"(
            params: [Bool(name: "endless", default: false, help: "Whether the shader goes on for ever.")],
            textures: { "display": (size: Screen, format: "rgba8") },
            passes: [(name: "endless", shaders: ["endless.comp"], dispatch: Cover("display"))],
            output: "display",
        )"#,
    );
    write(
        "shaders/endless.comp",
        "#version 460
        #extension GL_GOOGLE_include_directive : require
        #include \"params.glsl\"
        layout(local_size_x = 8, local_size_y = 8) in;
        layout(rgba8) uniform writeonly image2D display;
        void main() {
            float turn = 0.5;
            do {
                imageStore(display, ivec2(gl_GlobalInvocationID.xy), vec4(turn));
                turn = fract(turn + 0.25);
            } while (params.endless);
        }",
    );
    let mut driver = Driver::start();
    let options = GpuOptions {
        patience: Some(Duration::from_secs(3)),
        ..driver.options.clone()
    };
    driver.home.root = home.path().to_path_buf();
    driver.engine = Engine::start(driver.home.clone(), options, Arc::new(|| {}));
    let side = |endless: bool| {
        let params = if endless {
            vec![("endless".into(), Value::Bool(true))]
        } else {
            Vec::new()
        };
        Some(SideRequest {
            graph: "endless.ron".into(),
            params,
            ..SideRequest::default()
        })
    };
    driver.request.sides[0] = side(false);
    driver.ask();
    let first = driver.picture();
    driver.request.sides[0] = side(true);
    driver.ask();
    let begun = Instant::now();
    let why = driver.failure();
    assert!(
        why.contains("has not finished a frame within 3 s") || why.contains("the GPU was lost"),
        "{why}"
    );
    assert!(
        begun.elapsed() < Duration::from_secs(30),
        "noticed after {:?}",
        begun.elapsed()
    );
    // Another device of the same GPU renders, while the endless work is still there.
    driver.request.sides[0] = side(false);
    driver.ask();
    assert!(driver.picture().bytes == first.bytes);
    driver.engine.stop(Duration::from_secs(10));
}
