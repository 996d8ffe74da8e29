/** Lets the page work offline once it has been loaded: see service-worker.ts. The element in other pages does not. */
export function workOffline(): void {
  if (!import.meta.env.PROD || !("serviceWorker" in navigator)) return;
  // If the browser refuses one, as in a private window, the page still works online.
  navigator.serviceWorker.register(new URL("./service-worker.js", document.baseURI)).catch(() => undefined);
}
