//! Members of buffers, by name.

use crate::diagnostics::Loc;
use serde::Deserialize;

/// A buffer and, after a point, a member of its block as shaders declare it; after further points what is in that.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Path {
    /// The buffer.
    pub buffer: String,
    /// The member; empty where none is named.
    pub member: String,
}

impl std::fmt::Display for Path {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let point = if self.member.is_empty() { "" } else { "." };
        write!(f, "{}{point}{}", self.buffer, self.member)
    }
}

impl<'de> Deserialize<'de> for Path {
    fn deserialize<D: serde::Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let text = String::deserialize(deserializer)?;
        let (buffer, member) = text.split_once('.').unwrap_or((&text, ""));
        Ok(Path { buffer: buffer.into(), member: member.into() })
    }
}

/// Where the sizes of a dispatch or draw lie: `"buffer.member"`, or `"buffer", byte`.
#[derive(Clone, Debug)]
pub struct Command {
    /// The buffer, and the member.
    pub path: Loc<Path>,
    /// The byte, where no member says it.
    pub offset: Option<u64>,
}

impl<'de> Deserialize<'de> for Command {
    fn deserialize<D: serde::Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct Visitor;
        impl<'de> serde::de::Visitor<'de> for Visitor {
            type Value = Command;
            fn expecting(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
                f.write_str("\"buffer.member\", or \"buffer\" and a byte")
            }
            fn visit_seq<A: serde::de::SeqAccess<'de>>(self, mut parts: A) -> Result<Command, A::Error> {
                let path = parts.next_element()?.ok_or_else(|| serde::de::Error::invalid_length(0, &self))?;
                Ok(Command { path, offset: parts.next_element()? })
            }
        }
        deserializer.deserialize_tuple(2, Visitor)
    }
}
