// A tuning rule, or settings, against the library of problems.
import { call } from "./client.ts";
import type { ProblemScore, ScoreAnswer, ScoreRequest, SubmittedSettings } from "./contract.gen.ts";

export type { ProblemScore, ScoreAnswer, ScoreRequest, SubmittedSettings };

export const scoreOf = async (request: ScoreRequest, signal?: AbortSignal): Promise<ScoreAnswer> =>
  (await call("POST", "v1/score", request, {}, signal)).data as ScoreAnswer;
