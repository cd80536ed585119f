// Copies texts to the clipboard.

/** Pages without https have no clipboard. `announce` says what became of it. */
export async function copy(text: string, announce: (text: string) => void): Promise<void> {
  const clipboard = navigator.clipboard as Clipboard | undefined;
  const copied = await clipboard?.writeText(text).then(
    () => true,
    () => false,
  );
  announce(copied ? 'Copied' : 'The browser does not let this page copy');
}
