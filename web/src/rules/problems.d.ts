declare module "virtual:problems" {
  import type { Library } from "./words.ts";
  const library: Library;
  export default library;
}
