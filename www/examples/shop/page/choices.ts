/** Choice of one from several: radio buttons styled as cards. */

interface Shown {
  name: string;
  title: string;
  note: string;
  price: string;
  /** CSS class of the coloured dot in front. */
  swatch?: string;
}

/** Fills a fieldset and selects the first choice. */
export function choices<T>(fieldset: HTMLElement, offered: readonly T[], look: (it: T) => Shown, take: (it: T) => void): void {
  for (const it of offered) {
    const { name, title, note, price, swatch } = look(it);
    const input = document.createElement("input");
    input.type = "radio";
    input.name = fieldset.id;
    input.value = name;
    input.addEventListener("change", () => take(it));
    const words = document.createElement("span");
    words.append(element("strong", title), element("span", note));
    const label = document.createElement("label");
    label.className = "choice";
    label.append(input);
    if (swatch !== undefined) {
      const dot = document.createElement("i");
      dot.className = `swatch ${swatch}`;
      label.append(dot);
    }
    label.append(words, element("span", price));
    fieldset.append(label);
    if (it === offered[0]) {
      input.checked = true;
      take(it);
    }
  }
}

function element(tag: "strong" | "span", text: string): HTMLElement {
  const made = document.createElement(tag);
  made.textContent = text;
  if (tag === "span") made.className = "quiet";
  return made;
}
