/** Our own line icons, 24 units square, drawn in the colour of the text around them. They never carry meaning alone. */
import { html, svg } from "lit";
import { t } from "../texts/texts.js";

const DRAWINGS = {
  letter: svg`<rect x="3" y="5.5" width="18" height="13" rx="2.5"/><path d="m3.8 7.5 8.2 6 8.2-6"/>`,
  send: svg`<path d="M20.5 3.5 10.8 13.2M20.5 3.5 14.4 20.4l-3.6-7.2-7.2-3.6z"/>`,
  bell: svg`<path d="M6 10a6 6 0 0 1 12 0c0 5 2 6.5 2 6.500H4S6 15 6 10Z"/><path d="M10 20a2.3 2.3 0 0 0 4 0"/>`,
  person: svg`<circle cx="12" cy="8.5" r="3.8"/><path d="M4.5 20a7.6 7.6 0 0 1 15 0"/>`,
  warning: svg`<circle cx="12" cy="12" r="9"/><path d="M12 7.500v5.500M12 16.300v.2"/>`,
  clock: svg`<circle cx="12" cy="12" r="9"/><path d="M12 7v5.200l3.3 2"/>`,
  check: svg`<path d="m5 12.8 4.6 4.700L19.5 7"/>`,
  cross: svg`<path d="m6 6 12 12M18 6 6 18"/>`,
  arrow: svg`<path d="M4.5 12h15M13.5 6l6 6-6 6"/>`,
  repeat: svg`<path d="M4 11a7.5 7.5 0 0 1 13.3-3.500L20 10M20 4.500V10h-5.500M20 13a7.5 7.5 0 0 1-13.3 3.500L4 14M4 19.500V14h5.5"/>`,
  robot: svg`<rect x="4.5" y="8" width="15" height="11" rx="4"/><path d="M12 8V4.500M9.3 13v1M14.7 13v1"/><circle cx="12" cy="3.8" r=".8"/>`,
  battery: svg`<rect x="3" y="8" width="16" height="8.5" rx="2"/><path d="M21.5 11v2.500M6 11v2.500M9 11v2.5"/>`,
  dial: svg`<path d="M6 5.500v1M12 5.500v1M18 5.500v1M6 11.500v1M12 11.500v1M18 11.500v1M6 17.500v1M12 17.500v1M18 17.500v1"/>`,
  tray: svg`<path d="M4.500 5h15l1.500 9.500V19H3v-4.500zM3 14.500h5.500a3.500 3.500 0 0 0 7 0H21"/>`,
  settings: svg`<path d="M4 7h9M19 7h1M4 17h1M11 17h9"/><circle cx="16" cy="7" r="2.800"/><circle cx="8" cy="17" r="2.800"/>`,
  leave: svg`<path d="M10 4.500H6.500a2 2 0 0 0-2 2v11a2 2 0 0 0 2 2H10M14.500 8l4 4-4 4M18.500 12H9.500"/>`,
  install: svg`<rect x="6.500" y="2.500" width="11" height="19" rx="2.500"/><path d="M12 7v7M9 11.300l3 3 3-3"/>`,
  help: svg`<circle cx="12" cy="12" r="9"/><path d="M9.300 9.500a2.700 2.700 0 1 1 3.900 2.400c-.8.4-1.200.9-1.200 1.900M12 16.600v.2"/>`,
  network: svg`<path d="M4 4l16 16M8.5 15.500a5 5 0 0 1 5.5-1M5.5 12a9.5 9.5 0 0 1 4-2.400M14 9.300a9.5 9.5 0 0 1 4.5 2.700M12 19.200v.1"/>`,
  pin: svg`<path d="M12 21.200s6.8-6.3 6.8-11.400a6.8 6.8 0 1 0-13.6 0c0 5.1 6.8 11.4 6.8 11.400Z"/><circle cx="12" cy="9.8" r="2.4"/>`,
  closer: svg`<path d="M12 5.500v13M5.500 12h13"/>`,
  farther: svg`<path d="M5.500 12h13"/>`,
  whole: svg`<path d="M4 9V5.500A1.5 1.5 0 0 1 5.500 4H9M15 4h3.500A1.5 1.5 0 0 1 20 5.500V9M20 15v3.500a1.5 1.5 0 0 1-1.500 1.500H15M9 20H5.500A1.5 1.5 0 0 1 4 18.500V15"/>`,
  corridor: svg`<path d="M7 4v16M17 4v16M12 6v2.500M12 11v2.500M12 16v2.500"/>`,
  camera: svg`<path d="M4 8V5.500A1.5 1.5 0 0 1 5.5 4H8M16 4h2.500A1.5 1.5 0 0 1 20 5.500V8M20 16v2.500a1.5 1.5 0 0 1-1.5 1.500H16M8 20H5.500A1.5 1.5 0 0 1 4 18.500V16"/><circle cx="12" cy="12" r="3.3"/>`,
};

/** @param {keyof typeof DRAWINGS} name */
export const icon = (name) => html`<svg class="icon" viewBox="0 0 24 24" aria-hidden="true">${DRAWINGS[name]}</svg>`;

/** The mark of an order that is later than was promised: a word and a drawing, not a colour alone. */
export const lateMark = () => html`<span class="late">${icon("clock")}${t("late.mark")}</span>`;
