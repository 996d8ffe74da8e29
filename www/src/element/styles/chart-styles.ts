import { css, unsafeCSS } from "lit";
import { gradient } from "../../view/legend/palette.js";
import { lineIcon } from "./shared.js";

export const chartStyles = css`
  :host {
    display: flex;
    flex-direction: column;
    container-type: inline-size;
    min-width: 0;
  }
  .head,
  .top,
  .density,
  .key,
  .foot {
    flex: none;
  }
  .head {
    min-height: 0;
    margin: 0;
  }
  /* As high as its button, which comes and goes. */
  .top {
    display: flex;
    align-items: center;
    justify-content: space-between;
    gap: 0.5rem;
    min-height: 2.25rem;
  }
  .whole {
    flex: none;
    min-width: 2.25rem;
    padding: 0;
  }
  .whole svg {
    ${lineIcon}
  }
  .top p,
  .density,
  .key,
  .foot {
    font-size: 0.8125rem;
    line-height: 1.4;
    color: var(--cusp-quiet);
  }
  .density {
    text-align: center;
  }
  .key {
    display: grid;
    grid-template-columns: minmax(0, 1fr);
    gap: 0.25rem;
    margin: 0.5rem 0 0;
    padding: 0;
    list-style: none;
  }
  .colours {
    display: flex;
    flex-wrap: wrap;
    align-items: center;
    gap: 0 0.75rem;
  }
  .limits {
    display: flex;
    min-width: 0;
    align-items: center;
    gap: 0.375rem;
    white-space: nowrap;
  }
  .line {
    display: inline-block;
    width: 1.25rem;
    margin-inline-end: 0.375rem;
    border-top: 2px solid var(--cusp-chart-ink);
    vertical-align: middle;
  }
  .off-mark {
    display: inline-block;
    width: 0.3125rem;
    height: 0.75rem;
    margin-inline-end: 0.375rem;
    background: var(--cusp-bad);
    vertical-align: middle;
  }
  .scale {
    background: ${unsafeCSS(gradient())};
    width: 3rem;
    min-width: 1rem;
    height: 0.625rem;
    border-radius: 3px;
    forced-color-adjust: none;
  }
  .plot {
    flex: 1 1 30rem;
    min-height: 10rem;
    direction: ltr;
    overflow: hidden;
    border-radius: 4px;
    /* One finger scrolls the page; two are the chart's. */
    touch-action: pan-y;
  }
  .plot:focus-visible {
    outline-offset: -3px;
  }
  .u-over {
    cursor: crosshair;
    border-radius: 2px;
  }
  .u-select {
    background: var(--cusp-chart-ink);
    opacity: 0.25;
    forced-color-adjust: none;
  }
  /* The heights of a finding. */
  .range {
    position: absolute;
    inset-inline: 0;
    border-block: 2px dashed #c05f00;
    background: rgb(255 159 26 / 0.3);
    pointer-events: none;
  }
  .range[hidden] {
    display: none;
  }
  .marker {
    position: absolute;
    left: -5px;
    right: -5px;
    height: 0;
    border-top: 2px solid var(--cusp-chart-ink);
    outline: 1px solid var(--cusp-chart-paper);
    pointer-events: none;
    forced-color-adjust: none;
  }
  .marker::before {
    content: "";
    position: absolute;
    left: -3px;
    top: -6px;
    border: 5px solid transparent;
    border-left: 7px solid var(--cusp-text);
  }
  /* One cell for the hint, the value that replaces it, and the longest such value, so that nothing moves. */
  .foot {
    display: grid;
    min-height: 0;
    align-items: start;
    margin-top: 0.5rem;
  }
  .foot > * {
    grid-area: 1 / 1;
  }
  .off {
    visibility: hidden;
  }
  .touch {
    display: none;
  }
  @media (hover: none) {
    .mouse {
      display: none;
    }
    .touch {
      display: block;
    }
  }
  /* As a column beside the view, which has the scale of colours. */
  @container (max-width: 15rem) {
    .density {
      font-size: 0.75rem;
    }
    .colours {
      display: none;
    }
  }
  @media (forced-colors: active) {
    :host {
      --cusp-chart-ink: CanvasText;
      --cusp-chart-paper: Canvas;
      --cusp-text: CanvasText;
      --cusp-field: CanvasText;
    }
    .marker {
      border-top-color: Highlight;
    }
    .marker::before {
      border-left-color: Highlight;
    }
  }
`;
