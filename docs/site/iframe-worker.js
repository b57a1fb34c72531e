/**
 * Browsers start no worker from a page that was opened as a file. Then the site's search runs in a hidden frame, which
 * speaks the same messages as the worker. mkdocs.yml names this file in place of a script from a foreign server.
 * "iframe-worker" is the name by which the site's builder knows that one is there.
 */
if (location.protocol === "file:") {
  window.Worker = class {
    constructor(script) {
      this.frame = document.createElement("iframe");
      this.frame.hidden = true;
      document.body.append(this.frame);
      const inside = this.frame.contentWindow;
      inside.postMessage = (data) => this.later(() => this.onmessage?.({ data: structuredClone(data) }));
      this.ready = new Promise((resolve, reject) => {
        const element = inside.document.createElement("script");
        element.src = script;
        element.onload = () => resolve(inside);
        element.onerror = reject;
        inside.document.body.append(element);
      });
      this.ready.catch((problem) => this.onerror?.(problem));
    }
    postMessage(data) {
      const copy = structuredClone(data);
      this.ready.then((inside) => this.later(() => inside.onmessage?.({ data: copy })));
    }
    /** A message arrives after the code that sent it has ended, as a worker's does. */
    later(deliver) {
      setTimeout(deliver);
    }
    terminate() {
      this.frame.remove();
    }
  };
}
