// Preview of a file of a recorded test: the service reads it before anything is computed.
import { call, decoded } from "./client.ts";
import type { ControllerInRecord, Health, Implement, Preview, RecordedTest, Units } from "./types.ts";

/** The problems' pointers are those of a request with a record. */
const previewed = (data: unknown): Preview => {
  const preview = data as Preview;
  return {
    ...preview,
    problems: preview.problems.map(({ pointer, detail }) => ({ pointer: `/record/${pointer}`, detail })),
  };
};

/** What the service says about itself; null if it does not answer. */
export async function getHealth(): Promise<Health | null> {
  const reply = await call("GET", "healthz").catch(() => null);
  return (reply?.data as Health | undefined) ?? null;
}

/** Bytes of the largest body that the service takes; infinite if it does not
    state the limit, which its refusal then shows. */
export const maxBodyBytes = async (): Promise<number> => (await getHealth())?.max_body_bytes ?? Infinity;

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
  return { text: await decoded(bytes, preview.encoding), preview };
}

/** A record's text with the choices for reading it. */
export async function previewRecord({ csv, columns, dt, time_unit, u_step, run }: RecordedTest): Promise<Preview> {
  const chosen = Object.entries({ columns, dt, time_unit, u_step, run }).filter(([, value]) => value !== undefined);
  const request = { csv, ...Object.fromEntries(chosen) };
  return previewed((await call("POST", "v1/records/preview", request)).data);
}

/** Today's settings in the record of a loop in automatic, and as typed into the product if it is given; or the reason
    why the record does not show them. */
export async function controllerInRecord(
  record: RecordedTest,
  implement: Implement | null,
  units: Units | undefined,
): Promise<ControllerInRecord> {
  const body = { record, ...(units ? { units } : {}), ...(implement ? { implement } : {}) };
  return (await call("POST", "v1/records/controller", body)).data as ControllerInRecord;
}
