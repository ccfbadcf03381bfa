//! Mode 0: deltas between elements, stored in blocks, one byte position after another (appendix A
//! of the extension).

use super::{Stream, header};

/// Maximum elements per block.
const BLOCK: usize = 256;
/// Elements per group.
const GROUP: usize = 16;

/// Bits per delta by group mode; 8 bits are stored directly, fewer have a sentinel.
const VERSION_0: [u32; 4] = [0, 2, 4, 8];
/// The same for version 1, control modes 0 and 1.
const VERSION_1: [[u32; 4]; 2] = [[0, 1, 2, 4], [1, 2, 4, 8]];

/// Prediction of four bytes from the previous element.
#[derive(Clone, Copy)]
enum Channel {
    Bytes,
    Words,
    /// Exclusive or, rotated left by this amount.
    Xor(u32),
}

/// Decodes the elements of a stream.
pub(super) fn decode(data: &[u8], count: usize, stride: usize) -> Result<Vec<u8>, String> {
    let version = header(data, &[0xa0, 0xa1])? & 1;
    let tail = if version == 0 {
        stride
    } else {
        stride + stride / 4
    };
    let mut stream = Stream::body(data, tail.max(if version == 0 { 32 } else { 24 }))?;
    let mut tail = Stream(&data[data.len() - tail..]);
    let mut last = tail.take(stride)?.to_vec();
    let channels: Vec<Channel> = match version {
        0 => vec![Channel::Bytes; stride / 4],
        _ => tail
            .0
            .iter()
            .map(|&byte| channel(byte))
            .collect::<Result<_, _>>()?,
    };

    // The vector grows with the bytes read, so that a large declared count allocates nothing.
    let mut out = Vec::new();
    let mut deltas = vec![[0; BLOCK]; stride];
    let most = ((8192 / stride) & !(GROUP - 1)).min(BLOCK);
    let mut left = count;
    while left > 0 {
        let elements = left.min(most);
        let control = if version == 0 {
            &[][..]
        } else {
            stream.take(stride / 4)?
        };
        for (position, deltas) in deltas.iter_mut().enumerate() {
            let deltas = &mut deltas[..elements.next_multiple_of(GROUP)];
            let mode = control
                .get(position / 4)
                .map(|byte| byte >> (2 * (position % 4)) & 3);
            match mode {
                None => groups(&mut stream, deltas, VERSION_0)?,
                Some(mode @ 0..=1) => groups(&mut stream, deltas, VERSION_1[usize::from(mode)])?,
                Some(2) => deltas.fill(0),
                Some(_) => deltas[..elements].copy_from_slice(stream.take(elements)?),
            }
        }
        let mut follow_all = |element: usize| {
            for (i, channel) in channels.iter().enumerate() {
                let delta = std::array::from_fn(|k| deltas[4 * i + k][element]);
                if let Some(last) = last[4 * i..].first_chunk_mut::<4>() {
                    *last = follow(*last, delta, *channel);
                }
            }
            out.extend_from_slice(&last);
        };
        (0..elements).for_each(&mut follow_all);
        left -= elements;
    }
    stream.end()?;
    Ok(out)
}

fn channel(byte: u8) -> Result<Channel, String> {
    match (byte & 15, byte >> 4) {
        (0, 0) => Ok(Channel::Bytes),
        (1, 0) => Ok(Channel::Words),
        (2, rotation) => Ok(Channel::Xor(u32::from(rotation))),
        _ => Err(format!(
            "its compressed data has the unknown channel mode {byte:#x}"
        )),
    }
}

/// Deltas of one byte position, in groups of sixteen.
fn groups(stream: &mut Stream, deltas: &mut [u8], bits: [u32; 4]) -> Result<(), String> {
    let modes = stream.take(deltas.len().div_ceil(4 * GROUP))?;
    for (i, group) in deltas.chunks_exact_mut(GROUP).enumerate() {
        match bits[usize::from(modes[i / 4] >> (2 * (i % 4)) & 3)] {
            0 => group.fill(0),
            8 => group.copy_from_slice(stream.take(GROUP)?),
            bits => {
                let packed = stream.take(GROUP * bits as usize / 8)?;
                let sentinel = (1 << bits) - 1;
                for (k, delta) in group.iter_mut().enumerate() {
                    let bit = k as u32 * bits;
                    // Single bits start at the lowest bit, others at the highest.
                    let shift = if bits == 1 {
                        bit % 8
                    } else {
                        8 - bits - bit % 8
                    };
                    let value = packed[(bit / 8) as usize] >> shift & sentinel;
                    *delta = if value == sentinel {
                        stream.byte()?
                    } else {
                        value
                    };
                }
            }
        }
    }
    Ok(())
}

fn follow(last: [u8; 4], delta: [u8; 4], channel: Channel) -> [u8; 4] {
    match channel {
        Channel::Bytes => std::array::from_fn(|i| {
            let d = delta[i];
            last[i].wrapping_add((d >> 1) ^ (d & 1).wrapping_neg())
        }),
        Channel::Words => {
            let word = |b: [u8; 4], i: usize| u16::from_le_bytes([b[2 * i], b[2 * i + 1]]);
            let next = |i: usize| {
                let d = word(delta, i);
                word(last, i)
                    .wrapping_add((d >> 1) ^ (d & 1).wrapping_neg())
                    .to_le_bytes()
            };
            let ([a, b], [c, d]) = (next(0), next(1));
            [a, b, c, d]
        }
        Channel::Xor(rotation) => (u32::from_le_bytes(last)
            ^ u32::from_le_bytes(delta).rotate_right(rotation))
        .to_le_bytes(),
    }
}
