//! Lights that change while frames run: the picture must be that of a scene which had them from the start.

mod common;

use common::{assert_clean, experiment, lab, root, scene};
use conelab::lab::{Lab, Session};
use conelab::scene::{LightKind, Scene};
use glam::Vec3;
use std::sync::Arc;

fn session(lab: &Lab, scene: &Arc<Scene>) -> Session {
    // Nothing is kept from frame to frame.
    let settings = [
        ("voxel_dim", "32"),
        ("shadow_dim", "512"),
        ("bounces", "one"),
        ("gather_frames", "1"),
        ("pixel_rays", "2"),
    ];
    let experiment = experiment(&scene.name, (64, 48), &settings);
    lab.prepare(&experiment, scene.clone(), |_| Ok(vec!["radiance".into()]))
        .unwrap()
        .0
}

/// The linear picture after one more frame.
fn picture(lab: &Lab, session: &mut Session) -> Vec<u8> {
    session.frame(0.0).unwrap();
    session.finish().unwrap();
    assert_clean(lab);
    session.texels("radiance", 0, 0).unwrap().bytes
}

/// A scene, and what changes in it.
type Change = (&'static str, fn(&mut Scene));

#[test]
fn changed_lights_give_the_picture_of_a_scene_made_so() {
    let lab = lab(root());
    let changes: [Change; 4] = [
        ("atrium", |s| {
            s.lights[0].direction = Vec3::new(0.4, -0.9, -0.3).normalize()
        }),
        ("atrium", |s| s.sky = Vec3::new(0.3, 0.1, 0.0)),
        ("cornell", |s| s.lights[0].position.x += 0.7),
        ("cornell", |s| {
            s.lights[0].kind = LightKind::Spot {
                inner: 0.1,
                outer: 0.6,
            };
            s.lights[0].color *= Vec3::new(1.0, 0.5, 2.0);
        }),
    ];
    for (i, (name, change)) in changes.into_iter().enumerate() {
        changes_live(&lab, &scene(name), &format!("change {i} of {name}"), change);
    }
    let panel = Arc::new(under_a_panel());
    changes_live(&lab, &panel, "the panel's size", |s| {
        s.lights[0].kind = LightKind::Rectangle {
            width: 0.4,
            height: 2.0,
        };
    });
}

/// The Cornell box under a light with an extent.
fn under_a_panel() -> Scene {
    let mut scene = Scene::clone(&scene("cornell"));
    scene.lights[0].kind = LightKind::Rectangle {
        width: 1.0,
        height: 0.5,
    };
    scene
}

fn changes_live(lab: &Lab, before: &Arc<Scene>, what: &str, change: fn(&mut Scene)) {
    let mut after = Scene::clone(before);
    change(&mut after);
    let after = Arc::new(after);
    let mut live = session(lab, before);
    let first = picture(lab, &mut live);
    assert!(live.set_lights(&after.lights, after.sky));
    let changed = picture(lab, &mut live);
    let expected = picture(lab, &mut session(lab, &after));
    assert!(first != changed, "{what} changes nothing");
    assert!(
        changed == expected,
        "{what} gives another picture than a scene made so"
    );
    // And back.
    assert!(live.set_lights(&before.lights, before.sky));
    assert!(picture(lab, &mut live) == first, "{what} cannot be undone");
}

#[test]
fn other_numbers_of_lights_are_refused() {
    let lab = lab(root());
    let cornell = scene("cornell");
    let mut live = session(&lab, &cornell);
    let first = picture(&lab, &mut live);
    let (mut more, mut cube) = (Scene::clone(&cornell), Scene::clone(&cornell));
    more.lights.push(more.lights[0].clone());
    cube.lights[0].kind = LightKind::Point; // six shadow maps instead of one
    assert!(!live.set_lights(&more.lights, more.sky));
    assert!(!live.set_lights(&cube.lights, cube.sky));
    assert!(picture(&lab, &mut live) == first);
    // Six shadow maps either way, but other passes.
    let mut panel = session(&lab, &Arc::new(under_a_panel()));
    assert!(!panel.set_lights(&cube.lights, cube.sky));
}
