/** Sentences by code, made from the details of an error, a warning or a finding. */
import { say, type Spoken } from "./messages.js";

/** A sentence for each code, or several between which the detail decides. The compiler names a missing code. */
export type Sentences<Code extends PropertyKey> = Readonly<Record<Code, string | Readonly<Record<string, string>>>>;

type Text<Message> = Message extends string ? Message : Message[keyof Message];
type Named<Message> = Message extends `${string}{${infer Inside}}${infer Rest}` ? Field<Inside> | Named<Rest> : never;
type Field<Inside> = Inside extends `${infer Name}${"|" | "."}${string}` ? Field<Name> : Inside;
type Key<Detail> = Detail extends unknown ? keyof Detail : never;

/** Fields that a message names, and its detail does not have. */
type Strange<Message, Detail> = Exclude<Named<Text<Message>>, Key<Detail>>;

/**
 * The choice among the sentences of a code, by its detail, the same in every language. The compiler names a code whose sentence names a
 * field that the detail does not have.
 */
export type Cases<English, Details> = {
  readonly [Code in keyof English & keyof Details as [English[Code], Strange<English[Code], Details[Code]>] extends [string, never] ? never : Code]: [
    Strange<English[Code], Details[Code]>,
  ] extends [never]
    ? (detail: Details[Code]) => keyof English[Code]
    : { noSuchField: Strange<English[Code], Details[Code]> };
};

/** Returns a function that says a code in a language. `prefix` is that of the sentences' keys. */
export function sayer<English, Details>(prefix: string, cases: Cases<English, Details>) {
  return <Code extends keyof Details & string>(code: Code, detail: Details[Code], language: Spoken, more?: object): string => {
    const choose = (cases as unknown as Readonly<Record<string, (detail: Details[Code]) => string>>)[code];
    const key = choose === undefined ? code : `${code}.${choose(detail)}`;
    return say(`${prefix}.${key}`, { ...(detail as object), ...more }, language);
  };
}
