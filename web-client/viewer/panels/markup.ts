// Markup that several panels have.

/** Radio buttons in a row, the first one chosen; `titles` by value. */
export const segments = (name: string, titles: Record<string, string>): string =>
  Object.entries(titles)
    .map(([value, title], i) => {
      const checked = i === 0 ? ' checked' : '';
      const input = `<input type="radio" name="${name}" value="${value}"${checked}>`;
      return `<label>${input}<span>${title}</span></label>`;
    })
    .join('');

/** A labelled switch. */
export const toggle = (name: string, title: string, checked = false): string =>
  `<label class="switch"><span class="name">${title}</span>` +
  `<input type="checkbox" role="switch" name="${name}"${checked ? ' checked' : ''}></label>`;
