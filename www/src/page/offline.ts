/** The page works offline once it was loaded: see service-worker.ts. The element in other pages has no part in that. */
export function workOffline(): void {
  if (!import.meta.env.PROD || !("serviceWorker" in navigator)) return;
  // Where the browser will have none, such as in a private window, the page works as well.
  navigator.serviceWorker.register(new URL("./service-worker.js", document.baseURI)).catch(() => undefined);
}
