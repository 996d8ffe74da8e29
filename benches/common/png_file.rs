//! Pictures as PNG files, small enough for the documents.

/// A PNG of pixels in rows of `width`.
pub fn encoded(width: usize, pixels: &[[u8; 3]]) -> Vec<u8> {
    let mut bytes = Vec::new();
    let height = pixels.len() / width;
    let mut encoder = png::Encoder::new(&mut bytes, width as u32, height as u32);
    encoder.set_color(png::ColorType::Rgb);
    encoder.set_compression(png::Compression::High);
    let mut writer = encoder.write_header().expect("a header");
    writer
        .write_image_data(pixels.as_flattened())
        .expect("the pixels");
    writer.finish().expect("the end");
    bytes
}
