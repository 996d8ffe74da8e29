/** Replaces lit's types in the package's declarations: lit is bundled, so it need not be installed. */
export declare class LitElement extends HTMLElement {
  /** Resolves when the element shows its current properties. */
  readonly updateComplete: Promise<boolean>;
  connectedCallback(): void;
  disconnectedCallback(): void;
  requestUpdate(): void;
  protected willUpdate(changed: PropertyValues): void;
  protected firstUpdated(changed: PropertyValues): void;
  protected updated(changed: PropertyValues): void;
  protected render(): unknown;
}
export type PropertyValues<T = unknown> = Map<keyof T | PropertyKey, unknown>;
export interface TemplateResult {
  readonly strings: TemplateStringsArray;
}
export type CSSResult = CSSStyleSheet | { readonly cssText: string };
export type CSSResultGroup = CSSResult | CSSResultGroup[];
export declare const nothing: unique symbol;
export interface PropertyDeclaration {
  readonly attribute?: boolean | string;
  readonly state?: boolean;
}
