/** Styles shared by the elements: cards, buttons, focus, and text for screen readers only. */
import { css } from "lit";
import { visuallyHidden } from "../../view/visually-hidden.js";

/** Line icon with the height of its button's text. */
export const lineIcon = css`
  width: 1.125rem;
  height: 1.125rem;
  fill: none;
  stroke: currentColor;
  stroke-width: 1.75;
  stroke-linecap: round;
  stroke-linejoin: round;
`;

/** Panel that fills a box of definite height, with a layout by its own width. */
export const filling = css`
  :host {
    display: flex;
    flex-direction: column;
    min-width: 0;
    height: 100%;
    container-type: inline-size;
  }
`;

export const shared = css`
  *,
  *::before,
  *::after {
    box-sizing: border-box;
  }
  h1,
  h2,
  h3,
  p,
  dl,
  dd,
  fieldset {
    margin: 0;
    padding: 0;
    border: 0;
  }
  h3 {
    font-size: 0.9375rem;
    font-weight: 600;
  }
  .card {
    background: var(--cusp-card);
    border: 1px solid var(--cusp-line);
    border-radius: var(--cusp-radius);
    padding: 1.25rem;
  }
  .quiet {
    color: var(--cusp-quiet);
    font-size: 0.875rem;
  }
  .figures {
    font-variant-numeric: tabular-nums;
  }
  ${visuallyHidden}
  button,
  .button {
    font: inherit;
    font-weight: 550;
    line-height: 1.25;
    display: inline-flex;
    align-items: center;
    justify-content: center;
    gap: 0.5rem;
    min-height: 2.75rem;
    padding: 0.5rem 1.125rem;
    border-radius: 8px;
    border: 1px solid var(--cusp-field);
    background: transparent;
    color: var(--cusp-text);
    cursor: pointer;
    transition: background-color 120ms;
  }
  button:hover:not(:disabled) {
    background: var(--cusp-note-wash);
  }
  .primary {
    border-color: transparent;
    background: var(--cusp-accent);
    color: var(--cusp-on-accent);
  }
  .primary:hover:not(:disabled) {
    background: var(--cusp-accent-hover);
  }
  .small {
    min-height: 2.25rem;
    padding: 0.25rem 0.75rem;
    font-size: 0.875rem;
  }
  button:disabled {
    opacity: 0.55;
    cursor: default;
  }
  .link {
    min-height: 0;
    padding: 0.25rem;
    border: 0;
    color: var(--cusp-accent);
    text-decoration: underline;
    text-underline-offset: 0.2em;
  }
  .towers {
    margin-top: 0.625rem;
  }
  .towers p {
    margin-top: 0.375rem;
    font-size: 0.8125rem;
    line-height: 1.4;
    text-wrap: pretty;
  }
  .head,
  .foot {
    display: flex;
    flex-wrap: wrap;
    align-items: center;
    justify-content: space-between;
    gap: 0.25rem 1rem;
    min-height: 2.25rem;
  }
  .head {
    margin-bottom: 0.75rem;
  }
  .head h3 {
    /* A layout that names its panels itself leaves their titles to screen readers. */
    position: var(--cusp-title-position, static);
    clip-path: var(--cusp-title-clip, none);
  }
  :focus-visible {
    outline: 3px solid var(--cusp-focus);
    outline-offset: 2px;
  }
  @media (prefers-reduced-motion: reduce) {
    * {
      transition: none !important;
      animation-duration: 0s !important;
    }
  }
`;
