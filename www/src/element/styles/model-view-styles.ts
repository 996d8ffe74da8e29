import { css } from "lit";
import { filling } from "./shared.js";

export const modelViewStyles = css`
  ${filling}
  :host {
    position: relative;
  }
  /* Room for the toolbar until it is there. */
  .bar-place {
    position: var(--cusp-bar-position, static);
    flex: none;
    height: 2.75rem;
    margin-bottom: 0.75rem;
  }
  /* Their bases make the height where the parent has none, and shrink where it has one: the tools first. */
  .stage {
    flex: 1 1 auto;
    display: flex;
    flex-direction: column;
    gap: 0.75rem;
    min-height: 0;
  }
  .view {
    flex: 1 1 28rem;
    display: grid;
    min-width: 0;
    min-height: min(22rem, 65%);
  }
  .beside {
    flex: 0 999 auto;
    display: grid;
    grid-template: minmax(0, 1fr) / minmax(0, 1fr);
    min-height: 9rem;
  }
  /* Wide enough for both: the tools scroll at the view's side, and make nothing taller. */
  @container (min-width: 36rem) {
    .stage {
      flex: 1 1 28rem;
      flex-direction: row;
    }
    .view {
      flex: 1;
      min-height: 0;
    }
    .beside {
      flex: none;
      position: relative;
      width: 16rem;
      min-height: 0;
      margin-top: var(--cusp-view-head, 0px);
    }
    .beside > section {
      position: absolute;
      inset: 0;
    }
  }
`;
