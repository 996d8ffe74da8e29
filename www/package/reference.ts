/** The reference of the element and of the slicer, from the comments of their sources: `REFERENCE.md` in the package. */
import { readFile } from "node:fs/promises";
import { FACTS, FORMATS } from "../src/api/facts.js";
import { PROPERTIES, READ_ONLY, SETTING_NAMES, type PropertyName } from "../src/element/properties.js";
import { METRIC_NAMES } from "../src/element/state/metric.js";
import { PANELS } from "../src/element/state/panel-names.js";
import { LANGUAGES } from "../src/texts/index.js";

interface Member {
  name: string;
  /** The declaration as in the source, up to its body. */
  declared: string;
  comment: string;
}

/** A comment, and the first line of what follows it: a property, a method or an event. */
const MEMBER = /^ {2}\/\*\*((?:(?!\*\/)[\s\S])*)\*\/\n {2}(?:(?:readonly|declare|get|async|static|abstract) )*"?([a-z][\w-]*)"?(.*)$/gm;

function membersOf(source: string): Member[] {
  return [...source.matchAll(MEMBER)].map(([, comment = "", name = "", rest = ""]) => ({
    name,
    declared: rest.replace(/^\??/, "").replace(/ = [^,)]*;$/, "").replace(/(;| \{)$/, "").trim(),
    comment: comment.replaceAll(/\n\s*\* ?/g, "\n").replaceAll(/\{@link (.*?)\}/g, "`$1`").replaceAll("@throws", "Rejects with").replaceAll(/@param (\w+)/g, "`$1`:").replaceAll(/\s+/g, " ").trim(),
  }));
}

const row = (...cells: readonly string[]): string => `| ${cells.map((cell) => cell.replaceAll("|", "\\|")).join(" | ")} |`;

const table = (head: readonly string[], rows: readonly string[]): string => [row(...head), row(...head.map(() => "---")), ...rows].join("\n");

const code = (text: string): string => (text === "" ? "" : `\`${text}\``);

const values = (names: readonly string[]): string => names.map(code).join(", ");

/** Values and defaults that are lists and numbers of the core and of the element. */
const KNOWN: Partial<Record<PropertyName, string>> = {
  format: values(FORMATS),
  metric: values(METRIC_NAMES),
  panels: values(PANELS),
  fixed: values(SETTING_NAMES),
  locale: values(LANGUAGES),
  layerMin: `Default: ${FACTS.defaults.layer_min_mm}`,
  layerMax: `Default: ${FACTS.defaults.layer_max_mm}`,
  tolerance: `Defaults: ${FACTS.metrics.map(({ name, tolerance }) => `${tolerance} (${name})`).join(", ")}`,
};

const read = (path: string): Promise<string> => readFile(new URL(`../src/${path}`, import.meta.url), "utf8");

/** Members of an interface, or of all classes of a source. */
async function declared(path: string, start = ""): Promise<Member[]> {
  const source = await read(path);
  const from = source.slice(source.indexOf(start));
  return membersOf(start === "" ? from : from.slice(0, from.indexOf("\n}"))).filter(({ comment }) => !comment.startsWith("@internal"));
}

export async function reference(): Promise<string> {
  const classes = [...(await declared("element/settable-element.ts")), ...(await declared("element/slicer-element.ts"))];
  const property = (name: PropertyName | (typeof READ_ONLY)[number]): string => {
    const it = classes.find((member) => member.name === name);
    if (it === undefined) throw new Error(`the property ${name} has no comment`);
    const attribute = name in PROPERTIES ? (PROPERTIES[name as PropertyName]?.attribute ?? "") : name === "state" ? name : "";
    const known = KNOWN[name as PropertyName];
    const type = it.declared.replace(/^\(\)/, "").replace(/^: /, "");
    return row(code(attribute), code(name), code(type), known === undefined ? it.comment : `${it.comment} ${known}.`);
  };
  const methods = classes.filter(({ name, declared: rest }) => rest.startsWith("(") && !(name in PROPERTIES) && !READ_ONLY.some((it) => it === name));
  const signature = ({ name, declared: rest, comment }: Member): string => row(code(`${name}${rest}`), comment);
  const events = await declared("element/events.ts", "export interface CuspSlicerEvents");
  return `# Reference

## Properties of \`<cusp-slicer>\`

${table(["attribute", "property", "type", ""], (Object.keys(PROPERTIES) as PropertyName[]).map(property))}

Read-only:

${table(["attribute", "property", "type", ""], READ_ONLY.map(property))}

## Methods

${table(["method", ""], methods.map(signature))}

## Events

${table(["event", "type", ""], events.map(({ name, declared: type, comment }) => row(code(name), code(type.replace(/^: /, "")), comment)))}

## The headless slicer

${table(["method", ""], (await declared("api/index.ts", "export interface Slicer ")).map(signature))}

The declarations in \`types/\` define all types named here.
`;
}
