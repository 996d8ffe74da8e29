/** WebGPU adapters that the core may use. */

type Level = "core" | "compatibility";

/** `requestAdapter` with the feature level, which TypeScript's library lacks. */
type Request = (options?: GPURequestAdapterOptions & { featureLevel?: Level }) => Promise<GPUAdapter | null>;

/**
 * Falls back to an adapter of WebGPU's compatibility mode if no core adapter exists. The core's GPU library requests core adapters only; it
 * learns the actual limits from the device.
 */
export function acceptCompatible(gpu: { requestAdapter: Request }): void {
  const request: Request = gpu.requestAdapter.bind(gpu);
  gpu.requestAdapter = async (options) => (await request(options)) ?? request({ ...options, featureLevel: "compatibility" });
}
