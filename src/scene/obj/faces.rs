//! Corners of faces: indices of position, texture coordinates and normal.

/// Marks an absent attribute.
pub(super) const NONE: u32 = u32::MAX;

/// A corner, by indices from 0.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(super) struct Corner {
    pub position: u32,
    pub uv: u32,
    pub normal: u32,
}

/// Counts of the attributes read; negative numbers count back from them.
#[derive(Clone, Copy, Debug)]
pub(super) struct Counts {
    pub positions: usize,
    pub uvs: usize,
    pub normals: usize,
}

/// A corner, and flags for texture coordinates and normals that cannot exist.
pub(super) type Read = (Corner, [bool; 2]);

/// Parses `1`, `1/2`, `1//3`, `1/2/3`, and these with empty ends. Positions out of range are
/// checked later, because they may follow.
pub(super) fn corner(word: &str, counts: Counts) -> Result<Read, String> {
    let mut parts = word.split('/');
    let mut number = || match parts.next() {
        None | Some("") => Ok(None),
        Some(text) => text
            .parse::<i64>()
            .map(Some)
            .map_err(|_| format!("'{word}' is not a corner of a face")),
    };
    let (position, uv, normal) = (number()?, number()?, number()?);
    if parts.next().is_some() {
        return Err(format!("'{word}' has more than three numbers"));
    }
    let position = position.ok_or_else(|| format!("'{word}' names no vertex"))?;
    let found =
        resolve(position, counts.positions).ok_or_else(|| missing(position, counts.positions))?;
    let optional =
        |number: Option<i64>, count: usize| match number.map(|number| resolve(number, count)) {
            None => (NONE, false),
            Some(None) => (NONE, true),
            Some(Some(index)) => (index, false),
        };
    let ((uv, no_uv), (normal, no_normal)) =
        (optional(uv, counts.uvs), optional(normal, counts.normals));
    Ok((
        Corner {
            position: found,
            uv,
            normal,
        },
        [no_uv, no_normal],
    ))
}

/// The message about a missing vertex.
pub(super) fn missing(number: i64, count: usize) -> String {
    format!("a face names vertex {number} of {count}")
}

/// The index from 0 of a number from 1, or of a negative one that counts back from the last.
fn resolve(number: i64, count: usize) -> Option<u32> {
    let index = match number {
        0 => return None,
        1.. => number - 1,
        _ => i64::try_from(count).ok()?.checked_add(number)?,
    };
    u32::try_from(index).ok().filter(|index| *index != NONE)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn corners_have_many_forms() {
        let counts = Counts {
            positions: 4,
            uvs: 3,
            normals: 2,
        };
        let read =
            |word| corner(word, counts).map(|(c, wrong)| ([c.position, c.uv, c.normal], wrong));
        for (word, corner, wrong) in [
            ("1", [0, NONE, NONE], [false; 2]),
            ("+2/3/1", [1, 2, 0], [false; 2]),
            ("1/", [0, NONE, NONE], [false; 2]),
            ("1//", [0, NONE, NONE], [false; 2]),
            ("1//2", [0, NONE, 1], [false; 2]),
            ("1/2/", [0, 1, NONE], [false; 2]),
            ("-4/-3/-2", [0, 0, 0], [false; 2]),
            ("9/9/9", [8, 8, 8], [false; 2]),
            ("1/0/-3", [0, NONE, NONE], [true; 2]),
        ] {
            assert_eq!(read(word), Ok((corner, wrong)), "{word}");
        }
        for (word, told) in [
            ("0", "vertex 0 of 4"),
            ("-5", "vertex -5 of 4"),
            ("99999999999", "vertex 99999999999"),
            ("/1", "no vertex"),
            ("1/2/3/4", "more than three"),
            ("1,5", "not a corner"),
            ("x", "not a corner"),
        ] {
            assert!(read(word).is_err_and(|e| e.contains(told)), "{word}");
        }
    }
}
