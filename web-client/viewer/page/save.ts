// Saves a file that the page has made.

/** How long the browser may still read a file that is being saved. */
const kSavingMs = 1000;

export function save(file: Blob, download: string): void {
  const href = URL.createObjectURL(file);
  Object.assign(document.createElement('a'), {href, download}).click();
  setTimeout(() => URL.revokeObjectURL(href), kSavingMs);
}
