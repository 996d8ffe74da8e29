/** The icon above the drop zone: a vase in layers. */
import { html } from "lit";

export const layersPicture = html`<svg class="layers-picture" viewBox="0 0 64 56" width="80" height="70" aria-hidden="true">
  <rect x="22" y="2" width="20" height="3" fill="#f3d685" />
  <rect x="17" y="6" width="30" height="3" fill="#c3d08c" />
  <rect x="13" y="10" width="38" height="4" fill="#88c2a0" />
  <rect x="11" y="15" width="42" height="6" fill="#50a5a8" />
  <rect x="10" y="22" width="44" height="8" fill="#36769f" />
  <rect x="10" y="31" width="44" height="9" fill="#384080" />
  <rect x="12" y="41" width="40" height="6" fill="#36769f" />
  <rect x="16" y="48" width="32" height="3" fill="#88c2a0" />
  <rect x="22" y="52" width="20" height="2" fill="#f3d685" />
</svg>`;
