//! Contours in the Common Layer Interface (CLI), version 2.0, as text.
//!
//! The file states the top of each layer, and its thickness follows from the layer below; an empty layer at the plate
//! gives the first one its own. Rings are closed by repeating their first point. Direction 1 is an outer ring,
//! counter-clockwise; 0 is a hole, clockwise.

use std::io::{self, Write};

use super::{Contours, Heading, shown};

/// Writes a CLI file layer by layer.
#[derive(Debug)]
pub struct Cli<'a, W> {
    writer: W,
    heading: Heading<'a>,
}

impl<'a, W: Write> Cli<'a, W> {
    /// Writes what comes before the layers: the header, and the layer at the plate.
    ///
    /// # Errors
    /// Those of the writer.
    pub fn begin(mut writer: W, heading: Heading<'a>) -> io::Result<Self> {
        let (min, max) = (heading.bounds.min, heading.bounds.max);
        let numbers =
            [min.x, min.y, min.z, max.x, max.y, max.z].map(|number| shown(number).to_string());
        // Every command ends at white space, and a label at a comma: these are replaced in names.
        let is_plain = |character: char| !character.is_control() && !"$/,".contains(character);
        let label = heading
            .title
            .chars()
            .map(|character| if is_plain(character) { character } else { '_' });
        write!(
            writer,
            "$$HEADERSTART\n$$ASCII\n$$UNITS/1\n$$VERSION/200\n$$LABEL/1,{}\n$$DIMENSION/{}\n$$LAYERS/{}\n$$HEADEREND\n\
             $$GEOMETRYSTART\n$$LAYER/0\n",
            label.collect::<String>(),
            numbers.join(","),
            heading.layers + 1,
        )?;
        Ok(Self { writer, heading })
    }

    /// Writes the next layer.
    ///
    /// # Errors
    /// Those of the writer.
    pub fn write(&mut self, contours: &Contours) -> io::Result<()> {
        let Self { writer, heading } = self;
        writeln!(writer, "$$LAYER/{}", shown(contours.heights.top_mm))?;
        for polygon in &contours.polygons {
            for (number, ring) in polygon.rings().enumerate() {
                let direction = i32::from(number == 0);
                write!(writer, "$$POLYLINE/1,{direction},{}", ring.points.len() + 1)?;
                for &[x, y] in ring.points.iter().chain(ring.points.first()) {
                    writer.write_all(b",")?;
                    heading.lattice.write(writer, x)?;
                    writer.write_all(b",")?;
                    heading.lattice.write(writer, y)?;
                }
                writer.write_all(b"\n")?;
            }
        }
        Ok(())
    }

    /// Writes what comes after the layers, and returns the writer.
    ///
    /// # Errors
    /// Those of the writer.
    pub fn end(mut self) -> io::Result<W> {
        self.writer.write_all(b"$$GEOMETRYEND\n")?;
        Ok(self.writer)
    }
}
