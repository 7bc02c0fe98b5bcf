// Settings as the lines that one pastes into a firmware's configuration or a program, where the product has such lines.

type Values = Record<string, string>;

/** By the product's id; the values are the texts to type. */
const LINES: Record<string, (values: Values) => string[]> = {
  klipper: ({ pid_Kp, pid_Ki, pid_Kd, smooth_time }) => [
    "control: pid",
    `pid_Kp: ${pid_Kp}`,
    `pid_Ki: ${pid_Ki}`,
    `pid_Kd: ${pid_Kd}`,
    ...(smooth_time ? [`smooth_time: ${smooth_time}`] : []),
  ],
  marlin: ({ P, I, D }) => [`M301 P${P} I${I} D${D}`, "M500"],
  esphome_pid: ({ kp, ki, kd, derivative_averaging_samples: samples }) => [
    "control_parameters:",
    `  kp: ${kp}`,
    `  ki: ${ki}`,
    `  kd: ${kd}`,
    ...(samples ? [`  derivative_averaging_samples: ${samples}`] : []),
  ],
  arduino_pid_v1: ({ Kp, Ki, Kd, POn, ControllerDirection: direction = "DIRECT" }) => [
    `PID controller(&y, &u, &r, ${[Kp, Ki, Kd, POn, direction].filter(Boolean).join(", ")});`,
  ],
};

/** The places of the lines, for the button that copies them. */
const PLACES: Record<string, string> = {
  klipper: "printer.cfg",
  marlin: "G-code",
  esphome_pid: "YAML",
  arduino_pid_v1: "the sketch",
};

export interface Paste {
  /** Where the lines go: "printer.cfg". */
  place: string;
  text: string;
}

/** Null: settings of this product are typed, not pasted. */
export function pasteOf(product: string, values: Values): Paste | null {
  const lines = LINES[product];
  return lines ? { place: PLACES[product]!, text: lines(values).join("\n") } : null;
}
