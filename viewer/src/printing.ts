const redraws: (() => void)[] = [];

/** Calls a function when the page is about to be printed, laid out as wide as paper, and when it is as before again. */
export function whenPrinting(redraw: () => void): void {
  redraws.push(redraw);
}

const smallestText = 4; // px

/** Makes the text of tables that are wider than the paper smaller, until they fit: paper cannot be scrolled. */
function fitTables(): void {
  for (const table of document.querySelectorAll<HTMLElement>(".table-box table")) {
    let size = parseFloat(getComputedStyle(table).fontSize);
    for (let round = 0; round < 4 && size > smallestText; round++) {
      const room = table.parentElement!.clientWidth;
      if (room === 0 || table.offsetWidth <= room) break;
      size = Math.max(smallestText, size * Math.min(0.98, room / table.offsetWidth));
      table.style.fontSize = `${size}px`;
    }
  }
}

addEventListener("beforeprint", () => {
  document.documentElement.dataset.printing = "true";
  for (const redraw of redraws) redraw();
  fitTables();
});
addEventListener("afterprint", () => {
  delete document.documentElement.dataset.printing;
  for (const table of document.querySelectorAll<HTMLElement>(".table-box table")) table.style.fontSize = "";
  for (const redraw of redraws) redraw();
});
