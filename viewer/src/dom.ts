/** Small helpers to build HTML. Text is always set as text, never parsed. */

type Attributes = Record<string, string | number | boolean | ((event: Event) => void)>;
export type Child = Node | string | number | null | undefined;

/** h("p", { class: "note" }, "text", node): an element with attributes (functions become listeners) and children. */
export function h<K extends keyof HTMLElementTagNameMap>(
  tag: K,
  attributes: Attributes = {},
  ...children: Child[]
): HTMLElementTagNameMap[K] {
  const element = document.createElement(tag);
  for (const [name, value] of Object.entries(attributes)) {
    if (typeof value === "function") element.addEventListener(name, value);
    else if (value === true) element.setAttribute(name, "");
    else if (value !== false) element.setAttribute(name, String(value));
  }
  for (const child of children)
    if (child !== null && child !== undefined)
      element.append(String(child) === child ? child : typeof child === "number" ? String(child) : child);
  return element;
}

/** "a_x in m/s²" with the x as an index. */
export function symbols(text: string): DocumentFragment {
  const fragment = document.createDocumentFragment();
  for (const [k, part] of text.split(/_([a-z]+)/).entries())
    fragment.append(k % 2 === 1 ? h("sub", {}, part) : part);
  return fragment;
}

/** A labelled drop-down list. */
export function choice(
  label: string,
  options: readonly { value: string; text: string }[],
  selected: string,
  onChange: (value: string) => void,
): HTMLLabelElement {
  const select = h("select", { change: () => onChange(select.value) });
  for (const option of options) select.append(h("option", { value: option.value }, option.text));
  select.value = selected;
  return h("label", { class: "choice" }, h("span", {}, label), select);
}

/** A section of the report with its heading. */
export function section(id: string, title: string, ...children: Child[]): HTMLElement {
  return h(
    "section",
    { id, "aria-labelledby": `${id}-title` },
    h("h2", { id: `${id}-title` }, title),
    ...children,
  );
}

/** The value of a CSS custom property, which depends on the theme. */
export function css(name: string): string {
  return getComputedStyle(document.documentElement).getPropertyValue(name).trim();
}

let measuring: CanvasRenderingContext2D | null = null;

/** Width of each text in a font of so many pixels, px. */
export function textWidths(texts: readonly string[], pixels: number): number[] {
  const context = (measuring ??= document.createElement("canvas").getContext("2d")!);
  context.font = `${pixels}px ${css("--font")}`;
  return texts.map((text) => context.measureText(text).width);
}

/** A table in a box that scrolls sideways where the page is too narrow. */
export function tableBox(caption: string, head: Child[][], rows: Child[][], className = ""): HTMLElement {
  const header = h("thead");
  for (const cells of head) header.append(h("tr", {}, ...cells));
  const body = h("tbody");
  for (const cells of rows) body.append(h("tr", {}, ...cells));
  const table = h("table", { class: className }, h("caption", {}, h("span", {}, caption)), header, body);
  return h("div", { class: "table-box", tabindex: "0", role: "region", "aria-label": caption }, table);
}

/** The head of a column, with its unit under its name. */
export function column(text: string, unit = "", isText = false): HTMLElement {
  return h(
    "th",
    { scope: "col", class: isText ? "text" : "" },
    text,
    unit ? h("span", { class: "unit" }, unit) : null,
  );
}

/** Names with what they are, side by side where there is room. */
export function factList(facts: [string, Child][]): HTMLElement {
  const list = h("dl", { class: "facts" });
  for (const [name, value] of facts) list.append(h("div", {}, h("dt", {}, name), " ", h("dd", {}, value)));
  return list;
}

/** svg("path", { d: "M0 0" }): as h, for the elements of a drawing. */
export function svg<K extends keyof SVGElementTagNameMap>(
  tag: K,
  attributes: Record<string, string | number> = {},
  ...children: Child[]
): SVGElementTagNameMap[K] {
  const element = document.createElementNS("http://www.w3.org/2000/svg", tag);
  for (const [name, value] of Object.entries(attributes)) element.setAttribute(name, String(value));
  for (const child of children)
    if (child !== null && child !== undefined) element.append(child instanceof Node ? child : String(child));
  return element;
}
