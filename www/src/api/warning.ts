/** Warnings as data: a code for programs with typed details. The core gives no sentences; an element has its own. */
import type { Warning } from "./wire.js";

/** Every code with its details, generated from the core's own types. A code once published keeps its meaning. */
export type WarningDetails = { [W in Warning as W["code"]]: W extends { detail: infer Detail } ? Detail : null };

export type WarningCode = keyof WarningDetails;
