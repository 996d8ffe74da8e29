/** Styles of the view around its canvas. Uses the page's custom properties where they are set. */
import { css } from "lit";
import { visuallyHidden } from "./visually-hidden.js";

export const viewStyles = css`
  :host {
    position: relative;
    display: block;
    min-width: 0;
    min-height: 10rem;
    overflow: hidden;
    border-radius: 8px;
    color: var(--cusp-text, CanvasText);
    background: var(
      --cusp-view-background,
      radial-gradient(
        120% 90% at 50% 30%,
        color-mix(in srgb, var(--cusp-card, Canvas) 97%, currentColor),
        color-mix(in srgb, var(--cusp-card, Canvas) 90%, currentColor)
      )
    );
  }
  :host([hidden]) {
    display: none;
  }
  *,
  *::before,
  *::after {
    box-sizing: border-box;
  }
  .scene {
    position: absolute;
    inset: 0;
    /* What a layout puts over the view's edge; the model stands in the middle of the rest. */
    padding-inline-end: var(--cusp-view-aside, 0px);
    cursor: grab;
    user-select: none;
    -webkit-user-select: none;
    /* One finger that moves up or down scrolls the page, unless its host says that the page does not scroll. */
    touch-action: var(--cusp-view-touch, pan-y);
  }
  /* The finger turns or paints the model, or moves its points. */
  .scene[data-tool="rotate"],
  .scene[data-tool="paint"],
  .scene:is([data-tool="supports"], [data-tool="drains"]) {
    touch-action: none;
  }
  .scene:active {
    cursor: grabbing;
  }
  .scene:is([data-tool="flat"], [data-tool="paint"], [data-tool="supports"], [data-tool="drains"]) {
    cursor: crosshair;
  }
  .scene.over:is([data-tool="supports"], [data-tool="drains"]) {
    cursor: move;
  }
  .scene:focus-visible {
    outline: 3px solid var(--cusp-focus, Highlight);
    outline-offset: -3px;
    border-radius: 8px;
  }
  canvas {
    display: block;
    touch-action: inherit;
  }
  ${visuallyHidden}
  /* Marks where the keyboard lays a face flat, paints, or adds a point. */
  .cross {
    display: none;
    position: absolute;
    inset: calc(50% - 10px) auto auto calc(50% - 10px - var(--cusp-view-aside, 0px) / 2);
    width: 20px;
    height: 20px;
    background:
      linear-gradient(currentColor, currentColor) center / 2px 100% no-repeat,
      linear-gradient(currentColor, currentColor) center / 100% 2px no-repeat;
    pointer-events: none;
  }
  .scene:is([data-tool="flat"], [data-tool="paint"], [data-tool="supports"], [data-tool="drains"]):focus-visible .cross {
    display: block;
  }
  .label {
    position: absolute;
    inset-block-end: 0.5rem;
    inset-inline-end: calc(0.5rem + var(--cusp-view-aside, 0px));
    padding: 0.125rem 0.5rem;
    border-radius: 6px;
    background: var(--cusp-text, CanvasText);
    color: var(--cusp-card, Canvas);
    font-size: 0.75rem;
    line-height: 1.4;
    font-variant-numeric: tabular-nums;
    white-space: nowrap;
    pointer-events: none;
  }
  /* Above the progress of the work under way. */
  .label:has(~ .building) {
    inset-block-end: 2.25rem;
  }
  .label.beside {
    inset: 0 auto auto 0;
  }
  .grid {
    position: absolute;
    inset-block-end: 0.625rem;
    inset-inline-start: 0.75rem;
    color: var(--cusp-quiet, inherit);
    font-size: 0.75rem;
    pointer-events: none;
  }
  .building {
    position: absolute;
    inset: auto 0 0;
    padding: 0 calc(0.75rem + var(--cusp-view-aside, 0px)) 0.625rem 0.75rem;
    color: var(--cusp-quiet, inherit);
    font-size: 0.75rem;
    text-align: end;
    font-variant-numeric: tabular-nums;
    pointer-events: none;
  }
  .building progress {
    position: absolute;
    inset: auto 0 0;
    width: 100%;
    height: 3px;
    border: 0;
    appearance: none;
    background: transparent;
    accent-color: var(--cusp-accent, Highlight);
  }
  .building progress::-webkit-progress-bar {
    background: transparent;
  }
  .building progress::-webkit-progress-value {
    background: var(--cusp-accent, Highlight);
  }
  .building progress::-moz-progress-bar {
    background: var(--cusp-accent, Highlight);
  }
  .unavailable,
  .lost {
    position: absolute;
    inset: 0;
    display: grid;
    place-content: center;
    justify-items: center;
    margin: 0;
    padding: 2rem;
    color: var(--cusp-quiet, inherit);
    text-align: center;
    text-wrap: balance;
  }
  .lost {
    background: var(--cusp-card, Canvas);
  }
  .lost p {
    margin: 0 0 0.75rem;
  }
  .lost button {
    min-height: 2.25rem;
    padding: 0.25rem 0.75rem;
    border: 1px solid var(--cusp-field, ButtonBorder);
    border-radius: 8px;
    background: transparent;
    color: var(--cusp-text, CanvasText);
    font: inherit;
    font-weight: 550;
    cursor: pointer;
  }
  .lost button:focus-visible {
    outline: 3px solid var(--cusp-focus, Highlight);
    outline-offset: 1px;
  }
  /* Probes of the page's colours. The start of a transition reveals a change of colour, whatever its cause. */
  .probe {
    position: absolute;
    visibility: hidden;
    transition: color 1ms;
  }
  .ink {
    color: var(--cusp-text, CanvasText);
  }
  .accent {
    color: var(--cusp-accent, Highlight);
  }
  .bad {
    color: var(--cusp-bad, #c0303a);
  }
  @media (forced-colors: active) {
    :host {
      background: Canvas;
    }
    .probe {
      forced-color-adjust: none;
    }
    .ink {
      color: CanvasText;
    }
    .accent {
      color: Highlight;
    }
    /* There is no colour of errors; links stand out from text. */
    .bad {
      color: LinkText;
    }
    /* What gradients draw would vanish. */
    .cross {
      forced-color-adjust: none;
      color: CanvasText;
    }
    .label {
      outline: 1px solid CanvasText;
    }
    .building progress::-webkit-progress-value {
      forced-color-adjust: none;
      background: Highlight;
    }
    .building progress::-moz-progress-bar {
      forced-color-adjust: none;
      background: Highlight;
    }
  }
`;
