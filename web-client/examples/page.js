// What the examples are told by their address, ?server=http://127.0.0.1:8080/&mesh=fin (a running
// qtet-server) or ?log=fin.qtet (a file on any web server).
const words = new URLSearchParams(location.search);
const server = new URL(words.get('server') ?? '/', location.href);
const mesh = words.get('mesh') ?? 'fin';
/** A level as a file: the finest of at most so many tetrahedra. */
export const level = (ending, tets) =>
  new URL(`v1/meshes/${mesh}/levels/fit.${ending}?tets=${tets}`, server).href;
/** Where the log is, whole, for byte ranges. */
export const log = new URL(
  words.get('log') ?? new URL(`v1/meshes/${mesh}/log`, server),
  location.href,
).href;
