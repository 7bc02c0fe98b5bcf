// The options of a tuning method, as GET /v1/methods describes them.

/** A JSON Schema, as far as method options use it. */
export interface Schema {
  type?: string | string[];
  title?: string;
  description?: string;
  default?: unknown;
  enum?: unknown[];
  const?: unknown;
  minimum?: number;
  maximum?: number;
  exclusiveMinimum?: number;
  exclusiveMaximum?: number;
  properties?: Record<string, Schema>;
  required?: string[];
  items?: Schema;
  oneOf?: Schema[];
  anyOf?: Schema[];
  $ref?: string;
  $defs?: Record<string, Schema>;
  "x-unit"?: string;
  /** An option that decides what comes out. */
  "x-main"?: boolean;
  /** It adds what a page draws. */
  "x-draws"?: boolean;
  /** Another option follows from it: they are not given together. */
  "x-in-place-of"?: string;
  "x-slider"?: OptionSlider;
}

/** How an option is moved by hand. */
export interface OptionSlider {
  from: number;
  to: number;
  /** Ends are factors of the value. */
  relative?: boolean;
  logarithmic?: boolean;
  step?: number;
  label?: string;
  low?: string;
  high?: string;
  group?: string;
  moves_with?: string;
  value_of?: "Mks" | "Tf" | "Tf_over_Td" | "overshoot_percent";
  reached?: "Mks" | "Tf" | "Tf_over_Td" | "overshoot_percent";
}
