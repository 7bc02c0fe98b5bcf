// Preview of a file of a recorded test: the service reads it before anything is computed.
import { call } from "./client.ts";
import type { Health, IdentifiedController, Preview, RecordedTest } from "./types.ts";

/** The problems' pointers are those of a request with a record. */
const previewed = (data: unknown): Preview => {
  const preview = data as Preview;
  return {
    ...preview,
    problems: preview.problems.map(({ pointer, detail }) => ({ pointer: `/record/${pointer}`, detail })),
  };
};

/** Bytes of the largest body that the service takes; infinite if the service does not state the limit, which its
    refusal then shows. */
export async function maxBodyBytes(): Promise<number> {
  const health = await call("GET", "healthz").catch(() => null);
  return (health?.data as Health | undefined)?.max_body_bytes ?? Infinity;
}

export interface FileRead {
  /** Decoded with the encoding that the service found. */
  text: string;
  preview: Preview;
}

/** The file is sent unchanged: the service finds its encoding. */
export async function previewFile(file: Blob): Promise<FileRead> {
  const [{ data }, bytes] = await Promise.all([
    call("POST", "v1/records/preview", file, { "Content-Type": "text/csv" }),
    file.arrayBuffer(),
  ]);
  const preview = previewed(data);
  return { text: new TextDecoder(preview.encoding).decode(bytes), preview };
}

/** A record's text with the choices for reading it. */
export async function previewRecord({ csv, columns, dt, time_unit, u_step, run }: RecordedTest): Promise<Preview> {
  const chosen = Object.entries({ columns, dt, time_unit, u_step, run }).filter(([, value]) => value !== undefined);
  const request = { csv, ...Object.fromEntries(chosen) };
  return previewed((await call("POST", "v1/records/preview", request)).data);
}

/** Today's settings in the record of a loop in automatic; a refusal says why there are none. */
export async function controllerInRecord(record: RecordedTest): Promise<IdentifiedController> {
  const { data } = await call("POST", "v1/records/controller", { record });
  return (data as { identified: IdentifiedController }).identified;
}
