// Runs in a page that holds the viewer and its meshes (`qtet page`), and first in its workers. It
// unpacks what the page holds, gives each file an address in memory, and starts the viewer. Scripts
// name one another by file names. A page from a disk and its workers cannot read one another's
// addresses, so each makes its own.
{
  /** `files`: {type, content} by name; content is a text or a Blob. */
  const linker = (files) => {
    const addresses = {};
    const keep = (name, content) => {
      const {type} = files.get(name);
      return (addresses[name] = URL.createObjectURL(new Blob([content], {type})));
    };
    /** The address of a file; of a script, after those that it imports. */
    const link = (name) => {
      if (addresses[name]) return addresses[name];
      const {type, content} = files.get(name);
      if (type !== 'text/javascript') return keep(name, content);
      const text = content
        .replace(
          /\b(from|import)"\.\/([^"]+)"/g,
          (_, word, other) => `${word}${JSON.stringify(link(other))}`,
        )
        .replace(/\bimport\("\.\/([^"]+)"\)/g, 'import(qtetFile("$1"))')
        .replace(/new URL\("([^"]+)",import\.meta\.url\)/g, 'new URL(qtetFile("$1"))');
      return keep(name, text);
    };
    globalThis.qtetFile = link;
    return {addresses, keep, link};
  };

  const inWorker = () => {
    const early = [];
    const wait = (event) => early.push(event.data);
    /** Files that were dropped on the page: its address of each, and ours. */
    const dropped = new Map();
    addEventListener('message', (event) => {
      const {address, blob} = event.data.qtetBlob ?? {};
      if (!address) return;
      dropped.set(address, URL.createObjectURL(blob));
      event.stopImmediatePropagation();
    });
    const start = async ({data: {files, entry, known}}) => {
      removeEventListener('message', start);
      addEventListener('message', wait);
      const {link} = linker(files);
      // The page speaks of files by its own addresses.
      const fetchNative = fetch;
      globalThis.fetch = (address, init) => {
        const [place, behind = ''] = String(address).split('#');
        const name = known.get(place);
        const own = name ? link(name) : dropped.get(place);
        return fetchNative(own ? `${own}#${behind}` : address, init);
      };
      await import(link(entry));
      removeEventListener('message', wait);
      for (const data of early) dispatchEvent(new MessageEvent('message', {data}));
    };
    addEventListener('message', start);
  };

  const unpacked = async (part) => {
    const {size, type, coding} = part.dataset;
    const bytes = Uint8Array.from(atob(part.textContent), (sign) => sign.charCodeAt(0));
    let content = new Blob([bytes], {type});
    if (coding) {
      const stream = content.stream().pipeThrough(new DecompressionStream(coding));
      content = await new Response(stream).blob();
    }
    if (content.size !== Number(size)) throw new Error('a part is damaged');
    return /javascript|json/.test(type) ? content.text() : content;
  };

  const inPage = async ({parts: count, entry}, script) => {
    const parts = [...document.querySelectorAll('script[data-name]')];
    if (parts.length !== Number(count)) throw new Error('its end is missing');
    const files = new Map();
    for (const part of parts) {
      const {name, type} = part.dataset;
      files.set(name.replace(/^.*\//, ''), {type, content: await unpacked(part)});
      part.remove();
    }
    const {addresses, keep, link} = linker(files);
    const list = JSON.parse(files.get('index.json').content);
    for (const mesh of list.meshes) mesh.links.log = `${link(mesh.links.log)}#${mesh.id}.qtet`;
    document.querySelector('meta[name=qtet-src]').content =
      `${keep('index.json', JSON.stringify(list))}#index.json`;
    const first = URL.createObjectURL(new Blob([script], {type: 'text/javascript'}));
    const workers = new Set();
    const make = URL.createObjectURL.bind(URL);
    URL.createObjectURL = (blob) => {
      const address = make(blob);
      for (const worker of workers) worker.postMessage({qtetBlob: {address, blob}});
      return address;
    };
    const Native = Worker;
    globalThis.Worker = class extends Native {
      constructor(url) {
        super(first);
        workers.add(this);
        const known = new Map(Object.entries(addresses).map(([name, address]) => [address, name]));
        this.postMessage({files, entry: known.get(String(url)), known});
      }
    };
    const view = document.querySelector('meta[name=qtet-view]')?.content ?? '';
    const query = [...new URLSearchParams(location.search || view).keys()];
    if (query.some((name) => name !== 'mesh')) document.querySelector('img[slot=poster]')?.remove();
    await import(link(entry));
  };

  if (typeof document === 'undefined') {
    inWorker();
  } else {
    const {dataset, textContent} = document.currentScript;
    document.addEventListener('DOMContentLoaded', () => {
      inPage(dataset, textContent).catch((error) => {
        const why = error instanceof TypeError ? 'this browser is too old' : error.message;
        document.querySelector('.first p').textContent =
          `This file cannot be shown: ${why}. Ask for it again, or open it in another browser.`;
      });
    });
  }
}
