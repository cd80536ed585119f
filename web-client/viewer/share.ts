// A link to the same picture, and the lines that put it into another page.

/** The page's address with these parameters instead of its own. */
export function linkTo(page: string, view: ReadonlyMap<string, string>): string {
  const url = new URL(page);
  url.search = new URLSearchParams([...view]).toString();
  url.hash = '';
  return url.href;
}

/** HTML for a page on any host: the element, its script, and every attribute of the view. */
export function embedSnippet(script: string, server: string, view: ReadonlyMap<string, string>): string {
  const attributes = [...view].map(([name, value]) => `\n  ${name}="${value.replaceAll('&', '&amp;').replaceAll('"', '&quot;')}"`).join('');
  return `<script type="module" src="${script}"></script>\n<qtet-viewer src="${server}"${attributes}\n  style="height: 600px"></qtet-viewer>`;
}
