/** Makes the page work offline once loaded: see service-worker.ts. Does not apply to the element in other pages. */
export function workOffline(): void {
  if (!import.meta.env.PROD || !("serviceWorker" in navigator)) return;
  // If the browser refuses, as in a private window, the page still works online.
  navigator.serviceWorker.register(new URL("./service-worker.js", document.baseURI)).catch(() => undefined);
}
