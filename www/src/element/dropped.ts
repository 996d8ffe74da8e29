/** Reads a drop: files, the models in folders, or a link. */
import { said, SlicerError } from "../api/error.js";
import { isNamedAsModel } from "./state/choice.js";

export interface DropHost {
  open(files: readonly File[]): void;
  /** Called if nothing of the drop can be opened; `name` is that of the folder or link. */
  refuse(error: SlicerError, name: string): void;
}

/** Maximum number of folder entries to read; a larger drop is not just models. */
const MOST_ENTRIES = 10_000;

/** Reads a drop. Must be called during the event, after which the browser empties the transfer. */
export function takeDrop(transfer: DataTransfer | null, { open, refuse }: DropHost): void {
  if (transfer === null) return;
  const items = [...transfer.items].map((item) => ({ entry: item.webkitGetAsEntry(), file: item.getAsFile() }));
  const folders = items.map(({ entry }) => entry).filter(isFolder);
  const [folder] = folders;
  if (folder !== undefined) {
    const beside = items.flatMap(({ entry, file }) => (isFolder(entry) || file === null ? [] : [file]));
    void modelsIn(folders).then(
      (models) => {
        if (beside.length + models.length > 0) open([...beside, ...models]);
        else refuse(new SlicerError("folder-without-model", "the folder holds no model"), folder.name);
      },
      (cause: unknown) => refuse(new SlicerError("file-unreadable", said(cause)), folder.name),
    );
    return;
  }
  const files = [...transfer.files];
  if (files.length > 0) return open(files);
  const [link] = transfer.getData("text/uri-list").split(/\r?\n/);
  if (link === undefined || !URL.canParse(link)) return;
  const { host, protocol } = new URL(link);
  refuse(new SlicerError("dropped-link", "a link was dropped"), host || protocol);
}

/** All models in these folders and their subfolders, sorted by name within each. */
async function modelsIn(folders: readonly FileSystemDirectoryEntry[]): Promise<File[]> {
  const files: File[] = [];
  const waiting = [...folders];
  let seen = 0;
  for (const folder of waiting) {
    const entries = await entriesOf(folder);
    seen += entries.length;
    if (seen > MOST_ENTRIES) break;
    for (const entry of entries.sort((a, b) => COLLATOR.compare(a.name, b.name))) {
      if (isFolder(entry)) waiting.push(entry);
      else if (entry.name.includes(".") && isNamedAsModel(entry.name)) files.push(await fileOf(entry as FileSystemFileEntry));
    }
  }
  return files;
}

const isFolder = (entry: FileSystemEntry | null): entry is FileSystemDirectoryEntry => entry?.isDirectory === true;

const COLLATOR = new Intl.Collator(undefined, { numeric: true });

/** Browsers return entries in batches, and an empty batch at the end. */
async function entriesOf(folder: FileSystemDirectoryEntry): Promise<FileSystemEntry[]> {
  const reader = folder.createReader();
  const entries: FileSystemEntry[] = [];
  for (;;) {
    const some = await new Promise<FileSystemEntry[]>((resolve, reject) => reader.readEntries(resolve, reject));
    if (some.length === 0 || entries.length > MOST_ENTRIES) return entries;
    entries.push(...some);
  }
}

const fileOf = (entry: FileSystemFileEntry): Promise<File> => new Promise((resolve, reject) => entry.file(resolve, reject));
