//! Changes to the bytes of a file that keep most of it.

/// Numbers by SplitMix64 (Steele, Lea, Flood 2014).
pub struct Random(u64);

impl Random {
    pub fn new(seed: u64) -> Random {
        Random(seed.wrapping_mul(0x2545_f491_4f6c_dd1d))
    }

    fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    /// A number below a bound; 0 where that is 0.
    pub fn below(&mut self, bound: usize) -> usize {
        (self.next() % bound.max(1) as u64) as usize
    }
}

/// What parsers trip over.
const WORDS: [&str; 44] = [
    "nan",
    "inf",
    "-inf",
    "-1",
    "0",
    "1e39",
    "-1e39",
    "1e-45",
    "1e18",
    "2147483648",
    "4294967295",
    "4294967296",
    "1.0",
    "18446744073709551615",
    "99999999999999999999999",
    "0.1",
    "true",
    "null",
    "\"\"",
    "\"x\"",
    "[]",
    "{}",
    "()",
    "(",
    ")",
    "[",
    "]",
    "{",
    "}",
    ",",
    ":",
    "\"",
    "\\",
    "\n",
    "\t",
    "\0",
    "\u{feff}",
    "\u{fffd}",
    "/",
    "..",
    "-",
    "%",
    "f -1 -2 -3",
    "v 1 2",
];

/// The bytes of a file after one to eight changes; parts may come from another file.
pub fn mutated(random: &mut Random, bytes: &[u8], other: &[u8]) -> Vec<u8> {
    let mut out = bytes.to_vec();
    let changes = [1, 1, 1, 2, 3, 8][random.below(6)];
    (0..changes).for_each(|_| change(random, &mut out, other));
    out.truncate(1 << 20);
    out
}

fn change(random: &mut Random, out: &mut Vec<u8>, other: &[u8]) {
    let at = random.below(out.len() + 1);
    let most = if random.below(4) == 0 {
        out.len() + 1
    } else {
        16
    };
    let length = random.below(most);
    let end = (at + length).min(out.len());
    let word = WORDS[random.below(WORDS.len())].as_bytes();
    match random.below(14) {
        0 if at < out.len() => out[at] ^= 1 << random.below(8),
        1 if at < out.len() => out[at] = random.below(256) as u8,
        2 => drop(out.drain(at..end)),
        3 => {
            let part = out[at..end].to_vec();
            let to = random.below(out.len() + 1);
            out.splice(to..to, part);
        }
        4 => drop(out.splice(at..at, word.iter().copied())),
        5 => drop(out.splice(at..end, word.iter().copied())),
        6 => out.truncate(at),
        7 => {
            let from = random.below(other.len() + 1);
            let part = &other[from..(from + length).min(other.len())];
            out.splice(at..end, part.iter().copied());
        }
        8 if at + 4 <= out.len() => {
            let number = [
                0,
                1,
                0x7fff_ffff,
                0x8000_0000,
                u32::MAX,
                0x7f80_0000,
                0x7fc0_0000,
                65536,
            ][random.below(8)];
            out[at..at + 4].copy_from_slice(&number.to_le_bytes());
        }
        _ => {
            // A number of the text becomes another.
            let is_digit = |b: &u8| b.is_ascii_digit() || b".-+e".contains(b);
            let Some(from) = out[at..]
                .iter()
                .position(u8::is_ascii_digit)
                .map(|i| at + i)
            else {
                return;
            };
            let to = out[from..]
                .iter()
                .position(|b| !is_digit(b))
                .map_or(out.len(), |i| from + i);
            out.splice(from..to, WORDS[random.below(19)].bytes());
        }
    }
}
