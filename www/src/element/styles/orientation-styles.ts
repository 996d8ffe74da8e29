import { css } from "lit";
import { textField } from "./text-field.js";

export const orientationStyles = css`
  :host {
    /* What is for screen readers alone scrolls with the rest, instead of making the page longer. */
    position: relative;
    display: block;
    min-width: 0;
    container-type: inline-size;
  }
  h4 {
    margin: 0;
    font-size: 0.875rem;
    font-weight: 600;
  }
  .hint {
    text-wrap: pretty;
  }
  /* A layout that says itself what turning is for hides it. */
  .head + .hint {
    display: var(--cusp-orientation-hint, block);
  }
  .stale {
    margin-bottom: 0.75rem;
    padding: 0.375rem 0.75rem;
    border-radius: 6px;
    background: var(--cusp-note-wash);
    font-size: 0.875rem;
  }
  .hovers,
  .taps {
    display: none;
  }
  @media (hover: hover) {
    .hovers {
      display: inline;
    }
  }
  @media not (hover: hover) {
    .taps {
      display: inline;
    }
  }
  .aims {
    margin-top: 0.75rem;
    font-size: 0.875rem;
  }
  summary {
    display: flex;
    align-items: center;
    min-height: 2.25rem;
    cursor: pointer;
    font-weight: 550;
  }
  summary::after {
    content: "";
    width: 0.4375rem;
    height: 0.4375rem;
    margin-inline: 0.625rem;
    border: solid var(--cusp-quiet);
    border-width: 0 2px 2px 0;
    rotate: 45deg;
    translate: 0 -0.125rem;
  }
  [open] > summary::after {
    rotate: 225deg;
    translate: 0 0.125rem;
  }
  .weights {
    display: grid;
    grid-template-columns: auto minmax(4rem, 1fr);
    gap: 0 0.75rem;
  }
  .field {
    display: grid;
    grid-column: 1 / -1;
    grid-template-columns: subgrid;
    align-items: center;
    min-height: 2.25rem;
    min-width: 0;
  }
  .field > span:first-child {
    color: var(--cusp-quiet);
  }
  input[type="range"] {
    width: 100%;
    accent-color: var(--cusp-accent);
  }
  .limits {
    display: grid;
    grid-column: 1 / -1;
    grid-template-columns: auto minmax(0, 1fr);
    gap: inherit;
  }
  .limits > p {
    grid-column: 1 / -1;
    margin: 0.375rem 0 0;
  }
  input[type="number"] {
    ${textField}
    width: 100%;
  }
  .again {
    margin-top: 1rem;
  }
  /* Appears after a delay, so that a quick search does not flash. */
  .again.quick {
    animation: appear 150ms 400ms both;
  }
  @keyframes appear {
    from {
      opacity: 0;
    }
  }
  .results {
    display: grid;
    gap: 1.25rem;
    margin-top: 1.25rem;
  }
  /* Text stays legible. */
  .old {
    --cusp-faded: 0.5;
  }
  .globe {
    display: grid;
    align-content: start;
    gap: 0.75rem;
    min-width: 0;
  }
  .legend {
    display: grid;
    gap: 0.25rem;
    font-size: 0.8125rem;
  }
  .scale {
    direction: ltr;
    display: grid;
    grid-template-columns: auto 1fr auto;
    align-items: center;
    gap: 0.5rem;
    font-variant-numeric: tabular-nums;
  }
  .scale i {
    height: 0.625rem;
    border-radius: 3px;
  }
  .keys {
    display: flex;
    flex-wrap: wrap;
    gap: 0 1.25rem;
    font-size: 0.8125rem;
  }
  .keys svg {
    width: 0.75rem;
    height: 0.75rem;
    margin-inline-end: 0.375rem;
    stroke: var(--cusp-text);
    stroke-width: 2;
  }
  .keys .excluded {
    display: inline-block;
    width: 0.6875rem;
    height: 0.6875rem;
    margin-inline-end: 0.375rem;
    border-radius: 2px;
    background: rgb(138 143 152);
  }
  .looked dl {
    display: grid;
    grid-template-columns: repeat(auto-fill, minmax(7.25rem, 1fr));
    gap: 0.375rem 1rem;
  }
  /* The size is the longest of all. */
  .looked dl div:last-child {
    grid-column: 1 / -1;
  }
  dt {
    color: var(--cusp-quiet);
    font-size: 0.8125rem;
  }
  dd {
    font-size: 0.875rem;
  }
  .why {
    margin-bottom: 0.5rem;
    font-weight: 550;
  }
  .looked button {
    margin-top: 0.625rem;
  }
  .best {
    display: grid;
    align-content: start;
    gap: 0.5rem;
    min-width: 0;
  }
  .pose,
  .now {
    position: relative;
    display: grid;
    grid-template-columns: 5rem minmax(0, 1fr);
    justify-content: start;
    align-items: start;
    gap: 0.75rem;
    width: 100%;
    padding: 0.375rem;
    padding-inline-end: 0.5rem;
    border: 1px solid var(--cusp-line);
    border-radius: 8px;
    text-align: start;
    font-weight: 400;
    line-height: 1.25;
  }
  .now {
    border-style: dashed;
    border-color: var(--cusp-field);
  }
  .best canvas {
    display: block;
    width: 5rem;
    height: 5rem;
    border-radius: 6px;
    background: color-mix(in srgb, var(--cusp-card) 94%, var(--cusp-text));
    opacity: var(--cusp-faded, 1);
  }
  /* The picture is that of the pose before. */
  .unknown canvas {
    opacity: 0.35;
  }
  .pose[aria-pressed="true"] {
    border-color: var(--cusp-accent);
    box-shadow: inset 0 0 0 1px var(--cusp-accent);
  }
  .rank {
    position: absolute;
    inset-block-start: 0.625rem;
    inset-inline-start: 0.625rem;
    display: grid;
    place-items: center;
    width: 1.25rem;
    height: 1.25rem;
    border: 1.5px solid var(--cusp-text);
    border-radius: 50%;
    background: var(--cusp-card);
    font-size: 0.75rem;
    font-weight: 650;
  }
  .what {
    display: grid;
    align-content: center;
    gap: 0.1875rem;
    align-self: center;
    font-size: 0.875rem;
    font-variant-numeric: tabular-nums;
  }
  .tag {
    color: var(--cusp-quiet);
    font-size: 0.8125rem;
    font-weight: 650;
  }
  .cost {
    display: flex;
    flex-wrap: wrap;
    gap: 0 0.625rem;
  }
  .what .quiet {
    font-size: 0.8125rem;
  }
  .probe {
    position: absolute;
    visibility: hidden;
    color: var(--cusp-text);
    transition: color 1ms;
  }
  /* On a phone and in a column the answer comes first. */
  @container (max-width: 43.99rem) {
    .best:has(.pose) {
      order: -1;
    }
    .looked dl {
      grid-template-columns: 1fr;
    }
    .looked dl div {
      display: flex;
      justify-content: space-between;
      gap: 0.5rem;
    }
  }
  @container (min-width: 36rem) {
    .weights {
      grid-template-columns: auto minmax(4rem, 1fr) auto minmax(4rem, 1fr);
      column-gap: 1rem;
    }
    .field {
      grid-column: span 2;
    }
    .limits {
      max-width: 24rem;
    }
  }
  @container (min-width: 44rem) {
    .pose,
    .now {
      grid-template-columns: 7rem minmax(0, 1fr);
    }
    .best canvas {
      width: 7rem;
      height: 7rem;
    }
    /* Its greatest height, so that pointing at another direction moves nothing. */
    .looked {
      min-height: 9rem;
    }
    .results {
      grid-template-columns: minmax(0, 1.35fr) minmax(0, 1fr);
      gap: 2rem;
    }
  }
  @media (forced-colors: active) {
    .scale i,
    .keys .excluded,
    .best canvas {
      forced-color-adjust: none;
      border: 1px solid CanvasText;
    }
    .keys svg {
      stroke: CanvasText;
    }
    .stale,
    .now {
      border: 1px dashed CanvasText;
    }
    .pose:hover {
      border-color: Highlight;
    }
    .pose[aria-pressed="true"] {
      border-color: Highlight;
      outline: 2px solid Highlight;
      outline-offset: -3px;
    }
    .pose:focus-visible {
      outline: 3px solid CanvasText;
      outline-offset: 2px;
    }
  }
`;
