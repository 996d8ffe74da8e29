//! Placement of copies on plates: the fewest plates, then the lowest.
//!
//! A plate is divided into cells of whole pixels. A model covers the cells of its shadow, and keeps a distance around it free.
//! Copies are placed one after the other, each at the first place that is free: far back and to the left. Places are whole cells
//! apart, so copies share rays.

mod arranging;
mod check;
mod error;
mod outline;
mod shadow;
mod sheet;

use std::sync::Arc;

use glam::DVec2;

use crate::argsort::sort_by_number;
use crate::parallel;
pub use arranging::{Arranging, TURN_DEG};
pub use check::{PlacedOutline, problems};
pub use error::ArrangeError;
pub use outline::Outline;
pub use shadow::shadow_mm2;
use sheet::Sheet;

/// Beyond any plate, in pixels.
const MAX_OFFSET: f64 = (1 << 24) as f64;
/// The aim for the side of a cell, in millimetres.
const CELL_MM: f64 = 0.2;

/// The plate as its screen divides it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Screen {
    pixels: [u32; 2],
    pitch_mm: [f64; 2],
    /// Columns and rows of pixels in a cell.
    cell: [u32; 2],
}

impl Screen {
    /// The screen with these numbers of columns and rows, and pixels of these sides in x and y.
    pub fn new(pixels: [u32; 2], pitch_mm: [f64; 2]) -> Self {
        let cell = pitch_mm.map(|pitch_mm| (CELL_MM / pitch_mm + 0.5).max(1.0) as u32);
        Self {
            pixels,
            pitch_mm,
            cell,
        }
    }

    /// The same screen with cells of one pixel.
    #[must_use]
    pub fn by_pixels(&self) -> Self {
        Self {
            cell: [1, 1],
            ..*self
        }
    }

    /// The pixels from the middle of the plate to a point, columns to the right and rows downward.
    pub fn offset(&self, x_mm: f64, y_mm: f64) -> [i32; 2] {
        let nearest = |pixels: f64| (pixels + 0.5).floor().clamp(-MAX_OFFSET, MAX_OFFSET) as i32;
        [
            nearest(x_mm / self.pitch_mm[0]),
            nearest(-y_mm / self.pitch_mm[1]),
        ]
    }

    /// The same in millimetres, x to the right and y to the back.
    pub fn offset_mm(&self, [columns, rows]: [i32; 2]) -> [f64; 2] {
        [
            f64::from(columns) * self.pitch_mm[0],
            -f64::from(rows) * self.pitch_mm[1],
        ]
    }

    /// A point in pixels from the corner with the least x and the greatest y; 0, 0 is the middle of the plate.
    fn pixels_to(&self, point_mm: DVec2) -> DVec2 {
        let [columns, rows] = self.pixels.map(f64::from);
        DVec2::new(
            point_mm.x / self.pitch_mm[0] + columns * 0.5,
            rows * 0.5 - point_mm.y / self.pitch_mm[1],
        )
    }

    /// Sides of a cell in millimetres.
    fn cell_mm(&self) -> [f64; 2] {
        [0, 1].map(|axis| f64::from(self.cell[axis]) * self.pitch_mm[axis])
    }

    fn cell_mm2(&self) -> f64 {
        let [x_mm, y_mm] = self.cell_mm();
        x_mm * y_mm
    }

    /// Columns and rows of cells; the last ones may extend beyond the screen.
    fn cells(&self) -> [usize; 2] {
        [0, 1].map(|axis| self.pixels[axis].div_ceil(self.cell[axis]) as usize)
    }

    /// Sides in millimetres.
    pub fn size_mm(&self) -> [f64; 2] {
        [0, 1].map(|axis| f64::from(self.pixels[axis]) * self.pitch_mm[axis])
    }

    /// For each number of rows away, the columns to either side in which a cell may be nearer than `spacing_mm`.
    fn reach(&self, spacing_mm: f64) -> Vec<usize> {
        let [x_mm, y_mm] = self.cell_mm();
        let mut reach = Vec::new();
        for rows in 0.. {
            // Cells that touch are no distance apart.
            let away_mm = if rows == 0 {
                0.0
            } else {
                f64::from(rows - 1) * y_mm
            };
            if rows > 0 && away_mm >= spacing_mm {
                break;
            }
            let free_mm = (spacing_mm * spacing_mm - away_mm * away_mm)
                .max(0.0)
                .sqrt();
            reach.push((free_mm / x_mm).ceil() as usize);
        }
        reach
    }
}

/// A model to be arranged.
pub struct Item<'a, E> {
    /// Number of copies.
    pub copies: usize,
    /// Height of the model in millimetres.
    pub height_mm: f64,
    /// Its shadow after a number of turns of 15°.
    pub outline: &'a (dyn Fn(u32) -> Result<Arc<Outline>, E> + Sync),
}

/// Place of a copy.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Place {
    /// The model, by its index.
    pub item: usize,
    /// The copy of that model, by its index.
    pub copy: usize,
    /// Turns of 15° about z, counter-clockwise as seen from above.
    pub turns: u32,
    /// Columns to the right and rows downward from the middle of the plate.
    pub offset: [i32; 2],
    /// The plate, from 0.
    pub plate: usize,
}

/// Arranges all copies of all models. Places are listed by plate, then by model.
///
/// # Errors
/// [`ArrangeError`], and what outlines return.
pub fn arrange<E: From<ArrangeError> + Send>(
    screen: &Screen,
    arranging: &Arranging,
    items: &[Item<'_, E>],
) -> Result<Vec<Place>, E> {
    arranging.check()?;
    let reach = screen.reach(arranging.spacing_mm);
    let mut best: Option<Arrangement> = None;
    let mut shapes: Vec<Vec<Shape>> = items.iter().map(|_| Vec::new()).collect();
    for turns in arranging.turns() {
        let missing = (0..items.len()).flat_map(|item| {
            let known = &shapes[item];
            let is_missing = |turn: &u32| !known.iter().any(|shape| shape.turns == *turn);
            let turns = turns.iter().copied().filter(is_missing);
            turns.map(move |turn| (item, turn))
        });
        let turned = parallel::map(missing.collect(), |(item, turn): (usize, u32)| {
            let outline = (items[item].outline)(turn)?;
            Ok::<_, E>((item, Shape::new(turn, outline, &reach)))
        });
        for turned in turned {
            let (item, shape) = turned?;
            shapes[item].push(shape);
        }
        let orders = vec![Order::Height, Order::Area];
        let found = parallel::map(orders, |order| {
            Arrangement::of(screen, items, &shapes, order)
        });
        for found in found.into_iter().flatten() {
            if best.as_ref().is_none_or(|best| found.cost() < best.cost()) {
                best = Some(found);
            }
        }
        if best.as_ref().is_some_and(|best| best.sheets.len() <= 1) {
            break;
        }
    }
    let Some(best) = best else {
        let fits = |shape: &Shape| shape.places(screen).is_some();
        let is_too_large =
            |item: &usize| items[*item].copies > 0 && !shapes[*item].iter().any(fits);
        let item = (0..items.len()).find(is_too_large).unwrap_or_default();
        let [first, last] = shapes[item][0].outline.pixels;
        let size_mm = [0, 1].map(|axis| (last[axis] - first[axis]) as f64 * screen.pitch_mm[axis]);
        return Err(E::from(ArrangeError::TooLarge {
            model_number: item + 1,
            size_mm,
            plate_mm: screen.size_mm(),
        }));
    };
    Ok(best.places(screen, &shapes))
}

/// A model after some turns.
struct Shape {
    turns: u32,
    outline: Arc<Outline>,
    /// The cells that no other copy may cover.
    kept_free: outline::Cells,
    /// Cells by which `kept_free` begins before the outline.
    margin: [usize; 2],
}

impl Shape {
    fn new(turns: u32, outline: Arc<Outline>, reach: &[usize]) -> Self {
        Self {
            turns,
            kept_free: outline.cells.grown(reach),
            margin: [reach[0], reach.len() - 1],
            outline,
        }
    }

    /// The places, in cells to the right and downward from the middle of the plate, at which all pixels are on the screen:
    /// the first and the last in each direction. `None` if there are none.
    fn places(&self, screen: &Screen) -> Option<[[i64; 2]; 2]> {
        let [mut lowest, mut highest] = [[0; 2]; 2];
        for axis in [0, 1] {
            let [first, last] = [0, 1].map(|end| self.outline.pixels[end][axis]);
            let cell = i64::from(screen.cell[axis]);
            // Beyond the rounding that models as large as the plate need.
            let (side, slack) = (i64::from(screen.pixels[axis]), 1);
            if first >= -slack && last <= side + slack && last - first >= side - 2 * slack {
                continue;
            }
            lowest[axis] = -first.div_euclid(cell);
            highest[axis] = (side - last).div_euclid(cell);
            if lowest[axis] > highest[axis] {
                return None;
            }
        }
        Some([lowest, highest])
    }
}

/// In which order copies are placed.
#[derive(Clone, Copy)]
enum Order {
    /// The highest first, so that high models share plates.
    Height,
    /// The largest first.
    Area,
}

/// Copies on plates.
struct Arrangement {
    sheets: Vec<Sheet>,
    /// The sum of the heights of all plates.
    height_mm: f64,
}

impl Arrangement {
    /// Places all copies, or fails if one is too large for the plate.
    fn of<E>(
        screen: &Screen,
        items: &[Item<'_, E>],
        shapes: &[Vec<Shape>],
        order: Order,
    ) -> Option<Self> {
        let key = |item: usize| {
            let (height, area) = (items[item].height_mm, shapes[item][0].outline.area_mm2);
            match order {
                Order::Height => [height, area],
                Order::Area => [area, height],
            }
        };
        let mut queue: Vec<usize> = (0..items.len()).collect();
        for number in [1, 0] {
            sort_by_number(&mut queue, |&item| -key(item)[number]);
        }
        let mut sheets: Vec<Sheet> = Vec::new();
        for item in queue {
            let ranges: Vec<_> = shapes[item]
                .iter()
                .map(|shape| shape.places(screen))
                .collect();
            let mut first_open = 0;
            for _ in 0..items[item].copies {
                loop {
                    if first_open == sheets.len() {
                        sheets.push(Sheet::new(screen.cells()));
                    }
                    let is_empty = sheets[first_open].copies.is_empty();
                    if sheets[first_open].place(item, &shapes[item], &ranges) {
                        break;
                    }
                    if is_empty {
                        return None;
                    }
                    first_open += 1;
                }
            }
        }
        let height = |sheet: &Sheet| {
            let heights = sheet.copies.iter().map(|copy| items[copy.item].height_mm);
            heights.fold(0.0, f64::max)
        };
        Some(Self {
            height_mm: sheets.iter().map(height).sum(),
            sheets,
        })
    }

    /// Fewer plates are better, then lower ones.
    fn cost(&self) -> (usize, f64) {
        (self.sheets.len(), self.height_mm)
    }

    /// The places of all copies, those of each plate centred on it.
    fn places(&self, screen: &Screen, shapes: &[Vec<Shape>]) -> Vec<Place> {
        let mut places = Vec::new();
        let mut placed = vec![0; shapes.len()];
        for (plate, sheet) in self.sheets.iter().enumerate() {
            let to_middle = sheet.to_middle(screen, shapes);
            let mut on_plate: Vec<Place> = sheet
                .copies
                .iter()
                .map(|copy| Place {
                    item: copy.item,
                    copy: 0,
                    turns: shapes[copy.item][copy.shape].turns,
                    offset: [0, 1].map(|axis| {
                        let cells = copy.cells[axis] * i64::from(screen.cell[axis]);
                        (cells + to_middle[axis]) as i32
                    }),
                    plate,
                })
                .collect();
            sort_by_number(&mut on_plate, |place| place.item as f64);
            for place in &mut on_plate {
                place.copy = placed[place.item];
                placed[place.item] += 1;
            }
            places.extend(on_plate);
        }
        places
    }
}
