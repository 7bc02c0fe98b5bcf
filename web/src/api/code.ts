// A controller of a result as source text.
import { getText } from "./client.ts";
import type { TextFile } from "./client.ts";

export type Language = "st" | "c" | "python";

export interface CodeQuestion {
  job: string;
  /** Of the entry in the result. */
  index: number;
  language: Language;
  sample_time?: number | undefined;
  u_min?: number | undefined;
  u_max?: number | undefined;
}

export function codePath({ job, index, ...question }: CodeQuestion): string {
  const query = new URLSearchParams();
  for (const [name, value] of Object.entries(question)) if (value !== undefined) query.set(name, String(value));
  return `v1/jobs/${encodeURIComponent(job)}/controllers/${index}/code?${query.toString()}`;
}

export const getCode = (question: CodeQuestion): Promise<TextFile> => getText(codePath(question));
