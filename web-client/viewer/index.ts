// qtet: the viewer's class; qtet/element also defines <qtet-viewer>.

export type {QtetViewerAttributes, QtetViewerEventMap} from './page/events';
export type {MovieOptions} from './picture/movies';
export {QtetViewer} from './qtet_viewer';
export {kViewAttributes, type ViewAttribute} from './settings/settings';
export {embedSnippet, linkTo} from './settings/share';
