// Files that were dropped together: which of them are not shown, and which are missing.

/** Files that name no others: each is a mesh of its own. */
const kAlone = /\.(qtet|vtu|vtk|msh|meshb?|su2|unv)(\.gz)?$/i;
/** Files that name others by these attributes of XML. */
const kNaming = /\.(pvtu|pvd|vtm)$/i;
const kNamed = /\b(?:Source|file)\s*=\s*["']([^"']+)["']/g;
const kComment = /<!--.*?-->/gs;
const kEntities: Record<string, string> = {amp: '&', lt: '<', gt: '>', quot: '"', apos: "'"};
/** The blocks of a .vtm that are read; surfaces and lines are left out. */
const kVolumes = /\.(vtu|pvtu|vts|pvts|vtr|pvtr|vti|pvti|vtk|vtm)$/i;
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
  const named = namedIn(await main.text()).filter(
    (path) => !/\.vtm$/i.test(name) || kVolumes.test(path),
  );
  const bases = named.map((path) => path.replace(/^.*[/\\]/s, ''));
  const given = files.map((file) => file.name);
  const twice = [bases, given].flatMap((its) => its.filter((one, i) => its.indexOf(one) !== i));
  if (twice.length > 0)
    return (
      `${name} needs several files called ${twice[0]}, in folders that a page does not learn. ` +
      'Give them to the program qtet.'
    );
  const missing = bases.filter((its) => !given.includes(its));
  if (missing.length === 0) return '';
  return `${name} needs ${listOf(missing)}, which it names. Drop all of them together.`;
}

/** Each file that the XML names, once. */
function namedIn(text: string): string[] {
  const paths = [...text.replace(kComment, '').matchAll(kNamed)].map(([, path]) =>
    path!.replace(/&(amp|lt|gt|quot|apos);/g, (_, entity: string) => kEntities[entity]!),
  );
  return [...new Set(paths)];
}
