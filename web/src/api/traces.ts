// The page draws a record beside the models of it, so it asks for their traces.
import type { RecordedTest } from "./types.ts";

interface AboutRecord {
  record?: RecordedTest;
  identify?: Record<string, unknown>;
}

/** The request, with the traces of the models if it is about a record. */
export function withTraces<Request extends AboutRecord>(request: Request): Request {
  return request.record ? { ...request, identify: { ...request.identify, traces: true } } : request;
}
