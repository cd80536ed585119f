// Opens the view whose address a picture holds. Only the view's own parameters count: neither the
// address's host nor its server is asked for anything.

import {errorCode, errorText} from '../../core/protocol/errors';
import type {Page} from '../page/page';
import {chosenMesh} from '../panels/mesh_menu';
import {kViewAttributes, type ViewAttribute} from '../settings/settings';
import {viewIn} from './png_view';

export interface OpenHost {
  /** Opens another mesh. The attributes of this one end. */
  readonly stream: {choose(mesh: string): void};
  readonly notices: {end(code: string): void};
  look(direction: null): void;
  failed(code: string, message: string): void;
}

/** The parameters of a view in an address, without any other. */
export function parametersIn(address: string): Map<ViewAttribute, string> {
  const query = new URLSearchParams(/^[^?#]*\?([^#]*)/.exec(address)?.[1]);
  return new Map(
    kViewAttributes.flatMap((name) => {
      const value = query.get(name);
      return value ? [[name, value] as const] : [];
    }),
  );
}

export async function openView(file: Blob, page: Page, host: OpenHost): Promise<void> {
  try {
    const view = parametersIn(await viewIn(file));
    host.notices.end('no-picture');
    show(view, page, host);
  } catch (thrown) {
    host.failed(errorCode(thrown), errorText(thrown));
  }
}

function show(view: ReadonlyMap<ViewAttribute, string>, page: Page, host: OpenHost): void {
  const mesh = view.get('mesh');
  const isOther = mesh !== undefined && mesh !== chosenMesh(page.root);
  if (isOther) host.stream.choose(mesh);
  for (const name of kViewAttributes)
    if (name !== 'mesh' && name !== 'camera') page.write(name, view.get(name) ?? null);
  // The user may have left the camera that the attribute still says.
  page.write('camera', null);
  const camera = view.get('camera');
  if (camera !== undefined) page.write('camera', camera);
  else if (!isOther) host.look(null);
  page.announce('The view of the picture');
}
