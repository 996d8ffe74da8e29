/** The styles of the settings form. */
import { css } from "lit";

export const settingsStyles = css`
  form,
  .more {
    display: grid;
    gap: 1rem;
  }
  .more {
    margin-top: 1rem;
  }
  details summary {
    width: fit-content;
    font-size: 0.875rem;
    font-weight: 550;
    cursor: pointer;
  }
  .pair {
    display: grid;
    grid-template-columns: 1fr 1fr;
    gap: 0.75rem;
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
  .problem {
    margin: 0.5rem 0 0;
  }
  .towers {
    margin: 0;
  }
`;
