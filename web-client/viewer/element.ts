// qtet/element: defines <qtet-viewer>, only once however often it is loaded.

import {QtetViewer} from './qtet_viewer';

declare global {
  interface HTMLElementTagNameMap {
    'qtet-viewer': QtetViewer;
  }
}

if (!customElements.get('qtet-viewer')) customElements.define('qtet-viewer', QtetViewer);
