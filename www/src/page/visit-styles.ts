/** Shared styles of the page's own panels, in addition to the element's: full width, and rows of lists. */
import { css } from "lit";
import { lineIcon } from "../element/styles/shared.js";

export const visitStyles = css`
  :host {
    font-size: 0.9375rem;
  }
  ul {
    margin: 0;
    padding: 0;
    list-style: none;
  }
  li,
  .line {
    display: flex;
    align-items: center;
    gap: 0.25rem;
  }
  form.line,
  form .line {
    gap: 0.5rem;
  }
  .panel {
    display: grid;
    gap: 0.75rem;
  }
  .about,
  .status {
    color: var(--cusp-quiet);
    font-size: 0.8125rem;
    line-height: 1.4;
    text-wrap: pretty;
  }
  .status:empty {
    display: none;
  }
  .status {
    color: inherit;
  }
  .row {
    flex: 1;
    justify-content: start;
    min-width: 0;
    min-height: 2.5rem;
    padding: 0.25rem 0.5rem;
    border-color: transparent;
    font-weight: 500;
    text-align: start;
  }
  .row span {
    min-width: 0;
    overflow-wrap: anywhere;
  }
  .icon {
    flex: none;
    width: 2.25rem;
    min-height: 2.25rem;
    padding: 0;
    border-color: transparent;
    color: var(--cusp-quiet);
  }
  .icon svg {
    ${lineIcon}
  }
  input[type="text"] {
    font: inherit;
    flex: 1;
    width: 100%;
    min-width: 0;
    min-height: 2.25rem;
    padding: 0.25rem 0.625rem;
    border: 1px solid var(--cusp-field);
    border-radius: 8px;
    background: var(--cusp-card);
    color: inherit;
  }
`;
