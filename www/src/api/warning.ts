/** Warnings as data: a code with typed details. The core has no sentences for them; the element does. */
import type { Warning } from "./wire.js";

/** Every code with its details, generated from the core's types. A published code keeps its meaning. */
export type WarningDetails = { [W in Warning as W["code"]]: W extends { detail: infer Detail } ? Detail : null };

export type WarningCode = keyof WarningDetails;
