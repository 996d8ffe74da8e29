//! Classes of facets, and how they decide which points are printed.

/// The class of a facet. A mesh stores its facets in this order.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum FacetClass {
    /// The surface of the model. Profiles measure these facets alone.
    Surface,
    /// A cap that closes a hole of the surface.
    Cap,
    /// The wall of a void in the model: the surface of a body that is not printed.
    Void,
    /// The surface of a support.
    Support,
}

/// The facets of a mesh by class.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct FacetClasses {
    /// Index of the first cap, void and support facet. If a class is empty, it is the end of the class before.
    starts: [u32; 3],
    /// Number of facets.
    count: u32,
}

impl FacetClasses {
    /// The classes of a model without voids and supports: the facets before `caps_from` are surface, the others, up to
    /// `count`, are caps.
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

    /// The first facet after those of the surface, slivers without area included.
    pub fn surface_end(self) -> usize {
        self.starts[0] as usize
    }

    /// The first facet after those of the model itself, which are surface or caps.
    pub fn model_end(self) -> u32 {
        self.starts[1]
    }

    /// Returns true if any facet is a cap.
    pub fn has_caps(self) -> bool {
        self.starts[0] < self.starts[1]
    }

    /// Returns true if there are neither voids nor supports.
    pub fn is_model_alone(self) -> bool {
        self.starts[1] == self.count
    }

    /// The first facet after those of a class.
    pub(super) fn end(self, class: FacetClass) -> usize {
        *self.starts.get(class as usize).unwrap_or(&self.count) as usize
    }

    /// The classes after the facets of later classes are removed.
    pub(super) fn up_to(mut self, class: FacetClass) -> Self {
        self.count = self.end(class) as u32;
        self.starts = self.starts.map(|start| start.min(self.count));
        self
    }

    /// The classes after `count` facets are inserted at the end of `class`.
    pub(super) fn grown(mut self, class: FacetClass, count: usize) -> Self {
        for start in &mut self.starts[class as usize..] {
            *start += count as u32;
        }
        self.count += count as u32;
        self
    }
}

/// The winding numbers of a point on a ray, one for each kind of body: model, void and support.
#[derive(Debug, Clone, Copy, Default)]
pub struct Winding {
    model: i32,
    void: i32,
    support: i32,
}

impl Winding {
    /// From the winding numbers of model, void and support.
    pub fn of([model, void, support]: [i32; 3]) -> Self {
        Self {
            model,
            void,
            support,
        }
    }

    /// The winding numbers of model, void and support.
    pub fn numbers(self) -> [i32; 3] {
        [self.model, self.void, self.support]
    }

    /// Moves the point past a facet that changes its winding number by `by`.
    pub fn pass(&mut self, class: FacetClass, by: i32) {
        match class {
            FacetClass::Surface | FacetClass::Cap => self.model += by,
            FacetClass::Void => self.void += by,
            FacetClass::Support => self.support += by,
        }
    }

    /// Returns true if the point is in a support alone.
    pub fn is_support_alone(self) -> bool {
        self.support != 0 && (self.model == 0 || self.void != 0)
    }

    /// Returns true if the point is printed: inside the model and not inside a void, or inside a support.
    pub fn is_inside(self) -> bool {
        (self.model != 0 && self.void == 0) || self.support != 0
    }
}
