// A model from a record, at once.
import { call } from "./client.ts";
import { withTraces } from "./traces.ts";
import type { IdentifyRequest, Model } from "./types.ts";

export async function identify(request: IdentifyRequest): Promise<Model> {
  return ((await call("POST", "v1/identify", withTraces(request))).data as { model: Model }).model;
}
