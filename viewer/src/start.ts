import { h } from "./dom";

/** Builds the page into its main element; where that fails the page says why. `data-ready` marks the end. */
export async function start(build: (main: HTMLElement) => Promise<void>): Promise<void> {
  const main = document.getElementById("report")!;
  try {
    await build(main);
    document.documentElement.dataset.ready = "true";
  } catch (error) {
    main.replaceChildren(
      h("p", { class: "error", role: "alert" }, `This report cannot be shown: ${String(error)}`),
    );
    throw error;
  }
}
