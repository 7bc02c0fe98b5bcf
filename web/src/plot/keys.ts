// The keys of a plot that has the focus.

export interface KeyMeaning {
  keys: string;
  meaning: string;
}

export const PLOT_KEYS: readonly KeyMeaning[] = [
  { keys: "Arrow keys", meaning: "move the cursor, with Shift in bigger steps" },
  { keys: "Home, End", meaning: "move the cursor to an end" },
  { keys: "+ and −", meaning: "zoom" },
  { keys: "0", meaning: "shows everything" },
  { keys: "F", meaning: "enlarges the plot; F or Escape goes back" },
  { keys: "T", meaning: "shows the data as a table" },
];

/** For readers who do not see the plot. */
export const KEYS_SENTENCE = `${PLOT_KEYS.map(({ keys, meaning }) => `${keys}: ${meaning}`).join("; ")}.`;
