// The creases of the mesh at rest, so that no line comes or goes while a warp moves it. Instants of
// a series share them: they take longer than its values.

import type {Codec} from '../decode/codec';
import {creaseLines} from '../picture/crease_lines';
import type {MeshArrays} from '../picture/display';
import type {CreasesOf} from '../picture/triangle_soup';
import type {Plane} from '../protocol/geometry';

export class KeptCreases {
  /** The chunks of the mesh that has them. */
  private chunks = 0;
  private boundary: Uint8Array | null = null;
  private faces: Uint8Array | null = null;
  /** Tells sets of faces apart: parts may be hidden. */
  private facesKey = 0;

  constructor(
    private readonly codec: Codec,
    private readonly creasesOf: CreasesOf,
  ) {}

  /** They are of another mesh. */
  forget(): void {
    this.boundary = this.faces = null;
  }

  /** For surfaces of the mesh: of its boundary, or of faces of its cells. */
  of({boundary}: MeshArrays): CreasesOf {
    // A copy, because it is transferred.
    return (_, triangles) =>
      (triangles === boundary ? this.ofBoundary(triangles) : this.ofFaces(triangles)).slice();
  }

  /** The boundary's as lines, 6 lattice coordinates each; without the parts above the planes. */
  lines({boundary}: MeshArrays, planes: readonly Plane[]): Float32Array {
    return creaseLines(this.codec.points(), boundary, this.ofBoundary(boundary), planes);
  }

  private ofBoundary(triangles: Uint32Array): Uint8Array {
    this.follow();
    return (this.boundary ??= this.creasesOf(this.codec.points(), triangles));
  }

  private ofFaces(triangles: Uint32Array): Uint8Array {
    this.follow();
    let key = triangles.length;
    for (const vertex of triangles) key = (Math.imul(key, 31) + vertex) | 0;
    if (key !== this.facesKey) this.faces = null;
    this.facesKey = key;
    return (this.faces ??= this.creasesOf(this.codec.points(), triangles));
  }

  /** A finer or coarser mesh has others. */
  private follow(): void {
    if (this.codec.chunksApplied !== this.chunks) this.forget();
    this.chunks = this.codec.chunksApplied;
  }
}
