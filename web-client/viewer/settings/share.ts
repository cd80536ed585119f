// A link to the same picture, and HTML that embeds it in another page.

/** The page's address with these parameters instead of its own. */
export function linkTo(page: string, view: ReadonlyMap<string, string>): string {
  const url = new URL(page);
  url.search = new URLSearchParams([...view]).toString();
  url.hash = '';
  return url.href;
}

/** The page's address for others. That of a page on a disk would tell the names of its folders. */
export function publicAddress(page: string): string {
  return page.startsWith('file:') ? 'file:///' : page;
}

/**
 * HTML for a page on any host: a frame with this page, which loads its worker and its WebAssembly
 * itself.
 */
export function embedSnippet(link: string, title: string): string {
  const quoted = (text: string): string =>
    text.replaceAll('&', '&amp;').replaceAll('"', '&quot;').replaceAll('<', '&lt;');
  return (
    `<iframe src="${quoted(link)}"\n  title="${quoted(title)}" allow="fullscreen"\n  ` +
    'style="width: 100%; height: 600px; border: 0"></iframe>'
  );
}
