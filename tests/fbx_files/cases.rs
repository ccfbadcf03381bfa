//! The table: a name, an FBX file as text, and the expected scene.

use super::text::*;
use Expect::*;

type Point = [f32; 3];

/// A value of the scene; points are in the world.
#[derive(Debug)]
pub enum Expect {
    Triangles(usize),
    Meshes(usize),
    Instances(usize),
    /// All corners of the box of [`box_points`], as the matrix of three columns and a place puts them.
    Box([Point; 4]),
    /// The bounds of everything at a time.
    Bounds(f32, Point, Point),
    /// Every normal is that of its face, which looks away from the middle.
    Outward,
    /// How many normals there are at a point.
    Normals(Point, usize),
    Normal(Point, Point),
    /// Texture coordinates as in the file, v upwards, of every corner at a point.
    Uv(Point, [f32; 2]),
    SecondUv(Point, [f32; 2]),
    /// The base colours of faces at a point, sorted.
    Faces(Point, &'static [Point]),
    Painted(Point, Point),
    Base(&'static str, Point),
    Emission(&'static str, Point),
    Roughness(&'static str, f32),
    Metallic(&'static str, f32),
    Ior(&'static str, f32),
    LeftOut(&'static str, bool),
    Cutoff(&'static str, f32),
    /// Whether the picture of the base colour is clamped along both axes.
    Clamped(&'static str, bool),
    /// Whether the base colour's picture has the second coordinates, and its first texel.
    BaseMap(&'static str, bool, [u8; 4]),
    NormalMap(&'static str, Option<[u8; 4]>),
    /// Kind, colour, place and direction.
    Light(&'static str, &'static str, Point, Point, Point),
    /// There is no such light.
    Dark(&'static str),
    /// Eye, direction, up, vertical field of view, near.
    Camera(&'static str, Point, Point, Point, f32, f32),
    Warns(&'static str),
    Warnings(usize),
    Error(&'static str),
}

pub struct Case {
    pub name: &'static str,
    pub fbx: Text,
    pub expect: Vec<Expect>,
}

const X: Point = [1.0, 0.0, 0.0];
const Y: Point = [0.0, 1.0, 0.0];
const Z: Point = [0.0, 0.0, 1.0];
const O: Point = [0.0; 3];
const RED: Point = [1.0, 0.0, 0.0];
const BLUE: Point = [0.0, 0.0, 1.0];
const CHECKER: [u8; 4] = [200, 100, 50, 255];

fn case(
    name: &'static str,
    world: World,
    objects: Text,
    connections: Text,
    expect: Vec<Expect>,
) -> Case {
    Case {
        name,
        fbx: document(world, &objects, &connections),
        expect,
    }
}

/// A box below a node with these properties.
fn one(name: &'static str, world: World, properties: Text, mut expect: Vec<Expect>) -> Case {
    let objects = solid(1) + model(2, "box", "Mesh", &properties);
    expect.extend([Triangles(12), Outward, Warnings(0)]);
    case(name, world, objects, below(2, 0) + below(1, 2), expect)
}

/// A box of one material.
fn made_of(
    name: &'static str,
    kind: &str,
    properties: &str,
    more: (Text, Text),
    expect: Vec<Expect>,
) -> Case {
    let uvs: Vec<f64> = (0..24).flat_map(|i| [f64::from(i), 0.25]).collect();
    let layers = layer(
        "UV",
        0,
        "map",
        "ByPolygonVertex",
        "Direct",
        &array("UV", &uvs),
    ) + layer(
        "Material",
        0,
        "",
        "AllSame",
        "IndexToDirect",
        &array("Materials", &[0]),
    );
    let objects = mesh(
        1,
        &box_points(),
        &SIDES,
        &layers,
        &[("UV", 0), ("Material", 0)],
    ) + model(2, "box", "Mesh", "")
        + material(3, "m", kind, properties)
        + more.0;
    case(
        name,
        Y_UP,
        objects,
        below(2, 0) + below(1, 2) + below(3, 2) + more.1,
        expect,
    )
}

fn color(name: &str, [r, g, b]: [f64; 3]) -> Text {
    Text(format!(
        "P: \"{name}\", \"Color\", \"\", \"A\",{r},{g},{b}\n"
    ))
}

/// A light below a node.
fn light(
    name: &'static str,
    world: World,
    node: Text,
    properties: Text,
    expect: Vec<Expect>,
) -> Case {
    let objects = solid(1)
        + model(2, "box", "Mesh", "")
        + model(3, "lamp", "Light", &node)
        + attribute(4, "Light", &properties);
    case(
        name,
        world,
        objects,
        below(2, 0) + below(1, 2) + below(3, 0) + below(4, 3),
        expect,
    )
}

pub fn cases() -> Vec<Case> {
    let mut all = spaces();
    all.extend(meshes());
    all.extend(materials());
    all.extend(lights_and_cameras());
    all.extend(motions());
    all.extend(others());
    all
}

fn spaces() -> Vec<Case> {
    let parented = |name, above: Text, below_it: Text, expect: Vec<Expect>| {
        let objects =
            solid(1) + model(2, "box", "Mesh", &below_it) + model(3, "above", "Null", &above);
        case(
            name,
            Y_UP,
            objects,
            below(3, 0) + below(2, 3) + below(1, 2),
            expect,
        )
    };
    vec![
        one(
            "metres, y up",
            Y_UP,
            Text::default(),
            vec![Box([X, Y, Z, O])],
        ),
        one(
            "centimetres",
            CM,
            move_to(100.0, 0.0, 0.0),
            vec![Box([
                [0.01, 0.0, 0.0],
                [0.0, 0.01, 0.0],
                [0.0, 0.0, 0.01],
                X,
            ])],
        ),
        // (x, y, z) of a frame with z up is (x, z, -y).
        one(
            "z up",
            Z_UP,
            move_to(0.0, 0.0, 5.0),
            vec![Box([X, [0.0, 0.0, -1.0], Y, [0.0, 5.0, 0.0]])],
        ),
        // z of a left-handed file is -z of the scene.
        one(
            "left-handed",
            LEFT,
            move_to(0.0, 0.0, 5.0),
            vec![Box([X, Y, [0.0, 0.0, -1.0], [0.0, 0.0, -5.0]])],
        ),
        one(
            "turned about z, in degrees",
            Y_UP,
            turn(0.0, 0.0, 90.0),
            vec![Box([Y, [-1.0, 0.0, 0.0], Z, O])],
        ),
        // About x first, then about z.
        one(
            "turned about two axes",
            Y_UP,
            turn(90.0, 0.0, 90.0),
            vec![Box([Y, Z, X, O])],
        ),
        one(
            "mirrored",
            Y_UP,
            scale(-2.0, 1.0, 1.0),
            vec![Box([[-2.0, 0.0, 0.0], Y, Z, O])],
        ),
        one(
            "turned about a pivot",
            Y_UP,
            turn(0.0, 0.0, 90.0) + vector("RotationPivot", [1.0, 0.0, 0.0]),
            vec![Box([Y, [-1.0, 0.0, 0.0], Z, [1.0, -1.0, 0.0]])],
        ),
        one(
            "geometry moved and scaled, the node turned",
            Y_UP,
            turn(0.0, 0.0, 90.0)
                + vector("GeometricTranslation", [3.0, 0.0, 0.0])
                + vector("GeometricScaling", [2.0, 2.0, 2.0]),
            vec![Box([
                [0.0, 2.0, 0.0],
                [-2.0, 0.0, 0.0],
                [0.0, 0.0, 2.0],
                [0.0, 3.0, 0.0],
            ])],
        ),
        parented(
            "below a node that is moved, turned and scaled",
            move_to(10.0, 0.0, 0.0) + turn(0.0, 90.0, 0.0) + scale(2.0, 2.0, 2.0),
            move_to(1.0, 0.0, 0.0),
            vec![
                Box([
                    [0.0, 0.0, -2.0],
                    [0.0, 2.0, 0.0],
                    [2.0, 0.0, 0.0],
                    [10.0, 0.0, -2.0],
                ]),
                Outward,
            ],
        ),
        parented(
            "the geometry of a node above moves nothing below",
            vector("GeometricTranslation", [7.0, 7.0, 7.0]),
            Text::default(),
            vec![Box([X, Y, Z, O])],
        ),
        parented(
            "a scale that is not inherited",
            scale(2.0, 2.0, 2.0),
            move_to(1.0, 0.0, 0.0) + integer("InheritType", 2),
            vec![Box([X, Y, Z, [2.0, 0.0, 0.0]])],
        ),
        parented(
            "below an invisible node",
            number("Visibility", 0.0) + integer("Visibility", 0),
            Text::default(),
            vec![Triangles(0), Warns("invisible nodes are left out ('box')")],
        ),
        {
            let objects = solid(1)
                + model(2, "a", "Mesh", "")
                + model(3, "b", "Mesh", &move_to(5.0, 0.0, 0.0));
            let connections = below(2, 0) + below(3, 0) + below(1, 2) + below(1, 3);
            let bounds = Bounds(0.0, O, [6.0, 2.0, 3.0]);
            case(
                "two nodes of one mesh",
                Y_UP,
                objects,
                connections,
                vec![Meshes(1), Instances(2), Triangles(24), bounds],
            )
        },
    ]
}

fn meshes() -> Vec<Case> {
    let plain =
        |name, points: &[f64], polygons: &[i32], layers: &str, kinds: &[(&str, u32)], expect| {
            let objects = mesh(1, points, polygons, layers, kinds) + model(2, "n", "Mesh", "");
            case(name, Y_UP, objects, below(2, 0) + below(1, 2), expect)
        };
    let square = [0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 1.0, 1.0, 0.0, 0.0, 1.0, 0.0];
    // A pentagon with a notch down to (1, 0.5).
    let notch = [
        0.0, 0.0, 0.0, 2.0, 0.0, 0.0, 2.0, 2.0, 0.0, 1.0, 0.5, 0.0, 0.0, 2.0, 0.0,
    ];
    // Two squares that meet at a right angle along x = 1.
    let bent = [
        0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 1.0, 1.0, 0.0, 0.0, 1.0, 0.0, 1.0, 0.0, -1.0, 1.0, 1.0, -1.0,
    ];
    let folds = [0, 1, 2, -4, 1, 4, 5, -3];
    let smooth = |values: &[i32]| {
        layer(
            "Smoothing",
            0,
            "",
            "ByPolygon",
            "Direct",
            &array("Smoothing", values),
        )
    };
    let uv = |number, name, values: &[f64]| {
        layer(
            "UV",
            number,
            name,
            "ByPolygonVertex",
            "Direct",
            &array("UV", values),
        )
    };
    let two = uv(0, "first", &[0.0, 0.0, 1.0, 0.0, 1.0, 0.75, 0.0, 0.75])
        + uv(1, "second", &[0.5, 0.5, 2.0, 0.5, 2.0, 2.0, 0.5, 2.0]);
    let painted = layer(
        "Color",
        0,
        "",
        "ByPolygonVertex",
        "IndexToDirect",
        &(array("Colors", &[1.0, 0.0, 0.5, 1.0, 0.0, 1.0, 0.0, 1.0])
            + array("ColorIndex", &[0, 0, 1, 1])),
    );
    let leaning = layer(
        "Normal",
        0,
        "",
        "ByVertice",
        "Direct",
        &array(
            "Normals",
            &[0.6, 0.0, 0.8, 0.6, 0.0, 0.8, 0.6, 0.0, 0.8, 0.6, 0.0, 0.8],
        ),
    );
    vec![
        plain(
            "a polygon with a notch",
            &notch,
            &[0, 1, 2, 3, -5],
            "",
            &[],
            vec![
                Triangles(3),
                Bounds(0.0, O, [2.0, 2.0, 0.0]),
                Normal(X.map(|c| 2.0 * c), Z),
                Outward,
            ],
        ),
        plain(
            "normals of the file",
            &square,
            &[0, 1, 2, -4],
            &leaning,
            &[("Normal", 0)],
            vec![Triangles(2), Normal(O, [0.6, 0.0, 0.8])],
        ),
        plain(
            "no normals are flat",
            &bent,
            &folds,
            "",
            &[],
            vec![Normals(X, 2), Normal(O, Z), Normal([1.0, 0.0, -1.0], X)],
        ),
        plain(
            "one smoothing group",
            &bent,
            &folds,
            &smooth(&[1, 1]),
            &[("Smoothing", 0)],
            vec![
                Normals(X, 1),
                Normal(X, [0.5f32.sqrt(), 0.0, 0.5f32.sqrt()]),
            ],
        ),
        plain(
            "no smoothing group",
            &bent,
            &folds,
            &smooth(&[0, 0]),
            &[("Smoothing", 0)],
            vec![Normals(X, 2)],
        ),
        plain(
            "two sets of coordinates, no texture",
            &square,
            &[0, 1, 2, -4],
            &two,
            &[("UV", 0), ("UV", 1)],
            vec![
                Uv(O, [0.0, 0.0]),
                Uv([1.0, 1.0, 0.0], [1.0, 0.75]),
                Uv(Y, [0.0, 0.75]),
            ],
        ),
        // 0.5 of sRGB is 0.21404 (IEC 61966-2-1).
        plain(
            "colours of vertices",
            &square,
            &[0, 1, 2, -4],
            &painted,
            &[("Color", 0)],
            vec![
                Painted(X, [1.0, 0.0, 0.21404]),
                Painted(Y, [0.0, 1.0, 0.0]),
                Base("default", [1.0; 3]),
            ],
        ),
        plain(
            "triangles without area and lines",
            &square,
            &[0, 1, 2, -4, 0, 1, -2, 0, -2],
            "",
            &[],
            vec![Triangles(2), Warns("dropped 1 triangles without area")],
        ),
        {
            let layers = layer(
                "Material",
                0,
                "",
                "ByPolygon",
                "IndexToDirect",
                &array("Materials", &[0, 0, 0, 1, 0, 0]),
            );
            let objects = mesh(1, &box_points(), &SIDES, &layers, &[("Material", 0)])
                + model(2, "box", "Mesh", "")
                + model(5, "other", "Mesh", &move_to(10.0, 0.0, 0.0))
                + material(3, "red", "phong", &color("DiffuseColor", [1.0, 0.0, 0.0]))
                + material(
                    4,
                    "blue",
                    "lambert",
                    &color("DiffuseColor", [0.0, 0.0, 1.0]),
                );
            // The other node has them the other way round.
            let connections = [
                (2, 0),
                (1, 2),
                (3, 2),
                (4, 2),
                (5, 0),
                (1, 5),
                (4, 5),
                (3, 5),
            ];
            let connections = connections
                .map(|(child, parent)| below(child, parent))
                .into_iter()
                .sum();
            case(
                "materials by polygon and node",
                Y_UP,
                objects,
                connections,
                vec![
                    Meshes(2),
                    Triangles(24),
                    Faces(O, &[RED]),
                    Faces([0.0, 2.0, 0.0], &[BLUE, RED]),
                    Faces([10.0, 0.0, 0.0], &[BLUE]),
                    Warnings(0),
                ],
            )
        },
    ]
}

fn materials() -> Vec<Case> {
    let textured = |more: &str, relative: &str, absolute: &str, name: &str| {
        (texture(6, relative, absolute, more), property(6, 3, name))
    };
    let second = |set: &str| {
        Text(format!(
            "Properties70:  {{\nP: \"UVSet\", \"KString\", \"\", \"\", \"{set}\"\n}}\n"
        ))
    };
    let scaled = "Properties70:  {\nP: \"Scaling\", \"Vector\", \"\", \"A\",2,4,1\n}\n";
    let none = || (Text::default(), Text::default());
    vec![
        made_of(
            "Phong",
            "phong",
            &(color("DiffuseColor", [0.5, 0.25, 1.0])
                + number("DiffuseFactor", 0.5)
                + color("EmissiveColor", [1.0, 2.0, 4.0])
                + number("EmissiveFactor", 3.0)
                + number("ShininessExponent", 6.0)),
            none(),
            vec![
                Base("m", [0.25, 0.125, 0.5]),
                Emission("m", [3.0, 6.0, 12.0]),
                // sqrt(2 / (6 + 2)).
                Roughness("m", 0.5),
                Metallic("m", 0.0),
                LeftOut("m", false),
                Warnings(0),
            ],
        ),
        made_of(
            "Lambert has no exponent",
            "lambert",
            &number("ShininessExponent", 6.0),
            none(),
            vec![Roughness("m", 1.0)],
        ),
        made_of(
            "nearly transparent",
            "phong",
            &(color("TransparentColor", [1.0; 3]) + number("TransparencyFactor", 0.75)),
            none(),
            vec![
                LeftOut("m", true),
                Triangles(0),
                Warns("materials with an opacity of 0.25 are left out ('m')"),
            ],
        ),
        made_of(
            "a factor of 1 of black lets nothing through",
            "phong",
            &(color("TransparentColor", [0.0; 3]) + number("TransparencyFactor", 1.0)),
            none(),
            vec![LeftOut("m", false), Triangles(12), Warnings(0)],
        ),
        made_of(
            "a physical material of 3ds Max",
            "unknown",
            &(integer("3dsMax|ClassIDa", 0x3d6b_1cec)
                + integer("3dsMax|ClassIDb", 0xdead_c001_u32 as i32)
                + number("3dsMax|Parameters|base_weight", 0.5)
                + color("3dsMax|Parameters|base_color", [1.0, 0.5, 0.0])
                + number("3dsMax|Parameters|roughness", 0.25)
                + number("3dsMax|Parameters|metalness", 0.75)
                + number("3dsMax|Parameters|trans_ior", 2.0)
                + number("3dsMax|Parameters|coating", 0.5)),
            none(),
            vec![
                Base("m", [0.5, 0.25, 0.0]),
                Roughness("m", 0.25),
                Metallic("m", 0.75),
                Ior("m", 2.0),
                Warns("coats are left out ('m')"),
                Warnings(1),
            ],
        ),
        made_of(
            "an opacity map is a mask",
            "phong",
            "",
            textured("", "leaf.png", "", "TransparentColor"),
            vec![
                LeftOut("m", false),
                Cutoff("m", 0.5),
                BaseMap("m", false, [255, 255, 255, 0]),
            ],
        ),
        made_of(
            "a picture that is clamped",
            "phong",
            "",
            textured(
                "Properties70:  {\nP: \"WrapModeU\", \"enum\", \"\", \"\",1\nP: \"WrapModeV\", \"enum\", \"\", \"\",1\n}\n",
                "textures/wall.png",
                "",
                "DiffuseColor",
            ),
            vec![Clamped("m", true)],
        ),
        made_of(
            "a kind of its own",
            "my shader",
            &color("DiffuseColor", [1.0, 0.0, 0.0]),
            none(),
            vec![
                Base("m", RED),
                Warns(
                    "materials of a kind that is not known ('my shader') have only their common colours and maps ('m')",
                ),
            ],
        ),
        made_of(
            "a picture next to the file replaces the colour",
            "phong",
            &color("DiffuseColor", [0.5, 0.0, 0.0]),
            textured(
                "",
                "textures\\\\wall.png",
                "C:\\\\gone\\\\wall.png",
                "DiffuseColor",
            ),
            vec![
                Base("m", [1.0; 3]),
                BaseMap("m", false, CHECKER),
                Uv(O, [0.0, 0.25]),
                Warnings(0),
            ],
        ),
        made_of(
            "a picture in another folder and case",
            "phong",
            "",
            textured(
                "",
                "..\\\\maps\\\\Wall.PNG",
                "C:\\\\Users\\\\me\\\\Textures\\\\Wall.PNG",
                "DiffuseColor",
            ),
            vec![
                BaseMap("m", false, CHECKER),
                Warns("files were found under a name in another case, or in another folder"),
            ],
        ),
        made_of(
            "a picture that is nowhere",
            "phong",
            "",
            textured("", "gone.png", "C:\\\\gone.png", "DiffuseColor"),
            vec![
                BaseMap("m", false, [255, 0, 255, 255]),
                Warns("gone.png of material m')"),
            ],
        ),
        made_of(
            "a scaled picture repeats less often",
            "phong",
            "",
            textured(scaled, "textures/wall.png", "", "DiffuseColor"),
            vec![BaseMap("m", false, CHECKER), Uv(O, [0.0, 0.0625])],
        ),
        made_of(
            "a set that is not there is the first",
            "phong",
            "",
            textured(&second("other"), "textures/wall.png", "", "DiffuseColor"),
            vec![BaseMap("m", false, CHECKER), Uv(O, [0.0, 0.25])],
        ),
        made_of(
            "a normal map",
            "phong",
            "",
            textured("", "lean.png", "", "NormalMap"),
            vec![NormalMap("m", Some([128, 218, 218, 255])), Warnings(0)],
        ),
        made_of(
            "a bump map of heights",
            "phong",
            "",
            textured("", "height.png", "", "Bump"),
            vec![
                NormalMap("m", None),
                Warns(
                    "bump maps that hold heights are left out. Convert them to normal maps ('m')",
                ),
            ],
        ),
        made_of(
            "a map that is left out",
            "phong",
            "",
            textured("", "lean.png", "", "SpecularColor"),
            vec![
                Warns("maps of the specular colour are left out ('m')"),
                Warnings(1),
            ],
        ),
        {
            let uv = |number, name, values: &[f64]| {
                layer(
                    "UV",
                    number,
                    name,
                    "ByPolygonVertex",
                    "Direct",
                    &array("UV", values),
                )
            };
            let layers = uv(0, "first", &[0.0, 0.0, 1.0, 0.0, 1.0, 0.75])
                + uv(1, "second", &[0.5, 0.25, 2.0, 0.5, 2.0, 2.0])
                + layer(
                    "Material",
                    0,
                    "",
                    "AllSame",
                    "IndexToDirect",
                    &array("Materials", &[0]),
                );
            let points = [0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 1.0, 1.0, 0.0];
            let objects = mesh(
                1,
                &points,
                &[0, 1, -3],
                &layers,
                &[("UV", 0), ("Material", 0), ("UV", 1)],
            ) + model(2, "n", "Mesh", "")
                + material(3, "m", "phong", "")
                + texture(6, "lean.png", "", &second("first"))
                + texture(7, "textures/wall.png", "", &second("second"));
            // The colour's set is named by a later texture than the emission's.
            let connections = below(2, 0)
                + below(1, 2)
                + below(3, 2)
                + property(6, 3, "NormalMap")
                + property(7, 3, "DiffuseColor");
            case(
                "textures of two sets",
                Y_UP,
                objects,
                connections,
                vec![
                    BaseMap("m", false, CHECKER),
                    Uv(O, [0.5, 0.25]),
                    SecondUv([1.0, 1.0, 0.0], [1.0, 0.75]),
                    Warnings(0),
                ],
            )
        },
    ]
}

fn lights_and_cameras() -> Vec<Case> {
    let lamp = |kind: i32, decay: i32| {
        integer("LightType", kind)
            + integer("DecayType", decay)
            + number("Intensity", 200.0)
            + color("Color", [1.0, 0.5, 0.25])
    };
    let cone = || number("InnerAngle", 60.0) + number("OuterAngle", 90.0);
    let half = [2.0, 1.0, 0.5];
    let down = [0.0, -1.0, 0.0];
    let unit = Warns("a hundredth of them is taken as W/m^2 or W/sr");
    let camera = |name: &'static str, properties: Text, expect| {
        let objects = solid(1)
            + model(2, "box", "Mesh", "")
            + model(3, "first", "Camera", "")
            + model(
                5,
                "second",
                "Camera",
                &(move_to(100.0, 200.0, 300.0) + turn(0.0, 90.0, 0.0)),
            )
            + attribute(4, "Camera", &properties);
        let connections = [(2, 0), (1, 2), (3, 0), (4, 3), (5, 0), (4, 5)]
            .map(|(a, b)| below(a, b))
            .into_iter()
            .sum::<Text>();
        case(name, CM, objects, connections, expect)
    };
    // An aperture of one inch and a focal length of 12.7 mm see 90 degrees.
    let lens = number("NearPlane", 10.0)
        + number("FarPlane", 4000.0)
        + number("FocalLength", 12.7)
        + number("FilmWidth", 1.0)
        + number("FilmHeight", 1.0)
        + integer("ApertureMode", 3)
        + integer("AspectRatioMode", 1)
        + number("AspectWidth", 1.0)
        + number("AspectHeight", 1.0);
    vec![
        light(
            "a point light",
            CM,
            move_to(100.0, 200.0, 300.0),
            lamp(0, 2),
            vec![
                Light("lamp", "point", half, [1.0, 2.0, 3.0], down),
                unit,
                Warnings(1),
            ],
        ),
        light(
            "a sun that is turned about z",
            Y_UP,
            turn(0.0, 0.0, 90.0),
            lamp(1, 0),
            vec![Light("lamp", "directional", half, O, X), Warnings(1)],
        ),
        light(
            "a spot of whole angles",
            Y_UP,
            Text::default(),
            lamp(2, 2) + cone(),
            vec![Light("lamp", "spot 30 45", half, O, down)],
        ),
        light(
            "a spot with z up",
            Z_UP,
            Text::default(),
            lamp(2, 2) + cone(),
            vec![Light("lamp", "spot 30 45", half, O, Z)],
        ),
        light(
            "an area",
            Y_UP,
            Text::default(),
            lamp(3, 2),
            vec![
                Light("lamp", "spot 0 90", half, O, down),
                Warns("area lights have no extent"),
            ],
        ),
        light(
            "a lamp without decay",
            Y_UP,
            Text::default(),
            lamp(0, 0),
            vec![
                Light("lamp", "point", half, O, down),
                Warns("lights that do not decay by the square of the distance do so here ('lamp')"),
            ],
        ),
        light(
            "a light that is switched off",
            Y_UP,
            Text::default(),
            lamp(0, 2) + integer("CastLight", 0),
            vec![Dark("lamp"), Warnings(0)],
        ),
        camera(
            "the camera that the file names comes first",
            lens,
            vec![
                Camera("default", [1.0, 2.0, 3.0], [0.0, 0.0, -1.0], Y, 90.0, 0.1),
                Camera("first", O, X, Y, 90.0, 0.1),
                Warnings(0),
            ],
        ),
        camera(
            "no perspective",
            integer("CameraProjectionType", 1),
            vec![Warns(
                "cameras that are no usable perspective are left out ('first', 'second')",
            )],
        ),
    ]
}

fn motions() -> Vec<Case> {
    let moved = |name,
                 world,
                 node: &str,
                 above: &str,
                 property: &str,
                 keys: &[[f64; 3]],
                 animated: u32,
                 expect| {
        let (objects, connections) = motion(animated, property, keys);
        let objects =
            solid(1) + model(2, "box", "Mesh", node) + model(3, "above", "Null", above) + objects;
        case(
            name,
            world,
            objects,
            below(3, 0) + below(2, 3) + below(1, 2) + connections,
            expect,
        )
    };
    let (one, two) = ([1.0, 2.0, 3.0], [0.0, 4.0, 0.0]);
    let second = text!("AnimationStack: 9100, \"AnimStack::run\", \"\" {{\n}}\n");
    let (walk, connections) = motion(2, "Lcl Translation", &[[0.0; 3], two]);
    let objects = solid(1) + model(2, "box", "Mesh", "") + walk + second;
    let several = case(
        "two animations",
        Y_UP,
        objects,
        below(2, 0) + below(1, 2) + connections,
        vec![
            Bounds(0.5, [0.0, 2.0, 0.0], [1.0, 4.0, 3.0]),
            Warns(
                "of several animations of one node the first is played. `clip: \"NAME\"` of a scene file's model chooses another ('run')",
            ),
        ],
    );
    vec![
        several,
        // The last key is the first again, one second is its middle.
        moved(
            "moved",
            Y_UP,
            "",
            "",
            "Lcl Translation",
            &[[0.0; 3], two, [8.0, 0.0, 0.0]],
            2,
            vec![
                Bounds(0.0, O, one),
                Bounds(0.5, [0.0, 2.0, 0.0], [1.0, 4.0, 3.0]),
                Bounds(1.5, [4.0, 2.0, 0.0], [5.0, 4.0, 3.0]),
                Warnings(0),
            ],
        ),
        moved(
            "moved below a node, in centimetres",
            CM,
            "",
            &(scale(100.0, 100.0, 100.0) + turn(0.0, 0.0, 90.0)),
            "Lcl Translation",
            &[[0.0; 3], two],
            2,
            vec![
                Bounds(0.0, [-2.0, 0.0, 0.0], [0.0, 1.0, 3.0]),
                Bounds(0.5, [-4.0, 0.0, 0.0], [-2.0, 1.0, 3.0]),
            ],
        ),
        moved(
            "turned about a pivot",
            Y_UP,
            &vector("RotationPivot", [1.0, 0.0, 0.0]),
            "",
            "Lcl Rotation",
            &[[0.0; 3], [0.0, 0.0, 180.0]],
            2,
            vec![
                Bounds(0.0, O, one),
                Bounds(0.5, [-1.0, -1.0, 0.0], [1.0, 0.0, 3.0]),
            ],
        ),
        moved(
            "the node above turns, with z up",
            Z_UP,
            &move_to(5.0, 0.0, 0.0),
            "",
            "Lcl Rotation",
            &[[0.0; 3], [0.0, 0.0, 180.0]],
            3,
            vec![
                Bounds(0.0, [5.0, 0.0, -2.0], [6.0, 3.0, 0.0]),
                // (x, y) of the file is (-y, x) after a quarter: x from -2 to 0, y from 5 to 6.
                Bounds(0.5, [-2.0, 0.0, -6.0], [0.0, 3.0, -5.0]),
            ],
        ),
        moved(
            "moved and mirrored",
            Y_UP,
            &scale(-1.0, 1.0, 1.0),
            "",
            "Lcl Translation",
            &[[0.0; 3], two],
            2,
            vec![Bounds(0.5, [-1.0, 2.0, 0.0], [0.0, 4.0, 3.0]), Outward],
        ),
        moved(
            "scaled",
            Y_UP,
            "",
            "",
            "Lcl Scaling",
            &[[1.0; 3], [2.0; 3]],
            2,
            vec![
                Bounds(0.0, O, one),
                Bounds(0.5, O, [1.5, 3.0, 4.5]),
                Warnings(0),
            ],
        ),
    ]
}

fn others() -> Vec<Case> {
    let bare = |name, text: &str, expect| Case {
        name,
        fbx: Text(text.into()),
        expect,
    };
    // All vertices follow a bone that was at the origin when they were bound, and is at (0, 5, 0).
    let identity = "1,0,0,0,0,1,0,0,0,0,1,0,0,0,0,1";
    let weights = array("Indexes", &[0, 1, 2, 3, 4, 5, 6, 7]) + array("Weights", &[1.0; 8]);
    let matrices =
        format!("Transform: *16 {{\na: {identity}\n}}\nTransformLink: *16 {{\na: {identity}\n}}\n");
    let bound = || {
        solid(1)
            + model(2, "box", "Mesh", "")
            + model(3, "bone", "LimbNode", &move_to(0.0, 5.0, 0.0))
            + Text(format!(
                "Deformer: 6, \"Deformer::skin\", \"Skin\" {{\nVersion: 101\n}}\n\
                 Deformer: 7, \"SubDeformer::c\", \"Cluster\" {{\nVersion: 100\n{weights}{matrices}}}\n"
            ))
    };
    let bones = || {
        [(2, 0), (1, 2), (3, 0), (6, 1), (7, 6), (3, 7)]
            .map(|(a, b)| below(a, b))
            .into_iter()
            .sum::<Text>()
    };
    let skinned = case(
        "a skin in the pose of its bone",
        Y_UP,
        bound(),
        bones(),
        vec![
            Bounds(0.0, [0.0, 5.0, 0.0], [1.0, 7.0, 3.0]),
            Outward,
            Warnings(0),
        ],
    );
    let (moves, moved) = motion(3, "Lcl Translation", &[[0.0, 5.0, 0.0], [0.0, 9.0, 2.0]]);
    let walking = case(
        "a skin whose bone moves",
        Y_UP,
        bound() + moves,
        bones() + moved,
        vec![
            Bounds(0.0, [0.0, 5.0, 0.0], [1.0, 7.0, 3.0]),
            Bounds(0.5, [0.0, 7.0, 1.0], [1.0, 9.0, 4.0]),
            Outward,
            Warnings(0),
        ],
    );
    // All vertices go up by 2 at 100 percent; at rest there are 25.
    let blend = |percent: &str| {
        let offsets = array("Indexes", &[0, 1, 2, 3, 4, 5, 6, 7])
            + array("Vertices", &[0.0, 2.0, 0.0].repeat(8));
        solid(1)
            + model(2, "box", "Mesh", &move_to(0.0, 0.0, 1.0))
            + Text(format!(
                "Deformer: 6, \"Deformer::b\", \"BlendShape\" {{\nVersion: 100\n}}\n\
                 Deformer: 7, \"SubDeformer::up\", \"BlendShapeChannel\" {{\nVersion: 100\nDeformPercent: {percent}\n\
                 FullWeights: *1 {{\na: 100\n}}\nProperties70: {{\nP: \"DeformPercent\", \"Number\", \"\", \"A\", {percent}\n}}\n}}\n\
                 Geometry: 8, \"Geometry::up\", \"Shape\" {{\nVersion: 100\n{offsets}}}\n"
            ))
    };
    let shapes = || {
        [(2, 0), (1, 2), (6, 1), (7, 6), (8, 7)]
            .map(|(a, b)| below(a, b))
            .into_iter()
            .sum::<Text>()
    };
    let shaped = case(
        "a blend shape at its weight",
        Y_UP,
        blend("25"),
        shapes(),
        vec![
            Bounds(0.0, [0.0, 0.5, 1.0], [1.0, 2.5, 4.0]),
            Outward,
            Warnings(0),
        ],
    );
    let (grows, grown) = motion(7, "DeformPercent", &[[0.0; 3], [100.0; 3]]);
    let growing = case(
        "a blend shape whose weight grows",
        Y_UP,
        blend("0") + grows,
        shapes() + grown,
        vec![
            Bounds(0.0, [0.0, 0.0, 1.0], [1.0, 2.0, 4.0]),
            Bounds(0.5, [0.0, 1.0, 1.0], [1.0, 3.0, 4.0]),
            Outward,
            Warnings(0),
        ],
    );
    let levels = {
        let objects = solid(1)
            + model(2, "fine", "Mesh", "")
            + model(3, "coarse", "Mesh", "")
            + model(4, "levels", "LodGroup", "")
            + attribute(5, "LodGroup", "");
        let connections = [(4, 0), (5, 4), (2, 4), (3, 4), (1, 2), (1, 3)]
            .map(|(a, b)| below(a, b))
            .into_iter()
            .sum::<Text>();
        case(
            "levels of detail",
            Y_UP,
            objects,
            connections,
            vec![
                Triangles(12),
                Warns("of levels of detail the first is shown ('levels')"),
            ],
        )
    };
    vec![
        skinned,
        walking,
        shaped,
        growing,
        levels,
        case(
            "nothing",
            Y_UP,
            Text::default(),
            Text::default(),
            vec![Triangles(0), Warns("no triangles")],
        ),
        bare("no bytes", "", vec![Error("it is no FBX file")]),
        bare(
            "a page",
            "<html>404 not found</html>\n",
            vec![Error("it is no FBX file")],
        ),
        bare(
            "an OBJ",
            "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n",
            vec![Error("it is no FBX file")],
        ),
        bare(
            "a version of the future",
            "Kaydara FBX Binary  \0\x1a\0\u{7f}\u{7f}\0\0",
            vec![Error("a.fbx")],
        ),
    ]
}
