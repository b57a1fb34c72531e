// Where the keyboard is, as a person sees it.
(() => {
  const STOPS = "a[href], button, input, select, textarea, summary, [tabindex='0']";
  const visited = new WeakSet();
  const root = () => document.querySelector("dialog:modal") ?? document.body;

  const nameOf = (element) => {
    const labels = [...(element.labels ?? [])].map((label) => label.textContent);
    const by = (element.getAttribute("aria-labelledby") ?? "").split(" ").map((id) => document.getElementById(id)?.textContent ?? "");
    return [element.getAttribute("aria-label"), by.join(" "), labels.join(" "), element.textContent, element.title]
      .map((name) => (name ?? "").trim()).find(Boolean)?.replace(/\s+/g, " ") ?? element.name ?? element.localName;
  };

  /** The visible focus: its own ring, or that of the pill which it lies under; a date's own button has the
   *  browser's, and a heading that can only be read needs none. */
  const hasRing = (element) => element.matches("input:not(:focus), [tabindex='-1']") || [element, element.nextElementSibling].filter(Boolean).some((one) => {
    const { outlineStyle, outlineWidth } = getComputedStyle(one);
    return outlineStyle !== "none" && parseFloat(outlineWidth) >= 2;
  });

  /** True if nothing covers all of it, such as the bar of pages below a thumb. */
  const isUncovered = (element) => {
    const box = (element.matches("input") && element.closest("label")) || element;
    return [...box.getClientRects()].some(({ left, right, top, bottom }) => {
      const points = [0.5, 0.1, 0.9].flatMap((x) => [0.5, 0.15, 0.85].map((y) => [left + (right - left) * x, top + (bottom - top) * y]));
      return points.some(([x, y]) => {
        const hit = document.elementFromPoint(x, y);
        return hit && (box.contains(hit) || element.contains(hit));
      });
    });
  };

  const coveredBy = (element) => {
    const { left, top, width, height } = element.getBoundingClientRect();
    return document.elementFromPoint(left + width / 2, top + height / 2)?.outerHTML.slice(0, 80) ?? "it is off the screen";
  };

  const here = () => {
    const element = document.activeElement;
    if (!element || element === document.body) return { name: "", wrong: [] };
    visited.add(element);
    const name = nameOf(element);
    const wrong = [];
    if (!hasRing(element)) wrong.push(`nothing shows that the keyboard is at "${name}"`);
    if (!isUncovered(element)) wrong.push(`"${name}" has the keyboard and cannot be seen: ${coveredBy(element)}`);
    if (!root().contains(element)) wrong.push(`the keyboard is at "${name}", behind the dialog`);
    return { name, wrong };
  };

  const stops = () => [...root().querySelectorAll(STOPS)].filter((one) => one.checkVisibility({ visibilityProperty: true }) && !one.disabled);
  const group = (element) => element.type === "radio" && element.closest("fieldset, form, dialog, main");
  /** Controls that the keyboard never reached; of a group of radios one is enough. */
  const missed = () => {
    const all = stops();
    const groups = new Set(all.filter((one) => visited.has(one)).map(group));
    return all.filter((one) => !visited.has(one) && !(group(one) && groups.has(group(one)))).map(nameOf);
  };
  window.keys = { here, missed, all: () => stops().map(nameOf) };
})()
