//! The table: a name, an OBJ, its library `a.mtl`, and the expected scene.

use Expect::*;

type Point = [f32; 3];
type Color = [f32; 3];
type Texel = Option<[u8; 4]>;

/// A value of the scene.
#[derive(Debug)]
pub enum Expect {
    Triangles(usize),
    Meshes(&'static [&'static str]),
    Area(f32),
    /// x and y, and how many triangles are there.
    Covers(f32, f32, usize),
    /// Texture coordinates as in the file, v upwards, of every corner at a point.
    Uv(Point, [f32; 2]),
    NoUv(Point),
    Normal(Point, Point),
    /// How many normals there are at a point.
    Normals(Point, usize),
    /// The base colour of every face at a point.
    Face(Point, Color),
    /// The colour of every vertex at a point.
    Painted(Point, Color),
    Base(&'static str, Color),
    /// Whether the picture of the base colour is clamped along both axes.
    Wraps(&'static str, bool),
    Emission(&'static str, Color),
    Roughness(&'static str, f32),
    Metallic(&'static str, f32),
    Cutoff(&'static str, f32),
    NormalScale(&'static str, f32),
    /// The first texel.
    BaseMap(&'static str, Texel),
    EmissionMap(&'static str, Texel),
    NormalMap(&'static str, Texel),
    Textures(usize),
    Warns(&'static str),
    Warnings(usize),
    Error(&'static str),
}

pub struct Case {
    pub name: &'static str,
    pub obj: &'static [u8],
    pub mtl: &'static [u8],
    pub expect: &'static [Expect],
}

const RED: Color = [1.0, 0.0, 0.0];
const GREY: Color = [0.8; 3];
const O: Point = [0.0; 3];
const X: Point = [1.0, 0.0, 0.0];
const Y: Point = [0.0, 1.0, 0.0];
const Z: Point = [0.0, 0.0, 1.0];
const CHECKER: Texel = Some([200, 100, 50, 255]);
const MISSING: Texel = Some([255, 0, 255, 255]);
const LEAN: Texel = Some([128, 218, 218, 255]);
const RED_MTL: &[u8] = b"newmtl red\nKd 1 0 0\nnewmtl blue\nKd 0 0 1\n";
const UV_QUAD: &[u8] =
    b"mtllib a.mtl\nusemtl m\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nf 1/1 2/2 3/3 4/4\n";

/// A case without a library.
const fn plain(name: &'static str, obj: &'static [u8], expect: &'static [Expect]) -> Case {
    Case {
        name,
        obj,
        mtl: b"",
        expect,
    }
}

/// A case with a red and a blue material.
const fn red(name: &'static str, obj: &'static [u8], expect: &'static [Expect]) -> Case {
    Case {
        name,
        obj,
        mtl: RED_MTL,
        expect,
    }
}

/// A square with the material `m`.
const fn quad(name: &'static str, mtl: &'static [u8], expect: &'static [Expect]) -> Case {
    Case {
        name,
        obj: UV_QUAD,
        mtl,
        expect,
    }
}

pub const CASES: &[Case] = &[
    // Polygons.
    plain(
        "a concave polygon keeps its notch",
        b"v 2 0 0\nv 2 1 0\nv 1 1 0\nv 1 2 0\nv 0 2 0\nv 0 0 0\nf 1 2 3 4 5 6\n",
        &[Area(3.0), Triangles(4), Covers(1.3, 1.1, 0), Covers(0.53, 0.5, 1), Warnings(0)],
    ),
    plain(
        "a dart is cut along its inner diagonal",
        b"v 0 0 0\nv 1 0.2 0\nv 2 0 0\nv 1 2 0\nf 1 2 3 4\n",
        &[Area(1.8), Triangles(2), Covers(1.02, 0.1, 0), Warnings(0)],
    ),
    plain(
        "a dart that begins at each of its corners",
        b"v 0 0 0\nv 1 0.2 0\nv 2 0 0\nv 1 2 0\nf 2 3 4 1\nv 0 0 5\nv 1 .2 5\nv 2 0 5\nv 1 2 5\nf 7 8 5 6\n",
        &[Area(3.6), Triangles(4), Covers(1.02, 0.1, 0), Warnings(0)],
    ),
    plain(
        "a polygon that turns clockwise keeps its side",
        b"v 0 0 0\nv 0 2 0\nv 1 2 0\nv 1 1 0\nv 2 1 0\nv 2 0 0\nf 1 2 3 4 5 6\n",
        &[Area(3.0), Normal([2.0, 1.0, 0.0], [0.0, 0.0, -1.0]), Warnings(0)],
    ),
    plain(
        "an upright concave polygon",
        b"v 0 2 0\nv 0 2 1\nv 0 1 1\nv 0 1 2\nv 0 0 2\nv 0 0 0\nf 1 2 3 4 5 6\n",
        &[Area(3.0), Triangles(4), Warnings(0)],
    ),
    plain(
        "a quad that is not flat",
        b"v 0 0 0\nv 1 0 0.2\nv 1 1 0\nv 0 1 0.2\nf 1 2 3 4\n",
        &[Triangles(2), Covers(0.3, 0.6, 1), Covers(0.6, 0.3, 1), Warnings(0)],
    ),
    plain(
        "corners on a straight edge cost no triangle",
        b"v 0 0 0\nv 1 0 0\nv 2 0 0\nv 2 2 0\nv 0 2 0\nf 1 2 3 4 5\n",
        &[Area(4.0), Triangles(3), Warnings(0)],
    ),
    plain(
        "a hole behind a bridge stays open",
        b"v 0 0 0\nv 3 0 0\nv 3 3 0\nv 0 3 0\nv 1 1 0\nv 2 1 0\nv 2 2 0\nv 1 2 0\nf 1 2 3 4 1 5 8 7 6 5\n",
        &[Area(8.0), Covers(1.5, 1.5, 0), Covers(0.51, 1.5, 1), Warnings(0)],
    ),
    plain(
        "a crossed quad has triangles and a warning",
        b"v 0 0 0\nv 3 1 0\nv 3 0 0\nv 0 2 0\nf 1 2 3 4\n",
        &[Triangles(2), Warns("a.obj: faces cross or touch themselves: their triangles may overlap ('line 5')")],
    ),
    plain(
        "doubled corners and faces without area",
        b"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 1 2 3 3\nf 1 2 1 2\nf 1 1 1\n",
        &[Triangles(1), Area(0.5), Warns("without area")],
    ),
    plain(
        "faces of fewer than three corners are left out",
        b"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2\nf 1\nf\nf 1 2 3\n",
        &[Triangles(1), Warns("a.obj: faces of fewer than three corners are left out ('line 4', 'line 5', 'line 6')"), Warnings(1)],
    ),
    // Lines of text.
    plain("a byte order mark before v", b"\xef\xbb\xbfv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n", &[Triangles(1), Warnings(0)]),
    red(
        "a byte order mark before mtllib",
        b"\xef\xbb\xbfmtllib a.mtl\nusemtl red\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n",
        &[Face(O, RED), Warnings(0)],
    ),
    Case {
        name: "a byte order mark in the library",
        obj: b"mtllib a.mtl\nusemtl red\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n",
        mtl: b"\xef\xbb\xbfnewmtl red\nKd 1 0 0\n",
        expect: &[Face(O, RED), Warnings(0)],
    },
    plain("UTF-16", b"\xff\xfev\0 \x000\0 \x000\0 \x000\0\n\0p\0 \x001\0\n\0", &[Triangles(0), Warns("points (p)")]),
    plain("CRLF", b"v 0 0 0\r\nv 1 0 0\r\nv 0 1 0\r\nf 1 2 3\r\n", &[Triangles(1), Warnings(0)]),
    plain("line ends of old Macs", b"v 0 0 0\rv 1 0 0\rv 0 1 0\rf 1 2 3\r", &[Triangles(1), Warnings(0)]),
    plain("no line end, NUL and Ctrl-Z", b"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\0\x1a", &[Triangles(1), Warnings(0)]),
    plain("tabs and indentation", b"v\t0 0\t0\n  v 1 0 0\n\tv 0 1 0\n f\t1 2\t3 \n", &[Triangles(1), Warnings(0)]),
    plain("capital keywords", b"V 0 0 0\nV 1 0 0\nV 0 1 0\nVT 0.5 0.5\nF 1/1 2/1 3/1\n", &[Uv(X, [0.5; 2]), Warnings(0)]),
    plain(
        "continued lines",
        b"v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 \\\n0\nf 1 2 \\\n  4 \\\r\n 3\n# a comment \\\nf 1 2 3\n",
        &[Triangles(3), Area(1.5), Warnings(0)],
    ),
    plain(
        "comments behind values",
        b"v 0 0 0 # a\nv 1 0 0#b\nv 0 1 0 # c\nvn 0 0 1 # n\nf 1//1 2//1 3//1 # late\n",
        &[Triangles(1), Normal(X, Z), Warnings(0)],
    ),
    plain("numbers with signs and exponents", b"v +0 0 0\nv 1e0 0 0\nv 0 10.E-1 .0\nf +1 +2 +3\n", &[Area(0.5), Warnings(0)]),
    plain("a fourth coordinate", b"v 0 0 0 1\nv 1 0 0 1\nv 0 1 0 0.5\nf 1 2 3\n", &[Area(0.5), Warnings(0)]),
    plain("Latin-1 in a name", b"o caf\xe9\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n", &[Meshes(&["caf\u{fffd}"]), Warnings(0)]),
    plain(
        "objects and groups",
        b"v 0 0 0\nv 1 0 0\nv 0 1 0\no one\nf 1 2 3\ng two # x\nf 1 2 3\nf 3 2 1\ng\nf 1 2 3\n",
        &[Meshes(&["one", "two", "unnamed_object"]), Triangles(4), Warnings(0)],
    ),
    // Corners.
    plain(
        "relative corners",
        b"v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 0 1\nf -3/-3 -2/-2 -1/-1\nv 0 0 1\nf -1 -3 -2\n",
        &[Triangles(2), NoUv(Z), Warnings(0)],
    ),
    plain(
        "corners with empty parts",
        b"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1/ 2// 3\n",
        &[Triangles(1), Normal(O, Z), NoUv(X), Warnings(0)],
    ),
    plain(
        "a face without vt before one with",
        b"v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nv 1 0 1\nv 0 1 1\nvt .25 .25\nvt .75 .25\nvt .25 .75\nf 1 2 3\nf 4/1 5/2 6/3\n",
        &[NoUv(O), NoUv(X), Uv(Z, [0.25; 2]), Uv([1.0, 0.0, 1.0], [0.75, 0.25]), Uv([0.0, 1.0, 1.0], [0.25, 0.75])],
    ),
    plain(
        "a face with vt before one without",
        b"v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nv 1 0 1\nv 0 1 1\nvt .25 .25\nvt .75 .25\nvt .25 .75\nf 4/1 5/2 6/3\nf 1 2 3\n",
        &[NoUv(O), NoUv(X), Uv(Z, [0.25; 2]), Uv([1.0, 0.0, 1.0], [0.75, 0.25]), Uv([0.0, 1.0, 1.0], [0.25, 0.75])],
    ),
    plain(
        "one face with and without vt",
        b"v 0 0 0\nv 1 0 0\nv 0 1 0\nvt .5 .25\nf 1 2/1 3\n",
        &[NoUv(O), Uv(X, [0.5, 0.25]), NoUv(Y), Warnings(0)],
    ),
    plain(
        "normals are generated for faces that have none",
        b"o room\nv 0 0 0\nv 0 0 1\nv 1 0 1\nv 0 0 0\nv 2 0 0\nv 2 1 0\nvn 0 0 1\nf 1 2 3\nf 4//1 5//1 6//1\n",
        &[Normal([1.0, 0.0, 1.0], Y), Normal([2.0, 0.0, 0.0], Z), Normals(O, 2), Triangles(2), Warnings(0)],
    ),
    plain(
        "vt of one number",
        b"v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0\nvt 1\nvt 0.5\nf 1/1 2/2 3/3\n",
        &[Uv(X, [1.0, 0.0]), Uv(Y, [0.5, 0.0]), Warnings(0)],
    ),
    plain(
        "vt of three numbers",
        b"v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0.5 7\nf 1/1 2/1 3/1\n",
        &[Uv(X, [0.0, 0.5]), Warnings(0)],
    ),
    plain("v after the face", b"f 1 2 3\nv 0 0 0\nv 1 0 0\nv 0 1 0\n", &[Triangles(1), Warnings(0)]),
    plain(
        "vt after the face, in another object",
        b"o A\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nf 1/2 2/2 3/2\no B\nv 0 0 1\nv 1 0 1\nv 0 1 1\nvt 1 1\nf 4/1 5/1 6/2\n",
        &[Uv(O, [1.0; 2]), Uv([0.0, 1.0, 1.0], [1.0; 2]), Uv(Z, [0.0; 2]), Warnings(0)],
    ),
    plain(
        "vt that never comes",
        b"v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0.5 0.5\nf 1/1 2/1 3/2\nf 1/0 2/1 3/1\nf 1/-9 2/1 3/1\n",
        &[
            Triangles(3),
            NoUv(O),
            Warns("a.obj: faces name texture coordinates that the file does not hold: they have none ('line 6', 'line 7', 'line 5')"),
            Warnings(1),
        ],
    ),
    plain(
        "vn that never comes",
        b"v 0 0 0\nv 1 0 0\nv 0 1 0\nvn 1 0 0\nf 1//1 2//1 3//2\n",
        &[Normal(O, Z), Warns("normals that the file does not hold: theirs are generated ('line 5')"), Warnings(1)],
    ),
    plain(
        "normals of any length, and none",
        b"v 0 0 0\nv 1 0 0\nv 0 1 0\nvn 0 0 9\nvn 0 0 0\nvn nan 0 0\nf 1//1 2//2 3//3\n",
        &[Normal(O, Z), Normal(X, Z), Normal(Y, Z), Warnings(0)],
    ),
    plain(
        "vertices that are not finite",
        b"v 0 0 0\nv 1 0 0\nv 0 1 0\nv nan 0 0\nv inf 0 0\nf 1 2 3\nf 1 2 4\nf 1 2 5\n",
        &[Triangles(1), Warns("dropped 2 triangles with NaN or infinite vertices"), Warnings(1)],
    ),
    plain(
        "colours of vertices, some of them behind tabs",
        b"v\t0 0 0 1 0 0\nv\t1 0 0\nv 0 1 0 0 0 1\nf 1 2 3\n",
        &[
            Triangles(1),
            Painted([0.0; 3], [1.0, 0.0, 0.0]),
            Painted(X, [1.0; 3]),
            Painted(Y, [0.0, 0.0, 1.0]),
            Face(Y, [1.0; 3]),
            Warnings(0),
        ],
    ),
    plain(
        "colours of vertices as screens show them, one behind a weight, one that is no number",
        b"v 0 0 0 0.5 0.5 0.5\nv 1 0 0 1 0.25 0.25 0.25\nv 0 1 0 a b c\nf 1 2 3\n",
        &[
            Painted([0.0; 3], [0.21404114; 3]),
            Painted(X, [0.05087609; 3]),
            Painted(Y, [1.0; 3]),
            Warns("a.obj: colours of vertices that are not numbers are left out ('line 3')"),
            Warnings(1),
        ],
    ),
    // Smoothing.
    plain(
        "by angle: 40 degrees are smooth",
        b"v -1 0 0\nv 0 0 0\nv 0 1 0\nv -1 1 0\nv .76604 0 -.64279\nv .76604 1 -.64279\nf 1 2 3 4\nf 2 5 6 3\n",
        &[Normals(O, 1), Normal(O, [0.34202, 0.0, 0.93969]), Warnings(0)],
    ),
    plain(
        "s off: 40 degrees are flat",
        b"v -1 0 0\nv 0 0 0\nv 0 1 0\nv -1 1 0\nv .76604 0 -.64279\nv .76604 1 -.64279\ns off\nf 1 2 3 4\nf 2 5 6 3\n",
        &[Normals(O, 2), Normal([-1.0, 0.0, 0.0], Z), Warnings(0)],
    ),
    plain(
        "s 0 is off",
        b"v -1 0 0\nv 0 0 0\nv 0 1 0\nv -1 1 0\nv .76604 0 -.64279\nv .76604 1 -.64279\ns 0\nf 1 2 3 4\nf 2 5 6 3\n",
        &[Normals(O, 2), Warnings(0)],
    ),
    plain(
        "one group: 80 degrees are smooth",
        b"v -1 0 0\nv 0 0 0\nv 0 1 0\nv -1 1 0\nv .17365 0 -.98481\nv .17365 1 -.98481\ns 1\nf 1 2 3 4\nf 2 5 6 3\n",
        &[Normals(O, 1), Normal(O, [0.64279, 0.0, 0.76604]), Warnings(0)],
    ),
    plain(
        "two groups: 40 degrees are flat",
        b"v -1 0 0\nv 0 0 0\nv 0 1 0\nv -1 1 0\nv .76604 0 -.64279\nv .76604 1 -.64279\ns 1\nf 1 2 3 4\ns 2\nf 2 5 6 3\n",
        &[Normals(O, 2), Warnings(0)],
    ),
    plain(
        "a polygon with s off is flat across its triangles",
        b"s off\nv 0 0 0\nv 2 0 0\nv 2 1 0\nv 1 1 0\nv 1 2 0\nv 0 2 0\nf 1 2 3 4 5 6\n",
        &[Normal([1.0, 1.0, 0.0], Z), Area(3.0), Warnings(0)],
    ),
    plain(
        "given normals count more than groups",
        b"s 1\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvn 1 0 0\nf 1//1 2//1 3//1\n",
        &[Normal(O, X), Warnings(0)],
    ),
    // Statements that are left out.
    plain(
        "polylines are no surface",
        b"v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\nl 1 2 4 3\nl 1 2\nf 1 2 3\n",
        &[Triangles(1), Warns("a.obj: lines (l) are left out: only faces are rendered ('line 5', 'line 6')"), Warnings(1)],
    ),
    plain("points are no surface", b"v 0 0 0\nv 1 0 0\nv 0 1 0\np 1 2\nf 1 2 3\n", &[Triangles(1), Warns("points (p)")]),
    plain(
        "curves and surfaces",
        b"v 0 0 0\nv 1 0 0\nv 0 1 0\nvp 0 1\ncstype bspline\ndeg 1\ncurv 0 1 1 2\nparm u 0 1\nend\nsurf 0 1 0 1 1 2 3\nf 1 2 3\n",
        &[Triangles(1), Warns("curves and free-form surfaces are left out. Convert them to polygons ('line 4', 'line 7', 'line 10')"), Warnings(1)],
    ),
    plain(
        "unknown keywords",
        b"v 0 0 0\nv 1 0 0\nv 0 1 0\nxyz 1\nabc\nf 1 2 3\n",
        &[Triangles(1), Warns("lines with unknown keywords are left out ('xyz', 'abc')"), Warnings(1)],
    ),
    // Errors.
    plain("a vertex that is not there", b"v 0 0 0\nv 1 0 0\n\nf 1 2 3\n", &[Error("line 4: a face names vertex 3 of 2")]),
    plain("vertex 0", b"v 0 0 0\nf 0 1 1\n", &[Error("line 2: a face names vertex 0 of 1")]),
    plain("too far back", b"v 0 0 0\nf -1 -2 -1\n", &[Error("line 2: a face names vertex -2 of 1")]),
    plain("decimal commas", b"v 0,5 0 0\n", &[Error("line 1: '0,5' of a position is not a number (decimals have a point)")]),
    plain("two coordinates", b"v 0 0\n", &[Error("line 1: a position needs 3 numbers and has 2")]),
    plain("a face of words", b"v 0 0 0\nf a b c\n", &[Error("line 2: 'a' is not a corner of a face")]),
    plain("random bytes", b"\x80\x11\x93\x07\n\xff\xfe\n\x01\x02o\x7f\n\x99", &[Error("it holds nothing of the OBJ format")]),
    plain("a page", b"<html>404 not found</html>\n", &[Error("it holds nothing of the OBJ format")]),
    plain("nothing", b"", &[Triangles(0), Warns("no triangles"), Warnings(1)]),
    // Use of materials.
    red("a material", b"mtllib a.mtl\nusemtl red\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n", &[Face(O, RED), Warnings(0)]),
    red(
        "usemtl before mtllib",
        b"usemtl red\nmtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n",
        &[Face(O, RED), Warnings(0)],
    ),
    red("indented usemtl", b"mtllib a.mtl\n  usemtl red\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n", &[Face(O, RED), Warnings(0)]),
    red(
        "usemtl and mtllib with tabs",
        b"mtllib\ta.mtl\nusemtl\tred\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n",
        &[Face(O, RED), Warnings(0)],
    ),
    red(
        "usemtl and mtllib with comments",
        b"mtllib a.mtl # x\nusemtl red # wall\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n",
        &[Face(O, RED), Warnings(0)],
    ),
    red(
        "usemtl without a name",
        b"mtllib a.mtl\nusemtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n",
        &[Face(O, GREY), Warns("materials that no library defines are grey"), Warnings(1)],
    ),
    red(
        "a material in another case is another material",
        b"mtllib a.mtl\nusemtl Red\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n",
        &[Face(O, GREY), Warns("a.obj: materials that no library defines are grey ('Red')"), Warnings(1)],
    ),
    red(
        "no mtllib",
        b"usemtl red\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n",
        &[Face(O, GREY), Warns("materials that no library defines are grey ('red')"), Warnings(1)],
    ),
    red(
        "a library that is not there",
        b"mtllib gone.mtl\nusemtl red\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n",
        &[Face(O, GREY), Warns("material libraries cannot be read"), Warns("gone.mtl"), Warnings(2)],
    ),
    red(
        "quotes, a foreign path and another case",
        b"mtllib \"C:\\Users\\me\\A.MTL\"\nusemtl red\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n",
        &[Face(O, RED), Warns("files were found under a name in another case, or in another folder"), Warnings(1)],
    ),
    red(
        "several libraries, one of them missing",
        b"mtllib gone.mtl a.mtl\nmtllib a.mtl\nusemtl red\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n",
        &[Face(O, RED), Warns("gone.mtl"), Warnings(1)],
    ),
    red(
        "a material stays through o and g",
        b"mtllib a.mtl\nusemtl red\no a\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\no b\nf 1 2 3\no a\nf 3 2 1\n",
        &[Face(O, RED), Triangles(3), Warnings(0)],
    ),
    Case {
        name: "names with blanks and numbers",
        obj: b"mtllib a.mtl\nusemtl Material #2\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\nusemtl dark oak\nv 0 0 1\nf 1 2 4\n",
        mtl: b"newmtl Material #1\nKd 0 0 1\nnewmtl Material #2\nKd 1 0 0\nnewmtl dark oak # old\nKd 0 1 0\n",
        expect: &[Face(Y, RED), Base("Material #1", [0.0, 0.0, 1.0]), Face(Z, [0.0, 1.0, 0.0]), Warnings(0)],
    },
    Case {
        name: "an empty newmtl and one name twice",
        obj: b"mtllib a.mtl\nusemtl red\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n",
        mtl: b"newmtl\nKd 0 0 1\nnewmtl red\nKd 0 1 0\nnewmtl red\nKd 1 0 0\n",
        expect: &[Face(O, RED), Warnings(0)],
    },
    // Values of materials.
    quad("keywords in any case", b"NEWMTL m\nKD 0.5 0.25 1\nMAP_KD checker.png\nNS 198\n", &[
        Base("m", [0.5, 0.25, 1.0]),
        BaseMap("m", CHECKER),
        Roughness("m", 0.1),
        Warnings(0),
    ]),
    quad("tabs, indentation and comments", b"newmtl m # x\n\tKd\t0.5 0.25 1 # y\n\t map_Kd\tchecker.png # z\n", &[
        Base("m", [0.5, 0.25, 1.0]),
        BaseMap("m", CHECKER),
        Warnings(0),
    ]),
    quad("Kd 0 beside map_Kd", b"newmtl m\nKd 0 0 0\nmap_Kd checker.png\n", &[
        Base("m", [1.0; 3]),
        BaseMap("m", CHECKER),
        Warns("a.mtl: Kd is 0 next to map_Kd: the map is used as it is ('m')"),
        Warnings(1),
    ]),
    quad("Ke 0 beside map_Ke", b"newmtl m\nKd 0 0 0\nKe 0 0 0\nmap_Ke checker.png\n", &[
        Base("m", [0.0; 3]),
        Emission("m", [1.0; 3]),
        EmissionMap("m", CHECKER),
        Warns("a.mtl: Ke is 0 next to map_Ke"),
        Warnings(1),
    ]),
    quad("maps without factors", b"newmtl m\nmap_Kd checker.png\nmap_Ke checker.png\n", &[
        Base("m", [1.0; 3]),
        Emission("m", [1.0; 3]),
        Warnings(0),
    ]),
    quad("neither factors nor maps", b"newmtl m\n", &[Base("m", GREY), Roughness("m", 1.0), Warnings(0)]),
    quad("one number, too much, and none", b"newmtl m\nKd 0.5\nKe 2\nnewmtl n\nKd 255 128 0\nKs 1 2\nd x\n", &[
        Base("m", [0.5; 3]),
        Emission("m", [2.0; 3]),
        Base("n", [1.0, 1.0, 0.0]),
        Warns("a.mtl: Kd reflects more than arrives; numbers above 1 are read as 1 ('line 5')"),
        Warns("Ks needs one number or three; the line is left out ('line 6')"),
        Warns("d needs a number; the line is left out ('line 7')"),
        Warnings(3),
    ]),
    quad("metallic-roughness", b"newmtl m\nPr 0.25\nPm 0.75\nPs 0\nPc 0.5\n", &[
        Roughness("m", 0.25),
        Metallic("m", 0.75),
        Warns("a.mtl: lines with unknown keywords are left out ('Pc')"),
        Warnings(1),
    ]),
    quad("opacity", b"newmtl m\nd 0.8\nnewmtl n\nTr 0.7\nnewmtl o\nd 1\nTr 1\n", &[
        Cutoff("m", 0.0),
        Cutoff("n", 0.5),
        Cutoff("o", 0.0),
        Warns("a.mtl: materials with an opacity of 0.80 are opaque ('m')"),
        Warns("a.mtl: materials with an opacity of 0.30 are left out ('n')"),
        Warnings(2),
    ]),
    quad("statements before a material", b"Kd 1 0 0\nnewmtl m\n", &[Base("m", GREY), Warns("before the first newmtl")]),
    // Maps and their options.
    quad("scale and offset", b"newmtl m\nmap_Kd -s 4 2 1 -o 0.5 0.25 checker.png\n", &[
        Uv(O, [0.5, 0.25]),
        Uv([1.0, 1.0, 0.0], [4.5, 2.25]),
        BaseMap("m", CHECKER),
        Warnings(0),
    ]),
    quad("scale of one number", b"newmtl m\nmap_Kd -s 3 checker.png\n", &[Uv([1.0, 1.0, 0.0], [3.0, 1.0]), Warnings(0)]),
    quad("maps with different scales", b"newmtl m\nmap_Ke -s 2 2 checker.png\nmap_Kd -s 4 4 checker.png\n", &[
        Uv([1.0, 1.0, 0.0], [4.0, 4.0]),
        Warns("a.mtl: maps of one material have different -s or -o"),
        Warnings(1),
    ]),
    Case {
        name: "scale is that of the material of each face",
        obj: b"mtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nvt 1 1\nusemtl m\nf 1/1 2/1 3/1\nusemtl n\nf 1/1 2/1 4/1\n",
        mtl: b"newmtl m\nmap_Kd -s 2 2 checker.png\nnewmtl n\nmap_Kd checker.png\n",
        expect: &[Uv(Y, [2.0; 2]), Uv(Z, [1.0; 2]), Warnings(0)],
    },
    quad("options without effect", b"newmtl m\nmap_Kd -blendu on -mm 0 1 -texres 512 -clamp off -cc off checker.png\n", &[
        BaseMap("m", CHECKER),
        Wraps("m", false),
        Warnings(0),
    ]),
    quad("options that are left out", b"newmtl m\nmap_Kd -clamp on -mm 0.1 2 -imfchan r -cc on -t 1 1 1 checker.png\n", &[
        BaseMap("m", CHECKER),
        Warns("a.mtl: the option -imfchan of maps is left out ('m')"),
        Wraps("m", true),
        Warnings(4),
    ]),
    quad("a normal map as norm", b"newmtl m\nnorm -bm 0.5 lean.png\n", &[NormalMap("m", LEAN), NormalScale("m", 0.5), Warnings(0)]),
    quad("a normal map as bump, with any name", b"newmtl m\nmap_Bump -bm 1.5 brick_nor_gl_1k.png\n", &[
        NormalMap("m", LEAN),
        NormalScale("m", 1.5),
        Warnings(0),
    ]),
    quad("heights as bump, with any name", b"newmtl m\nbump wall_normal_height.png\n", &[
        NormalMap("m", None),
        Textures(0),
        Warns("a.mtl: bump maps that hold heights are left out. Convert them to normal maps, and write 'norm FILE' ('m')"),
        Warnings(1),
    ]),
    quad("a bump map that is not there", b"newmtl m\nbump gone.png\n", &[
        NormalMap("m", None),
        Warns("a.mtl: bump maps that are not there are left out"),
        Warnings(1),
    ]),
    quad("norm and bump", b"newmtl m\nmap_Bump wall_normal_height.png\nnorm lean.png\nmap_Kd checker.png\n", &[
        NormalMap("m", LEAN),
        BaseMap("m", CHECKER),
        Textures(2),
    ]),
    quad(
        "maps that are left out",
        b"newmtl m\nmap_Ks a.png\nmap_Ns b.png\nmap_Ka c.png\ndisp d.png\nrefl -type sphere e.png\ndecal f.png\nmap_aat on\n",
        &[Warns("a.mtl: map_Ks is left out ('a.png')"), Warns("disp is left out"), Warns("refl"), Warnings(6)],
    ),
    quad("holes in the alpha of map_Kd", b"newmtl m\nKd 1 1 1\nmap_Kd leaf.png\n", &[
        Cutoff("m", 0.5),
        Warns("a.mtl: the picture of map_Kd has holes in its alpha and there is no map_d: it is a mask at 0.5 ('m')"),
        Warnings(1),
    ]),
    quad("the same picture as map_d", b"newmtl m\nmap_Kd leaf.png\nmap_d leaf.png\n", &[Cutoff("m", 0.5), Warnings(0)]),
    quad("an alpha that is nowhere", b"newmtl m\nmap_Kd clear.png\n", &[Cutoff("m", 0.0), Warns("below 0.5 everywhere")]),
    quad("a cutoff of the exporter's own", b"newmtl m\nmap_Kd leaf.png\nalpha_cutoff 0\n", &[Cutoff("m", 0.0), Warnings(0)]),
    // Paths.
    quad("backslashes", b"newmtl m\nmap_Kd .\\textures\\\\wall.png\n", &[BaseMap("m", CHECKER), Warnings(0)]),
    quad("another case", b"newmtl m\nmap_Kd Textures\\Wall.PNG\n", &[
        BaseMap("m", CHECKER),
        Warns("a.mtl: files were found under a name in another case, or in another folder ('Textures\\Wall.PNG')"),
        Warnings(1),
    ]),
    quad("a path of another machine", b"newmtl m\nmap_Kd C:\\Users\\me\\textures\\wall.png\n", &[BaseMap("m", CHECKER), Warnings(1)]),
    quad("a name with blanks", b"newmtl m\nmap_Kd my wall.png\n", &[BaseMap("m", CHECKER), Warnings(0)]),
    quad("a name in quotes", b"newmtl m\nmap_Kd \"my wall.png\" # x\n", &[BaseMap("m", CHECKER), Warnings(0)]),
    quad("a picture that is not there", b"newmtl m\nmap_Kd gone.png\n", &[
        BaseMap("m", MISSING),
        Warns("textures: the file does not exist; a checkerboard replaces it, or its first colour on meshes without texture coordinates ('"),
        Warns("gone.png of material m')"),
        Warnings(1),
    ]),
];
