//! The namespaces of 3MF, and the prefixes that stand for them.

use super::XmlFault;
use super::xml::Attributes;

/// A namespace that the reader distinguishes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Namespace {
    /// The core specification.
    Core,
    /// Objects in parts of their own.
    Production,
    /// Encrypted parts.
    SecureContent,
    /// Extensions that add nothing to the facets, or whose elements are recognised where they occur.
    Known,
    /// Anything else.
    Other,
}

impl Namespace {
    /// Versions differ in their year and their host.
    fn of(uri: &[u8]) -> Self {
        // http://HOST/3dmanufacturing/NAME/YEAR/MONTH
        let mut steps = uri.split(|&byte| byte == b'/').skip(3);
        if steps.next() != Some(b"3dmanufacturing") {
            return Self::Other;
        }
        match steps.next().unwrap_or_default() {
            // The first drafts have no name before the year.
            b"core" | b"2013" => Self::Core,
            b"production" => Self::Production,
            b"securecontent" => Self::SecureContent,
            b"material" | b"slice" | b"beamlattice" | b"trianglesets" | b"displacement"
            | b"booleanoperations" | b"volumetric" | b"implicit" => Self::Known,
            _ => Self::Other,
        }
    }
}

/// The prefixes in use at some place of a part.
#[derive(Debug, Default)]
pub struct Namespaces {
    /// The depth of the element that declares it, the prefix, the namespace and its name.
    declared: Vec<(usize, Vec<u8>, Namespace, Vec<u8>)>,
}

impl Namespaces {
    /// Adds what an element at this depth declares.
    pub fn declare(&mut self, depth: usize, attributes: Attributes<'_>) -> Result<(), XmlFault> {
        for attribute in attributes {
            let (name, uri) = attribute?;
            let Some(rest) = name.strip_prefix(b"xmlns") else {
                continue;
            };
            let prefix = match rest {
                [] => rest,
                [b':', prefix @ ..] => prefix,
                _ => continue,
            };
            let entry = (depth, prefix.to_vec(), Namespace::of(uri), uri.to_vec());
            self.declared.push(entry);
        }
        Ok(())
    }

    /// Forgets what elements deeper than this declared.
    pub fn leave(&mut self, depth: usize) {
        while self.declared.last().is_some_and(|last| last.0 > depth) {
            self.declared.pop();
        }
    }

    /// The namespace of a prefix, and its name. Without any declaration, names without a prefix are core's.
    pub fn of(&self, prefix: &[u8]) -> (Namespace, &[u8]) {
        let mut declared = self.declared.iter().rev();
        match declared.find(|declared| declared.1 == prefix) {
            Some((_, _, namespace, uri)) => (*namespace, uri),
            None if prefix.is_empty() => (Namespace::Core, &[]),
            None => (Namespace::Other, &[]),
        }
    }

    /// The namespace of an element and its name in it.
    pub fn split<'n>(&self, name: &'n [u8]) -> (Namespace, &'n [u8]) {
        let (prefix, local) = split(name);
        (self.of(prefix).0, local)
    }
}

/// The prefix of a name, which may be empty, and the rest.
pub fn split(name: &[u8]) -> (&[u8], &[u8]) {
    match name.iter().position(|&byte| byte == b':') {
        Some(colon) => (&name[..colon], &name[colon + 1..]),
        None => (&[], name),
    }
}
