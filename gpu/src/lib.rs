//! The GPU in the browser: a module of its own, which the slicer fetches when a plan wants a GPU. It finds the facets that rays
//! meet; the slicer's module computes heights and all else.
//!
//! Errors are thrown as `{ code, message, detail }`.

#![cfg(target_arch = "wasm32")]

use std::ops::ControlFlow;

use cusp_slicer::grid::Grid;
use cusp_slicer::js::thrown;
use cusp_slicer::ldi::LdiError;
use cusp_slicer::ldi::gpu::{self, Adapters, Gpu, Method, Tiling};
use cusp_slicer::ldi::projection::Projection;
use glam::DVec2;
use js_sys::{Array, Function, Uint32Array};
use wasm_bindgen::prelude::{JsValue, wasm_bindgen};

/// An open GPU. Any number of meshes may be sampled on it.
#[wasm_bindgen]
pub struct OpenGpu {
    gpu: Gpu,
}

#[wasm_bindgen]
impl OpenGpu {
    /// Opens the browser's high-performance adapter, or only one that is no emulation.
    ///
    /// # Errors
    /// Throws an error of the slicer: `no-gpu`, `gpu-emulated`.
    pub async fn open(hardware: bool) -> Result<OpenGpu, JsValue> {
        let adapters = if hardware {
            Adapters::Hardware
        } else {
            Adapters::Any
        };
        let gpu = Gpu::open(adapters).await.map_err(throw)?;
        Ok(Self { gpu })
    }

    /// The name of the adapter, as in reports.
    pub fn name(&self) -> String {
        self.gpu.name().to_owned()
    }

    /// Whether depth peeling is the faster method of those that the device can do, or filling.
    pub fn peels(&self) -> bool {
        self.gpu.method() == Method::Peel
    }

    /// Whether it is known to be emulated in software.
    pub fn is_emulated(&self) -> bool {
        self.gpu.is_emulated()
    }

    /// Finds the facets that rays meet, by peeling or by filling, in tiles of `side` pixels at most: the place of each tile,
    /// where the rays in it begin, and their facets. `grid` is columns, rows, the sides of a pixel and its corner, as in the
    /// slicer's grid. `progress` is told the fraction that is done, and returns whether to go on.
    ///
    /// # Errors
    /// Throws an error of the slicer: `gpu-too-small`, `gpu-failed`, `cancelled`.
    #[wasm_bindgen(unchecked_return_type = "Uint32Array[]")]
    pub async fn find(
        &self,
        vertices: Vec<f32>,
        vertices_of: Vec<u32>,
        grid: &[f64],
        side: u32,
        peels: bool,
        #[wasm_bindgen(unchecked_param_type = "(fraction: number) => boolean")] progress: Function,
    ) -> Result<Array, JsValue> {
        let &[width, height, pitch_mm, pitch_y_mm, x, y] = grid else {
            return Err(JsValue::NULL);
        };
        let grid = Grid {
            width: width as u32,
            height: height as u32,
            pitch_mm,
            pitch_y_mm,
            corner_mm: DVec2::new(x, y),
        };
        let vertices = bytemuck::cast_slice(&vertices);
        let (vertices_of, _) = vertices_of.as_chunks();
        let projection = Projection::of(vertices, vertices_of, &grid);
        let method = if peels { Method::Peel } else { Method::Fill };
        let mut report = |fraction: f64| {
            let goes_on = progress.call1(&JsValue::NULL, &fraction.into());
            match goes_on {
                Ok(goes_on) if goes_on.is_falsy() => ControlFlow::Break(()),
                _ => ControlFlow::Continue(()),
            }
        };
        let tiling = Tiling { side };
        let found = gpu::find(&projection, &grid, &self.gpu, tiling, method, &mut report).await;
        let tiles = Array::new();
        for (region, meetings) in found.map_err(throw)? {
            let place = [region.column, region.row, region.width, region.height];
            for words in [&place[..], &meetings.offsets, &meetings.facets] {
                tiles.push(&Uint32Array::from(words));
            }
        }
        Ok(tiles)
    }
}

#[expect(clippy::needless_pass_by_value, reason = "errors are mapped by value")]
fn throw(error: LdiError) -> JsValue {
    thrown(&error)
}
