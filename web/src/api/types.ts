// The page's names for the types of the contract (contract.gen.ts): for names that mean something else in a browser,
// for answers that the page combines from several, and for types that it fills from a description and reads by name.
import type * as Contract from "./contract.gen.ts";
import type { Schema } from "./method.ts";

export type {
  ExperimentCodeRequest as ExperimentQuestion,
  Batch,
  BatchCheck,
  Certificate,
  CheckCurve,
  CheckLoop,
  CheckRequest,
  CheckResult,
  Controller,
  ControllerEvidence as Evidence,
  ControllerParameter as ProductParameter,
  ControllerProduct as Product,
  ControllerSummary as ProductSummary,
  DesignAnswer,
  Emulation,
  EmulatedScenario,
  Fault as FieldError,
  Filter,
  Finding,
  Frequency as FrequencyTraces,
  FrequencyPoint,
  Frontier,
  Health,
  Implemented,
  JobList,
  JobOutline as Outline,
  JobStatus,
  JobSummary as ListedJob,
  LevelOneRow,
  LimitCycle,
  LoopCheck,
  LoopCluster,
  LoopCure,
  LoopChange,
  LoopRank,
  LoopTrend,
  Model,
  OneSetting,
  OptimumAtMs,
  OwnStep,
  OwnStepEntry,
  PlantAnswer,
  PlantQuestion,
  PreviewAnswer as Preview,
  PreviewColumn,
  Progress,
  Range as RangeContent,
  RangePassage,
  RangeRun,
  RangeTraces,
  Record as RecordedTest,
  Region,
  Relay as RelaySettings,
  RelayAnswer,
  RelayPlan,
  RelayRequest,
  Rimc,
  Robustness,
  Schedule,
  ScheduleRow,
  ScheduleSettingsAnswer as TypedSchedule,
  SettingsAnswer as AsEntered,
  Standing,
  Trace as Response,
  Tradeoff,
  TradeoffFigures,
  UltimatePoint,
  Units,
  WorstPlace,
} from "./contract.gen.ts";

/** A warning, or a note on settings, which has no level. */
export type Notice = Omit<Contract.Warning, "level"> & Partial<Pick<Contract.Warning, "level">>;
export type WhyNull = Record<string, string>;
export type Column = (number | null)[];
export type SettingValue = number | string | boolean;

export type Need = "y_span" | "u_span" | "sample_time";
/** Settings that a search determines. */
export type Tuned = "Kp" | "Ti" | "Td" | "Tf";
/** A point of the trade-off's rule, by the quantity that was given. */
export type TradeoffPoint = Contract.TradeoffAtMs | Contract.TradeoffAtLevel;
export type Span = [number, number];

/** Members of an answer by name. */
export type Figures = { why_null?: WhyNull } & Record<string, number | null | WhyNull | undefined>;
/** Any plant, read by the names of its parameters. */
export type Plant = Contract.PlantModel & { L?: number };
/** A method with the options that it describes. */
export type TuneEntry = Contract.Method;
/** The user's own controller. */
export type Implement = Pick<Contract.Implement, "product" | "y_span" | "u_span" | "sample_time"> & Record<string, unknown>;
/** Settings as typed into a product. */
export type TypedSettings = Contract.TypedSettings;
/** A controller in a request: a law, or settings typed into a product. */
export type GivenController = ({ form: string; product?: undefined } & Record<string, unknown>) | TypedSettings;

/** A request as filled by the page's forms, or by files. */
export interface TuningRequest extends Pick<Contract.TuningRequest, "name" | "units" | "record"> {
  plant?: Plant;
  identify?: Record<string, unknown>;
  tune?: TuneEntry[] | string;
  /** "from-record": the service finds them in the record. */
  controllers?: GivenController[];
  baseline?: GivenController | "from-record";
  implement?: Implement;
  evaluate?: Partial<Contract.Evaluate> & Record<string, unknown>;
  [key: string]: unknown;
}
/** Today's settings as the service finds them in a record. */
export type IdentifiedController = Contract.IdentifiedController & { certain?: boolean };
export type ControllerInRecord = Omit<Contract.ControllerRecordAnswer, "identified" | "typing"> & {
  identified?: IdentifiedController;
  typing?: Contract.SettingsAnswer & { standard_errors?: Record<string, number> };
};
export type IdentifyRequest = Pick<TuningRequest, "name" | "units" | "identify"> & Pick<Contract.IdentifyRequest, "record">;

/** From the service, or from the page if the service cannot be reached. */
export type Problem = Partial<Contract.Problem>;
/** A structure that was tried, or the model itself. */
export type Candidate = Omit<Contract.Candidate, "criterion">;
/** An entry of a method, or one that the page names. */
export type Entry = Contract.Entry & { method: string };
/** A check of loops in operation. */
export type CheckJob = Omit<Contract.Job, "request" | "result"> & { request?: Contract.CheckRequest; result?: Contract.CheckResult };
type OwnParts = "excerpt" | "spectrum" | "autocorrelation" | "shape";
/** A loop in the list of a check: in that of a batch it has no curves of its own, but its job. */
export type ListedLoop = Omit<Contract.LoopCheck, OwnParts> & Partial<Pick<Contract.LoopCheck, OwnParts>> & { job?: string };
/** What a check found: of a job with all curves, of a batch without them. `changes`: since an earlier check, whose name is `since`. */
export type CheckContent = Pick<Contract.CheckResult, "clusters" | "cascades" | "ranking" | "units"> &
  Pick<Contract.BatchCheck, "changes"> & { loops: ListedLoop[]; partial?: boolean; failed?: number; since?: string };
/** The result of a job about one loop or a range, or a combination of the answers to a slider. */
export type Result = Partial<Omit<Contract.TuningResult, "controllers">> & { controllers: Entry[]; range?: Contract.Range };
export type Job = Omit<Contract.Job, "request" | "result"> & { request?: TuningRequest; result?: Result };
export type Example = Omit<Contract.Example, "request"> & { request: TuningRequest };

export type { OptionSlider, Schema } from "./method.ts";
export type Method = Omit<Contract.MethodDescription, "options"> & { options?: Schema };

/** The name of a job's loop; "" if it has none. */
export const nameOf = ({ name, request }: Pick<Job, "name" | "request">): string => name || request?.name || "";

export const isFinal = (status: Contract.JobStatus): boolean =>
  status === "succeeded" || status === "failed" || status === "cancelled";
