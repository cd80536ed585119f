// Files that were dropped together: which of them are not shown, and which are missing.

/** Files that name no others: each is a mesh of its own. */
const kAlone = /\.(qtet|vtu|vtk|msh|meshb?|su2|unv)(\.gz)?$/i;
/** Files that name others by these attributes of XML. */
const kNaming = /\.(pvtu|pvd|vtm)$/i;
const kNamed = /\b(?:Source|file)\s*=\s*["']([^"']+)["']/g;
const kSurface = /\.(stl|obj|ply|off)(\.gz)?$/i;
/** More names make no sentence. */
const kMaxNames = 4;

/** "a, b and c", or "a, b, c, d and 8 more". */
function listOf(names: readonly string[]): string {
  const isLong = names.length > kMaxNames + 1;
  const shown = isLong ? names.slice(0, kMaxNames) : names.slice(0, -1);
  const last = isLong ? `${names.length - kMaxNames} more` : names.at(-1)!;
  return shown.length > 0 ? `${shown.join(', ')} and ${last}` : last;
}

/** Names the files that are not shown beside `shown`, which was read; empty if there are none. */
export function leftOut(shown: File, files: readonly File[]): string {
  if (kNaming.test(shown.name)) return '';
  const names = files
    .filter((file) => file !== shown && (kAlone.test(file.name) || shown.name.endsWith('.qtet')))
    .map(({name}) => name);
  if (names.length === 0) return '';
  const are = names.length > 1 ? 'are' : 'is';
  return `${listOf(names)} ${are} not shown beside ${shown.name}: drop one mesh at a time.`;
}

/** Says why the file cannot be read, as far as names tell; empty if nothing speaks against it. */
export async function hindrance(main: File, files: readonly File[]): Promise<string> {
  const {name} = main;
  if (kSurface.test(name))
    return (
      `${name} is a surface: it has no cells inside, and qtet shows volumes. ` +
      'Fill it with tetrahedra, for example by Gmsh, and drop that mesh.'
    );
  if (!kNaming.test(name)) return '';
  const here = new Set(files.map((file) => file.name));
  const named = [...(await main.text()).matchAll(kNamed)].map(([, path]) => path!);
  const missing = [...new Set(named.map((path) => path.replace(/^.*[/\\]/s, '')))].filter(
    (its) => !here.has(its),
  );
  if (missing.length === 0) return '';
  return `${name} needs ${listOf(missing)}, which it names. Drop all of them together.`;
}
