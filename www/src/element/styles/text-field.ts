/** Declarations of a text field or a list with a border of its own. */
import { css } from "lit";

export const textField = css`
  font: inherit;
  font-variant-numeric: tabular-nums;
  min-height: 2.25rem;
  padding: 0.25rem 0.5rem;
  border: 1px solid var(--cusp-field);
  border-radius: 8px;
  background: var(--cusp-card);
  color: inherit;
`;
