import { css } from "lit";

export const settingsStyles = css`
  form,
  .more {
    display: grid;
    grid-template-columns: minmax(0, 1fr);
    gap: 0.875rem;
  }
  .more {
    margin-top: 0.875rem;
  }
  details summary {
    width: fit-content;
    font-size: 0.875rem;
    font-weight: 550;
    cursor: pointer;
  }
  /* Two fields share their rows, so that the boxes stay level if only one of the labels wraps. */
  .pair {
    display: grid;
    grid-template: auto auto auto / minmax(0, 1fr) minmax(0, 1fr);
    column-gap: 0.75rem;
  }
  .pair .field {
    display: grid;
    grid-row: span 3;
    grid-template-rows: subgrid;
    grid-template-columns: minmax(0, 1fr);
  }
  .pair label {
    align-self: end;
  }
  label,
  legend {
    display: block;
    padding: 0;
    font-size: 0.875rem;
    font-weight: 550;
  }
  .field {
    min-width: 0;
  }
  .box {
    display: flex;
    align-items: center;
    margin-top: 0.25rem;
    border: 1px solid var(--cusp-field);
    border-radius: 8px;
    background: var(--cusp-card);
  }
  .box:focus-within {
    outline: 3px solid var(--cusp-focus);
    outline-offset: 1px;
  }
  .list {
    position: relative;
  }
  .list::after {
    content: "";
    position: absolute;
    inset-inline-end: 0.875rem;
    width: 0.4375rem;
    height: 0.4375rem;
    border: solid var(--cusp-quiet);
    border-width: 0 2px 2px 0;
    translate: 0 -2px;
    rotate: 45deg;
    pointer-events: none;
  }
  .box.wrong {
    border-color: var(--cusp-bad);
    box-shadow: inset 0 0 0 1px var(--cusp-bad);
  }
  input[type="text"],
  select {
    font: inherit;
    font-variant-numeric: tabular-nums;
    width: 100%;
    min-width: 0;
    min-height: 2.5rem;
    padding: 0.25rem 0.625rem;
    border: 0;
    border-radius: 8px;
    outline: none;
    background: transparent;
    color: inherit;
  }
  select {
    appearance: none;
    padding-inline-end: 2rem;
    text-overflow: ellipsis;
    cursor: pointer;
  }
  .box:has(:disabled) {
    background: var(--cusp-page);
  }
  input:disabled,
  select:disabled {
    opacity: 1;
    color: var(--cusp-quiet);
    cursor: not-allowed;
  }
  option {
    background: var(--cusp-card);
    color: var(--cusp-text);
  }
  .open {
    margin-top: 0.5rem;
  }
  .unit {
    padding-inline-end: 0.625rem;
    color: var(--cusp-quiet);
    font-size: 0.875rem;
  }
  .hint,
  .fault {
    margin-top: 0.25rem;
    font-size: 0.8125rem;
    line-height: 1.4;
  }
  .hint {
    color: var(--cusp-quiet);
  }
  .fault {
    color: var(--cusp-bad);
  }
  .choice {
    display: grid;
    grid-template-columns: 1fr 1fr;
    margin-top: 0.25rem;
    border: 1px solid var(--cusp-field);
    border-radius: 8px;
    overflow: hidden;
  }
  .open:has(:focus-visible),
  .choice:focus-within:has(:focus-visible) {
    outline: 3px solid var(--cusp-focus);
    outline-offset: 1px;
  }
  .choice label {
    min-height: 2.5rem;
    display: grid;
    place-items: center;
    text-align: center;
    cursor: pointer;
  }
  .choice label:has(:checked) {
    background: var(--cusp-accent);
    color: var(--cusp-on-accent);
  }
  @media (forced-colors: active) {
    .choice label:has(:checked) {
      forced-color-adjust: none;
      background: Highlight;
      color: HighlightText;
    }
    .box.wrong {
      outline: 1px solid CanvasText;
      outline-offset: -4px;
    }
    .box:focus-within,
    .open:has(:focus-visible),
    .choice:focus-within:has(:focus-visible) {
      outline: 3px solid Highlight;
      outline-offset: 1px;
    }
    input:disabled,
    select:disabled {
      color: GrayText;
    }
  }
  .problem {
    margin: 0.5rem 0 0;
  }
  .towers {
    margin: 0;
  }
`;
