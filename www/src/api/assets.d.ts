/** What Vite makes of an import with `?url`, for the worker, which has none of Vite's own declarations: they want a DOM. */
declare module "*?url" {
  const address: string;
  export default address;
}
