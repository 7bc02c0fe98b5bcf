// The options of a tuning method, in the form of GET /v1/methods.

/** A JSON Schema, restricted to the parts that method options use. */
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
  /** An option that affects the result strongly. */
  "x-main"?: boolean;
  /** An option that adds data for a drawing. */
  "x-draws"?: boolean;
  /** Another option follows from it: they are not given together. */
  "x-in-place-of"?: string;
  "x-slider"?: OptionSlider;
}

/** The slider of an option. */
export interface OptionSlider {
  from: number;
  to: number;
  /** The ends are factors of the value. */
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
