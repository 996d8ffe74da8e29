/** The styles of the copies field, in the list and next to a single model. */
import { css } from "lit";

export const copiesStyles = css`
  .copies {
    display: inline-flex;
  }
  .copies input {
    width: 2.5rem;
    border-radius: 0;
    text-align: center;
  }
  .copies-fault {
    flex-basis: 100%;
    color: var(--cusp-bad);
    font-size: 0.8125rem;
  }
  .copies .step {
    min-width: 2.25rem;
    padding: 0;
    border-radius: 8px 0 0 8px;
    border-inline-end: 0;
  }
  .copies .step:last-child {
    border-radius: 0 8px 8px 0;
    border-inline-start: 0;
    border-inline-end: 1px solid var(--cusp-field);
  }
  .copies-row {
    display: flex;
    align-items: center;
    flex-wrap: wrap;
    gap: 0.375rem;
    margin-top: 0.625rem;
    font-size: 0.875rem;
  }
  .copies-row .button {
    white-space: nowrap;
  }
  .copies-number {
    display: inline-flex;
    flex-wrap: wrap;
    align-items: center;
    gap: 0.375rem;
  }
  .copies-number ~ .button {
    margin-inline-start: auto;
    padding-inline: 0.375rem;
    font-size: 0.8125rem;
  }
  .copies input,
  .spacing,
  select {
    min-height: 2.25rem;
    padding: 0.25rem 0.375rem;
    border: 1px solid var(--cusp-field);
    background: transparent;
    color: inherit;
    font: inherit;
    font-variant-numeric: tabular-nums;
  }
  .spacing,
  select {
    border-radius: 8px;
  }
`;
