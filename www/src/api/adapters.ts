/** Which WebGPU adapters the core is offered. */

type Level = "core" | "compatibility";

/** What TypeScript's library does not know of yet. */
type Request = (options?: GPURequestAdapterOptions & { featureLevel?: Level }) => Promise<GPUAdapter | null>;

/**
 * Offers adapters of WebGPU's compatibility mode where there is none that can do all of it. The core's GPU library asks for the
 * latter alone; what the core needs, it finds out from the device.
 */
export function acceptCompatible(gpu: { requestAdapter: Request }): void {
  const request: Request = gpu.requestAdapter.bind(gpu);
  gpu.requestAdapter = async (options) => (await request(options)) ?? request({ ...options, featureLevel: "compatibility" });
}
