// The documents that the service serves next to the page, by what they answer.

export interface Document {
  /** Its file in docs/ without the ending. */
  id: string;
  title: string;
}

export const DOCUMENTS: readonly Document[] = [
  { id: "tutorial", title: "Tutorial: from a trend to settings" },
  { id: "page", title: "The page, screen by screen" },
  { id: "glossary", title: "Glossary" },
  { id: "symbols", title: "Symbols and units" },
  { id: "verdicts", title: "Verdicts: levels, codes, thresholds" },
  { id: "methods", title: "Tuning methods" },
  { id: "problems", title: "Problems in PID design, and the score of a rule" },
  { id: "proof", title: "Proof of an optimum" },
  { id: "controllers", title: "Products and their settings" },
  { id: "records", title: "Recorded tests" },
  { id: "relay", title: "Relay tests" },
  { id: "range", title: "Operating ranges" },
  { id: "structures", title: "Loops around the loop" },
  { id: "check", title: "Check of loops in operation" },
  { id: "uncertain", title: "Uncertain plants" },
  { id: "plants", title: "Plants in one line" },
  { id: "nonlinear", title: "Plants as equations" },
  { id: "batches", title: "Batches" },
  { id: "report", title: "Reports and change sheets" },
  { id: "correctness", title: "How figures are checked" },
  { id: "numerics", title: "Numerics" },
  { id: "api", title: "API: calls and requests" },
  { id: "README", title: "All documents" },
];

/** Relative to the page, like every address. */
export const documentAddress = (id: string, anchor = ""): string => `documents/${id}.html${anchor && `#${anchor}`}`;
