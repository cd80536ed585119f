// The mesh's name, or a menu if there are several.

import type {MeshEntry} from '../page/catalog';
import {find} from '../page/find';
import {fillSelect} from '../page/select';

/**
 * The mesh in the menu; empty if there is no menu yet. It also works for a viewer outside a
 * document.
 */
export function chosenMesh(root: ParentNode): string {
  return root.querySelector<HTMLSelectElement>('select[name=mesh]')?.value ?? '';
}

export class MeshMenu {
  private readonly select: HTMLSelectElement;

  constructor(
    private readonly root: ShadowRoot,
    choose: (mesh: string) => void,
  ) {
    this.select = find(root, 'select[name=mesh]');
    this.select.addEventListener('change', () => choose(this.select.value));
  }

  fill(catalog: readonly MeshEntry[], mesh: string): void {
    const isThere = catalog.some(({id}) => id === mesh);
    const hasChoice = catalog.length > (isThere ? 1 : 0);
    fillSelect(
      this.select,
      catalog.map(({id}) => ({value: id, title: id})),
      mesh,
    );
    find(this.root, '.mesh-menu').hidden = !hasChoice;
    find(this.root, '.mesh-name').classList.toggle('visually-hidden', hasChoice);
  }

  name(mesh: string): void {
    find(this.root, '.mesh-name').textContent = find(this.root, '.title').title = mesh;
    find(this.root, '.scene').setAttribute(
      'aria-label',
      `3D view of ${mesh}. Arrow keys turn it, plus and minus zoom; the question mark lists all ` +
        'keys.',
    );
  }
}
