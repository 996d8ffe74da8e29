import { css } from "lit";
import { lineIcon } from "./shared.js";

export const layoutStyles = css`
  :host([hidden]) {
    display: none;
  }
  h2 {
    font-size: 1.125rem;
    font-weight: 600;
    overflow-wrap: anywhere;
  }
  h2:focus:not(:focus-visible) {
    outline: none;
  }
  .start {
    display: grid;
    justify-items: center;
    gap: 1rem;
    padding-top: clamp(0rem, 4vh, 3rem);
  }
  .drop {
    display: grid;
    justify-items: center;
    align-content: center;
    gap: 1rem;
    width: 100%;
    max-width: 44rem;
    min-height: 20rem;
    padding: 2rem 1rem;
    border: 2px dashed var(--cusp-field);
    border-radius: 16px;
    background: var(--cusp-card);
    cursor: pointer;
    transition: border-color 120ms;
  }
  .drop:hover {
    border-color: var(--cusp-accent);
  }
  .drop:has(:focus-visible),
  .open-other label:has(:focus-visible) {
    outline: 3px solid var(--cusp-focus);
    outline-offset: 2px;
  }
  .drop-title {
    font-size: 1.375rem;
    font-weight: 600;
  }
  slot[name="empty"] {
    display: block;
    width: 100%;
    max-width: 44rem;
  }
  .waiting {
    display: grid;
    gap: 1rem;
    align-content: center;
    justify-items: start;
    min-height: 10rem;
    width: 100%;
    max-width: 44rem;
  }
  .waiting .progress {
    width: 100%;
  }

  .work {
    display: grid;
    grid-template-columns: minmax(0, 1fr);
    gap: 1rem;
  }
  .model dl {
    display: flex;
    flex-wrap: wrap;
    gap: 0.5rem 1.5rem;
    margin-top: 0.75rem;
  }
  .earlier {
    margin-bottom: 0.75rem;
    padding: 0.375rem 0.75rem;
    border-radius: 6px;
    background: var(--cusp-note-wash);
    font-size: 0.875rem;
  }
  .warning {
    margin-top: 0.75rem;
    padding-inline-start: 0.75rem;
    border-inline-start: 3px solid #e0a030;
    font-size: 0.875rem;
  }
  .files {
    display: flex;
    align-items: center;
    gap: 0.5rem;
    margin-top: 1rem;
  }
  .open-other {
    display: flex;
    align-items: center;
    gap: 0.75rem;
    margin-top: 1rem;
  }
  /* The card is narrow: in a line of its own, the button begins where the line does. */
  .copies-row .copies ~ .button {
    margin-inline-start: 0;
  }
  .card > summary {
    cursor: pointer;
  }
  .card > summary h2 {
    display: inline;
  }
  .card[open] > summary {
    margin-bottom: 1rem;
  }
  /* Its summary is the title. */
  .findings {
    --cusp-title-position: absolute;
    --cusp-title-clip: inset(50%);
  }
  .settings {
    position: relative;
  }
  .settings .steps {
    position: absolute;
    inset-block-start: 0.9375rem;
    inset-inline-end: 1.25rem;
    display: flex;
    gap: 0.25rem;
  }
  .settings .steps button {
    min-width: 2.25rem;
    padding: 0;
  }
  .steps svg {
    ${lineIcon}
  }
  .results {
    display: grid;
    grid-template-columns: minmax(0, 1fr);
    gap: 1rem;
    align-content: start;
  }
  .results > * {
    transition: opacity 150ms;
  }
  /* Dims late and returns at once, so that quick plans do not make the page blink. */
  .results.replanning > * {
    opacity: 0.6;
    transition-delay: 250ms;
  }
  .results .waiting {
    max-width: none;
  }
  .download {
    min-height: 3rem;
    padding-inline: 1.5rem;
  }
  details.quiet {
    margin-top: 0.75rem;
  }
  /* Appears after a delay, so that quick plans do not flash. */
  .toast {
    position: fixed;
    z-index: 2;
    inset-inline: 1rem;
    bottom: 1rem;
    max-width: 32rem;
    margin-inline: auto;
    box-shadow: 0 8px 30px rgb(0 0 0 / 0.25);
    animation: appear 150ms 250ms both;
  }
  @keyframes appear {
    from {
      opacity: 0;
    }
  }
  .dragging {
    outline: 3px dashed var(--cusp-accent);
    outline-offset: 0.25rem;
    border-radius: 16px;
  }
  .span {
    grid-column: 1 / -1;
  }
  /* About as high as it will be once its code is there. */
  [part="orientation"] {
    min-height: 14rem;
  }

  @container (min-width: 56rem) {
    .work {
      grid-template-columns: 19rem minmax(0, 1fr);
      grid-template-rows: auto 1fr;
    }
    .model {
      grid-area: 1 / 1;
    }
    .settings {
      grid-area: 2 / 1;
      align-self: start;
    }
    .results {
      grid-area: 1 / 2 / 3 / 3;
      grid-template-columns: minmax(0, 1.15fr) minmax(0, 1fr);
    }
    .work.plain {
      grid-template-columns: minmax(0, 1fr);
    }
    .plain .results {
      grid-area: auto;
    }
  }
  /* On a phone the answer comes before the settings, which fold away. */
  @container (max-width: 55.99rem) {
    .results {
      display: contents;
    }
    .results > * {
      order: 1;
    }
    .settings {
      order: 0;
    }
    .results > .first {
      order: -1;
    }
    .model {
      order: -2;
    }
  }
`;
