// The service's question for the settings of an entry, or of a controller that is tried by hand, in the user's own
// product.
import { evaluateAsBuilt } from "../api/live.ts";
import { getProduct, settingsFor } from "../api/products.ts";
import type { AsEntered, Controller, Entry, Implement, Product, TuningRequest } from "../api/types.ts";
import type { CallSubject } from "../api/live.ts";

export interface TypedQuestion {
  implement: Implement & { product: string };
  /** The entry's controller, or the one that is tried. */
  controller: Controller;
  /** Null: a trial by hand, for which only the settings are requested. */
  subject: CallSubject | null;
  request: TuningRequest;
}

export interface TypedAnswer {
  product: Product;
  entered: AsEntered;
  /** The entry evaluated on the product; null if only the settings could be computed. */
  judged: Entry | null;
}

/** The settings with the implemented loop; only the settings if this plant cannot be evaluated this way. */
export async function askTyped({ implement, controller, subject, request }: TypedQuestion): Promise<TypedAnswer> {
  const product = await getProduct(implement.product);
  const judged = subject ? await evaluateAsBuilt(subject, controller, implement, request).catch(() => null) : null;
  const entered = judged?.as_entered ?? (await settingsFor(implement, controller, request.units));
  return { product, entered, judged };
}
