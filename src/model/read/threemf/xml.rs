//! The tags of a part of XML, as a stream: what lies between them is nothing to a model. Memory does not grow with the part.

use std::borrow::Cow;

use super::package::Part;
use super::{ThreeMfError, XmlFault};

/// Bytes that are read at a time.
const CHUNK_BYTES: usize = 1 << 16;

/// No tag is longer.
const MOST_TAG_BYTES: usize = 1 << 20;

/// A tag.
#[derive(Debug, Clone)]
pub enum Tag<'b> {
    /// The start of an element.
    Start {
        /// Its name, with the prefix.
        name: &'b [u8],
        attributes: Attributes<'b>,
        /// True if it is the end of the element as well.
        is_empty: bool,
    },
    /// The end of an element.
    End {
        /// Its name, with the prefix.
        name: &'b [u8],
    },
}

/// The tags of a part.
pub struct Tags<'a> {
    part: Part<'a>,
    buffer: Vec<u8>,
    /// Start of the text not yet read.
    at: usize,
    /// Start of the last tag.
    start: usize,
    /// Lines before the buffer.
    lines: u64,
}

impl<'a> Tags<'a> {
    pub fn of(part: Part<'a>) -> Result<Self, ThreeMfError> {
        let mut tags = Self {
            part,
            buffer: Vec::new(),
            at: 0,
            start: 0,
            lines: 0,
        };
        while tags.buffer.len() < 4 && tags.read_on()? {}
        if tags.buffer.starts_with(b"\xef\xbb\xbf") {
            tags.at = 3;
        }
        if !tags.buffer[tags.at..].trim_ascii_start().starts_with(b"<") {
            return Err(tags.fault(XmlFault::NotXml));
        }
        Ok(tags)
    }

    pub fn part(&self) -> &str {
        &self.part.name
    }

    /// The line of the last tag, from 1.
    pub fn line(&self) -> u64 {
        self.lines + 1 + line_ends(&self.buffer[..self.start])
    }

    pub fn fault(&self, fault: XmlFault) -> ThreeMfError {
        ThreeMfError::Xml {
            part: self.part.name.clone(),
            line: self.line(),
            fault,
        }
    }

    /// The next tag; `None` at the end of the part.
    pub fn next(&mut self) -> Result<Option<Tag<'_>>, ThreeMfError> {
        loop {
            if !self.skip_until(b"<")? {
                return Ok(None);
            }
            self.start = self.at;
            // Enough to distinguish comments from the rest.
            while self.buffer.len() - self.start < 9 && self.read_on()? {}
            let text = &self.buffer[self.start..];
            let end: &[u8] = if text.starts_with(b"<!--") {
                b"-->"
            } else if text.starts_with(b"<![CDATA[") {
                b"]]>"
            } else if text.starts_with(b"<?") {
                b"?>"
            } else if text.starts_with(b"<!") {
                return Err(self.fault(XmlFault::Doctype));
            } else {
                break;
            };
            // `<!-->` is no comment.
            self.at += if end == b"-->" { 4 } else { 2 };
            if !self.skip_until(end)? {
                return Err(self.fault(XmlFault::CutShort));
            }
            self.at += end.len();
        }
        let length = loop {
            let text = &self.buffer[self.start..];
            if let Some(length) = tag_length(text) {
                break length;
            }
            if text.len() > MOST_TAG_BYTES {
                return Err(self.fault(XmlFault::LongTag));
            }
            if !self.read_on()? {
                return Err(self.fault(XmlFault::CutShort));
            }
        };
        self.at = self.start + length;
        Ok(Some(tag(&self.buffer[self.start + 1..self.at - 1])))
    }

    /// Goes to the next occurrence of `text`; `false` if there is none.
    fn skip_until(&mut self, text: &[u8]) -> Result<bool, ThreeMfError> {
        loop {
            let rest = &self.buffer[self.at..];
            if let Some(found) = position(rest, text) {
                self.at += found;
                return Ok(true);
            }
            // The end of the buffer may be the beginning of it.
            self.at = self
                .at
                .max((self.buffer.len() + 1).saturating_sub(text.len()));
            self.start = self.at;
            if !self.read_on()? {
                return Ok(false);
            }
        }
    }

    /// Reads on, and drops what lies before the last tag. `false` at the end of the part.
    fn read_on(&mut self) -> Result<bool, ThreeMfError> {
        self.lines += line_ends(&self.buffer[..self.start]);
        self.buffer.drain(..self.start);
        self.at -= self.start;
        self.start = 0;
        let length = self.buffer.len();
        self.buffer.resize(length + CHUNK_BYTES.max(length), 0);
        let count = self.part.read(&mut self.buffer[length..]);
        self.buffer
            .truncate(length + count.as_ref().copied().unwrap_or(0));
        Ok(count? > 0)
    }
}

#[expect(
    clippy::naive_bytecount,
    reason = "the compiler makes vectors of it, and a crate would be one more"
)]
fn line_ends(text: &[u8]) -> u64 {
    text.iter().filter(|&&byte| byte == b'\n').count() as u64
}

fn position(text: &[u8], part: &[u8]) -> Option<usize> {
    let [first, ..] = part else { return Some(0) };
    let mut from = 0;
    loop {
        from += text[from..].iter().position(|byte| byte == first)?;
        if text[from..].starts_with(part) {
            return Some(from);
        }
        from += 1;
    }
}

/// The length of the tag that a text begins with. `>` may occur in the value of an attribute.
fn tag_length(text: &[u8]) -> Option<usize> {
    let mut quote = 0;
    for (place, &byte) in text.iter().enumerate() {
        match byte {
            b'>' if quote == 0 => return Some(place + 1),
            b'"' | b'\'' if quote == 0 => quote = byte,
            _ if byte == quote => quote = 0,
            _ => (),
        }
    }
    None
}

/// The tag between `<` and `>`.
fn tag(text: &[u8]) -> Tag<'_> {
    if let [b'/', name @ ..] = text {
        return Tag::End {
            name: name.trim_ascii_end(),
        };
    }
    let is_empty = text.ends_with(b"/");
    let text = &text[..text.len() - usize::from(is_empty)];
    let end = text.iter().position(u8::is_ascii_whitespace);
    let (name, rest) = text.split_at(end.unwrap_or(text.len()));
    Tag::Start {
        name,
        attributes: Attributes { rest },
        is_empty,
    }
}

/// The attributes of a tag: names, with prefixes, and values as they are in the file.
#[derive(Debug, Clone)]
pub struct Attributes<'b> {
    rest: &'b [u8],
}

impl<'b> Iterator for Attributes<'b> {
    type Item = Result<(&'b [u8], &'b [u8]), XmlFault>;

    fn next(&mut self) -> Option<Self::Item> {
        let rest = self.rest.trim_ascii_start();
        if rest.is_empty() {
            return None;
        }
        let found = split_attribute(rest);
        self.rest = found.map_or(&[], |(_, _, rest)| rest);
        Some(
            found
                .map(|(name, value, _)| (name, value))
                .ok_or(XmlFault::Attribute),
        )
    }
}

/// Splits `name = "value" rest`.
fn split_attribute(text: &[u8]) -> Option<(&[u8], &[u8], &[u8])> {
    let equals = text.iter().position(|&byte| byte == b'=')?;
    let (&quote, rest) = text[equals + 1..].trim_ascii_start().split_first()?;
    if !matches!(quote, b'"' | b'\'') {
        return None;
    }
    let end = rest.iter().position(|&byte| byte == quote)?;
    Some((
        text[..equals].trim_ascii_end(),
        &rest[..end],
        &rest[end + 1..],
    ))
}

/// A value with its references to characters replaced. Those that are unknown stay.
pub fn unescaped(value: &[u8]) -> Cow<'_, [u8]> {
    if !value.contains(&b'&') {
        return Cow::Borrowed(value);
    }
    let mut text = Vec::new();
    let mut rest = value;
    while let Some(start) = rest.iter().position(|&byte| byte == b'&') {
        text.extend(&rest[..start]);
        rest = &rest[start..];
        let end = rest.iter().take(12).position(|&byte| byte == b';');
        let character = end.and_then(|end| character(&rest[1..end]).zip(Some(end)));
        if let Some((character, end)) = character {
            text.extend(character.encode_utf8(&mut [0; 4]).as_bytes());
            rest = &rest[end + 1..];
        } else {
            text.push(b'&');
            rest = &rest[1..];
        }
    }
    text.extend(rest);
    Cow::Owned(text)
}

/// The character that a reference names.
fn character(name: &[u8]) -> Option<char> {
    Some(match name {
        b"amp" => '&',
        b"lt" => '<',
        b"gt" => '>',
        b"quot" => '"',
        b"apos" => '\'',
        [b'#', number @ ..] => {
            let (digits, radix) = match number {
                [b'x', digits @ ..] => (digits, 16),
                _ => (number, 10),
            };
            char::from_u32(u32::from_str_radix(str::from_utf8(digits).ok()?, radix).ok()?)?
        }
        _ => return None,
    })
}
