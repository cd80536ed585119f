// One HTML file with the viewer and a log in it, as `qtet page` makes it
// (simplify/publish/single_page.cpp). Loaded when such a page is saved.

const kList = 'viewer.json';
const kFirstScript = 'single_page.js';
const kLogType = 'application/octet-stream';

/** A part of viewer.json, which the build writes (viewer_files.ts). */
interface ViewerFiles {
  /** The Content-Security-Policy of a page. */
  policy: string;
  /** The type of each file that a page holds. */
  page: Record<string, string>;
}

/**
 * The page of a log; `view` is what it shows without a query. Rejects where the viewer's files do
 * not lie beside this script, as in a bundle of another page.
 */
export async function singlePage(log: Blob, name: string, view: string): Promise<Blob> {
  const {policy, page: files} = (await (await file(kList)).json()) as ViewerFiles;
  const ofType = (wanted: RegExp): string[] =>
    Object.keys(files).filter((its) => wanted.test(files[its]!));
  const index = await (await file('index.html')).text();
  const entry = /<script type="module"[^>]* src="([^"]*)"/.exec(index)?.[1] ?? '';
  const list = {meshes: [{id: name, links: {log: `${name}.qtet`}}]};
  const parts = [
    part('index.json', 'application/json', new Blob([JSON.stringify(list)])),
    part(`${name}.qtet`, kLogType, log),
    ...ofType(/javascript|wasm|plain/).map((its) => fetchedPart(its, files[its]!)),
  ];
  const styles = ofType(/css/).map(async (its) => {
    return `<style>${await (await file(its)).text()}</style>\n  `;
  });
  const [icon] = ofType(/svg/);
  const head = [
    icon ? `<link rel="icon" href="data:image/svg+xml;base64,${await iconOf(icon)}">\n  ` : '',
    ...(await Promise.all(styles)),
    '<meta name="qtet-src" content="index.json">\n  ',
    view ? `<meta name="qtet-view" content="${escaped(view)}">\n  ` : '',
    `<script data-parts="${parts.length}" data-entry="${lastPart(entry)}">`,
    await (await file(kFirstScript)).text(),
    '</script>\n  ',
  ];
  const page = index
    .replace(/<script[^>]*>[^]*?<\/script>\s*|<link[^>]*>\s*/g, '')
    .replace(/<img slot="poster"[^>]*>\s*|<meta name="qtet-[^>]*>\s*/g, '')
    .replace(/<h1>[^<]*<\/h1>/, () => `<h1>${escaped(name)}</h1>`)
    .replace(
      '<meta name',
      () => `<meta http-equiv="Content-Security-Policy" content="${policy}">\n  <meta name`,
    )
    .replace('</head>', () => `${head.join('')}</head>`);
  const at = page.lastIndexOf('</body>');
  return new Blob([page.slice(0, at), ...(await Promise.all(parts)), page.slice(at)], {
    type: 'text/html',
  });
}

/** A file of the viewer. The build puts this script into a folder beside its page. */
async function file(name: string): Promise<Response> {
  const response = await fetch(new URL(/* @vite-ignore */ `../${name}`, import.meta.url));
  if (!response.ok || (name !== 'index.html' && isPage(response)))
    throw new Error(`the viewer's file ${name} is not there; make the page by \`qtet page\``);
  return response;
}

/** Some hosts answer every address by their page. */
const isPage = (response: Response): boolean =>
  response.headers.get('Content-Type')?.startsWith('text/html') ?? false;

async function fetchedPart(name: string, type: string): Promise<string> {
  return part(name, type, await (await file(name)).blob());
}

/** A script element that no browser runs: the packed file. A log is compressed already. */
async function part(name: string, type: string, content: Blob): Promise<string> {
  const isPacked = type !== kLogType;
  const packed = isPacked
    ? await new Response(content.stream().pipeThrough(new CompressionStream('gzip'))).blob()
    : content;
  return (
    `<script type="application/octet-stream" data-name="${escaped(name)}" data-type="${type}" ` +
    `data-size="${content.size}"${isPacked ? ' data-coding="gzip"' : ''}>` +
    `${await base64(packed)}</script>\n`
  );
}

const iconOf = async (name: string): Promise<string> => base64(await (await file(name)).blob());

/** A data: address has it, made outside of the page's thread. */
function base64(content: Blob): Promise<string> {
  return new Promise((resolve, reject) => {
    const reader = new FileReader();
    reader.onload = () => resolve((reader.result as string).replace(/^[^,]*,/, ''));
    reader.onerror = () => reject(reader.error ?? new Error('the file cannot be read'));
    reader.readAsDataURL(content);
  });
}

const lastPart = (path: string): string => path.replace(/^.*\//, '');

const escaped = (text: string): string =>
  text.replace(/[&<>"]/g, (sign) => `&#${sign.charCodeAt(0)};`);
