/** The layout of the page. */
import { css } from "lit";

export const appStyles = css`
  :host {
    display: block;
    max-width: 80rem;
    margin: 0 auto;
    padding: 1.25rem clamp(1rem, 3vw, 2rem) 3rem;
    color: var(--cusp-text);
    font-family: var(--cusp-font);
  }
  header {
    display: flex;
    flex-wrap: wrap;
    align-items: center;
    gap: 0.25rem 1.25rem;
    margin-bottom: 1.25rem;
  }
  .brand {
    display: flex;
    align-items: center;
    gap: 0.625rem;
  }
  .brand img {
    display: block;
  }
  h1 {
    font-size: 1.5rem;
    font-weight: 650;
    letter-spacing: -0.01em;
  }
  h2 {
    font-size: 1.125rem;
    font-weight: 600;
    overflow-wrap: anywhere;
  }
  h2:focus:not(:focus-visible) {
    outline: none;
  }
  .tagline {
    flex: 1 1 20rem;
  }
  .private {
    color: var(--cusp-good);
    font-size: 0.875rem;
    font-weight: 550;
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
  .points {
    display: grid;
    grid-template-columns: repeat(auto-fit, minmax(min(12rem, 100%), 1fr));
    gap: 1rem 2rem;
    width: 100%;
    max-width: 44rem;
    margin: 1.5rem 0 0;
    padding: 0;
    list-style: none;
    color: var(--cusp-quiet);
    font-size: 0.9375rem;
  }
  .points strong {
    display: block;
    color: var(--cusp-text);
    font-weight: 600;
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

  .message {
    display: flex;
    flex-wrap: wrap;
    align-items: start;
    justify-content: space-between;
    gap: 1rem;
    margin-bottom: 1rem;
    padding: 0.875rem 1.25rem;
    border: 1px solid var(--cusp-line);
    border-left-width: 4px;
    border-radius: 8px;
  }
  .message > :first-child {
    flex: 1 1 18rem;
    min-width: 0;
    overflow-wrap: anywhere;
  }
  .message h2 {
    font-size: 1rem;
  }
  .problem {
    border-color: var(--cusp-bad);
    background: var(--cusp-bad-wash);
  }
  .notice {
    align-items: center;
    border-color: var(--cusp-accent);
    background: var(--cusp-note-wash);
  }
  .offers {
    display: flex;
    flex-wrap: wrap;
    gap: 0.5rem;
    margin-top: 0.625rem;
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
  dt {
    color: var(--cusp-quiet);
    font-size: 0.8125rem;
  }
  .warning {
    margin-top: 0.75rem;
    padding-left: 0.75rem;
    border-left: 3px solid #e0a030;
    font-size: 0.875rem;
  }
  .open-other {
    display: flex;
    align-items: center;
    gap: 0.75rem;
    margin-top: 1rem;
  }
  .open-other label {
    position: relative;
  }
  .settings summary {
    cursor: pointer;
  }
  .settings summary h2 {
    display: inline;
  }
  .settings[open] summary {
    margin-bottom: 1rem;
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
  /* Late to dim and quick to return, so that quick plans do not make the page blink. */
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
  details.quiet summary {
    width: fit-content;
    cursor: pointer;
  }
  .facts {
    display: flex;
    flex-wrap: wrap;
    gap: 0.5rem 2rem;
    margin-top: 0.5rem;
  }
  /* Waits a little before it shows, so that quick plans do not make it flash. */
  .toast {
    position: fixed;
    z-index: 2;
    left: 50%;
    bottom: 1rem;
    width: min(32rem, calc(100vw - 2rem));
    transform: translateX(-50%);
    box-shadow: 0 8px 30px rgb(0 0 0 / 0.25);
    animation: appear 150ms 250ms both;
  }
  @keyframes appear {
    from {
      opacity: 0;
    }
  }
  .drop-veil {
    position: fixed;
    z-index: 3;
    inset: 0.5rem;
    display: grid;
    place-items: center;
    border: 3px dashed var(--cusp-accent);
    border-radius: 16px;
    background: color-mix(in srgb, var(--cusp-page) 85%, transparent);
    font-size: 1.5rem;
    font-weight: 600;
    pointer-events: none;
  }

  @media (min-width: 60rem) {
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
    .results > :first-child {
      grid-column: 1 / -1;
    }
  }
  /* On a phone the answer comes before the settings, which fold away. */
  @media (max-width: 59.99rem) {
    .results {
      display: contents;
    }
    .results > :nth-child(n + 2) {
      order: 1;
    }
    .settings {
      order: 0;
    }
    .results > :first-child {
      order: -1;
    }
    .model {
      order: -2;
    }
  }
`;
