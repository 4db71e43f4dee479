import { h } from "./dom";

export type Grade = "attention" | "good" | "plain";

/** A sentence of the result, and how it is to be taken. */
export interface Finding {
  grade: Grade;
  text: string;
}

export function findingList(items: readonly Finding[]): HTMLElement {
  const list = h("ul", { class: "findings" });
  for (const { grade, text } of items) list.append(h("li", { class: `finding ${grade}` }, text));
  return list;
}
