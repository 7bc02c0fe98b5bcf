// What to ask the service for the settings of an entry, or of a controller that is tried by hand, in the user's own product.
import { evaluateAsBuilt } from "../api/live.ts";
import { getProduct, settingsFor } from "../api/products.ts";
import type { AsEntered, Controller, Entry, Implement, Product, TuningRequest } from "../api/types.ts";
import type { CallSubject } from "../api/live.ts";

export interface TypedQuestion {
  implement: Implement & { product: string };
  /** Of the entry, or as tried. */
  controller: Controller;
  /** Null: what is tried by hand, of which only the settings are asked. */
  subject: CallSubject | null;
  request: TuningRequest;
}

export interface TypedAnswer {
  product: Product;
  entered: AsEntered;
  /** The entry judged on the product; null where only the settings could be had. */
  judged: Entry | null;
}

/** The settings with the loop as built; the settings alone where this plant cannot be judged so. */
export async function askTyped({ implement, controller, subject, request }: TypedQuestion): Promise<TypedAnswer> {
  const product = await getProduct(implement.product);
  const judged = subject ? await evaluateAsBuilt(subject, controller, implement, request).catch(() => null) : null;
  const entered = judged?.as_entered ?? (await settingsFor(implement, controller, request.units));
  return { product, entered, judged };
}
