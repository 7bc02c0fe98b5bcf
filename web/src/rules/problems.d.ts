declare module "virtual:problems" {
  import type { Library } from "../words/score.ts";
  const library: Library;
  export default library;
}
