import { css } from "lit";

export const findingsStyles = css`
  :host {
    display: block;
    font-size: 0.875rem;
  }
  .head {
    display: block;
    min-height: 0;
    margin: 0;
  }
  .head h3 {
    margin-bottom: 0.75rem;
  }
  .verdict {
    display: flex;
    align-items: center;
    gap: 0.5rem;
    margin-bottom: 0.5rem;
    font-size: 0.9375rem;
    font-weight: 600;
  }
  svg {
    flex: none;
    width: 1.25rem;
    height: 1.25rem;
    padding: 0.125rem;
    border-radius: 50%;
    fill: none;
    stroke: var(--cusp-card);
    stroke-width: 2.25;
    stroke-linecap: round;
    stroke-linejoin: round;
    background: var(--cusp-quiet);
  }
  svg.ok {
    background: var(--cusp-good);
  }
  svg.review {
    background: var(--cusp-accent);
  }
  svg.reject {
    background: var(--cusp-bad);
  }
  .show-walls {
    display: flex;
    align-items: center;
    gap: 0.5rem;
    min-height: 1.75rem;
    margin-top: 0.5rem;
    font-weight: 550;
    cursor: pointer;
  }
  .fix {
    margin-block: 0.25rem 0.375rem;
  }
  .failed {
    color: var(--cusp-bad);
  }
  .kinds {
    margin-top: 0.5rem;
  }
  .old {
    opacity: 0.6;
  }
  section {
    margin-top: 0.75rem;
    padding-top: 0.75rem;
    border-top: 1px solid var(--cusp-line);
  }
  h4.model {
    margin-top: 1rem;
    font-size: 1rem;
  }
  h4 {
    display: flex;
    flex-wrap: wrap;
    align-items: center;
    gap: 0 0.5rem;
    margin: 0;
    font-size: 0.875rem;
    font-weight: 600;
  }
  .count {
    padding-inline: 0.5rem;
    border: 1px solid var(--cusp-line);
    border-radius: 1rem;
    font-weight: 500;
  }
  .severity {
    margin-inline-start: auto;
    font-size: 0.8125rem;
    font-weight: 400;
  }
  .quiet {
    font-size: 0.8125rem;
  }
  ul {
    display: grid;
    gap: 0.375rem;
    margin: 0.375rem 0 0;
    padding: 0;
    list-style: none;
  }
  .finding {
    display: grid;
    gap: 0.125rem;
    justify-items: start;
    width: 100%;
    padding: 0.375rem 0.625rem;
    border-color: var(--cusp-line);
    font-size: 0.8125rem;
    font-weight: 400;
    line-height: 1.4;
    text-align: start;
    overflow-wrap: anywhere;
  }
  .finding[aria-pressed="true"] {
    border-color: var(--cusp-accent);
    background: var(--cusp-note-wash);
    box-shadow: inset 3px 0 var(--cusp-accent);
  }
  @media (forced-colors: active) {
    svg,
    svg[class] {
      stroke: CanvasText;
      background: Canvas;
      border: 1px solid CanvasText;
    }
    .finding[aria-pressed="true"] {
      border: 3px solid Highlight;
    }
  }
`;
