/** The findings panel, bound to a session. Its code is fetched when a user first opens it. */
import { html, nothing, type TemplateResult } from "lit";
import type { Facts } from "./facts.js";
import type { Fix } from "./state/fixes.js";
import { FetchedPanel } from "./parts/part.js";

const findingsCode = new FetchedPanel("findings", () => import("./panels/findings-panel.js"), ({ defineFindings }) => defineFindings());

export function findingsPanel({ element, session, language, panels }: Facts): TemplateResult | typeof nothing {
  if (!findingsCode.isThere) return findingsCode.instead(element, language);
  const { checks, settings, plate } = session;
  return html`<cusp-findings
    .checks=${checks}
    .session=${session}
    .verdict=${checks.last?.verdict ?? null}
    .models=${checks.models}
    .names=${plate.entries.map(({ model }) => model.name)}
    .isCurrent=${checks.isCurrent}
    .error=${checks.error}
    .chosen=${checks.chosen}
    .hasView=${panels.has("view")}
    .showsWalls=${checks.showsWalls}
    .wall_mm=${checks.wall_mm}
    .metric=${settings.metric}
    .settings=${settings}
    .fixed=${session.fixed}
    .canOrient=${panels.has("orientation") && session.orientation.isPossible}
    @cusp-fix=${({ detail: { change } }: CustomEvent<Fix>) => (change === null ? void session.orientation.start() : session.change(change))}
    .language=${language}
  ></cusp-findings>`;
}
