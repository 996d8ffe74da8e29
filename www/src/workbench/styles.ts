/** Styles of the workbench. It fills its host, which has a definite height; overflow scrolls inside the panels. */
import { css } from "lit";
import { lineIcon } from "../element/styles/shared.js";

export const workbenchStyles = css`
  :host {
    height: 100%;
    --cusp-radius: 10px;
    /* Nothing scrolls below the view: one finger turns it. */
    --cusp-view-touch: none;
    /* The steps and the tabs say it. */
    --cusp-title-position: absolute;
    --cusp-title-clip: inset(50%);
    --cusp-orientation-hint: none;
  }
  :host([hidden]) {
    display: none;
  }
  h2 {
    font-size: 1rem;
    font-weight: 600;
    overflow-wrap: anywhere;
  }
  /* Focused by script alone, so that screen readers read on from here: a ring would only puzzle. */
  h2:focus {
    outline: none;
  }
  .bench {
    display: grid;
    height: 100%;
    min-height: 0;
    border-top: 1px solid var(--cusp-line);
  }
  /* The view has at least three fifths of the width. */
  .bench.wide {
    grid-template: minmax(0, 1fr) / clamp(14.75rem, 20%, 19rem) minmax(0, 1fr) clamp(14.75rem, 20%, 19rem);
  }
  .bench.empty {
    grid-template: minmax(0, 1fr) / minmax(0, 1fr);
  }
  .bench.narrow {
    grid-template: minmax(0, 1fr) auto / minmax(0, 1fr);
  }
  /* On a small screen, too, the model is seen above the sheet. */
  .bench.narrow:has(.sheet) {
    grid-template-rows: minmax(min(17rem, 46%), 1fr) minmax(0, 1fr) auto;
  }
  /* In what is left of the view, the scale would hide the model, and the switches would take its room. */
  .bench.narrow:has(.sheet) cusp-model {
    --cusp-view-legend: none;
    --cusp-view-switches: none;
  }
  .dragging {
    outline: 3px dashed var(--cusp-accent);
    outline-offset: -3px;
    border-radius: var(--cusp-radius);
  }
  .card {
    padding: 0.75rem;
  }

  .side {
    display: flex;
    flex-direction: column;
    min-width: 0;
    min-height: 0;
    background: var(--cusp-card);
  }
  .choices {
    border-inline-end: 1px solid var(--cusp-line);
  }
  .answers {
    border-inline-start: 1px solid var(--cusp-line);
  }
  .side .card {
    border: 0;
    border-radius: 0;
  }
  .answers .tabbed {
    border-top: 1px solid var(--cusp-line);
  }
  .tabbed {
    display: flex;
    flex: 1 1 14rem;
    flex-direction: column;
    min-height: 0;
    padding: 0;
  }
  .tab-row {
    display: flex;
    align-items: center;
    justify-content: space-between;
    gap: 0.5rem;
    min-height: 2.75rem;
    padding: 0.25rem 0.5rem 0.25rem 0.75rem;
    border-bottom: 1px solid var(--cusp-line);
  }
  .tabs {
    display: flex;
    gap: 0.75rem;
    align-self: stretch;
  }
  .tabs button {
    padding: 0.25rem 0;
    border: 0;
    border-block: 2px solid transparent;
    border-radius: 0;
    color: var(--cusp-quiet);
    font-size: 0.875rem;
  }
  .tabs button[aria-selected="true"] {
    border-bottom-color: var(--cusp-accent);
    color: var(--cusp-text);
  }
  .panel {
    flex: 1;
    min-height: 0;
    padding: 0.75rem;
    overflow: hidden auto;
    overscroll-behavior: contain;
    scrollbar-width: thin;
  }
  .panel:focus-visible {
    outline-offset: -3px;
  }
  .path {
    grid-column: 1 / -1;
    flex: none;
    min-width: 0;
    border-bottom: 1px solid var(--cusp-line);
  }
  .path ol {
    margin: 0;
    padding: 0;
    list-style: none;
  }
  .path button {
    display: flex;
    justify-content: start;
    width: 100%;
    min-height: 2.125rem;
    padding: 0.125rem 0.75rem;
    border: 0;
    border-inline: 3px solid transparent;
    border-radius: 0;
    color: var(--cusp-quiet);
    font-size: 0.875rem;
    text-align: start;
  }
  .path button[aria-current] {
    border-inline-start-color: var(--cusp-accent);
    background: var(--cusp-note-wash);
    color: var(--cusp-text);
  }
  /* It would reach over the edge of the stage. */
  .path button:focus-visible {
    outline-offset: -3px;
  }
  /* States are a column of their own: nothing moves when one changes. */
  .path .name {
    flex: 0 0 5.25rem;
    white-space: nowrap;
  }
  .path .state {
    flex: 1;
    overflow: hidden;
    text-overflow: ellipsis;
    white-space: nowrap;
    color: var(--cusp-quiet);
    font-size: 0.75rem;
    font-weight: 400;
    font-variant-numeric: tabular-nums;
  }
  .badge {
    flex: none;
    display: grid;
    place-items: center;
    width: 1.25rem;
    height: 1.25rem;
    border: 1px solid currentColor;
    border-radius: 50%;
    font-size: 0.75rem;
    line-height: 1;
  }
  .badge svg {
    ${lineIcon}
    width: 0.875rem;
    height: 0.875rem;
    stroke-width: 2.5;
  }
  .badge.done {
    color: var(--cusp-good);
  }
  .badge.look {
    color: var(--cusp-accent);
  }
  .badge.wrong {
    color: var(--cusp-bad);
  }
  .path [aria-current] .badge {
    border-color: var(--cusp-accent);
    background: var(--cusp-accent);
    color: var(--cusp-on-accent);
  }
  .narrow .path ol {
    display: flex;
    flex-wrap: wrap;
  }
  .narrow .path li {
    flex: 1 0 auto;
    max-width: 100%;
  }
  .narrow .path .name {
    flex: none;
  }
  .narrow .path button {
    flex-direction: column;
    justify-content: center;
    gap: 0.125rem;
    min-height: 2.75rem;
    padding: 0.25rem 0.125rem;
    border-inline: 0;
    border-block: 2px solid transparent;
    font-size: 0.75rem;
  }
  .narrow .path button[aria-current] {
    border-bottom-color: var(--cusp-accent);
    background: none;
  }
  .panel > .hint {
    margin-bottom: 0.625rem;
    font-size: 0.8125rem;
    line-height: 1.4;
    text-wrap: pretty;
  }
  .prepare {
    display: grid;
    gap: 0.25rem;
    font-size: 0.8125rem;
  }
  .tab-row .prepare button {
    padding-inline: 0.5rem;
    font-size: 0.8125rem;
  }
  .panel > .prepare {
    margin-block: 0 0.875rem;
  }
  .by-hand,
  .missing {
    margin-top: 0.875rem;
  }
  .hint + .by-hand {
    margin-block: 0 0.75rem;
  }
  .missing {
    color: var(--cusp-bad);
    font-size: 0.875rem;
  }
  .step-foot {
    display: flex;
    justify-content: space-between;
    gap: 0.5rem;
    padding: 0.5rem 0.75rem;
    border-top: 1px solid var(--cusp-line);
  }
  .step-foot .next {
    margin-inline-start: auto;
  }
  /* The last step leads on to no other: its fields have the room. */
  .panel .step-foot {
    padding: 0.875rem 0 0;
    border: 0;
  }
  .steps {
    display: flex;
  }
  .steps button {
    min-width: 1.625rem;
    padding: 0;
    border: 0;
  }
  .steps svg {
    ${lineIcon}
  }

  cusp-chart {
    height: 100%;
  }
  cusp-quality {
    height: auto;
  }
  /* The steps keep their place, however many models there are. */
  .side .model {
    flex: 0 1 auto;
    min-height: 5rem;
    max-height: 40%;
    padding-bottom: 0.5rem;
    overflow: hidden auto;
    scrollbar-width: thin;
  }
  /* Facts in as few lines as they take, and the buttons side by side. */
  .side .model,
  .side .model dl,
  .side .model dl > div {
    display: flex;
    flex-wrap: wrap;
    align-items: center;
    gap: 0.25rem 0.5rem;
  }
  .side .model:has(cusp-plate) {
    min-height: 14rem;
    max-height: 50%;
  }
  .side .model > :is(h2, dl, .files, cusp-plate, p) {
    flex: 1 0 100%;
    min-width: 0;
    max-width: 100%;
    margin: 0;
  }
  .side .model dl {
    color: var(--cusp-quiet);
    font-size: 0.8125rem;
  }
  .side .model dl > div:not(:nth-child(2)) dt {
    position: absolute;
    clip-path: inset(50%);
  }
  .side .model :is(.open-other, .copies-row) {
    display: contents;
  }
  .side .model .button.small {
    margin: 0;
    padding-inline: 0.375rem;
    font-size: 0.8125rem;
  }
  .side .model .copies-row .button {
    order: 1;
  }
  .side .model .copies-row > :not(.button),
  .side .model slot,
  .side .model cusp-plate {
    order: 2;
  }
  .side .model .step {
    min-width: 1.75rem;
  }
  .sheet .model dl {
    display: flex;
    gap: 0.25rem 1.25rem;
    margin-top: 0.375rem;
    font-size: 0.875rem;
  }
  .files,
  .open-other {
    display: flex;
    flex-wrap: wrap;
    align-items: center;
    gap: 0.5rem;
    margin-top: 0.5rem;
  }
  .open-other label:has(:focus-visible) {
    outline: 3px solid var(--cusp-focus);
    outline-offset: 2px;
  }

  .stage {
    position: relative;
    display: grid;
    grid-template: auto minmax(0, 1fr) / minmax(0, 1fr) auto;
    min-width: 0;
    min-height: 0;
    overflow: hidden;
  }
  /* The slider and the profile lie over the view's edge, and the model stands in the middle of the rest. */
  .wide .stage {
    --strip: 9.5rem;
    --cusp-view-aside: 12rem;
    --cusp-view-head: 3rem;
    --cusp-bar-position: absolute;
    grid-template: minmax(0, 1fr) / minmax(0, 1fr) 2.5rem var(--strip);
  }
  .wide .stage:has(cusp-model[editing]) {
    --cusp-view-aside: 0px;
  }
  .wide .view:has(cusp-model[editing]) ~ :not(.overlay) {
    visibility: hidden;
  }
  .stage > :not(.path) {
    grid-row: -2;
  }
  .empty .stage {
    display: block;
  }
  .view {
    grid-column: 1 / -1;
    min-width: 0;
    min-height: 0;
  }
  .narrow .view {
    grid-column: 1;
  }
  cusp-layer-slider {
    grid-column: 2;
  }
  .profile {
    z-index: 1;
    grid-column: 3;
    min-width: 0;
    min-height: 0;
    padding: 0.625rem 0.5rem 0.625rem 0;
    background: linear-gradient(to right, transparent, color-mix(in srgb, var(--cusp-card) 70%, transparent) 2.5rem);
  }
  .stage > .model-name {
    z-index: 1;
    grid-column: 1;
    place-self: start;
    max-width: 55%;
    margin: 3.5rem 0 0 0.75rem;
    overflow: hidden;
    font-size: 0.875rem;
    text-overflow: ellipsis;
    white-space: nowrap;
    pointer-events: none;
  }

  .start {
    display: flex;
    align-items: center;
    justify-content: center;
    gap: 2rem 4rem;
    height: 100%;
    max-width: 80rem;
    margin: auto;
    padding: 1.5rem clamp(1rem, 4vw, 3rem);
    overflow-y: auto;
  }
  .welcome {
    flex: 0 1 30rem;
    display: grid;
    grid-template-columns: minmax(0, 1fr);
    gap: 1.25rem;
    max-height: 100%;
    min-width: 0;
  }
  .narrow .start {
    flex-direction: column;
    align-items: stretch;
    justify-content: start;
  }
  .narrow .welcome {
    flex: none;
    max-height: none;
  }
  .opening {
    display: grid;
    place-items: center;
    height: 100%;
    font-size: 1.375rem;
  }

  /* What lies over the view takes no room from it, so that nothing moves when it comes and goes. */
  .overlay {
    position: absolute;
    z-index: 2;
    inset: auto 0 0.75rem;
    display: grid;
    justify-items: center;
    gap: 0.5rem;
    max-height: calc(100% - 1.5rem);
    padding-inline: 0.75rem;
    pointer-events: none;
  }
  .wide .overlay {
    padding-inline-end: calc(0.75rem + var(--cusp-view-aside, 0px));
  }
  .overlay > * {
    width: 100%;
    max-width: 34rem;
    margin: 0;
    box-shadow: 0 6px 24px rgb(0 0 0 / 0.2);
    pointer-events: auto;
  }
  .overlay .message {
    background-color: var(--cusp-card);
    background-image: linear-gradient(var(--cusp-bad-wash), var(--cusp-bad-wash));
    max-height: 14rem;
    overflow-y: auto;
  }
  .overlay .notice {
    background-image: linear-gradient(var(--cusp-note-wash), var(--cusp-note-wash));
  }
  .saved {
    display: grid;
    gap: 0.375rem;
    font-size: 0.875rem;
    overflow-wrap: anywhere;
  }
  .saved .tools {
    display: flex;
    flex-wrap: wrap;
    justify-content: end;
    gap: 0.5rem;
  }
  /* Appears after a delay, so that quick plans do not flash. */
  .progressing.quick {
    animation: appear 150ms 250ms both;
  }
  @keyframes appear {
    from {
      opacity: 0;
    }
  }

  /* Its height is its own, whatever the result has to say: nothing below it moves. */
  .plan {
    flex: 0 0 56%;
    overflow: hidden auto;
    scrollbar-width: thin;
  }
  .plan .figure {
    display: grid;
    gap: 0;
  }
  .plan .count {
    font-size: 2.25rem;
  }
  .plan .amount {
    font-size: 1rem;
  }
  .plan .gain {
    min-block-size: 2lh;
    font-size: 0.875rem;
  }
  .plan .replanning {
    opacity: 0.6;
    transition: opacity 150ms 250ms;
  }
  .plan table {
    font-size: 0.8125rem;
  }
  .plan :is(th, td) {
    white-space: normal;
  }
  .exposure {
    margin-top: 0.25rem;
  }
  .download {
    width: 100%;
    padding-inline: 0.5rem;
    margin-block: 0.75rem 0.5rem;
  }
  .findings {
    display: flex;
    justify-content: start;
    align-items: center;
    min-height: 1.75rem;
    padding: 0;
    font-size: 0.875rem;
    text-align: start;
  }
  .findings.ok {
    color: var(--cusp-good);
  }
  .findings.reject {
    color: var(--cusp-bad);
  }
  .plan #file {
    padding: 0;
    font-size: 0.8125rem;
  }
  .earlier {
    padding: 0.5rem 1rem;
    border: 1px solid var(--cusp-line);
    border-radius: 8px;
    background: var(--cusp-note-wash);
    font-size: 0.875rem;
  }
  .warning {
    margin-top: 0.625rem;
    padding-inline-start: 0.75rem;
    border-inline-start: 3px solid #e0a030;
    font-size: 0.875rem;
  }
  details.quiet {
    margin-top: 0.625rem;
  }

  .narrow cusp-layer-slider {
    margin-block: 2.5rem 3rem;
  }
  .bar {
    display: grid;
    border-top: 1px solid var(--cusp-line);
    background: var(--cusp-card);
    padding-bottom: env(safe-area-inset-bottom);
  }
  /* The words of the button break before those of the figures. */
  .bar-result {
    display: grid;
    grid-template-columns: minmax(min-content, max-content) minmax(min-content, 1fr);
    align-items: center;
    gap: 0.75rem;
    padding: 0.5rem 0.75rem;
  }
  .bar-figures {
    display: grid;
    gap: 0;
    justify-items: start;
    padding: 0.125rem 0.5rem;
    border-color: transparent;
    text-align: start;
    font-variant-numeric: tabular-nums;
  }
  .bar-figures span {
    font-size: 0.875rem;
    font-weight: 400;
  }
  .bar .download {
    justify-self: end;
    width: auto;
    margin: 0;
    padding-inline: 0.875rem;
  }
  .bar-panels {
    display: flex;
    flex-wrap: wrap;
  }
  .bar-panels button {
    flex: auto;
    padding: 0.25rem 0.125rem;
    border: 0;
    border-top: 2px solid transparent;
    border-radius: 0;
    font-size: 0.75rem;
  }
  .bar-panels button[aria-expanded="true"] {
    border-top-color: var(--cusp-accent);
    color: var(--cusp-accent);
  }
  /* In the flow, so that the view above shows the whole model in what is left. */
  .sheet {
    display: flex;
    flex-direction: column;
    min-height: 0;
    border-top: 1px solid var(--cusp-line);
    background: var(--cusp-card);
  }
  /* Instead of the one in the view above. */
  .sheet cusp-findings {
    --cusp-findings-legend: block;
  }
  .sheet .close {
    margin-inline-start: auto;
  }
  .sheet .model {
    padding: 0;
    border: 0;
    margin-bottom: 1rem;
  }
  @container (max-width: 22.49rem) {
    .bar-result {
      padding-block: 0.25rem;
    }
    .bar-figures {
      padding-inline: 0;
    }
    .bar .download {
      padding-inline: 0.5rem;
      font-size: 0.875rem;
    }
  }
  /* Between phone and desktop, a sheet stands at the side and leaves the view its height. */
  @container (min-width: 40rem) {
    .bench.narrow:has(.sheet) {
      grid-template: minmax(0, 1fr) auto / minmax(0, 1fr) 21rem;
    }
    .bench.narrow:has(.sheet) cusp-model {
      --cusp-view-legend: block;
      --cusp-view-switches: flex;
    }
    .sheet cusp-findings {
      --cusp-findings-legend: none;
    }
    .narrow .sheet {
      border-top: 0;
      border-inline-start: 1px solid var(--cusp-line);
    }
    .narrow .bar {
      grid-column: 1 / -1;
      grid-template-columns: auto minmax(0, 1fr);
      align-items: center;
    }
  }
  @media (forced-colors: active) {
    /* Here no border is transparent. */
    .tabs button,
    .path button,
    .bar-panels button,
    .bar-figures {
      border-color: Canvas;
    }
    .path [aria-current] .badge {
      forced-color-adjust: none;
      border-color: Highlight;
      background: Highlight;
      color: HighlightText;
    }
    .tabs button[aria-selected="true"],
    .path button[aria-current],
    .bar-panels button[aria-expanded="true"] {
      border-color: Canvas;
      border-bottom-color: Highlight;
      color: Highlight;
    }
  }
`;
