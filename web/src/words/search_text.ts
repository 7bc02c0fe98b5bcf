// Text as it is searched: capitals, accents and the signs between words do not matter.

/** How letters are written where a keyboard does not have them. */
const SPELLED: Readonly<Record<string, string>> = {
  ä: "ae",
  ö: "oe",
  ü: "ue",
  ø: "oe",
  å: "aa",
  æ: "ae",
  ß: "ss",
};

/** Lower case without accents, a space before each word: " hagglund" for "Hägglund". */
export const plainText = (text: string): string =>
  ` ${text.toLowerCase().normalize("NFD").replaceAll(/\p{M}/gu, "").replaceAll(/[^\p{L}\p{N}]+/gu, " ")}`.trimEnd();

/** The text in each spelling under which it is looked for: "Hägglund" as " hagglund" and " haegglund". */
export function spellings(text: string): string[] {
  const spelled = text.toLowerCase().normalize("NFC").replaceAll(/[äöüøåæß]/g, (letter) => SPELLED[letter]!);
  return [...new Set([plainText(text), plainText(spelled)])];
}

/** All spellings, as one text in which typed words are looked for. */
export const searchText = (text: string): string => spellings(text).join(" ");

/** The typed words. */
export const searchWords = (typed: string): string[] => plainText(typed).split(" ").filter(Boolean);

/** True if the text has every typed word, in one of its spellings. */
export function hasWords(text: string, typed: string): boolean {
  const searched = searchText(text);
  return searchWords(typed).every((word) => searched.includes(word));
}
