//! `auto` stands for the option with the fastest stages on the device.

mod common;

use common::{conelab, fails, home, succeeds};
use std::fs::{read_dir, write};
use std::path::Path;

/// A graph with one choice, and passes that repeat a sum for as many steps as their options say.
fn make_graph(home: &Path, [first, second]: [u32; 2]) {
    let graph = r#"(
        params: [Choice(name: "work", options: ["auto", "first", "second"], help: "Which pass runs.",
            fastest: (of: ["first", "second"], stages: ["work"]))],
        textures: { "picture": (size: (8, 8), format: "rgba16f") },
        passes: [
            (name: "work one", stage: "work", when: "work == first", shaders: ["first.comp"], dispatch: Cover("picture")),
            (name: "work two", stage: "work", when: "work == second", shaders: ["second.comp"], dispatch: Cover("picture")),
        ],
        output: "picture",
    )"#;
    write(home.join("passes/work.ron"), graph).unwrap();
    write(
        home.join("configs/work.ron"),
        "(graph: \"work.ron\", scene: \"cornell\", size: (64, 48))",
    )
    .unwrap();
    for (name, steps) in [("first", first), ("second", second)] {
        let shader = format!(
            "#version 460
            layout(local_size_x = 8, local_size_y = 8) in;
            uniform writeonly image2D picture;
            void main() {{
                float x = float(gl_GlobalInvocationID.x);
                for (int i = 0; i < {steps}; i++) x = fract(1.37 * x + 0.1);
                imageStore(picture, ivec2(gl_GlobalInvocationID.xy), vec4(x));
            }}"
        );
        write(home.join(format!("shaders/{name}.comp")), shader).unwrap();
    }
}

/// The option that runs, from the file of the measurements.
fn chosen(home: &Path, cache: &Path) -> String {
    let json = home.join("stats.json");
    succeeds(
        conelab(home)
            .env("CONELAB_CACHE", cache)
            .args(["render", "configs/work.ron", "-o", "picture.png", "--json"])
            .arg(&json),
    );
    let stats: serde_json::Value = serde_json::from_slice(&std::fs::read(json).unwrap()).unwrap();
    let ran = stats["passes"][0]["name"].as_str().unwrap();
    let option = stats["auto"]["work"].as_str().unwrap().to_string();
    assert_eq!(ran == "work one", option == "first", "{stats}");
    option
}

fn measure(home: &Path, cache: &Path) -> String {
    succeeds(
        conelab(home)
            .env("CONELAB_CACHE", cache)
            .args(["devices", "--measure", "work.ron"]),
    )
}

#[test]
fn auto_is_the_option_with_the_shortest_stages() {
    let home = home();
    let (home, cache) = (home.path(), home.path().join("cache"));
    // Four orders of magnitude, so that no load of the machine turns them round.
    make_graph(home, [200_000, 20]);
    let told = measure(home, &cache);
    assert!(told.contains("work auto: second (first "), "{told}");
    assert_eq!(chosen(home, &cache), "second");
    make_graph(home, [20, 200_000]);
    let told = measure(home, &cache);
    assert!(told.contains("work auto: first (first "), "{told}");
    assert_eq!(chosen(home, &cache), "first");
}

#[test]
fn an_unmeasured_software_device_takes_the_last_option() {
    let home = home();
    let (home, cache) = (home.path(), home.path().join("cache"));
    make_graph(home, [20, 200_000]);
    assert_eq!(chosen(home, &cache), "second");
    measure(home, &cache);
    assert_eq!(chosen(home, &cache), "first");
    // Files that hold no measurement are ignored.
    let is_file = |path: &std::path::PathBuf| path.to_string_lossy().contains("fastest-");
    let mut files = read_dir(&cache).unwrap().flatten().map(|f| f.path());
    let file = files.find(is_file).unwrap();
    for text in ["", "{", "{\"work\": {\"first\": -1.0}}", "[1]"] {
        write(&file, text).unwrap();
        assert_eq!(chosen(home, &cache), "second", "{text}");
    }
}

#[test]
fn what_fastest_names_must_be_there() {
    let home = home();
    let home = home.path();
    make_graph(home, [1, 1]);
    let graph = std::fs::read_to_string(home.join("passes/work.ron")).unwrap();
    for (from, to, error) in [
        ("\"auto\", ", "", "no option 'auto'"),
        (
            "of: [\"first\"",
            "of: [\"fist\"",
            "'fist' cannot be the fastest",
        ),
        ("of: [\"first\", ", "of: [", "needs two options or more"),
        ("stages: [\"work\"]", "stages: []", "the stages to measure"),
        (
            "stages: [\"work\"]",
            "stages: [\"wrok\"]",
            "no stage 'wrok'",
        ),
    ] {
        let wrong = graph.replacen(from, to, 1);
        assert_ne!(wrong, graph);
        write(home.join("passes/work.ron"), wrong).unwrap();
        let said = fails(conelab(home).args(["graph", "passes/work.ron"]));
        assert!(said.contains(error), "{error}: {said}");
    }
}
