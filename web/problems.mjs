// A part of the page's build: the library of problems as the module "virtual:problems", without what the page does not
// show.
import { readFileSync } from "node:fs";

const NAME = "virtual:problems";
const RESOLVED = `\0${NAME}`;

export function problemsOf(library) {
  const families = Object.keys(library.families);
  const problems = library.problems.map(({ name, plant, structure, Tf, Ms, Mt, upper, lower }) => [name, { plant, structure, Tf, Ms, Mt, upper, lower }]);
  return { families, problems: Object.fromEntries(problems) };
}

/** `file`: of the library. */
export function problems(file) {
  return {
    name: "problems",
    resolveId: (id) => (id === NAME ? RESOLVED : undefined),
    load(id) {
      if (id !== RESOLVED) return undefined;
      this.addWatchFile(file);
      return `export default JSON.parse(${JSON.stringify(JSON.stringify(problemsOf(JSON.parse(readFileSync(file, "utf8")))))});`;
    },
  };
}
