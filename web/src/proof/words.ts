// A certificate in words: what is proved, and about which controllers.
import type { Certificate } from "../api/types.ts";
import { formatNumber, withUnit } from "../words/numbers.ts";

const KINDS: Record<Certificate["problem"]["structure"], string> = { pi: "PI", pid_tied: "PID with Tf = Td/10", pid_fixed: "PID with this filter" };

/** `unit`: of the IAE. */
export function provedWords({ complete, lower, gap, asked_gap, problem }: Certificate, unit: string): string {
  const bound = [formatNumber(lower, 4), unit].filter(Boolean).join(" ");
  const sentence = `no ${KINDS[problem.structure]} within these limits has an IAE below ${bound}: this one is within ${percent(gap)} % of the best possible`;
  if (complete) return `${capital(sentence)} (proved).`;
  return `Proved so far: ${sentence}. The search ended before the ${percent(asked_gap)} % that were asked for.`;
}

const percent = (share: number): string => String(Number((100 * share).toPrecision(2)));
const capital = (text: string): string => text[0]!.toUpperCase() + text.slice(1);

/** Label and text of each figure. */
export function certificateFacts({ upper, lower, root, boxes, seconds }: Certificate, unit: string): [label: string, text: string][] {
  const { low, high } = root;
  const sides = (["k", "ki", "kd", "Td"] as const).flatMap((name): [string, string][] => {
    const [from, to] = [low[name], high[name]];
    return from === undefined || to === undefined ? [] : [[`${name} of the controllers compared`, `${formatNumber(from)} to ${formatNumber(to)}`]];
  });
  return [
    [withUnit("IAE of this design, unit load step", unit), formatNumber(upper, 4)],
    [withUnit("Proved bound", unit), formatNumber(lower, 4)],
    ...sides,
    ["Boxes", String(boxes)],
    ["Seconds", formatNumber(seconds, 2)],
  ];
}
