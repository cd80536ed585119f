// A link to the same picture, and the lines that put it into another page.

/** The page's address with these parameters instead of its own. */
export function linkTo(page: string, view: ReadonlyMap<string, string>): string {
  const url = new URL(page);
  url.search = new URLSearchParams([...view]).toString();
  url.hash = '';
  return url.href;
}

/**
 * HTML for a page on any host: this page in a frame, which brings its own worker and WebAssembly
 * from where they lie.
 */
export function embedSnippet(link: string, title: string): string {
  const quoted = (text: string): string =>
    text.replaceAll('&', '&amp;').replaceAll('"', '&quot;').replaceAll('<', '&lt;');
  return (
    `<iframe src="${quoted(link)}"\n  title="${quoted(title)}" allow="fullscreen"\n  ` +
    'style="width: 100%; height: 600px; border: 0"></iframe>'
  );
}
