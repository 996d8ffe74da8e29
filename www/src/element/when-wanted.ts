/** Detects that an element is about to be used: a page with the element further down need not fetch the slicer for every visitor. */

/** Calls back once, when the element comes into view or files are dragged over its page. Ends with the signal. */
export function whenWanted(element: Element, wanted: () => void, signal: AbortSignal): void {
  const over = new AbortController();
  const once = (): void => {
    over.abort();
    wanted();
  };
  if (globalThis.IntersectionObserver === undefined) return once();
  const observer = new IntersectionObserver((entries) => {
    if (entries.some(({ isIntersecting }) => isIntersecting)) once();
  });
  observer.observe(element);
  const either = AbortSignal.any([signal, over.signal]);
  either.addEventListener("abort", () => observer.disconnect());
  window.addEventListener(
    "dragenter",
    ({ dataTransfer }) => {
      if (dataTransfer?.types.includes("Files") === true) once();
    },
    { capture: true, signal: either },
  );
}
