// How long the service keeps a job, and so how long its link works.

const UNITS = [
  ["day", 86_400],
  ["hour", 3600],
  ["minute", 60],
  ["second", 1],
] as const;

/** "7 days", "36 hours": in the largest unit of which it is a whole number. */
export function durationWords(seconds: number): string {
  const [name, size] = UNITS.find(([, length]) => seconds >= length && seconds % length === 0) ?? UNITS[3];
  const count = Math.round(seconds / size);
  return `${count} ${name}${count === 1 ? "" : "s"}`;
}

const local = (time: Date): string => time.toLocaleString(undefined, { dateStyle: "medium", timeStyle: "short" });

/** `finished`: when the job ended, null before; `retention`: of jobs that succeeded, in s, 0 without limit; undefined if
    the service does not say. */
export function keptWords(finished: string | null, retention: number | undefined): string {
  if (retention === undefined) return "The link works as long as the service keeps the job.";
  if (retention === 0) return "The link works until the job is deleted; the service keeps jobs without limit.";
  const kept = `the service keeps a job for ${durationWords(retention)} after its end`;
  if (finished === null) return `The link works for a time: ${kept}.`;
  return `The link works until ${local(new Date(Date.parse(finished) + 1000 * retention))}: ${kept}.`;
}
