/** Colours, which the page may set, and fonts of our elements. */
import { css } from "lit";

export const theme = css`
  :host {
    --cusp-font: system-ui, -apple-system, "Segoe UI", Roboto, "Helvetica Neue", "Noto Sans", Arial, sans-serif;
    --cusp-page: light-dark(#f4f5f7, #13151a);
    --cusp-card: light-dark(#ffffff, #1b1e25);
    --cusp-line: light-dark(#dfe3e8, #2e333d);
    --cusp-field: light-dark(#868f9c, #6b7480);
    --cusp-text: light-dark(#171b22, #e8eaee);
    --cusp-quiet: light-dark(#566070, #a2abb8);
    --cusp-accent: light-dark(#1f4f96, #8fb8f0);
    --cusp-accent-hover: light-dark(#173f7c, #aacbf7);
    --cusp-on-accent: light-dark(#ffffff, #10203a);
    --cusp-good: light-dark(#1a6e3c, #7fd0a0);
    --cusp-bad: light-dark(#a8212c, #ff9a9a);
    --cusp-bad-wash: light-dark(#fdf1f1, #2d1b1f);
    --cusp-note-wash: light-dark(#eef3fa, #1a2434);
    --cusp-focus: light-dark(#2f74d6, #9ac4ff);
    --cusp-chart-ink: light-dark(#171b22, #f4f6fa);
    --cusp-chart-paper: light-dark(#ffffff, #1b1e25);
    --cusp-chart-seam: rgb(16 19 26 / 0.22);
    --cusp-radius: 12px;

    display: block;
    container-type: inline-size;
    color: var(--cusp-text);
    font: 16px/1.5 var(--cusp-font);
    text-align: start;
  }
`;
