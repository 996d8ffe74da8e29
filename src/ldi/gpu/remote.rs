//! The GPU from the slicer's module in the browser. The module that drives it (gpu/) is fetched when a plan wants a GPU, and
//! returns the facets that rays meet; all else stays here.

use std::cell::RefCell;
use std::ops::ControlFlow;

use js_sys::{Array, Float32Array, Function, Reflect, Uint32Array};
use wasm_bindgen::closure::ScopedClosure;
use wasm_bindgen::prelude::{JsCast, JsValue, wasm_bindgen};

use super::tiles::{Meetings, Region};
use super::{Adapters, Method, Tiling, failed};
use crate::grid::Grid;
use crate::ldi::projection::Projection;
use crate::ldi::{GpuFault, LdiError};
use crate::progress::{Cancelled, Progress};

#[wasm_bindgen]
extern "C" {
    /// A GPU that the other module has opened.
    #[derive(Debug)]
    #[wasm_bindgen(typescript_type = "OpenGpu")]
    type Opened;

    #[wasm_bindgen(method)]
    fn name(this: &Opened) -> String;

    #[wasm_bindgen(method)]
    fn peels(this: &Opened) -> bool;

    #[wasm_bindgen(method)]
    fn is_emulated(this: &Opened) -> bool;

    #[wasm_bindgen(method, catch)]
    async fn find(
        this: &Opened,
        vertices: Float32Array,
        vertices_of: Uint32Array,
        grid: &[f64],
        side: u32,
        peels: bool,
        progress: &JsValue,
    ) -> Result<Array, JsValue>;
}

thread_local! {
    static OPEN: RefCell<Option<Function>> = const { RefCell::new(None) };
}

/// Opens GPUs by this function from now on. It is told whether it must be hardware, and returns a promise of the other module's
/// `OpenGpu`.
pub fn open_by(open: Function) {
    OPEN.set(Some(open));
}

/// An open GPU. Any number of meshes may be sampled on it.
#[derive(Debug)]
pub struct Gpu {
    opened: Opened,
    name: String,
}

impl Gpu {
    /// Opens the system's high-performance adapter.
    ///
    /// # Errors
    /// [`LdiError::NoGpu`] if there is no such adapter or the module cannot be fetched, [`LdiError::GpuEmulated`].
    pub async fn open(adapters: Adapters) -> Result<Self, LdiError> {
        let Some(open) = OPEN.with_borrow(Clone::clone) else {
            let system = "there is no module for it".to_owned();
            return Err(LdiError::NoGpu { system });
        };
        let hardware = (adapters == Adapters::Hardware).into();
        let promise = open
            .call1(&JsValue::NULL, &hardware)
            .map_err(|thrown| error_of(&thrown))?;
        let opened = js_sys::futures::JsFuture::from(js_sys::Promise::resolve(&promise)).await;
        let opened: Opened = opened.map_err(|thrown| error_of(&thrown))?.unchecked_into();
        let name = opened.name();
        Ok(Self { opened, name })
    }

    /// The faster method of those that the device can do.
    pub fn method(&self) -> Method {
        if self.opened.peels() {
            Method::Peel
        } else {
            Method::Fill
        }
    }

    /// Whether it is known to be emulated in software.
    pub fn is_emulated(&self) -> bool {
        self.opened.is_emulated()
    }

    /// The name of the adapter, as in reports.
    pub fn name(&self) -> &str {
        &self.name
    }
}

/// Finds the facets that rays meet, tile by tile.
///
/// # Errors
/// [`LdiError::GpuTooSmall`], [`LdiError::GpuFailed`].
pub async fn find(
    projection: &Projection<'_>,
    grid: &Grid,
    gpu: &Gpu,
    tiling: Tiling,
    method: Method,
    progress: &mut Progress<'_>,
) -> Result<Vec<(Region, Meetings)>, LdiError> {
    let mut cancelled = None;
    let found = {
        let mut report = |fraction: f64| {
            if let ControlFlow::Break(()) = progress(fraction) {
                cancelled = Some(Cancelled);
            }
            cancelled.is_none()
        };
        let report = ScopedClosure::<dyn FnMut(f64) -> bool>::borrow_mut(&mut report);
        let vertices = Float32Array::from(bytemuck::cast_slice::<_, f32>(projection.vertices));
        let vertices_of = Uint32Array::from(projection.vertices_of.as_flattened());
        let peels = method == Method::Peel;
        let numbers = [
            f64::from(grid.width),
            f64::from(grid.height),
            grid.pitch_mm,
            grid.pitch_y_mm,
            grid.corner_mm.x,
            grid.corner_mm.y,
        ];
        let found = gpu.opened.find(
            vertices,
            vertices_of,
            &numbers,
            tiling.side,
            peels,
            report.as_js_value(),
        );
        found.await
    };
    if let Some(cancelled) = cancelled {
        return Err(cancelled.into());
    }
    let tiles = found.map_err(|thrown| error_of(&thrown))?.to_vec();
    let (tiles, _) = tiles.as_chunks::<3>();
    tiles.iter().map(tile_of).collect()
}

/// A tile of the other module.
fn tile_of(tile: &[JsValue; 3]) -> Result<(Region, Meetings), LdiError> {
    let [region, offsets, facets] = tile
        .each_ref()
        .map(|words| words.unchecked_ref::<Uint32Array>().to_vec());
    let [column, row, width, height] = region[..] else {
        return Err(failed(GpuFault::BadOffsets));
    };
    let region = Region {
        column,
        row,
        width,
        height,
    };
    Ok((region, Meetings { offsets, facets }))
}

/// The error that the other module threw, or the failure to fetch it.
fn error_of(thrown: &JsValue) -> LdiError {
    let get = |of: &JsValue, name: &str| Reflect::get(of, &name.into()).unwrap_or_default();
    let detail = get(thrown, "detail");
    let text = |name| get(&detail, name).as_string();
    let number = |name| get(&detail, name).as_f64().unwrap_or_default() as u64;
    match get(thrown, "code").as_string().as_deref() {
        Some("gpu-emulated") => LdiError::GpuEmulated {
            adapter: text("adapter").unwrap_or_default(),
        },
        Some("gpu-too-small") => LdiError::GpuTooSmall {
            facets: number("facets"),
            needed_bytes: number("needed_bytes"),
            limit_bytes: number("limit_bytes"),
        },
        Some("gpu-failed") => LdiError::GpuFailed {
            fault: match text("fault").as_deref() {
                Some("device-lost") => GpuFault::DeviceLost,
                Some("too-many-hits") => GpuFault::TooManyHits,
                Some("bad-offsets") => GpuFault::BadOffsets,
                Some("out-of-memory") => GpuFault::OutOfMemory,
                _ => GpuFault::Error,
            },
            system: text("system"),
        },
        Some("no-gpu") => LdiError::NoGpu {
            system: text("system").unwrap_or_default(),
        },
        _ => LdiError::NoGpu {
            system: get(thrown, "message").as_string().unwrap_or_default(),
        },
    }
}
