import { css } from "lit";
import { filling } from "./shared.js";

export const maskStyles = css`
  ${filling}
  /* It takes what a box of definite height leaves. */
  .well {
    position: relative;
    flex: 1 1 18rem;
    min-height: 10rem;
    border-radius: 8px;
    background: #000;
    overflow: hidden;
  }
  canvas {
    position: absolute;
    inset: 0;
    width: 100%;
    height: 100%;
    border-radius: 8px;
    /* One finger scrolls the page, two are for the picture. */
    touch-action: pan-x pan-y;
  }
  canvas:focus-visible {
    outline-offset: -3px;
  }
  canvas.zoomed {
    cursor: grab;
    touch-action: none;
  }
  /* Where the title is for screen readers alone, nothing of its room stays. */
  .head {
    display: block;
    min-height: 0;
    margin: 0;
  }
  .head h3 {
    margin-bottom: 0.75rem;
  }
  /* On the picture, which is black in every theme: so they take none of its height. */
  .tools {
    position: absolute;
    inset-block-start: 0.375rem;
    inset-inline-end: 0.375rem;
    display: flex;
    align-items: center;
    gap: 0.25rem;
    color: #fff;
    font-size: 0.8125rem;
    pointer-events: none;
  }
  .tools button {
    min-width: 2.25rem;
    padding: 0;
    border-color: #8b94a2;
    background: rgb(0 0 0 / 0.7);
    color: #fff;
    pointer-events: auto;
  }
  .tools button:hover:not(:disabled) {
    background: #2e333d;
  }
  .tools button:focus-visible {
    outline-color: #9ac4ff;
  }
  .tools {
    flex-wrap: wrap;
    justify-content: end;
    max-width: 100%;
  }
  .tools svg {
    width: 1.125rem;
    height: 1.125rem;
    fill: none;
    stroke: currentColor;
    stroke-width: 1.5;
  }
  .tools button[aria-pressed="true"]:not(:disabled) {
    border-color: #fff;
    background: #fff;
    color: #000;
  }
  canvas.measuring {
    cursor: crosshair;
    touch-action: none;
  }
  .changes {
    display: flex;
    flex-wrap: wrap;
    gap: 0.25rem 0.75rem;
    margin-top: 0.25rem;
    font-size: 0.8125rem;
  }
  .changes i {
    display: inline-block;
    margin-inline-end: 0.375em;
    width: 0.75em;
    height: 0.75em;
    border-radius: 2px;
    background: #ff9f1a;
  }
  .changes .gone {
    background: #2a60b0;
  }
  :host(:fullscreen) {
    padding: 1rem;
    background: var(--cusp-card);
  }
  .zoom {
    padding: 0 0.5rem;
    border-radius: 1rem;
    background: rgb(0 0 0 / 0.7);
  }
  .head,
  .hint,
  .scrub,
  dl {
    flex: none;
  }
  /* All hints have the room of the longest. */
  .hint {
    display: grid;
    margin-top: 0.25rem;
    font-size: 0.8125rem;
    line-height: 1.4;
  }
  .hint span {
    grid-area: 1 / 1;
  }
  .hint .off {
    visibility: hidden;
  }
  .hint .taps {
    display: none;
  }
  @media not (hover: hover) {
    .hint .taps {
      display: inline;
    }
    .hint .hovers {
      display: none;
    }
  }
  .scrub {
    display: grid;
    grid-template-columns: auto auto 1fr auto;
    align-items: center;
    gap: 0.5rem;
    margin-top: 0.5rem;
  }
  .scrub button {
    min-width: 2.75rem;
    padding: 0;
    font-size: 1.25rem;
  }
  .scrub svg {
    width: 1rem;
    height: 1rem;
    fill: currentColor;
  }
  input {
    width: 100%;
    min-width: 0;
    height: 2.75rem;
    margin: 0;
    accent-color: var(--cusp-accent);
  }
  dl {
    display: flex;
    flex-wrap: wrap;
    justify-content: space-between;
    gap: 0.25rem 1rem;
    margin-top: 0.5rem;
  }
  dt {
    color: var(--cusp-quiet);
    font-size: 0.8125rem;
  }
  dd {
    font-weight: 550;
    white-space: nowrap;
  }
  .swatch {
    display: inline-block;
    width: 0.75em;
    height: 0.75em;
    margin-inline-end: 0.375em;
    border-radius: 2px;
  }
  @container (max-width: 24rem) {
    dl {
      gap: 0.25rem 0.5rem;
      font-size: 0.875rem;
    }
  }
  @container (max-width: 19rem) {
    .tools {
      gap: 0.125rem;
    }
    .tools button {
      min-width: 1.875rem;
      min-height: 1.875rem;
    }
    .tools .zoom {
      display: none;
    }
    .scrub {
      gap: 0.25rem;
    }
    .scrub button {
      min-width: 2.25rem;
      min-height: 2.25rem;
    }
    dl {
      font-size: 0.8125rem;
    }
  }
  @media (forced-colors: active) {
    .well,
    .swatch {
      forced-color-adjust: none;
      border: 1px solid CanvasText;
    }
  }
`;
