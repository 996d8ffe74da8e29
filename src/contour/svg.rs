//! Contours as SVG: one file with a group for each layer.
//!
//! Groups and their heights are named as Slic3r names them, `<g id="layer0" slic3r:z="0.025">`, for the programs that read its files; z is
//! the height of the section. Each polygon is a path: its outer ring, then its holes. Coordinates are those of the model in millimetres,
//! with y upward, and the group turns y over for the screen.

use std::io::{self, Write};

use super::{Contours, Heading, shown};
use crate::xml::escaped;

/// Writes an SVG layer by layer.
#[derive(Debug)]
pub struct Svg<'a, W> {
    writer: W,
    heading: Heading<'a>,
    layer: usize,
}

impl<'a, W: Write> Svg<'a, W> {
    /// Writes what comes before the layers.
    ///
    /// # Errors
    /// Those of the writer.
    pub fn begin(mut writer: W, heading: Heading<'a>) -> io::Result<Self> {
        let (min, size) = (heading.bounds.min, heading.bounds.size());
        let [left, top] = [min.x, -heading.bounds.max.y].map(shown);
        write!(
            writer,
            "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n\
             <svg xmlns=\"http://www.w3.org/2000/svg\" xmlns:slic3r=\"http://slic3r.org/namespaces/slic3r\" \
             width=\"{x}mm\" height=\"{y}mm\" viewBox=\"{left} {top} {x} {y}\" fill-rule=\"evenodd\">\n\
             <title>{}</title>\n",
            escaped(heading.title),
            x = shown(size.x),
            y = shown(size.y),
        )?;
        Ok(Self {
            writer,
            heading,
            layer: 0,
        })
    }

    /// Writes the next layer.
    ///
    /// # Errors
    /// Those of the writer.
    pub fn write(&mut self, contours: &Contours) -> io::Result<()> {
        let Self {
            writer, heading, ..
        } = self;
        let heights = contours.heights;
        writeln!(
            writer,
            "<g id=\"layer{}\" slic3r:z=\"{}\" data-bottom-mm=\"{}\" data-top-mm=\"{}\" transform=\"scale(1,-1)\">",
            self.layer,
            shown(heights.section_mm),
            shown(heights.bottom_mm),
            shown(heights.top_mm)
        )?;
        for polygon in &contours.polygons {
            writer.write_all(b"<path d=\"")?;
            for (number, ring) in polygon.rings().enumerate() {
                writer.write_all(if number == 0 { b"M" } else { b" M" })?;
                for &[x, y] in &ring.points {
                    writer.write_all(b" ")?;
                    heading.lattice.write(writer, x)?;
                    writer.write_all(b",")?;
                    heading.lattice.write(writer, y)?;
                }
                writer.write_all(b" Z")?;
            }
            writer.write_all(b"\"/>\n")?;
        }
        self.layer += 1;
        writer.write_all(b"</g>\n")
    }

    /// Writes what comes after the layers, and returns the writer.
    ///
    /// # Errors
    /// Those of the writer.
    pub fn end(mut self) -> io::Result<W> {
        self.writer.write_all(b"</svg>\n")?;
        Ok(self.writer)
    }
}
