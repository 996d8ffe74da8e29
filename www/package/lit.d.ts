/** What declarations of the package say of lit, which is inside it and not to be installed beside it. */
export declare class LitElement extends HTMLElement {
  /** Resolves when what is shown agrees with the properties. */
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
