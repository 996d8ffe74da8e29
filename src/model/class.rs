//! What facets belong to, and how that decides where the printed solid is.

/// What a facet belongs to. A mesh holds its facets in this order.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum FacetClass {
    /// The surface of the model. Profiles measure these facets alone.
    Surface,
    /// A flat cap that closes a hole of the surface.
    Cap,
    /// The wall of a void inside the model: the surface of the body that is left out.
    Void,
    /// A support.
    Support,
}

/// The facets of a mesh by class.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct FacetClasses {
    /// The first cap, void wall and support, or the end of the class before where there is none.
    starts: [u32; 3],
    /// Number of facets.
    count: u32,
}

impl FacetClasses {
    /// Facets of a model: the first `caps_from` are of the surface, the others, up to `count`, are caps.
    pub fn of_model(caps_from: usize, count: usize) -> Self {
        Self {
            starts: [caps_from as u32, count as u32, count as u32],
            count: count as u32,
        }
    }

    /// The class of a facet.
    pub fn of(self, facet: u32) -> FacetClass {
        let [cap, void, support] = self.starts;
        match facet {
            facet if facet < cap => FacetClass::Surface,
            facet if facet < void => FacetClass::Cap,
            facet if facet < support => FacetClass::Void,
            _ => FacetClass::Support,
        }
    }

    /// The first facet that is no part of the model itself: neither surface nor cap.
    pub fn model_end(self) -> u32 {
        self.starts[1]
    }

    /// Whether any facet is a cap.
    pub fn has_caps(self) -> bool {
        self.starts[0] < self.starts[1]
    }

    /// Whether there are neither voids nor supports.
    pub fn is_model_alone(self) -> bool {
        self.starts[1] == self.count
    }

    /// The first facet after those of a class.
    pub(super) fn end(self, class: FacetClass) -> usize {
        *self.starts.get(class as usize).unwrap_or(&self.count) as usize
    }

    /// The classes after `count` facets were inserted at the end of one.
    pub(super) fn grown(mut self, class: FacetClass, count: usize) -> Self {
        for start in &mut self.starts[class as usize..] {
            *start += count as u32;
        }
        self.count += count as u32;
        self
    }
}

/// The winding numbers of a point on a ray, by what the facets below it belong to.
#[derive(Debug, Clone, Copy, Default)]
pub struct Winding {
    model: i32,
    void: i32,
    support: i32,
}

impl Winding {
    /// Moves the point past a facet that changes its winding number by `by`.
    pub fn pass(&mut self, class: FacetClass, by: i32) {
        match class {
            FacetClass::Surface | FacetClass::Cap => self.model += by,
            FacetClass::Void => self.void += by,
            FacetClass::Support => self.support += by,
        }
    }

    /// Whether the point is printed: inside the model and in no void, or inside a support.
    pub fn is_inside(self) -> bool {
        (self.model != 0 && self.void == 0) || self.support != 0
    }
}
