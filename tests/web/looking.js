// What can be measured on a page as it stands: each of these gives back what is wrong, in words, or nothing.
(() => {
  const TARGETS = "a[href], button, input, select, textarea, summary, [tabindex='0']";
  const BOXES = "button, .button, .card, dialog, summary, .badge, label, td, th, .toast, .banner, .order, .notices li > a";
  const SLACK = 1.5;
  const root = () => document.querySelector("dialog:modal") ?? document.body;
  const words = (element) => `<${element.localName}${element.className?.baseVal === undefined && element.className ? ` class="${element.className}"` : ""}> ${element.textContent.trim().replace(/\s+/g, " ").slice(0, 50)}`;
  const isSeen = (element) => element.checkVisibility({ opacityProperty: true, visibilityProperty: true }) && !element.closest(".unseen, .skip, [aria-hidden='true']");
  const shared = (a, b) => [Math.min(a.right, b.right) - Math.max(a.left, b.left), Math.min(a.bottom, b.bottom) - Math.max(a.top, b.top)];

  /** Elements above the page that may cover it: a sheet, a toast, the bar of pages. */
  const layer = (element) => {
    for (let one = element; one && one !== root(); one = one.parentElement)
      if (["fixed", "absolute", "sticky"].includes(getComputedStyle(one).position)) return one;
    return root();
  };

  /** The touch target of a control, with its label. */
  const targets = () => {
    const found = [...root().querySelectorAll(TARGETS)].map((element) => (element.matches("input") && element.closest("label")) || element);
    return [...new Set(found)].filter((element) => element.checkVisibility({ visibilityProperty: true }) && !element.matches(".skip"));
  };

  const lines = () => {
    const found = [];
    const walker = document.createTreeWalker(root(), NodeFilter.SHOW_TEXT);
    for (let node = walker.nextNode(); node; node = walker.nextNode()) {
      const owner = node.parentElement;
      if (!node.data.trim() || owner.closest("svg, option") || !isSeen(owner)) continue;
      const range = document.createRange();
      range.selectNodeContents(node);
      for (const rect of range.getClientRects()) if (rect.width > 1 && rect.height > 1) found.push({ owner, rect });
    }
    return found;
  };

  /** Overflow can be reached by scrolling, or ends in an ellipsis because the whole stands elsewhere. */
  const scrolls = (style) => /auto|scroll/.test(style.overflowX) || /auto|scroll/.test(style.overflowY) || style.webkitLineClamp !== "none";

  /** True if a line is not scrolled out of the box that holds it. */
  const isInSight = ({ owner, rect }) => {
    for (let box = owner; box && box !== document.documentElement; box = box.parentElement) {
      const place = box.getBoundingClientRect();
      if (scrolls(getComputedStyle(box)) && (rect.top >= place.bottom - SLACK || rect.bottom <= place.top + SLACK)) return false;
    }
    return true;
  };

  const sideways = () => {
    const { scrollWidth, clientWidth } = document.documentElement;
    const dialog = document.querySelector("dialog:modal");
    if (dialog) return dialog.scrollWidth > dialog.clientWidth ? [`the dialog scrolls sideways by ${dialog.scrollWidth - dialog.clientWidth} px`] : [];
    const wide = [...root().querySelectorAll("*")].filter((one) => !one.closest("svg") && one.getBoundingClientRect().right > clientWidth + 1);
    return scrollWidth > clientWidth ? [`the page scrolls sideways by ${scrollWidth - clientWidth} px: ${wide.slice(-2).map(words)}`] : [];
  };

  /** Text that its box does not hold, or that is cut off. */
  const cutOff = () => {
    const found = new Set();
    for (const { owner, rect } of lines()) {
      for (let box = owner; box; box = box.parentElement) {
        const style = getComputedStyle(box);
        const place = box.getBoundingClientRect();
        const isOut = rect.right > place.right + SLACK || rect.left < place.left - SLACK;
        if (scrolls(style) && box !== document.documentElement && (isOut || rect.top >= place.bottom - SLACK)) break;
        if (isOut && style.display !== "inline" && (style.overflowX !== "visible" || box.matches(BOXES)))
          found.add(`${words(owner)} sticks out of ${words(box).slice(0, 40)}`);
        if (/hidden|clip/.test(style.overflowY) && rect.bottom > place.bottom + 3) found.add(`${words(owner)} is cut off`);
        if (style.position === "fixed") break;
      }
      if (rect.left < -1 && !owner.closest("dialog")) found.add(`${words(owner)} lies left of the screen`);
    }
    const pen = document.createElement("canvas").getContext("2d");
    for (const select of root().querySelectorAll("select")) {
      const style = getComputedStyle(select);
      pen.font = style.font;
      const room = select.clientWidth - parseFloat(style.paddingLeft) - parseFloat(style.paddingRight);
      const text = select.selectedOptions[0]?.textContent.trim() ?? "";
      if (select.checkVisibility() && pen.measureText(text).width > room + SLACK) found.add(`${words(select).slice(0, 20)} cuts off "${text}"`);
    }
    return [...found];
  };

  /** Controls that lie upon each other, and text upon other text. */
  const overlapping = () => {
    const found = new Set();
    const boxes = targets().map((element) => ({ element, rect: element.getBoundingClientRect(), layer: layer(element.parentElement) }));
    boxes.forEach((one, i) => {
      for (const other of boxes.slice(i + 1)) {
        if (one.layer !== other.layer || one.element.contains(other.element) || other.element.contains(one.element)) continue;
        const [width, height] = shared(one.rect, other.rect);
        if (width > SLACK && height > SLACK) found.add(`${words(one.element)} lies upon ${words(other.element)}`);
      }
    });
    const texts = lines().filter(isInSight).map(({ owner, rect }) => ({ owner, rect, layer: layer(owner), shrunk: rect.height * 0.2 }));
    texts.forEach((one, i) => {
      for (const other of texts.slice(i + 1)) {
        if (one.layer !== other.layer || one.owner === other.owner) continue;
        const [width, height] = shared(one.rect, other.rect);
        if (width > 3 && height > one.shrunk + other.shrunk) found.add(`"${words(one.owner)}" is written over "${words(other.owner)}"`);
      }
    });
    return [...found];
  };

  /** Targets that a finger may miss; a link within a sentence is as high as its line. */
  const small = (least) => targets().flatMap((element) => {
    const { width, height } = element.getBoundingClientRect();
    const isInSentence = getComputedStyle(element).display === "inline" && element.parentElement.textContent.trim() !== element.textContent.trim();
    const isSmall = Math.min(width, height) < 24 - 0.5 || height < least - 0.5;
    return isSmall && !isInSentence ? [`${words(element)} is ${Math.round(width)} × ${Math.round(height)} px`] : [];
  });

  const isLong = (durations) => durations.split(",").some((duration) => parseFloat(duration) > 0.001);

  /** Whatever moves although less motion is wanted. */
  const moving = () => {
    const found = new Set(document.getAnimations().map(({ effect, animationName }) => `${words(effect.target)} moves: ${animationName}`));
    for (const element of document.querySelectorAll("*")) for (const part of ["", "::before", "::after"]) {
      const style = getComputedStyle(element, part || null);
      if (style.animationName !== "none" && isLong(style.animationDuration)) found.add(`${words(element)}${part} is animated`);
      if (isLong(style.transitionDuration)) found.add(`${words(element)}${part} changes slowly`);
      if (style.scrollBehavior === "smooth") found.add(`${words(element)} scrolls smoothly`);
    }
    return [...found];
  };

  /** The texts that people hear or read on this page, each once. */
  const said = () => {
    const names = [...document.querySelectorAll("[aria-label], [placeholder], [title], [alt]")].flatMap((one) =>
      ["aria-label", "placeholder", "title", "alt"].map((name) => one.getAttribute(name) ?? ""));
    const walker = document.createTreeWalker(document.body, NodeFilter.SHOW_TEXT);
    const texts = [document.title];
    for (let node = walker.nextNode(); node; node = walker.nextNode())
      if (!node.parentElement.closest("[translate=no], [lang]:not(html), script, style")) texts.push(node.data);
    return [...new Set([...texts, ...names].map((text) => text.replace(/\s+/g, " ").trim()).filter(Boolean))];
  };

  const CHANNELS = /[\d.]+/g;
  const brightness = (colour) => {
    const [r, g, b] = colour.match(CHANNELS).map((one) => Number(one) / 255).map((one) => (one <= 0.04045 ? one / 12.92 : ((one + 0.055) / 1.055) ** 2.4));
    return 0.2126 * r + 0.7152 * g + 0.0722 * b;
  };
  const contrast = (one, other) => {
    const [dark, bright] = [brightness(one), brightness(other)].sort((a, b) => a - b);
    return (bright + 0.05) / (dark + 0.05);
  };
  const groundOf = (element) => {
    for (let box = element; box; box = box.parentElement) {
      const { backgroundColor } = getComputedStyle(box);
      if (!backgroundColor.endsWith(", 0)")) return backgroundColor;
    }
    return "rgb(255, 255, 255)";
  };
  /** The shapes of a drawing that carry meaning, each with its colour. */
  const TELLING = { fill: ".campus .goal, .holder path, .shut circle, .robot:not(.offline) .body", stroke: ".corridor, .taken-edge, .hatch, .dock, .campus .post, .way, .expected, .robot.offline .body, .curve .charge, .curve .low" };

  /** Contrast that axe does not see: the letters of a drawing upon their halo, and the shapes that tell something. */
  const faint = () => {
    const least = (ratio, least, what) => (ratio < least ? [`${what} has a contrast of ${ratio.toFixed(2)}, not ${least}`] : []);
    const letters = [...root().querySelectorAll("svg text, svg tspan")].flatMap((text) => {
      const { fill, stroke, paintOrder } = getComputedStyle(text);
      return least(contrast(fill, paintOrder.startsWith("stroke") ? stroke : groundOf(text)), 4.5, `"${text.textContent}" on the drawing`);
    });
    const shapes = Object.entries(TELLING).flatMap(([colour, which]) => [...root().querySelectorAll(`svg :is(${which})`)].flatMap((shape) =>
      least(contrast(getComputedStyle(shape)[colour], groundOf(shape)), 3, `the ${shape.getAttribute("class")} of the drawing`)));
    return [...new Set([...letters, ...shapes])];
  };

  const settled = () => new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done)));
  window.looking = { settled, said, moving, small, faint, layout: () => [...sideways(), ...cutOff(), ...overlapping()] };
})()
