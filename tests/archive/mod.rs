//! Print files, read back with independent libraries.

mod convert;
mod convert_values;
mod formats;
mod png_zip;
mod read_back;
mod runs;

use std::io::{Cursor, Read};

type Zip = zip::ZipArchive<Cursor<Vec<u8>>>;

fn file(zip: &mut Zip, name: &str) -> Vec<u8> {
    let mut bytes = Vec::new();
    zip.by_name(name)
        .unwrap_or_else(|_| panic!("{name}"))
        .read_to_end(&mut bytes)
        .unwrap();
    bytes
}

fn text(zip: &mut Zip, name: &str) -> String {
    String::from_utf8(file(zip, name)).unwrap()
}
