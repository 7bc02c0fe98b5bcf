// Sends what is to be checked: as one job, or as a batch if that is too long for one request or the file has many loops.
import { postCheck, postCheckBatch } from "../api/check.ts";
import { maxBodyBytes } from "../api/records.ts";
import type { CheckedBy } from "../routes.ts";
import { linesOf } from "./request.ts";
import type { CheckOrder } from "./request.ts";

const batch = ({ id }: { id: string }): CheckedBy => ({ kind: "batch", id });

export async function sendOrder(order: CheckOrder): Promise<CheckedBy> {
  if (order.kind === "file") return batch(await postCheckBatch(new Blob([order.csv]), "text/csv", order.options));
  const { request } = order;
  const body = new Blob([JSON.stringify(request)], { type: "application/json" });
  if (body.size <= (await maxBodyBytes())) return { kind: "job", id: (await postCheck(body)).id };
  const options: Record<string, string> = request.name ? { name: request.name } : {};
  return batch(await postCheckBatch(new Blob(linesOf(request)), "application/x-ndjson", options));
}
