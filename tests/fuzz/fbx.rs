//! A small FBX file as text, with something of most kinds.

use super::text::*;

/// A box with two materials, a texture, a skin and a motion, below a lamp and next to a camera.
pub fn room() -> Text {
    let uvs: Vec<f64> = (0..48).map(|i| f64::from(i) * 0.25).collect();
    let layers = layer(
        "UV",
        0,
        "map",
        "ByPolygonVertex",
        "Direct",
        &array("UV", &uvs),
    ) + layer(
        "Smoothing",
        0,
        "",
        "ByPolygon",
        "Direct",
        &array("Smoothing", &[1, 1, 0, 0, 2, 2]),
    ) + layer(
        "Material",
        0,
        "",
        "ByPolygon",
        "IndexToDirect",
        &array("Materials", &[0, 1, 0, 1, 0, 0]),
    );
    let kinds = [("UV", 0), ("Smoothing", 0), ("Material", 0)];
    let weights = array("Indexes", &[0, 1, 2, 7]) + array("Weights", &[1.0, 0.5, 0.25, 1.0]);
    let matrix = "1,0,0,0,0,1,0,0,0,0,1,0,0,0,0,1";
    let skin = text!(
        "Deformer: 6, \"Deformer::skin\", \"Skin\" {{\nVersion: 101\n}}\n\
         Deformer: 7, \"SubDeformer::c\", \"Cluster\" {{\nVersion: 100\n{weights}Transform: *16 {{\na: {matrix}\n}}\n\
         TransformLink: *16 {{\na: {matrix}\n}}\n}}\n"
    );
    let (walk, curves) = motion(
        2,
        "Lcl Rotation",
        &[[0.0; 3], [0.0, 0.0, 90.0], [10.0, 20.0, 30.0]],
    );
    let objects = mesh(1, &box_points(), &SIDES, &layers, &kinds)
        + solid(20)
        + model(
            2,
            "box",
            "Mesh",
            &(move_to(1.0, 2.0, 3.0) + scale(1.0, 2.0, 1.0) + integer("InheritType", 2)),
        )
        + model(
            21,
            "other",
            "Mesh",
            &vector("GeometricTranslation", [1.0, 0.0, 0.0]),
        )
        + material(
            3,
            "red",
            "phong",
            &(number("ShininessExponent", 6.0) + number("TransparencyFactor", 0.25)),
        )
        + material(
            4,
            "blue",
            "lambert",
            &vector("DiffuseColor", [0.0, 0.0, 1.0]),
        )
        + texture(5, "t.png", "C:\\\\x\\\\t.png", "")
        + model(8, "lamp", "Light", &turn(45.0, 0.0, 0.0))
        + attribute(
            9,
            "Light",
            &(integer("LightType", 2) + number("InnerAngle", 30.0) + number("OuterAngle", 60.0)),
        )
        + model(10, "eye", "Camera", "")
        + attribute(11, "Camera", &number("FocalLength", 30.0))
        + model(12, "bone", "LimbNode", &move_to(0.0, 1.0, 0.0))
        + skin
        + walk;
    let pairs = [
        (8, 0),
        (9, 8),
        (2, 8),
        (1, 2),
        (3, 2),
        (4, 2),
        (10, 0),
        (11, 10),
        (12, 0),
        (21, 0),
        (20, 21),
    ];
    let more = [(6, 20), (7, 6), (12, 7)];
    let connections: Text = pairs
        .into_iter()
        .chain(more)
        .map(|(child, parent)| below(child, parent))
        .sum();
    document(
        Z_UP,
        &objects,
        &(connections + property(5, 3, "DiffuseColor") + curves),
    )
}
