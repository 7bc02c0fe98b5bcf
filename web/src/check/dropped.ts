// Dropped files and folders, and files as texts.
import { decoded } from "../api/client.ts";
import { previewFile } from "../api/records.ts";

const READ = /\.(csv|tsv|txt)$/i;

/** Files that were dropped, also those in folders; `others`: how many have another ending. */
export interface Dropped {
  files: File[];
  others: number;
}

const isFile = (entry: FileSystemEntry): entry is FileSystemFileEntry => entry.isFile;
const isFolder = (entry: FileSystemEntry): entry is FileSystemDirectoryEntry => entry.isDirectory;

/** A folder lists its entries in parts, and ends with an empty one. */
async function entriesOf(folder: FileSystemDirectoryEntry): Promise<FileSystemEntry[]> {
  const reader = folder.createReader();
  const all: FileSystemEntry[] = [];
  for (;;) {
    const part = await new Promise<FileSystemEntry[]>((give, fail) => reader.readEntries(give, fail));
    if (part.length === 0) return all;
    all.push(...part);
  }
}

async function filesIn(entry: FileSystemEntry): Promise<File[]> {
  if (isFile(entry)) return [await new Promise<File>((give, fail) => entry.file(give, fail))];
  const inside = isFolder(entry) ? await entriesOf(entry) : [];
  return (await Promise.all(inside.map(filesIn))).flat();
}

/** Files of a list, in the order of their names. */
export function chosen(list: Iterable<File>): Dropped {
  const all = [...list];
  const files = all.filter(({ name }) => READ.test(name));
  files.sort((a, b) => a.name.localeCompare(b.name, undefined, { numeric: true }));
  return { files, others: all.length - files.length };
}

/** To be called while the drop is handled: its items are gone afterwards. */
export function dropped(transfer: DataTransfer): Promise<Dropped> {
  const entries = [...transfer.items].map((item) => item.webkitGetAsEntry());
  const plain = [...transfer.files];
  if (!entries.some((entry) => entry?.isDirectory)) return Promise.resolve(chosen(plain));
  return Promise.all(entries.map((entry) => (entry ? filesIn(entry) : []))).then((lists) => chosen(lists.flat()));
}

/** The service finds the encoding of a file that is not UTF-8. */
export async function textOf(file: File): Promise<string> {
  const bytes = await file.arrayBuffer();
  try {
    new TextDecoder("utf-8", { fatal: true }).decode(bytes);
  } catch {
    return (await previewFile(file)).text;
  }
  return decoded(bytes, "utf-8");
}
