//! Settings drawn at random: whatever a researcher turns, there is a picture without a NaN, or a refusal in words, and the
//! validation layer says nothing.
//!
//! A few by default. CONELAB_FUZZ is another number of them and CONELAB_FUZZ_SEED another place to begin; the settings that
//! fail are printed.

mod common;
#[path = "fuzz/mutate.rs"]
#[allow(dead_code, reason = "the fuzzer of files uses the rest")]
mod mutate;

use common::{lab, root};
use conelab::graph::param::{Kind, Param, Value};
use conelab::lab::load;
use conelab::lab::{Lab, LabError, Workspace};
use mutate::Random;

/// Where nobody says how many.
const SETTINGS: usize = 10;

const GRAPHS: [&str; 10] = [
    "rays.ron",
    "cones.ron",
    "warps.ron",
    "temporal.ron",
    "thesis.ron",
    "ddgi.ron",
    "ssgi.ron",
    "ssgi_rays.ron",
    "rsm.ron",
    "lpv.ron",
];
const SCENES: [&str; 4] = [
    "cornell",
    "furnace",
    "configs/scenes/workshop.ron",
    "atrium",
];

/// A picture's light, and its parts.
const LIGHT: [&str; 4] = ["radiance", "direct", "diffuseIndirect", "specularIndirect"];

/// What would only make a small picture slow.
fn most(name: &str, highest: f64) -> f64 {
    highest.min(match name {
        "voxel_dim" => 64.0,
        "shadow_dim" => 512.0,
        "exact_rays" | "bounce_directions" | "pixel_rays" => 16.0,
        "rsm_samples" | "rsm_dim" => 512.0,
        "probe_rows" | "ssgi_slices" | "lpv_steps" => 12.0,
        "lpv_dim" | "ssgi_steps" => 32.0,
        "diffuse_steps" | "specular_steps" => 128.0,
        "fragment_capacity" => 4e6,
        "voxel_capacity" => 1e6,
        _ => f64::INFINITY,
    })
}

/// A number of a range: an end of it, or between, where wide ranges are drawn from by their logarithm.
fn in_range(param: &Param, random: &mut Random) -> f64 {
    let (low, high) = param.range.unwrap_or((0.0, 1.0));
    let high = most(&param.name, high).max(low);
    let at = random.below(1001) as f64 / 1000.0;
    match random.below(10) {
        0 => low,
        1 => high,
        _ if low >= 0.0 && high - low > 1000.0 => {
            (low - 1.0 + (high - low + 1.0).powf(at)).clamp(low, high)
        }
        _ if high - low > 1000.0 => (high + 1.0)
            .powf(at * 2.0 - 1.0)
            .copysign(at - 0.5)
            .clamp(low, high),
        _ => low + (high - low) * at,
    }
}

fn draw(param: &Param, random: &mut Random) -> Value {
    let mut next = || in_range(param, random);
    match &param.kind {
        Kind::Int => Value::Int(next().round() as i64),
        Kind::Float => Value::Float(next()),
        Kind::Vector(n) => Value::Vector((0..*n).map(|_| next()).collect()),
        Kind::Colour => Value::Vector((0..3).map(|_| next()).collect()),
        Kind::Bool => Value::Bool(random.below(2) == 1),
        Kind::Choice(options) => Value::Choice(options[random.below(options.len())].clone()),
    }
}

/// Renders; what is wrong with the picture, or why there is none.
fn render(
    lab: &Lab,
    graph: &str,
    scene: &str,
    settings: &[(&str, &str)],
) -> Result<Vec<String>, LabError> {
    let mut experiment = common::experiment(scene, (48, 32), &[]);
    experiment.graph = graph.into();
    for (name, value) in settings {
        let name = conelab::diagnostics::Loc {
            value: (*name).to_string(),
            at: Default::default(),
        };
        experiment.params.push((name, (*value).to_string()));
    }
    let lights = ["display"]
        .iter()
        .chain(&LIGHT)
        .map(|name| (*name).to_string())
        .collect();
    let (mut session, _) = lab.prepare(&experiment, common::scene(&experiment.scene), |_| {
        Ok(lights)
    })?;
    for _ in 0..4 {
        session.frame(1.0 / 60.0)?;
    }
    session.finish()?;
    let mut wrong = lab.gpu.messages();
    wrong.extend(
        session
            .failed_checks()?
            .into_iter()
            .filter(|check| check.contains("NaN")),
    );
    // Contributions are not all shown: light itself is looked at too, and where it comes from.
    for name in LIGHT {
        let light = session.texels(name, 0, 0)?.floats();
        let bad = light
            .iter()
            .flat_map(|t| &t[..3])
            .filter(|v| !v.is_finite() || **v < 0.0)
            .count();
        if bad > 0 {
            wrong.push(format!(
                "{bad} numbers of '{name}' are negative or not finite"
            ));
        }
    }
    Ok(wrong)
}

#[test]
fn no_setting_makes_a_nan() {
    let count = common::number("CONELAB_FUZZ").unwrap_or(SETTINGS);
    let seed = common::number("CONELAB_FUZZ_SEED").unwrap_or(1);
    let lab = lab(root());
    let home = Workspace::with(root().to_path_buf(), None);
    let graphs = GRAPHS.map(|name| {
        (
            name,
            load(&home.graph_path(name), &home.folders())
                .unwrap()
                .params
                .offered()
                .cloned()
                .collect::<Vec<_>>(),
        )
    });
    let (mut refused, mut failed) = (0, 0);
    for i in 0..count {
        let mut random = Random::new((seed + i) as u64);
        let (graph, params) = &graphs[i % GRAPHS.len()];
        let scene = match SCENES[random.below(SCENES.len())] {
            file if file.ends_with(".ron") => root().join(file).to_string_lossy().into_owned(),
            built_in => built_in.to_string(),
        };
        let mut settings = vec![
            ("voxel_dim".to_string(), "48".to_string()),
            ("shadow_dim".into(), "512".into()),
        ];
        settings.retain(|(name, _)| params.iter().any(|p| p.name == *name));
        for param in params {
            if random.below(2) == 0 {
                settings.retain(|(name, _)| *name != param.name);
                settings.push((param.name.clone(), draw(param, &mut random).to_ron()));
            }
        }
        let settings: Vec<_> = settings
            .iter()
            .map(|(n, v)| (n.as_str(), v.as_str()))
            .collect();
        let shown = || format!("{i} (seed {seed}): {graph}, {scene}, {settings:?}");
        match render(&lab, graph, &scene, &settings) {
            Ok(wrong) if wrong.is_empty() => {}
            Ok(wrong) => {
                eprintln!("{}\nwrong: {}", shown(), wrong.join("\n"));
                failed += 1;
            }
            Err(LabError::Vulkan(e)) => panic!("{}\n{e}", shown()),
            Err(e) => {
                eprintln!("{}\nrefused: {e}", shown());
                refused += 1;
            }
        }
    }
    eprintln!("{count} settings, {refused} refused");
    assert_eq!(failed, 0, "settings with a wrong picture");
    assert!(
        refused * 4 <= count,
        "{refused} of {count} settings were refused"
    );
}
