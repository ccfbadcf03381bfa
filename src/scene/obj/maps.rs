//! Texture entries of a material library: options, then a file.

use super::lines::without_comment;

/// A texture of a material with its options.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Map {
    /// As written in the library; may contain quotes, blanks and a comment.
    pub file: String,
    pub placement: Placement,
    /// `-clamp on`: the edge colour continues outside the picture.
    pub clamp: bool,
    /// `-bm`: strength of a bump map.
    pub strength: Option<f32>,
    /// Unsupported options.
    pub left_out: Vec<&'static str>,
}

/// Scale and offset of texture coordinates (`-s` and `-o`), v upwards.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Placement {
    pub scale: [f32; 2],
    pub offset: [f32; 2],
}

impl Default for Placement {
    fn default() -> Placement {
        Placement {
            scale: [1.0; 2],
            offset: [0.0; 2],
        }
    }
}

impl Placement {
    /// Transformed coordinates. OBJ has its origin at the lower left of the picture, scenes at the
    /// upper left.
    pub fn of(&self, [u, v]: [f32; 2]) -> [f32; 2] {
        [
            u * self.scale[0] + self.offset[0],
            1.0 - (v * self.scale[1] + self.offset[1]),
        ]
    }

    /// Equal placements have equal bits.
    pub fn bits(&self) -> [u32; 4] {
        let ([a, b], [c, d]) = (self.scale, self.offset);
        [a, b, c, d].map(f32::to_bits)
    }
}

/// The options and file of an entry; `None` without a file.
pub(super) fn parse(entry: &str) -> Option<Map> {
    let mut map = Map {
        file: String::new(),
        placement: Placement::default(),
        clamp: false,
        strength: None,
        left_out: Vec::new(),
    };
    let mut rest = entry.trim();
    while let Some((option, after)) = rest.starts_with('-').then(|| word(rest)) {
        rest = after;
        match option.to_ascii_lowercase().as_str() {
            "-s" => map.placement.scale = pair(&mut rest, map.placement.scale),
            "-o" => map.placement.offset = pair(&mut rest, map.placement.offset),
            "-t" => {
                if pair(&mut rest, [0.0; 2]) != [0.0; 2] {
                    map.left_out.push("-t");
                }
            }
            "-mm" => {
                if pair(&mut rest, [0.0, 1.0]) != [0.0, 1.0] {
                    map.left_out.push("-mm");
                }
            }
            "-bm" => map.strength = numbers::<1>(&mut rest)[0],
            "-clamp" => map.clamp = is_on(&mut rest),
            "-cc" => {
                if is_on(&mut rest) {
                    map.left_out.push("-cc");
                }
            }
            "-imfchan" => {
                rest = word(rest).1;
                map.left_out.push("-imfchan");
            }
            // Filter options and reflection map shapes do not affect the surface.
            _ => rest = word(rest).1,
        }
    }
    map.file = rest.to_owned();
    (!without_comment(rest).is_empty() && !rest.starts_with('#')).then_some(map)
}

fn is_on(rest: &mut &str) -> bool {
    let (value, after) = word(rest);
    *rest = after;
    value.eq_ignore_ascii_case("on")
}

/// The first word and the rest.
fn word(text: &str) -> (&str, &str) {
    let (first, rest) = text.split_once(char::is_whitespace).unwrap_or((text, ""));
    (first, rest.trim_start())
}

/// Up to three numbers, of which two are used; missing or non-finite ones keep their default.
fn pair(rest: &mut &str, default: [f32; 2]) -> [f32; 2] {
    let [x, y, _] = numbers::<3>(rest);
    [x.unwrap_or(default[0]), y.unwrap_or(default[1])]
}

/// The leading numbers, at most `N`. The last word is the file, even if it is a number.
fn numbers<const N: usize>(rest: &mut &str) -> [Option<f32>; N] {
    let mut found = [None; N];
    for number in &mut found {
        let (first, after) = word(rest);
        let Some(value) = first.parse::<f32>().ok().filter(|_| !after.is_empty()) else {
            break;
        };
        *number = Some(value).filter(|value| value.is_finite());
        *rest = after;
    }
    found
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn entries_have_options_and_a_file() {
        let (plain, none) = ([[1.0; 2], [0.0; 2]], &[][..]);
        let moved = [[4.0; 2], [1.0, 2.0]];
        let left = &["-mm", "-imfchan", "-t"][..];
        for (entry, file, [scale, offset], strength, left_out) in [
            ("a b.png", "a b.png", plain, None, none),
            ("-bm 0.5 t\\wall.png", "t\\wall.png", plain, Some(0.5), none),
            (
                "-o 1 2 -s 4 4 1 -clamp on a.png",
                "a.png",
                moved,
                None,
                none,
            ),
            (
                "-O 1 -S 2 a.png",
                "a.png",
                [[2.0, 1.0], [1.0, 0.0]],
                None,
                none,
            ),
            (
                "  -mm 0 1 -blendu on -texres 512 a.png",
                "a.png",
                plain,
                None,
                none,
            ),
            (
                "-mm 0.1 2 -imfchan r -t 1 a.png",
                "a.png",
                plain,
                None,
                left,
            ),
            ("-s 2 2 7", "7", [[2.0; 2], [0.0; 2]], None, none),
            ("-s nan inf 1 a.png # x", "a.png # x", plain, None, none),
        ] {
            let map = parse(entry).unwrap();
            let expected = (file, scale, offset, strength, left_out);
            assert_eq!(map.clamp, entry.contains("-clamp on"), "{entry}");
            let Placement { scale, offset } = map.placement;
            let found = (
                map.file.as_str(),
                scale,
                offset,
                map.strength,
                &map.left_out[..],
            );
            assert_eq!(found, expected, "{entry}");
        }
        assert!(
            ["", "-clamp on", "# a.png"]
                .iter()
                .all(|entry| parse(entry).is_none())
        );
    }
}
