//! FBX as text (version 7.4), written by hand: objects, and how they are connected.

macro_rules! text {
    ($($part:tt)*) => {
        Text(format!($($part)*))
    };
}

/// Text that is put together.
#[derive(Clone, Debug, Default)]
pub struct Text(pub String);

impl std::ops::Add for Text {
    type Output = Text;

    fn add(mut self, more: Text) -> Text {
        self.0 += &more.0;
        self
    }
}

impl std::ops::Deref for Text {
    type Target = str;

    fn deref(&self) -> &str {
        &self.0
    }
}

impl std::fmt::Display for Text {
    fn fmt(&self, f: &mut std::fmt::Formatter) -> std::fmt::Result {
        f.write_str(&self.0)
    }
}

impl std::iter::Sum for Text {
    fn sum<I: Iterator<Item = Text>>(parts: I) -> Text {
        parts.fold(Text::default(), |all, part| all + part)
    }
}

/// Unit in centimetres, and the axes: index and sign of up, front and right.
#[derive(Clone, Copy)]
pub struct World {
    pub unit: f64,
    pub up: (u8, i8),
    pub front: (u8, i8),
    pub right: (u8, i8),
}

pub const Y_UP: World = World {
    unit: 100.0,
    up: (1, 1),
    front: (2, 1),
    right: (0, 1),
};
pub const CM: World = World { unit: 1.0, ..Y_UP };
pub const Z_UP: World = World {
    unit: 100.0,
    up: (2, 1),
    front: (1, -1),
    right: (0, 1),
};
/// As of DirectX: the front is the other way.
pub const LEFT: World = World {
    front: (2, -1),
    ..Y_UP
};

/// A whole file.
pub fn document(world: World, objects: &str, connections: &str) -> Text {
    let axis = |name: &str, (axis, sign): (u8, i8)| {
        text!(
            "P: \"{name}Axis\", \"int\", \"Integer\", \"\",{axis}\nP: \"{name}AxisSign\", \"int\", \"Integer\", \"\",{sign}\n"
        )
    };
    let axes = axis("Up", world.up) + axis("Front", world.front) + axis("Coord", world.right);
    text!(
        "; FBX 7.4.0 project file\nFBXHeaderExtension:  {{\nFBXHeaderVersion: 1003\nFBXVersion: 7400\n}}\n\
         GlobalSettings:  {{\nVersion: 1000\nProperties70:  {{\n{axes}\
         P: \"UnitScaleFactor\", \"double\", \"Number\", \"\",{}\n\
         P: \"DefaultCamera\", \"KString\", \"\", \"\", \"second\"\n}}\n}}\n\
         Objects:  {{\n{objects}}}\nConnections:  {{\n{connections}}}\n",
        world.unit
    )
}

/// An array of numbers.
pub fn array<T: ToString>(name: &str, values: &[T]) -> Text {
    let list: Vec<String> = values.iter().map(T::to_string).collect();
    text!("{name}: *{} {{\na: {}\n}}\n", values.len(), list.join(","))
}

/// A layer of a mesh: `values` are its arrays.
pub fn layer(
    kind: &str,
    number: u32,
    name: &str,
    mapping: &str,
    reference: &str,
    values: &str,
) -> Text {
    text!(
        "LayerElement{kind}: {number} {{\nVersion: 101\nName: \"{name}\"\nMappingInformationType: \"{mapping}\"\n\
         ReferenceInformationType: \"{reference}\"\n{values}}}\n"
    )
}

/// A mesh of polygons: each ends with the complement of its last index. `kinds` are its layers.
pub fn mesh(
    id: u32,
    points: &[f64],
    polygons: &[i32],
    layers: &str,
    kinds: &[(&str, u32)],
) -> Text {
    let mut lists = Text::default();
    for number in [0, 1] {
        let of: Text = kinds
            .iter()
            .filter(|(_, n)| *n == number)
            .map(|(kind, n)| {
                text!("LayerElement:  {{\nType: \"LayerElement{kind}\"\nTypedIndex: {n}\n}}\n")
            })
            .sum();
        lists = lists + text!("Layer: {number} {{\nVersion: 100\n{of}}}\n");
    }
    let body = array("Vertices", points)
        + array("PolygonVertexIndex", polygons)
        + text!("{layers}")
        + lists;
    text!("Geometry: {id}, \"Geometry::\", \"Mesh\" {{\n{body}}}\n")
}

/// Corners of a box from the origin to (1, 2, 3): bits of the index are x, y and z.
pub fn box_points() -> Vec<f64> {
    (0..8)
        .flat_map(|i| {
            [
                f64::from(i & 1),
                f64::from(i >> 1 & 1) * 2.0,
                f64::from(i >> 2) * 3.0,
            ]
        })
        .collect()
}

/// Its six sides, counter-clockwise from outside: -z, +z, -y, +y, -x, +x.
pub const SIDES: [i32; 24] = [
    0, 2, 3, -2, 4, 5, 7, -7, 0, 1, 5, -5, 2, 6, 7, -4, 0, 4, 6, -3, 1, 3, 7, -6,
];

/// The box without normals.
pub fn solid(id: u32) -> Text {
    mesh(id, &box_points(), &SIDES, "", &[])
}

/// A node; `properties` are lines of `P`.
pub fn model(id: u32, name: &str, kind: &str, properties: &str) -> Text {
    text!(
        "Model: {id}, \"Model::{name}\", \"{kind}\" {{\nVersion: 232\nProperties70:  {{\n{properties}}}\n}}\n"
    )
}

/// A property of three numbers.
pub fn vector(name: &str, [x, y, z]: [f64; 3]) -> Text {
    text!("P: \"{name}\", \"Vector3D\", \"Vector\", \"\",{x:?},{y:?},{z:?}\n")
}

/// A property of one number.
pub fn number(name: &str, value: f64) -> Text {
    text!("P: \"{name}\", \"double\", \"Number\", \"\",{value}\n")
}

/// A property of a kind or a switch.
pub fn integer(name: &str, value: i32) -> Text {
    text!("P: \"{name}\", \"enum\", \"\", \"\",{value}\n")
}

pub fn move_to(x: f64, y: f64, z: f64) -> Text {
    vector("Lcl Translation", [x, y, z])
}

pub fn turn(x: f64, y: f64, z: f64) -> Text {
    vector("Lcl Rotation", [x, y, z])
}

pub fn scale(x: f64, y: f64, z: f64) -> Text {
    vector("Lcl Scaling", [x, y, z])
}

/// A material of a shading model.
pub fn material(id: u32, name: &str, kind: &str, properties: &str) -> Text {
    text!(
        "Material: {id}, \"Material::{name}\", \"\" {{\nVersion: 102\nShadingModel: \"{kind}\"\nProperties70:  {{\n\
         {properties}}}\n}}\n"
    )
}

/// A light or a camera, to be connected to a node.
pub fn attribute(id: u32, kind: &str, properties: &str) -> Text {
    text!(
        "NodeAttribute: {id}, \"NodeAttribute::\", \"{kind}\" {{\nProperties70:  {{\n{properties}}}\nTypeFlags: \"{kind}\"\n}}\n"
    )
}

/// A texture with its paths; `more` are lines.
pub fn texture(id: u32, relative: &str, absolute: &str, more: &str) -> Text {
    text!(
        "Texture: {id}, \"Texture::t{id}\", \"\" {{\nType: \"TextureVideoClip\"\nVersion: 202\nTextureName: \"Texture::t{id}\"\n\
         {more}FileName: \"{absolute}\"\nRelativeFilename: \"{relative}\"\n}}\n"
    )
}

/// One object below another; 0 is the root.
pub fn below(child: u32, parent: u32) -> Text {
    text!("C: \"OO\",{child},{parent}\n")
}

/// One object as a property of another.
pub fn property(child: u32, parent: u32, name: &str) -> Text {
    text!("C: \"OP\",{child},{parent}, \"{name}\"\n")
}

/// Ticks of a second.
pub const SECOND: i64 = 46_186_158_000;

/// An animation of one property: values of x, y and z at whole seconds, in straight lines.
pub fn motion(node: u32, name: &str, keys: &[[f64; 3]]) -> (Text, Text) {
    let curves: Text = (0..3u32)
        .map(|axis| {
            let times: Vec<i64> = (0..keys.len() as i64).map(|i| i * SECOND).collect();
            let values: Vec<f64> = keys.iter().map(|key| key[axis as usize]).collect();
            text!("AnimationCurve: {}, \"AnimCurve::\", \"\" {{\nDefault: 0\nKeyVer: 4008\n", 9010 + axis)
                + array("KeyTime", &times)
                + array("KeyValueFloat", &values)
                // Straight lines.
                + array("KeyAttrFlags", &[4])
                + array("KeyAttrDataFloat", &[0, 0, 0, 0])
                + array("KeyAttrRefCount", &[keys.len()])
                + text!("}}\n")
        })
        .sum();
    let objects = text!(
        "AnimationStack: 9000, \"AnimStack::walk\", \"\" {{\n}}\nAnimationLayer: 9001, \"AnimLayer::base\", \"\" {{\n}}\n\
         AnimationCurveNode: 9002, \"AnimCurveNode::T\", \"\" {{\n}}\n{curves}"
    );
    let connections = below(9001, 9000)
        + below(9002, 9001)
        + property(9002, node, name)
        + ["X", "Y", "Z"]
            .iter()
            .zip(9010..)
            .map(|(axis, id)| property(id, 9002, &format!("d|{axis}")))
            .sum::<Text>();
    (objects, connections)
}
